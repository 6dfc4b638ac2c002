"""Second opinions on the proofs: checked certificates of bounded theorems, and another solver.

drup.py         a SAT solver refutes clauses, and a verified checker follows the refutation
cvc5_solver.py  a second solver for the scripts that Z3 is asked
options.py      --certify and --solver of `prove`
"""
