/* What an event means: one bold sentence, one more, and the two percepts that are compared.

   Plain words (place, road, exit, guess) for the field's terms (vertex, edge, dart, hypothesis). */

const exits = (n) => `${n} ${n === 1 ? 'exit' : 'exits'}`;
const sight = ([degree, marker]) => exits(degree) + (marker === null ? '' : ' and the marker');

/** The sentences of an event: {kind: '' | 'bad' | 'good', title, text, sees, should}. */
function words(run, when) {
  const one = run.events[when];
  if (run.illegal !== null && when >= run.illegal) return lost(run, when);
  const labels = ['it sees', 'it should see'];
  const said = { kind: '', title: '', text: '', sees: run.percept(when), should: null, labels };
  Object.assign(said, SAY[one.type](run, when, one));
  if (run.recorded.identified[when]) said.text += ' Its history now proves: what is ringed in green are places that it saw before.';
  return said;
}

function lost(run, when) {
  const one = run.events[when];
  const degree = run.picture.seen(run.position[run.illegal - 1])[0];
  const text =
    when === run.illegal
      ? `It takes door ${one.door}, but the place has ${exits(degree)}: doors 0 to ${degree - 1}.`
      : 'Since a door that is not there, nobody can say where it stands.';
  return { kind: 'bad', title: when === run.illegal ? 'No such door' : 'The robot is lost', text, sees: null, should: null, labels: ['', ''] };
}

const SAY = {
  start: (run) => ({
    title: 'The robot wakes up beside the marker',
    text:
      `It sees ${sight(run.percept(0))}. Dotted roads are unknown to it. It can count the exits of a place and tell` +
      ' their order; all that it can recognise is the marker, the red arrow.',
  }),

  move(run, when, one) {
    const tested = run.tested(when);
    const round = run.round(when);
    if (tested) {
      const steps = run.word(when).length;
      return {
        title: `Testing guess ${tested.number}`,
        text:
          `If its road ended at exit ${tested.number}, these doors would lead to a place that it knows: road ${steps}` +
          ' of its way. The ring on the map is where it would be now.',
        should: expectedNow(run, when, tested),
      };
    }
    if (one.purpose === 1) return { title: 'Into the unknown', text: 'It takes a road that it has never walked. Where does it come out?' };
    if (one.purpose === 3) return { title: 'Back the way it came', text: 'It returns to the place that it is asking about.' };
    if (one.purpose === 0) return { title: 'On to the next open exit', text: 'A walk over roads that it knows already.' };
    if (one.purpose === 2 && round) return { title: 'A test', text: 'It walks on to tell its guesses apart.' };
    const first = run.walked.get(run.picture.edgeOf[run.left[when]]) === when;
    const text = `It leaves by door ${one.door} and sees ${sight(run.percept(when))}.`;
    return { title: first ? 'A road never walked before' : 'A road that it has walked before', text };
  },

  pose(run, when, one) {
    const n = one.hypotheses.length;
    if (run.round(when).late) return { title: 'A road crossed before', text: 'By now it has seen enough to say where this road leads, wherever it stands.' };
    const seen = run.percept(when);
    if (!n) return { title: 'Never seen anything like it', text: `It sees ${sight(seen)}, and finds no place on its map with an open exit that looks like this. So it takes the place for new.` };
    const which = n === 1 ? 'One open exit' : `${n} open exits`;
    return {
      title: 'Was I here before?',
      text: `It sees ${sight(seen)}. ${which} on its map, numbered, could be the one that it has just come in by. Or the place is new.`,
    };
  },

  reject(run, when, one) {
    const tested = run.tested(when);
    const name = tested ? `Guess ${tested.number}` : 'A guess';
    const { observed, expected } = one;
    const said = { kind: 'bad', title: `${name} is wrong`, sees: observed, should: expected };
    if (one.rule === 'planar') {
      const text = 'Its exit lies on another face of the map: the road would have to cross another one, and this world is said to be planar.';
      return { ...said, title: `${name} is on the other side`, text };
    }
    if (one.rule === 'folding') return { ...said, ...folded(run, when, name) };
    if (one.rule !== 'motion') Object.assign(said, { title: `${name} is wrong too, without a step`, labels: ['it saw', 'it should see'] });
    return { ...said, text: disagreement(one) };
  },

  confirm(run, when, one) {
    const tested = run.tested(when);
    const name = tested ? `Guess ${tested.number}` : 'The guess';
    const text =
      one.rule === 'motion'
        ? 'Every place on the way looked as it should, and the marker at the end points the right way.'
        : 'No other end is left for its road, it says.';
    return { kind: 'good', title: `${name} is right, it says`, text };
  },

  augment(run, when, one) {
    const round = run.rounds.find((r) => r.to === when);
    if (one.kind === 'loop') {
      const text = 'Both ends of the road are on the map now: one road more, and two open exits fewer.';
      return { kind: 'good', title: 'The road closes a circle', text };
    }
    const text = round && round.hypotheses.length ? 'Every guess was refuted, it says, so it was never here before.' : 'With it come new open exits.';
    return { kind: 'good', title: 'A new place for the map', text };
  },

  finish(run, when) {
    const wrong = run.findings.length > 0;
    const text = `${run.costOf(when)} moves for ${run.picture.edges.length} roads.` + (wrong ? '' : ' The map is the world.');
    return { kind: wrong ? '' : 'good', title: wrong ? 'It delivers its map' : 'The map is complete', text };
  },
};

/** What would be seen now if the guess that is tested were true. */
function expectedNow(run, when, tested) {
  const { at, rest } = run.map.trace(tested.dart, run.word(when), when);
  const image = run.map.darts[at]?.image ?? -1;
  return rest.length || image < 0 ? null : run.picture.seen(image);
}

function disagreement({ rule, observed, expected, record }) {
  if (!observed || !expected) return '';
  const earlier = { prefix: 'The walk just made', history: 'A walk made before' }[rule];
  const how = record
    ? 'A walk made before is replayed on the map and leaves it by an open exit, of which a record is kept. '
    : earlier
      ? `${earlier} is replayed on the map from there. `
      : '';
  const marked = observed[1] !== null && expected[1] !== null;
  if (observed[0] === expected[0] && marked) return `${how}The marker is here, but it would have to point another way.`;
  return `${how}At the ring it would see ${sight(expected)}. It ${rule === 'motion' ? 'sees' : 'saw'} ${sight(observed)}.`;
}

function folded(run, when, name) {
  const { contradiction } = run.events[when];
  const told = run.recorded.places[when];
  if (!told || told.length < 2) return { text: `If it were right, the history would contradict itself: ${contradiction}.`, sees: null };
  const [sees, should] = told.map((dart) => run.picture.seen(dart));
  const text = `Were ${name.toLowerCase()} right, the two ringed places would be one: it saw both, and they differ (${contradiction}).`;
  return { text, sees, should, labels: ['one place', 'the other'] };
}

/** One short line for screen readers and for the slider. */
function summary(run, when) {
  const { title, text } = words(run, when);
  return `${title}. ${text}`;
}
