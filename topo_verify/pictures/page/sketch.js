/* A quick picture of any rotation system: every dart leaves its vertex at its own angle, clockwise
   in the order of the rotation, so the order at each vertex is true. Of several sketches the one in
   which the fewest roads cross is taken.

   Where vertices stand is found by pulling: each road wants to be straight and one long, each
   vertex turns to face its neighbours. What stood before hardly moves, so a growing map keeps its
   shape. */

const LONG = 100; // a road
const ROUND = 17; // the radius of a vertex
const STRAIGHT = 0.75; // of the way from even angles to straight roads

class Sketch {
  /** @param spots where its first vertices stand at the start. */
  constructor(vertices, alpha, spots = []) {
    Object.assign(this, { vertices, alpha, spots: [] });
    this.owner = new Map();
    vertices.forEach((rotation, v) => rotation.forEach((dart, place) => this.owner.set(dart, [v, place])));
    vertices.forEach((rotation, v) => this.spots.push({ ...(spots[v] ?? this.beside(v)) }));
    this.face(1);
    for (let round = 0; round < 160; round += 1) this.pull(0.35 * (1 - round / 200));
    this.straighten();
  }

  /** The sketch with the fewest crossings: grown from the one before, or with a face outside. */
  static best(vertices, alpha, before) {
    let best = new Sketch(vertices, alpha, before?.spots), fewest = best.crossings();
    for (const start of fewest >= 1 ? best.faces().map((face) => best.inside(face)) : []) {
      const other = new Sketch(vertices, alpha, start), number = other.crossings();
      if (number < fewest) [best, fewest] = [other.turnedLike(before?.spots ?? []), number];
    }
    // Of a small planar map: it takes long, and another one has to cross.
    if (alpha.size < 20 && vertices.length - alpha.size / 2 + best.faces().length === 2) best.untwist();
    return best;
  }

  /** Three times, move and turn each vertex a little while fewer roads cross, or they are shorter. */
  untwist() {
    let least = this.crossings();
    for (const spot of this.spots.concat(this.spots, this.spots)) {
      let best = { ...spot };
      const { x, y, turn } = spot;
      for (let k = 0; k < 72 && least >= 1; k += 1) {
        const far = 40 * (k % 3);
        Object.assign(spot, { x: x + far * Math.cos(k), y: y + far * Math.sin(k), turn: turn + 2.4 * k });
        this.straighten();
        const number = this.crossings();
        if (number < least) [least, best] = [number, { ...spot }];
      }
      Object.assign(spot, best);
    }
    this.straighten();
  }

  /** The vertices along each face, in the directions of its roads. */
  faces() {
    const seen = new Set();
    return [...this.alpha.keys()].map((dart) => {
      const face = new Set();
      while (!seen.has(dart)) {
        seen.add(dart);
        face.add(this.owner.get(dart)[0]);
        const [v, place] = this.owner.get(this.alpha.get(dart)), rotation = this.vertices[v];
        dart = [...rotation.slice(place + 1), ...rotation].find((next) => this.alpha.has(next));
      }
      return [...face];
    }).filter((face) => face.length);
  }

  /** These vertices on a circle, each other one in the middle of its neighbours (Tutte's drawing). */
  inside(face) {
    const spots = this.vertices.map(() => ({ x: 0, y: 0, turn: 0 })), radius = (LONG * Math.max(face.length, 3)) / 5;
    face.forEach((v, k) => {
      const angle = (2 * Math.PI * k) / face.length;
      Object.assign(spots[v], { x: radius * Math.cos(angle), y: radius * Math.sin(angle) });
    });
    const near = this.vertices.map((rotation) => rotation.filter((dart) => this.alpha.has(dart)).map((dart) => spots[this.owner.get(this.alpha.get(dart))[0]]));
    const mean = (v, c) => near[v].reduce((sum, spot) => sum + spot[c], 0) / near[v].length;
    for (let round = 0; round < 80; round += 1) {
      spots.forEach((spot, v) => face.includes(v) || Object.assign(spot, { x: mean(v, 'x'), y: mean(v, 'y') }));
    }
    return spots;
  }

  /** Turned as a whole, so that its vertices lie about where they were. */
  turnedLike(spots) {
    const { spots: mine } = this, [old] = spots, { x, y } = mine[0];
    let [sin, cos] = [0, 0];
    spots.forEach((spot, v) => {
      const [a, b, c, d] = [mine[v].x - x, mine[v].y - y, spot.x - old.x, spot.y - old.y];
      sin += a * d - b * c, cos += a * c + b * d;
    });
    const turn = Math.atan2(sin, cos), [s, c] = [Math.sin(turn), Math.cos(turn)];
    for (const spot of mine) Object.assign(spot, { x: c * spot.x - s * spot.y, y: s * spot.x + c * spot.y, turn: spot.turn + turn });
    return this;
  }

