(** The bound O(m²n) of claim 7 is reached: in a row of n vertices with m = 2 n edges, algorithm basic
    with pick policy nearest makes at least 2 n (n - 1) (n - 2) / 3 moves. That is at least m m n / 12
    from n = 6 on, and comes near m m n / 6.

    n     the vertices of the row        k, i    vertices, counted from the marker
    M     the map, p where the robot is  e       the dart being explored

    The robot goes to the end of the row first, for nearest prefers the vertex where the robot is
    ([row_picks]). Each vertex that it passes keeps two open darts. So when it has passed k vertices and
    finds a new one, it refutes 2 k hypotheses, at distances 1 to k from the marker: 2 k (k + 1) moves.
    SCEPTICS READ Row.v and [bound_reached]. *)
From Coq Require Import Arith Lia List Bool.
Import ListNotations.
From Topo Require Import World Rotation Embedding Vertices Augment Program Mapper Validation
  MapperCorrect Rules Ways ReferencePolicies Algorithms RejectionCost Row.

(** The first of the elements for which f is least. *)
Lemma least_first (f : nat -> nat) e k : (forall x, In x k -> f e <= f x) -> forall l,
  (forall x, In x l -> f e < f x) -> least f (l ++ e :: k) = Some e.
Proof.
  intros Hk l. induction l as [|d l IH]; simpl; intros Hl.
  - assert (I := least_in f k). destruct (least f k) as [b|]; auto. apply Hk in I. cases; auto.
  - rewrite IH by (intros x I; apply Hl; auto). rewrite (proj2 (Nat.ltb_lt _ _)); auto.
Qed.

(** The search keeps what was found before. *)
Lemma outward_begins M n : forall i found, begins found (outward M n i found).
Proof.
  assert (Scan : forall l far found, begins found (fold_left (fun found d => match alpha M d with
      | Some o => sprout M far found o | None => found end) l found)).
  { intros l far. induction l as [|d l IH]; intros found; cbn [fold_left]; [apply begins_refl|].
    destruct (alpha M d) as [o|]; auto. eapply begins_trans; [|apply IH]. unfold sprout. cbv zeta.
    destruct (existsb _ _); [apply begins_refl|eexists; reflexivity]. }
  induction n as [|n IH]; intros i found; simpl; [apply begins_refl|].
  destruct (nth_error found i) as [x|]; [|apply begins_refl].
  eapply begins_trans; [apply Scan|apply IH].
Qed.

(** The vertices at distance 0 are that of the root. *)
Lemma far_zero M p d : is_map M -> connected M -> p < darts M -> d < darts M ->
  far_from M (tree_from M p) d = 0 <-> lowest M d = lowest M p.
Proof.
  intros WM CM Hp Hd. destruct (tree_good M p WM Hp) as [G R].
  assert (Rd : reach M p d).
  { apply reach_trans with (root M); [|apply CM; auto].
    apply (reach_sym M (root M) p); auto. apply root_lt; auto. }
  unfold far_from. split.
  - intros Z. apply R, in_map_iff in Rd as ((v, (n, o)) & Ev & I). simpl in Ev. subst v.
    assert (B := branch_of_in M p _ _ G I). simpl in B. rewrite B in Z. simpl in Z. subst n.
    apply (t_back _ _ _ G) in I. destruct o as [o|]; [|apply I].
    destruct I as (_ & _ & y & m & c & _ & _ & S0). discriminate.
  - intros ->. unfold tree_from, branch_of. destruct (outward_begins M (darts M) 0
      [(lowest M p, (0, None))]) as [l ->]. simpl. rewrite Nat.eqb_refl. auto.
Qed.

(** Pick policy nearest picks the lowest open dart of the vertex where the robot is, if it has one. *)
Lemma nearest_here M p e : is_map M -> connected M -> p < darts M -> e < darts M ->
  alpha M e = None -> lowest M e = lowest M p ->
  (forall d, d < e -> alpha M d = None -> lowest M d <> lowest M p) -> nearest M p = Some e.
