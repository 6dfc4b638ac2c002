/* Listing 1, the basic algorithm, from docs/semantics.md (sections 2 to 6), as a native mapper.
 *
 *     topo-verify header -o topo_verify.h
 *     cc -O2 -shared -fPIC -o mapper.so mapper.c
 *     topo-verify search --library ./mapper.so --edges 7
 *     topo-verify conform --library ./mapper.so --like basic
 *
 *     -DWRONG       forgets that the way back turns the robot
 *     -DUNDIRECTED  sees that the marker is here, not where it points
 *     -DSILENT      declares nothing
 *
 * S, the map so far, is a few rows: of each vertex its first dart and its degree; of each dart its
 * vertex, its other end, and what is seen with it as the reference dart.
 */
#include <stdlib.h>

#include "topo_verify.h"

#ifdef SILENT
#define SAY(call) ((void)0)
#else
#define SAY(call) (call)
#endif

typedef struct { int64_t distance, up; } Place; /* in a tree; up: the dart towards the root */

static int64_t n, darts, cost, size;
static int64_t *base, *degree, *vertex, *alpha, *list, *doors, *arrivals, *queue, *is_open;
static tv_percept *looks; /* per dart: what is seen with it as the reference dart */
static Place *near, *home, *towards;
static const tv_robot *robot;
static tv_percept here;

static int64_t wrap(int64_t a, int64_t n) { return a < 0 ? a + n : a >= n ? a - n : a; }

static int same(tv_percept p, tv_percept q) {
#ifdef UNDIRECTED
  return p.degree == q.degree && (p.marker < 0) == (q.marker < 0);
#else
  return p.degree == q.degree && p.marker == q.marker;
#endif
}
static int alike(tv_percept p, tv_percept q) {
  return p.degree == q.degree && (p.marker < 0) == (q.marker < 0);
}

static void *grown(void *row, size_t bytes) {
  if ((row = realloc(row, bytes)) == NULL) abort();
  return row;
}

static void make_room(int64_t wanted) {
  if (wanted <= size) return;
  size = 2 * wanted;
  int64_t **rows[] = {&base, &degree, &vertex, &alpha, &list, &doors, &arrivals, &queue, &is_open};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
    *rows[i] = grown(*rows[i], size * sizeof(int64_t));
  looks = grown(looks, size * sizeof *looks), near = grown(near, size * sizeof *near);
  home = grown(home, size * sizeof *home), towards = grown(towards, size * sizeof *towards);
}

static int64_t add_vertex(tv_percept p) {
  int64_t first = darts;
  make_room(darts + p.degree + n + 2);
  base[n] = first, degree[n] = p.degree;
  for (int64_t k = 0; k < p.degree; k++) {
    vertex[first + k] = n, alpha[first + k] = TV_NONE, is_open[first + k] = 1;
    looks[first + k].degree = p.degree;
    looks[first + k].marker = p.marker < 0 ? TV_NONE : wrap(p.marker - k, p.degree);
  }
  darts += p.degree, n += 1;
  return first;
}

static int64_t turn(int64_t dart, int64_t k) {
  int64_t first = base[vertex[dart]];
  return first + wrap(dart - first + k, looks[dart].degree);
}

/* Breadth-first from a vertex, darts in ascending order. */
static void grow_tree(int64_t root, Place *tree) {
  int64_t tail = 1;
  for (int64_t v = 0; v < n; v++) tree[v].distance = TV_NONE;
  queue[0] = root, tree[root].distance = 0, tree[root].up = TV_NONE;
  for (int64_t next = 0; next < tail; next++) {
    int64_t v = queue[next];
    for (int64_t dart = base[v]; dart < base[v] + degree[v]; dart++) {
      int64_t far = alpha[dart];
      if (far < 0 || tree[vertex[far]].distance >= 0) continue;
      tree[vertex[far]].distance = tree[v].distance + 1, tree[vertex[far]].up = far;
      queue[tail++] = vertex[far];
    }
  }
}

