"""A second opinion on a trace by the judge of coq/Judge.v, extracted to OCaml.

Coq proves that the judge says `failed` exactly where a definition of coq/Claims.v is violated; how
much is judged, `judged` of `of`, is not proved. Trusted besides Coq: its extraction, in which
natural numbers become OCaml's integers; the OCaml compiler; `numbers` and coq/judge_driver.ml,
which pass the trace.

What this does not show: claims 8 and 10 where a trace declares the planar prior.
"""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import chain
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import get_args

from topo_verify.checkers import CLAIMS, Judgement, Status
from topo_verify.checkers.folding import OWN_END, TURNED, TWO_OF_S, UNLIKE
from topo_verify.cli.replay import ProvedOpinion
from topo_verify.errors import InputError
from topo_verify.extra.certificates.certificate_format import (
    LARGEST,
    event_line,
    optional,
    percept_line,
)
from topo_verify.proofs.mechanised import toolchain
from topo_verify.robot import events as ev
from topo_verify.robot.percept import Percept
from topo_verify.world.rooted_map import World

APART = "rejection-justified", "decisions-entailed"
"""The claims that are not judged of every trace."""

LONG = 400
"""Longer traces are not judged for claim 10, which folds the log at each decision; nor for claim 8
if they cite contradictions."""

CONTRADICTIONS = UNLIKE, TURNED, OWN_END, TWO_OF_S
"""In the order of coq/Claims.v, where other words come last."""

TracedRun = tuple[World, Sequence[ev.Event]]


def second_opinion(
    run: TracedRun, *, timeout: float, progress: Callable[[str], None] = lambda _: None
) -> ProvedOpinion:
    """Judge one run by the judge that is proved.

    Raises:
        InputError: the installed Coq or OCaml refuses the sources; or as `numbers`.
    """
    numbers(*run)
    if why := missing():
        return ProvedOpinion("", why=why)
    by = f"the judge extracted by {toolchain.version()}"
    with TemporaryDirectory() as folder:
        try:
            progress("compiling the judge")
            program = build(Path(folder), timeout=timeout)
            progress("judging the trace")
            (judgements,) = judge(program, [run], timeout=timeout)
        except toolchain.Unfinished as error:
            return ProvedOpinion(by, why=str(error))
    return ProvedOpinion(by, judgements)


def missing() -> str:
    """Why the judge cannot be built here, or ""."""
    no_ocaml = shutil.which("ocamlfind") is None
    ocaml = "ocamlfind not installed: apt-get install ocaml-findlib" if no_ocaml else ""
    return toolchain.missing() or ocaml


def build(folder: Path, *, timeout: float) -> Path:
    """Compile the program and its part of the library.

    Raises:
        InputError: a compiler refuses a file.
    """
    needed = toolchain.required("JudgeCitations")
    names = [name for name in needed if not (folder / f"{name}.vo").exists()]
    toolchain.copy_library(folder, [*names, "ExtractJudge"])
    shutil.copy(toolchain.SOURCES / "judge_driver.ml", folder)
    ran = toolchain.compile_all(folder, [*names, "ExtractJudge"], timeout=timeout)
    if ran.accepted:
        sources = ["judge.mli", "judge.ml", "judge_driver.ml"]
        command = ["ocamlfind", "ocamlopt", "-w", "-a", *sources, "-o", "judge"]
        ran = toolchain.run(command, folder, timeout=timeout)
    if not ran.accepted:
        raise InputError(f"the judge cannot be built: {ran.output[-300:]}")
    return folder / "judge"


def judged_claims(trace: Sequence[ev.Event]) -> tuple[str, ...]:
    """The claims that are judged of this trace, in the order of the answer."""
    rules = {event.rule for event in trace if isinstance(event, ev.Reject)}
    is_long, is_planar = len(trace) > LONG, "planar" in rules
    left_out = {
        "rejection-justified": is_planar or (is_long and "folding" in rules),
        "decisions-entailed": is_planar or is_long,
    }
    return tuple(claim for claim in CLAIMS if not left_out.get(claim))


