"""A mapper in many worlds: run, judged, tallied.

run.py        the one way to run a mapper in a world, and to judge the run
targets.py    what a TARGET means
corpus.py     what WORLDS means
tally.py      what was found, as values that add up
ledger.py     what a search has done, kept in a file
gap.py        how far a rule is from the best possible
search/       every world of a class
conform/      an implementation against the reference
baseline/     record and compare
faults/       the seeded faults, and which check finds which
verify/       the main job
"""
