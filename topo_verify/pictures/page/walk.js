/* Walk it yourself: the reader is the robot, sees percepts only, and is told at the end what
   followed from the walk and what was luck. */

const LETTERS = 'abcdefghijklmopqrstvwxyz'; // n and u are keys of their own

/** Why a true declaration does not follow; the witness shows it. */
const WHY = {
  new: 'the road might as well end at an unexplored exit of the map',
  loop: 'the road might as well end elsewhere',
};

class WalkMode {
  constructor(recording) {
    this.recording = recording;
    const walked = (drawn) => new WalkWorld({ ...drawn, marker: drawn.root, drawn });
    this.page = { name: recording.name, world: walked(recording.worlds[0]) };
    this.gallery = recording.gallery.map((one) => ({ name: one.name, world: walked(one) }));
    this.seed = 1;
    const button = html('button', '', document.querySelector('.choices'), 'Walk it yourself');
    button.id = 'walk-it';
    button.title = 'Be the robot: see only what it sees, choose doors, draw the map';
    button.addEventListener('click', () => {
      this.open('random');
      this.head.focus();
    });
    addEventListener('keydown', (event) => this.key(event), { capture: true });
  }

  // ---------------------------------------------------------------- the frame

  /** Begin in this world, or where the walk was. */
  open(world) {
    if (this.section?.isConnected) return;
    this.outside = [...document.body.children].filter((one) => !['walk', 'help'].includes(one.id) && !one.inert);
    for (const one of this.outside) one.inert = true;
    this.section ??= this.frame();
    document.body.append(this.section);
    this.before = location.hash;
    address('#walk'); // so that a reload does not show the world
    if (!this.section.classList.contains('begun')) this.choose(world);
    this.section.classList.add('begun');
  }

  close() {
    this.section.remove();
    address(this.before);
    for (const one of this.outside) one.inert = false;
    byId('walk-it').focus();
  }

  frame() {
    const section = html('section');
    section.id = 'walk';
    section.setAttribute('aria-label', 'Walk it yourself');
    const bar = html('div', 'bar', section);
    this.head = html('h1', '', bar, 'Walk it yourself');
    this.head.tabIndex = -1; // not the section: a browser would focus what the address names
    const label = html('label', '', bar, 'world ');
    this.select = html('select', '', label);
    const names = [['page', 'that of this page'], ...this.gallery.map(({ name }, k) => [`${k}`, name]), ['random', 'drawn by lot'], ['own', 'build one']];
    for (const [value, text] of names) html('option', '', this.select, text).value = value;
    this.select.addEventListener('change', () => {
      this.choose(this.select.value);
      this.head.focus();
    });
    this.lot = html('label', '', bar, 'roads ');
    this.roads = html('input', '', this.lot);
    Object.assign(this.roads, { type: 'number', min: 1, max: 40, value: 6 });
    this.roads.addEventListener('change', () => this.choose('random'));
    this.button(this.lot, 'another', '', () => ((this.seed += 1), this.choose('random')));
    const hint = html('label', 'end', bar);
    this.atOnce = html('input', '', hint);
    this.atOnce.type = 'checkbox';
    hint.append(' judge each decision at once');
    this.atOnce.addEventListener('change', () => (this.atOnce.blur(), this.show()));
    this.button(bar, 'Help', '?', () => byId('help').showModal());
    this.button(bar, 'Back to the run', 'esc', () => this.close());
    const panes = html('div', 'panes', section);
    [this.left, this.right] = [0, 1].map(() => {
      const pane = html('div', 'card pane', panes);
      const head = html('h2', '', pane);
      return { title: html('span', '', head), note: html('small', '', head), svg: draw('svg', { role: 'group' }, pane) };
    });
    this.says = html('div', 'card says', section);
    this.says.setAttribute('aria-live', 'polite');
    return section;
  }

  button(parent, text, key, action) {
    const button = html('button', '', parent, text);
    if (key) html('kbd', '', button, key);
    button.dataset.key = key;
    button.addEventListener('click', action);
    return button;
  }

