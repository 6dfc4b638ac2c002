"""Exhaustive search: a mapper in every world up to so many edges, or in a class of them.

exhaustive.py  shards added up in their order, and the verdict
plan.py      what is searched, as data; the shards
shard.py     one shard examined
choices.py   the choices that the paper leaves open: policies, and every choice
workers.py   processes that examine shards; worker.py is one of them
pace.py      how fast it goes
identity.py  a hash of what a mapper is made of
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
