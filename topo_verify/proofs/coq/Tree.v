(** Edges in a breadth-first tree, and chords, the edges outside of it (docs/semantics.md, section
    11).

    W is a world, b a dart; depth and up describe a breadth-first tree (Distance.v). SCEPTICS
    READ [in_tree], [chords] and [weight]. *)
From Coq Require Import Arith Lia List Bool.
Import ListNotations.
From Topo Require Import World Rotation Distance.

(** Is b the dart by which its vertex's tree edge leads to the parent? *)
Definition nearer (depth up : nat -> nat) b := (0 <? depth b) && (up b =? b).

(** Is the edge of b in the tree? *)
Definition in_tree W depth up b := nearer depth up b || nearer depth up (opposite W b).

(** The edges outside of the tree, each given by its lower dart. *)
Definition chords W depth up :=
  filter (fun b => negb (in_tree W depth up b) && (b <? opposite W b)) (seq 0 (darts W)).

(** The length of the loop that an edge uv closes in the tree, d(u) + 1 + d(v). *)
Definition weight W (depth : nat -> nat) b := depth b + 1 + depth (opposite W b).

(** The representative of an edge: the lower of its two darts. *)
Definition edge W b := Nat.min b (opposite W b).

Section Tree.
Variables (W : Map) (depth up : nat -> nat).
Hypothesis HW : world W.
Let WW := world_is_map W HW.
Let opposite_ok := opposite_ok W HW.

(** Both darts of an edge have the same representative. *)
Lemma edge_opposite b : b < darts W -> edge W (opposite W b) = edge W b.
Proof.
  intros Hb. unfold edge. destruct (opposite_ok b Hb) as (_ & _ & ->). apply Nat.min_comm.
Qed.

(** Both darts of an edge have the same weight. *)
Lemma weight_opposite b : b < darts W -> weight W depth (opposite W b) = weight W depth b.
Proof. intros Hb. unfold weight. destruct (opposite_ok b Hb) as (_ & _ & ->). lia. Qed.

(** Both darts of an edge are in the tree, or neither is. *)
Lemma in_tree_opposite b : b < darts W -> in_tree W depth up (opposite W b) = in_tree W depth up b.
Proof. intros Hb. unfold in_tree. destruct (opposite_ok b Hb) as (_ & _ & ->). apply orb_comm. Qed.

(** The representative of an edge is one of its two darts. *)
Lemma edge_or b : edge W b = b \/ edge W b = opposite W b.
Proof. unfold edge. lia. Qed.

Hypothesis B : breadth_first W depth up.

(** All darts of a vertex have the same depth and the same up. *)
Lemma depth_turn k b : b < darts W -> depth (turn W k b) = depth b /\ up (turn W k b) = up b.
Proof.
  intros Hb. induction k as [|k [IH IH']]; simpl; auto.
  destruct (bf_sigma W depth up B (turn W k b)) as [E E']; [apply turn_lt; auto|].
  split; congruence.
Qed.
End Tree.
