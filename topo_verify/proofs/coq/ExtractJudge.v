(** The judge as a program in OCaml: judge.ml, to which judge_driver.ml adds the main program.

    Natural numbers become OCaml's integers. That is right below 2^62, and it is trusted. *)
From Coq Require Import Extraction ExtrOcamlBasic ExtrOcamlNatInt.
From Topo Require Import Judge JudgeCitations.

Extraction "judge.ml" judge_trace judge_justified judge_entailed judge_decisions.
