"""Every rooted map with m edges, or of a class of them: counted, listed in rank order, sampled.

rank_order.py  all rooted maps: formulas, ranks, listing, uniform samples counts.py      counts by
genus, and by properties of the graph classes.py     CLASS on a command line: planar, genus:1,
simple, ... pruned.py      the worlds of a class in rank order, grown with pruning
"""
