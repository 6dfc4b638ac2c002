(** Distances in a world, and the breadth-first tree that every world has (docs/semantics.md,
    section 11).

    W is a world; a, b, d are darts; n is a distance; depth d is the distance of the vertex of d
    from v0; up d is the dart at the vertex of d that leads to its parent in the tree. SCEPTICS
    READ [opposite] and [breadth_first]. *)
From Coq Require Import Arith Lia List Bool.
Import ListNotations.
From Topo Require Import World Rotation Vertices Determined.

(** The other dart of the edge; the dart itself if the edge is unexplored. *)
Definition opposite W b := match alpha W b with Some a => a | None => b end.

(** depth and up describe a breadth-first tree: depth 0 is v0 alone; both are the same for all
    darts of a vertex; an edge changes the depth by at most 1; at every other vertex up is one of
    its darts and leads to a vertex whose depth is one less. *)
Record breadth_first W (depth up : nat -> nat) : Prop := {
  bf_root : depth (root W) = 0;
  bf_home : forall b, b < darts W -> depth b = 0 -> exists k, b = turn W k (root W);
  bf_sigma : forall b, b < darts W -> depth (sigma W b) = depth b /\ up (sigma W b) = up b;
  bf_alpha : forall b, b < darts W -> depth (opposite W b) <= S (depth b);
  bf_up : forall b, b < darts W -> 0 < depth b ->
    (exists k, up b = turn W k b) /\ S (depth (opposite W (up b))) = depth b }.

Section Distance.
Variable W : Map.
Hypothesis HW : world W.
Let WW := world_is_map W HW.

(** In a world alpha of every dart is its opposite. *)
Lemma opposite_alpha b : b < darts W -> alpha W b = Some (opposite W b).
Proof.
  intros Hb. unfold opposite. destruct (alpha W b) eqn:E; auto.
  destruct (world_total W HW b Hb E).
Qed.

(** The opposite of a dart is another dart, whose opposite is the first one. *)
Lemma opposite_ok b : b < darts W ->
  opposite W b < darts W /\ opposite W b <> b /\ opposite W (opposite W b) = b.
Proof.
  intros Hb. destruct (alpha_ok W WW b _ Hb (opposite_alpha b Hb)) as (A & N & E).
  repeat split; auto. unfold opposite at 1. rewrite E. auto.
Qed.

(** Is the vertex of d at most n edges away from v0? *)
Fixpoint within n d := match n with
  | 0 => at_vertex W (root W) d
  | S n => within n d ||
           existsb (fun b => within n b && at_vertex W (opposite W b) d) (seq 0 (darts W)) end.

