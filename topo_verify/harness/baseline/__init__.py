"""What a mapper pays and decides in each world of a corpus, kept in a file and compared later.

file.py      the file format
record.py    making a baseline
compare.py   a mapper against a baseline
"""
