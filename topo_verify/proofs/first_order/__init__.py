"""Worlds of any size: first-order theories, the rules as terms, and obligations that Z3 proves.

terms.py            formulas, built once, read three ways
axioms.py           worlds, the map S, the correspondence between them
rules.py            each rule of the algorithms as one transition
obligations/        what is proved, by theme
theorems.py         the obligations as theorems, and a mutant for each premise
mutants/            rules with one thing changed
structures.py       formulas evaluated in a concrete structure, with no solver
finite_models.py    models over tiny domains
scenes.py           exact worlds and maps in which a mutated rule fails
scene_replay.py     the same scenes in the simulator
conformance.py      the terms of the rules against the decisions of real runs
run_structure.py    a real run as a structure of the theory
"""
