"""The Python around the proofs in Coq (`proofs/coq/`).

toolchain.py  calls coqc and coqchk
theorems.py   the theorems of coq/, by theorems.csv there
"""
