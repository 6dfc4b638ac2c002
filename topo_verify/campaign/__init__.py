"""Runs mappers in worlds, judges each run, counts and stores: prints nothing and draws nothing.

row.py             Row: what one mapper did in one world
attempt.py         one run, judged, and its row
tally.py           Tally: what rows add up to; which rows are kept as examples
campaign.py        Campaign: worlds, mappers, limits; its results in order
store.py           Store: the SQLite file from which a campaign resumes
backend.py         where shards are examined; what a lost worker means
compiled.py        a shard by the compiled engine, partly judged again by the checkers
compiled_shard.py  the counts of the compiled engine
run.py             runs a mapper in a world; the engines
judge.py           judges a run by every claim
targets.py         what a TARGET means, and the text of a callable
identity.py        what a mapper rests on
work.py            what workers do; the pieces of tasks
pool.py            worker processes that may die or hang; worker.py is one
cluster.py         the workers of a Dask cluster; cluster_worker.py runs there
progress.py        the progress callback and rate
"""
