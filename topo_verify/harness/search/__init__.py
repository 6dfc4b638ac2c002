"""Exhaustive search: a mapper in every world up to so many edges, or in a class of them.

exhaustive.py  adds up shards in their order, and gives the verdict
plan.py        what is searched, as data; the shards
shard.py       examines one shard: by_checkers.py, or compiled_shard.py
tallier.py     makes its tally, run by run
choices.py     the choices that the paper leaves open: policies, and every choice
parallel.py    shards as tasks of the worker pool
identity.py    what a mapper rests on: its files, distributions, values
again.py       runs some worlds again, each in a fresh process
"""