  /** Keys: digits are doors, letters are exits of the map; nothing reaches the player below. */
  key(event) {
    if (!this.section?.isConnected) return;
    event.stopPropagation();
    if (byId('help').open) return event.key === '?' && byId('help').close();
    if (event.ctrlKey || event.metaKey || event.altKey || event.target.closest('select, input[type=number]')) {
      if (event.key === 'Escape') this.close();
      return;
    }
    const name = { Escape: 'esc', Enter: '↵', Backspace: 'u' }[event.key] ?? event.key.toLowerCase();
    const onTarget = (event.key === 'Enter' || event.key === ' ') && event.target.closest('[role=button], button, input');
    const goal = onTarget || [...this.section.querySelectorAll('[data-key]')].find((one) => one.dataset.key === name && !one.disabled);
    if (!goal || onTarget && goal.tagName !== 'g') return;
    event.preventDefault();
    goal.dispatchEvent(new MouseEvent('click'));
  }

  /** A part of a picture that one can press. */
  press(parent, className, label, key, action) {
    const group = draw('g', { class: className, role: 'button', tabindex: 0, 'aria-label': label, 'data-key': key }, parent);
    draw('title', {}, group, label);
    group.addEventListener('click', action);
    return group;
  }

  // ---------------------------------------------------------------- which world

  choose(value) {
    this.select.value = value;
    this.lot.hidden = value !== 'random';
    this.walk = null;
    if (value === 'own') return void new Builder(this);
    const edges = Math.max(1, Math.min(40, Math.round(+this.roads.value) || 6));
    const world = value === 'page' ? this.page.world : value === 'random' ? randomWorld(this.seed, edges) : this.gallery[+value].world;
    this.begin(world);
  }

  begin(world) {
    this.walk = new Walk(world);
    this.sketch = null;
    this.ended = null;
    this.show();
  }

  // ---------------------------------------------------------------- on the way

  show() {
    if (!this.walk) return; // a world is being built
    if (this.ended) return this.verdict();
    this.percept();
    this.map();
    this.sentence();
  }

  act(action) {
    const focused = document.activeElement?.dataset?.key;
    action();
    this.show();
    this.section.querySelector(`[data-key="${focused}"]`)?.focus?.();
  }

  /** What is seen: the place with its doors, the way back below. */
  percept() {
    const { svg, title, note } = this.left, { degree, marker } = this.walk.percept;
    title.textContent = 'What you see';
    note.textContent = degree ? `${seenAs(this.walk.percept)}${this.walk.moves ? '; the way you came is below' : ''}` : 'no exit';
    svg.replaceChildren();
    svg.setAttribute('viewBox', '-150 -125 300 250');
    const size = Math.min(14, 260 / Math.max(degree, 1));
    for (let door = 0; door < degree; door += 1) {
      const angle = Math.PI / 2 + (2 * Math.PI * door) / degree;
      const at = (far) => [far * Math.cos(angle), far * Math.sin(angle)];
      const words = `Door ${door}${door || !this.walk.moves ? '' : ', the way you came'}${door === marker ? ', at which the marker points' : ''}`;
      const group = this.press(svg, `door ${door ? '' : 'in'}`, words, `${door}`, () => this.act(() => this.walk.move(door)));
      draw('path', { d: `M${pair(at(30))}L${pair(at(78))}` }, group);
      if (door === marker) drawMarker(group, at(30), at(58), at(74));
      const [cx, cy] = at(96);
      draw('circle', { cx, cy, r: size }, group);
      draw('text', { x: cx, y: cy }, group, door).style.fontSize = `${1.1 * size}px`;
    }
    draw('g', { class: 'vertex' }, svg).append(draw('circle', { r: 30 }));
    drawRobot(svg, 20).setAttribute('transform', `rotate(${this.walk.moves ? -90 : 90})`);
  }

