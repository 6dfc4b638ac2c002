"""Theorems about worlds of any size: a first-order theory, and obligations that Z3 proves in it.

terms.py            formulas: written as SMT-LIB, expanded over tiny domains, or evaluated
axioms.py           the theory: worlds, the map S, the correspondence between them
rules.py            one step of each rule of the algorithms as a formula
obligations/        the statements that Z3 proves, by theme
theorems.py         the obligations as theorems, each with a mutant that lacks a premise
mutants/            rules with one mistake, as theorems that must be refuted
structures.py       evaluates formulas in a concrete structure, with no solver
finite_models.py    finds models over tiny domains
scenes.py           finds exact worlds and maps in which a faulty rule fails
scene_replay.py     repeats these scenes in the simulator
conformance.py      compares the formulas of the rules with the decisions of real runs
run_structure.py    a real run as a structure of the theory
"""
