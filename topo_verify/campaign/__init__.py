"""Runs mappers in worlds, judges each run, counts and stores. It prints and draws nothing.

row.py             Row: what one mapper did in one world
attempt.py         makes one run, judges it, and makes its row
tally.py           Tally: the sums of rows; which rows are kept
campaign.py        Campaign: worlds, mappers, limits; results in order
drawn_row.py       the worlds that a search runs again in a row
progress.py        how fast the work goes, and how long still
store.py           Store: the SQLite file from which a campaign resumes
backend.py         where shards are examined: in this process, in workers
engine.py          what an engine answers, and the reference
examiner.py        how shards are examined
loss.py            what a lost process means: one table
run.py             runs a mapper in a world
judge.py           judges a run by every claim
targets.py         what a TARGET means, and the text of a callable
identity.py        what a mapper rests on
work.py            tasks, and the pieces into which they are cut
pool.py            worker processes that may die or hang; worker.py is one
"""
