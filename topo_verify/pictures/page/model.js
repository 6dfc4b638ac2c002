/* A run as the page shows it: where the robot stood, how S grew, and what each event asks.

   The recording holds the events, which are deltas, and what the replay of the checkers knows of
   them. S only grows, so one list of its vertices, edges and darts, each with the event at which it
   appears, is S at every moment. Beyond a door that is not there nothing is known; beyond a false
   augmentation S is what the mapper believes, drawn where its robot really stood. */

const PURPOSES = ['walk', 'cross', 'validate', 'retrace', 'other'];
const MOST_DARTS = 10000;
const RULES = ['motion', 'prefix', 'history', 'records', 'folding', 'planar'];
const KINDS = ['', 'ask', 'ok', 'bad'];
const TYPES = { s: 'start', p: 'pose', r: 'reject', k: 'confirm', a: 'augment', l: 'augment', f: 'finish' };

/** A percept as [degree, marker or null], from the form in which the recording keeps it. */
const percept = (kept) => (typeof kept === 'number' ? [kept, null] : kept);

const DIGITS = '0123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ-_';

/** The numbers in a text: a digit each, 64 more for each blank before it; see recording.py. */
function numbers(text) {
  let more = 0;
  const all = [];
  for (const digit of text) {
    if (digit !== ' ') all.push(more + DIGITS.indexOf(digit));
    more = digit === ' ' ? more + 64 : 0;
  }
  return all;
}

/** An event with names, from the letter and the numbers by which the recording keeps it. */
function event([, letter, text]) {
  const type = TYPES[letter], [edge, ...rest] = text.split(',').map(Number);
  if (!type) return { type: 'move', purpose: 'wcvtm'.indexOf(letter), door: edge };
  if (type === 'pose') return { type, edge, hypotheses: rest };
  const [dart, more, ...last] = rest;
  if (type === 'augment') return { type, kind: letter === 'a' ? 'new' : 'loop', edge, dart, degree: more, records: last };
  return more === undefined ? { type } : { type, edge, hypothesis: dart, rule: RULES[more], evidence: last };
}

/** Where doors lead from a dart on: the darts left by, the dart where it ends, doors to go. */
function follow(start, doors, turn, across) {
  const left = [];
  let at = start;
  for (const [k, door] of doors.entries()) {
    const exit = turn(at, door), next = across(exit);
    left.push(exit);
    if (next === null) return { left, at: exit, rest: doors.slice(k) };
    at = next;
  }
  return { left, at, rest: [] };
}

/** S, as it grows: its darts, vertices and edges, each with the event at which it appears. */
class GrowingMap {
  constructor(picture) {
    this.picture = picture;
    this.darts = []; // {image: dart of the world, vertex, place, born, joined, other}
    this.vertices = []; // {first, degree, born, entry: dart of the world, twin: is it drawn twice}
    this.edges = []; // {a, b, when, real: are they the two ends of one edge of the world}
    this.drawn = new Set(); // vertices of the world that S has
  }

  addVertex(entry, declared, born) {
    const first = this.darts.length, degree = Math.max(0, Math.min(declared, MOST_DARTS)); // any number may be declared
    const vertex = this.picture.vertex[entry] ?? 0;
    this.vertices.push({ first, degree, born, entry, twin: this.drawn.has(vertex) });
    this.drawn.add(vertex);
    for (let place = 0; place < degree; place += 1) {
      const image = entry < 0 ? -1 : this.picture.turn(entry, place);
      this.darts.push({ image, vertex: this.vertices.length - 1, place, born, joined: Infinity, other: null });
    }
  }

  grow({ edge, dart, degree, kind }, when) {
    if (!this.darts[edge] || (kind === 'new' && dart !== this.darts.length)) return;
    if (kind === 'new') this.addVertex(this.beyond(edge), degree, when);
    const [one, other] = [this.darts[edge], this.darts[dart]];
    if (!other) return;
    one.joined = other.joined = Math.min(when, one.joined, other.joined);
    one.other = dart;
    other.other = edge;
    this.edges.push({ a: edge, b: dart, when, real: this.picture.other[one.image] === other.image });
  }

  /** The dart of the world at the other end of a dart of S; -1 if there is no such dart. */
  beyond(dart) {
    return this.picture.other[this.darts[dart]?.image] ?? -1;
  }

  turn(dart, door) {
    const { vertex, place } = this.darts[dart];
    const { first, degree } = this.vertices[vertex];
    return first + ((place + door) % degree);
  }

  isOpen(dart, when) {
    const one = this.darts[dart];
    return one !== undefined && one.born <= when && when <= one.joined;
  }

  /** Where doors lead on S at an event. */
  trace(dart, doors, when) {
    return follow(dart, doors, (at, door) => this.turn(at, door), (exit) => (this.isOpen(exit, when) ? null : this.darts[exit].other));
  }

  /** The darts of S on the face of an unexplored dart; where a dart is open the boundary turns. */
  face(edge, when) {
    const face = [edge];
    for (let at = edge; face.length <= this.darts.length; face.push(at)) {
      const { joined, other } = this.darts[at];
      at = this.turn(joined < when ? other : at, 1);
      if (at === edge) break;
    }
    return face;
  }
}

