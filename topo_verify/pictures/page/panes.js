/* The two panes of a run: the world, and the robot's map S in the same coordinates.

   What appears once stays in the picture and is switched on and off by a timeline, so that a step
   touches only what changes. What belongs to one moment is drawn anew. */

/** Things that appear and disappear at events; `seek` applies what lies in between, either way. */
class Timeline {
  constructor() {
    this.changes = []; // [event, change(is it on?)]
    this.next = 0;
  }

  add(when, change) {
    if (when !== Infinity) this.changes.push([when, change]);
  }

  ready() {
    this.changes.sort((a, b) => a[0] - b[0]);
  }

  seek(when) {
    const { changes } = this;
    while (this.next < changes.length && changes[this.next][0] <= when) changes[this.next++][1](true);
    while (this.next > 0 && changes[this.next - 1][0] > when) changes[--this.next][1](false);
  }
}

/** What both panes have: the picture's frame, sizes, layers, marks and the robot. */
class Pane {
  constructor(layers, picture, run) {
    Object.assign(this, { layers, picture, run, timeline: new Timeline() });
    this.R = picture.radius;
    this.u = picture.unit;
    layers.replaceChildren();
    layers.style.setProperty('--u', this.u);
    // Moving parts have separate layers, because repainting a large picture is slow.
    for (const names of [['roads', 'stubs'], ['under', 'now'], ['vertices', 'marks'], ['over', 'robot']]) {
      const svg = draw('svg', { preserveAspectRatio: 'xMidYMid meet', 'aria-hidden': 'true' }, layers);
      for (const name of names) this[name] = draw('g', { class: name }, svg);
    }
  }

  centre(dart) {
    return this.picture.centres[dart < 0 ? 0 : this.picture.vertex[dart]];
  }

  path(data, className, parent) {
    return draw('path', { d: data, class: className }, parent);
  }

  ring([x, y], className, parent, extra = 8) {
    return draw('circle', { cx: x, cy: y, r: this.R + extra * this.u, class: className }, parent);
  }

  marker(parent) {
    const { root } = this.picture;
    if (root === null) return;
    const [x, y] = this.centre(root), angle = this.picture.angle(root);
    const ends = [0, 10, 24].map((far) => this.R + far * this.u).map((far) => [x + far * Math.cos(angle), y + far * Math.sin(angle)]);
    draw('title', {}, drawMarker(parent, ...ends), 'The marker: the only thing that the robot can recognise');
  }

  makeRobot() {
    this.tick = this.path('', 'tick', this.robot);
    this.bot = drawRobot(this.robot, Math.max(this.R * 0.95, 9 * this.u));
  }

  /** Put the robot at a reference dart of the world: the tick shows the dart, the nose looks away. */
  place(dart, start) {
    const [x, y] = this.centre(dart);
    let angle = 0;
    if (dart < 0) this.tick.setAttribute('d', '');
    else {
      angle = this.picture.angle(dart) + (start ? 0 : Math.PI);
      const trail = this.picture.trail(dart);
      this.tick.setAttribute('d', trail.piece(this.R, Math.min(this.R + 11 * this.u, trail.length / 2)));
    }
    this.bot.setAttribute('transform', `translate(${x} ${y}) rotate(${(angle * 180) / Math.PI})`);
  }

  /** Let the robot come along the edge of a dart. */
  glide(dart, milliseconds, arrived) {
    const trail = this.picture.trail(dart);
    const begin = performance.now();
    this.tick.setAttribute('d', '');
    const frame = (now) => {
      const t = Math.min(1, Math.max(0, now - begin) / milliseconds);
      const { x, y, angle } = trail.at(t * t * (3 - 2 * t) * trail.length);
      this.bot.setAttribute('transform', `translate(${x} ${y}) rotate(${(angle * 180) / Math.PI})`);
      if (t < 1) this.moving = requestAnimationFrame(frame);
      else arrived();
    };
    this.moving = requestAnimationFrame(frame);
  }

  settle() {
    cancelAnimationFrame(this.moving);
  }

  /** Ring the places that the fold of the history has just found to be places seen before. */
  identified(when, parent) {
    for (const dart of this.run.recorded.identified[when] ?? []) this.ring(this.centre(dart), 'ring same', parent, 5);
  }

  setRobot(when, animate) {
    const { run } = this;
    this.settle();
    const at = run.position[when];
    const lost = run.illegal !== null && when >= run.illegal;
    this.robot.classList.toggle('lost', lost);
    if (lost) return this.place(run.position[run.illegal - 1], false);
    const stand = () => this.place(at, when === 0);
    if (animate && run.left[when] >= 0) this.glide(run.left[when], animate, stand);
    else stand();
  }

  bridges(known) {
    for (const [data, over, under] of this.picture.bridges) {
      const halo = this.path(data, 'halo', this.roads);
      const road = this.path(data, 'road', this.roads);
      known(halo, road, over, under);
    }
  }
}
