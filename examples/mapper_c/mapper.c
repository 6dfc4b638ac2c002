/* Listing 1, the basic algorithm, from docs/semantics.md alone (sections 2 to 6), as a program of
 * protocol 1: percepts come in on standard input, doors go out on standard output.
 *
 *     cc -O2 -o mapper mapper.c
 *     cc -O2 -DWRONG -o wrong mapper.c      forgets that the way back turns the robot
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NONE = -1 };

typedef struct { long degree, marker; } Percept; /* marker: NONE if it is not here */
typedef struct { long distance, up; } Place;     /* in a tree; up: the dart towards the root */

static void *grown(void *row, size_t bytes) {
  if ((row = realloc(row, bytes)) == NULL) { fputs("out of memory\n", stderr); exit(1); }
  return row;
}

static long mod(long a, long n) { return ((a % n) + n) % n; }
static int same(Percept p, Percept q) { return p.degree == q.degree && p.marker == q.marker; }
static int alike(Percept p, Percept q) {
  return p.degree == q.degree && (p.marker == NONE) == (q.marker == NONE);
}

/* ---------------------------------------------------------------- one JSON object a line */

static char *line;
static size_t room;

static int hear(void) { return getline(&line, &room, stdin) > 0; }

/* The percept in the line. Our side of the protocol has numbers only where the names are ours. */
static Percept percept_in_line(void) {
  char *degree = strstr(line, "\"degree\""), *marker = strstr(line, "\"marker\"");
  if (degree == NULL || marker == NULL) { fprintf(stderr, "no percept: %s", line); exit(1); }
  degree += strlen("\"degree\""), marker += strlen("\"marker\"");
  degree += strspn(degree, ": "), marker += strspn(marker, ": ");
  return (Percept){atol(degree), *marker == 'n' ? NONE : atol(marker)};
}

static void say_percept(const char *name, Percept p) {
  printf("\"%s\":{\"degree\":%ld,\"marker\":", name, p.degree);
  p.marker == NONE ? printf("null}") : printf("%ld}", p.marker);
}

/* ---------------------------------------------------------------- the map S, and the robot */

static long n, *base;                            /* per vertex: its first dart */
static long darts, size, *vertex, *alpha, *list; /* per dart; alpha: NONE if unexplored */
static Percept *looks;                           /* per dart: what is seen with it as reference */
static char *open_dart;                          /* per dart: in U? */
static Place *near, *home, *towards;             /* per vertex: three trees */
static long *doors, *arrivals, *queue;           /* a way; a queue of vertices */
static Percept here;
static long cost;

static long add_vertex(Percept p) {
  long first = darts;
  darts += p.degree, n += 1;
  if (darts + n > size) {
    size = 2 * (darts + n);
    vertex = grown(vertex, size * sizeof *vertex), alpha = grown(alpha, size * sizeof *alpha);
    list = grown(list, size * sizeof *list), looks = grown(looks, size * sizeof *looks);
    open_dart = grown(open_dart, size), base = grown(base, size * sizeof *base);
    near = grown(near, size * sizeof *near), home = grown(home, size * sizeof *home);
    towards = grown(towards, size * sizeof *towards), queue = grown(queue, size * sizeof *queue);
    doors = grown(doors, size * sizeof *doors), arrivals = grown(arrivals, size * sizeof *arrivals);
  }
  base[n - 1] = first;
  for (long k = 0; k < p.degree; k++) {
    vertex[first + k] = n - 1, alpha[first + k] = NONE, open_dart[first + k] = 1;
    looks[first + k] = (Percept){p.degree, p.marker == NONE ? NONE : mod(p.marker - k, p.degree)};
  }
  return first;
}

/* The dart that door k means to a robot with this reference dart. */
static long turn(long dart, long k) {
  long first = base[vertex[dart]];
  return first + mod(dart - first + k, looks[dart].degree);
}

/* Breadth-first from a vertex, darts in ascending order. */
static void grow_tree(long root, Place *tree) {
  long tail = 1;
  for (long v = 0; v < n; v++) tree[v].distance = NONE;
  queue[0] = root, tree[root] = (Place){0, NONE};
  for (long next = 0; next < tail; next++) {
    long v = queue[next];
    for (long dart = base[v]; dart < base[v] + looks[base[v]].degree; dart++) {
      long far = alpha[dart];
      if (far == NONE || tree[vertex[far]].distance != NONE) continue;
      tree[vertex[far]] = (Place){tree[v].distance + 1, far};
      queue[tail++] = vertex[far];
    }
  }
}

/* The way from a reference dart to the root of a tree; its length. */
static long find_way(long dart, const Place *tree) {
  long length = 0, out;
  arrivals[0] = dart;
  while ((out = tree[vertex[dart]].up) != NONE) {
    doors[length++] = out - dart;
    arrivals[length] = dart = alpha[out];
  }
  return length;
}

