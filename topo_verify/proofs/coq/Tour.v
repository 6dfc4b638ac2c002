(** LB is exact: in every world a walk of LB moves proves the map (docs/semantics.md, section 11).

    W is a world; depth and up describe a breadth-first tree of it; b, x are darts, each standing
    for its vertex; f is a mapper, L a log.

    The tour goes around the loops of all chords, then down to the vertex where ending saves most,
    with the stalks that this walk does not cross there and back on the way (Growing.v). Its log is
    closed (Walks.v). The loops cost their weights, a stalk 2, and the stalks on the last way 1.

    [tour] is a function: Coq computes it. SCEPTICS READ [least_cost_exact]; that some
    mapper pays LB is shown in Attained.v. *)
From Coq Require Import Arith Lia List Bool.
Import ListNotations.
From Topo Require Import World Rotation Log Determined Sound Distance Tree Pendant LeastCost
  Walks Growing.

(** How much a walk saves that ends at the vertex of b. *)
Definition gain W depth up b := height W depth up b - (depth b - height W depth up b).

(** The vertex where ending saves most; v0 if nothing is saved. *)
Definition last_vertex W depth up :=
  match find (fun b => (0 <? gain W depth up b) && (gain W depth up b =? saved W depth up))
    (seq 0 (darts W)) with Some b => b | None => root W end.

(** The tour. *)
Definition tour W depth up := grow_walk W depth up (length (stalks W depth up))
  (loops W depth up (last_vertex W depth up)).

Section Tour.
Variables (W : Map) (depth up : nat -> nat).
Hypotheses (HW : world W) (B : breadth_first W depth up).
Let WW := world_is_map W HW.
Let parent_ok := parent_ok W depth up HW B.
Notation way_down := (way_down W up).
Notation way_home := (way_home W up).
Notation climb := (climb W up).
Notation parent := (parent W up).
Notation height := (height W depth up).
Notation stalks := (stalks W depth up).
Notation uncrossed := (uncrossed W depth up).
Notation crosses := (crosses W).

(** The ways to and from b are as long as b is deep. *)
Lemma way_length n : forall b, length (way_down n b) = n /\ length (way_home n b) = n.
Proof.
  induction n as [|n IH]; simpl; auto. intros b. destruct (IH (parent b)) as [X Y].
  rewrite app_length, X, Y. simpl. lia.
Qed.

(** The loops cost the weights of the chords, and the way to x its depth. *)
Lemma loops_length x :
  length (loops W depth up x) = list_sum (map (weight W depth) (chords W depth up)) + depth x.
Proof.
  unfold loops. rewrite app_length. f_equal; [|apply way_length].
  induction (chords W depth up) as [|c l IH]; simpl; auto. rewrite app_length, IH. f_equal.
  unfold loop, weight. rewrite app_length. simpl.
  destruct (way_length (depth c) c) as [-> _].
  destruct (way_length (depth (opposite W c)) (opposite W c)) as [_ ->].
  lia.
Qed.

(** The ancestors of b are darts, each one step nearer to v0 than the one before. *)
Lemma climb_ok b j : b < darts W -> j <= depth b ->
  climb j b < darts W /\ depth (climb j b) = depth b - j.
Proof.
  intros Hb. induction j as [|j IH]; intros L; [simpl; split; auto; lia|].
  destruct IH as [H D]; [lia|]. rewrite (climb_S W up).
  destruct (parent_ok (climb j b) H) as (_ & Hp & Dp & _); [lia|]. split; auto. lia.
Qed.

(** The height is at most the depth, and so many ancestors are in pendant trees. *)
Lemma hanging_pendant n : forall b, hanging W depth up n b <= n /\
  forall j, j < hanging W depth up n b -> pendant W depth up (climb j b) = true.
Proof.
  induction n as [|n IH]; intros b; simpl; [split; auto; lia|].
  destruct (pendant W depth up b) eqn:P; [|split; [lia|intros; lia]].
  destruct (IH (parent b)) as [L H]. split; [lia|]. intros [|j] Hj; simpl; auto. apply H. lia.
Qed.

(** The loops with a way to x leave as many stalks uncrossed as there are, less the height of x. *)
Lemma loops_uncrossed x : x < darts W ->
  length (uncrossed (loops W depth up x)) + height x <= length stalks.
Proof.
  intros Hx. set (ds := loops W depth up x).
  assert (F := filter_split (crosses ds) stalks). unfold crosses in F at 2. fold (uncrossed ds) in F.
  enough (height x <= length (filter (crosses ds) stalks))
    by (unfold Growing.uncrossed, crosses in *; lia).
  destruct (hanging_pendant (depth x) x) as [L Pd]. fold (height x) in L, Pd.
  rewrite <- (seq_length (height x) 0), <- (map_length (fun j => up (climb j x))).
  assert (Anc : forall j, j < height x -> climb j x < darts W /\ depth (climb j x) = depth x - j /\
    up (climb j x) < darts W /\ depth (up (climb j x)) = depth x - j /\
    up (up (climb j x)) = up (climb j x) /\ pendant W depth up (up (climb j x)) = true).
  { intros j Hj. destruct (climb_ok x j Hx) as [H D]; [lia|].
    destruct (parent_ok (climb j x) H) as (Hu & _ & _ & Du & Uu); [lia|].
    repeat split; auto; [lia|].
    destruct (up_ok W depth up HW B (climb j x) H) as (_ & (k & E) & _); [lia|].
    rewrite E, (pendant_turn W depth up HW B); auto. }
  apply NoDup_incl_length.
  - apply nodup_map; [apply seq_NoDup|]. intros i j I J E. apply in_seq in I, J.
    destruct (Anc i) as (_ & _ & _ & Di & _); [lia|]. destruct (Anc j) as (_ & _ & _ & Dj & _); [lia|].
    rewrite E in Di. lia.
  - intros q I. apply in_map_iff in I as (j & <- & I). apply in_seq in I.
    destruct (Anc j) as (H & D & Hu & Du & Uu & Pu); [lia|]. apply filter_In. split.
    + apply filter_In. split; [apply in_seq; lia|]. rewrite Pu, Uu. apply Nat.eqb_refl.
    + apply existsb_exists. exists (opposite W (up (climb j x))). split.
      * apply in_or_app. right. apply (on_ways W up). lia.
      * rewrite (edge_opposite W HW) by auto. apply Nat.eqb_refl.
