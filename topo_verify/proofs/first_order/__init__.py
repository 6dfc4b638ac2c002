"""Theorems about worlds of any size: a first-order theory, and obligations that Z3 proves.

terms.py            formulas
theory.py           worlds, the map S, their correspondence, and the rules
obligations/        the statements, by theme
mutants/            rules with one mistake, by the same themes
theorems.py         obligations and mutants as theorems
finite_models.py    models over tiny domains
scenes.py           exact worlds in which a faulty rule fails
conformance.py      compares the rules' formulas with real runs
"""
