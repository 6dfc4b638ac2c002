"""Theorems about every world with m edges and every reachable map, as clauses.

cnf.py            clauses over named Booleans, and Z3's answers
encoding.py       worlds, maps and walks as clauses
statements.py     the statements
theorems.py       proves them; lists the encoded worlds
confirmations.py  false claims, to be refuted
replay.py         repeats a counterexample in the simulator
"""
