(** Edges in a breadth-first tree and outside of it (section 11).

    SCEPTICS READ [in_tree], [chords] and [weight]. *)
From Coq Require Import Arith Lia List Bool.
Import ListNotations.
From Topo Require Import World Rotation Distance.

(** Is it the dart that leads nearer to the root's vertex? *)
Definition nearer (depth up : nat -> nat) b := (0 <? depth b) && (up b =? b).

(** Is this so of the dart or of its opposite? *)
Definition in_tree W depth up b := nearer depth up b || nearer depth up (opposite W b).

(** The edges outside of the tree, each by its lower dart. *)
Definition chords W depth up :=
  filter (fun b => negb (in_tree W depth up b) && (b <? opposite W b)) (seq 0 (darts W)).

(** d(u) + 1 + d(v), for an edge uv. *)
Definition weight W (depth : nat -> nat) b := depth b + 1 + depth (opposite W b).

(** The name of an edge: its lower dart. *)
Definition edge W b := Nat.min b (opposite W b).

Section Tree.
Variables (W : Map) (depth up : nat -> nat).
Hypothesis HW : world W.
Let WW := world_is_map W HW.
Let opposite_ok := opposite_ok W HW.

(** Both darts have it. *)
Lemma edge_opposite b : b < darts W -> edge W (opposite W b) = edge W b.
Proof.
  intros Hb. unfold edge. destruct (opposite_ok b Hb) as (_ & _ & ->). apply Nat.min_comm.
Qed.

(** And the same weight. *)
Lemma weight_opposite b : b < darts W -> weight W depth (opposite W b) = weight W depth b.
Proof. intros Hb. unfold weight. destruct (opposite_ok b Hb) as (_ & _ & ->). lia. Qed.

(** And both are in the tree or none. *)
Lemma in_tree_opposite b : b < darts W -> in_tree W depth up (opposite W b) = in_tree W depth up b.
Proof. intros Hb. unfold in_tree. destruct (opposite_ok b Hb) as (_ & _ & ->). apply orb_comm. Qed.

(** One of them has the edge's name. *)
Lemma edge_or b : edge W b = b \/ edge W b = opposite W b.
Proof. unfold edge. lia. Qed.

Hypothesis B : breadth_first W depth up.

(** Turning changes neither distance nor dart nearer. *)
Lemma depth_turn k b : b < darts W -> depth (turn W k b) = depth b /\ up (turn W k b) = up b.
Proof.
  intros Hb. induction k as [|k [IH IH']]; simpl; auto.
  destruct (bf_sigma W depth up B (turn W k b)) as [E E']; [apply turn_lt; auto|].
  split; congruence.
Qed.
End Tree.
