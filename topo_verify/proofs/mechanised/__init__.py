"""The Python around the proofs in Coq (`proofs/coq/`).

toolchain.py           calls coqc and coqchk
theorems.py            the theorems of coq/, by theorems.csv there
certificates.py        makes certificates for logs, and has Coq check them
certificate_format.py  writes and reads certificates
evidence.py            folds a log, and records its merges
judge.py               has the extracted judge judge a trace
"""
