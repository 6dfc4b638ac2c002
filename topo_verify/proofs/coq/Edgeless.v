(** Claim 9 and the least cost for all worlds, the one without an edge among them (docs/semantics.md,
    sections 1 and 11).

    w is any world, the point or a world W with edges; L is a log, f a mapper, M the map that it
    delivers. SCEPTICS READ every definition of this file. *)
From Coq Require Import Arith Lia List.
Import ListNotations.
From Topo Require Import World Rotation Log Determined Entailed Sound Distance LeastCost AnyWorld.

(** The log is that of the point, or it is closed. *)
Definition closed_any L := start L = nothing_there /\ moves L = [] \/ closed L.

(** A deterministic mapper for all worlds: the next door, or the map that it delivers. *)
Definition any_strategy := Log -> nat + any_world.

(** The mapper f takes the doors of L one after the other and then delivers M. *)
Definition ends_any (f : any_strategy) L M :=
  (forall i k, door L i = Some k -> f (cut L i) = inl k) /\ f L = inr M.

(** The mapper f is right in every world in which it ends. *)
Definition sound_any f := forall w L M, shows_log w L -> ends_any f L M -> alike M w.

(** Claim 9, for all worlds: a log is closed, or that of the point, exactly if all worlds that show
    it are one.
    Not in the paper. *)
Theorem closed_any_iff w L : shows_log w L ->
  (closed_any L <-> forall w', shows_log w' L -> alike w w').
Proof.
  intros Sh. destruct w as [|W]; simpl in Sh.
  - split; [|intros _; left; auto]. intros _ [|W']; simpl; auto. intros [HW R].
    apply (edges_seen W' L HW R). apply Sh.
  - destruct Sh as [HW R]. split.
    + intros [[E _]|C] [|W'] Sh'; simpl in *; try (destruct (edges_seen W L HW R); tauto).
      destruct Sh' as [HW' R']. apply (closed_determines L); auto.
    + intros H. right. apply (closed_iff_determined W L HW R). intros W' HW' R'.
      apply (H (Edges W')). simpl. auto.
Qed.

(** Claim 9, for all worlds: a mapper that is right in every world leaves such a log in each.
    Not in the paper. *)
Theorem sound_any_closed f : sound_any f -> forall w L M, shows_log w L -> ends_any f L M ->
  closed_any L.
Proof.
  intros So w L M Sh E. destruct w as [|W]; [left; apply Sh|right]. destruct Sh as [HW R].
  destruct (closed_or_undetermined W L HW R) as [C|(W1 & W2 & H1 & H2 & R1 & R2 & N)]; auto.
  destruct N. assert (A := So (Edges W1) L M (conj H1 R1) E).
  assert (A' := So (Edges W2) L M (conj H2 R2) E).
  destruct M as [|M]; simpl in *; [destruct A|]. rewrite <- (proj1 A). apply A'.
Qed.

(** Section 11, for all worlds: such a mapper makes at least LB moves; in the point that is none.
    Not in the paper. *)
Theorem sound_any_cost f : sound_any f -> forall W L M depth up, shows_log (Edges W) L ->
  ends_any f L M -> breadth_first W depth up -> least_cost W depth up <= length (moves L).
Proof.
  intros So W L M depth up Sh E B. assert (C := sound_any_closed f So (Edges W) L M Sh E).
  destruct Sh as [HW R]. destruct C as [[X _]|C]; [destruct (edges_seen W L HW R X)|].
  destruct (replays_visits W L (world_is_map W HW) R) as [v V].
  apply (closed_least_cost W L v depth up HW V C B).
Qed.
