/* A walk by the reader: what is seen, what is declared, and at the end what followed from it.

   The map S is as the reader declares it: its vertices by their first darts, numbered as a trace
   numbers them. Where the robot is on S follows from the doors, as long as S is right. */

class Walk {
  constructor(world) {
    this.world = world;
    this.events = [{ type: 'start', percept: world.seen(world.marker) }];
    this.replay();
  }

  /** Find everything again from the events. */
  replay() {
    const { percept } = this.events[0];
    Object.assign(this, { at: this.world.marker, percept, moves: 0 });
    this.vertices = [{ first: 0, degree: percept.degree }];
    this.alpha = new Map(); // of S
    this.size = percept.degree;
    this.here = percept.degree ? 0 : null; // the reference dart on S; null: not on S
    this.pending = null; // the edge e behind which the robot is, with the doors from vu on
    this.contradiction = ''; // why S cannot be right: from then on where the robot is on it is unknown
    for (const event of this.events.slice(1)) this[event.type === 'move' ? 'moved' : 'declared'](event);
  }

  // ---------------------------------------------------------------- S

  vertexOf(dart) {
    return this.vertices.findLast(({ first }) => first <= dart);
  }

  turn(dart, door) {
    const { first, degree } = this.vertexOf(dart);
    return first + ((dart - first + door) % degree);
  }

  /** What S says is seen with this reference dart. */
  expected(dart) {
    const { first, degree } = this.vertexOf(dart);
    return { degree, marker: first === 0 ? (degree - dart) % degree : null };
  }

  /** The unexplored darts of S. */
  open() {
    return [...Array(this.size).keys()].filter((dart) => !this.alpha.has(dart));
  }

  /** The unexplored darts that may be the other end of e: their vertices look like vu. */
  hypotheses() {
    if (!this.pending) return [];
    const { degree, marker } = this.pending.percept;
    const alike = (dart) => this.vertexOf(dart).degree === degree && (this.vertexOf(dart).first === 0) === (marker !== null);
    return this.open().filter((dart) => dart !== this.pending.edge && alike(dart));
  }

  /** Whether vu may be new: the marker lies at one place only. */
  mayBeNew() {
    return this.pending !== null && this.pending.percept.marker === null;
  }

  // ---------------------------------------------------------------- what the reader does

  move(door) {
    const percept = this.world.seen(this.world.other.get(this.world.turn(this.at, door)));
    const event = { type: 'move', door, percept };
    this.events.push(event);
    this.moved(event);
  }

  /** Say where e leads: to the unexplored dart h, or (null) to a new vertex. */
  declare(h) {
    const { edge, percept } = this.pending;
    const kind = h === null ? 'new' : 'loop';
    const event = { type: 'augment', edge, kind, dart: h ?? this.size, degree: percept.degree };
    this.events.push(event);
    this.declared(event);
  }

  /** Take back the declarations from an event on, by default the last; all moves are kept. */
  takeBack(from = this.events.findLastIndex(({ type }) => type === 'augment')) {
    this.events = this.events.filter(({ type }, when) => when < from || type !== 'augment');
    this.replay();
  }

  moved({ door, percept }) {
    const { degree } = this.percept;
    this.at = this.world.other.get(this.world.turn(this.at, door));
    this.percept = percept;
    this.moves += 1;
    if (this.contradiction) return;
    if (this.pending) this.behind(door, degree, percept);
    else if (this.here !== null) this.onward(this.turn(this.here, door), percept, this.moves);
  }

  /** Leave a place of S by this dart, with this move. */
  onward(exit, percept, move) {
    this.here = this.alpha.get(exit) ?? null;
    if (this.here !== null) return this.compare(percept, move);
    this.pending = { edge: exit, percept, word: [], turned: 0 };
    if (this.mayBeNew() || this.hypotheses().length) return;
    this.contradiction = 'The road (?) that you took next ends at the marker, where no other exit of your map is unexplored.';
  }

