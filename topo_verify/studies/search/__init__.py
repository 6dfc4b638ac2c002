"""Exhaustive search: a mapper in every world up to N edges, or in a class of them.

search.py      the campaign, its result and the verdict
choices.py     the choices that the paper leaves open
again.py       runs some worlds again in fresh processes
failing_run.py the judged run of a counterexample, as it comes from a worker
states/        every choice of a policy, searched over states
"""
