"""The engines that run an algorithm of the catalogue: `reference` and `compiled`.

The reference is `topo_verify.algorithms`. The compiled engine (`topo_verify.compiled`) makes the
same runs some hundred times as fast. It is not trusted: what it delivers is judged like the run of
any mapper, and tests hold it to the reference event by event.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Literal, get_args

from topo_verify.algorithms import CATALOGUE, REFERENCE, Algorithm
from topo_verify.compiled import require
from topo_verify.compiled.faults import PLANTED
from topo_verify.errors import InputError, InternalError
from topo_verify.programs.loader import Target
from topo_verify.robot.events import Policies, Robot
from topo_verify.robot.limits import Limits

Engine = Literal["reference", "compiled"]
"""What runs an algorithm of the catalogue."""

ENGINES: tuple[Engine, ...] = get_args(Engine)


@dataclass(frozen=True, slots=True)
class CompiledAlgorithm:
    """An algorithm of the catalogue, to be run by the compiled engine: `campaign/run.py` does so.

    Attributes:
        name: as in the catalogue.
        fault: a mistake that is planted in it, by the name of the seeded fault; empty: none.
        trace: keep the trace of a run; False: cost and map alone.
    """

    name: str
    fault: str = ""
    trace: bool = True

    @property
    def policies(self) -> Policies:
        """Those of the reference; the kernels know no others."""
        return REFERENCE

    def __call__(self, robot: Robot) -> object:
        """Raise an InternalError: the engine needs the world, and a robot hides it."""
        raise InternalError(f"the compiled {self.name} was called with a robot: {robot!r}")


def policies_of(target: Target) -> Policies | None:
    """The policies of an algorithm of the catalogue, whatever runs it; None for other mappers."""
    mapper = target.mapper
    return mapper.policies if isinstance(mapper, Algorithm | CompiledAlgorithm) else None


def on_engine(engine: Engine, targets: Iterable[Target], limits: Limits) -> tuple[Target, ...]:
    """The same algorithms, to be run by this engine.

    Raises:
        InputError: the compiled engine cannot run one of them, or has no such limits; the message
            says what it can.
    """
    found = tuple(targets)
    if engine == "reference":
        return found
    require_compiled(found, limits)
    return tuple(Target(target.text, CompiledAlgorithm(target.text)) for target in found)


def planted(fault: str) -> CompiledAlgorithm | None:
    """The compiled mapper with the mistake of this seeded fault; None if no kernel has it."""
    found = PLANTED.get(fault)
    return None if found is None else CompiledAlgorithm(found[1], fault)


def require_compiled(targets: Iterable[Target], limits: Limits) -> None:
    """Raise an InputError unless the compiled engine can run these mappers under these limits."""
    require("--engine compiled")
    for target in targets:
        if not isinstance(target.mapper, Algorithm):
            raise InputError(
                f"--engine compiled runs the algorithms of the catalogue, {', '.join(CATALOGUE)},"
                f" and {target.text} is none of them: leave --engine out"
            )
        if target.mapper != CATALOGUE.get(target.text):
            chosen = target.mapper.policies
            raise InputError(
                f"--engine compiled runs {target.text} with the policies {REFERENCE.pick} and"
                f" {REFERENCE.order}, got {chosen.pick} and {chosen.order}: leave out --pick and"
                " --order, or --engine"
            )
    if replace(limits, budget=None) != Limits():
        raise InputError(
            "--engine compiled cannot stop a run after some seconds, and its runs are bounded by"
            " the number of moves: leave out --move-timeout and --world-timeout, or --engine"
        )