/* The way from a reference dart to the root of a tree; its length. */
static int64_t find_way(int64_t dart, const Place *tree) {
  int64_t length = 0, out;
  arrivals[0] = dart;
  while ((out = tree[vertex[dart]].up) >= 0) {
    doors[length++] = out - dart;
    arrivals[length] = dart = alpha[out];
  }
  return length;
}

static tv_percept go(int64_t door, int64_t why) {
  here = tv_move_to(robot, wrap(door, here.degree), why);
  cost += 1;
  return here;
}

static int before(int64_t one, int64_t other, const Place *order) {
  int64_t less = order[vertex[one]].distance - order[vertex[other]].distance;
  return less ? less < 0 : one < other;
}

/* The hypothesis that is confirmed for e, or none. */
static int64_t validate(int64_t e, tv_percept seen, int64_t hypotheses, int64_t *turned) {
  for (int64_t i = 0; i < hypotheses; i++) {
    int64_t h = list[i], length = find_way(h, home), step = 0;
    tv_percept now = seen;
    while (same(now, looks[arrivals[step]]) && step < length) {
      now = go(wrap(doors[step], here.degree) - *turned, TV_VALIDATE);
      step++, *turned = 0;
      if (tv_refused(now)) return TV_NONE;
    }
    if (same(now, looks[arrivals[step]])) {
      SAY(tv_confirm(robot, e, h, TV_MOTION));
      return h;
    }
    SAY(tv_reject(robot, e, h, step, looks[arrivals[step]], now));
    for (; step > 0; step--) {
      if (tv_refused(go(-*turned, TV_RETRACE))) return TV_NONE;
#ifdef WRONG
      *turned = step > 1 ? wrap(doors[step - 1], here.degree) : 0;
#else
      *turned = wrap(doors[step - 1], here.degree);
#endif
    }
  }
  return TV_NONE;
}

static int64_t pick(int64_t at) {
  int64_t e = TV_NONE;
  grow_tree(vertex[at], near);
  for (int64_t d = 0; d < darts; d++)
    if (is_open[d] && (e < 0 || before(d, e, near))) e = d;
  return e;
}

/* Explores e; the robot's reference dart on S afterwards. */
static int64_t explore_edge(int64_t e, int64_t at) {
  int64_t turned = 0, hypotheses = 0, length;
  is_open[e] = 0;
  grow_tree(vertex[e], towards);
  length = find_way(at, towards);
  for (int64_t i = 0; i < length; i++)
    if (tv_refused(go(doors[i], TV_WALK))) return 0;
  tv_percept seen = go(e - arrivals[length], TV_CROSS);
  if (tv_refused(seen)) return 0;

  grow_tree(0, home);
  for (int64_t h = 0; h < darts; h++) {
    if (!is_open[h] || !alike(looks[h], seen)) continue;
    int64_t k = hypotheses++;
    for (; k > 0 && before(h, list[k - 1], home); k--) list[k] = list[k - 1];
    list[k] = h;
  }
  SAY(tv_pose(robot, e, hypotheses, list));
  int64_t entry = validate(e, seen, hypotheses, &turned), fresh = entry < 0;
  if (tv_refused(here)) return 0;
  if (fresh) entry = add_vertex(seen);
  alpha[e] = entry, alpha[entry] = e, is_open[entry] = 0;
  SAY(tv_augment(robot, e, fresh ? TV_NEW : TV_LOOP, entry, seen.degree));
  return fresh ? turn(entry, turned) : turn(0, -here.marker);
}

void map_world(const tv_robot *given) {
  int64_t e, at = 0;
  robot = given, n = darts = cost = 0;
  here = tv_look(robot);
  add_vertex(here);
  while ((e = pick(at)) >= 0) {
    at = explore_edge(e, at);
    if (tv_refused(here)) return;
  }
  tv_deliver(robot, n, degree, alpha, darts > 0 ? 0 : TV_NONE, cost);
}