/** One run in a world. */
class Run {
  constructor(picture, recorded) {
    Object.assign(this, { picture, recorded, name: recorded.name, findings: recorded.findings });
    this.events = [...recorded.events.matchAll(/([a-z])([-\d,]*)/g)].slice(0, recorded.end).map(event);
    this.length = this.events.length;
    this.map = new GrowingMap(picture);
    this.silent = !this.events.some((one) => one.type === 'augment');
    this.illegal = null;
    this.position = new Int32Array(this.length).fill(-1);
    this.left = new Int32Array(this.length).fill(-1); // by which dart of the world a move left
    this.costs = PURPOSES.map(() => new Int32Array(this.length));
    this.rounds = []; // by event, the round in which an edge is asked about, or null
    this.walked = new Map(); // edge of the world: the event at which it was first crossed
    this.sayings = numbers(recorded.said.events);
    this.read();
    this.cost = this.costOf(this.length - 1);
  }

  costOf(when) {
    return this.costs.reduce((sum, row) => sum + row[when], 0);
  }

  read() {
    const { picture, map } = this;
    let at = picture.root ?? -1, round = null;
    map.addVertex(at, picture.seen(at)[0], 0);
    const cost = PURPOSES.map(() => 0);
    this.events.forEach((one, when) => {
      const { type, edge, hypothesis, hypotheses } = one;
      if (type === 'move') {
        cost[one.purpose] += 1;
        if (this.illegal === null) at = this.step(one.door, when, at);
      }
      if (type === 'pose') {
        const guesses = hypotheses.map((dart, k) => ({ dart, number: k + 1, out: Infinity }));
        round = { from: when, to: Infinity, edge, hypotheses: guesses };
      }
      const decided = round?.hypotheses.find((h) => h.dart === hypothesis && h.out === Infinity);
      if (decided) Object.assign(decided, { out: when, kept: type === 'confirm' });
      this.rounds[when] = round;
      if (type === 'augment') {
        if (round) round.to = when;
        round = null;
        if (this.illegal === null) map.grow(one, when);
      }
      this.position[when] = this.illegal === null ? at : -1;
      cost.forEach((sum, k) => (this.costs[k][when] = sum));
    });
  }

  step(door, when, at) {
    if (door < 0 || door >= this.picture.seen(at)[0]) {
      this.illegal = when;
      return -1;
    }
    const exit = this.picture.turn(at, door), edge = this.picture.edgeOf[exit];
    this.left[when] = exit;
    if (!this.walked.has(edge)) this.walked.set(edge, when);
    return this.picture.other[exit];
  }

  /** The hypothesis that an event is about: named by it, or tested in motion next. */
  tested(when) {
    const one = this.events[when], round = this.rounds[when];
    let dart = one.hypothesis;
    if (one.purpose === 2) dart = this.events.find((next, k) => k > when && (next.rule === 'motion' || this.rounds[k] !== round))?.hypothesis;
    return round?.hypotheses.find((h) => h.dart === dart) ?? null;
  }

  /** The doors from where an edge was posed to the robot. */
  word(when) {
    const { other, place, vertex, vertices } = this.picture, { from } = this.rounds[when], way = [];
    for (const exit of this.left.slice(from + 1, when + 1)) {
      if (exit >= 0 && other[way.at(-1)] === exit) way.pop();
      else if (exit >= 0) way.push(exit);
    }
    return way.map((exit, k) => {
      const degree = vertices[vertex[exit]].length;
      return (place[exit] - place[k ? other[way[k - 1]] : this.position[from]] + degree) % degree;
    });
  }

  /** The two visits that a rejection by folding would make one, as darts of the world, or null. */
  told(when) {
    const { rule, evidence } = this.events[when];
    return rule === 'folding' && evidence.length && !this.recorded.end ? evidence : null;
  }

  /** Where the evidence of a rejection lies, on the world and on S; null: the replay has none. */
  evidence(when) {
    const { edge, hypothesis, rule, evidence } = this.events[when];
    if (!this.map.darts[edge] || !this.map.darts[hypothesis] || evidence[0] === -1) return null;
    const doors = rule === 'folding' ? [] : evidence;
    return { real: this.follow(this.map.beyond(edge), doors), believed: this.map.trace(hypothesis, doors, when) };
  }

  /** Where doors lead in the world from a reference dart. */
  follow(at, doors) {
    return follow(at, doors, (dart, door) => this.picture.turn(dart, door), (exit) => this.picture.other[exit]);
  }

  /** What the narrator says of an event (narrator.py): {kind, title, text, sees, should, labels}. */
  said(when) {
    const { texts, sayings } = this.recorded.said;
    const [kind, title, sentences, sees = null, should = null, labels = [0, 1]] = sayings[this.sayings[when]];
    const [text, shown] = [sentences, labels].map((all) => all.map((k) => texts[k]));
    return { kind: KINDS[kind], title: texts[title], text: text.join(' '), sees: percept(sees), should: percept(should), labels: shown };
  }

  /** Whether a confirmation is false in the world, or its walk speaks against it. */
  isWrong(when) {
    const { edge, hypothesis } = this.events[when], { darts } = this.map;
    return this.said(when).kind === 'bad' || darts[hypothesis]?.image !== this.map.beyond(edge);
  }

  isDecision(when) {
    return this.events[when].type !== 'move';
  }

  /** The findings that an event shows; those of the run as a whole stand at its end. */
  findingsAt(when) {
    return this.findingsBetween(when, when);
  }

  findingsBetween(from, to) {
    const at = (one) => one.event ?? this.length - 1;
    return this.findings.filter((one) => from <= at(one) && at(one) <= to);
  }
}
