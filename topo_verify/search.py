"""The exhaustive search, for use from Python: `from topo_verify.search import search`."""

from topo_verify.studies.search.choices import Choices
from topo_verify.studies.search.search import (
    ByEdges,
    CostComparison,
    CostPair,
    Counterexample,
    FailingClaim,
    Search,
    SearchEntry,
    search,
)

__all__ = [
    "ByEdges",
    "Choices",
    "CostComparison",
    "CostPair",
    "Counterexample",
    "FailingClaim",
    "Search",
    "SearchEntry",
    "search",
]
