"""Solvers with their limits: a script goes in, `sat`, `unsat` or `unknown` comes out.

z3_solver.py    for all proofs but the mechanised ones
"""