(** All darts of a vertex are within the same distances. *)
Lemma within_turn n k d : d < darts W -> within n d = true -> within n (turn W k d) = true.
Proof.
  intros Hd. assert (At : forall a, a < darts W -> at_vertex W a d = true ->
    at_vertex W a (turn W k d) = true).
  { intros a Ha A. apply (at_vertex_iff W WW) in A as (j & <-); auto.
    apply (at_vertex_iff W WW); auto. exists (k + j). apply turn_add. }
  induction n as [|n IH]; simpl; [apply At, root_lt; auto|]. rewrite !orb_true_iff, !existsb_exists.
  intros [A|(b & I & A)]; [auto|right]. exists b. split; auto. apply in_seq in I.
  apply andb_true_iff in A as [A A']. rewrite A. apply At; auto. apply opposite_ok. lia.
Qed.

(** The opposite of a dart within n is within n + 1. *)
Lemma within_opposite n b : b < darts W -> within n b = true -> within (S n) (opposite W b) = true.
Proof.
  intros Hb H. simpl. apply orb_true_iff. right. apply existsb_exists. exists b.
  split; [apply in_seq; lia|]. rewrite H. apply (at_vertex_iff W WW); [apply opposite_ok; auto|].
  exists 0. auto.
Qed.

(** Every dart has a least n that it is within. *)
Lemma distance d : d < darts W ->
  exists n, within n d = true /\ forall m, within m d = true -> n <= m.
Proof.
  intros Hd. assert (H : exists n, within n d = true).
  { assert (R := world_connected W HW d Hd). clear Hd. induction R as [|d R [n IH]|d e R [n IH] E].
    - exists 0. apply (at_vertex_iff W WW); [apply root_lt; auto|]. exists 0. auto.
    - exists n. apply (within_turn n 1); auto. apply (reach_sym W (root W)); auto. apply root_lt; auto.
    - exists (S n). assert (Ld : d < darts W).
      { apply (reach_sym W (root W)); auto. apply root_lt; auto. }
      replace e with (opposite W d) by (unfold opposite; rewrite E; auto).
      apply within_opposite; auto. }
  destruct H as [n H]. destruct (find (fun n => within n d) (seq 0 (S n))) as [m|] eqn:F.
  - apply find_seq in F as (_ & F & Less). exists m. split; auto. intros k K.
    destruct (le_lt_dec m k) as [|L]; auto. rewrite Less in K; [discriminate|lia].
  - assert (X := find_none _ _ F n). simpl in X. rewrite H in X. discriminate X.
    apply (in_seq (S n) 0). lia.
Qed.

(** Every world has a breadth-first tree.
    Not in the paper. *)
Theorem breadth_first_exists : exists depth up, breadth_first W depth up.
Proof.
  destruct (choice 0 (fun d n => within n d = true /\ forall m, within m d = true -> n <= m)
    (darts W) distance) as [depth D].
  assert (Turn : forall k b, b < darts W -> depth (turn W k b) = depth b).
  { intros k b Hb. assert (Hk : turn W k b < darts W) by (apply turn_lt; auto).
    destruct (D b Hb) as [A A'], (D _ Hk) as [E E']. apply Nat.le_antisymm.
    - apply E'. apply within_turn; auto.
    - apply A'. destruct (turn_back W WW k b Hb) as (j & T).
      assert (X := within_turn _ j _ Hk E). rewrite T in X. auto. }
  assert (Cross : forall b, b < darts W -> depth (opposite W b) <= S (depth b)).
  { intros b Hb. destruct (opposite_ok b Hb) as (Ho & _). apply D; auto.
    apply within_opposite; auto. apply D; auto. }
  destruct (choice 0 (fun d u => 0 < depth d -> (exists k, u = turn W k d) /\
    S (depth (opposite W u)) = depth d) (darts W)) as [near N].
  { intros d Hd. destruct (depth d) as [|n] eqn:E; [exists 0; lia|].
    destruct (D d Hd) as [A A']. rewrite E in *. simpl in A. apply orb_true_iff in A as [A|A].
    - apply A' in A. lia.
    - apply existsb_exists in A as (b & I & A). apply in_seq in I. apply andb_true_iff in A as [A T].
      assert (Hb : b < darts W) by lia. destruct (opposite_ok b Hb) as (Ho & _ & Oo).
      apply (at_vertex_iff W WW) in T as (k & <-); auto.
      destruct (turn_back W WW k _ Ho) as (j & T). exists (opposite W b). intros _. split; [eauto|].
      rewrite Oo. assert (X := Cross b Hb). rewrite Turn in E by auto.
      destruct (D b Hb) as [_ Y]. apply Y in A. lia. }
  exists depth, (fun b => near (first_dart W b)). split.
  - assert (R := root_lt W WW). apply Nat.le_0_r, D; auto. apply (at_vertex_iff W WW); auto.
    exists 0. auto.
  - intros b Hb E. destruct (D b Hb) as [A _]. rewrite E in A. simpl in A.
    apply (at_vertex_iff W WW) in A as (k & <-); [eauto|apply root_lt; auto].
  - intros b Hb. split; [apply (Turn 1); auto|]. f_equal. symmetry. apply first_dart_eq; auto.
    + apply (sigma_lt W WW); auto.
    + apply (at_vertex_iff W WW); auto. exists 1. auto.
  - auto.
  - intros b Hb P. destruct (first_dart_at W WW b Hb) as [F A].
    apply (at_vertex_iff W WW) in A as (j & E); auto. destruct (N (first_dart W b) F) as [(k & U) X].
    + rewrite <- E, Turn; auto.
    + split; [|rewrite X, <- E, Turn; auto]. exists (k + j). rewrite U, <- E. symmetry. apply turn_add.
Qed.
End Distance.
