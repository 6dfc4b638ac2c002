/* The player: which runs are shown, at which event, and everything that one can press. */

const CALM = matchMedia('(prefers-reduced-motion: reduce)');
const WAIT = { move: 520, pose: 1700, reject: 1700, confirm: 1700 };
const LARGE = 40;
const VIEWS = { world: 'the world', map: 'its map', witness: 'the witness' };

class Player {
  constructor(recording) {
    this.pictures = recording.worlds.map((world) => new Picture(world));
    this.recording = recording;
    this.runs = recording.runs.map((run) => new Run(this.pictures[0], run));
    this.chosen = this.runs.length === 2 ? [0, 1] : [0];
    // A large map begins as a dot.
    this.view = this.chosen.length > 1 && recording.worlds[0].edges.length > LARGE ? 'world' : 'best';
    this.kind = this.chosen.length > 1 ? 'cost' : 'event';
    this.speed = 1;
    this.tick = 0;
    this.timer = 0;
    this.choices();
    this.buttons();
    this.keys();
    this.arrange();
    this.jump(this.asked() ?? this.opening());
    addEventListener('resize', () => {
      clearTimeout(this.resized);
      this.resized = setTimeout(() => this.rearrange(), 150);
    });
    addEventListener('hashchange', () => this.asked() !== null && this.asked() !== this.tick && this.jump(this.asked()));
  }

  // ---------------------------------------------------------------- what is shown

  /** The tick that the address asks for (#step=120), or null. */
  asked() {
    const found = /^#step=(\d{1,9})$/.exec(location.hash);
    return found ? +found[1] : null;
  }

  /** Where a run opens: at its first finding, or at the first question with guesses before its last move. */
  opening() {
    const [found] = this.findings(), run = this.runs[this.chosen[0]], { events } = run;
    if (found) return found.tick;
    const asked = events.findIndex(({ hypotheses }, when) => hypotheses?.length && run.costOf(when) < run.cost);
    const first = asked < 0 ? events.findIndex(({ type }) => type !== 'start' && type !== 'move') : asked;
    return this.clock.tick(0, Math.max(first, 0));
  }

  /** The findings of the shown runs with their ticks, in order. */
  findings() {
    const found = this.chosen.flatMap((number, index) => {
      const run = this.runs[number];
      return run.findings.map((one) => ({ one, run, tick: this.clock.tick(index, one.event ?? run.length - 1) }));
    });
    return found.sort((a, b) => a.tick - b.tick);
  }

  /** The finding with a witness that is current: of this event, or the last one before it. */
  witnessed(run, when) {
    const all = run.findings.filter((one) => one.witness !== null);
    return all.findLast((one) => (one.event ?? run.length - 1) <= when) ?? all[0] ?? null;
  }

  /** Whether nothing is wrong in this world: then only the witness shows what was luck. */
  lucky(run) {
    const proofs = ['map-entailed', 'decisions-entailed'];
    return run.findings.length > 0 && run.findings.every((one) => proofs.includes(one.claim));
  }

  /** Make panes, sentences and charts for the chosen runs. */
  arrange() {
    const runs = this.chosen.map((number) => this.runs[number]);
    const two = runs.length > 1;
    this.clock = new Clock(two ? this.kind : 'event', runs);
    document.body.classList.toggle('two', two);
    byId('title').textContent = `${runs.map((run) => run.name).join(' beside ')} in ${this.recording.name}`;
    const [header, hint] = [byId('title').parentNode, byId('hint')];
    hint.hidden = two || innerWidth < 1600;
    hint.hidden ||= header.offsetHeight > 45; // it may not take a second line
    byId('panes').replaceChildren();
    byId('says').replaceChildren();
    byId('chart').replaceChildren();
    this.frames = [];
    if (two) this.panes = runs.map((run, index) => this.pane(this.view === 'world' ? 'world' : 'map', run, index));
    else this.panes = [this.pane('world', runs[0], 0), this.pane(this.other(runs[0]), runs[0], 0)];
    this.says = runs.map((run) => new Saying(byId('says'), two ? run.name : ''));
    const top = Math.max(1, ...runs.map((run) => run.cost));
    this.charts = runs.map((run, index) => new Chart(byId('chart'), run, this.clock, index, top, this.recording.least_cost));
    byId('slider').max = this.clock.last;
    this.marks();
    this.legend(runs);
    byId('finding').hidden = !runs.some((run) => run.findings.length);
  }

