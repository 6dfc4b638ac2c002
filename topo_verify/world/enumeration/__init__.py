"""Every rooted map with m edges, or of a class of them: counted, listed in rank order, sampled.

rank_order.py      all rooted maps: closed formulas, rank and unrank, listing, uniform samples
degree_counts.py   counts of worlds by properties of their graph: loopless, simple, degrees
genus_counts.py    counts of worlds by genus
classes.py         CLASS on a command line: planar, genus:1, simple, ...
pruned.py          the worlds of a class, grown in rank order without listing the others
listing.py         `tv.worlds`: the worlds of a size and a class, one after the other
"""
