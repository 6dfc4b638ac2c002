"""Z3 and cvc5 with their limits: a script goes in, one of three answers comes out.

z3_solver.py    the solver of all proofs but the mechanised ones
cvc5_solver.py  a second solver that reads the same scripts

They take SMT-LIB text and know neither terms nor clauses.
"""