  /** How often two roads cross, a road runs over a vertex, or two vertices are near; and a millionth of their length. */
  crossings() {
    const side = ([a, b], [c, d], [e, f]) => (c - a) * (f - b) - (d - b) * (e - a);
    const roads = [...this.alpha].filter(([a, b]) => a < b).map(([dart]) => {
      const [points] = flattened(this.road(dart));
      return points.slice(1).map((point, n) => [points[n], point]);
    });
    let number = 0;
    this.spots.forEach((one, v) => {
      for (const two of this.spots.slice(0, v)) number += Math.hypot(one.x - two.x, one.y - two.y) < 3.5 * ROUND;
    });
    roads.forEach((road, k) => {
      for (const [a, b] of road) {
        number += Math.hypot(a[0] - b[0], a[1] - b[1]) / 1e6;
        for (const { x, y } of this.spots) number += Math.hypot(a[0] - x, a[1] - y) < 0.9 * ROUND;
        for (const [c, d] of roads.slice(0, k).flat()) number += side(a, b, c) * side(a, b, d) < 0 && side(c, d, a) * side(c, d, b) < 0;
      }
    });
    return number;
  }

  /** Where a new vertex stands: at the end of its first road to one that stands already. */
  beside(v) {
    const dart = this.vertices[v].find((one) => this.alpha.has(one) && this.owner.get(this.alpha.get(one))[0] < v);
    if (dart === undefined) return { x: 0, y: 0, turn: 0 };
    const from = this.alpha.get(dart), angle = this.angle(from), spot = this.spots[this.owner.get(from)[0]];
    const place = this.owner.get(dart)[1];
    const turn = angle + Math.PI - (2 * Math.PI * place) / this.vertices[v].length;
    return { x: spot.x + LONG * Math.cos(angle), y: spot.y + LONG * Math.sin(angle), turn };
  }

  /** The direction in which a dart leaves its vertex; y grows downwards, so this is clockwise. */
  angle(dart) {
    const [v, place] = this.owner.get(dart);
    return this.spots[v].turn + (2 * Math.PI * place) / this.vertices[v].length + (this.off?.get(dart) ?? 0);
  }

  /** By which angle each road at a vertex would have to turn to leave straight for its other end. */
  turns(v) {
    return this.vertices[v].flatMap((dart, place) => {
      const [w] = this.owner.get(this.alpha.get(dart)) ?? [v], [one, two] = [this.spots[v], this.spots[w]];
      const turn = Math.atan2(two.y - one.y, two.x - one.x) - this.angle(dart);
      return w === v ? [] : [[place, Math.atan2(Math.sin(turn), Math.cos(turn))]];
    });
  }

  /** Turn each vertex a part of the way towards its neighbours. */
  face(part) {
    this.spots.forEach((spot, v) => {
      const turns = this.turns(v), sum = (part) => turns.reduce((all, [, turn]) => all + part(turn), 0);
      const [sin, cos] = [sum(Math.sin), sum(Math.cos)];
      if (Math.hypot(sin, cos) > 0.01) spot.turn += part * Math.atan2(sin, cos);
    });
  }

  pull(strength) {
    const moves = this.spots.map(() => ({ x: 0, y: 0, n: 0 }));
    for (const [dart, other] of this.alpha) {
      const [v] = this.owner.get(dart), [w] = this.owner.get(other);
      if (v === w) continue;
      const [a, b] = [this.angle(dart), this.angle(other)];
      const [one, two] = [this.spots[v], this.spots[w]];
      // Half from where it is wanted by this dart, half by the other one.
      const [x, y] = [Math.cos(a) - Math.cos(b), Math.sin(a) - Math.sin(b)];
      const far = Math.atan2(two.y - one.y, two.x - one.x);
      const wanted = Math.hypot(x, y) < 0.9 ? far : Math.atan2(y, x);
      moves[w].x += one.x + LONG * Math.cos(wanted) - two.x;
      moves[w].y += one.y + LONG * Math.sin(wanted) - two.y;
      moves[w].n += 1;
    }
    this.face(0.5 * strength);
    this.spots.forEach((one, v) => {
      const { x, y, n } = moves[v];
      if (v && n) one.x += (strength * x) / n, one.y += (strength * y) / n;
      for (const other of this.spots) {
        const [dx, dy] = [one.x - other.x, one.y - other.y], gap = Math.hypot(dx, dy);
        if (other === one || gap > 0.85 * LONG) continue;
        const push = (0.85 * LONG - gap) / 2, away = gap > 1 ? Math.atan2(dy, dx) : v;
        if (v) one.x += push * Math.cos(away), one.y += push * Math.sin(away);
      }
    });
  }