Proof.
  intros WM CM Hp He Oe Le Lower. unfold nearest, opens.
  replace (darts M) with (e + S (darts M - S e)) by lia.
  rewrite seq_app, filter_app. cbn [seq filter plus]. unfold explored at 2. rewrite Oe. simpl negb.
  cbv iota. assert (Ze := proj2 (far_zero M p e WM CM Hp He) Le). apply least_first.
  - intros x _. lia.
  - intros x I. apply filter_In in I as [I Ox]. apply in_seq in I. rewrite Ze.
    destruct (Nat.eq_dec (far_from M (tree_from M p) x) 0) as [Z|]; [|lia].
    apply far_zero in Z; auto; [|lia]. destruct (Lower x); auto; [lia|].
    unfold explored in Ox. destruct (alpha M x); [discriminate|auto].
Qed.

(** In the row, nearest goes on to the next vertex. *)
Lemma row_picks n k : k < n -> nearest (row_so_far k) (4 * k) = Some (onward_dart k).
Proof.
  intros Hk. destruct (row_so_far_embedded n k Hk) as (WM & CM & _).
  destruct (row_so_far_darts k) as (D & S4 & _), (row_so_far_open k) as (O & Full & _).
  assert (He : onward_dart k < darts (row_so_far k))
    by (rewrite D; unfold onward_dart; destruct k; lia).
  apply nearest_here; auto; [lia|..].
  - unfold onward_dart. destruct k as [|k]; auto.
    destruct (turn_four _ (S k) WM S4) as (_ & T & _); [lia|]. rewrite <- T.
    apply turn_lowest; auto. lia.
  - intros d Ld Od Eq. apply (lowest_turn _ WM) in Eq as (i & _ & Ei); [|lia..].
    assert (V := turn_same _ i d WM S4 ltac:(lia)). rewrite Ei in V.
    assert (Z := div_four k 0 ltac:(lia)). rewrite Nat.add_0_r in Z. rewrite Z in V.
    unfold onward_dart in Ld. destruct k as [|k]; [lia|]. apply (Full ltac:(lia)).
    replace (4 * S k) with d; auto. assert (B := Nat.mul_div_le d 4 ltac:(discriminate)). lia.
Qed.

(** The hypotheses of a round: two at each vertex passed, with their distances. *)
Lemma row_hypotheses k : forall i, i <= S k -> 2 * (i * (i - 1)) <=
  list_sum (map (fun h => 2 * Nat.min (in_row h / 4) (4 * S k / 4)) (filter (fun h =>
    negb (h =? onward_dart k) && negb (explored (row_so_far k) h) &&
    same_signature (percept (row_so_far k) h) (4, None)) (seq 0 (4 * i)))).
Proof.
  destruct (row_so_far_embedded (S k) k) as (WM & _); [lia|].
  destruct (row_so_far_darts k) as (D & S4 & R0), (row_so_far_open k) as (_ & _ & Open).
  set (P := fun h => negb _ && _ && _). set (f := fun h => _).
  assert (Off : forall i, 0 < i -> i <= k -> P (4 * i + 2) = true /\ P (4 * i + 3) = true /\
    f (4 * i + 2) = 2 * i /\ f (4 * i + 3) = 2 * i).
  { intros i Pi Hi. destruct (Open i Hi) as [O2 O3]. unfold P, explored. rewrite O2, O3.
    assert (Pc : forall r, r < 4 -> percept (row_so_far k) (4 * i + r) = (4, None)).
    { intros r Hr. apply percept_four; auto; [lia|]. rewrite R0, div_four by auto. simpl. lia. }
    rewrite !Pc by lia. unfold onward_dart. split; [|split; [|split]].
    - destruct k; simpl negb; cases; auto.
    - destruct k; simpl negb; cases; auto.
    - unfold f, in_row. rewrite (proj2 (Nat.ltb_ge _ 4)), div_four by lia.
      assert (Z := div_four (S k) 0 ltac:(lia)). rewrite Nat.add_0_r in Z. rewrite Z. lia.
    - unfold f, in_row. rewrite (proj2 (Nat.ltb_ge _ 4)), div_four by lia.
      assert (Z := div_four (S k) 0 ltac:(lia)). rewrite Nat.add_0_r in Z. rewrite Z. lia. }
  intros i. induction i as [|i IH]; intros Hi; [lia|]. specialize (IH ltac:(lia)).
  replace (4 * S i) with (4 * i + 4) by lia. rewrite seq_app, filter_app, map_app, list_sum_app.
  destruct i as [|i]; [lia|]. destruct (Off (S i)) as (P2 & P3 & F2 & F3); [lia..|].
  assert (Q : 4 * S i <= list_sum (map f (filter P (seq (0 + 4 * S i) 4)))); [|nia].
  cbn [seq plus]. replace (S (S (4 * S i))) with (4 * S i + 2) by lia.
  replace (S (4 * S i + 2)) with (4 * S i + 3) by lia. cbn [filter]. rewrite P2, P3.
  assert (Q : 4 * S i <= list_sum (map f [4 * S i + 2; 4 * S i + 3]))
    by (cbn [map list_sum fold_right]; lia).
  destruct (P (4 * S i)), (P (S (4 * S i))); cbn [map list_sum fold_right] in *; lia.
