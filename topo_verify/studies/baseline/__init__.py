"""Baselines: the cost and decisions of a mapper in each world of a corpus, kept in a file.

file.py      the file format
record.py    a mapper in a corpus, as a baseline
compare.py   a mapper against a baseline
"""
