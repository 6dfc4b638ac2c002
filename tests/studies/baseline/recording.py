"""Recordings of baselines, for their tests."""

from __future__ import annotations

from topo_verify.programs.loader import Target
from topo_verify.robot.limits import Limits
from topo_verify.studies.baseline.file import Baseline
from topo_verify.studies.baseline.record import baseline_runs, record
from topo_verify.studies.corpus import CorpusWorlds, corpus_from


def recording(
    target: Target,
    *texts: str,
    limits: Limits | None = None,
    engine: str = "reference",
    workers: int = 0,
) -> Baseline:
    """The baseline of a mapper in the worlds that these texts name."""
    corpus = corpus_from(texts)
    worlds = CorpusWorlds(corpus)
    runs = baseline_runs(target, worlds, corpus.total, limits=limits, engine=engine)
    return record(target, corpus, runs.rows(workers), worlds=texts, limits=limits)
