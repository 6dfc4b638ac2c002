"""The paper's experiments run again: which runs make which point of which figure.

figures.py   the figures: their lines, sizes, graphs, and the costs stated in the paper
points.py    the campaign of each line; means, standard errors, growth exponents, CSV
"""
