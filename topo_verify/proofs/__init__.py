"""Z3 proofs about worlds of any size, and about every world of a bounded size. docs/proofs.md.

    theorems.py      what a theorem is            catalogue.py    all of them

Worlds of any size:
    terms.py         formulas                     theory.py       worlds, maps, doors as axioms
    rules.py         each rule as a term          obligations/    what is proved, by theme
    inductive.py     obligations as theorems      mutants/        rules with one thing changed
    finite.py        models over tiny domains     structures.py   formulas evaluated, no solver
    scenes.py        exact worlds and maps        stage.py        scenes played by the simulator
    decisions.py     the rules' terms on real runs (sensing.py)   z3solver.py    asking Z3

Every world with m edges:
    clauses.py, encoding.py, words.py     worlds, maps, words as clauses
    one_door.py, whole_words.py           what is claimed of them        bounded.py   as theorems
    negatives.py, counterexamples.py      what must be refuted
    stories.py, replaying.py              models decoded, and done in the simulator
    enumeration.py, deciding.py           all worlds; asking Z3
    second_opinion.py, certificates.py    cvc5; refutations checked without a solver
"""

from __future__ import annotations

if __name__ != "topo_verify.proofs":
    raise ImportError(
        f"this package is topo_verify.proofs; as {__name__!r} its classes would exist twice"
    )
