(** A map as a table, checked by computing: it is a map, connected, and shows the log. *)
From Coq Require Import Arith List Bool.
Import ListNotations.
From Topo Require Import World Rotation Log.

(** A map as a table: each dart's next and previous dart in the rotation and its other end.
    The root is dart 0; a dart other than 0 follows its predecessor or is joined with a
    smaller dart (a numbering by discovery is such). *)
Definition map_table := list (nat * nat * option nat).

(** The row of dart d. *)
Definition row (t : map_table) d := nth d t (0, 0, None).

(** The map that the table tells. *)
Definition map_of (t : map_table) :=
  {| darts := length t; sigma := fun d => fst (fst (row t d)); alpha := fun d => snd (row t d);
    root := 0 |}.

(** A dart's row: its numbers are darts, next and previous agree, alpha is an involution, and the
    dart is reached from a lower one. *)
Definition check_row t n d :=
  let '(s, _, x) := row t d in
  (s <? n) && (snd (fst (row t s)) =? d) &&
  match x with
  | Some e => (e <? n) && negb (e =? d) && match snd (row t e) with Some y => y =? d | None => false end
  | None => true end &&
  ((d =? 0) || (fst (fst (row t (d - 1))) =? d) || match x with Some e => e <? d | None => false end).

(** All rows. *)
Definition check_table t := let n := length t in (0 <? n) && forallb (check_row t n) (seq 0 n).

(** The map shows these moves from dart a. *)
Fixpoint check_moves M a ms := match ms with
  | [] => true
  | (k, p) :: ms => match move M a k with
                    | Some b => percept_eqb (percept M b) p && check_moves M b ms
                    | None => false end
  end.

(** The table is a connected map that shows the log. *)
Definition check_map t L := check_table t &&
  (percept_eqb (percept (map_of t) 0) (start L) && check_moves (map_of t) 0 (moves L)).

(** Nothing of the table is open. *)
Definition total (t : map_table) :=
  forallb (fun r => match snd r with Some _ => true | None => false end) t.

(** The verdict REFUTED, to be checked: the table shows the log and has an open dart. *)
Definition refute L (t : map_table) := check_map t L && negb (total t).
