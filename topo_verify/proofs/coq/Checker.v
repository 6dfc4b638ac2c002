(** Programs that check certificates: a log, and evidence from code that nobody trusts.

    Evidence is the merges of a union-find that folds the log, in their order: pairs of arcs that
    leave by the same dart. Each is done only if they do leave by the same dart, so evidence that
    lies merges too little, never too much. *)
From Coq Require Import Arith List Bool PArith FMapPositive.
Import ListNotations.
From Topo Require Import World Rotation Log Table.

(** Visits are counted from 1 in binary: visit x is visit [num x] of the log. *)
Definition num x := pred (Pos.to_nat x).

(** A place of a log, its visit in binary. *)
Definition pplace := (positive * nat)%type.

(** The same place with its visit counted from 0. *)
Definition abs (p : pplace) : place := (num (fst p), snd p).

(** Both ends of an edge. *)
Definition abs2 (l : pplace * pplace) : place * place := (abs (fst l), abs (snd l)).

(** Are they equal? *)
Definition pplace_eqb (p q : pplace) := Pos.eqb (fst p) (fst q) && (snd p =? snd q).

(** A list numbered from x. *)
Fixpoint enum {X} x (l : list X) : list (positive * X) :=
  match l with [] => [] | a :: l => (x, a) :: enum (Pos.succ x) l end.

(** A list as a table, numbered from 1. *)
Definition table_of {X} (l : list X) : PositiveMap.t X :=
  fold_left (fun t xa => PositiveMap.add (fst xa) (snd xa) t) (enum 1 l) (PositiveMap.empty X).

(** What was seen at the visits, in order. *)
Definition sights L := start L :: map snd (moves L).

(** The edges that were crossed, move by move, then those that are assumed. *)
Definition edges L (extra : list (pplace * pplace)) : list (pplace * pplace) :=
  map (fun xk => ((fst xk, snd xk), (Pos.succ (fst xk), 0))) (enum 1 (map fst (moves L))) ++ extra.

