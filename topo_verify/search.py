"""The exhaustive search, for use from Python: `from topo_verify.search import search`.

The search itself lives in `topo_verify.harness.search`; docs/search.md says what it does.
"""

from topo_verify.harness.search.exhaustive import Found, Search, Size, search
from topo_verify.harness.search.plan import Choices, Plan
from topo_verify.harness.tally import Compared, Costs, Failing, Failure, Pair, Tally

__all__ = [
    "Choices",
    "Compared",
    "Costs",
    "Failing",
    "Failure",
    "Found",
    "Pair",
    "Plan",
    "Search",
    "Size",
    "Tally",
    "search",
]
