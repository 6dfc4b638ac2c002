"""Runs a mapper in many worlds, judges each run, and tallies the results.

run.py        the one way to run a mapper in a world
judge.py      the judgement of a run by every claim
log_report.py a log judged with no world; open_doors.py: what is left to walk
map_check.py  a map judged by a log, and the cheapest way to prove it
targets.py    what a TARGET means; engines.py: what runs an algorithm of the catalogue
corpus.py     what WORLDS means
tally.py      counts of runs judged in worlds, as values that add up
work.py       what workers do, and what a lost task means; pieces.py: the parts of tasks
pool.py       worker processes that may die or hang; worker.py is one of them
cluster.py    the workers of a Dask cluster; cluster_worker.py is what runs on one
progress.py   the progress callback, and the rate of progress
ledger.py     the finished shards of a search, kept in a file
line_store.py finished runs of `reproduce` and the arena, kept in a file
gap.py        how far a rule is from the best possible
search/       every world of a class
conform/      an implementation against the reference
baseline/     record and compare
faults/       the seeded faults, and which check finds which
arena/        mappers in named suites, ranked
verify/       the main job
"""