  /** S as declared, with the robot where it is on it, and the exits where e may end. */
  map() {
    const { walk } = this, { svg, title, note } = this.right;
    title.textContent = 'Your map';
    note.textContent = walk.open().length ? many(walk.open().length, 'unexplored exit') : 'no unexplored exit';
    this.sketch = this.sketchOfMap();
    const stubs = this.sketch.show(svg, { marker: walk.size ? 0 : null, kinds: this.atOnce.checked ? this.kinds(walk.judged().found) : undefined });
    const stand = walk.here ?? null;
    if (stand !== null || !walk.size) {
      const { x, y } = this.sketch.spots[walk.size ? walk.vertices.indexOf(walk.vertexOf(stand)) : 0];
      const turn = walk.size ? (this.sketch.angle(stand) * 180) / Math.PI + (walk.moves ? 180 : 0) : 0;
      if (walk.size) draw('path', { class: 'tick', d: `M${pair(this.sketch.out(stand, ROUND))}L${pair(this.sketch.out(stand, 1.6 * ROUND))}` }, svg);
      drawRobot(svg, 11).setAttribute('transform', `translate(${pair([x, y])}) rotate(${short(turn)})`);
    }
    if (!walk.pending) return;
    const { group, at } = stubs.get(walk.pending.edge);
    group.setAttribute('class', 'asked');
    group.querySelector('path').setAttribute('class', 'e');
    draw('circle', { class: 'unknown', cx: at[0], cy: at[1], r: 12 }, svg);
    draw('text', { class: 'what', x: at[0], y: at[1] }, svg, '?');
    walk.hypotheses().forEach((dart, k) => {
      const letter = LETTERS[k] ?? '', [cx, cy] = stubs.get(dart).at;
      const badge = this.press(svg, 'badge', `The road ends at exit ${letter} of your map`, letter || '-', () => this.act(() => walk.declare(dart)));
      badge.dataset.dart = dart;
      draw('circle', { cx, cy, r: 12 }, badge);
      draw('text', { x: cx, y: cy }, badge, letter);
    });
  }

  sketchOfMap() {
    const rotation = ({ first, degree }) => Array.from({ length: degree }, (_, k) => first + k);
    const before = this.sketch && this.sketch.vertices.length <= this.walk.vertices.length ? this.sketch : null;
    return Sketch.best(this.walk.vertices.map(rotation), this.walk.alpha, before);
  }

  /** By dart of S, what became of the declaration about it. */
  kinds(found) {
    return new Map(found.map(({ event, fate }) => [event.edge, fate]));
  }

  sentence() {
    const { walk, says } = this, { pending } = walk;
    says.className = 'card says';
    says.replaceChildren();
    const last = this.atOnce.checked ? walk.judged().found.at(-1) : undefined;
    const [head, body] = this.told(last), bad = Boolean(walk.contradiction) || last?.fate === 'wrong';
    html('h3', '', says, head);
    html('p', '', says, body);
    const row = html('div', 'bar', says);
    this.button(row, 'It is a new place', 'n', () => this.act(() => walk.declare(null))).disabled = !walk.mayBeNew();
    const declared = walk.events.some(({ type }) => type === 'augment');
    const back = this.button(row, 'Take back the last decision', 'u', () => this.act(() => walk.takeBack()));
    back.disabled = !declared;
    back.classList.toggle('main', bad);
    const done = this.button(row, walk.complete ? 'The map is complete' : 'Stop and judge', '↵', () => this.end());
    done.classList.toggle('main', walk.complete && !bad);
    html('span', 'end', row, many(walk.moves, 'move'));
    if (bad) says.classList.add('bad');
    else if (walk.complete) says.classList.add('good');
    if (pending && walk.hypotheses().length > LETTERS.length) html('p', '', says, 'Not all exits have a letter: click them.');
  }