Qed.

(** From the state after k rounds on: what the next j rounds pay. *)
Lemma row_pays n path order : good_path path -> good_order order -> forall j k v b t fuel,
  k + S j = n -> facing (double_row n) v b (in_row (4 * k)) ->
  pays (double_row n) b (explore nearest path order retrace rule_none fuel
      (row_so_far k, 4 * k, v, tt, t))
    (list_sum (map (fun i => 2 * (S i * i)) (seq k j))).
Proof.
  intros Gp Go j. induction j as [|j IH]; intros k v b t fuel Hn Hv;
    [intros x b' ms _; simpl; lia|].
  destruct (row_so_far_embedded n k) as (WM & CM & E); [lia|].
  destruct (row_so_far_darts k) as (D & S4 & R0), (row_so_far_open k) as (O & _).
  assert (HW := row_world n ltac:(lia)). assert (WW := world_is_map _ HW).
  assert (W4 : in_fours (double_row n)) by (intros x _; auto).
  assert (Pick := row_picks n k ltac:(lia)).
  destruct fuel as [|fuel]; cbn [explore map_in dart_in]; rewrite Pick;
    [intros x b' ms P; discriminate|].
  cbn [seq map list_sum fold_right]. change (fold_right Nat.add 0) with list_sum.
  assert (Pa : percept (double_row n) (4 * S k) = (4, None)).
  { apply percept_four; auto; [cbn [darts double_row]; lia|]. cbn [root double_row].
    assert (Z := div_four (S k) 0 ltac:(lia)). rewrite Nat.add_0_r in Z. rewrite Z. discriminate. }
  eapply pays_bind.
  - apply (new_round path order (double_row n) (row_so_far k) (fun x => x / 4) in_row (4 * k) v t b
      (onward_dart k) (4 * S k)); auto.
    + intros x i y Hx. apply row_near; auto. lia.
    + intros x y Hx Hy Nx Ny. rewrite !percept_four; auto.
    + lia.
    + rewrite D. unfold onward_dart. destruct k; lia.
    + replace (in_row (onward_dart k)) with (4 * k + 1).
      * destruct (over_row_at n k) as (_ & A & _). cbn [alpha double_row]. rewrite A. f_equal. cases.
      * unfold in_row, onward_dart. destruct k as [|k]; [auto|]. cases.
    + intros h Lh. rewrite D in Lh. unfold in_row, next_of_four.
      destruct h as [|[|[|[|h]]]]; simpl; lia.
    + rewrite Pa. auto.
  - intros st b' c ((v' & t' & -> & Hv') & C). split.
    + rewrite Pa, D in C. replace (4 * k + 4) with (4 * S k) in C by lia.
      assert (Q := row_hypotheses k (S k) (le_n _)). replace (S k - 1) with k in Q by lia. lia.
    + rewrite (degree_four (double_row n)), D by (auto; cbn [darts double_row]; lia).
      replace (4 * k + 4) with (4 * S k) by lia. apply (IH (S k)); [lia|].
      unfold in_row. rewrite (proj2 (Nat.ltb_ge _ 4)) by lia. auto.
Qed.

(** Claim 7, from below: in a row of n vertices, basic with pick policy nearest, and with all policies
    else, makes at least 2 n (n - 1) (n - 2) / 3 moves.
    Not in the paper. *)
