"""Every rooted map with m edges, or of a class of them: counted, listed in rank order, drawn.

rank_order.py      all rooted maps: closed formulas, rank and unrank, listing, uniform samples
degree_counts.py   how many there are with a bound on the degrees
genus_counts.py    how many there are on each surface
classes.py         CLASS on a command line: planar, genus:1, simple, ...
pruned.py          the worlds of a class, grown in rank order without listing the others
"""