static Percept go(long door, const char *purpose) { /* the purpose is for pictures of the run */
  printf("{\"type\":\"move\",\"door\":%ld,\"purpose\":\"%s\"}\n", mod(door, here.degree), purpose);
  fflush(stdout);
  if (!hear()) exit(1);
  cost += 1;
  return here = percept_in_line();
}

/* ---------------------------------------------------------------- the loop */

static const Place *order; /* by distance in this tree, then by dart */

static int before(const void *a, const void *b) {
  long one = *(const long *)a, other = *(const long *)b;
  long less = order[vertex[one]].distance - order[vertex[other]].distance;
  return less ? (less > 0) - (less < 0) : (one > other) - (one < other);
}

/* The hypothesis that is confirmed for e, or NONE. The robot is at v0, or back where it was. */
static long validate(long e, Percept seen, long hypotheses, long *turned) {
  for (long i = 0; i < hypotheses; i++) {
    long h = list[i], length = find_way(h, home), step = 0;
    Percept now = seen;
    while (same(now, looks[arrivals[step]]) && step < length) {
      now = go(doors[step++] - *turned, "validate");
      *turned = 0;
    }
    printf("{\"type\":\"declare\",\"event\":{\"edge\":%ld,\"hypothesis\":%ld,\"rule\":\"motion\",", e, h);
    if (same(now, looks[arrivals[step]])) {
      printf("\"type\":\"confirm\"}}\n");
      return h;
    }
    printf("\"type\":\"reject\",\"evidence\":{\"step\":%ld,", step);
    say_percept("expected", looks[arrivals[step]]), putchar(',');
    say_percept("observed", now), printf("}}}\n");
    for (; step > 0; step--) {
      go(-*turned, "retrace");
#ifdef WRONG
      *turned = step > 1 ? doors[step - 1] : 0;
#else
      *turned = doors[step - 1];
#endif
    }
  }
  return NONE;
}

static long pick(long at) {
  long e = NONE;
  grow_tree(vertex[at], near);
  order = near;
  for (long d = 0; d < darts; d++)
    if (open_dart[d] && (e == NONE || before(&d, &e) < 0)) e = d;
  return e;
}

/* Explores e; the robot's reference dart on S afterwards. */
static long explore_edge(long e, long at) {
  long turned = 0, hypotheses = 0, length;
  open_dart[e] = 0;
  grow_tree(vertex[e], towards);
  length = find_way(at, towards);
  for (long i = 0; i < length; i++) go(doors[i], "walk");
  Percept seen = go(e - arrivals[length], "cross");

  grow_tree(0, home);
  for (long h = 0; h < darts; h++)
    if (open_dart[h] && alike(looks[h], seen)) list[hypotheses++] = h;
  order = home;
  qsort(list, hypotheses, sizeof *list, before);
  printf("{\"type\":\"declare\",\"event\":{\"type\":\"pose\",\"edge\":%ld,\"hypotheses\":[", e);
  for (long i = 0; i < hypotheses; i++) printf(i ? ",%ld" : "%ld", list[i]);
  printf("]}}\n");

  long entry = validate(e, seen, hypotheses, &turned), new = entry == NONE;
  if (new) entry = add_vertex(seen);
  alpha[e] = entry, alpha[entry] = e, open_dart[entry] = 0;
  printf("{\"type\":\"declare\",\"event\":{\"type\":\"augment\",\"edge\":%ld,\"kind\":\"%s\",", e,
         new ? "new" : "loop");
  printf("\"dart\":%ld,\"degree\":%ld}}\n", entry, seen.degree);
  return new ? turn(entry, turned) : turn(0, -here.marker);
}

static void deliver(void) {
  printf("{\"type\":\"done\",\"cost\":%ld,\"map\":{\"vertices\":[", cost);
  for (long v = 0; v < n; v++) {
    printf(v ? ",[" : "[");
    for (long k = 0; k < looks[base[v]].degree; k++) printf(k ? ",%ld" : "%ld", base[v] + k);
    printf("]");
  }
  printf(n ? "],\"edges\":[" : "[]],\"edges\":[");
  for (long d = 0, some = 0; d < darts; d++)
    if (d < alpha[d]) printf(some++ ? ",[%ld,%ld]" : "[%ld,%ld]", d, alpha[d]);
  printf("],\"marker\":%s}}\n", n ? "0" : "null");
  fflush(stdout);
}

int main(void) {
  while (hear() && strstr(line, "\"start\"") != NULL) {
    long e, at = 0;
    n = darts = cost = 0;
    here = percept_in_line();
    if (here.degree > 0) {
      add_vertex(here);
      while ((e = pick(at)) != NONE) at = explore_edge(e, at);
    }
    deliver();
  }
  return 0;
}
