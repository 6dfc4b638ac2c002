(** The checkers as a program in OCaml: certifier.ml, to which driver.ml gives a main.

    Natural numbers become OCaml's integers, which is right below 2^62 and is trusted. *)
From Coq Require Import Extraction ExtrOcamlBasic ExtrOcamlNatInt.
From Topo Require Import World Log Table Checker Decisions.

Extraction "certifier.ml" certified refute impossible decided.
