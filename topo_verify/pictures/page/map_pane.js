/* The pane of S. */

/** S: what the mapper has declared, and the question that it is about. */
class MapPane extends Pane {
  constructor(layers, picture, run) {
    super(layers, picture, run);
    const { map } = run;
    const shown = (element, from, to = Infinity) => {
      element.classList.add('off');
      this.timeline.add(from, (on) => element.classList.toggle('off', !on));
      this.timeline.add(to, (on) => element.classList.toggle('off', on));
    };
    const roads = this.roads;
    let cut = Infinity; // the first edge that leaves the polygon of a cut surface
    const crossed = (dart, when) => picture.crosses(dart) && (cut = Math.min(cut, when));
    if (run.silent) {
      run.walked.forEach((when, edge) => {
        shown(this.path(picture.trail(picture.edges[edge][0]).data, 'road', roads), when);
        crossed(picture.edges[edge][0], when);
      });
    }
    const joined = new Map();
    for (const { a, b, when, real } of map.edges) {
      if (real) joined.set(picture.edgeOf[map.darts[a].image], when), crossed(map.darts[a].image, when);
      const data = real ? picture.trail(map.darts[a].image).data : this.arc(this.end(a), this.end(b));
      const road = this.path(data, real ? 'road' : 'road wrong', roads);
      if (!real) draw('title', {}, road, 'The map joins these two ends; in the world they belong to two edges');
      shown(road, when);
    }
    shown(picture.drawSides(roads), cut);
    this.bridges((halo, road, over, under) => {
      const when = Math.max(joined.get(over) ?? Infinity, joined.get(under) ?? Infinity);
      shown(halo, when);
      shown(road, when);
    });
    this.names = draw('g', { class: 'names' }, this.over);
    map.darts.forEach(({ image, born, joined: gone }, dart) => {
      if (image < 0) return;
      const g = draw('g', { class: 'stub' }, this.stubs);
      this.path(picture.trail(image).piece(this.R, picture.stub(image)), '', g);
      const [cx, cy] = this.end(dart);
      draw('circle', { cx, cy, r: 4 * this.u }, g);
      shown(g, born, gone);
      shown(this.name(dart, this.names), born);
    });
    for (const { entry, born, twin } of map.vertices) {
      const g = draw('g', { class: twin ? 'vertex twin' : 'vertex' }, this.vertices);
      const [x, y] = this.centre(entry);
      const shift = twin ? 0.8 * this.R : 0;
      draw('circle', { cx: x + shift, cy: y - shift, r: this.R }, g);
      if (twin) draw('title', {}, g, 'The map has this vertex of the world twice');
      shown(g, born);
    }
    if (run.silent) this.visited(shown);
    this.records(shown);
    this.marker(this.marks);
    this.recent = this.path('', 'recent', this.under);
    this.moment = draw('g', {}, this.over);
    this.asked = null; // the question that is shown
    this.named = draw('g', {}, this.over);
    this.ways = draw('g', {}, this.under);
    this.makeRobot();
    this.timeline.ready();
  }

  visited(shown) {
    const seen = new Set();
    this.run.position.forEach((dart, when) => {
      if (dart < 0 || seen.has(this.picture.vertex[dart])) return;
      seen.add(this.picture.vertex[dart]);
      const [cx, cy] = this.centre(dart);
      const g = draw('g', { class: 'vertex' }, this.vertices);
      draw('circle', { cx, cy, r: this.R }, g);
      shown(g, when);
    });
  }

  /** A diamond behind each unexplored dart of which a record is kept. */
  records(shown) {
    const kept = this.run.events.flatMap(({ records = [] }, when) => records.map((dart) => [when, dart]));
    for (const [when, dart] of kept) {
      const [x, y] = this.end(dart);
      const s = 7 * this.u;
      const data = `M${x} ${y - s}L${x + s} ${y}L${x} ${y + s}L${x - s} ${y}Z`;
      const mark = this.path(data, 'record', this.marks);
      draw('title', {}, mark, 'A record: what was seen behind this unexplored dart');
      shown(mark, when, this.run.map.darts[dart].joined);
    }
  }

  /** Where the drawn part of an unexplored dart of S ends. */
  end(dart, more = 0) {
    const { image, vertex } = this.run.map.darts[dart];
    if (image < 0) return this.picture.centres[0];
    const p = this.picture.trail(image).at(this.picture.stub(image) + more);
    const shift = this.run.map.vertices[vertex].twin ? 0.8 * this.R : 0;
    return [p.x + shift, p.y - shift];
  }

  /** The number of a dart of S, beside its beginning; farther out, where the next darts are close. */
  name(dart, parent) {
    const { picture, u } = this, { image } = this.run.map.darts[dart], degree = picture.vertices[picture.vertex[image]].length;
    const at = (one, far) => picture.trail(one).at(this.R + far * u);
    const beside = [1, degree - 1].map((door) => picture.turn(image, door)).filter((one) => one !== image);
    const apart = (far) => beside.every((one) => Math.hypot(at(one, far).x - at(image, far).x, at(one, far).y - at(image, far).y) > 12 * u);
    const p = at(image, [9, 14, 19].find(apart) ?? 9);
    const aside = p.angle + Math.PI / 2;
    const [x, y] = [p.x + 8 * this.u * Math.cos(aside), p.y + 8 * this.u * Math.sin(aside)];
    return draw('text', { x, y, 'font-size': 12 * this.u, class: 'dart' }, parent, String(dart));
  }

