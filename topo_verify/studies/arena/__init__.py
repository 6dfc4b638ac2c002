"""The arena: mappers in named suites of worlds, ranked by cost if every claim holds.

suites.py    the named suites: families of worlds with their seeds
league.py    the table: places, intervals, counterexamples
match.py     the mappers' campaigns, hidden worlds, memory
"""