Qed.

(** What is saved is 0, or the gain of some vertex. *)
Lemma saved_attained : 0 < saved W depth up ->
  exists b, b < darts W /\ gain W depth up b = saved W depth up.
Proof.
  unfold saved. assert (H : forall b, In b (seq 0 (darts W)) -> b < darts W).
  { intros b I. apply in_seq in I. lia. }
  fold (gain W depth up). induction (seq 0 (darts W)) as [|b l IH]; simpl; [lia|]. intros P.
  change (height b - (depth b - height b)) with (gain W depth up b) in *.
  destruct (Nat.max_dec (gain W depth up b) (list_max (map (gain W depth up) l))) as [E|E].
  - exists b. split; [apply H; simpl; auto|]. unfold gain in *. lia.
  - destruct IH as (c & Hc & Ec); [intros; apply H; simpl; auto|unfold gain in *; lia|].
    exists c. split; auto. unfold gain in *. lia.
Qed.

(** The tour is a walk that homes, crosses every edge, and makes at most LB moves. *)
Lemma tour_ok : path W (root W) (tour W depth up) /\ homing W depth up false (tour W depth up) = true /\
  (forall b, b < darts W -> exists d, In d (tour W depth up) /\ edge W d = edge W b) /\
  length (tour W depth up) <= least_cost W depth up.
Proof.
  assert (R := root_lt W WW). set (x := last_vertex W depth up).
  assert (X : x < darts W /\ depth x + saved W depth up <= 2 * height x).
  { unfold x, last_vertex. destruct (find _ _) as [b|] eqn:F.
    - apply find_some in F as [I E]. apply in_seq in I. apply andb_true_iff in E as [P E].
      apply Nat.ltb_lt in P. apply Nat.eqb_eq in E. split; [lia|]. unfold gain in *. lia.
    - split; auto. rewrite (bf_root W depth up B). destruct (Nat.eq_dec (saved W depth up) 0); [lia|].
      destruct saved_attained as (b & Hb & E); [lia|].
      assert (N := find_none _ _ F b). cbv beta in N. rewrite E, Nat.eqb_refl in N.
      rewrite (proj2 (Nat.ltb_lt _ _)) in N by lia. discriminate N. apply in_seq. lia. }
  destruct X as [Hx S]. assert (U := loops_uncrossed x Hx).
  destruct (loops_ok W depth up HW B x Hx) as [P H].
  destruct (grow_ok W depth up HW B (length stalks) _ P H ltac:(lia) (tour W depth up) eq_refl)
    as (P' & H' & Le & Sub & Stop).
  repeat split; auto; [apply (all_crossed W depth up HW B x); auto|].
  rewrite loops_length in Le. unfold least_cost. lia.
Qed.
End Tour.

(** The log of the tour. *)
Definition tour_log W depth up := walk_log W (tour W depth up).

(** Section 11: in every world the tour proves the map in LB moves.
    Not in the paper. *)
Theorem tour_exact W depth up : world W -> breadth_first W depth up ->
  replays W (tour_log W depth up) /\ closed (tour_log W depth up) /\
  length (moves (tour_log W depth up)) = least_cost W depth up.
Proof.
  intros HW B. destruct (tour_ok W depth up HW B) as (P & H & Every & Le).
  assert (R := walk_replays W HW _ P). assert (C := walk_closed W depth up _ HW B P H Every).
  split; auto. split; auto. apply Nat.le_antisymm.
  - simpl. rewrite trail_length. auto.
  - destruct (replays_visits W _ (world_is_map W HW) R) as [v V].
    apply (closed_least_cost W _ v depth up HW V C B).
Qed.

(** LB is the least number of moves of a log that proves the map; so it does not depend on the tree.
    Paper, I, II-B: O(m) is a trivial lower bound. *)
Theorem least_cost_exact W : world W -> exists lb, (forall depth up, breadth_first W depth up ->
    least_cost W depth up = lb) /\
  (exists L, replays W L /\ closed L /\ length (moves L) = lb) /\
  forall L, replays W L -> closed L -> lb <= length (moves L).
Proof.
  intros HW. destruct (breadth_first_exists W HW) as (depth & up & B).
  assert (Least : forall depth up L, breadth_first W depth up -> replays W L -> closed L ->
    least_cost W depth up <= length (moves L)).
  { intros dp u L B' R C. destruct (replays_visits W L (world_is_map W HW) R) as [v V].
    apply (closed_least_cost W L v dp u HW V C B'). }
  destruct (tour_exact W depth up HW B) as (R & C & E). exists (least_cost W depth up).
  split; [|split; eauto]. intros dp u B'. destruct (tour_exact W dp u HW B') as (R' & C' & E').
  apply Nat.le_antisymm; [rewrite <- E|rewrite <- E']; auto.
Qed.
