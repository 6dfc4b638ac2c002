"""The arena: mappers in named suites of worlds, ranked by cost if every claim holds.

suites.py    the named suites: families of worlds with their seeds
interval.py  means over the families of a suite, with confidence intervals
rows.py      what a run in the arena came to, as data
playing.py   a run, judged; the workers of the pool that make the runs
store.py     the runs that are done, in a file from which the next call goes on
league.py    from runs to the table: places, intervals, counterexamples
"""
