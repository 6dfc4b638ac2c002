/* The example, right but for certain calls of its process, which MISDEEDS names:
 * "at 20 map from 60 skip" is a wrong map in the 20th call, and declining from the 60th on. */
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>
#define map_world good_world
#include "mapper.c"
#undef map_world

static int calls;
static const struct rlimit nothing;

static void detour(const tv_robot *r, int times) {
  for (int i = 0; i < 2 * times; i++) tv_move(r, 0);
}

void map_world(const tv_robot *r) {
  const char *plan = getenv("MISDEEDS");
  char when[8], deed[16];
  int number, read;
  calls++;
  for (; plan && sscanf(plan, "%7s %d %15s%n", when, &number, deed, &read) == 3; plan += read) {
    if (calls != number && (strcmp(when, "from") || calls < number)) continue;
    if (!strcmp(deed, "map")) tv_deliver(r, 0, 0, 0, -1, -1);
    if (!strcmp(deed, "nothing")) return;
    if (!strcmp(deed, "skip")) tv_skip(r, "not today");
    if (!strcmp(deed, "error")) tv_move(r, -7);
    if (!strcmp(deed, "hang")) sleep(60);
    if (!strcmp(deed, "kill")) kill(getpid(), SIGKILL);
    if (!strcmp(deed, "doors")) detour(r, 1);
    if (!strcmp(deed, "cost")) detour(r, 2);
    if (!strcmp(deed, "files")) setrlimit(RLIMIT_NOFILE, &nothing);
    if (!strcmp(deed, "memory")) while (malloc(1 << 20));
    if (!strcmp(deed, "parent")) kill(getppid(), SIGTERM);
    if (!strcmp(deed, "robot")) ((tv_robot *)r)->version = 2;
    if (!strcmp(deed, "engine") && r->world) abort(); /* behind the pipe there is no world */
  }
  good_world(r);
}
