(** What the loops of a world cost every mapper (docs/semantics.md, section 11: the least cost of a
    proof).

    L is a closed log, W a world that shows it, v i the reference dart of visit i, n the number of
    moves; depth and up describe a breadth-first tree; d(u) is the distance of vertex u from v0. A
    trip is the moves from one visit that saw the marker to the next.

    The trips of a closed log generate all closed ways of the world. Modulo 2 this says: a cochain
    (a parity on every edge) that vanishes on each trip is the difference of a parity on the
    vertices; if it also vanishes on a spanning tree, it is 0.

    A trip of t moves crosses only edges uv with d(u) + 1 + d(v) <= t. So for every t there are at
    least as many trips longer than t as chords with d(u) + 1 + d(v) > t: otherwise there were fewer
    equations than unknowns, and a nonzero cochain would vanish on all trips and on the tree.

    Hence the sum of d(u) + 1 + d(v) over the chords is at most the number of moves. The section
    variables [idle] and [seat] make this hold for the moves that are not idle alone: LeastCost.v
    lets the edges of pendant trees be idle. *)
From Coq Require Import Arith Lia List Bool.
Import ListNotations.
From Topo Require Import World Rotation Vertices Log Determined Sound Parity
  Distance Tree.

Section Loops.
Variables (W : Map) (L : Log) (v depth up : nat -> nat).
Hypotheses (HW : world W) (V : visits W L v) (C : closed L) (B : breadth_first W depth up).

(** idle: tree edges whose crossings do not count. seat: for every vertex, a bound from below on how
    many edges that are not idle lead to it from v0; at the ends of a chord it is the depth. *)
Variables (idle : nat -> bool) (seat : nat -> nat).
Hypothesis Seat_root : seat (root W) = 0.
Hypothesis Seat_sigma : forall b, b < darts W -> seat (sigma W b) = seat b.
Hypothesis Seat_cross : forall b, b < darts W ->
  seat (opposite W b) <= (if idle b then 0 else 1) + seat b.
Hypothesis Seat_chord : forall b, b < darts W -> in_tree W depth up b = false -> seat b = depth b.
Hypothesis Chord_counts : forall b, b < darts W -> in_tree W depth up b = false -> idle b = false.
Hypothesis Idle : forall b, b < darts W -> idle (opposite W b) = idle b.
Let WW := world_is_map W HW.
Let n := length (moves L).
Let v_lt := v_lt W L v V.
Let opposite_alpha := opposite_alpha W HW.
Let opposite_ok := opposite_ok W HW.
Let depth_turn := depth_turn W depth up HW B.
Let edge_opposite := edge_opposite W HW.
Let edge_or := edge_or W.
Let weight_opposite := weight_opposite W depth HW.
Let in_tree_opposite := in_tree_opposite W depth up HW.
Notation edge := (edge W).

(** All darts of a vertex have the same seat. *)
Lemma seat_turn k b : b < darts W -> seat (turn W k b) = seat b.
Proof.
  intros Hb. induction k as [|k IH]; simpl; auto. rewrite <- IH. apply Seat_sigma, turn_lt; auto.
Qed.

(* ---------------------------------------------------------------- moves and trips *)

(** The dart by which move i leaves. *)
Definition out i := turn W (nth i (map fst (moves L)) 0) (v i).

(** It is a dart with the seat of visit i, and its opposite is the reference dart of visit i + 1. *)
Lemma out_ok i : i < n -> door L i = Some (nth i (map fst (moves L)) 0) /\ out i < darts W /\
  seat (out i) = seat (v i) /\ opposite W (out i) = v (S i).
