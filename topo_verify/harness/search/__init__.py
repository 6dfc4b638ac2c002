"""Exhaustive search: a mapper in every world up to so many edges, or in a class of them.

exhaustive.py  shards added up in their order, and the verdict
plan.py      what is searched, as data; the shards
shard.py     one shard examined
choices.py   the choices that the paper leaves open: policies, and every choice
workers.py   processes that examine shards; worker.py is one of them

identity.py  a hash of what a mapper is made of
"""
