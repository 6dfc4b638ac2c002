"""Runs mappers in worlds, judges each run, counts and stores: prints nothing and draws nothing.

row.py             Row: what one mapper did in one world
attempt.py         one run, judged, and the row of it
tally.py           Tally: the numbers that rows add up to; which rows are kept as examples
campaign.py        Campaign: worlds, mappers, limits, what is kept, as data; its results in order
store.py           Store: the SQLite file from which a campaign resumes
backend.py         where shards are examined; what a lost worker means
compiled.py        a shard by the compiled engine, a part of it judged again by the checkers
compiled_shard.py  the engine's counts in a range of worlds; open verdicts go to the checkers
run.py             the one way to run a mapper in a world, and the engines
judge.py           the judgement of a run by every claim
targets.py         what a TARGET means, and the text of a callable
identity.py        what a mapper rests on: its files, distributions, values
work.py            what workers do, what a lost task means, the pieces of tasks
pool.py            worker processes that may die or hang; worker.py is one of them
cluster.py         the workers of a Dask cluster; cluster_worker.py is what runs on one
progress.py        the progress callback, and the rate of progress
"""