  /** What is said on the way, with what became of the last decision that was judged. */
  told(last) {
    const { walk } = this, { pending } = walk;
    if (walk.contradiction) return ['Your map contradicts what you see', `${walk.contradiction} One of your decisions is wrong: take it back, or stop and see which one.`];
    if (last?.fate === 'wrong') {
      const later = walk.events.slice(last.when + 1).some(({ type }) => type === 'augment');
      return [`${later ? 'An earlier' : 'Your last'} decision is wrong`, 'It is red on your map. Take it back, or walk on until your map contradicts what you see.'];
    }
    const fate = !last ? '' : last.fate === 'followed' ? 'Your last decision is proved. ' : `Your last decision is true, but not proved: ${WHY[last.event.kind]}. `;
    if (walk.complete) return ['Nothing on your map is unexplored', `${fate}Is every decision certain? Walk on, or have it judged.`];
    const doors = `Choose a door, by click or by its number. Door 0 ${walk.moves ? 'leads back' : 'is the one at which the marker points'}; the others count clockwise.`;
    if (!walk.moves) return ['Find out where every exit leads', `Places look alike, but for the one with the marker, the red arrow. ${doors}`];
    if (!pending) return ['You know where you are', fate + doors];
    const guesses = walk.hypotheses().length, exits = guesses === 1 ? 'the exit with the letter' : `one of the ${guesses} exits with letters`, mayBeNew = walk.mayBeNew();
    const alone = !guesses || !mayBeNew;
    const places = !mayBeNew ? `You see the marker, so no place is new here: the road ends at ${exits}${guesses > 1 ? '. Its arrow tells which: count from it' : ''}` : guesses ? `It may be a new place, or ${exits}` : 'No unexplored exit of your map looks like it, so it is a new place';
    if (pending.word.length) return [`You are ${many(pending.word.length, 'door')} past the end of the new road`, `${fate}If you know now where the road (?) ends, say so: ${mayBeNew ? 'it is a new place, or an exit of your map' : 'it is an exit at the marker'}.`];
    return ['A new road: where does it end?', `${fate}${places}. ${alone ? 'Say so' : 'Walk on to find out, or say so'}: ${guesses ? 'choose a letter on your map' : 'press “It is a new place”'}${guesses && mayBeNew ? ', or “It is a new place”' : ''}.`];
  }

  // ---------------------------------------------------------------- the end

  end() {
    this.ended = { ...this.walk.judged(), other: null };
    this.show();
    this.says.querySelector('button').focus({ preventScroll: true }); // the headline stays in sight
  }

  /** What was right, what followed, what was luck: in words and in both pictures. */
  verdict() {
    const { walk, ended, says } = this, { found } = ended;
    const luck = found.filter(({ fate }) => fate === 'luck'), wrong = found.find(({ fate }) => fate === 'wrong');
    this.reveal();
    if (walk.complete && !wrong) {
      this.right.note.textContent = 'no unexplored exit; drawn like the world';
      this.showWorld(this.right.svg);
    } else this.sketch.show(this.right.svg, { marker: walk.size ? 0 : null, kinds: this.kinds(found) });
    if (wrong && wrong.truth !== null) {
      const [cx, cy] = this.sketch.out(wrong.truth, 2.35 * ROUND);
      draw('circle', { class: 'ring truth', cx, cy, r: 10 }, this.right.svg);
    }
    says.replaceChildren();
    const good = !wrong && !luck.length && ended.proved && walk.complete;
    says.className = `card says ${wrong ? 'bad' : good ? 'good' : ''}`;
    html('h3', '', says, this.headline(wrong, luck, good));
    html('p', '', says, `${this.cost()} ${this.proof(wrong, luck)}`);
    const list = html('ol', '', says);
    for (const one of found) html('li', one.fate, list, this.fate(one));
    if (wrong && walk.events.slice(wrong.when + 1).some(({ type }) => type === 'augment')) html('p', '', says, 'What came later is not judged: it stands on a wrong map.');
    const key = html('p', 'kinds', says);
    for (const [kind, text] of [['followed', 'proved'], ['luck', 'true by luck'], ['wrong', 'wrong']]) {
      const part = html('span', '', key);
      html('i', `swatch ${kind}`, part);
      part.append(text);
    }
    const row = html('div', 'bar', says);
    this.button(row, 'Walk it again', 'w', () => this.begin(walk.world));
    const on = () => {
      this.ended = null;
      if (wrong) walk.takeBack(wrong.when);
    };
    if (walk.moves) this.button(row, ...(wrong ? ['Take it back and walk on', 'u'] : ['Walk on', 'o']), () => this.act(on));
    const witness = luck.at(-1)?.witness ?? (wrong ? null : ended.witness);
    if (witness) this.button(row, ended.other ? 'Show this world' : 'Show another world with this walk', 's', () => this.act(() => (ended.other = ended.other ? null : witness)));
  }

  headline(wrong, luck, good) {
    const { walk, ended } = this, roads = walk.world.edges.length;
    if (wrong) return 'A decision is wrong';
    if (good) return 'Your walk proves this map';
    const part = walk.complete ? 'The map is right' : `So far it is right, with ${ended.found.length} of ${many(roads, 'road')} on it`;
    if (luck.length) return `${part}, but ${luck.length} of ${ended.found.length} decisions ${luck.length === 1 ? 'was' : 'were'} luck`;
    return walk.complete ? `${part}, but the walk does not prove it` : part;
  }

