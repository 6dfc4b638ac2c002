/* A run as the page shows it: what each event of a trace means, found again from the doors alone.

   The recording holds the events and no snapshot. S only grows, so one list of its vertices, edges
   and darts, each with the event at which it appears, is S at every moment. Beyond a door that is
   not there nothing is known; beyond a false augmentation S is what the mapper believes, drawn where
   its robot really stood. */

const PURPOSES = ['walk', 'cross', 'validate', 'retrace', 'other'];
const MOST_DARTS = 10000;
const RULES = { m: 'motion', p: 'prefix', h: 'history', r: 'records', f: 'folding', l: 'planar' };
const MOVES = { w: 0, c: 1, v: 2, t: 3, m: 4 };

/** A percept as [degree, marker or null], from the form in which the recording keeps it. */
const percept = (kept) => (typeof kept === 'number' ? [kept, null] : kept);

/** An event with names, from the form in which the recording keeps it; see recording.py. */
function event(kept, contradictions) {
  if (kept === 's') return { type: 'start' };
  if (typeof kept === 'string') return { type: 'move', purpose: MOVES[kept[0]], door: +kept.slice(1) };
  const [letter, edge, other] = kept;
  switch (letter) {
    case 'p':
      return { type: 'pose', edge, hypotheses: other };
    case 'c':
      return { type: 'confirm', edge, hypothesis: other, rule: RULES[kept[3]] };
    case 'a':
    case 'l':
      return { type: 'augment', edge, dart: other, degree: kept[3], kind: letter === 'a' ? 'new' : 'loop' };
    case 'r': {
      if (typeof kept[4] === 'string') {
        const alone = { step: 0, observed: null, expected: null, sequence: null, at: null, record: null };
        return { type: 'reject', edge, hypothesis: other, rule: RULES[kept[3]], ...alone, contradiction: contradictions[+kept[4]] };
      }
      const [, , , rule, step, observed, expected, sequence, at, record, contradiction] = kept;
      const cited = { step, observed: percept(observed ?? null), expected: percept(expected ?? null) };
      Object.assign(cited, { sequence: sequence ?? null, at: at ?? null, record: record ?? null });
      cited.contradiction = contradiction ?? null;
      return { type: 'reject', edge, hypothesis: other, rule: RULES[rule], ...cited };
    }
    default:
      return { type: 'finish', cost: kept[1] };
  }
}

/** The moves behind an edge, reduced to the doors that lead from vu to the robot. */
class Excursion {
  constructor() {
    this.word = [];
    this.sequences = [];
    this.turned = 0;
  }

  move(door, degree) {
    const meant = (door + this.turned) % degree;
    if (meant === 0 && this.word.length) this.turned = this.word.pop();
    else {
      this.word.push(meant);
      this.turned = 0;
    }
  }
}

/** S, as it grows: its darts, vertices and edges, each with the event at which it appears. */
class GrowingMap {
  constructor(picture) {
    this.picture = picture;
    this.darts = []; // {image: dart of the world, vertex, place, born, joined, other, records}
    this.vertices = []; // {first, degree, born, entry: dart of the world, twin: is it drawn twice}
    this.edges = []; // {a, b, when, real: are they the two ends of one edge of the world}
    this.drawn = new Set(); // vertices of the world that S has
  }

  addVertex(entry, declared, when) {
    const first = this.darts.length;
    const degree = Math.max(0, Math.min(declared, MOST_DARTS)); // a mapper may declare any number
    const vertex = this.picture.vertex[entry] ?? 0;
    this.vertices.push({ first, degree, born: when, entry, twin: this.drawn.has(vertex) });
    this.drawn.add(vertex);
    for (let place = 0; place < degree; place += 1) {
      const image = entry < 0 ? -1 : this.picture.turn(entry, place);
      const born = { image, vertex: this.vertices.length - 1, place, born: when, joined: Infinity };
      this.darts.push({ ...born, other: null, records: [] });
    }
  }