def judge(
    program: Path, runs: Iterable[TracedRun], *, timeout: float
) -> list[tuple[Judgement, ...]]:
    """Judge each run; one judgement without findings for each claim.

    Raises:
        InputError: as `numbers`.
        toolchain.Unfinished: the program ended without a result.
    """
    runs = list(runs)
    lines = [" ".join(map(str, numbers(world, trace))) for world, trace in runs]
    stdin = "\n".join([str(len(lines)), *lines])
    ran = toolchain.run([str(program)], program.parent, timeout=timeout, stdin=stdin)
    answers = ran.output.splitlines()
    if not ran.accepted or len(answers) != len(lines):
        raise toolchain.Unfinished(f"the judge ended without a result: {ran.output[-300:]}")
    return [
        tuple(_judgements(judged_claims(trace), line.split()))
        for (_, trace), line in zip(runs, answers, strict=True)
    ]


def _judgements(claims: Sequence[str], words: Sequence[str]) -> Iterator[Judgement]:
    rows = zip(words[::3], words[1::3], words[2::3], strict=True)
    for claim, (word, judged, of) in zip(claims, rows, strict=True):
        status: Status = next(status for status in get_args(Status) if status == word)
        yield Judgement(claim, status, int(judged), int(of))


def numbers(world: World, trace: Sequence[ev.Event]) -> list[int]:
    """A run as the program reads it (coq/judge_driver.ml).

    Raises:
        InputError: the trace is out of order, or has a number below 0 or above 2^60.
    """
    ev.require_order(trace)
    start, finish = trace[0], trace[-1]
    assert isinstance(start, ev.Start)
    delivered = isinstance(finish, ev.Finish)
    world = World.from_code(world.code)  # its root is dart 0
    steps = [_step(event) for event in (trace[1:-1] if delivered else trace[1:])]
    stated = [
        *(int(claim in judged_claims(trace)) for claim in APART),
        *_listed(world.sigma), *_listed(world.alpha), *percept_line(start.percept),
        len(steps), *chain.from_iterable(steps),
        *(_ending(finish) if isinstance(finish, ev.Finish) else [0]),
    ]  # fmt: skip
    if not 0 <= min(stated) <= max(stated) <= LARGEST:
        raise InputError(
            "the trace has a number below 0 or above 2^60, which cannot be stated as a natural"
            " number: leave out --kernel"
        )
    return stated


def _listed(row: Sequence[int]) -> list[int]:
    return [len(row), *row]


def _step(event: ev.Event) -> Sequence[int]:
    if isinstance(event, ev.Pose):
        return [5, event.edge, *_listed(event.hypotheses)]
    line = event_line(event)
    assert line is not None, "`require_order` lets only the first and the last be others"
    return [*line, *_citation(event)] if isinstance(event, ev.Reject) else line


def _citation(event: ev.Reject) -> list[int]:
    evidence, record, cited = event.evidence, event.evidence.record, event.evidence.contradiction
    return [
        {"motion": 0, "folding": 2, "planar": 2}.get(event.rule, 1), evidence.step,
        *_stated(evidence.expected), *_stated(evidence.observed),
        optional(evidence.sequence), optional(evidence.at),
        *([0] if record is None else [1, record.dart, *_listed(record.doors)]),
        0 if cited is None else 1 + [*CONTRADICTIONS, cited].index(cited),
    ]  # fmt: skip


def _stated(percept: Percept | None) -> list[int]:
    return [0] if percept is None else [1, *percept_line(percept)]


def _ending(finish: ev.Finish) -> list[int]:
    vertices, edges, marker = finish.map.vertices, finish.map.edges, finish.map.marker
    head = [1, optional(finish.cost)]
    if any(len(edge) != 2 for edge in edges) or (marker is None) == any(vertices):
        return [*head, 0]
    number: dict[int | None, int] = {}
    rows = [[number.setdefault(label, len(number)) for label in row] for row in (*vertices, *edges)]
    rotations, pairs = rows[: len(vertices)], rows[len(vertices) :]
    return [
        *head, 1,
        len(rotations), *chain.from_iterable(map(_listed, rotations)),
        len(pairs), *chain.from_iterable(pairs), number.setdefault(marker, len(number)),
    ]  # fmt: skip
