"""Theorems about worlds of any size: a first-order theory, and obligations that Z3 proves in it.

terms.py            formulas: written as SMT-LIB, expanded over tiny domains, or evaluated
theory.py           worlds, the map S, their correspondence; one step of each rule as a formula
obligations/        the statements that Z3 proves, by theme
mutants/            rules with one mistake, by the same themes
theorems.py         the obligations as theorems; as mutants, which must be refuted, the faulty
                    rules, and each obligation without one of its premises
finite_models.py    finds models over tiny domains
scenes.py           finds exact worlds and maps in which a faulty rule fails, and replays them
conformance.py      compares the formulas of the rules with the decisions of real runs
"""
