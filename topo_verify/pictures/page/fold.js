"use strict";
// The fold of a history: what percepts and doors alone prove, with no world at hand.
//
// A twin of checkers/folding.py, map_on_fold.py and entailment.py, where the words are explained
// (docs/semantics.md, section 11); the tests compare the two. It knows no planar prior.
// A percept is {degree, marker}, its marker a door or null. A place is [node, dart], a dart of one
// visit; several places may be one dart. A world is {vertices, edges, marker}, as in its file.

/** No world shows this history (under the assumption made). */
class Contradiction extends Error {}

function demand(condition, contradiction) {
  if (!condition) throw new Contradiction(contradiction);
}

/** The fold of a history. Grows by `move`; `assuming` looks ahead and returns. */
class Fold {
  constructor(percept) {
    this.nodes = []; // of each visit: percept, parent, offset in it, size, partners of its darts
    this.undo = [];
    this.at = [this.visit(percept), 0]; // where the robot stands: its reference dart
  }

  visit(seen) {
    return this.nodes.push({ seen, parent: null, offset: 0, size: 1, partner: new Map() }) - 1;
  }

  /** Let the robot leave by a door and see this behind it. Throws Contradiction. */
  move(door, percept) {
    const { degree, marker } = percept, exit = [this.at[0], this.at[1] + door];
    demand(door >= 0 && door < this.degree(exit[0]) && degree > 0, "there is no such door");
    demand(marker === null || (marker >= 0 && marker < degree), "the marker points at no door");
    const known = this.partner(exit);
    if (known) this.requireAlike(this.nodes[known[0]].seen, percept);
    this.at = known ?? [this.visit(percept), 0];
    if (marker !== null) this.identify([[this.at[0], this.at[1] + marker], [0, 0]]);
    if (!known) this.join(exit, this.at);
  }

  /** The one place that stands for all that are the same dart. */
  find([node, dart]) {
    for (; this.nodes[node].parent !== null; node = this.nodes[node].parent)
      dart += this.nodes[node].offset;
    const degree = this.degree(node);
    return [node, ((dart % degree) + degree) % degree];
  }

  same(one, other) { return this.find(one).join() === this.find(other).join(); }

  /** The other end of a dart's edge, or null: the dart is open. */
  partner(place) {
    const [node, dart] = this.find(place), end = this.nodes[node].partner.get(dart);
    return end ? this.find(end) : null;
  }

  /** Make the two the ends of one edge, and draw what follows. Throws Contradiction. */
  join(one, other) {
    for (const [place, end] of [[one, other], [other, one]])
      this.identify(...this.lead(this.find(place), end));
  }

  /** Let an edge lead there. Returns the pairs of places that are then one dart: one, or none. */
  lead([node, dart], end) {
    demand(!this.same([node, dart], end), "a dart would be its own other end");
    const known = this.nodes[node].partner.get(dart);
    if (known) return [[known, end]];
    this.nodes[node].partner.set(dart, end);
    this.undo.push([node, dart]);
    return [];
  }

  requireAlike(one, other) {
    const alike = one.degree === other.degree && (one.marker === null) === (other.marker === null);
    demand(alike, "two degrees, or the marker and its absence, at one place");
  }

  /** Make the two places of each pair one dart, and draw what follows. Throws Contradiction. */
  identify(...pairs) {
    while (pairs.length) {
      let [[a, i], [b, j]] = pairs.pop().map((place) => this.find(place));
      demand(a !== b || i === j, "a vertex would be itself, turned");
      if (a === b) continue;
      if (this.nodes[a].size > this.nodes[b].size) [a, i, b, j] = [b, j, a, i];
      const lost = this.nodes[a], kept = this.nodes[b];
      this.requireAlike(lost.seen, kept.seen);
      // Paths are never shortened, so that to undo a union is to cut one link.
      Object.assign(lost, { parent: b, offset: j - i });
      kept.size += lost.size;
      this.undo.push([a, null]);
      for (const [dart, end] of lost.partner) pairs.push(...this.lead(this.find([a, dart]), end));
    }
  }

