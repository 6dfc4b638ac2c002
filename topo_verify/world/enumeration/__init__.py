"""Every rooted map with m edges, or of a class of them: counted, listed in rank order, sampled.

rank_order.py is the basis; counts.py has further formulas, classes.py CLASS on a command line,
pruned.py the listing of a class.
"""
