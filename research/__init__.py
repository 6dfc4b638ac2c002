"""One script a finding of docs/findings.md: `python -m research.NAME --help` says what it prints.

price       what mappers pay, as a ratio to the least cost
ignorance   what a truthful oracle saves; belief: what confirming early would save
marker      where to put the marker; heat: a picture of it, docs/heat.svg
dearer      worlds in which a stronger algorithm costs more
every       what any choices can cost, by a model of basic, I and II
left_open   policies, ways home, records: what the paper leaves open
twins       worlds that look alike without the marker's direction
totals      the totals of large searches
advice      what it costs to follow the advice of `certify`
junctions   which rule reads the order of roads at wide junctions
game        what the best possible robot pays
"""
