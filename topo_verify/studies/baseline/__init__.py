"""Baselines: the cost and decisions of a mapper in each world of a corpus, kept in a file."""
