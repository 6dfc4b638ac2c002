/* A world that a reader walks, and what is needed of it: percepts, doors, costs; and new worlds. */

/** A number of things in words. */
const many = (count, thing) => `${count} ${thing}${count === 1 ? '' : 's'}`;

/** A rotation system: {vertices, edges, marker}, as in a world file. The marker is a dart or null.
    `drawn`: its drawing, if the page has one. */
class WalkWorld {
  constructor({ vertices, edges, marker, drawn }) {
    Object.assign(this, { vertices, edges, marker, drawn });
    this.vertex = new Map();
    this.other = new Map();
    vertices.forEach((rotation, v) => rotation.forEach((dart) => this.vertex.set(dart, v)));
    for (const [a, b] of edges) this.other.set(a, b).set(b, a);
  }

  /** The dart that a door means to a robot with this reference dart. */
  turn(dart, door) {
    const rotation = this.vertices[this.vertex.get(dart)];
    return rotation[(rotation.indexOf(dart) + door) % rotation.length];
  }

  /** What a robot with this reference dart sees; null is the only vertex of a world without edges. */
  seen(dart) {
    if (dart === null) return { degree: 0, marker: null };
    const rotation = this.vertices[this.vertex.get(dart)];
    const [here, there] = [rotation.indexOf(dart), rotation.indexOf(this.marker)];
    const degree = rotation.length;
    return { degree, marker: there < 0 ? null : (there - here + degree) % degree };
  }

  /** How many handles the surface has. */
  genus() {
    const left = new Set(this.other.keys());
    let faces = 0;
    for (const first of left) {
      faces += 1;
      for (let dart = first; left.delete(dart); ) dart = this.turn(this.other.get(dart), 1);
    }
    faces = Math.max(faces, 1);
    return (2 - this.vertices.length + this.edges.length - faces) / 2;
  }

  get words() {
    return `${many(this.vertices.length, 'place')}, ${many(this.edges.length, 'road')}, genus ${this.genus()}`;
  }

  /** The least cost of a proof of this world (world/least_cost.py says why). */
  leastCost() {
    if (this.marker === null) return 0;
    const start = this.vertex.get(this.marker);
    const depth = new Map([[start, 0]]), parent = new Map(), tree = new Set(), order = [start];
    for (const v of order) // it grows
      for (const dart of this.vertices[v]) {
        const w = this.vertex.get(this.other.get(dart));
        if (depth.has(w)) continue;
        depth.set(w, depth.get(v) + 1);
        parent.set(w, v);
        tree.add(dart).add(this.other.get(dart));
        order.push(w);
      }
    const loops = this.edges.filter(([a]) => !tree.has(a)).map((edge) => edge.map((dart) => this.vertex.get(dart)));
    const core = new Set([start]);
    for (let v of loops.flat()) for (; !core.has(v); v = parent.get(v)) core.add(v);
    const attached = new Map(), pendant = order.filter((v) => !core.has(v));
    for (const v of order) attached.set(v, core.has(v) ? depth.get(v) : attached.get(parent.get(v)));
    const saved = Math.max(0, ...pendant.map((v) => depth.get(v) - 2 * attached.get(v)));
    const closing = loops.reduce((sum, [u, v]) => sum + depth.get(u) + 1 + depth.get(v), 0);
    return closing + 2 * pendant.length - saved;
  }
}

/** A world under construction: edges are put into corners. Each change gives a new one. */
class Sketchbook {
  constructor(vertices = [[]], edges = [], marker = null) {
    Object.assign(this, { vertices, edges, marker });
  }

  get world() {
    return new WalkWorld(this);
  }

  /** The corners: [vertex, place]; a new dart comes before the dart at that place. */
  corners() {
    return this.vertices.flatMap((rotation, v) => (rotation.length ? rotation.map((_, k) => [v, k]) : [[v, 0]]));
  }

  /** With a new edge from one corner to another, or to a new vertex (`to` is null). */
  withEdge(from, to) {
    const [a, b] = [2 * this.edges.length, 2 * this.edges.length + 1];
    const vertices = this.vertices.map((rotation) => rotation.slice());
    const put = ([v, place], dart) => vertices[v].splice(place, 0, dart);
    if (to === null) vertices.push([b]);
    else if (to[0] === from[0] && to[1] < from[1]) return this.withEdge(to, from);
    else put(to, b);
    put(from, a); // the later place first, so that the earlier one keeps its number
    return new Sketchbook(vertices, [...this.edges, [a, b]], this.marker ?? a);
  }

  /** With the marker at the dart behind a corner. */
  withMarker([v, place]) {
    return new Sketchbook(this.vertices, this.edges, this.vertices[v][place] ?? this.marker);
  }
}

/** A generator of numbers from 0 to below 1, the same for the same seed (mulberry32). */
function lots(seed) {
  let state = seed >>> 0;
  return () => {
    state = (state + 0x6d2b79f5) >>> 0;
    let t = Math.imul(state ^ (state >>> 15), state | 1);
    t ^= t + Math.imul(t ^ (t >>> 7), t | 61);
    return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
  };
}

/** A random world with this number of edges, and at most 5 exits at a place. */
function randomWorld(seed, edges) {
  const draw = lots(seed);
  const pick = (list) => list[Math.floor(draw() * list.length)];
  let book = new Sketchbook();
  while (book.edges.length < edges) {
    const { vertices, edges: roads } = book, free = book.corners().filter(([v]) => vertices[v].length < 5);
    const [from, to] = [pick(free), pick(free)], isLoop = from[0] === to[0];
    const fits = 5 * vertices.length - 2 * roads.length > 2 && !(isLoop && vertices[from[0]].length === 4); // and leaves a place free
    book = book.withEdge(from, fits && draw() < 0.5 ? to : null);
  }
  return book.withMarker(pick(book.corners())).world;
}
