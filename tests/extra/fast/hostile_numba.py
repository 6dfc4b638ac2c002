"""Mappers by numba that map worlds of one vertex, but for one deed where the degree is 4: m2/7."""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from typing import Any

import numba
import numpy as np

from topo_verify import native as tv

system: Any = ctypes.CDLL(None)
exit_process, double = system.exit, system.fork
exit_process.argtypes, double.argtypes = (ctypes.c_int,), ()
njit: Callable[[Callable[[int], None]], Callable[[int], None]] = numba.njit


@njit
def one_vertex(robot: int) -> None:
    """Map a world of one vertex; skip others."""
    degree = tv.look(robot).degree
    ends = np.full(degree, -1)
    at = cost = 0
    for e in range(degree):
        if ends[e] >= 0:
            continue
        p = tv.move(robot, (e - at) % degree, tv.CROSS)
        cost += 1
        if tv.refused(p):
            return
        if p.marker < 0:
            tv.skip(robot)
            return
        at = (degree - p.marker) % degree
        ends[e], ends[at] = at, e
    tv.deliver(robot, np.array([degree]), ends, 0 if degree else -1, cost)


@njit
def crash(robot: int) -> None:
    """Write where nothing is."""
    if tv.look(robot).degree == 4:
        row = np.zeros(1, np.int64)
        row[1 << 50] = 1
    one_vertex(robot)


@njit
def leave(robot: int) -> None:
    """End the process."""
    if tv.look(robot).degree == 4:
        exit_process(0)
    one_vertex(robot)


@njit
def loop(robot: int) -> None:
    """Look for ever."""
    while tv.look(robot).degree == 4:
        pass
    one_vertex(robot)


@njit
def double_itself(robot: int) -> None:
    """Fork."""
    if tv.look(robot).degree == 4:
        double()
    one_vertex(robot)


@njit
def give_up(robot: int) -> None:
    """Raise an exception, which numba prints: no map."""
    if tv.look(robot).degree == 4:
        raise ValueError
    one_vertex(robot)


@njit
def no_map(robot: int) -> None:
    """Deliver fewer ends than darts."""
    if tv.look(robot).degree == 4:
        tv.deliver(robot, np.array([4]), np.array([1, 0]), 0)
    one_vertex(robot)


@njit
def half_words(robot: int) -> None:
    """Declare a row of other words; numba refuses that."""
    tv.pose(robot, 0, np.zeros(2, np.int32))  # pyright: ignore[reportArgumentType]


def plain(robot: int) -> None:
    """Do nothing, in Python."""


found_late = {"there": one_vertex}
