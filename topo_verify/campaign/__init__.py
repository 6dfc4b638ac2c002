"""Runs mappers in worlds, judges each run, counts and stores. It prints and draws nothing.

row.py             Row: what one mapper did in one world
attempt.py         makes one run, judges it, and makes its row
tally.py           Tally: the sums of rows; which rows are kept
campaign.py        Campaign: worlds, mappers, limits; results in order
drawn_row.py       the worlds that a search runs again in a row
progress.py        how fast the work goes, and how long still
store.py           Store: the SQLite file from which a campaign resumes
backend.py         where shards are examined; what a lost worker means
compiled.py        a shard by the compiled engine, judged again in part
compiled_shard.py  the counts of the compiled engine
compiled_checks.py the judgements of the compiled judge on a trace
run.py             runs a mapper in a world; the engines
judge.py           judges a run by every claim
targets.py         what a TARGET means, and the text of a callable
identity.py        what a mapper rests on
work.py            tasks, and the pieces into which they are cut
pool.py            worker processes that may die or hang; worker.py is one
"""
