(** The file that checks one certificate. It is the same for every certificate: the numbers are in
    Data.v, which is written for each. All names are qualified, so nothing in Data.v could give
    another meaning to one of them. *)
From Coq Require Import NArith.
From Topo Require Certificate Data.
Local Open Scope N_scope.

(** The numbers are a certificate, and what it says is true. *)
Theorem checked : Topo.Certificate.proves_itself Topo.Data.numbers.
Proof. apply Topo.Certificate.check_numbers_correct. vm_cast_no_check (eq_refl true). Qed.

Print Assumptions checked.
Eval vm_compute in Topo.Certificate.summary Topo.Data.numbers.