  join(a, b, when) {
    const [one, other] = [this.darts[a], this.darts[b]];
    if (!one || !other) return;
    one.other = b;
    other.other = a;
    one.joined = other.joined = Math.min(when, one.joined, other.joined);
    this.edges.push({ a, b, when, real: this.picture.other[one.image] === other.image });
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

  /** Where doors lead on S at an event: darts left by, the dart where it ends, doors to go. */
  trace(dart, doors, when) {
    const left = [];
    let at = dart;
    for (let k = 0; k < doors.length; k += 1) {
      const exit = this.turn(at, doors[k]);
      left.push(exit);
      if (this.isOpen(exit, when) || this.darts[exit].other === null) {
        return { left, at: exit, rest: doors.slice(k) };
      }
      at = this.darts[exit].other;
    }
    return { left, at, rest: [] };
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
    this.events = recorded.events.map((kept) => event(kept, recorded.contradictions));
    this.length = this.events.length;
    this.map = new GrowingMap(picture);
    this.silent = !this.events.some((one) => one.type === 'augment');
    this.illegal = null;
    this.position = new Int32Array(this.length).fill(-1);
    this.left = new Int32Array(this.length).fill(-1); // by which dart of the world a move left
    this.costs = PURPOSES.map(() => new Int32Array(this.length));
    this.rounds = [];
    this.roundAt = new Int32Array(this.length).fill(-1);
    this.learned = []; // {when, dart}: a record that was kept behind an unexplored dart
    this.walked = new Map(); // edge of the world: the event at which it was first crossed
    this.read();
    this.cost = this.costOf(this.length - 1);
  }

  costOf(when) {
    return this.costs.reduce((sum, row) => sum + row[when], 0);
  }

  read() {
    const { picture, map } = this;
    let at = picture.root ?? -1;
    map.addVertex(at, picture.vertices[at < 0 ? 0 : picture.vertex[at]].length, 0);
    let behind = new Excursion();
    let round = null;
    const cost = PURPOSES.map(() => 0);
    this.events.forEach((one, when) => {
      if (one.type === 'move') {
        cost[one.purpose] += 1;
        if (this.illegal === null) at = this.step(one, when, at, behind);
      } else if (one.type === 'pose') {
        behind = new Excursion();
        behind.late = at !== this.beyond(one.edge);
        const hypotheses = one.hypotheses.map((dart, k) => ({ dart, number: k + 1, out: Infinity }));
        round = { from: when, to: Infinity, edge: one.edge, late: behind.late, hypotheses, tests: [] };
        this.rounds.push(round);
      } else if (round) this.decide(one, when, round, behind);
      if (one.type === 'augment') {
        this.grow(one, when, at, behind, round);
        round = null;
      }
      if (round || one.type === 'augment') this.roundAt[when] = this.rounds.length - 1;
      this.position[when] = this.illegal === null ? at : -1;
      cost.forEach((sum, k) => (this.costs[k][when] = sum));
    });
  }

  step(one, when, at, behind) {
    const degree = this.picture.seen(at)[0];
    if (one.door < 0 || one.door >= degree) {
      this.illegal = when;
      return -1;
    }
    const exit = this.picture.turn(at, one.door);
    this.left[when] = exit;
    const edge = this.picture.edgeOf[exit];
    if (!this.walked.has(edge)) this.walked.set(edge, when);
    if (!behind.late) behind.move(one.door, degree); // after a late pose no move is behind e
    return this.picture.other[exit];
  }

  /** The dart of the world at the other end of a dart of S; -1 if there is no such dart. */
  beyond(e) {
    const dart = this.map.darts[e];
    return dart ? this.picture.other[dart.image] : -1;
  }

  decide(one, when, round, behind) {
    if (one.type !== 'reject' && one.type !== 'confirm') return;
    const hypothesis = round.hypotheses.find((h) => h.dart === one.hypothesis && h.out === Infinity);
    if (hypothesis) Object.assign(hypothesis, { out: when, kept: one.type === 'confirm' });
    if (one.rule === 'motion') round.tests.push({ when, dart: one.hypothesis });
    if (one.type !== 'reject') return;
    one.doors = one.sequence === null ? behind.word.slice() : behind.sequences[one.sequence] ?? [];
    one.doors = one.doors.slice(0, one.step);
    if (one.rule === 'motion' && behind.word.length) behind.sequences.push(behind.word.slice());
  }

  grow(one, when, at, behind, round) {
    const { map, picture } = this;
    if (round) round.to = when;
    const edge = map.darts[one.edge];
    if (!edge || this.illegal !== null) return;
    one.end = picture.other[edge.image] ?? -1;
    if (one.kind === 'new') {
      if (one.dart !== map.darts.length) return;
      map.addVertex(one.end, one.degree, when);
    }
    map.join(one.edge, one.dart, when);
    if (!map.darts[one.dart]) return;
    for (const doors of behind.sequences) {
      const { at: dart, rest } = map.trace(one.dart, doors, when + 1);
      if (rest.length) {
        map.darts[dart].records.push({ when, doors: rest });
        this.learned.push({ when, dart });
      }
    }
    behind.sequences = [];
  }

  /** The round in which edge e is asked about at an event, or null. */
  round(when) {
    return this.rounds[this.roundAt[when]] ?? null;
  }

  /** The hypothesis that an event is about: named by it, or tested in motion next. */
  tested(when) {
    const one = this.events[when];
    const round = this.round(when);
    if (!round) return null;
    if (one.hypothesis !== undefined) return round.hypotheses.find((h) => h.dart === one.hypothesis) ?? null;
    if (one.type !== 'move' || one.purpose !== 2) return null;
    const next = round.tests.find((test) => test.when > when);
    return (next && round.hypotheses.find((h) => h.dart === next.dart)) ?? null;
  }

  /** The doors from vu to the robot at an event of a round. */
  word(when) {
    const behind = new Excursion();
    for (let k = this.rounds[this.roundAt[when]].from + 1; k <= when; k += 1) {
      const one = this.events[k];
      if (one.type === 'move' && this.left[k] >= 0) behind.move(one.door, this.picture.seen(this.position[k - 1])[0]);
    }
    return behind.word;
  }

  /** The darts of the world by which these doors lead on from a reference dart, and the last end. */
  follow(at, doors) {
    const left = [];
    let end = at;
    for (const door of doors) {
      if (end < 0 || door >= this.picture.seen(end)[0]) break;
      left.push(this.picture.turn(end, door));
      end = this.picture.other[left.at(-1)];
    }
    return { left, end };
  }

  /** Where the evidence of a rejection lies: on the world and on S. */
  evidence(when) {
    const one = this.events[when];
    const round = this.round(when);
    const e = this.map.darts[one.edge];
    const h = this.map.darts[one.hypothesis];
    if (!round || !e || !h || one.doors === undefined) return null;
    const told = this.recorded.places[when]; // of a contradiction: the places that would be one
    const real = this.follow(this.picture.other[e.image], one.doors);
    const believed = this.map.trace(one.hypothesis, one.doors, when);
    return { real, believed, told, record: one.record };
  }

  /** What the robot senses after an event: what it was told, true or not. */
  percept(when) {
    for (let k = when; k >= 0; k -= 1) {
      if (this.recorded.lies[k]) return percept(this.recorded.lies[k]);
      if (this.events[k].type === 'move' || k === 0) return this.position[k] < 0 && k ? null : this.picture.seen(this.position[k]);
    }
    return null;
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
