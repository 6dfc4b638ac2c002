(** Programs that check certificates: a log, and evidence from code that is not trusted (claims 9
    and 10; docs/proofs.md).

    L      a log                             T     the percept of each visit, as a binary map
    x, y   visits, counted from 1 in binary  D     the edge of each move, as a binary map
    p, q   places with binary visits         U     the union-find
    a      an arc                            C     the darts crossed, by representative
    ev, s  evidence, one step of it          c     a conflict

    Evidence is the list of merges of a union-find that folds the log, in their order. Each merge
    is a pair of arcs that leave by the same dart. The program does a merge only if the two do
    leave by the same dart, so wrong evidence merges too little, never too much. CheckerCorrect.v
    proves what these programs decide. *)
From Coq Require Import Arith List Bool PArith FMapPositive.
Import ListNotations.
From Topo Require Import World Rotation Log Table.

(** The number of visit x in the log: binary visits count from 1, those of the log from 0. *)
Definition num x := pred (Pos.to_nat x).

(** A place whose visit is a binary number. *)
Definition pplace := (positive * nat)%type.

(** The same place in the log. *)
Definition abs (p : pplace) : place := (num (fst p), snd p).

(** Both ends of an edge as places of the log. *)
Definition abs2 (l : pplace * pplace) : place * place := (abs (fst l), abs (snd l)).

(** The decision procedure for equality of such places. *)
Definition pplace_eqb (p q : pplace) := Pos.eqb (fst p) (fst q) && (snd p =? snd q).

(** The list with its elements numbered from x. *)
Fixpoint enum {X} x (l : list X) : list (positive * X) :=
  match l with [] => [] | a :: l => (x, a) :: enum (Pos.succ x) l end.

(** The list as a binary map, numbered from 1. *)
Definition table_of {X} (l : list X) : PositiveMap.t X :=
  fold_left (fun t xa => PositiveMap.add (fst xa) (snd xa) t) (enum 1 l) (PositiveMap.empty X).

(** The percepts of all visits in order. *)
Definition sights L := start L :: map snd (moves L).

(** The edges crossed, move by move, then the assumed ones. *)
Definition edges L (extra : list (pplace * pplace)) : list (pplace * pplace) :=
  map (fun xk => ((fst xk, snd xk), (Pos.succ (fst xk), 0))) (enum 1 (map fst (moves L))) ++ extra.

(** The union-find: for a visit its parent, and the offset at the parent that is this visit's
    reference dart. *)
Definition unions := PositiveMap.t pplace.

(** How many parents are followed: enough for a union by size of 2^40 visits. *)
Definition fuel := 40.

(** An arc: an edge and its direction, true from its first end to its second. *)
Definition arc := (bool * positive)%type.

Section Check.
Variables (T : PositiveMap.t Percept) (D : PositiveMap.t (pplace * pplace)).

(** The same place with its offset reduced modulo the degree. *)
Definition reduced (p : pplace) : pplace := match PositiveMap.find (fst p) T with
  | Some (d, _) => (fst p, snd p mod d) | None => p end.

(** The representative of the class of p. *)
Fixpoint rep n (U : unions) (p : pplace) : pplace := match n with 0 => p | S n =>
  match PositiveMap.find (fst p) U with
  | Some (y, o) => rep n U (reduced (y, snd p + o)) | None => p end end.

(** Merge the classes of two places: the representative of q becomes a child of that of p. *)
Definition unite (U : unions) (p q : pplace) : unions :=
  let (x, i) := rep fuel U p in let (y, j) := rep fuel U q in
  if Pos.eqb x y then U else
  match PositiveMap.find y T with
  | Some (d, _) => if j <=? d then PositiveMap.add y (reduced (x, d - j + i)) U else U
  | None => U end.

(** The two ends of an arc: the place where it leaves, the place where it arrives. *)
Definition arc_ends (a : arc) : option (pplace * pplace) :=
  match PositiveMap.find (snd a) D with
  | Some (p, q) => Some (if fst a then (p, q) else (q, p))
  | None => None end.

(** If two arcs leave by the same dart, the places where they arrive; these are one dart. *)
Definition meet (U : unions) (s : arc * arc) : option (pplace * pplace) :=
  match arc_ends (fst s), arc_ends (snd s) with
  | Some (p, q), Some (p', q') =>
      if pplace_eqb (rep fuel U p) (rep fuel U p') then Some (q, q') else None
  | _, _ => None end.

