(** Worlds, what the robot senses, and what it means that a map is the world.

    THIS FILE IS WHAT A SCEPTIC READS. It contains definitions only, no theorem. It says what
    sections 1 to 3 of docs/semantics.md say, with the same names. Worlds have any number of darts
    but 0: the world without an edge (m = 0) has no root; AnyWorld.v puts it beside the others.

    M, W    a map, a world                            a, b, d, e    darts: 0, 1, ..., darts M - 1
    sigma   the next dart clockwise at a vertex       k, j          doors, offsets at a vertex
    alpha   the other dart of an edge                 w             doors taken one after the other
    phi     a correspondence of darts

    A vertex is a cycle of [sigma]; an edge is a dart and its [alpha]. *)
From Coq Require Import Arith List.
Import ListNotations.

(** A map: its number of darts; the next dart clockwise; the other dart of the edge, None where
    the edge is unexplored; the dart that the marker points at. What the functions say beyond the
    darts has no meaning. *)
Record Map := { darts : nat; sigma : nat -> nat; alpha : nat -> option nat; root : nat }.

(** The map is well formed: sigma is a permutation of the darts; alpha is an involution without
    fixed point on the explored darts; the root is a dart. *)
Record is_map (M : Map) : Prop := {
  sigma_lt : forall d, d < darts M -> sigma M d < darts M;
  sigma_inj : forall d e, d < darts M -> e < darts M -> sigma M d = sigma M e -> d = e;
  alpha_ok : forall d e, d < darts M -> alpha M d = Some e ->
             e < darts M /\ e <> d /\ alpha M e = Some d;
  root_lt : root M < darts M }.

(** Dart d can be reached from p by turning at vertices and crossing explored edges. *)
Inductive reach (M : Map) (p : nat) : nat -> Prop :=
| reach_here : reach M p p
| reach_sigma d : reach M p d -> reach M p (sigma M d)
| reach_alpha d e : reach M p d -> alpha M d = Some e -> reach M p e.

(** Every dart can be reached from the root. *)
Definition connected M := forall d, d < darts M -> reach M (root M) d.

(** A world is a connected map without unexplored darts. *)
Record world (W : Map) : Prop := {
  world_is_map : is_map W;
  world_total : forall d, d < darts W -> alpha W d <> None;
  world_connected : connected W }.

(** sigma^k(a): the k-th dart clockwise from a at its vertex. *)
Fixpoint turn (M : Map) (k a : nat) : nat :=
  match k with 0 => a | S k => sigma M (turn M k a) end.

(** The degree of the vertex of a: the least k > 0 with sigma^k(a) = a. *)
Definition degree M a :=
  match find (fun k => turn M k a =? a) (seq 1 (darts M)) with Some k => k | None => 0 end.

(** The direction of the marker, counted from reference dart a: the least j < degree with
    sigma^j(a) = root; None where the marker is not at this vertex. *)
Definition marker M a := find (fun j => turn M j a =? root M) (seq 0 (degree M a)).

(** What the robot senses: the degree of the vertex, and the direction of the marker if it is
    there. *)
Definition Percept : Type := nat * option nat.

(** What the robot senses when its reference dart is a. *)
Definition percept M a : Percept := (degree M a, marker M a).

(** Leaving by door k, counted from reference dart a: the new reference dart, if the vertex has
    that door and the map knows where it leads. *)
Definition move M a k := if k <? degree M a then alpha M (turn M k a) else None.

(** The reference dart after the doors w have been taken. *)
Fixpoint walk M a (w : list nat) : option nat :=
  match w with
  | [] => Some a
  | k :: w => match move M a k with Some b => walk M b w | None => None end
  end.

(** What the robot senses after each of the doors w. *)
Fixpoint percepts M a (w : list nat) : option (list Percept) :=
  match w with
  | [] => Some []
  | k :: w => match move M a k with
              | Some b => option_map (cons (percept M b)) (percepts M b w)
              | None => None end
  end.

(** phi embeds M in W: it maps different darts to different darts, the root to the root, and
    keeps the rotation and the explored edges. *)
Record embedded (M W : Map) (phi : nat -> nat) : Prop := {
  phi_lt : forall d, d < darts M -> phi d < darts W;
  phi_inj : forall d e, d < darts M -> e < darts M -> phi d = phi e -> d = e;
  phi_sigma : forall d, d < darts M -> phi (sigma M d) = sigma W (phi d);
  phi_alpha : forall d e, d < darts M -> alpha M d = Some e -> alpha W (phi d) = Some (phi e);
  phi_root : phi (root M) = root W }.

(** M is W up to the numbering of the darts: a bijection keeps root, sigma and alpha. *)
Definition isomorphic M W := darts M = darts W /\ exists phi, embedded M W phi /\
  (forall b, b < darts W -> exists d, d < darts M /\ phi d = b) /\
  (forall d, d < darts M -> alpha W (phi d) = option_map phi (alpha M d)).
