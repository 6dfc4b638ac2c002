"""The trusted core's verdict: a trace replayed in its world, and the claims asked of it.

replay.py     where the robot stood, what its map was, what the truth is
claims.py     the claims of SPEC section 7, one function each
findings.py   what a check says
"""

from topo_verify.checkers.claims import CLAIMS, check, cost_bound
from topo_verify.checkers.findings import Finding, Judgement, Status
from topo_verify.checkers.replay import Case

__all__ = ["CLAIMS", "Case", "Finding", "Judgement", "Status", "check", "cost_bound"]
