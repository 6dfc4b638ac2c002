"""What --kernel does in `replay`: the judge that is proved in Coq judges the same run."""

from __future__ import annotations

import msgspec

from topo_verify.campaign.judge import Report
from topo_verify.cli.output import Output
from topo_verify.cli.replay import ProvedOpinion
from topo_verify.errors import InternalError
from topo_verify.extra.certificates import judge

TIMEOUT = 600
"""Time limit of each program of Coq and OCaml, in seconds."""


def opinion(output: Output, report: Report) -> ProvedOpinion:
    """The extracted judge's judgement; InternalError if it differs from the checkers'."""
    if report.run is None:
        return ProvedOpinion("", why="the run has no trace")
    proved = judge.second_opinion(
        (report.run.world, report.run.trace),
        timeout=TIMEOUT,
        progress=lambda doing: output.progress(doing, 0, 1),
    )
    checked = {judgement.claim: judgement for judgement in report.judgements}
    for judgement in proved.judgements:
        if judgement != msgspec.structs.replace(checked[judgement.claim], findings=()):
            raise InternalError(
                f"{proved.by} says of {judgement.claim}: {judgement.status}, judged"
                f" {judgement.judged} of {judgement.of}; the checkers say otherwise"
            )
    return proved


def words(opinion: ProvedOpinion) -> str:
    """The judge's verdicts as blocks of text."""
    if opinion.why:
        return f"Not judged by the judge that is proved in Coq: {opinion.why}"
    number = len(opinion.judgements)
    return f"Judged again by {opinion.by}: the same of {number} of 10 claims."
