/* Pictures of worlds: where vertices stand and how edges run, in the user space of the layout.

   A dart is a number, as in the world file. The trail of a dart runs from the centre of its vertex
   along its edge to the centre at the other end; an edge that leaves the cell of a torus and comes
   back has several parts. */

const SVG = 'http://www.w3.org/2000/svg';
const byId = (id) => document.getElementById(id);

/** A new SVG element with these attributes, inside `parent`; text stays text. */
/** Write this part of the address, without a step in the history. */
function address(hash) {
  try {
    history.replaceState(null, '', hash);
  } catch {
    /* a page inside a frame cannot change its address */
  }
}

function draw(name, attributes, parent, text) {
  const element = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  if (text !== undefined) element.textContent = text;
  if (parent) parent.append(element);
  return element;
}

/** A new HTML element with this class and text, inside `parent`. */
function html(name, className, parent, text) {
  const element = document.createElement(name);
  if (className) element.className = className;
  if (text !== undefined) element.textContent = text;
  if (parent) parent.append(element);
  return element;
}

/** The robot at the origin: a disc of this radius, its nose to the right. */
function drawRobot(parent, radius) {
  const bot = draw('g', { class: 'bot' }, parent);
  const size = draw('g', { transform: `scale(${radius / 13})` }, bot);
  draw('circle', { r: 13, class: 'body' }, size);
  draw('path', { d: 'M2-7L10 0L2 7Z', class: 'nose' }, size);
  return bot;
}

/** The marker: an arrow whose shaft goes from one point to another, the tip beyond. */
function drawMarker(parent, from, to, tip) {
  const [x, y] = [tip[0] - to[0], tip[1] - to[1]].map((d) => 0.55 * d);
  const group = draw('g', { class: 'marker' }, parent);
  draw('path', { class: 'shaft', d: `M${pair(from)}L${pair(to)}` }, group);
  draw('path', { class: 'tip', d: `M${pair(tip)}L${pair([to[0] - y, to[1] + x])}L${pair([to[0] + y, to[1] - x])}Z` }, group);
  return group;
}

/** The points of SVG path data (absolute M, L, Q, C): a list of points for each part. */
function flattened(data) {
  const parts = [];
  for (const [, command, numbers] of data.matchAll(/([MLQC])([^MLQC]*)/g)) {
    const values = (numbers.match(/-?[\d.]+(?:e-?\d+)?/g) || []).map(Number);
    const width = { M: 2, L: 2, Q: 4, C: 6 }[command];
    for (let k = 0; k + width <= values.length; k += width) {
      const control = values.slice(k, k + width);
      if (command === 'M' && k === 0) parts.push([control]);
      else curve(parts.at(-1), control);
    }
  }
  return parts;
}

/** Add the points of a Bézier curve of degree 1, 2 or 3, from the last point on. */
function curve(points, control) {
  if (control.length === 2) return void points.push(control);
  const ends = [points.at(-1)];
  for (let k = 0; k < control.length; k += 2) ends.push([control[k], control[k + 1]]);
  for (let n = 1; n <= 12; n += 1) {
    let row = ends;
    while (row.length > 1) {
      row = row.slice(1).map((p, k) => [0, 1].map((c) => row[k][c] + (p[c] - row[k][c]) * (n / 12)));
    }
    points.push(row[0]);
  }
}

/** A way through the picture, measured: where one is after so much of it. */
class Trail {
  constructor(parts) {
    this.parts = parts;
    this.length = 0;
    this.steps = []; // [length so far, from, to]
    for (const part of parts) {
      for (let k = 1; k < part.length; k += 1) {
        const long = Math.hypot(part[k][0] - part[k - 1][0], part[k][1] - part[k - 1][1]);
        if (long > 0) this.steps.push([this.length, part[k - 1], part[k], long]);
        this.length += long;
      }
    }
  }

  /** The point after so much of the way, and the direction there. */
  at(distance) {
    const s = Math.max(0, Math.min(this.length, distance));
    let low = 0;
    let high = this.steps.length - 1;
    if (high < 0) return { x: this.parts[0][0][0], y: this.parts[0][0][1], angle: 0 };
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (this.steps[middle][0] <= s) low = middle;
      else high = middle - 1;
    }
    const [before, [x, y], [u, v], long] = this.steps[low];
    const t = (s - before) / long;
    return { x: x + (u - x) * t, y: y + (v - y) * t, angle: Math.atan2(v - y, u - x) };
  }

  /** Path data of a piece of the way's first part, from one length to another. */
  piece(start, end) {
    const points = [];
    let sum = 0;
    const part = this.parts[0];
    for (let k = 1; k < part.length && sum < end; k += 1) {
      const [[x, y], [u, v]] = [part[k - 1], part[k]];
      const long = Math.hypot(u - x, v - y);
      const point = (length) => [x + ((u - x) * (length - sum)) / long, y + ((v - y) * (length - sum)) / long];
      if (long > 0 && sum + long > start) {
        if (!points.length) points.push(point(Math.max(start, sum)));
        points.push(point(Math.min(end, sum + long)));
      }
      sum += long;
    }
    return line(points.length ? points : [part[0]]);
  }

  /** Path data of all of it. */
  get data() {
    return this.parts.map(line).join('');
  }
}

const short = (number) => Math.round(number * 10) / 10;
const pair = ([x, y]) => `${short(x)} ${short(y)}`;
const line = (points) => points.map(([x, y], k) => `${k ? 'L' : 'M'}${short(x)} ${short(y)}`).join('');

