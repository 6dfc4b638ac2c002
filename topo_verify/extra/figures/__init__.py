"""The paper's experiments run again: its figures, beside the numbers that its text states.

command.py    `topo-verify reproduce`
figures.py    the figures as data
points.py     their points: runs, means, growth, CSV
words.py      a paragraph under each figure
pictures.py   a figure as SVG and PNG, by matplotlib
"""
