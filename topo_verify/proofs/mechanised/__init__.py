"""The Python around the proofs in Coq, which lie in `proofs/coq/`.

toolchain.py           coqc and coqchk as programs
theorems.py            what is proved in Coq, compiled and asked for its axioms
certificates.py        a run certified by the kernel
vernacular.py          a certificate as a source of Coq, and as numbers
evidence.py            a log folded, with every merge written down
decision_evidence.py   evidence for the decisions of a trace
"""
