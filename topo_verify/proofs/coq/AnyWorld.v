(** All worlds, the one without an edge among them (docs/semantics.md, section 1).

    In World.v a map has a root, so the world of one vertex and no dart (m = 0) is left out. Here it
    is put beside the others: w is any world, the point or a world W with edges; L is a log.

    In the point a robot senses degree 0 and cannot move; in every other world it senses a degree
    above 0. So the first percept tells the point from all others ([edges_seen]). SCEPTICS READ every
    definition of this file but [of_point], a program. *)
From Coq Require Import Arith Lia List Bool.
Import ListNotations.
From Topo Require Import World Rotation Log.

(** Any world: the point, or a world with edges. *)
Inductive any_world := Point | Edges (W : Map).

(** The percept of a robot in the point. *)
Definition nothing_there : Percept := (0, None).

(** The world w shows the log L. *)
Definition shows_log w L := match w with
  | Point => start L = nothing_there /\ moves L = []
  | Edges W => world W /\ replays W L end.

(** Two worlds are one up to the numbering of the darts. *)
Definition alike w w' := match w, w' with
  | Point, Point => True | Edges W, Edges W' => isomorphic W W' | _, _ => False end.

(** No world with edges shows the log of the point. *)
Lemma edges_seen W L : world W -> replays W L -> start L <> nothing_there.
Proof.
  intros HW [R _] E. rewrite E in R. assert (WW := world_is_map W HW). injection R as R _.
  destruct (degree_spec W WW (root W)) as (D & _); [apply root_lt; auto|]. lia.
Qed.

(** Is this the log of the point? *)
Definition of_point L := percept_eqb (start L) nothing_there &&
  match moves L with [] => true | _ => false end.

(** [of_point] decides whether the point shows the log. *)
Lemma of_point_spec L : of_point L = true <-> shows_log Point L.
Proof.
  unfold of_point. rewrite andb_true_iff. simpl.
  destruct (percept_eqb_spec (start L) nothing_there), (moves L); intuition congruence.
Qed.
