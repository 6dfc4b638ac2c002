(** The least cost of a proof, LB: every mapper that is right in every world makes at least LB moves
    (docs/semantics.md, section 11).

    L is a closed log, W a world that shows it, v i the reference dart of visit i, n the number of
    moves; depth and up describe a breadth-first tree; b, c are darts, q is a stalk.

    Loops.v bounds the number of moves outside of pendant trees from below. The moves inside are
    added here: each edge of a pendant tree is crossed twice, or once if the robot ends below it.
    A robot that ends in a pendant tree has also walked, outside of it, from v0 to where the tree
    is attached, and that walk is part of no loop. SCEPTICS READ [saved] and [least_cost], and in
    Distance.v, Tree.v and Pendant.v the definitions that they use. *)
From Coq Require Import Arith Lia List Bool.
Import ListNotations.
From Topo Require Import World Rotation Log Sound Parity Distance Tree Loops Pendant.

(** What the last trip saves because it need not come back: the greatest difference, over the
    vertices of pendant trees, between the height and the distance from v0 of the place where the
    tree is attached. *)
Definition saved W depth up :=
  list_max (map (fun b => height W depth up b - (depth b - height W depth up b)) (seq 0 (darts W))).

(** LB: the weights of the chords, twice the number of stalks, less what the last trip saves. *)
Definition least_cost W depth up :=
  list_sum (map (weight W depth) (chords W depth up)) + 2 * length (stalks W depth up) -
  saved W depth up.

(** The elements that satisfy f and those that do not are together all elements. *)
Lemma filter_split {X} (f : X -> bool) l :
  length (filter f l) + length (filter (fun x => negb (f x)) l) = length l.
Proof. induction l as [|x l IH]; simpl; auto. destruct (f x); simpl; lia. Qed.

(** The parity is 1 exactly if the number of elements that satisfy f is odd. *)
Lemma parity_odd {X} (f : X -> bool) l : parity f l = Nat.odd (length (filter f l)).
Proof.
  induction l as [|x l IH]; simpl; auto. rewrite IH. destruct (f x); simpl length.
  - rewrite Nat.odd_succ, <- Nat.negb_odd. destruct (Nat.odd _); auto.
  - apply xorb_false_l.
Qed.

(** One more element adds one to the count of at most one of several different keys. *)
Lemma one_key x (h : nat -> nat) keys : NoDup keys ->
  list_sum (map (fun k => (if x =? k then 1 else 0) + h k) keys) <=
  (if existsb (Nat.eqb x) keys then 1 else 0) + list_sum (map h keys).
Proof.
  induction 1 as [|k keys N _ IH]; simpl; auto. destruct (Nat.eqb_spec x k) as [->|_]; simpl.
  - destruct (existsb (Nat.eqb k) keys) eqn:E; [|lia]. apply existsb_exists in E as (y & I & E).
    apply Nat.eqb_eq in E as <-. destruct (N I).
  - simpl in IH. lia.
Qed.

(** The counts for different keys add up to at most the number of elements that have one of the
    keys. *)
Lemma count_keys {X} (g : X -> nat) keys l : NoDup keys ->
  list_sum (map (fun k => length (filter (fun x => g x =? k) l)) keys) <=
  length (filter (fun x => existsb (Nat.eqb (g x)) keys) l).
Proof.
  intros N. induction l as [|x l IH]; simpl.
  - clear N. induction keys; simpl; auto.
  - apply Nat.le_trans with ((if existsb (Nat.eqb (g x)) keys then 1 else 0) +
      list_sum (map (fun k => length (filter (fun x => g x =? k) l)) keys)).
    + rewrite <- (one_key (g x)) by auto. apply Nat.eq_le_incl. f_equal. apply map_ext.
      intros k. destruct (g x =? k); auto.
    + destruct (existsb (Nat.eqb (g x)) keys); simpl; lia.
Qed.

(** If every element has f at least 2, or at least 1 where g holds, the sum of f is at least
    twice the length, less the number of elements with g. *)
Lemma two_each {X} (f : X -> nat) (g : X -> bool) l :
  (forall x, In x l -> 2 <= f x + (if g x then 1 else 0)) ->
  2 * length l <= list_sum (map f l) + length (filter g l).
Proof.
  induction l as [|x l IH]; simpl; intros H; auto. assert (A := H x (or_introl eq_refl)).
  assert (B := IH (fun y I => H y (or_intror I))). destruct (g x); simpl in *; lia.
Qed.

Section LeastCost.
Variables (W : Map) (L : Log) (v depth up : nat -> nat).
Hypotheses (HW : world W) (V : visits W L v) (C : closed L) (B : breadth_first W depth up).
Let WW := world_is_map W HW.
Let n := length (moves L).
Let opposite_ok := opposite_ok W HW.
Notation pendant := (pendant W depth up).
Notation below := (below W depth up).
Notation height := (height W depth up).
Notation nearer := (nearer depth up).
Notation stalks := (stalks W depth up).
Notation out := (out W L v).

