"""Native mappers in Python: what a function that numba compiles does with its robot.

    import numba
    from topo_verify import native as tv

    @numba.njit
    def explore(robot): ...              # topo-verify search --library my_mapper.py:explore

The functions are those of `topo_verify.h`, without `tv_`; that file describes them. A robot is
the address of its `tv_robot`. Rows are contiguous numpy arrays of int64; numba refuses others
when it compiles the mapper. Importing this module imports numba.
"""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

import numpy as np
from numba import njit
from numba.core.errors import TypingError
from numba.extending import intrinsic

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Row = NDArray[np.int64]

F = TypeVar("F", bound=Callable[..., Any])

ir: Any = import_module("llvmlite.ir")
types: Any = import_module("numba.types")  # neither has types
_njit: Any = njit

NONE = -1
"""No marker, dart, cost or percept: `TV_NONE`."""

UNSAID, WALK, CROSS, VALIDATE, RETRACE = -1, 0, 1, 2, 3
"""Purposes of a move."""

MOTION, PREFIX, HISTORY, RECORDS, FOLDING, PLANAR = range(6)
"""Rules that decide."""

NEW, LOOP = 1, 2
"""Kinds of an augmentation."""

UNLIKE, TURNED_ITSELF, OWN_OTHER_END, TWO_OF_S, OTHER_FACE = range(1, 6)
"""Contradictions of `FOLDING` and `PLANAR`."""

_WORLD, _LOOK, _MOVE, _POSE, _REJECT, _CONFIRM, _AUGMENT, _DELIVER, _SKIP = range(1, 10)
"""Where the members of `tv_robot` stand."""

_NO_DOORS = np.zeros(1, np.int64)[:0]


def _compiled(function: F) -> F:
    kernel: F = _njit(function)
    return kernel


class NativePercept(NamedTuple):
    """A percept of the robot: `tv_percept`. After a refusal the degree is `NONE`."""

    degree: int
    marker: int


def _called(_typing: Any, _robot: Any, _member: Any, given: Any) -> Any:
    """Call a member of the robot with its world and these words and rows."""
    for argument in given:
        if isinstance(argument, types.Array) and (
            argument.dtype,
            argument.ndim,
            argument.layout,
        ) != (
            types.int64,
            1,
            "C",
        ):
            raise TypingError(f"expected a row of int64 without gaps, got {argument}")
        if not isinstance(argument, types.Array | types.Integer | types.Boolean):
            raise TypingError(f"expected an integer or a row of int64, got {argument}")
    word = ir.IntType(64)

    def generate(context: Any, builder: Any, _signature: Any, values: Any) -> Any:
        robot, member, each = values
        members = builder.inttoptr(robot, word.as_pointer())
        words = [builder.load(builder.gep(members, [ir.Constant(word, _WORLD)]))]
        for k, kind in enumerate(given):
            value = builder.extract_value(each, k)
            if isinstance(kind, types.Array):
                row = context.make_array(kind)(context, builder, value)
                words.append(builder.ptrtoint(row.data, word))
            else:
                words.append(context.cast(builder, value, kind, types.int64))
        callback = ir.FunctionType(word, [word] * len(words)).as_pointer()
        address = builder.load(builder.gep(members, [member]))
        return builder.call(builder.inttoptr(address, callback), words)

    return types.int64(types.int64, types.int64, given), generate


_intrinsic: Any = intrinsic
_call: Callable[[int, int, tuple[int | Row, ...]], int] = _intrinsic(_called)


# ---------------------------------------------------------------- sense and move


@_compiled
def word(percept: NativePercept) -> int:
    """A percept as one word, as in evidence."""
    return percept.degree * 65536 + percept.marker + 1


@_compiled
def percept_of(word: int) -> NativePercept:
    """The percept of a word."""
    return NativePercept(word >> 16, NONE if word < 0 else (word & 65535) - 1)


@_compiled
def look(robot: int) -> NativePercept:
    """The percept where the robot stands; costs nothing."""
    return percept_of(_call(robot, _LOOK, ()))


@_compiled
def move(robot: int, door: int, purpose: int = UNSAID) -> NativePercept:
    """Leave by a door, 0 to degree - 1; return the percept behind it. Costs 1."""
    return percept_of(_call(robot, _MOVE, (door, purpose)))


@_compiled
def refused(percept: NativePercept) -> bool:
    """Whether the robot refuses for good: return then."""
    return percept.degree < 0


# ---------------------------------------------------------------- declare


@_compiled
def pose(robot: int, edge: int, hypotheses: Row) -> int:
    """Declare the darts by which the place behind an edge may have been entered."""
    return _call(robot, _POSE, (edge, len(hypotheses), hypotheses))


@_compiled
def evidence_of(
    step: int,
    expected: int = NONE,
    observed: int = NONE,
    sequence: int = NONE,
    at: int = NONE,
    record: int = NONE,
    contradiction: int = 0,
) -> Row:
    """The evidence of a rejection, `tv_evidence`; percepts in it are words."""
    return np.array([step, expected, observed, sequence, at, record, contradiction], np.int64)


@_compiled
def reject(
    robot: int,
    edge: int,
    hypothesis: int,
    step: int,
    expected: NativePercept,
    observed: NativePercept,
) -> int:
    """Declare a rejection by motion: after `step` doors this was expected and that observed."""
    evidence = evidence_of(step, word(expected), word(observed))
    return _call(robot, _REJECT, (edge, hypothesis, MOTION, evidence, 0, evidence))


@_compiled
def reject_by(
    robot: int, edge: int, hypothesis: int, rule: int, evidence: Row, doors: Row = _NO_DOORS
) -> int:
    """Declare a rejection by a rule; `doors`: of a record, from the dart `record` on."""
    return _call(robot, _REJECT, (edge, hypothesis, rule, evidence, len(doors), doors))


@_compiled
def confirm(robot: int, edge: int, hypothesis: int, rule: int) -> int:
    """Declare that the other end of an edge is this hypothesis."""
    return _call(robot, _CONFIRM, (edge, hypothesis, rule))


@_compiled
def augment(robot: int, edge: int, kind: int, dart: int, degree: int) -> int:
    """Declare that S grows: the edge ends in this dart, of a vertex that is `NEW` or not."""
    return _call(robot, _AUGMENT, (edge, kind, dart, degree))


# ---------------------------------------------------------------- deliver


@_compiled
def deliver(robot: int, degrees: Row, ends: Row, marker: int, cost: int = NONE) -> int:
    """Deliver the map: each vertex's degree, each dart's other end, the marker's dart."""
    darts = 0
    for degree in degrees:
        darts += max(0, degree)
    vertices = len(degrees) if darts <= len(ends) else NONE
    return _call(robot, _DELIVER, (vertices, degrees, ends, marker, cost))


@_compiled
def skip(robot: int) -> int:
    """Decline this world: it counts as neither right nor wrong. Return after it."""
    return _call(robot, _SKIP, (0,))