/** A world with its picture. */
class Picture {
  constructor(world) {
    // vertices, edges, root, width, height, radius, centres, paths, bridges; of a cut surface sides, corners
    Object.assign(this, { sides: '', corners: [] }, world);
    this.vertex = [];
    this.place = [];
    this.vertices.forEach((rotation, vertex) =>
      rotation.forEach((dart, place) => {
        this.vertex[dart] = vertex;
        this.place[dart] = place;
      }),
    );
    this.other = [];
    this.edgeOf = [];
    this.edges.forEach(([a, b], edge) => {
      this.other[a] = b;
      this.other[b] = a;
      this.edgeOf[a] = this.edgeOf[b] = edge;
    });
    this.trails = new Map();
    this.near = this.nearest();
    this.crop();
  }

  /** Leave out the blank margin of the layout, so that a small world fills its pane. */
  crop() {
    const points = [...this.centres, ...this.corners, ...this.paths.flatMap(flattened).flat()], pad = 1.8 * this.radius;
    [['left', 'width', 0], ['top', 'height', 1]].forEach(([from, size, k]) => {
      const all = points.map((point) => point[k]), least = Math.max(0, Math.min(...all) - pad);
      this[size] = Math.min(this[size], Math.max(...all) + pad) - least;
      this[from] = least;
    });
  }

  /** The distance of a vertex to the nearest other one, where the picture is rather crowded. */
  nearest() {
    const places = this.centres;
    if (places.length < 2) return Infinity;
    const all = places.map(([x, y], k) => {
      let least = Infinity;
      places.forEach(([u, v], n) => n !== k && (least = Math.min(least, (u - x) ** 2 + (v - y) ** 2)));
      return Math.sqrt(least);
    });
    return all.sort((a, b) => a - b)[Math.floor(all.length / 10)];
  }

  /** Choose sizes for a pane of this size in screen pixels; `radius` and `unit` are in user space. */
  fit(width, height) {
    const pixel = 1 / Math.max(1e-6, Math.min(width / this.width, height / this.height));
    this.radius = Math.max(3.2 * pixel, Math.min(15 * pixel, 0.29 * this.near));
    this.unit = Math.max(this.radius / 13, 0.5 * pixel);
  }

  /** The dart that a door means to a robot with this reference dart. */
  turn(dart, door) {
    const rotation = this.vertices[this.vertex[dart]];
    return rotation[(this.place[dart] + door) % rotation.length];
  }

  /** What is seen with this reference dart: degree, and the door of the marker or null. */
  seen(dart) {
    if (dart < 0) return [this.vertices[0].length, null];
    const degree = this.vertices[this.vertex[dart]].length;
    const here = this.root !== null && this.vertex[this.root] === this.vertex[dart];
    const door = here ? (this.place[this.root] - this.place[dart] + degree) % degree : null;
    return [degree, door];
  }

  /** The way along the edge of a dart, from centre to centre. */
  trail(dart) {
    if (!this.trails.has(dart)) {
      const edge = this.edgeOf[dart];
      const [a, b] = this.edges[edge];
      const parts = flattened(this.paths[edge]);
      if (!parts.length) parts.push([]); // not shown: its ends lie outside the ball that is drawn
      parts[0].unshift(this.centres[this.vertex[a]]);
      parts.at(-1).push(this.centres[this.vertex[b]]);
      const forward = dart === a ? parts : parts.map((part) => part.slice().reverse()).reverse();
      this.trails.set(dart, new Trail(forward));
    }
    return this.trails.get(dart);
  }

  /** Whether the edge of a dart leaves the polygon by one side and comes back by another. */
  crosses(dart) {
    return flattened(this.paths[this.edgeOf[dart]]).length > 1;
  }

  /** The sides of the polygon: those with one colour and letter are one line of the surface. */
  drawSides(parent) {
    const group = draw('g', { class: 'sides' }, parent), { corners, sides } = this;
    const [cx, cy] = [0, 1].map((k) => corners.reduce((sum, corner) => sum + corner[k], 0) / corners.length);
    [...sides].forEach((letter, k) => {
      const [from, to] = [corners[k], corners[(k + 1) % corners.length]];
      draw('path', { d: `M${pair(from)}L${pair(to)}`, class: `side-${'abcd'[(letter.charCodeAt(0) - 97) % 4]}` }, group);
      const [x, y] = [0, 1].map((k) => (from[k] + to[k]) / 2), out = 12 * this.unit / Math.hypot(x - cx, y - cy);
      const at = { x: x + out * (x - cx), y: y + out * (y - cy) + 5 * this.unit };
      if (sides.length > 4) draw('text', { ...at, 'font-size': 15 * this.unit }, group, letter);
    });
    return group;
  }

  /** The direction in which a dart leaves its vertex. */
  angle(dart) {
    const [x, y] = this.centres[this.vertex[dart]];
    const trail = this.trail(dart);
    const p = trail.at(Math.min(this.radius + 2, trail.length / 2));
    return Math.atan2(p.y - y, p.x - x);
  }

  /** How much of a dart's edge is drawn while its other end is unknown. */
  stub(dart) {
    const long = this.trail(dart).length;
    return Math.min(this.radius * 2.9, Math.max(long * 0.42, this.radius * 1.3));
  }
}
