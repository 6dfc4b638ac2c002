(** The program that checks the decisions of a log: each must follow from the events before it (claim
    10; docs/proofs.md).

    m is a moment of the walk along the log, s the sketch of the map S, r a reason, rs the reasons
    of one decision, rss those of all; e, h, a, es are the letters of Events.v; the other letters
    are those of Checker.v.

    The program walks the events once. It folds the log as it goes, and draws S: it keeps a place of
    the log for each open dart. So the facts that a decision states are found here, from the
    event alone. For a rejection the program assumes the edge, continues the fold to a conflict, and
    forgets that part again. The evidence is not trusted. DecisionsCorrect.v proves what the program
    decides. *)
From Coq Require Import Arith List Bool PArith FMapPositive.
Import ListNotations.
From Topo Require Import World Log Checker Events.

(** A fact about places of a log: an edge leads from place p to place q, or none does. *)
Inductive place_fact := Leads (p q : pplace) | LeadsNot (p q : pplace).

(** The reason for a fact: this arc joins the two places; or the fold with an edge between them,
    continued by ev, has the conflict c. *)
Inductive reason := Joined (a : arc) | Refuted (ev : evidence) (c : conflict).

(** A moment of the walk: the visit, the percepts and edges up to it, and the union-find. *)
Record moment := { here : positive; sighted : PositiveMap.t Percept;
  crossed : PositiveMap.t (pplace * pplace); unified : unions }.

(** The moment at the start. *)
Definition outset (p : Percept) : moment := let T := table_of [p] in
  {| here := 1; sighted := T; crossed := table_of []; unified := markers T [p] |}.

(** The moment one move later: one more visit, one more edge, and a merge if the visit saw the
    marker. *)
Definition onward m (a : nat * Percept) := let y := Pos.succ (here m) in
  let T := PositiveMap.add y (snd a) (sighted m) in
  {| here := y; sighted := T;
     crossed := PositiveMap.add (here m) ((here m, fst a), (y, 0)) (crossed m);
     unified := match snd (snd a) with
       | Some j => unite T (unified m) (1%positive, 0) (y, j) | None => unified m end |}.

(** Do the merges whose arcs exist already at this moment: the moment after them, and the
    evidence that is left. *)
Fixpoint settle m (ev : evidence) := match ev with [] => (m, []) | s :: rest =>
  if Pos.ltb (snd (fst s)) (here m) && Pos.ltb (snd (snd s)) (here m) then
    settle {| here := here m; sighted := sighted m; crossed := crossed m;
              unified := glue (sighted m) (crossed m) (unified m) s |} rest
  else (m, ev) end.

(** The reason proves the fact at this moment. *)
Definition supported m d r := match d, r with
  | Leads p q, Joined a => check_partners (sighted m) (crossed m) (unified m) p q a
  | LeadsNot p q, Refuted ev c => let T := sighted m in
      let D := PositiveMap.add (here m) (p, q) (crossed m) in
      PositiveMap.mem (fst p) T && PositiveMap.mem (fst q) T &&
      check_conflict T D (fold_left (glue T D) ev (unified m)) c
  | _, _ => false end.

(** What the program knows of the map S: how many darts it has, and of each open dart its number and
    a place of the log where it was seen. *)
Record sketch := { size : nat; opened : list (nat * pplace) }.

(** The darts size, size + 1, ... of a vertex of degree d, seen from place p on. *)
Definition seen_from T n d (p : pplace) :=
  map (fun i => (n + i, reduced T (fst p, snd p + i))) (seq 0 d).

(** The sketch at the start. *)
Definition first_sketch (p : Percept) :=
  {| size := fst p; opened := seen_from (table_of [p]) 0 (fst p) (1%positive, 0) |}.

(** The place of an open dart. *)
Definition place_of s e := option_map snd (find (fun o : nat * pplace => fst o =? e) (opened s)).

(** The open darts without e. *)
Definition but e (l : list (nat * pplace)) := filter (fun o => negb (fst o =? e)) l.

(** Every other open dart is refuted, each by the next reason. *)
Fixpoint all_refuted m p (l : list (nat * pplace)) rs := match l, rs with
  | [], [] => true
  | o :: l, r :: rs => supported m (LeadsNot p (snd o)) r && all_refuted m p l rs
  | _, _ => false end.

(** The degree of the vertex of a place is d. *)
Definition has_degree (T : PositiveMap.t Percept) d (p : pplace) := match PositiveMap.find (fst p) T with
  | Some (d', _) => d' =? d | None => false end.

(** Check one decision and draw it: the sketch after it; None if the reasons do not prove it. *)
Definition judge m s ev rs : option sketch := match ev, rs with
  | Reject e h, [r] => match place_of s e, place_of s h with
      | Some p, Some q => if supported m (LeadsNot p q) r then Some s else None
      | _, _ => None end
  | Confirm e h, [r] => match place_of s e, place_of s h with
      | Some p, Some q => if supported m (Leads p q) r then Some s else None
      | _, _ => None end
  | Loop e h d, [r] => match place_of s e, place_of s h with
      | Some p, Some q => if supported m (Leads p q) r && has_degree (sighted m) d q && negb (h =? e)
          then Some {| size := size s; opened := but h (but e (opened s)) |} else None
      | _, _ => None end
  | New e a d, Joined c :: rs => match place_of s e, arc_ends (crossed m) c with
      | Some p, Some (_, q) => if supported m (Leads p q) (Joined c) && has_degree (sighted m) d q &&
            (a =? size s) && all_refuted m p (but e (opened s)) rs
          then Some {| size := size s + d; opened := but e (opened s) ++
                       tl (seen_from (sighted m) (size s) d q) |} else None
      | _, _ => None end
  | _, _ => None end.

(** The event draws the map S. *)
Definition draws ev := match ev with Loop _ _ _ | New _ _ _ => true | _ => false end.

(** The moment after an event that is no decision. *)
Definition passed m ev := match ev with Move k q => onward m (k, q) | _ => m end.

(** From this moment on, the reasons prove the decisions, one list of reasons for each in order. A
    decision with an empty list is not proved. What comes after the last list is not proved either;
    if a loop or a new vertex is not proved, nothing after it is. *)
Fixpoint decided_from m s (ev : evidence) es (rss : list (list reason)) := match es with
  | [] => match rss with [] => true | _ => false end
  | e :: es => if is_decision e then match rss with
      | [] => true
      | [] :: rss => (negb (draws e) || match rss with [] => true | _ => false end) &&
          decided_from m s ev es rss
      | rs :: rss => let (m, ev) := settle m ev in match judge m s e rs with
          | Some s => decided_from m s ev es rss
          | None => false end end
    else decided_from (passed m e) s ev es rss end.

(** The check of the decisions among these events, with the merges ev of the log itself and the
    reasons of each decision. *)
Definition decided p es ev rss := decided_from (outset p) (first_sketch p) ev es rss.

(** How many decisions there are among these events. *)
Definition decisions es := length (filter is_decision es).

(** Reasons are given for decision number n. *)
Definition reasoned (rss : list (list reason)) n := nth n rss [] <> [].