(** Union-find: a visit's parent and the parent's offset that is this visit's reference dart. *)
Definition unions := PositiveMap.t pplace.

(** How many parents are followed: enough for a union by size of 2^40 visits. *)
Definition fuel := 40.

(** An edge, forwards or backwards. *)
Definition arc := (bool * positive)%type.

Section Check.
Variables (T : PositiveMap.t Percept) (D : PositiveMap.t (pplace * pplace)).

(** The offset reduced modulo the degree. *)
Definition reduced (p : pplace) : pplace := match PositiveMap.find (fst p) T with
  | Some (d, _) => (fst p, snd p mod d) | None => p end.

(** The place that stands for all that are the same. *)
Fixpoint rep n (U : unions) (p : pplace) : pplace := match n with 0 => p | S n =>
  match PositiveMap.find (fst p) U with
  | Some (y, o) => rep n U (reduced (y, snd p + o)) | None => p end end.

(** Make two places one: the visit of the second is hung under that of the first. *)
Definition unite (U : unions) (p q : pplace) : unions :=
  let (x, i) := rep fuel U p in let (y, j) := rep fuel U q in
  if Pos.eqb x y then U else
  match PositiveMap.find y T with
  | Some (d, _) => if j <=? d then PositiveMap.add y (reduced (x, d - j + i)) U else U
  | None => U end.

(** The two ends of an arc: where it leaves, where it arrives. *)
Definition arc_ends (a : arc) : option (pplace * pplace) :=
  match PositiveMap.find (snd a) D with
  | Some (p, q) => Some (if fst a then (p, q) else (q, p))
  | None => None end.

(** Two arcs that leave by the same dart arrive at the same dart: the two places of arrival. *)
Definition meet (U : unions) (s : arc * arc) : option (pplace * pplace) :=
  match arc_ends (fst s), arc_ends (snd s) with
  | Some (p, q), Some (p', q') =>
      if pplace_eqb (rep fuel U p) (rep fuel U p') then Some (q, q') else None
  | _, _ => None end.

(** One step of evidence. *)
Definition glue (U : unions) (s : arc * arc) : unions :=
  match meet U s with Some (q, q') => unite U q q' | None => U end.

(** At the beginning only the visits that saw the marker are one. *)
Definition markers (l : list Percept) : unions := fold_left (fun U (v : positive * Percept) =>
  match snd (snd v) with Some j => unite U (1%positive, 0) (fst v, j) | None => U end)
  (enum 1 l) (PositiveMap.empty _).

(** The crossed darts of a visit. *)
Definition offsets (C : PositiveMap.t (list nat)) x :=
  match PositiveMap.find x C with Some l => l | None => [] end.

(** Note that the arc's dart was crossed. *)
Definition cover U C (a : arc) := match arc_ends a with
  | Some (p, _) => let (x, k) := rep fuel U p in
      if existsb (Nat.eqb k) (offsets C x) then C else PositiveMap.add x (k :: offsets C x) C
  | None => C end.

(** The darts that were crossed, one way or the other, by visit. *)
Definition covered U (l : list (pplace * pplace)) : PositiveMap.t (list nat) :=
  fold_left (fun C m => cover U (cover U C (true, fst m)) (false, fst m)) (enum 1 l)
    (PositiveMap.empty _).

(** Each door of each visit was crossed. *)
Definition check_closed U (s : list Percept) (l : list (pplace * pplace)) := let C := covered U l in
  forallb (fun v : positive * Percept => (0 <? fst (snd v)) && forallb (fun i =>
    let (x, k) := rep fuel U (fst v, i) in existsb (Nat.eqb k) (offsets C x))
    (seq 0 (fst (snd v)))) (enum 1 s).

(** Two places cannot be one: degrees differ, or the marker is seen at one only, or a vertex would
    be itself, turned. *)
Definition apart U (p q : pplace) :=
  match PositiveMap.find (fst p) T, PositiveMap.find (fst q) T with
  | Some (d, m), Some (e, n) => negb (d =? e) ||
      match m, n with Some _, None | None, Some _ => true | _, _ => false end
  | _, _ => false end ||
  let (x, i) := rep fuel U p in let (y, j) := rep fuel U q in
  Pos.eqb x y && negb (i =? j) &&
  match PositiveMap.find x T with Some (d, _) => (i <? d) && (j <? d) | None => false end.

(** Why no world shows the log: two arcs from one dart arrive apart; a visit that saw the marker is
    apart from the start; an edge has one dart only. *)
Inductive conflict := Arrive (s : arc * arc) | Marked (x : positive) | Alone (x : positive).

(** Is this a contradiction? *)
Definition check_conflict U c := match c with
  | Arrive s => match meet U s with Some (q, q') => apart U q q' | None => false end
  | Marked x => match PositiveMap.find x T with
                | Some (_, Some j) => apart U (1%positive, 0) (x, j) | _ => false end
  | Alone x => match PositiveMap.find x D with
               | Some (p, q) => pplace_eqb (rep fuel U p) (rep fuel U q) | None => false end
  end.

(** The arc joins these two places. *)
Definition check_partners U p q a := match arc_ends a with
  | Some (p', q') => pplace_eqb (rep fuel U p) (rep fuel U p') &&
                     pplace_eqb (rep fuel U q) (rep fuel U q')
  | None => false end.
End Check.

(** Evidence: which arcs meet, in order. *)
Definition evidence := list (arc * arc).

(** The log folded as the evidence says, with these edges assumed. *)
Definition folded L extra (ev : evidence) :=
  let T := table_of (sights L) in
  fold_left (glue T (table_of (edges L extra))) ev (markers T (sights L)).

(** The fold has no open dart. *)
Definition proves L ev := check_closed (table_of (sights L)) (table_of (edges L []))
  (folded L [] ev) (sights L) (edges L []).

(** The verdict PROVED, to be checked: a log, a map and evidence, all from untrusted code. *)
Definition certified L (t : map_table) ev := check_map t L && (total t && proves L ev).

(** Percepts that a world can show: a degree above 0, the marker at one of the doors. *)
Definition legal_percept (p : Percept) :=
  (0 <? fst p) && match snd p with Some j => j <? fst p | None => true end.

(** Doors that are there, from a vertex of degree d on. *)
Fixpoint legal_moves d (ms : list (nat * Percept)) := match ms with
  | [] => true
  | (k, p) :: ms => (k <? d) && legal_percept p && legal_moves (fst p) ms end.

(** A log that does not go wrong in itself; it starts at the marker, facing along it. *)
Definition legal L := legal_percept (start L) &&
  match snd (start L) with Some 0 => true | _ => false end && legal_moves (fst (start L)) (moves L).

(** The verdict that no world shows the log, to be checked. *)
Definition impossible L ev c := negb (legal L) ||
  check_conflict (table_of (sights L)) (table_of (edges L [])) (folded L [] ev) c.

(** No world shows the log and has an edge from p to q. *)
Definition rejected L p q ev c := let T := table_of (sights L) in
  PositiveMap.mem (fst p) T && PositiveMap.mem (fst q) T &&
  check_conflict T (table_of (edges L [(p, q)])) (folded L [(p, q)] ev) c.

(** Every world that shows the log has an edge from p to q. *)
Definition confirmed L p q ev a :=
  check_partners (table_of (sights L)) (table_of (edges L [])) (folded L [] ev) p q a.
