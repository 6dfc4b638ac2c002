"""Theorems about every world with m edges and every reachable map of it, as clauses.

cnf.py         clauses over named Booleans, put to Z3
encoding.py    worlds, maps and walks as clauses
statements.py  the bounded statements, in words, symbols and clauses
theorems.py    the statements as theorems; lists the worlds of the encoding
mutants.py     false claims and rules with one mistake, as theorems that must be refuted
replay.py      decodes an assignment, and repeats the counterexample in the simulator
drup.py        refutations found by a SAT solver and checked by another program
"""