  arc([x, y], [u, v], bend = 0.18) {
    const [dx, dy] = [u - x, v - y];
    const long = Math.hypot(dx, dy) || 1;
    const aside = Math.min(30 * this.u, long * bend);
    const via = [(x + u) / 2 - (dy / long) * aside, (y + v) / 2 + (dx / long) * aside];
    return `M${short(x)} ${short(y)}Q${short(via[0])} ${short(via[1])} ${short(u)} ${short(v)}`;
  }

  show(when, animate) {
    const { run, picture } = this;
    this.when = when;
    this.timeline.seek(when);
    this.moment.replaceChildren();
    this.ways.replaceChildren();
    const round = run.rounds[when];
    const asking = (round && run.map.darts[round.edge] && when < round.to ? round : null) ?? this.leaving(when);
    this.robot.classList.toggle('off', Boolean(asking));
    const one = run.events[when];
    this.ask(asking, when);
    if (!asking) this.setRobot(when, animate);
    if (one.type === 'augment') this.grown(one);
    this.named.replaceChildren();
    if (run.findingsAt(when).length) {
      const truth = run.map.darts.findIndex((dart) => dart.image === picture.other[run.map.darts[one.edge]?.image]);
      for (const dart of new Set([one.edge, one.hypothesis, one.dart, truth, ...(one.hypotheses ?? [])])) {
        if (run.map.darts[dart]?.image >= 0 && run.map.darts[dart].born <= when) this.name(dart, this.named);
      }
    }
  }

  /** Show a round's question. It is kept during the round, since making it is slow. */
  ask(round, when) {
    const { run } = this;
    const same = round && this.asked?.round.edge === round.edge && this.asked.round.from === round.from;
    if (!same) {
      this.asked?.remove();
      this.asked = round && run.map.darts[round.edge].image >= 0 ? new Question(this, round) : null;
    }
    if (!this.asked) return;
    const tested = run.tested(when);
    this.asked.show(when, tested);
    const one = run.events[when];
    if (one.type === 'reject') this.evidence(when, tested, this.asked.at);
    else if (tested) this.walk(run.word(when), tested, one.type !== 'confirm' ? '' : run.isWrong(when) ? 'bad' : 'good');
  }

  /** A question without guesses: a move leaves S by an unexplored dart, and nothing is said yet. */
  leaving(when) {
    const { map, left } = this.run;
    const edge = left[when] < 0 ? -1 : map.darts.findIndex((dart) => dart.image === left[when]);
    return edge >= 0 && map.isOpen(edge, when) && !this.run.silent ? { edge, from: -1, hypotheses: [] } : null;
  }

  /** The doors walked so far, from a hypothesis on: where the robot would be if it were true. */
  walk(doors, hypothesis, kind) {
    const { map } = this.run;
    const { left, at, rest } = map.trace(hypothesis.dart, doors, this.when);
    for (const dart of left) this.band(dart, `way home ${kind}`);
    if (rest.length) return;
    this.ring(this.centre(map.darts[at].image), `ghost ${kind}`, this.moment);
  }

  band(dart, kind, parent = this.ways) {
    const { image, joined } = this.run.map.darts[dart];
    if (image < 0) return;
    const trail = this.picture.trail(image);
    this.path(joined > this.when ? trail.piece(this.R, this.picture.stub(image)) : trail.data, kind, parent);
  }

  evidence(when, tested, at) {
    const { run } = this;
    const one = run.events[when];
    const found = run.evidence(when);
    if (!found || !tested) return;
    const { believed } = found;
    if (one.rule === 'folding' || one.rule === 'planar') {
      this.path(this.arc(at, this.end(tested.dart)), 'guess bad', this.moment);
      if (one.rule === 'planar') for (const dart of run.map.face(one.edge, when)) this.band(dart, 'face');
      for (const dart of run.told(when) ?? []) {
        if (run.map.vertices.some((v) => v.born <= when && this.centre(v.entry) === this.centre(dart))) {
          this.ring(this.centre(dart), 'ring', this.moment);
        }
      }
      return;
    }
    for (const dart of believed.left) this.band(dart, 'way bad');
    if (believed.rest.length) {
      const [cx, cy] = this.end(believed.at);
      draw('circle', { cx, cy, r: 12 * this.u, class: 'ring would' }, this.moment);
    } else this.ring(this.centre(run.map.darts[believed.at].image), 'ring would', this.moment);
  }

  /** What an augmentation has just added. */
  grown(one) {
    const dart = this.run.map.darts[one.dart];
    if (!dart || dart.image < 0) return;
    this.ring(this.centre(dart.image), one.kind === 'new' ? 'ring truth' : 'ring fresh', this.moment, 6);
  }
}