Theorem basic_row n path order : 0 < n -> good_path path -> good_order order -> exists M b ms,
  perform (double_row n) (root (double_row n)) (run_of basic nearest path order (darts (double_row n))
    (percept (double_row n) (root (double_row n)))) = Some (M, b, ms) /\
  isomorphic M (double_row n) /\ 2 * (n * (n - 1) * (n - 2)) <= 3 * length ms.
Proof.
  intros Hn Gp Go. assert (HW := row_world n Hn). assert (WW := world_is_map _ HW).
  destruct (basic_correct nearest path order (double_row n) nearest_good Gp Go HW)
    as (M & b & ms & m & P & Iso & _).
  exists M, b, ms. split; auto. split; auto.
  assert (R := root_lt _ WW). assert (W4 : in_fours (double_row n)) by (intros x _; auto).
  assert (D4 : degree (double_row n) (root (double_row n)) = 4) by (apply degree_four; auto).
  assert (L : list_sum (map (fun i => 2 * (S i * i)) (seq 0 (n - 1))) <= length ms).
  { assert (F : facing (double_row n) (percept (double_row n) (root (double_row n)), 0)
        (root (double_row n)) (in_row (4 * 0)))
      by (unfold facing; cbn [fst snd]; repeat split; auto; lia).
    assert (C := row_pays n path order Gp Go (n - 1) 0 _ _ [] (darts (double_row n)) ltac:(lia) F).
    apply (C M b ms). rewrite <- P. unfold run_of, mapper, initial_state.
    change (fst (percept (double_row n) (root (double_row n))))
      with (degree (double_row n) (root (double_row n))).
    rewrite D4. auto. }
  assert (Sum : forall j, 2 * (S j * j * (j - 1)) =
    3 * list_sum (map (fun i => 2 * (S i * i)) (seq 0 j))).
  { intros j. induction j as [|j IH]; auto. rewrite seq_S, map_app, list_sum_app, Nat.mul_add_distr_l,
      <- IH. cbn [map list_sum fold_right plus]. destruct j as [|j]; [auto|].
    replace (S (S j) - 1) with (S j) by lia. replace (S j - 1) with j by lia. nia. }
  specialize (Sum (n - 1)). replace (S (n - 1)) with n in Sum by lia.
  replace (n - 1 - 1) with (n - 2) in Sum by lia. lia.
Qed.

(** Claim 7: the bound O(m²n) is reached. For every n from 6 on there is a world of n vertices and
    m = 2 n edges in which basic, with the reference policies, makes between m m n / 12 and 4 m m n
    moves.
    Paper, I: The worst case is O(m²n) edge traversals. *)
Theorem bound_reached n : 6 <= n -> exists W m M b ms, world W /\ vertices W = n /\
  darts W = 2 * m /\ m = 2 * n /\
  perform W (root W) (run_of basic nearest way_to shortest (darts W) (percept W (root W))) =
    Some (M, b, ms) /\ isomorphic M W /\ m * m * n <= 12 * length ms <= 12 * (4 * (m * m * n)).
Proof.
  intros Hn. assert (H0 : 0 < n) by lia. assert (HW := row_world n H0).
  destruct (basic_row n way_to shortest H0 way_to_good shortest_good) as (M & b & ms & P & Iso & L).
  destruct (basic_correct nearest way_to shortest (double_row n) nearest_good way_to_good
    shortest_good HW)
    as (N & c & ns & m & P' & _ & D & U).
  rewrite P in P'. injection P' as <- <- <-. rewrite (row_vertices n H0) in U.
  exists (double_row n), m, M, b, ms. cbn [darts double_row] in D. assert (m = 2 * n) as -> by lia.
  assert (B := bound_order (2 * n) n).
  split; [auto|]. split; [apply row_vertices; auto|]. split; [cbn [darts double_row]; lia|].
  split; [auto|]. split; [auto|]. split; [auto|]. split; [|lia].
  clear - Hn L. assert (I : exists i, n = 6 + i) by (exists (n - 6); lia). destruct I as [i ->].
  replace (6 + i - 1) with (5 + i) in L by lia. replace (6 + i - 2) with (4 + i) in L by lia. nia.
Qed.