  /** What the right pane of a single run shows. */
  other(run) {
    if (this.view === 'witness' && this.witnessed(run, Infinity)) return 'witness';
    return 'map';
  }

  pane(kind, run, index) {
    const section = html('section', 'card pane', byId('panes'));
    const head = html('h2', '', section);
    const two = this.chosen.length > 1;
    const picture = kind === 'witness' ? this.pictures[this.witnessed(run, this.at(0)).witness] : this.pictures[0];
    const layers = html('div', `layers ${kind}`, section);
    layers.setAttribute('role', 'img');
    picture.fit(layers.clientWidth - 16, layers.clientHeight - 12);
    const show = this.shower(kind, layers, picture, run);
    const frame = new Frame(layers, picture, []);
    frame.peers = this.frames.filter((one) => one.picture === picture).concat(frame);
    for (const peer of frame.peers) peer.peers = frame.peers;
    this.frames.push(frame);
    const names = { world: 'The world', map: 'The robot’s map', witness: 'A witness' };
    const notes = { world: 'only you can see all of it', map: run.silent ? 'it declares none: where it has walked' : 'all that it knows', witness: 'the same walk in another world' };
    html('span', '', head, two ? run.name : names[kind]);
    html('small', '', head, two ? `${names[kind].toLowerCase()}` : notes[kind]);
    layers.setAttribute('aria-label', `${names[kind]}, ${notes[kind]}`);
    frame.reset();
    this.zoomers(section, frame);
    return { index, show };
  }

  shower(kind, layers, picture, run) {
    if (kind === 'map') {
      const pane = new MapPane(layers, picture, run);
      return (when, animate) => pane.show(when, animate);
    }
    if (kind === 'world') {
      const pane = new WorldPane(layers, picture, run);
      if (this.view === 'witness' && this.chosen.length === 1) this.parting(pane, run);
      return (when, animate) => pane.show(when, animate);
    }
    const finding = this.witnessed(run, this.at(0));
    const last = finding.event ?? run.length - 1;
    const pane = new WorldPane(layers, picture, this.inWitness(run, finding));
    this.parting(pane, run);
    return (when, animate) => pane.show(Math.min(when, last), when > last ? 0 : animate);
  }

  /** The same walk in the witness of a finding, up to the finding. */
  inWitness(run, finding) {
    const end = (finding.event ?? run.length - 1) + 1; // what follows names darts of this world
    return new Run(this.pictures[finding.witness], { ...run.recorded, end, identified: {}, findings: [] });
  }

  /** Ring the vertices of a pane at which the walks in world and witness part. */
  parting(pane, run) {
    const finding = this.witnessed(run, this.at(0));
    const there = this.inWitness(run, finding);
    const here = pane.picture === run.picture;
    const [mine, theirs] = here ? [run, there] : [there, run];
    const beside = new Map();
    const back = new Map();
    for (let when = 0; when < there.length; when += 1) {
      const [a, b] = [mine, theirs].map((one) => (one.position[when] < 0 ? 0 : one.picture.vertex[one.position[when]]));
      beside.set(a, (beside.get(a) ?? new Set()).add(b));
      back.set(b, (back.get(b) ?? new Set()).add(a));
    }
    for (const [vertex, others] of beside) {
      if (others.size < 2 && back.get([...others][0]).size < 2) continue;
      pane.ring(pane.picture.centres[vertex], 'ring part', pane.marks, 15);
    }
    pane.picture.edges.forEach(([dart], edge) => {
      const crossed = (mine.walked.get(edge) ?? Infinity) < there.length;
      if (!crossed) pane.path(pane.picture.trail(dart).data, 'way part', pane.under);
    });
  }

  // ---------------------------------------------------------------- one moment

  at(index) {
    return this.clock ? this.clock.event(index, this.tick) : 0;
  }

  /** The first event that a tick stands for: one of cost or of edges stands for several. */
  since(index) {
    const row = this.clock.rows[index];
    const tick = Math.min(this.tick, row.length - 1);
    return (row[tick - 1] ?? -1) + 1;
  }