(** One step of evidence: merge where the two arcs arrive, if they meet. *)
Definition glue (U : unions) (s : arc * arc) : unions :=
  match meet U s with Some (q, q') => unite U q q' | None => U end.

(** The union-find at the beginning: the visits that saw the marker are one class. *)
Definition markers (l : list Percept) : unions := fold_left (fun U (v : positive * Percept) =>
  match snd (snd v) with Some j => unite U (1%positive, 0) (fst v, j) | None => U end)
  (enum 1 l) (PositiveMap.empty _).

(** The darts crossed at a representative. *)
Definition offsets (C : PositiveMap.t (list nat)) x :=
  match PositiveMap.find x C with Some l => l | None => [] end.

(** Add the dart by which the arc leaves to the darts crossed. *)
Definition cover U C (a : arc) := match arc_ends a with
  | Some (p, _) => let (x, k) := rep fuel U p in
      if existsb (Nat.eqb k) (offsets C x) then C else PositiveMap.add x (k :: offsets C x) C
  | None => C end.

(** All darts crossed, in either direction, by representative. *)
Definition covered U (l : list (pplace * pplace)) : PositiveMap.t (list nat) :=
  fold_left (fun C m => cover U (cover U C (true, fst m)) (false, fst m)) (enum 1 l)
    (PositiveMap.empty _).

(** Every door of every visit was crossed, so the log is closed. *)
Definition check_closed U (s : list Percept) (l : list (pplace * pplace)) := let C := covered U l in
  forallb (fun v : positive * Percept => (0 <? fst (snd v)) && forallb (fun i =>
    let (x, k) := rep fuel U (fst v, i) in existsb (Nat.eqb k) (offsets C x))
    (seq 0 (fst (snd v)))) (enum 1 s).

(** The places p and q cannot be one dart: the degrees differ, or only one sees the marker, or a
    vertex would be turned against itself. *)
Definition apart U (p q : pplace) :=
  match PositiveMap.find (fst p) T, PositiveMap.find (fst q) T with
  | Some (d, m), Some (e, n) => negb (d =? e) ||
      match m, n with Some _, None | None, Some _ => true | _, _ => false end
  | _, _ => false end ||
  let (x, i) := rep fuel U p in let (y, j) := rep fuel U q in
  Pos.eqb x y && negb (i =? j) &&
  match PositiveMap.find x T with Some (d, _) => (i <? d) && (j <? d) | None => false end.

(** Why no world shows the log: two arcs from one dart arrive at places that are apart; a visit
    that saw the marker is apart from the start; the two darts of an edge are one. *)
Inductive conflict := Arrive (s : arc * arc) | Marked (x : positive) | Alone (x : positive).

(** The union-find shows this conflict. *)
Definition check_conflict U c := match c with
  | Arrive s => match meet U s with Some (q, q') => apart U q q' | None => false end
  | Marked x => match PositiveMap.find x T with
                | Some (_, Some j) => apart U (1%positive, 0) (x, j) | _ => false end
  | Alone x => match PositiveMap.find x D with
               | Some (p, q) => pplace_eqb (rep fuel U p) (rep fuel U q) | None => false end
  end.

(** The arc joins the classes of p and q. *)
Definition check_partners U p q a := match arc_ends a with
  | Some (p', q') => pplace_eqb (rep fuel U p) (rep fuel U p') &&
                     pplace_eqb (rep fuel U q) (rep fuel U q')
  | None => false end.
End Check.

(** Evidence: the pairs of arcs that meet, in order. *)
Definition evidence := list (arc * arc).

(** The union-find of the log with the assumed edges, after all merges of the evidence. *)
Definition folded L extra (ev : evidence) :=
  let T := table_of (sights L) in
  fold_left (glue T (table_of (edges L extra))) ev (markers T (sights L)).

(** The evidence shows that the log is closed. *)
Definition proves L ev := check_closed (table_of (sights L)) (table_of (edges L []))
  (folded L [] ev) (sights L) (edges L []).

(** The check of the verdict PROVED: the table is a world that shows the log, and the evidence
    shows that the log is closed. *)
Definition certified L (t : map_table) ev := check_map t L && (total t && proves L ev).

(** Some world shows this percept: the degree is positive, and the marker's direction is below
    the degree. *)
Definition legal_percept (p : Percept) :=
  (0 <? fst p) && match snd p with Some j => j <? fst p | None => true end.

(** Every door taken exists, starting at a vertex of degree d, and every percept is legal. *)
Fixpoint legal_moves d (ms : list (nat * Percept)) := match ms with
  | [] => true
  | (k, p) :: ms => (k <? d) && legal_percept p && legal_moves (fst p) ms end.

(** The log is legal: it starts at the marker, facing along it, with legal percepts and doors. *)
Definition legal L := legal_percept (start L) &&
  match snd (start L) with Some 0 => true | _ => false end && legal_moves (fst (start L)) (moves L).

(** The check that no world shows the log: it is not legal, or its fold has this conflict. *)
Definition impossible L ev c := negb (legal L) ||
  check_conflict (table_of (sights L)) (table_of (edges L [])) (folded L [] ev) c.

(** The check that no world that shows the log has an edge from p to q: the fold with that edge
    has this conflict. *)
Definition rejected L p q ev c := let T := table_of (sights L) in
  PositiveMap.mem (fst p) T && PositiveMap.mem (fst q) T &&
  check_conflict T (table_of (edges L [(p, q)])) (folded L [(p, q)] ev) c.

(** The check that every world that shows the log has an edge from p to q: an arc joins their
    classes. *)
Definition confirmed L p q ev a :=
  check_partners (table_of (sights L)) (table_of (edges L [])) (folded L [] ev) p q a.