  /** A move somewhere behind e: the doors from vu on are kept as a word, ways back cancel. */
  behind(door, degree, percept) {
    const { edge, word, turned } = this.pending, meant = (door + turned) % degree;
    if (meant) {
      word.push({ door: meant, percept, move: this.moves });
      this.pending.turned = 0;
    } else if (word.length) this.pending.turned = word.pop().door;
    else {
      this.pending = null;
      this.here = edge;
      this.compare(percept, this.moves);
    }
  }

  declared({ edge, kind, dart, degree }) {
    const { word, turned } = this.pending ?? { word: [], turned: 0 };
    if (kind === 'new') {
      this.vertices.push({ first: dart, degree });
      this.size += degree;
    }
    this.alpha.set(edge, dart).set(dart, edge);
    this.pending = null;
    this.here = dart;
    for (const [place, { door, percept, move }] of word.entries()) {
      this.onward(this.turn(this.here, door), percept, move);
      if (this.contradiction) return;
      if (this.pending) {
        Object.assign(this.pending, { word: word.slice(place + 1), turned });
        return;
      }
    }
    this.here = this.turn(this.here, turned);
    this.compare(this.percept, this.moves);
  }

  /** Whether a move showed what S shows. */
  compare(percept, move) {
    const should = this.expected(this.here), { degree, marker } = percept;
    if (should.degree === degree && should.marker === marker) return;
    this.contradiction = should.degree !== degree || (should.marker === null) !== (marker === null)
      ? `After move ${move} you saw ${seenAs(percept)}, where your map shows ${seenAs(should)}.`
      : `After move ${move} the marker pointed to another exit than on your map.`;
    this.here = null;
  }

  // ---------------------------------------------------------------- the end

  /**
   * What became of each declaration: it `followed` from the history, was true by `luck`, or `wrong`.
   * What was luck is taken for true by those after it (`given`), but not by the proof of the map.
   * What stands on a wrong one is not judged.
   */
  judged() {
    const { world } = this, [{ percept }] = this.events, fold = new Fold(percept);
    const believed = new Fold(percept), map = new MapOnFold(believed);
    const phi = new Map(), number = new Map(), found = [];
    const add = (entry) => {
      for (let door = 0, { degree } = world.seen(entry); door < degree; door += 1) {
        const image = world.turn(entry, door);
        number.set(image, phi.size);
        phi.set(phi.size, image);
      }
    };
    if (world.marker !== null) add(world.marker);
    for (const [when, event] of this.events.entries()) {
      if (event.type === 'move') for (const one of [fold, believed]) one.move(event.door, event.percept);
      if (event.type !== 'augment' || found.at(-1)?.fate === 'wrong') continue;
      const end = world.other.get(phi.get(event.edge)), truth = number.get(end) ?? null;
      const { why, witness } = map.doubt(event);
      if (truth !== (event.kind === 'new' ? null : event.dart)) {
        found.push({ when, event, fate: 'wrong', truth, witness: null });
        continue; // the moves alone decide what is proved
      }
      const given = found.some(({ fate }) => fate === 'luck');
      found.push({ when, event, fate: why ? 'luck' : 'followed', why, witness, given });
      if (event.kind === 'new') add(end);
      else if (why) believed.join(map.places[event.edge], map.places[event.dart]);
      map.grow(event);
    }
    const open = fold.openDarts().length, code = JSON.stringify;
    const short = fold.world(1);
    const witness = !open ? null : code(sizes(short)) !== code(sizes(world)) ? short : fold.world(2);
    return { found, phi, proved: !open, witness };
  }

  /** Whether S has no unexplored dart: as far as the reader says, the map is complete. */
  get complete() {
    return !this.open().length && !this.pending;
  }
}

const sizes = ({ vertices, edges }) => [vertices.length, edges.length];

/** A percept in words. */
function seenAs({ degree, marker }) {
  return `${many(degree, 'exit')}${marker === null ? '' : ' and the marker'}`;
}
