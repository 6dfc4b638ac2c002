"""The judgements of mutated traces stay what they are while the checkers are made faster.

The checksum covers claims, statuses, counts, events and witnesses, not sentences. It changes only
where docs/semantics.md does.
"""

from __future__ import annotations

from hashlib import sha256

import msgspec
import pytest

from tests.checkers.mutated import mutated_traces
from topo_verify.checkers import check

PINNED = "0d4fd93e375f1fe0a56bd9a17665a38e6fa3ffe71fc90291e2bb963b25d42437"


@pytest.mark.no_cover
def test_the_judgements_of_a_thousand_mutated_traces_are_as_they_were() -> None:
    judgements = sha256()
    for place, case in enumerate(mutated_traces(seed=1, runs=200)):
        judged = check(case.world, case.trace, case.stopped, strict=bool(place % 2))
        for judgement in judged:
            places = [(finding.event, finding.witness) for finding in judgement.findings]
            numbers = (judgement.claim, judgement.status, judgement.judged, judgement.of, places)
            judgements.update(msgspec.json.encode(numbers))
    assert judgements.hexdigest() == PINNED
