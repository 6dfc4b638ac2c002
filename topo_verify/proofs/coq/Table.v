(** Maps as tables, and programs that check that a table is a connected map that shows a log (claim
    9).

    t is a table, d a dart, n the number of rows, L a log, ms a list of moves. TableCorrect.v
    proves what these programs decide. *)
From Coq Require Import Arith List Bool.
Import ListNotations.
From Topo Require Import World Rotation Log.

(** A map as a table: for each dart the next and the previous dart in the rotation, and the other
    dart of its edge, None where it is open. The root is dart 0. Every dart but 0 follows its
    predecessor in number or is joined with a smaller dart, so that the table shows its own
    connectedness; a numbering by discovery does so. *)
Definition map_table := list (nat * nat * option nat).

(** The row of dart d. *)
Definition row (t : map_table) d := nth d t (0, 0, None).

(** The map that the table describes. *)
Definition map_of (t : map_table) :=
  {| darts := length t; sigma := fun d => fst (fst (row t d)); alpha := fun d => snd (row t d);
    root := 0 |}.

(** The row of dart d is right: its numbers are darts, next and previous dart agree, alpha is an
    involution without fixed point, and the dart is reached from a smaller one. *)
Definition check_row t n d :=
  let '(s, _, x) := row t d in
  (s <? n) && (snd (fst (row t s)) =? d) &&
  match x with
  | Some e => (e <? n) && negb (e =? d) && match snd (row t e) with Some y => y =? d | None => false end
  | None => true end &&
  ((d =? 0) || (fst (fst (row t (d - 1))) =? d) || match x with Some e => e <? d | None => false end).

(** The table has a row, and every row is right. *)
Definition check_table t := let n := length t in (0 <? n) && forallb (check_row t n) (seq 0 n).

(** The map shows the percepts of these moves, starting at dart a. *)
Fixpoint check_moves M a ms := match ms with
  | [] => true
  | (k, p) :: ms => match move M a k with
                    | Some b => percept_eqb (percept M b) p && check_moves M b ms
                    | None => false end
  end.

(** The table is a connected map that shows the log. *)
Definition check_map t L := check_table t &&
  (percept_eqb (percept (map_of t) 0) (start L) && check_moves (map_of t) 0 (moves L)).

(** No dart of the table is open. *)
Definition total (t : map_table) :=
  forallb (fun r => match snd r with Some _ => true | None => false end) t.

(** The check of the verdict REFUTED: the table shows the log and has an open dart. *)
Definition refute L (t : map_table) := check_map t L && negb (total t).
