"""Theorems about every world with m edges and every reachable map of it, as clauses.

cnf.py          clauses over named Booleans
encoding.py     worlds and maps as clauses
walks.py        words of doors, executed in the world and traced on a map
door_steps.py   one arbitrary door: what must not happen there
word_rules.py   whole words of doors: what the rules must not do
statements.py   the bounded statements, in words, symbols and clauses
theorems.py     the statements as theorems
negatives.py    false claims, with the size of the smallest world that refutes each
mutants.py      negatives and rules with one mistake as theorems that must be refuted
solve.py        puts clauses to Z3 and reads assignments
decode.py       turns an assignment into a world, a map and doors
replay.py       repeats a decoded counterexample in the simulator
model_count.py  lists the worlds of the encoding and compares them with the enumeration
drup.py         refutations found by a SAT solver and checked by another program
"""