  jump(tick, animate = 0) {
    this.tick = Math.max(0, Math.min(this.clock.last, tick));
    for (const pane of this.panes) pane.show(this.at(pane.index), animate);
    this.says.forEach((say, index) => say.show(this.runs[this.chosen[index]], this.at(index), this.since(index)));
    for (const chart of this.charts) chart.show(this.tick);
    const slider = byId('slider');
    slider.value = this.tick;
    const said = this.runs[this.chosen[0]].said(this.at(0));
    if (!this.timer) slider.setAttribute('aria-valuetext', `Step ${this.tick} of ${this.clock.last}: ${said.title}. ${said.text}`);
    this.counts();
    if (!this.timer) this.address();
  }

  /** Keep the step in the address, once it rests: browsers allow few changes a second. */
  address() {
    clearTimeout(this.resting);
    this.resting = setTimeout(() => byId('walk') ?? address(`#step=${this.tick}`), 120);
  }

  step(by) {
    this.pause();
    this.jump(this.tick + by, by === 1 && !CALM.matches ? 320 : 0);
  }

  /** The next tick (by = 1) or the previous one (-1) with a decision. */
  decision(by) {
    this.pause();
    const decides = (tick) =>
      this.chosen.some((number, index) => {
        const row = this.clock.rows[index];
        if (tick >= row.length) return false;
        for (let k = (row[tick - 1] ?? -1) + 1; k <= row[tick]; k += 1) if (this.runs[number].isDecision(k)) return true;
        return false;
      });
    let tick = this.tick + by;
    while (tick > 0 && tick < this.clock.last && !decides(tick)) tick += by;
    this.jump(tick);
  }

  /** The next finding; after the last one, the first. */
  finding(by = 1) {
    this.pause();
    const ticks = [...new Set(this.findings().map(({ tick }) => tick))];
    if (!ticks.length) return;
    const next = by > 0 ? ticks.find((tick) => tick > this.tick) ?? ticks[0] : ticks.findLast((tick) => tick < this.tick) ?? ticks.at(-1);
    this.jump(next);
  }

  // ---------------------------------------------------------------- playing

  play() {
    if (this.timer) return this.pause();
    if (this.tick >= this.clock.last) this.jump(0);
    byId('play').textContent = 'Pause';
    byId('says').setAttribute('aria-live', 'off');
    this.timer = 1;
    this.next(0);
  }

  pause() {
    if (!this.timer) return;
    clearTimeout(this.timer);
    cancelAnimationFrame(this.frame);
    this.timer = 0;
    byId('play').textContent = 'Play';
    byId('says').setAttribute('aria-live', 'polite');
    this.address();
  }

  next(wait) {
    const go = () => {
      if (this.tick >= this.clock.last) return this.pause();
      const pause = this.wait(this.tick + 1);
      this.jump(this.tick + 1, CALM.matches || pause < 100 ? 0 : pause * 0.7);
      this.next(pause);
    };
    if (wait < 16) this.frame = requestAnimationFrame(go);
    else this.timer = setTimeout(go, wait);
  }

  /** How long a tick is shown, in milliseconds. */
  wait(tick) {
    const { type } = this.runs[this.chosen[0]].events[this.clock.event(0, tick)];
    const long = this.chosen.length > 1 ? WAIT.move : WAIT[type] ?? 1000;
    return long / this.speed;
  }

  // ---------------------------------------------------------------- controls

  buttons() {
    const press = { before: () => this.decision(-1), back: () => this.step(-1), play: () => this.play() };
    Object.assign(press, { on: () => this.step(1), after: () => this.decision(1), finding: () => this.finding() });
    for (const [id, action] of Object.entries(press)) byId(id).addEventListener('click', action);
    byId('slider').addEventListener('input', (e) => {
      this.pause();
      this.jump(+e.target.value);
    });
    byId('speed').addEventListener('change', (e) => (this.speed = e.target.value === 'max' ? Infinity : +e.target.value));
    for (const id of ['known', 'darts']) {
      byId(id).addEventListener('change', (e) => document.body.classList.toggle(id, e.target.checked));
    }
    byId('ask').addEventListener('click', () => byId('help').showModal());
    const chart = byId('chart');
    const scrub = (e) => {
      if (e.target.tagName === 'BUTTON' || (e.type === 'pointermove' && !e.buttons)) return;
      this.pause();
      const { left, width } = chart.getBoundingClientRect();
      this.jump(Math.round(((e.clientX - left) / width) * this.clock.last));
    };
    chart.addEventListener('pointerdown', scrub);
    chart.addEventListener('pointermove', scrub);
  }

