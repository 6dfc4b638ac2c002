(** The check of certificates as a program in OCaml: certifier.ml, to which driver.ml adds the main
    program.

    Natural numbers become OCaml's integers. That is right below 2^62, and it is trusted. *)
From Coq Require Import Extraction ExtrOcamlBasic ExtrOcamlNatInt.
From Topo Require Import Certificate.

Extraction "certifier.ml" check_numbers summary.
