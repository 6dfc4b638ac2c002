"""Questions put to many runs.

verify/          the main job
search/          every world of a class
conform/         an implementation against the reference
baseline/        record and compare
gap.py           how far a rule is from the best
corpus.py        what WORLDS means
beside.py        calls in worker processes
log_file.py      reads a robot's log
log_report.py    what a log proves without its world
advice.py        where a robot goes next
map_check.py     judges a map by a log
"""
