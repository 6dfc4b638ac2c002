"""Solvers with their limits: an SMT-LIB script goes in, one of three answers comes out.

z3_solver.py    for all proofs but the mechanised ones
cvc5_solver.py  a second solver for the same scripts
"""
