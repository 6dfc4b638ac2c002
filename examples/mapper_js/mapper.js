// Listing 1, the basic algorithm, from docs/semantics.md alone (sections 2 to 6), as a program of
// protocol 1: percepts come in on standard input, doors go out on standard output.
//
//     node mapper.js
//     node mapper.js --wrong        ignores where the marker points
"use strict";
const fs = require("fs");

// ---------------------------------------------------------------- one JSON object a line

let rest = "";
const chunk = Buffer.alloc(65536);

function hear() {
  for (;;) {
    const end = rest.indexOf("\n");
    if (end >= 0) {
      const line = rest.slice(0, end);
      rest = rest.slice(end + 1);
      return JSON.parse(line);
    }
    const bytes = fs.readSync(0, chunk, 0, chunk.length, null);
    if (bytes === 0) return { type: "stop" };
    rest += chunk.toString("utf8", 0, bytes);
  }
}

let pending = "";

function say(message) {
  pending += JSON.stringify(message) + "\n"; // declarations are not answered: they can wait
  if (message.type !== "declare") {
    for (let left = Buffer.from(pending); left.length; ) left = left.subarray(fs.writeSync(1, left));
    pending = "";
  }
}

// ---------------------------------------------------------------- a world

const mod = (a, n) => ((a % n) + n) % n;
const alikeTo = (p) => (q) => p.degree === q.degree && (p.marker === null) === (q.marker === null);
const wrong = process.argv.includes("--wrong");
const same = (p, q) => (wrong || p.marker === q.marker) && alikeTo(p)(q);

function explore(start) {
  const base = [], vertex = [], looks = [], alpha = new Map(), unexplored = new Set();
  let percept = start, cost = 0;

  function addVertex({ degree, marker }) {
    base.push(vertex.length);
    for (let k = 0; k < degree; k++) {
      unexplored.add(vertex.length);
      vertex.push(base.length - 1);
      looks.push({ degree, marker: marker === null ? null : mod(marker - k, degree) });
    }
    return base[base.length - 1];
  }

  function turn(dart, k) { // the dart that door k means to a robot with this reference dart
    const first = base[vertex[dart]];
    return first + mod(dart - first + k, looks[dart].degree);
  }

  function tree(root) { // for each vertex: its distance from the root, its dart towards it
    const found = new Map([[root, { distance: 0, up: null }]]), queue = [root];
    for (const v of queue) {
      for (let dart = base[v]; dart < base[v] + looks[base[v]].degree; dart++) {
        const far = alpha.get(dart);
        if (far === undefined || found.has(vertex[far])) continue;
        found.set(vertex[far], { distance: found.get(v).distance + 1, up: far });
        queue.push(vertex[far]);
      }
    }
    return found;
  }

  function way(dart, towards) { // to the root of a tree: doors, and the darts of arrival
    const doors = [], arrivals = [dart];
    for (let out; (out = towards.get(vertex[dart]).up) !== null; arrivals.push(dart)) {
      doors.push(out - dart);
      dart = alpha.get(out);
    }
    return { doors, arrivals };
  }

  function go(door, purpose) { // the purpose is for pictures of the run
    say({ type: "move", door: mod(door, percept.degree), purpose });
    const { degree, marker } = hear();
    cost += 1;
    percept = { degree, marker };
    return percept;
  }

  const first = (darts, tree) => // by distance, then by dart
    darts.sort((a, b) => tree.get(vertex[a]).distance - tree.get(vertex[b]).distance || a - b);

  if (percept.degree > 0) addVertex(percept);
  let at = 0;
  while (unexplored.size) {
    const [e] = first([...unexplored], tree(vertex[at])), home = tree(0);
    const declare = (type, fields) => say({ type: "declare", event: { type, edge: e, ...fields } });
    unexplored.delete(e);
    const walk = way(at, tree(vertex[e]));
    for (const door of walk.doors) go(door, "walk");
    const seen = go(e - walk.arrivals[walk.arrivals.length - 1], "cross");
    const looksAlike = alikeTo(seen);
    const hypotheses = first([...unexplored].filter((h) => looksAlike(looks[h])), home);
    declare("pose", { hypotheses });

    let entry = null, turned = 0;
    for (const h of hypotheses) {
      const { doors, arrivals } = way(h, home);
      let now = seen, step = 0;
      for (; same(now, looks[arrivals[step]]) && step < doors.length; step++) {
        now = go(doors[step] - turned, "validate");
        turned = 0;
      }
      const expected = looks[arrivals[step]];
      if (same(now, expected)) {
        declare("confirm", { hypothesis: h, rule: "motion" });
        entry = h;
        break;
      }
      const evidence = { step, expected, observed: now };
      declare("reject", { hypothesis: h, rule: "motion", evidence });
      for (const door of doors.slice(0, step).reverse()) {
        go(-turned, "retrace");
        turned = door;
      }
    }

    const kind = entry === null ? "new" : "loop";
    if (entry === null) entry = addVertex(seen);
    alpha.set(e, entry).set(entry, e);
    unexplored.delete(entry);
    declare("augment", { kind, dart: entry, degree: seen.degree });
    at = kind === "new" ? turn(entry, turned) : turn(0, -percept.marker);
  }

  const vertices = base.map((d) => Array.from({ length: looks[d].degree }, (_, k) => d + k));
  const edges = [...alpha].filter(([d, other]) => d < other).sort(([a], [b]) => a - b);
  const map = { vertices: base.length ? vertices : [[]], edges, marker: base.length ? 0 : null };
  say({ type: "done", map, cost });
}

for (let message = hear(); message.type === "start"; message = hear()) explore(message.percept);