  keys() {
    const help = byId('help');
    const keys = {
      ArrowRight: () => this.step(1),
      ArrowLeft: () => this.step(-1),
      n: () => this.decision(1),
      p: () => this.decision(-1),
      f: () => this.finding(1),
      F: () => this.finding(-1),
      Home: () => this.go(0),
      End: () => this.go(this.clock.last),
      '+': () => this.frames[0].zoom(1.5),
      '-': () => this.frames[0].zoom(1 / 1.5),
      0: () => this.frames.forEach((one) => one.reset()),
      k: () => byId('known').click(),
      d: () => byId('darts').click(),
      '?': () => (help.open ? help.close() : help.showModal()),
    };
    addEventListener('keydown', (e) => {
      if (e.ctrlKey || e.metaKey || e.altKey || e.target.closest('select, input[type=text]')) return;
      if (help.open && e.key !== '?') return; // closed, it may keep the focus until the next frame
      if (e.key === ' ' && !e.target.closest('button, input[type=checkbox]')) this.play();
      else if (keys[e.key]) keys[e.key]();
      else return;
      e.preventDefault();
    });
  }

  go(tick) {
    this.pause();
    this.jump(tick);
  }

  zoomers(section, frame) {
    const group = html('div', 'zoomers', section);
    const all = { '+': ['Zoom in (+)', 1.5], '−': ['Zoom out (-)', 1 / 1.5], '○': ['See all (0)', 0] };
    for (const [text, [label, factor]] of Object.entries(all)) {
      const button = html('button', '', group, text);
      button.setAttribute('aria-label', label);
      button.title = label;
      button.addEventListener('click', () => frame.zoom(factor || 1e-9));
    }
  }

  // ---------------------------------------------------------------- choices, marks, legend

  choices() {
    const names = this.runs.map((run, k) => [String(k), run.name]);
    const chosen = this.chosen;
    this.select('first', names, String(chosen[0]), (value) => this.choose([+value, ...this.chosen.slice(1)]));
    const beside = [['', 'none'], ...names];
    this.select('second', beside, String(chosen[1] ?? ''), (value) => this.choose(value === '' ? [this.chosen[0]] : [this.chosen[0], +value]));
    this.select('clock', [['cost', 'moves'], ['edge', 'edges of the map']], this.kind === 'edge' ? 'edge' : 'cost', (value) => {
      this.kind = value;
      this.rearrange();
    });
    byId('compare').hidden = this.runs.length < 2;
    this.views();
  }

  views() {
    const run = this.runs[this.chosen[0]];
    const two = this.chosen.length > 1;
    const kinds = two ? ['world', 'map'] : this.witnessed(run, Infinity) ? ['map', 'witness'] : ['map'];
    if (this.view === 'best') this.view = this.lucky(run) ? 'witness' : 'map';
    if (!kinds.includes(this.view)) this.view = 'map';
    this.select('view', kinds.map((kind) => [kind, VIEWS[kind]]), this.view, (value) => {
      this.view = value;
      this.rearrange();
    });
    byId('views').hidden = kinds.length < 2;
    byId('clocks').hidden = !two;
  }

  select(id, options, value, change) {
    const select = byId(id);
    select.replaceChildren();
    for (const [key, text] of options) {
      const option = html('option', '', select, text);
      option.value = key;
    }
    select.value = value;
    select.onchange = () => change(select.value);
  }

  choose(chosen) {
    this.chosen = chosen;
    this.kind = this.kind === 'event' ? 'cost' : this.kind;
    this.views();
    this.rearrange();
  }

  /** Arrange anew, and stay at the event of the first run. */
  rearrange() {
    this.pause();
    const when = this.at(0);
    this.arrange();
    this.jump(this.clock.tick(0, Math.min(when, this.runs[this.chosen[0]].length - 1)));
  }

  marks() {
    const holder = html('div', 'findings', byId('chart'));
    for (const [tick, group] of [...this.grouped()].slice(0, 60)) {
      const button = html('button', '', holder);
      const text = group.map(({ one }) => `${one.claim}: ${one.message}`).join('\n');
      button.title = text;
      button.setAttribute('aria-label', `Finding at step ${tick}. ${text}`);
      button.style.left = `${(100 * tick) / Math.max(1, this.clock.last)}%`;
      button.addEventListener('click', () => this.go(tick));
    }
  }

