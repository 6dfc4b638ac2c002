/* A native mapper for version 1 of topo_verify.h: it maps a single edge and declines a loop. */
#include "native_1.h"

void map_world(const tv_robot *robot) {
  const int64_t degrees[] = {1, 1}, ends[] = {1, 0};
  if (robot->version != 1 || tv_look(robot).degree != 1) {
    tv_skip(robot, "expected version 1 and a vertex of degree 1");
    return;
  }
  tv_percept seen = tv_move_to(robot, 0, TV_CROSS);
  if (tv_refused(seen)) return;
  tv_pose(robot, 0, 0, NULL);
  tv_augment(robot, 0, TV_NEW, 1, seen.degree);
  tv_deliver(robot, 2, degrees, ends, 0, 1);
}
