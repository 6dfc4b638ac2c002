(** The mappers of Algorithms.v and FoldingRule.v, told as in Declared.v, as a program in OCaml: mappers.ml, to which main.ml adds the main
    program. Natural numbers become OCaml's integers. *)
From Coq Require Import Extraction ExtrOcamlBasic ExtrOcamlNatInt.
From Topo Require Import Ways ReferencePolicies Algorithms RandomPolicies FoldingRule Declared.

Extraction "mappers.ml" trace_in way_to nearest first_open last_open shortest oldest newest
  chosen_dart shuffled
  basic enhancement_i enhancement_ii enhancement_ii_i enhancement_iii_one enhancement_iii_one_i
  enhancement_iii_all enhancement_iii_all_i folding.
