"""The exhaustive search, for use from Python: `from topo_verify.search import search`.

The search itself lives in `topo_verify.harness.search`; docs/search.md says what it does.
"""

from topo_verify.harness.search.exhaustive import Search, SearchResult, Size, search
from topo_verify.harness.search.plan import Choices, Plan
from topo_verify.harness.tally import CostComparison, CostPair, CostTotals, Failing, Failure, Tally

__all__ = [
    "Choices",
    "CostComparison",
    "CostPair",
    "CostTotals",
    "Failing",
    "Failure",
    "Plan",
    "Search",
    "SearchResult",
    "Size",
    "Tally",
    "search",
]
