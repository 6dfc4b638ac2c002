"""The paper's experiments run again: which runs make which point of which figure.

figures.py     the figures: their lines, sizes, graphs, and what the paper's text states
measuring.py   the campaign of each line, over all graphs that the figures need it in
points.py      means, standard errors, growth exponents, CSV
"""
