/* The last part: the page begins. */

const recording = JSON.parse(byId('recording').textContent);
const asked = location.hash; // the player writes its step there
new Player(recording);
const walkMode = new WalkMode(recording);
if (asked === '#walk') walkMode.open();