Proof.
  intros Hi. assert (D : door L i = Some (nth i (map fst (moves L)) 0)).
  { unfold door. apply nth_error_nth'. rewrite map_length. auto. }
  split; auto. split; [apply turn_lt; auto|]. split; [apply seat_turn; auto|].
  apply (v_door W L v V) in D. unfold move in D. destruct (_ <? _); [|discriminate].
  unfold opposite, out. rewrite D. auto.
Qed.

(** Does visit i see the marker? *)
Definition marked i := match marker W (v i) with Some _ => true | None => false end.

(** The seat of a visit that sees the marker is 0. *)
Lemma marked_seat i : marked i = true -> seat (v i) = 0.
Proof.
  unfold marked. destruct (marker W (v i)) as [j|] eqn:E; [|discriminate]. intros _.
  apply marker_some in E. rewrite <- (seat_turn j (v i)), E; auto.
Qed.

(** The first visit sees the marker. *)
Lemma marked_start : marked 0 = true.
Proof.
  unfold marked. rewrite (v_0 W L v V).
  destruct (degree_spec W WW (root W)) as (D & _); [apply root_lt; auto|].
  destruct (marker_of W (root W) 0 D eq_refl) as [j ->]. auto.
Qed.

(** The last visit up to i that saw the marker. *)
Fixpoint last_sight i := match i with 0 => 0 | S j => if marked (S j) then S j else last_sight j end.

(** The trips up to visit i, each as its first and last visit. *)
Fixpoint trips i := match i with
  | 0 => []
  | S j => if marked (S j) then (last_sight j, S j) :: trips j else trips j end.

(** The moves of a trip. *)
Definition taken (t : nat * nat) := seq (fst t) (snd t - fst t).

(** How many of the moves l are not idle. *)
Definition counted l := length (filter (fun i => negb (idle (out i))) l).

(** Counting is additive over concatenation. *)
Lemma counted_app l m : counted (l ++ m) = counted l + counted m.
Proof. unfold counted. rewrite filter_app, app_length. auto. Qed.

(** The last sight is a visit up to i that saw the marker. *)
Lemma last_sight_ok i : last_sight i <= i /\ marked (last_sight i) = true.
Proof.
  induction i as [|i [IH IH']]; simpl; [split; [lia|apply marked_start]|].
  destruct (marked (S i)) eqn:M; split; auto.
Qed.

(** The moves of the trips up to i are the moves up to the last sight; those that are not idle
    are counted once. *)
Lemma trips_total i : list_sum (map (fun t => counted (taken t)) (trips i)) =
  counted (seq 0 (last_sight i)).
Proof.
  induction i as [|i IH]; simpl; auto. destruct (marked (S i)); auto. simpl map. simpl list_sum.
  rewrite IH. destruct (last_sight_ok i) as [Le _]. unfold taken. cbn [fst snd].
  replace (S i) with (last_sight i + (S i - last_sight i)) at 2 by lia. rewrite seq_app, counted_app.
  rewrite Nat.add_0_l. lia.
Qed.

(** A trip begins and ends at visits that saw the marker, and has a move. *)
Lemma trips_ok i t : In t (trips i) ->
  marked (fst t) = true /\ marked (snd t) = true /\ fst t < snd t <= i.
Proof.
  induction i as [|i IH]; simpl; [intros []|]. intros I. destruct (last_sight_ok i).
  destruct (marked (S i)) eqn:M; [destruct I as [<-|I]; [cbn [fst snd]; repeat split; auto; lia|]|].
  all: destruct (IH I) as (X & Y & Z); repeat split; auto; lia.
Qed.

(** Along k moves the seat changes by at most the number of those that are not idle, in either
    direction. *)
Lemma seat_along a k : a + k <= n ->
  seat (v (a + k)) <= seat (v a) + counted (seq a k) /\
  seat (v a) <= seat (v (a + k)) + counted (seq a k).
Proof.
  induction k as [|k IH]; intros H; [rewrite Nat.add_0_r; lia|].
  destruct IH as [I J]; [lia|]. rewrite Nat.add_succ_r, seq_S, counted_app.
  destruct (out_ok (a + k)) as (_ & O & D & E); [lia|].
  assert (F := Seat_cross _ O). assert (G := Idle _ O). rewrite E in F, G.
  destruct (opposite_ok _ O) as (P & _ & Q). rewrite E in P, Q.
  assert (K := Seat_cross _ P). rewrite Q, G in K. rewrite D in *.
  unfold counted at 2 4. simpl. destruct (idle (out (a + k))); simpl in *; lia.
Qed.

(** If a trip crosses a chord, at least as many of its moves as the weight of the chord are not
    idle. *)
Lemma trip_weight t i : In t (trips n) -> In i (taken t) -> in_tree W depth up (out i) = false ->
  idle (out i) = false -> weight W depth (out i) <= counted (taken t).
Proof.
  intros T I N K. apply trips_ok in T as (A & Z & Hn). apply in_seq in I.
  destruct (out_ok i) as (_ & O & D & E); [lia|]. unfold weight.
  rewrite <- (Seat_chord _ O N), <- (Seat_chord (opposite W (out i))), D, E.
  2: { apply opposite_ok; auto. }
  2: { rewrite in_tree_opposite; auto. }
  apply marked_seat in A, Z. destruct (seat_along (fst t) (i - fst t)) as [F _]; [lia|].
  destruct (seat_along (S i) (snd t - S i)) as [_ G]; [lia|].
  replace (fst t + (i - fst t)) with i in F by lia.
  replace (S i + (snd t - S i)) with (snd t) in G by lia.
  unfold taken. replace (snd t - fst t) with ((i - fst t) + (1 + (snd t - S i))) by lia.
  rewrite seq_app, counted_app. replace (fst t + (i - fst t)) with i by lia.
  rewrite seq_app, counted_app. replace (i + 1) with (S i) by lia.
  unfold counted at 2. simpl filter. rewrite K. simpl. lia.
Qed.

(* ---------------------------------------------------------------- cochains that vanish on trips *)

Section Cochain.
Variable c : nat -> bool.
Hypothesis Sym : forall b, b < darts W -> c (opposite W b) = c b.
Hypothesis Vanishes : forall t, In t (trips n) -> parity (fun i => c (out i)) (taken t) = false.
Hypothesis Tree : forall b, b < darts W -> in_tree W depth up b = true -> c b = false.

(** The label of visit i: the sum of the cochain c over the moves before it. *)
Definition label i := parity (fun i => c (out i)) (seq 0 i).

(** The label of every visit that saw the marker is 0. *)
Lemma label_marked i : i <= n -> marked i = true -> label i = false.
Proof.
  enough (H : forall i, i <= n -> label (last_sight i) = false).
  { intros Hi M. specialize (H i Hi). destruct i; [auto|]. simpl in H. rewrite M in H. auto. }
  clear i. intros i. induction i as [|i IH]; intros Hi; [auto|]. simpl.
  destruct (marked (S i)) eqn:M; [|apply IH; lia].
  assert (T : In (last_sight i, S i) (trips n)).
  { clear - Hi M. generalize dependent n. intros m Hi. induction Hi as [|m Hi IH]; simpl.
    - rewrite M. left; auto.
    - destruct (marked (S m)); [right|]; auto. }
  apply Vanishes in T. unfold taken in T. cbn [fst snd] in T.
  destruct (last_sight_ok i) as [Le _]. specialize (IH ltac:(lia)). unfold label in *.
  replace (S i) with (last_sight i + (S i - last_sight i)) at 1 by lia.
  rewrite seq_app, parity_app, IH, xorb_false_l. exact T.
Qed.

(** The labels of linked places differ by the value of c on their edge. *)
Lemma label_link p q : link nothing L p q -> label (fst q) = xorb (label (fst p)) (c (dart W v p)).
Proof.
  assert (H : forall i k, door L i = Some k -> i < n /\ turn W k (v i) = out i).
  { intros i k D. assert (Hi : i < n).
    { unfold n. rewrite <- (map_length fst). apply nth_error_Some. unfold door in D. congruence. }
    split; auto. destruct (out_ok i Hi) as [E _]. unfold out. congruence. }
  assert (Step : forall i, label (S i) = xorb (label i) (c (out i))).
  { intros i. unfold label. rewrite seq_S, parity_app. simpl. rewrite xorb_false_r. auto. }
  intros [i k D|i k D|x y []|x y []]; destruct (H i k D) as [Hi E]; unfold dart; simpl.
  - rewrite E. apply Step.
  - destruct (out_ok i Hi) as (_ & O & _ & <-). rewrite Sym, Step by auto.
    destruct (label i), (c (out i)); auto.
Qed.

(** Identified places have the same label. *)
Lemma label_same p q : same nothing L p q -> label (fst p) = label (fst q).
Proof.
  induction 1 as [p|p q _ IH|p q r _ IH _ IH'|k i a j b _ IH|i d m E|i d j E
                 |p q p' q' K K' S IH]; simpl in *; try congruence.
  - apply label_marked.
    + unfold seen in E. unfold n. rewrite <- (map_length snd).
      assert (X : i < length (start L :: map snd (moves L))) by (apply nth_error_Some; congruence).
      simpl in X. lia.
    + apply (v_seen W L v V) in E. injection E as _ E. unfold marked. rewrite E. auto.
  - apply label_link in K, K'. apply (same_sound W L v nothing HW V (fits_nothing W v)) in S.
    congruence.
Qed.

(** x is the label of a visit at whose vertex b is a dart. *)
Definition potential b x := exists p, valid L p /\ dart W v p = b /\ label (fst p) = x.

(** A dart has at most one label. *)
Lemma potential_one b x y : potential b x -> potential b y -> x = y.
Proof.
  intros (p & P & E & <-) (q & Q & F & <-). apply label_same.
  apply (same_complete W L v HW V C p q); auto. congruence.
Qed.

(** All darts of a vertex have the same label. *)
Lemma potential_turn k b x : potential b x -> potential (turn W k b) x.
Proof.
  intros ((i, j) & P & <- & E). exists (i, k + j). repeat split; auto.
  unfold dart. simpl. apply turn_add.
Qed.

(** The labels of the two ends of an edge differ by the value of c on it. *)
Lemma potential_opposite b x : b < darts W -> potential b x -> potential (opposite W b) (xorb x (c b)).
Proof.
  intros Hb (p & P & <- & <-). destruct (C p P) as (q & r & K & S). exists r.
  split; [eapply link_valid, link_sym; eauto|]. assert (F := fits_nothing W v).
  assert (E := same_sound W L v nothing HW V F p q S). rewrite E in *. split.
  - apply (link_sound W L v nothing HW V F) in K. rewrite opposite_alpha in K by auto. congruence.
  - apply label_same in S. rewrite S. apply label_link. auto.
Qed.

(** By induction on the depth: the label of every vertex is 0, since c vanishes on the tree. *)
Lemma potential_false d : forall b, b < darts W -> depth b = d -> potential b false.
Proof.
  assert (R : potential (root W) false).
  { exists (0, 0). repeat split; [discriminate|apply (v_0 W L v V)]. }
  induction d as [|d IH]; intros b Hb D.
  - destruct (bf_home W depth up B b Hb D) as (k & ->). apply potential_turn. auto.
  - destruct (bf_up W depth up B b Hb) as [(k & U) E]; [lia|].
    assert (Hu : up b < darts W) by (rewrite U; apply turn_lt; auto).
    destruct (opposite_ok (up b) Hu) as (Ho & _ & Oo).
    assert (P : potential (up b) false).
    { rewrite <- Oo. assert (Z : c (opposite W (up b)) = false).
      { rewrite Sym; auto. apply Tree; auto. unfold in_tree, nearer.
        destruct (depth_turn k b Hb) as [X Y].
        rewrite <- U in X, Y. rewrite X, Y, Nat.eqb_refl, D. auto. }
      rewrite <- (xorb_false_l (c _)) in Z. rewrite <- Z. apply potential_opposite; auto.
      apply IH; auto. lia. }
    destruct (turn_back W WW k b Hb) as (j & T). rewrite <- U in T. rewrite <- T.
    apply potential_turn. auto.
Qed.

(** A cochain that vanishes on every trip and on the tree vanishes on all edges. *)
Lemma cochain_zero b : b < darts W -> c b = false.
Proof.
  intros Hb. destruct (opposite_ok b Hb) as (Ho & _).
  apply (potential_one (opposite W b)).
  - rewrite <- (xorb_false_l (c b)). apply potential_opposite; auto.
    apply (potential_false (depth b)); auto.
  - apply (potential_false (depth (opposite W b))); auto.
Qed.
End Cochain.

(* ---------------------------------------------------------------- the bound *)

(** How many values of f are greater than t. *)
Lemma above_map {X} (f : X -> nat) t l : above t (map f l) = length (filter (fun x => t <? f x) l).
Proof. unfold above. induction l as [|x l IH]; simpl; auto. destruct (t <? f x); simpl; auto. Qed.

(** For every t, at least as many trips have more than t moves that are not idle as chords have a
    weight greater than t. *)
Lemma trips_above t : above t (map (weight W depth) (chords W depth up)) <=
  above t (map (fun t => counted (taken t)) (trips n)).
Proof.
  rewrite !above_map. set (vars := filter _ (chords _ _ _)). set (long := filter _ (trips n)).
  destruct (le_lt_dec (length vars) (length long)) as [|Few]; auto. exfalso.
  set (row := fun tr e => parity (fun i => e =? edge (out i)) (taken tr)).
  destruct (solution (length long) (map row long) vars) as (z & (a & Ia & Za) & Su & Eq); auto.
  { rewrite map_length. auto. }
  { apply NoDup_filter, NoDup_filter, seq_NoDup. }
  assert (Chord : forall e, In e vars -> e < darts W /\ in_tree W depth up e = false /\
    e < opposite W e /\ t < weight W depth e).
  { intros e I. apply filter_In in I as [I Ht]. apply filter_In in I as [I J]. apply in_seq in I.
    apply andb_true_iff in J as [J K]. apply negb_true_iff in J. apply Nat.ltb_lt in Ht, K.
    repeat split; auto. lia. }
  assert (Same : forall b, b < darts W -> z (edge b) = true ->
    in_tree W depth up b = false /\ t < weight W depth b).
  { intros b Hb Z. destruct (Chord _ (Su _ Z)) as (_ & T & _ & Ht).
    destruct (edge_or b) as [E|E]; rewrite E in *; auto.
    rewrite in_tree_opposite in T by auto. rewrite weight_opposite in Ht by auto. auto. }
  destruct (Chord a Ia) as (Ha & _ & Lo & _).
  assert (Z : z (edge a) = false); [|unfold edge in Z; rewrite Nat.min_l in Z by lia; congruence].
  apply (cochain_zero (fun b => z (edge b))); auto.
  - intros tr T. destruct (t <? counted (taken tr)) eqn:Lt.
    + rewrite (parity_ext _ (fun i => parity (fun e => z e && (e =? edge (out i))) vars)).
      * rewrite parity_swap. rewrite <- (Eq (row tr)).
        -- apply parity_ext. intros e _. apply parity_and.
        -- apply in_map, filter_In. auto.
      * intros i I. symmetry. apply parity_pick; [|apply Su].
        apply NoDup_filter, NoDup_filter, seq_NoDup.
    + apply parity_none. intros i I. destruct (z (edge (out i))) eqn:Zi; auto.
      assert (T' := T). apply trips_ok in T' as (_ & _ & T'). assert (I' := I). apply in_seq in I'.
      destruct (out_ok i) as (_ & O & _); [lia|]. destruct (Same _ O Zi) as [N X].
      assert (Y := trip_weight tr i T I N (Chord_counts _ O N)). apply Nat.ltb_ge in Lt. lia.
  - intros b Hb T. destruct (z (edge b)) eqn:Zb; auto. destruct (Same b Hb Zb). congruence.
Qed.

(** The weights of the chords, plus the seat of the last visit, are at most the number of moves
    that are not idle. The last moves, after the last sight of the marker, lead from v0 to that
    seat. *)
Theorem loops_cost :
  list_sum (map (weight W depth) (chords W depth up)) + seat (v n) <= counted (seq 0 n).
Proof.
  destruct (last_sight_ok n) as [Le M]. apply marked_seat in M.
  destruct (seat_along (last_sight n) (n - last_sight n)) as [F _]; [lia|].
  replace (last_sight n + (n - last_sight n)) with n in F by lia.
  assert (H := sum_by_level _ _ trips_above). rewrite trips_total in H.
  replace n with (last_sight n + (n - last_sight n)) at 2 by lia.
  rewrite seq_app, counted_app, Nat.add_0_l. lia.
Qed.
End Loops.
