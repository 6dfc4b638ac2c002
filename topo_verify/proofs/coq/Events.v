(** Logs with decisions: what a mapper declares, and when it follows from what was seen (claims 9
    and 10; docs/semantics.md, sections 3, 11 and 13).

    SCEPTICS READ this file. It contains definitions only, no theorem.

    p is the percept at the start, es a list of events, past the events before a moment; W is a
    world, M the map S, phi its correspondence with W; e, h, a are darts of S, k is a door, d a
    degree. *)
From Coq Require Import List NArith Bool.
Import ListNotations.
From Topo Require Import World Log Augment.

(** An event of a trace, as section 13 names them. The robot moves by door k and senses p. It
    declares: the edge of dart e does not end in dart h; it does; e and h are the two darts of one
    edge, and their vertex has degree d; the edge of e leads to a new vertex of degree d, whose
    first dart is a. *)
Inductive event := Move (k : nat) (p : Percept) | Reject (e h : nat) | Confirm (e h : nat)
  | Loop (e h d : nat) | New (e a d : nat).

(** What the robot did and sensed: the log of the moves among the events. *)
Definition log_after (p : Percept) (es : list event) : Log := {| start := p;
  moves := flat_map (fun ev => match ev with Move k q => [(k, q)] | _ => [] end) es |}.

(** The map S grows by a declared loop and by a declared new vertex, and by nothing else. *)
Definition drawn M ev := match ev with
  | Loop e h _ => augment_loop M e h
  | New e _ d => augment_new M e d
  | _ => M end.

(** The map S after these events: v0 has the degree that was seen at the start. *)
Definition map_after (p : Percept) es := fold_left drawn es (initial (fst p)).

(** Dart d is an unexplored dart of the map. *)
Definition open_dart M d := d < darts M /\ alpha M d = None.

(** What the event declares is true in W, in which phi embeds the map. A new vertex is one
    statement: behind e lies a vertex of degree d, and it is no vertex of the map. *)
Definition true_event W M phi ev := match ev with
  | Move _ _ => True
  | Reject e h => open_dart M e /\ open_dart M h /\ alpha W (phi e) <> Some (phi h)
  | Confirm e h => open_dart M e /\ open_dart M h /\ alpha W (phi e) = Some (phi h)
  | Loop e h d => open_dart M e /\ open_dart M h /\ alpha W (phi e) = Some (phi h) /\
      degree W (phi h) = d
  | New e a d => open_dart M e /\ a = darts M /\ exists b, alpha W (phi e) = Some b /\
      degree W b = d /\ forall h, h < darts M -> phi h <> b end.

(** Claim 10: the event follows from the events before it. In every world that shows the moves up
    to that moment the map drawn up to that moment is embedded, and the event is true there. There
    is no second embedding ([embedded_unique]). *)
Definition event_follows p past ev := forall W, world W -> replays W (log_after p past) ->
  exists phi, embedded (map_after p past) W phi /\ true_event W (map_after p past) phi ev.

(** The event is a decision. *)
Definition is_decision ev := match ev with Move _ _ => false | _ => true end.

(** A map as a mapper delivers it: of each vertex its darts clockwise, the pairs of darts that are
    edges, and the marked dart. Darts have numbers as labels. *)
Record Delivery := { rotations : list (list N); pairs : list (N * N); marked_label : N }.

(** The place of a label in a list; the length of the list where it is not in it. *)
Fixpoint label_index (x : N) l := match l with
  | [] => 0
  | y :: l => if N.eqb x y then 0 else S (label_index x l) end.

(** The label of the other dart in the first pair that has x. *)
Fixpoint partner_label (x : N) l := match l with
  | [] => None
  | (y, z) :: l => if N.eqb x y then Some z else if N.eqb x z then Some y else partner_label x l end.

(** The labels of all darts, vertex by vertex. *)
Definition labels D := concat (rotations D).

(** The labels of their next darts clockwise. *)
Definition next_labels D := flat_map (fun r => match r with
  | [] => []
  | x :: r => r ++ [x] end) (rotations D).

(** The delivered map with its darts numbered in the order of [labels]. *)
Definition delivered_map D := {| darts := length (labels D);
  sigma := fun d => label_index (nth d (next_labels D) 0%N) (labels D);
  alpha := fun d => option_map (fun y => label_index y (labels D))
    (partner_label (nth d (labels D) 0%N) (pairs D));
  root := label_index (marked_label D) (labels D) |}.

(** The delivery is right in W: it lists no vertex without a dart and no pair too many, its map is a
    world, and it is W. *)
Definition right_delivery D W := Forall (fun r => r <> []) (rotations D) /\
  2 * length (pairs D) = length (labels D) /\ world (delivered_map D) /\
  isomorphic (delivered_map D) W.