  /** What `look` returns while the two are ends of one edge; the fold is as before after it. */
  assuming(one, other, look) {
    const mark = this.undo.length;
    try {
      this.join(one, other);
      return look();
    } finally {
      for (const [number, dart] of this.undo.splice(mark).reverse()) {
        const node = this.nodes[number];
        if (dart !== null) node.partner.delete(dart);
        else {
          this.nodes[node.parent].size -= node.size;
          Object.assign(node, { parent: null, offset: 0 });
        }
      }
    }
  }

  degree(node) { return this.nodes[node].seen.degree; }

  /** The darts, vertex by vertex. */
  darts() {
    return this.nodes.flatMap(({ parent, seen }, node) => parent !== null ? []
      : [Array.from({ length: seen.degree }, (_, dart) => [node, dart])]);
  }

  /** The darts that were never crossed, neither way. None: the history proves the map. */
  openDarts() { return this.darts().flat().filter(([v, k]) => !this.nodes[v].partner.has(k)); }

  /** The fold as a world, with a path of `pendant` vertices at every open dart. */
  world(pendant = 1) {
    const vertices = [], edges = [], numbers = new Map();
    let count = 0;
    const add = (degree) => vertices.push(Array.from({ length: degree }, () => count++));
    const number = (place) => numbers.get(this.find(place).join());
    for (const darts of this.darts()) {
      darts.forEach((place, door) => numbers.set(place.join(), count + door));
      add(darts.length);
    }
    for (const place of this.darts().flat()) {
      const end = this.partner(place);
      let here = number(place);
      if (end && here < number(end)) edges.push([here, number(end)]); // met at both its ends
      for (let left = end ? 0 : pendant; left > 0; left--) {
        edges.push([here, count]);
        here = count + 1;
        add(left > 1 ? 2 : 1);
      }
    }
    return { vertices, edges, marker: count ? number([0, 0]) : null };
  }
}

/** The map S beside the fold: which place each dart of S is. Grows by right augmentations. */
class MapOnFold {
  constructor(fold) {
    Object.assign(this, { fold, places: [], open: new Set(), entries: [] });
    this.addVertex([0, 0]);
  }

  addVertex([node, first]) {
    this.entries.push([node, first]);
    for (let door = 0; door < this.fold.degree(node); door++)
      this.open.add(this.places.push([node, first + door]) - 1);
  }

  grow({ edge, kind, dart }) {
    if (kind === "new") this.addVertex(this.fold.partner(this.places[edge]));
    for (const end of [edge, dart]) this.open.delete(end);
  }

  others(e) { return [...this.open].filter((dart) => dart !== e).sort((a, b) => a - b); }

  isKnown(node) { return this.entries.some((entry) => this.fold.find(entry)[0] === node); }

  /** A world with this history in which e and h are one edge, or null. */
  mayLeadTo(e, h) {
    try {
      return this.fold.assuming(this.places[e], this.places[h], () => this.fold.world());
    } catch (error) {
      if (error instanceof Contradiction) return null;
      throw error;
    }
  }

  /** Why a decision does not follow ("": it does), and a world with the same history in which it
   * is false (claim 10). Its darts are open darts of S; `refuted`: no end of the edge any more. */
  doubt({ type, edge, kind, hypothesis, dart, degree }, refuted = new Set()) {
    const { fold } = this, end = fold.partner(this.places[edge]), h = dart ?? hypothesis;
    const doubt = (why, witness = fold.world()) => ({ why, witness });
    if (type === "reject" || kind === "new") {
      if (kind && !end) return doubt("the edge was never crossed", fold.world(degree === 1 ? 2 : 1));
      if (kind && (fold.degree(end[0]) !== degree || this.isKnown(end[0])))
        return doubt("the edge leads to another vertex");
      const ends = kind ? this.others(edge).filter((other) => !refuted.has(other)) : [h];
      const witness = ends.map((other) => this.mayLeadTo(edge, other)).find(Boolean);
      return witness ? doubt("the edge may well lead there", witness) : doubt("", null);
    }
    if (!end || !fold.same(end, this.places[h]))
      return doubt(`darts ${edge} and ${h} may well belong to different edges`);
    const right = degree === undefined || degree === fold.degree(end[0]);
    return right ? doubt("", null) : doubt("the vertex there has another degree");
  }
}