  /** Where the neighbours lie in the order of the rotation, turn roads most of the way towards them. */
  straighten() {
    const off = new Map();
    this.off = null;
    this.vertices.forEach((rotation, v) => {
      const degree = rotation.length, turns = this.turns(v);
      const gaps = turns.map(([place, turn], k) => {
        const [next, last] = turns[(k + 1) % turns.length];
        return { place, places: ((next - place + degree - 1) % degree) + 1, turn, more: last - turn };
      });
      if (gaps.some(({ places, more }) => more < (-1.99 * Math.PI * places) / degree)) return;
      for (const { place, places, turn, more } of gaps) {
        for (let n = 0; n < places; n += 1) off.set(rotation[(place + n) % degree], STRAIGHT * (turn + (more * n) / places));
      }
    });
    this.off = off;
  }

  /** A point at this distance from the centre of a dart's vertex, along the dart. */
  out(dart, distance, turn = 0) {
    const { x, y } = this.spots[this.owner.get(dart)[0]], angle = this.angle(dart) + turn;
    return [x + distance * Math.cos(angle), y + distance * Math.sin(angle)];
  }

  /** Path data of the road of a dart. */
  road(dart) {
    const other = this.alpha.get(dart);
    const [v, place] = this.owner.get(dart), [w, there] = this.owner.get(other);
    const gap = Math.hypot(this.spots[v].x - this.spots[w].x, this.spots[v].y - this.spots[w].y);
    if (v === w) return this.loop(dart, other, there - place, this.vertices[v].length);
    const bow = ROUND + Math.max(0.36 * gap, 32);
    const [p, q, r, s] = [this.out(dart, ROUND), this.out(dart, bow), this.out(other, bow), this.out(other, ROUND)];
    return `M${pair(p)}C${pair(q)} ${pair(r)} ${pair(s)}`;
  }

  /** Path data of a loop: around the fewest roads to other places; there it is large, to hold them. */
  loop(dart, other, places, degree) {
    const ahead = (places + degree) % degree, [v, place] = this.owner.get(dart), leads = [0, 0];
    for (const [there] of this.turns(v)) leads[+((there - place + degree) % degree > ahead)] += 1;
    const way = (leads[0] - leads[1] || 2 * ahead - degree) <= 0 ? 1 : -1;
    const half = (Math.PI * (way > 0 ? ahead : degree - ahead)) / degree;
    const far = Math.min(...leads) ? 1.4 * LONG : ROUND + 20 + 26 * half;
    const [x, y] = this.out(dart, far, way * half), tangent = this.angle(dart) + way * (half + Math.PI / 2);
    const reach = 0.75 * far * Math.min(half, 1.2);
    const [dx, dy] = [reach * Math.cos(tangent), reach * Math.sin(tangent)];
    const [p, q, r, s] = [this.out(dart, ROUND), this.out(dart, 0.8 * far), this.out(other, 0.8 * far), this.out(other, ROUND)];
    return `M${pair(p)}C${pair(q)} ${pair([x - dx, y - dy])} ${pair([x, y])}C${pair([x + dx, y + dy])} ${pair(r)} ${pair(s)}`;
  }

  /** Draw it into an SVG element; returns the stubs by their darts. */
  show(svg, { marker = null, kinds = new Map() } = {}) {
    svg.replaceChildren();
    const stubs = new Map();
    for (const [dart, other] of this.alpha) {
      if (dart > other) continue;
      const road = draw('path', { class: `road ${kinds.get(dart) ?? kinds.get(other) ?? ''}`, d: this.road(dart) }, svg);
      road.dataset.darts = `${dart} ${other}`;
    }
    for (const dart of this.owner.keys()) {
      if (this.alpha.has(dart)) continue;
      const group = draw('g', { class: 'stub', 'data-dart': dart }, svg);
      draw('path', { d: `M${pair(this.out(dart, ROUND))}L${pair(this.out(dart, 2 * ROUND))}` }, group);
      const [cx, cy] = this.out(dart, 2.35 * ROUND);
      draw('circle', { cx, cy, r: 6 }, group);
      stubs.set(dart, { group, at: [cx, cy] });
    }
    if (marker !== null) drawMarker(svg, ...[1, 1.3, 1.98].map((far) => this.out(marker, far * ROUND)));
    for (const { x, y } of this.spots) draw('circle', { cx: x, cy: y, r: ROUND }, draw('g', { class: 'vertex' }, svg));
    const room = 2 * ROUND, box = svg.getBBox(), [left, top] = [box.x - room, box.y - room];
    const [wide, high] = [box.width + 2 * room, box.height + 2 * room];
    const [width, height] = [Math.max(wide, 4 * LONG), Math.max(high, 2.4 * LONG)];
    svg.setAttribute('viewBox', [left - (width - wide) / 2, top - (height - high) / 2, width, height].map(short).join(' '));
    return stubs;
  }
}

