"""Theorems about worlds of any size: a first-order theory, and obligations that Z3 proves.

terms.py            formulas
theory.py           worlds, the map S, their correspondence, and the rules
obligations/        the statements, by theme
theorems.py         obligations as theorems, with all premises or without one
finite_models.py    models over tiny domains
"""