  cost() {
    const { walk } = this, least = walk.world.leastCost();
    const runs = walk.world !== this.page.world ? [] : this.recording.runs.map((run) => `${run.name} takes ${run.events.replace(/[^wcvtm]/g, '').length}`);
    return `You made ${many(walk.moves, 'move')}. With the map in hand, a proof of this world takes ${least}${runs.length ? `; ${runs.join(', ')}` : ''}.`;
  }

  /** Whether the history proves the world; if not, what is left open. */
  proof(wrong, luck) {
    if (this.ended.proved) return 'The history proves the world.';
    const left = !this.walk.complete ? ': exits are left that may lead anywhere' : wrong ? '' : `: ${luck.length === 1 ? 'the' : 'a'} road marked orange may end elsewhere`;
    return `The history does not prove the world${left}.`;
  }

  fate({ event, fate, truth, given }) {
    const said = event.kind === 'new' ? 'A new place' : 'A road between places known';
    if (fate === 'followed') return `${said}: proved${given ? ', if what was luck is taken for true' : ''}.`;
    if (fate === 'luck') return `${said}: luck, for ${WHY[event.kind]}.`;
    return `${said}: wrong, ${truth === null ? 'the place behind it was new' : `${event.kind === 'new' ? 'you had been there: ' : ''}the road ends at the exit with the green ring`}.`;
  }

  /** Show the world or its witness. */
  reveal() {
    const { walk, ended } = this, { svg, title, note } = this.left;
    title.textContent = ended.other ? 'Another world' : 'The world';
    note.textContent = ended.other ? 'the same doors show the same there; dotted: never walked' : walk.world.words;
    if (ended.other) sketchOf(ended.other).show(svg, { marker: ended.other.marker, kinds: this.untaken(new WalkWorld(ended.other)) });
    else this.showWorld(svg);
  }

  /** Show the world with the declarations in colours. */
  showWorld(svg) {
    const { found, phi } = this.ended, { world } = this.walk;
    const kinds = new Map(found.map(({ event, fate }) => [phi.get(event.edge), fate]));
    if (world.drawn) this.picture(svg, kinds);
    else sketchOf(world).show(svg, { marker: world.marker, kinds });
  }

  /** The darts of another world that the same doors do not cross. */
  untaken(world) {
    const kinds = new Map(world.edges.flat().map((dart) => [dart, 'far']));
    let at = world.marker;
    for (const { type, door } of this.walk.events) {
      if (type !== 'move') continue;
      const exit = world.turn(at, door);
      at = world.other.get(exit);
      kinds.delete(exit);
      kinds.delete(at);
    }
    return kinds;
  }

  /** A world whose drawing the page has, as the player draws it. */
  picture(svg, kinds) {
    const drawn = new Picture(this.walk.world.drawn), { left, top, width, height } = drawn;
    svg.replaceChildren();
    svg.setAttribute('viewBox', [left, top, width, height].map(short).join(' '));
    drawn.fit(svg.clientWidth || 600, svg.clientHeight || 400);
    const inside = draw('g', {}, svg);
    inside.style.setProperty('--u', drawn.unit);
    drawn.drawSides(inside);
    const road = ([a, b], d) => {
      const path = draw('path', { class: `road ${kinds.get(a) ?? kinds.get(b) ?? ''}`, d }, inside);
      path.style.strokeWidth = `${(kinds.has(a) || kinds.has(b) ? 5 : 3) * drawn.unit}px`;
    };
    for (const edge of drawn.edges) road(edge, drawn.trail(edge[0]).data);
    for (const [data, over] of drawn.bridges) {
      draw('path', { class: 'halo', d: data }, inside);
      road(drawn.edges[over], data);
    }
    if (drawn.root !== null) {
      const trail = drawn.trail(drawn.root), along = (far) => trail.at(Math.min(far * drawn.radius, 0.45 * trail.length));
      drawMarker(inside, ...[0, 1.7, 2.5].map(along).map(({ x, y }) => [x, y]));
    }
    for (const [cx, cy] of drawn.centres) draw('g', { class: 'vertex' }, inside).append(draw('circle', { cx, cy, r: drawn.radius }));
  }
}
