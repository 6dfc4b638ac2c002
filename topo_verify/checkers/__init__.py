"""The trusted core's verdict on a run: the claims, and what a history proves.

`claims` holds the claims of docs/semantics.md, section 9, one function each; `entailment` what
claims 9 and 10 rest on; `folding` the fold of a history; `findings` what a check says.
"""

from topo_verify.checkers.claims import CLAIMS, check
from topo_verify.checkers.entailment import decision_conclusions, fold_history, map_conclusion
from topo_verify.checkers.findings import Finding, Judgement, Status
from topo_verify.checkers.folding import Contradiction, Fold

__all__ = [
    "CLAIMS",
    "Contradiction",
    "Finding",
    "Fold",
    "Judgement",
    "Status",
    "check",
    "decision_conclusions",
    "fold_history",
    "map_conclusion",
]
