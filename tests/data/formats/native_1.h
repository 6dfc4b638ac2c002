/* topo_verify.h: the interface of native mappers, version 1.
 *
 * A mapper is one function. It is given a robot that stands at the marker of an unknown world; it
 * moves the robot, may declare what it decides, delivers a map, and returns.
 *
 *     #include "topo_verify.h"
 *     void map_world(const tv_robot *robot) { ... }
 *
 *     topo-verify header -o topo_verify.h
 *     cc -O2 -shared -fPIC -o mapper.so mapper.c
 *     topo-verify search --library ./mapper.so:map_world --edges 8
 *
 * The same function is called for millions of worlds in one process, one after the other, never
 * twice at a time, and from one thread. It may keep memory between calls (a buffer that has grown, say); what it decides
 * may depend on nothing but what it was shown since the call, or the same world can give another
 * run, and is then UNKNOWN.
 *
 * A world is a map: vertices, and around each vertex its doors, clockwise. The robot always has a
 * reference door, by which it came in; door k is the k-th clockwise from it, and door 0 goes back.
 * The marker stands at one vertex and points at one door of it.
 *
 * The map S of a mapper: darts 0, 1, 2, ... Vertex v0 is where the marker is, dart 0 is the one that
 * the marker points at, and a vertex that is added takes the next numbers, clockwise from the dart
 * by which it was entered. Declarations speak of these darts (docs/semantics.md, section 3). Who
 * declares nothing is judged on percepts, map and cost, and may number darts as it likes.
 *
 * Every number is 64 bits wide and signed; one that is declared lies between -2^62 and 2^62. The
 * functions below are inline: what the library and topo-verify share is `tv_robot` alone.
 */
#ifndef TOPO_VERIFY_H
#define TOPO_VERIFY_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define TV_VERSION 1
#define TV_NONE (-1) /* no marker, no dart, no cost, no percept */

/* What the robot senses: how many doors there are, and behind how many doors clockwise from the
 * reference door the marker's is; TV_NONE if the marker is not here. After a refusal (see
 * `tv_refused`) the degree is TV_NONE. */
typedef struct tv_percept {
  int64_t degree, marker;
} tv_percept;

/* Why the robot moves: a hint for reports and pictures; no claim depends on it. */
enum { TV_UNSAID = -1, TV_WALK, TV_CROSS, TV_VALIDATE, TV_RETRACE };

/* The rule that decides, and the kind of an augmentation. */
enum { TV_MOTION, TV_PREFIX, TV_HISTORY, TV_RECORDS, TV_FOLDING, TV_PLANAR };
enum { TV_NEW = 1, TV_LOOP = 2 };

/* What contradicts a hypothesis of rules TV_FOLDING and TV_PLANAR. */
enum { TV_UNLIKE = 1, TV_TURNED_ITSELF, TV_OWN_OTHER_END, TV_TWO_OF_S, TV_OTHER_FACE };

/* The evidence of a rejection: at this step of the hypothesis' way home (or of a sequence that was
 * executed before, counted from 0 for this edge) another percept was expected than was observed.
 * TV_EVIDENCE has nothing in it but the step; set what the rule says.
 * Percepts are words here: `tv_word`. */
typedef struct tv_evidence {
  int64_t step, expected, observed, sequence, at, record, contradiction;
} tv_evidence;
#define TV_EVIDENCE {0, TV_NONE, TV_NONE, TV_NONE, TV_NONE, TV_NONE, 0}

/* The robot. Opaque but for the calls below: do not write to it and do not call its members. */
typedef struct tv_robot {
  int64_t version; /* TV_VERSION of the program that calls */
  void *world;
  int64_t (*look)(void *);
  int64_t (*move)(void *, int64_t door, int64_t purpose);
  int64_t (*pose)(void *, int64_t edge, int64_t count, const int64_t *hypotheses);
  int64_t (*reject)(void *, int64_t edge, int64_t hypothesis, int64_t rule, const tv_evidence *,
                    int64_t count, const int64_t *doors);
  int64_t (*confirm)(void *, int64_t edge, int64_t hypothesis, int64_t rule);
  int64_t (*augment)(void *, int64_t edge, int64_t kind, int64_t dart, int64_t degree);
  int64_t (*deliver)(void *, int64_t vertices, const int64_t *degrees, const int64_t *ends,
                     int64_t marker, int64_t cost);
  int64_t (*skip)(void *, const char *why);
} tv_robot;

