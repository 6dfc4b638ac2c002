(** The list of worlds of Listed.v, and the ranks of Ranks.v, as a program in OCaml: worlds.ml, to which
    listing.ml adds the main program. Natural numbers become OCaml's integers; ranks stay binary. *)
From Coq Require Import Extraction ExtrOcamlBasic ExtrOcamlNatInt.
From Topo Require Import World Listed ListedOnce Ranks.

Extraction "worlds.ml" plans planned formula_rows by_rows plan_at plan_of plan_rank.
