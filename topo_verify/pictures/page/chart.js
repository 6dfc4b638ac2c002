/* The cost so far, stacked by purpose, along a clock; ticks for decisions, a line for the least cost. */

const PURPOSE_NAMES = { walk: 'walking', cross: 'new', validate: 'testing', retrace: 'back', other: 'other' };

/** Which event of a run is shown at each tick: every event, every move, or every edge of S. */
class Clock {
  constructor(kind, runs) {
    this.kind = kind;
    this.rows = runs.map((run) => Clock.row(kind, run));
    this.last = Math.max(...this.rows.map((row) => row.length - 1));
  }

  static row(kind, run) {
    if (kind === 'event') return run.events.map((_, when) => when);
    const row = [0];
    run.events.forEach((one, when) => {
      if (kind === 'cost') row[run.costOf(when)] = when; // the last event of this cost stays
      else if (one.type === 'augment') row.push(when);
    });
    if (kind === 'edge' && row.at(-1) < run.length - 1) row.push(run.length - 1);
    return row;
  }

  event(index, tick) {
    const row = this.rows[index];
    return row[Math.min(tick, row.length - 1)];
  }

  /** The first tick at which an event has happened. */
  tick(index, when) {
    const row = this.rows[index];
    const found = row.findIndex((shown) => shown >= when);
    return found < 0 ? row.length - 1 : found;
  }
}

/** The chart of one run. */
class Chart {
  constructor(holder, run, clock, index, top, least) {
    Object.assign(this, { run, clock, index });
    this.svg = draw('svg', { preserveAspectRatio: 'none', 'aria-hidden': 'true' }, holder);
    const wide = Math.max(1, clock.last);
    this.svg.setAttribute('viewBox', `0 0 ${wide} 100`);
    const row = clock.rows[index];
    const height = (cost) => short(80 - (78 * cost) / Math.max(1, top));
    for (let from = 0; from < PURPOSES.length; from += 1) {
      if (!run.costs[from][run.length - 1]) continue;
      let data = 'M0 80';
      let before = null;
      row.forEach((when, tick) => {
        let sum = 0;
        for (let k = from; k < PURPOSES.length; k += 1) sum += run.costs[k][when];
        const y = height(sum);
        if (y !== before) data += `H${tick}V${y}`;
        before = y;
      });
      draw('path', { d: `${data}H${row.length - 1}V80Z`, class: PURPOSES[from] }, this.svg);
    }
    this.ticks();
    if (least > 0 && least <= top) draw('path', { d: `M0 ${height(least)}H${wide}`, class: 'least' }, this.svg);
    this.veil = draw('rect', { class: 'veil', y: 0, height: 100 }, this.svg);
    this.cursor = draw('path', { class: 'cursor' }, this.svg);
    this.wide = wide;
  }

  ticks() {
    const data = { rejected: '', confirmed: '', grown: '' };
    const { run, clock, index } = this;
    const width = Math.max(Math.min(0.7, clock.last / 120), clock.last / 900);
    const seen = new Set();
    clock.rows[index].forEach((when, tick) => {
      const before = tick ? clock.rows[index][tick - 1] : -1;
      for (let k = before + 1; k <= when; k += 1) {
        const { type, kind } = run.events[k];
        const name = { reject: 'rejected', confirm: 'confirmed', augment: kind === 'new' ? 'grown' : '' }[type];
        if (!name || seen.has(`${name}${tick}`)) continue;
        seen.add(`${name}${tick}`);
        data[name] += `M${short(tick - width / 2)} 86h${width}v13h-${width}Z`;
      }
    });
    for (const [name, d] of Object.entries(data)) if (d) draw('path', { d, class: name }, this.svg);
  }

  show(tick) {
    this.veil.setAttribute('x', tick);
    this.veil.setAttribute('width', Math.max(0, this.wide - tick));
    this.cursor.setAttribute('d', `M${tick} 0V100`);
  }
}