/* A percept as one word: 65536 * degree, and 1 + marker if the marker is here; -1: none. */
static inline int64_t tv_word(tv_percept p) { return p.degree * 65536 + p.marker + 1; }
static inline tv_percept tv_percept_of(int64_t word) {
  tv_percept p;
  p.degree = word >> 16; /* -1 of a refusal */
  p.marker = word < 0 ? TV_NONE : (word & 65535) - 1;
  return p;
}

/* ---------------------------------------------------------------- sense and move */

/* The percept where the robot stands; costs nothing. */
static inline tv_percept tv_look(const tv_robot *r) { return tv_percept_of(r->look(r->world)); }

/* Leave by a door, 0 ... degree - 1: the percept behind it. Costs 1. */
static inline tv_percept tv_move(const tv_robot *r, int64_t door) {
  return tv_percept_of(r->move(r->world, door, TV_UNSAID));
}
static inline tv_percept tv_move_to(const tv_robot *r, int64_t door, int64_t purpose) {
  return tv_percept_of(r->move(r->world, door, purpose));
}

/* The robot refuses for good: a door that is not there, one more move than the bound of claim 7, a
 * declaration or a map that is none. The run is judged by what came before: return. */
static inline int tv_refused(tv_percept p) { return p.degree < 0; }

/* ---------------------------------------------------------------- declare: optional
 *
 * Each returns 0, or why the robot refuses. Order: docs/semantics.md, sections 4 to 8. */

/* H: the unexplored darts by which the place behind `edge` may have been entered. */
static inline int64_t tv_pose(const tv_robot *r, int64_t edge, int64_t count,
                              const int64_t *hypotheses) {
  return r->pose(r->world, edge, count, hypotheses);
}

/* Rejected by motion: after `step` doors of its way home this was expected and that observed. */
static inline int64_t tv_reject(const tv_robot *r, int64_t edge, int64_t hypothesis, int64_t step,
                                tv_percept expected, tv_percept observed) {
  tv_evidence evidence = TV_EVIDENCE;
  evidence.step = step;
  evidence.expected = tv_word(expected);
  evidence.observed = tv_word(observed);
  return r->reject(r->world, edge, hypothesis, TV_MOTION, &evidence, 0, NULL);
}

/* Rejected by a rule; `doors`: of a record, from the dart `evidence->record` on. */
static inline int64_t tv_reject_by(const tv_robot *r, int64_t edge, int64_t hypothesis,
                                   int64_t rule, const tv_evidence *evidence, int64_t count,
                                   const int64_t *doors) {
  return r->reject(r->world, edge, hypothesis, rule, evidence, count, doors);
}

static inline int64_t tv_confirm(const tv_robot *r, int64_t edge, int64_t hypothesis,
                                 int64_t rule) {
  return r->confirm(r->world, edge, hypothesis, rule);
}

/* S grows: `edge` ends in `dart`, the first of a new vertex (TV_NEW) or one it has (TV_LOOP). */
static inline int64_t tv_augment(const tv_robot *r, int64_t edge, int64_t kind, int64_t dart,
                                 int64_t degree) {
  return r->augment(r->world, edge, kind, dart, degree);
}

/* ---------------------------------------------------------------- deliver
 *
 * The map: of each vertex its degree; of each dart the dart at the other end of its edge. Darts are
 * numbered vertex by vertex, clockwise around each. `marker`: the dart that the marker points at;
 * TV_NONE where there is no dart. `cost`: the moves made, or TV_NONE if the mapper does not count.
 * Once; nothing counts after it. Who returns without it has delivered no map. */
static inline int64_t tv_deliver(const tv_robot *r, int64_t vertices, const int64_t *degrees,
                                 const int64_t *ends, int64_t marker, int64_t cost) {
  return r->deliver(r->world, vertices, degrees, ends, marker, cost);
}

/* Decline this world, and say why (UTF-8, or NULL): it counts as neither right nor wrong. Return
 * after it. */
static inline int64_t tv_skip(const tv_robot *r, const char *why) {
  return r->skip(r->world, why);
}

#ifdef __cplusplus
}
#endif
#endif
