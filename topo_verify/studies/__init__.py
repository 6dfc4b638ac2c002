"""Questions put to many runs.

search/        every world of a class: the smallest counterexample, or EXHAUSTED
conform/       an implementation against the reference
baseline/      record and compare
faults.py      the seeded faults, and which check finds which
arena/         mappers in named suites, ranked by cost
game/          what the best explorer pays, computed
reproduce/     the paper's figures
verify/        the main job
gap.py         how far a rule is from the best possible
log_file.py    the log of a robot, in JSON Lines or as a CSV table
advice.py      where a robot goes next, so that its log proves the map in the end
corpus.py      what WORLDS means
log_report.py  a log judged with no world; what is left to walk
map_check.py   a map judged by a log, and the cheapest way to prove it
"""
