"""Every world with m edges and every map that can be reached in it, as clauses.

cnf.py          clauses over named Booleans
encoding.py     worlds and maps as clauses
walks.py        words of doors, executed and traced
door_steps.py   what one door can do
word_rules.py   what the rules do on whole words
statements.py   what is claimed, in words, symbols and clauses
theorems.py     the statements as theorems
negatives.py    what is not true, and must be refuted
mutants.py      rules with one thing changed
solve.py        Z3 on clauses
decode.py       from a model to a world, a map and doors
replay.py       a decoded model done again in the simulator
model_count.py  the worlds of the encoding, listed and compared with the enumeration
drup.py         refutations that another program checks
"""
