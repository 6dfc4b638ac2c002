/* The last part: the page begins. */

const recording = JSON.parse(byId('recording').textContent);
const asked = location.hash; // the player writes its step there

function begin() {
  new Player(recording);
  const walkMode = new WalkMode(recording);
  const walk = () => walkMode.open('page');
  if (asked === '#walk') walk();
  addEventListener('hashchange', () => location.hash === '#walk' && walk());
}

// In a frame that has just been made the pictures may have no room yet to be fitted into.
if (byId('panes').clientWidth) begin();
else {
  new ResizeObserver((_, watch) => {
    if (!byId('panes').clientWidth) return;
    watch.disconnect();
    begin();
  }).observe(byId('panes'));
}
