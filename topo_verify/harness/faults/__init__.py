"""The seeded faults put to every check: search, property tests, theorems.

checks.py      one fault and one check
detection.py   all faults and all checks
"""
