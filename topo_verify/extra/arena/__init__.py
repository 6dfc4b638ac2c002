"""The arena: mappers in named suites of worlds, ranked by cost if every claim holds.

command.py   `topo-verify arena`
suites.py    the named suites
match.py     the runs: a campaign for each mapper
league.py    the table: places, intervals, counterexamples
folder.py    the standings, and the files of `--out`
plot.py      cost / LB by family, as SVG
"""
