"""Exhaustive search: a mapper in every world up to so many edges, or in a class of them.

searching.py    the search: shards added up in their order, verdicts
plan.py         what is searched, as data; the shards
examining.py    one shard examined
variants.py     the choices that the paper leaves open: policies, and every choice
tally.py        what was found, as values that add up
workers.py      processes that examine shards
ledger.py       what was done, in a file: a search that is cut off goes on
"""

from topo_verify.search.plan import Choices, Plan
from topo_verify.search.searching import Found, Search, Size, search
from topo_verify.search.tally import Compared, Costs, Failing, Failure, Pair, Tally

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
