"""The checkers, trusted: they judge a trace in its world, and what its history proves.

claims.py           the ten claims of docs/semantics.md, section 9
replayed_trace.py   a trace replayed in its world
map_in_world.py     S beside the world (claims 1-8)
excursions.py       the walks behind an edge
entailment.py       what a history proves (claims 9 and 10)
folding.py          the fold of a history
map_on_fold.py      S beside the fold
certificate.py      a log judged without a world
darts.py, coverage.py, findings.py
"""

from topo_verify.checkers.claims import CLAIMS, check
from topo_verify.checkers.entailment import decision_conclusions
from topo_verify.checkers.findings import Finding, Judgement, Status
from topo_verify.checkers.folding import Fold

__all__ = ["CLAIMS", "Finding", "Fold", "Judgement", "Status", "check", "decision_conclusions"]
