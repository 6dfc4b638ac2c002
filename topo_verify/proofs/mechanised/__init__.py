"""The Python around the proofs in Coq; their sources lie in `proofs/coq/`.

toolchain.py           calls coqc and coqchk as programs
theorems.py            the theorems of coq/, compiled and asked for their axioms
certificates.py        makes certificates for logs and has Coq's kernel check them
certificate_format.py  writes and reads a certificate, which is a list of numbers
evidence.py            folds a log, and records every merge as evidence for it and its decisions
"""
