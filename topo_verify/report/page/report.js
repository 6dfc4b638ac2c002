/* Opens a player where one is asked for: all players share one page, each has its own recording. */
const shell = document.getElementById('player');
const [before, after] = shell ? JSON.parse(shell.textContent) : ['', ''];
for (const box of document.querySelectorAll('details.play')) {
  box.addEventListener('toggle', () => {
    if (!box.open || box.querySelector('iframe')) return;
    const frame = document.createElement('iframe');
    frame.setAttribute('sandbox', 'allow-scripts');
    frame.title = box.dataset.title;
    frame.srcdoc = before + document.getElementById(box.dataset.recording).textContent + after;
    box.append(frame);
  });
}