/** The sketch of a world as in its file. */
const sketchOf = ({ vertices, edges }, before = null) => {
  const alpha = new Map();
  for (const [a, b] of edges) alpha.set(a, b).set(b, a);
  return Sketch.best(vertices, alpha, before);
};

/* Build a world: roads are put into corners, the gaps between neighbouring exits of a place, so that
   every change gives a rotation system again, and every rotation system can be built. */

class Builder {
  constructor(mode) {
    Object.assign(this, { mode, book: new Sketchbook(), past: [], corner: null, sketch: null });
    this.show();
  }

  change(book) {
    this.past.push(this.book);
    Object.assign(this, { book, corner: null });
    this.show();
  }

  show() {
    const { left, right } = this.mode, { book } = this, world = book.world;
    left.title.textContent = 'Your world';
    left.note.textContent = world.words;
    const grown = this.sketch && this.sketch.vertices.length <= book.vertices.length;
    this.sketch = sketchOf(book, grown ? this.sketch : null);
    this.sketch.show(left.svg, { marker: book.marker });
    book.corners().forEach((corner, k) => this.handle(corner, k));
    right.title.textContent = 'Its rotations';
    right.note.textContent = 'the exits of each place, clockwise; equal numbers are one road';
    this.rotations(right.svg);
    this.row();
  }

  /** The handle of a corner: halfway between the dart before it and the dart behind it. */
  handle([v, place], k) {
    const degree = this.book.vertices[v].length, { x, y, turn } = this.sketch.spots[v];
    const angle = turn + (2 * Math.PI * (place - 0.5)) / Math.max(degree, 1), far = degree ? 1.62 * ROUND : 0;
    const [cx, cy] = [x + far * Math.cos(angle), y + far * Math.sin(angle)];
    const chosen = this.corner && this.corner.join() === [v, place].join();
    const group = this.mode.press(this.mode.left.svg, `corner${chosen ? ' chosen' : ''}`, `Corner ${k + 1}, at place ${v + 1}`, `${k + 1}`, () => this.press([v, place]));
    draw('circle', { cx, cy, r: Math.min(8, 30 / Math.max(degree, 1) + 3) }, group);
  }

  /** The first corner is chosen; the second one gets a road from it; the same again: a loop. */
  press(corner) {
    if (this.corner) return this.change(this.book.withEdge(this.corner, corner));
    this.corner = corner;
    this.show();
  }

  rotations(svg) {
    svg.replaceChildren();
    const rows = this.book.vertices.map((rotation, v) => `${v + 1}:  ${rotation.map((dart) => `${(dart >> 1) + 1}${dart === this.book.marker ? '➤' : ''}`).join('  ') || 'no exit'}`);
    svg.setAttribute('viewBox', `0 0 400 ${Math.max(240, 24 * rows.length + 30)}`);
    rows.forEach((row, k) => draw('text', { x: 20, y: 30 + 24 * k, fill: 'currentColor', 'font-size': 16 }, svg, row));
  }

  row() {
    const { mode, book } = this, { says } = mode;
    says.className = 'card says';
    says.replaceChildren();
    html('h3', '', says, this.corner ? 'Where does the new road end?' : 'Choose the corner where a new road begins');
    html('p', '', says, this.corner ? 'In another corner; in the same one for a loop; or at a new place.' : 'The dotted handles are the corners between the exits of a place.');
    const row = html('div', 'bar', says);
    const corner = () => this.corner;
    mode.button(row, 'At a new place', 'n', () => this.change(book.withEdge(corner(), null))).disabled = !this.corner;
    mode.button(row, 'Marker here', 'm', () => this.change(book.withMarker(corner()))).disabled = !this.corner || !book.edges.length;
    mode.button(row, 'Undo', 'u', () => this.undo()).disabled = !this.past.length && !this.corner;
    const walk = mode.button(row, 'Walk it', '↵', () => mode.begin(book.world));
    walk.classList.add('main');
    walk.disabled = !book.edges.length;
  }

  undo() {
    if (this.corner) this.corner = null;
    else this.book = this.past.pop();
    this.show();
  }
}
