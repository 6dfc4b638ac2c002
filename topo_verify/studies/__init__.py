"""Questions put to many runs.

verify/        the main job
search/        every world of a class: the smallest counterexample, or EXHAUSTED
conform/       an implementation against the reference
baseline/      record and compare
faults.py      the seeded faults, and which check finds which
arena/         mappers in named suites, ranked by cost
game/          what the best explorer pays, computed
reproduce/     the paper's figures
gap.py         how far a rule is from the best possible
corpus.py      what WORLDS means
beside.py      a function called in worker processes beside the campaign
log_file.py    a robot's log, in JSON Lines or as a CSV table
log_report.py  what a log proves without its world
advice.py      where a robot goes next, so that its log proves the map
map_check.py   a map judged by a log, and the cheapest way to prove it
"""
