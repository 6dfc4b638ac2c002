/* Pan and zoom of a pane: the wheel, two fingers, dragging, and buttons; the keyboard uses the buttons. */

class Frame {
  /** `peers` are the frames of panes with the same picture: they move together. */
  constructor(layers, picture, peers) {
    Object.assign(this, { layers, picture, peers });
    this.fingers = new Map();
    layers.addEventListener('wheel', (e) => this.wheel(e), { passive: false });
    layers.addEventListener('pointerdown', (e) => this.down(e));
    layers.addEventListener('pointermove', (e) => this.drag(e));
    for (const end of ['pointerup', 'pointercancel']) layers.addEventListener(end, (e) => this.fingers.delete(e.pointerId));
    layers.addEventListener('dblclick', () => this.all(() => ({ x: 0, y: 0, zoom: 1 })));
  }

  reset() {
    this.set({ x: 0, y: 0, zoom: 1 });
  }

  set(view) {
    const { left, top, width, height } = this.picture;
    const zoom = Math.max(1, Math.min(40, view.zoom));
    const inside = (at, from, size) => Math.max(from, Math.min(from + size - size / zoom, at));
    this.view = { zoom, x: inside(view.x, left, width), y: inside(view.y, top, height) };
    const { x, y } = this.view;
    const box = `${short(x)} ${short(y)} ${short(width / zoom)} ${short(height / zoom)}`;
    for (const svg of this.layers.children) svg.setAttribute('viewBox', box);
  }

  all(change) {
    const view = change(this.view);
    for (const frame of this.peers) frame.set(view);
  }

  /** The point of the picture under a point of the screen. */
  under(clientX, clientY) {
    const matrix = this.layers.lastElementChild.getScreenCTM();
    return matrix ? new DOMPoint(clientX, clientY).matrixTransform(matrix.inverse()) : { x: 0, y: 0 };
  }

  /** Zoom by a factor around a point of the picture; default: the middle. */
  zoom(factor, point) {
    const { width, height } = this.picture;
    this.all(({ x, y, zoom }) => {
      const next = Math.max(1, Math.min(40, zoom * factor));
      const at = point ?? { x: x + width / zoom / 2, y: y + height / zoom / 2 };
      return { zoom: next, x: at.x - ((at.x - x) * zoom) / next, y: at.y - ((at.y - y) * zoom) / next };
    });
  }

  wheel(e) {
    e.preventDefault();
    this.zoom(Math.exp(-e.deltaY * (e.deltaMode ? 0.05 : 0.0015)), this.under(e.clientX, e.clientY));
  }

  down(e) {
    this.layers.setPointerCapture(e.pointerId);
    this.fingers.set(e.pointerId, e);
  }

  drag(e) {
    if (!this.fingers.has(e.pointerId)) return;
    const others = [...this.fingers.values()].filter((one) => one.pointerId !== e.pointerId);
    const last = this.fingers.get(e.pointerId);
    this.fingers.set(e.pointerId, e);
    if (others.length) {
      const apart = (one) => Math.hypot(one.clientX - others[0].clientX, one.clientY - others[0].clientY) || 1;
      return this.zoom(apart(e) / apart(last), this.under(others[0].clientX, others[0].clientY));
    }
    const from = this.under(last.clientX, last.clientY);
    const to = this.under(e.clientX, e.clientY);
    this.all(({ x, y, zoom }) => ({ zoom, x: x + from.x - to.x, y: y + from.y - to.y }));
  }
}
