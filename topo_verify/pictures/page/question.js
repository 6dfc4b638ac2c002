/* The question of a round: e, the unknown place behind it, and the guesses as numbered badges. */

class Question {
  constructor(pane, round) {
    Object.assign(this, { pane, round });
    const { picture, run, u, R } = pane;
    const { image } = run.map.darts[round.edge];
    const trail = picture.trail(image);
    const size = Math.max(8 * u, Math.min(13 * u, R * 0.9));
    const known = round.hypotheses.filter((h) => run.map.darts[h.dart]), ends = known.map((h) => pane.end(h.dart, 5 * u));
    const least = Math.min(R + 46 * u, Math.max(trail.length * 0.48, R + size + 4 * u), trail.length);
    const farther = [0, 14, 28, 42].map((more) => least + more * u).filter((far) => far < 0.6 * trail.length);
    const clear = (far) => ends.every(([x, y]) => Math.hypot(x - trail.at(far).x, y - trail.at(far).y) > 26 * u);
    const reach = farther.find(clear) ?? least; // beside no badge, where there is room
    const end = trail.at(reach);
    this.at = [end.x, end.y];
    this.below = draw('g', {}, pane.now);
    this.above = draw('g', {}, pane.over);
    pane.path(trail.piece(R, reach), 'e', this.below);
    this.unknown(size, end.angle + Math.PI, picture.seen(picture.other[image])[0]);
    this.guesses = known.map((h) => ({ h, arc: this.arc(h), badge: this.badge(h) }));
  }

  remove() {
    this.below.remove();
    this.above.remove();
  }

  /** The place behind e, with the exits that are seen there. */
  unknown(size, back, degree) {
    const [x, y] = this.at;
    for (let k = 1; k < Math.min(degree, 60); k += 1) {
      const a = back + (k * 2 * Math.PI) / degree;
      const spoke = (r) => `${short(x + size * r * Math.cos(a))} ${short(y + size * r * Math.sin(a))}`;
      this.pane.path(`M${spoke(1)}L${spoke(1.6)}`, 'spoke', this.above);
    }
    draw('circle', { cx: x, cy: y, r: size, class: 'unknown' }, this.above);
    draw('text', { x, y, 'font-size': size * 1.3, class: 'what' }, this.above, '?');
  }

  arc(h) {
    return this.pane.path(this.pane.arc(this.at, this.pane.end(h.dart, 5 * this.pane.u)), 'guess', this.below);
  }

  badge(h) {
    const { pane } = this;
    const [x, y] = pane.end(h.dart, 5 * pane.u);
    const size = Math.max(8.5, Math.min(10.5, (pane.R / pane.u) * 0.75)) * pane.u;
    const g = draw('g', { class: 'badge' }, this.above);
    draw('circle', { cx: x, cy: y, r: size }, g);
    draw('text', { x, y, 'font-size': size * 1.15 }, g, String(h.number));
    return g;
  }

  /** Show what is left of the guesses at an event. */
  show(when, tested) {
    for (const { h, arc, badge } of this.guesses) {
      const state = h.out > when ? '' : h.kept && !this.pane.run.isWrong(h.out) ? ' kept' : h.kept || h.out === when ? ' hot' : ' out';
      const kind = h.out < when && !h.kept ? 'off' : h === tested ? 'guess tested' : 'guess';
      if (badge.getAttribute('class') !== `badge${state}`) badge.setAttribute('class', `badge${state}`);
      if (arc.getAttribute('class') !== kind) arc.setAttribute('class', kind);
    }
  }
}
