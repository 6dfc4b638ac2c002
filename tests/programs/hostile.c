/* A mapper that maps worlds of one vertex, and skips others, but for one DEED in worlds whose marker
 * is at a place of degree 4: the first of them is m2/7. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "topo_verify.h"

static volatile int64_t sink;
static int64_t calls;

static int64_t deep(int64_t k) {
  volatile char big[4096];
  big[k & 4095] = 1;
  return deep(k + 1) + big[k & 4095];
}

static void crash(const tv_robot *r) { (void)r, *(volatile int64_t *)(intptr_t)sink = 1; }
static void leave(const tv_robot *r) { (void)r, exit(0); }
static void loop(const tv_robot *r) { (void)r; for (;;) sink++; }
static void look(const tv_robot *r) { for (;;) sink += tv_look(r).degree; }
static void walk(const tv_robot *r) { for (;;) sink += tv_move(r, 0).degree; }
static void overflow(const tv_robot *r) { (void)r, sink = deep(sink); }
static void write_world(const tv_robot *r) { for (int i = 0; i < 40; i++) ((int64_t *)r->world)[i] ^= 1; }
static void write_on(const tv_robot *r) { memset(r->world, 0xff, 1 << 24); }
static void write_before(const tv_robot *r) { ((int64_t *)r->world)[-1] = 7; }
static void write_robot(const tv_robot *r) { ((tv_robot *)r)->move = NULL; }
static void double_itself(const tv_robot *r) { (void)r, sink = fork(); }
static void close_all(const tv_robot *r) { (void)r; for (int f = 3; f < 1024; f++) close(f); }
static void once(const tv_robot *r) { (void)r; if (calls > 6) abort(); }
static void nothing(const tv_robot *r) { (void)r; }

void map_world(const tv_robot *r) {
  int64_t degree = tv_look(r).degree, ends[64], at = 0, cost = 0;
  calls++;
  if (degree == 4) DEED(r);
  for (int64_t e = 0; e < degree; e++) ends[e] = -1;
  for (int64_t e = 0; e < degree; e++) {
    if (ends[e] >= 0) continue;
    tv_percept p = tv_move(r, (e - at + degree) % degree);
    cost++;
    if (tv_refused(p)) return;
    if (p.marker < 0) {
      tv_skip(r, "several vertices");
      return;
    }
    at = (degree - p.marker) % degree;
    ends[e] = at, ends[at] = e;
  }
  tv_deliver(r, 1, &degree, ends, degree > 0 ? 0 : -1, cost);
  (void)crash, (void)leave, (void)loop, (void)look, (void)walk, (void)overflow, (void)once;
  (void)write_world, (void)write_on, (void)write_before, (void)write_robot, (void)double_itself;
  (void)close_all, (void)nothing;
}
