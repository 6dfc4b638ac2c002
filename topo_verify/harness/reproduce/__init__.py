"""The paper's experiments run again: which runs make which point of which figure.

figures.py     the figures: their lines, sizes, graphs, and what the paper's text states
measuring.py   one run, judged, as a row; in this process or in workers
store.py       the rows that are done, kept in a file from which the next call goes on
points.py      means, standard errors, growth exponents, CSV
"""