  grouped() {
    const groups = new Map();
    for (const found of this.findings()) groups.set(found.tick, [...(groups.get(found.tick) ?? []), found]);
    return groups;
  }

  legend(runs) {
    const key = byId('key');
    key.replaceChildren();
    this.cells = [];
    const cell = (className, name, value) => {
      const span = html('span', '', key);
      if (className) html('i', className, span);
      span.append(`${name} `);
      const b = html('b', '', span);
      this.cells.push(() => (b.textContent = value()));
    };
    const one = runs.length === 1;
    const used = PURPOSES.filter((_, k) => runs.some((run) => run.costs[k].at(-1)));
    const alone = used.length === 1 && used[0] === 'other' ? used.pop() : '';
    for (const name of used) cell(name, PURPOSE_NAMES[name], () => runs.map((run, index) => run.costs[PURPOSES.indexOf(name)][this.at(index)]).join(' : '));
    if (one) cell(alone, 'moves', () => `${runs[0].costOf(this.at(0))} of ${runs[0].cost}`);
    else runs.forEach((run, index) => cell('', run.name, () => `${run.costOf(this.at(index))} of ${run.cost} moves`));
    if (this.recording.least_cost) cell('least', 'least', () => this.recording.least_cost);
    const unit = { event: 'step', cost: 'move', edge: 'edge' }[this.clock.kind];
    cell('', unit, () => `${this.tick} of ${this.clock.last}`);
  }

  counts() {
    for (const cell of this.cells) cell();
  }
}

/** The sentences of one run, the two glyphs, and what is found wrong. */
class Saying {
  constructor(holder, name) {
    this.section = html('section', 'card say', holder);
    const said = html('div', 'said', this.section);
    if (name) html('small', 'who', said, name);
    this.title = html('h3', '', said);
    this.text = html('p', '', said);
    this.wrong = html('ul', 'wrong', said);
    this.compared = html('div', 'compared', this.section);
    this.glyphs = ['it sees', 'it should see'].map((label, k) => {
      if (k) this.sign = html('b', '', this.compared);
      const figure = html('figure', '', this.compared);
      const svg = draw('svg', { viewBox: '-40 -40 80 80', class: 'glyph', 'aria-hidden': 'true' }, figure);
      return { figure, svg, label: html('figcaption', '', figure, label) };
    });
  }

  show(run, when, since) {
    const said = run.said(when);
    this.section.className = `card say ${said.kind}`;
    this.title.textContent = said.title;
    this.text.textContent = said.text;
    const found = run.findingsBetween(since, when);
    this.wrong.hidden = !found.length;
    const lines = [...found.map((one) => ['', `${one.claim}: ${one.message}`]), ...found.flatMap(({ remarks }) => remarks.map((one) => ['remark', one]))];
    this.wrong.replaceChildren(...lines.slice(0, 20).map(([kind, line]) => html('li', kind, null, line)));
    this.section.classList.toggle('found', found.length > 0);
    const { sees, should } = said;
    this.compared.classList.toggle('none', !sees);
    glyph(this.glyphs[0].svg, sees);
    glyph(this.glyphs[1].svg, should);
    this.glyphs.forEach(({ label }, k) => (label.textContent = said.labels[k]));
    this.glyphs[1].figure.classList.toggle('none', !should);
    const equal = sees && should && sees[0] === should[0] && sees[1] === should[1];
    this.sign.textContent = should ? (equal ? '=' : '≠') : '';
    this.sign.className = equal ? 'yes' : 'no';
  }
}

/** A percept as spokes: the exits around a place, the one by which it came in below. */
function glyph(svg, seen) {
  svg.replaceChildren();
  if (!seen) return;
  const [degree, marker] = seen;
  const shown = Math.min(degree, 60);
  for (let k = 0; k < shown; k += 1) {
    const a = Math.PI / 2 + (k * 2 * Math.PI) / degree;
    const at = (r) => `${short(r * Math.cos(a))} ${short(r * Math.sin(a))}`;
    draw('path', { d: `M${at(13)}L${at(k === marker ? 26 : 34)}`, class: k === marker ? 'shaft' : k ? '' : 'in' }, svg);
  }
  draw('circle', { r: 13 }, svg);
  if (marker !== null) draw('path', { class: 'tip', d: 'M38 0L22 8V-8Z', transform: `rotate(${90 + (marker * 360) / degree})` }, svg);
}
