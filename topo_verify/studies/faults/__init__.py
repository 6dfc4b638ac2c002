"""Tries every check on the seeded faults: search, property tests, theorems.

checks.py      one fault and one check
detection.py   all faults and all checks
"""
