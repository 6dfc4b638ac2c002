"""Tries all checks on all seeded faults: which finds which, how fast, in which smallest world.

    search       every world of 1, 2, … edges, until there are some in which a claim fails: how many
                 of that size, and the smallest in which the one run already convicts the mapper,
                 by claims 9 and 10 alone
    properties   property tests on worlds of two strategies: how many examples until one fails, the
                 median over five seeds; the second is asked where the first leaves a seed without
    proofs       a theorem of which the solver refutes the version with the same mistake in it; the
                 pairs are made by hand, and most mistakes in motion and drawing have none

A fault counts as caught if each of the checks asked for finds it, and the claim that must catch it
fails in worlds of the smallest size. A harmless difference must be found by none. A run that a time
limit ended counts as undecided, never as a fault found. Entries come in the order of the faults.

What this does not show: that these are all the mistakes there are; or, for the harmless ones,
anything about larger worlds beyond those that were drawn.
"""

from __future__ import annotations

from collections.abc import Generator, Iterable, Iterator, Sequence
from contextlib import closing, contextmanager
from math import inf
from typing import Literal, get_args

import msgspec

from topo_verify.campaign.engines import Engine
from topo_verify.campaign.pool import Pool
from topo_verify.campaign.progress import Progress
from topo_verify.campaign.work import Loss, Work, in_order
from topo_verify.campaign.worker import Beat, Handler
from topo_verify.errors import InternalError
from topo_verify.faults import FAULTS, Fault
from topo_verify.studies.faults.checks import (
    COUNTED,
    Examples,
    Proof,
    Smallest,
    examples,
    proof,
    smallest,
)

Check = Literal["search", "properties", "proofs"]
CHECKS: tuple[Check, ...] = get_args(Check)

LARGEST_HARMLESS, LARGEST_THOROUGH = 4, 5
"""The most edges of worlds in which a harmless difference is tried: usually; if thorough."""


class Caught(msgspec.Struct, frozen=True):
    """One fault and what each check found.

    Attributes:
        name, part, why, claim, harmless, target: of the fault.
        search, properties: None if the check was not asked for.
        proofs: None also if no theorem has this mistake.
        asked: how many checks spoke of it; none do if `by` is `proofs` and no theorem has it.
        undecided: nothing is wrong, but a run was out of time or a theorem is UNKNOWN.
        ok: a fault is caught by every check that was asked; a harmless difference by none.
    """

    name: str
    part: str
    why: str
    claim: str | None
    harmless: bool
    target: str
    search: Smallest | None
    properties: Examples | None
    proofs: Proof | None
    asked: int
    undecided: bool
    ok: bool


def try_faults(
    faults: Iterable[Fault],
    *,
    by: Sequence[Check] = CHECKS,
    workers: int = 0,
    thorough: bool = False,
    engine: Engine = "reference",
    tell: Progress | None = None,
) -> Iterator[Caught]:
    """Try the checks on each of these faults.

    Args:
        by: which checks.
        workers: so many processes, each with a fault of its own; 0: this one.
        thorough: count the failing worlds of every size, and try the harmless differences in all
            worlds of 5 edges, too.
        engine: what runs a fault that has a kernel, in worlds of up to `COUNTED` edges; the
            checkers judge the runs. All other runs are by the reference.
        tell: the progress callback, called in the larger worlds.
    """
    faults = list(faults)
    # A worker finds a fault by its name alone, so any other is tried in this process.
    known = all(FAULTS.get(fault.name) is fault for fault in faults)
    if workers and known and len(faults) > 1:
        with closing(
            _in_workers(faults, FaultsJob(tuple(by), thorough, engine), workers)
        ) as entries:
            for fault, entry in entries:
                yield _to_the_end(fault, entry, workers, thorough=thorough, tell=tell)
    else:
        for fault in faults:
            entry = _begun(fault, by=by, thorough=thorough, engine=engine)
            yield _to_the_end(fault, entry, workers, thorough=thorough, tell=tell)


class FaultsJob(msgspec.Struct, frozen=True):
    """What a worker is handed before its first fault; the faults are named, one a task."""

    by: tuple[Check, ...]
    thorough: bool
    engine: Engine


def _in_workers(
    faults: Sequence[Fault], job: FaultsJob, workers: int
) -> Generator[tuple[Fault, Caught]]:
    """The faults in their order, each with what the checks found in a process of their own."""
    work = Work(
        serve=f"{__name__}:serve_faults",
        job=job,
        result=Caught,
        lost=_lost,
        silence=inf,  # checks are counted, not clocked: a thorough one may take an hour
    )
    with Pool(work, workers) as pool:
        names = [fault.name for fault in faults]
        yield from zip(faults, in_order(pool, names, ahead=len(names)), strict=True)


def _lost(name: str, loss: Loss) -> Caught:
    raise InternalError(f"in a worker, which was to try the fault {name}: {loss}")


@contextmanager
def serve_faults(job: bytes) -> Generator[Handler]:
    """Put the checks of a `FaultsJob` to one fault after the other."""
    asked = msgspec.json.decode(job, type=FaultsJob)

    def try_one(name: bytes, _beat: Beat) -> Caught:
        fault = FAULTS[msgspec.json.decode(name, type=str)]
        return _begun(fault, by=asked.by, thorough=asked.thorough, engine=asked.engine)

    yield try_one


def _begun(fault: Fault, *, by: Sequence[Check], thorough: bool, engine: Engine) -> Caught:
    """Try every check on a fault, the search in worlds of up to `COUNTED` edges."""
    last = (LARGEST_THOROUGH if thorough else LARGEST_HARMLESS) if fault.harmless else COUNTED
    return entry_of(
        fault,
        smallest(fault, largest=last, engine=engine) if "search" in by else None,
        examples(fault) if "properties" in by else None,
        proof(fault) if "proofs" in by else None,
    )


def _to_the_end(
    fault: Fault, entry: Caught, workers: int, *, thorough: bool, tell: Progress | None
) -> Caught:
    """Go on with the larger worlds if the search found nothing in the smaller ones."""
    if fault.harmless or entry.search is None or entry.search.failing:
        return entry
    found = smallest(fault, first=COUNTED + 1, workers=workers, thorough=thorough, tell=tell)
    return entry_of(fault, found, entry.properties, entry.proofs)


def entry_of(
    fault: Fault, found: Smallest | None, drawn: Examples | None, proved: Proof | None
) -> Caught:
    """The entry of a fault: what these checks found, and whether each finds what it must."""
    asked: list[bool | None] = []
    if found is not None:
        caught = bool(found.failing) if fault.harmless else fault.claim in found.claims
        asked.append(_finds_what_it_must(fault, caught, found.undecided))
    if drawn is not None:
        caught = drawn.found if fault.harmless else drawn.median_examples is not None
        asked.append(_finds_what_it_must(fault, caught, drawn.undecided))
    if proved is not None:
        asked.append(None if proved.verdict == "UNKNOWN" else proved.verdict == "REFUTED")
    return Caught(
        name=fault.name,
        part=fault.part,
        why=fault.why,
        claim=fault.claim,
        harmless=fault.harmless,
        target=fault.target,
        search=found,
        properties=drawn,
        proofs=proved,
        asked=len(asked),
        # None, an undecided check, is no pass for `all`.
        undecided=None in asked and False not in asked,
        ok=all(asked),
    )


def _finds_what_it_must(fault: Fault, caught: bool, undecided: int) -> bool | None:  # noqa: FBT001  private
    """Does a check find a fault, and no harmless difference? None: a run was undecided."""
    if caught:
        return not fault.harmless
    return None if undecided else fault.harmless