(** Is the edge of b in a pendant tree? *)
Definition idle b := nearer b && pendant b || nearer (opposite W b) && pendant (opposite W b).

(** The distance from v0 of the place where the pendant tree of b is attached; outside of pendant
    trees the distance of b. *)
Definition seat b := depth b - height b.

(** A tree edge changes the seat by 1, and not at all in a pendant tree. *)
Lemma seat_nearer c : c < darts W -> nearer c = true ->
  if pendant c then seat (opposite W c) = seat c
  else seat c = depth c /\ S (seat (opposite W c)) = depth c.
Proof.
  intros Hc N. destruct (nearer_ok W depth up HW B c Hc N) as (P & _ & -> & D). unfold seat.
  destruct (pendant c) eqn:E.
  - rewrite (height_pendant W depth up HW B c) by auto. lia.
  - rewrite (height_none W depth up c) by auto. rewrite height_none; [lia|].
    destruct (pendant (parent W up c)) eqn:E'; auto.
    apply (pendant_parent W depth up HW B) in E'; auto. congruence.
Qed.

(** Crossing an edge changes the seat by at most 1, and not at all in a pendant tree. *)
Lemma seat_cross b : b < darts W -> seat (opposite W b) <= (if idle b then 0 else 1) + seat b.
Proof.
  intros Hb. destruct (opposite_ok b Hb) as (Ho & _ & Oo). unfold idle.
  destruct (nearer b) eqn:N.
  - assert (S := seat_nearer b Hb N). rewrite (nearer_one W depth up HW B b Hb N).
    destruct (pendant b); simpl; lia.
  - destruct (nearer (opposite W b)) eqn:N'.
    + assert (S := seat_nearer _ Ho N'). rewrite Oo in S. destruct (pendant (opposite W b)); simpl; lia.
    + assert (T : in_tree W depth up b = false) by (unfold in_tree; rewrite N, N'; auto).
      simpl. unfold seat. rewrite !height_none.
      * assert (X := bf_alpha W depth up B b Hb). lia.
      * apply chord_pendant; auto.
      * apply chord_pendant; auto. rewrite in_tree_opposite; auto.
Qed.

(** The weights of the chords, plus the seat of the last visit, are at most the number of moves
    outside of pendant trees. *)
Lemma loops_part : list_sum (map (weight W depth) (chords W depth up)) + seat (v n) <=
  counted W L v idle (seq 0 n).
Proof.
  apply (loops_cost W L v depth up HW V C B idle seat).
  - unfold seat. rewrite (bf_root W depth up B). auto.
  - intros b Hb. unfold seat. change (sigma W b) with (turn W 1 b).
    rewrite (height_turn W depth up HW B 1 b Hb). f_equal.
    apply (depth_turn W depth up HW B 1 b Hb).
  - apply seat_cross.
  - intros b Hb T. unfold seat. rewrite height_none; [lia|]. apply chord_pendant; auto.
  - intros b Hb T. unfold in_tree in T. apply orb_false_iff in T as [N N']. unfold idle.
    rewrite N, N'. auto.
  - intros b Hb. unfold idle. destruct (opposite_ok b Hb) as (_ & _ & ->). apply orb_comm.
Qed.

(** How often the edge of a stalk is crossed. *)
Definition crossings q := length (filter (fun i => edge W (out i) =? edge W q) (seq 0 n)).

(** The robot is below a stalk exactly after an odd number of crossings of it. *)
Lemma below_parity q i : In q stalks -> i <= n ->
  below q (v i) = parity (fun i => edge W (out i) =? edge W q) (seq 0 i).
Proof.
  intros I. assert (Q := stalk_ok W depth up q I). destruct Q as (Hq & _ & _ & N).
  induction i as [|i IH]; intros Hi.
  - rewrite (v_0 W L v V). simpl. apply below_nearer. rewrite (bf_root W depth up B).
    apply nearer_ok with (1 := HW) in N; auto. lia.
  - rewrite seq_S, parity_app. simpl. rewrite xorb_false_r, <- IH by lia.
    destruct (out_ok W L v HW V (fun _ => 0) (fun _ _ => eq_refl) i Hi) as (_ & O & _ & <-).
    rewrite (below_edge W depth up HW B q (out i) I O). f_equal. unfold Loops.out.
    apply (below_turn W depth up HW B); auto. apply V.
Qed.

(** A stalk is crossed at least twice, or once if the robot ends below it. *)
Lemma stalk_twice q : In q stalks -> 2 <= crossings q + (if below q (v n) then 1 else 0).
Proof.
  intros I. assert (P := below_parity q n I (le_n n)). rewrite parity_odd in P.
  fold (crossings q) in P. assert (Q := stalk_ok W depth up q I). destruct Q as (Hq & _).
  assert (0 < crossings q).
  { destruct (closed_crossed W L v q HW V C Hq) as (i & k & D & E).
    assert (Hi : i < n).
    { unfold n. rewrite <- (map_length fst). apply nth_error_Some. unfold door in D. congruence. }
    destruct (out_ok W L v HW V (fun _ => 0) (fun _ _ => eq_refl) i Hi) as (D' & O & _ & N).
    assert (F : edge W (out i) = edge W q).
    { destruct E as [-> | ->]; [|rewrite <- N; symmetry; apply edge_opposite; auto].
      unfold Loops.out. congruence. }
    unfold crossings. assert (X : In i (filter (fun i => edge W (out i) =? edge W q) (seq 0 n))).
    { apply filter_In. split; [apply in_seq; lia|]. apply Nat.eqb_eq. auto. }
    destruct (filter _ _); [destruct X|simpl; lia]. }
  rewrite P. destruct (crossings q) as [|[|k]]; simpl; lia.
Qed.

(** The moves in pendant trees are at least twice the number of stalks, less the height of the
    last visit. *)
Lemma stalks_part :
  2 * length stalks <= length (filter (fun i => idle (out i)) (seq 0 n)) + height (v n).
Proof.
  assert (H := two_each crossings (fun q => below q (v n)) stalks stalk_twice).
  assert (A := stalks_above W depth up HW B _ (v n) (v_lt W L v V n) eq_refl).
  enough (list_sum (map crossings stalks) <= length (filter (fun i => idle (out i)) (seq 0 n))) by lia.
  assert (Eq : map crossings stalks = map (fun k => length (filter (fun i => edge W (out i) =? k)
    (seq 0 n))) (map (edge W) stalks)) by (rewrite map_map; auto). rewrite Eq.
  eapply Nat.le_trans; [apply count_keys|].
  - apply nodup_map; [apply NoDup_filter, seq_NoDup|]. intros p q Ip Iq E.
    assert (P := stalk_ok W depth up p Ip). apply (stalk_edge W depth up HW B q p Iq); auto; apply P.
  - apply NoDup_incl_length; [apply NoDup_filter, seq_NoDup|]. intros i I.
    apply filter_In in I as [I E]. apply filter_In. split; auto. apply in_seq in I.
    apply existsb_exists in E as (k & K & E). apply Nat.eqb_eq in E as <-.
    apply in_map_iff in K as (q & E & K).
    destruct (out_ok W L v HW V (fun _ => 0) (fun _ _ => eq_refl) i) as (_ & O & _);
      [unfold n in I; lia|].
    assert (Q := stalk_ok W depth up q K). destruct Q as (Hq & P & _ & N). unfold idle.
    destruct (opposite_ok q Hq) as (_ & _ & Oq). destruct (opposite_ok (out i) O) as (_ & _ & Oo).
    assert (X : out i = q \/ opposite W (out i) = q).
    { destruct (edge_or W q) as [F|F], (edge_or W (out i)) as [G|G]; rewrite F, G in E; auto.
      - right. congruence.
      - left. congruence. }
    destruct X as [-> | ->]; rewrite P, N; auto. apply orb_true_r.
Qed.

(** A closed log has at least LB moves. *)
Theorem closed_least_cost : least_cost W depth up <= length (moves L).
Proof.
  assert (A := loops_part). assert (S := stalks_part). unfold counted in A.
  assert (F := filter_split (fun i => idle (out i)) (seq 0 n)). rewrite seq_length in F.
  assert (M : height (v n) - seat (v n) <= saved W depth up).
  { unfold saved, seat. assert (X := proj1 (list_max_le _ _) (le_n (saved W depth up))).
    rewrite Forall_forall in X. apply X, in_map_iff. exists (v n). split; auto.
    apply in_seq. assert (Y := v_lt W L v V n). lia. }
  unfold least_cost. fold n. lia.
Qed.
End LeastCost.

(** Section 11: a mapper that is right in every world makes at least LB moves in each.
    Paper, I, II-B: O(m) is a trivial lower bound. *)
Theorem sound_least_cost f depth up : sound f -> forall W L M, world W -> replays W L ->
  ends f L M -> breadth_first W depth up -> least_cost W depth up <= length (moves L).
Proof.
  intros S W L M HW R E B. assert (C := sound_closed f S W L M HW R E).
  apply replays_visits in R as [v V]; [|apply HW].
  apply (closed_least_cost W L v depth up HW V C B).
Qed.
