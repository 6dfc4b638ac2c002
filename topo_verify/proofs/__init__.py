"""Theorems about all worlds (docs/proofs.md).

theorem.py     the types that the engines share
catalogue.py   all theorems, by name and kind
first_order/   worlds of any size, by induction, in Z3
bounded/       every world with m edges, as clauses
mechanised/    the Python around Coq; coq/ holds the proofs
solvers/       Z3 with its limits; the extra sat has cvc5
"""

from __future__ import annotations

if __name__ != "topo_verify.proofs":
    raise ImportError(
        f"this package is topo_verify.proofs; as {__name__!r} its classes would exist twice"
    )
