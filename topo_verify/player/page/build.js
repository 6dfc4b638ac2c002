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
    left.note.textContent = `${world.vertices.length} place${world.vertices.length === 1 ? '' : 's'}, ${world.edges.length} road${world.edges.length === 1 ? '' : 's'}, genus ${world.genus()}`;
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
