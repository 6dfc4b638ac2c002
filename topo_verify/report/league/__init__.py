"""The league table of the arena, for people: tables, CSV, a plot of ratio against size.

tables.py  the table of a suite as blocks, and as CSV
plot.py    cost / LB against the number of edges, as SVG
"""
