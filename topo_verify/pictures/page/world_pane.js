/* The pane of the world, and of a witness. */

/** The world: what the robot knows is solid, what it does not know is dotted. */
class WorldPane extends Pane {
  constructor(layers, picture, run) {
    super(layers, picture, run);
    const edges = new Array(picture.edges.length).fill(Infinity);
    const vertices = new Array(picture.centres.length).fill(Infinity);
    this.known(edges, vertices);
    picture.drawSides(this.roads);
    const far = (element, when) => {
      element.classList.add('far');
      this.timeline.add(when, (on) => element.classList.toggle('far', !on));
    };
    picture.edges.forEach(([dart], edge) => far(this.path(picture.trail(dart).data, 'road', this.roads), edges[edge]));
    this.bridges((halo, road, over) => far(road, edges[over]));
    picture.centres.forEach(([cx, cy], vertex) => {
      const g = draw('g', { class: 'vertex' }, this.vertices);
      draw('circle', { cx, cy, r: this.R }, g);
      if (picture.names) draw('title', {}, g, picture.names[vertex]);
      far(g, vertices[vertex]);
    });
    this.recent = this.path('', 'recent', this.under);
    this.e = this.path('', 'e', this.now);
    this.marker(this.marks);
    this.makeRobot();
    this.timeline.ready();
  }

  /** From which event on each edge and vertex of the world is known: by S, or by walking. */
  known(edges, vertices) {
    const { run, picture } = this;
    const see = (dart, when) => {
      const vertex = dart < 0 ? 0 : picture.vertex[dart];
      vertices[vertex] = Math.min(vertices[vertex], when);
    };
    if (run.silent) {
      run.walked.forEach((when, edge) => (edges[edge] = when));
      run.position.forEach((dart, when) => (dart >= 0 || when === 0) && see(dart, when));
      return;
    }
    run.map.vertices.forEach(({ entry, born }) => see(entry, born));
    for (const { a, when, real } of run.map.edges) {
      if (real) edges[picture.edgeOf[run.map.darts[a].image]] = when;
    }
  }

  show(when, animate) {
    const { run, picture } = this;
    this.timeline.seek(when);
    this.over.replaceChildren();
    const trails = [];
    for (let k = when; k > 0 && k > when - 40 && trails.length < 6; k -= 1) {
      if (run.left[k] >= 0) trails.push(picture.trail(run.left[k]).data);
    }
    this.recent.setAttribute('d', trails.join(''));
    const one = run.events[when];
    const round = run.rounds[when];
    const image = round ? run.map.darts[round.edge]?.image ?? -1 : -1;
    const crossed = one.type === 'move' && one.purpose === 1 ? run.left[when] : -1;
    const e = image >= 0 ? image : crossed;
    this.e.setAttribute('d', e < 0 ? '' : picture.trail(e).data);
    if (image >= 0) this.ask(picture.other[image]);
    if (one.type === 'reject') this.evidence(when);
    if (run.findingsAt(when).length) this.truth(one);
    this.identified(when, this.over);
    this.setRobot(when, animate);
  }

  ask(dart) {
    const [x, y] = this.centre(dart);
    this.ring([x, y], 'ask', this.over, 5);
    const [dx, dy] = [this.R + 9 * this.u, -this.R - 5 * this.u];
    draw('text', { x: x + dx, y: y + dy, class: 'what', 'font-size': 17 * this.u }, this.over, '?');
  }

  evidence(when) {
    const { run, picture } = this;
    const found = run.evidence(when), told = run.told(when);
    if (!found) return;
    const { real, believed } = found;
    if (told) return told.forEach((dart) => this.ring(this.centre(dart), 'ring', this.over));
    const one = run.events[when];
    if (one.rule === 'planar' || one.rule === 'folding') return this.face(one, when);
    for (const dart of real.left) this.path(picture.trail(dart).data, 'way bad', this.over);
    this.ring(this.centre(real.at), 'ring', this.over);
    const would = believed.rest.length ? this.recorded(believed) : run.map.darts[believed.at].image;
    if (would >= 0) this.ring(this.centre(would), 'ring would', this.over, 13);
  }

  /** Where a record was made: the end of the doors behind an unexplored dart. */
  recorded({ at, rest }) {
    return this.run.follow(this.run.map.beyond(at), rest.slice(1)).at;
  }

  face(one, when) {
    const { map } = this.run;
    if (one.rule === 'planar' && map.darts[one.edge]) {
      for (const dart of map.face(one.edge, when)) {
        this.path(this.picture.trail(map.darts[dart].image).piece(this.R, this.picture.stub(map.darts[dart].image)), 'face', this.under);
      }
    }
    const h = map.darts[one.hypothesis];
    if (h && h.image >= 0) this.ring(this.centre(h.image), 'ring', this.over);
  }

  /** At a finding: the real other end of the edge that a decision is about. */
  truth(one) {
    const dart = this.run.map.darts[one.edge];
    if (!dart || dart.image < 0) return;
    const end = this.picture.other[dart.image];
    const trail = this.picture.trail(dart.image);
    this.path(trail.piece(this.R, trail.length - this.R), 'way truth', this.over);
    this.ring(this.centre(end), 'ring truth', this.over, 12);
  }
}
