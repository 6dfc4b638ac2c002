(** Rows: worlds in which basic needs moves of the order of its bound (BoundReached.v; claim 7), and the
    maps that a robot has of them when it goes straight on.

    n     the vertices of the row        k, i    vertices, counted from the marker
    x     a dart                         M       a map; in_row: its correspondence with the row

    Vertex i has the darts 4i, 4i + 1, 4i + 2 and 4i + 3. Two edges join it with the next vertex.
    SCEPTICS READ [next_of_four], [over_row] and [double_row]. *)
From Coq Require Import Arith Lia List Bool.
Import ListNotations.
From Topo Require Import World Rotation Embedding Vertices Augment.

(** The next dart clockwise, where vertex i has the darts 4i, 4i + 1, 4i + 2 and 4i + 3. *)
Definition next_of_four x := if x mod 4 =? 3 then x - 3 else S x.

(** The other dart of an edge in a row of n vertices: darts 4i + 1 and 4i + 3 lead to 4i + 4 and 4i + 6
    of the next vertex; at both ends two darts of the vertex are a loop. *)
Definition over_row n x := match x mod 4 with
  | 0 => if x =? 0 then 2 else x - 3
  | 1 => if S x =? 4 * n - 2 then x + 2 else x + 3
  | 2 => if x =? 2 then 0 else x - 3
  | _ => if S x =? 4 * n then x - 2 else x + 3
  end.

(** A row of n vertices, each joined with the next one by two edges. The marker is at vertex 0. *)
Definition double_row n :=
  {| darts := 4 * n; sigma := next_of_four; alpha := fun x => Some (over_row n x); root := 1 |}.

(** Every number is a dart of some vertex. *)
Lemma four_darts x : exists i, x = 4 * i \/ x = 4 * i + 1 \/ x = 4 * i + 2 \/ x = 4 * i + 3.
Proof.
  exists (x / 4). assert (D := Nat.div_mod x 4 ltac:(discriminate)).
  assert (B := Nat.mod_upper_bound x 4 ltac:(discriminate)). lia.
Qed.

(** Remainders of the darts of a vertex. *)
Lemma mod_four i r : r < 4 -> (4 * i + r) mod 4 = r.
Proof. intros Hr. rewrite Nat.add_comm, Nat.mul_comm, Nat.mod_add, Nat.mod_small; auto. Qed.

(** The vertex of a dart. *)
Lemma div_four i r : r < 4 -> (4 * i + r) / 4 = i.
Proof.
  intros Hr. rewrite Nat.add_comm, Nat.mul_comm, Nat.div_add, Nat.div_small; auto.
Qed.

(** The vertex of a dart is unchanged by turning. *)
Lemma next_of_four_at i : next_of_four (4 * i) = 4 * i + 1 /\ next_of_four (4 * i + 1) = 4 * i + 2 /\
  next_of_four (4 * i + 2) = 4 * i + 3 /\ next_of_four (4 * i + 3) = 4 * i.
Proof.
  assert (Z := mod_four i 0 ltac:(lia)). rewrite Nat.add_0_r in Z. unfold next_of_four.
  rewrite Z, !mod_four by lia. simpl Nat.eqb. cbv iota. lia.
Qed.

(** The other darts of the darts of a vertex. *)
Lemma over_row_at n i : over_row n (4 * i) = (if i =? 0 then 2 else 4 * i - 3) /\
  over_row n (4 * i + 1) = (if S i =? n then 4 * i + 3 else 4 * i + 4) /\
  over_row n (4 * i + 2) = (if i =? 0 then 0 else 4 * i - 1) /\
  over_row n (4 * i + 3) = (if S i =? n then 4 * i + 1 else 4 * i + 6).
Proof.
  assert (Z := mod_four i 0 ltac:(lia)). rewrite Nat.add_0_r in Z. unfold over_row.
  rewrite Z, !mod_four by lia. repeat split; cases.
Qed.

(** A tactic: the dart x is one of those of vertex i. *)
Ltac by_vertices x i S0 S1 S2 S3 := let Ex := fresh in
  destruct (four_darts x) as [i Ex]; destruct (next_of_four_at i) as (S0 & S1 & S2 & S3);
  destruct Ex as [Ex|[Ex|[Ex|Ex]]]; subst x.

(** The other dart of the other dart is the dart. *)
Lemma over_row_back n x : x < 4 * n ->
  over_row n x < 4 * n /\ over_row n x <> x /\ over_row n (over_row n x) = x.
Proof.
  intros Hx. by_vertices x i S0 S1 S2 S3; destruct (over_row_at n i) as (A0 & A1 & A2 & A3).
  - rewrite A0. destruct (Nat.eqb_spec i 0) as [->|N].
    + destruct (over_row_at n 0) as (_ & _ & B & _). simpl in B. rewrite B. lia.
    + destruct (over_row_at n (i - 1)) as (_ & B & _). replace (4 * i - 3) with (4 * (i - 1) + 1) by lia.
      rewrite B. cases.
  - rewrite A1. destruct (Nat.eqb_spec (S i) n) as [Eq|N].
    + rewrite A3. cases.
    + destruct (over_row_at n (S i)) as (B & _). replace (4 * i + 4) with (4 * S i) by lia.
      rewrite B. cases.
  - rewrite A2. destruct (Nat.eqb_spec i 0) as [->|N].
    + destruct (over_row_at n 0) as (B & _). simpl in B. rewrite B. lia.
    + destruct (over_row_at n (i - 1)) as (_ & _ & _ & B).
      replace (4 * i - 1) with (4 * (i - 1) + 3) by lia. rewrite B. cases.
  - rewrite A3. destruct (Nat.eqb_spec (S i) n) as [Eq|N].
    + rewrite A1. cases.
    + destruct (over_row_at n (S i)) as (_ & _ & B & _). replace (4 * i + 6) with (4 * S i + 2) by lia.
      rewrite B. cases.
Qed.

(** The row is a map. *)
Lemma is_map_row n : 0 < n -> is_map (double_row n).
Proof.
  intros Hn. split; simpl darts; simpl sigma; simpl alpha; simpl root; [..|lia].
  - intros x Hx. by_vertices x i S0 S1 S2 S3; lia.
  - intros x y Hx Hy Exy. by_vertices x i S0 S1 S2 S3; by_vertices y j T0 T1 T2 T3; lia.
  - intros x y Hx Exy. injection Exy as <-. destruct (over_row_back n x Hx) as (A & B & C).
    rewrite C. auto.
Qed.

(** The row is a world. *)
Lemma row_world n : 0 < n -> world (double_row n).
Proof.
  intros Hn. split; [apply is_map_row; auto|discriminate|].
  assert (Out : forall i, i < n -> reach (double_row n) 1 (4 * i + 1)).
  { intros i. induction i as [|i IH]; intros Hi; [constructor|].
    destruct (next_of_four_at (S i)) as (S0 & _). destruct (over_row_at n i) as (_ & A & _).
    replace (4 * S i + 1) with (sigma (double_row n) (4 * S i)) by exact S0. apply reach_sigma.
    apply (reach_alpha (double_row n) 1 (4 * i + 1)); [apply IH; lia|]. cbn [alpha double_row].
    rewrite A. f_equal. cases. }
  intros x Hx. simpl in Hx. simpl root. by_vertices x i S0 S1 S2 S3.
  all: assert (R := Out i ltac:(lia)).
  - rewrite <- S3, <- S2, <- S1.
    exact (reach_sigma (double_row n) 1 _ (reach_sigma (double_row n) 1 _
      (reach_sigma (double_row n) 1 _ R))).
  - exact R.
  - rewrite <- S1. exact (reach_sigma (double_row n) 1 _ R).
  - rewrite <- S2, <- S1. exact (reach_sigma (double_row n) 1 _ (reach_sigma (double_row n) 1 _ R)).
Qed.

(** A map whose darts turn in fours. *)
Definition in_fours M := forall x, x < darts M -> sigma M x = next_of_four x.

(** The darts of a vertex, clockwise. *)
Lemma turn_four M i : is_map M -> in_fours M -> 4 * i < darts M -> turn M 0 (4 * i) = 4 * i /\
  turn M 1 (4 * i) = 4 * i + 1 /\ turn M 2 (4 * i) = 4 * i + 2 /\ turn M 3 (4 * i) = 4 * i + 3 /\
  turn M 4 (4 * i) = 4 * i.
Proof.
  intros WM S4 Hi. destruct (next_of_four_at i) as (S0 & S1 & S2 & S3).
  assert (T : forall k, turn M (S k) (4 * i) = next_of_four (turn M k (4 * i)))
    by (intros k; apply S4, turn_lt; auto).
  rewrite !T. change (turn M 0 (4 * i)) with (4 * i). rewrite S0, S1, S2, S3. auto.
Qed.

(** Turning does not change the vertex. *)
Lemma turn_same M k x : is_map M -> in_fours M -> x < darts M -> turn M k x / 4 = x / 4.
Proof.
  intros WM S4 Hx. induction k as [|k IH]; cbn [turn]; auto. rewrite S4 by (apply turn_lt; auto).
  rewrite <- IH. clear IH. generalize (turn M k x). intros y. by_vertices y i S0 S1 S2 S3.
  all: assert (Z := div_four i 0 ltac:(lia)); rewrite Nat.add_0_r in Z.
  all: rewrite ?S0, ?S1, ?S2, ?S3, ?Z, ?div_four by lia; auto.
Qed.

(** Every dart is a turn of the first one of its vertex. *)
Lemma turn_of_first M x : is_map M -> in_fours M -> x < darts M ->
  4 * (x / 4) < darts M /\ exists k, k < 4 /\ turn M k (4 * (x / 4)) = x.
Proof.
  intros WM S4 Hx. assert (D := Nat.div_mod x 4 ltac:(discriminate)).
  assert (B := Nat.mod_upper_bound x 4 ltac:(discriminate)). set (i := x / 4) in *.
  split; [lia|]. destruct (turn_four M i WM S4 ltac:(lia)) as (T0 & T1 & T2 & T3 & _).
  exists (x mod 4). split; auto. destruct (x mod 4) as [|[|[|[|r]]]]; lia.
Qed.

(** Every degree is 4. *)
Lemma degree_four M x : is_map M -> in_fours M -> x < darts M -> degree M x = 4.
Proof.
  intros WM S4 Hx. destruct (turn_of_first M x WM S4 Hx) as (Hi & k & _ & Ek).
  rewrite <- Ek, degree_turn by auto.
  destruct (turn_four M _ WM S4 Hi) as (T0 & T1 & T2 & T3 & T4).
  apply degree_unique; auto. intros j Hj Ej.
  destruct j as [|[|[|[|j]]]]; lia.
Qed.

(** Away from the marker every percept is the same. *)
Lemma percept_four M x : is_map M -> in_fours M -> x < darts M -> x / 4 <> root M / 4 ->
  percept M x = (4, None).
Proof.
  intros WM S4 Hx N. unfold percept. rewrite (degree_four M) by auto. f_equal. unfold marker.
  destruct (find _ _) as [k|] eqn:F; auto. apply find_some in F as [_ F]. apply Nat.eqb_eq in F.
  destruct N. rewrite <- F. symmetry. apply turn_same; auto.
Qed.

(** Darts that are near one another are at neighbouring vertices. *)
Lemma near_four x y : x <= y + 4 -> x / 4 <= S (y / 4).
Proof.
  intros L. replace (S (y / 4)) with ((y + 1 * 4) / 4) by (rewrite Nat.div_add; lia).
  apply Nat.div_le_mono; lia.
Qed.

(** In the row every door leads to a vertex at a distance that differs by 1 at most. *)
Lemma row_near n x k y : 0 < n -> x < 4 * n -> move (double_row n) x k = Some y ->
  x / 4 <= S (y / 4) /\ y / 4 <= S (x / 4).
Proof.
  intros Hn Hx E. unfold move in E. destruct (k <? _); [|discriminate].
  assert (T := turn_same (double_row n) k x (is_map_row n Hn) (fun _ _ => eq_refl) Hx).
  rewrite <- T. clear T.
  simpl alpha in E. injection E as <-. generalize (turn (double_row n) k x). clear x k Hx. intros x.
  assert (L : x <= over_row n x + 4 /\ over_row n x <= x + 4)
    by (unfold over_row; destruct (x mod 4) as [|[|[|r]]]; cases).
  split; apply near_four; lia.
Qed.

(** The row has n vertices. *)
Lemma row_vertices n : 0 < n -> vertices (double_row n) = n.
Proof.
  intros Hn. assert (WM := is_map_row n Hn). assert (S4 : in_fours (double_row n)) by (intros x _; auto).
  apply Nat.le_antisymm.
  - change (vertices (double_row n)) with (length (firsts (double_row n))).
    assert (Own := firsts_own (double_row n) WM).
    rewrite <- (map_length (fun x => x / 4)). apply Nat.le_trans with (length (seq 0 n));
      [|rewrite seq_length; auto]. apply NoDup_incl_length.
    + apply nodup_map; [apply NoDup_nodup|]. intros a b Ia Ib Eq.
      apply Own in Ia as [La Fa], Ib as [Lb Fb]. rewrite <- Fa, <- Fb.
      destruct (turn_of_first _ a WM S4 La) as (Li & j & _ & Ej).
      destruct (turn_of_first _ b WM S4 Lb) as (_ & k & _ & Ek). rewrite <- Eq in Ek.
      replace (first_dart (double_row n) a) with (first_dart (double_row n) (4 * (a / 4))).
      * apply (first_dart_eq _ WM); auto. apply (at_vertex_iff _ WM); eauto.
      * apply (first_dart_eq _ WM); auto. apply (at_vertex_iff _ WM); eauto.
    + intros v I. apply in_map_iff in I as (x & <- & I). apply Own in I as [Lx _]. simpl in Lx.
      apply in_seq. assert (D := Nat.div_lt_upper_bound x 4 n ltac:(discriminate) Lx). lia.
  - apply Nat.le_trans with (length (map (fun i => 4 * i) (seq 0 n)));
      [rewrite map_length, seq_length; auto|]. apply vertices_most.
    + intros a I. apply in_map_iff in I as (i & <- & I). apply in_seq in I. simpl. lia.
    + rewrite map_map. apply nodup_map; [apply seq_NoDup|]. intros i j Ii Ij Eq.
      apply in_seq in Ii, Ij. apply (first_dart_eq _ WM) in Eq; simpl; try lia.
      apply (at_vertex_iff _ WM) in Eq as (k & Ek); [|simpl; lia].
      assert (T := turn_same _ k (4 * i) WM S4 ltac:(simpl; lia)). rewrite Ek in T.
      rewrite !(Nat.mul_comm 4), !Nat.div_mul in T by discriminate. auto.
Qed.

(** Where the map's darts lie in the row: those of v0 begin with the root. *)
Definition in_row x := if x <? 4 then next_of_four x else x.

(** The dart that leads on from the last vertex of the map, after k rounds. *)
Definition onward_dart k := match k with 0 => 0 | _ => 4 * k + 1 end.

(** The map after k rounds: k + 1 vertices in a row. *)
Fixpoint row_so_far k := match k with
  | 0 => initial 4 | S k => augment_new (row_so_far k) (onward_dart k) 4 end.

(** What the map after k rounds is. *)
Lemma row_so_far_darts k : darts (row_so_far k) = 4 * k + 4 /\ in_fours (row_so_far k) /\
  root (row_so_far k) = 0.
Proof.
  induction k as [|k (D & S4 & R)]; simpl row_so_far.
  - split; auto. split; auto. intros x Hx. simpl in *. unfold grow, next_of_four.
    destruct x as [|[|[|[|x]]]]; simpl; auto; lia.
  - cbn [augment_new darts root]. split; [lia|]. split; auto. intros x Hx.
    cbn [augment_new darts sigma] in *. unfold grow. rewrite D in *.
    destruct (Nat.ltb_spec x (4 * k + 4)) as [L|L]; [apply (S4 x); lia|].
    by_vertices x i S0 S1 S2 S3; rewrite ?S0, ?S1, ?S2, ?S3; cases.
Qed.

(** Which darts of it are open. *)
Lemma row_so_far_open k : alpha (row_so_far k) (onward_dart k) = None /\
  (0 < k -> alpha (row_so_far k) (4 * k) <> None) /\
  forall i, i <= k -> alpha (row_so_far k) (4 * i + 2) = None /\
                      alpha (row_so_far k) (4 * i + 3) = None.
Proof.
  induction k as [|k (O & _ & H)]; [split; [auto|split; [lia|auto]]|].
  destruct (row_so_far_darts k) as (D & _). cbn [row_so_far augment_new alpha]. rewrite D.
  assert (On : onward_dart k < 4 * k + 2) by (unfold onward_dart; destruct k; lia).
  assert (Off : forall i, onward_dart k <> 4 * i + 2 /\ onward_dart k <> 4 * i + 3)
    by (intros i; unfold onward_dart; destruct k; lia).
  unfold join. split; [|split].
  - change (onward_dart (S k)) with (4 * S k + 1). cases; auto.
  - intros _. cases.
  - intros i Hi. specialize (H i). destruct (Off i) as [N2 N3]. split; cases; auto; apply H; lia.
Qed.

(** It is a connected map and a part of the row. *)
Lemma row_so_far_embedded n k : k < n -> is_map (row_so_far k) /\ connected (row_so_far k) /\
  embedded (row_so_far k) (double_row n) in_row.
Proof.
  intros Hk. assert (WW := is_map_row n ltac:(lia)).
  assert (W4 : in_fours (double_row n)) by (intros x _; auto).
  induction k as [|k IH].
  - split; [apply is_map_initial; lia|]. split; [apply connected_initial; lia|].
    split; cbn [row_so_far initial darts sigma alpha root double_row]; try discriminate; auto.
    + intros x Hx. unfold in_row, next_of_four. destruct x as [|[|[|[|x]]]]; simpl; lia.
    + intros x y Hx Hy. destruct x as [|[|[|[|x]]]], y as [|[|[|[|y]]]]; try lia; discriminate.
    + intros x Hx. destruct x as [|[|[|[|x]]]]; auto; lia.
  - destruct IH as (WM & CM & E); [lia|]. destruct (row_so_far_darts k) as (D & S4 & R).
    destruct (row_so_far_open k) as (O & _). cbn [row_so_far].
    assert (He : onward_dart k < darts (row_so_far k))
      by (rewrite D; unfold onward_dart; destruct k; lia).
    assert (Ea : alpha (double_row n) (in_row (onward_dart k)) = Some (4 * S k)).
    { replace (in_row (onward_dart k)) with (4 * k + 1).
      - destruct (over_row_at n k) as (_ & A & _). cbn [alpha double_row]. rewrite A. f_equal. cases.
      - unfold in_row, onward_dart. destruct k as [|k]; [auto|]. cases. }
    split; [apply is_map_new; auto; lia|]. split; [apply connected_new; auto|].
    assert (Small : forall x, in_row x < 4 \/ in_row x = x /\ 4 <= x).
    { intros x. unfold in_row, next_of_four. destruct x as [|[|[|[|x]]]]; simpl; lia. }
    assert (New : is_new (row_so_far k) in_row (4 * S k))
      by (intros h Lh; rewrite D in Lh; destruct (Small h); lia).
    assert (E' := embedded_new _ (double_row n) in_row _ _ WM WW E He Ea New).
    rewrite (degree_four (double_row n) (4 * S k) WW W4) in E' by (cbn [darts double_row]; lia).
    assert (Same : forall x, x < darts (row_so_far k) + 4 ->
      extend in_row (darts (row_so_far k)) (double_row n) (4 * S k) x = in_row x).
    { intros x Hx. unfold extend. rewrite D in *. destruct (Nat.ltb_spec x (4 * k + 4)); auto.
      destruct (turn_four (double_row n) (S k) WW W4) as (T0 & T1 & T2 & T3 & _);
        [cbn [darts double_row]; lia|].
      unfold in_row. rewrite (proj2 (Nat.ltb_ge x 4)) by lia.
      destruct (x - (4 * k + 4)) as [|[|[|[|r]]]] eqn:Er; lia. }
    assert (WN : is_map (augment_new (row_so_far k) (onward_dart k) 4)) by (apply is_map_new; auto; lia).
    destruct E' as [E1 E2 E3 E4 E5]. cbn [augment_new darts sigma alpha root] in *.
    split; cbn [augment_new darts sigma alpha root].
    + intros x Hx. rewrite <- Same by auto. auto.
    + intros x y Hx Hy Exy. apply E2; auto. rewrite !Same by auto. auto.
    + intros x Hx. rewrite <- Same, <- (Same x) by (auto; apply (sigma_lt _ WN x Hx)). auto.
    + intros x y Hx Hy. assert (Ly := proj1 (alpha_ok _ WN x y Hx Hy)).
      rewrite <- Same, <- (Same y) by auto. auto.
    + rewrite <- (Same (root (row_so_far k))); auto. rewrite R. lia.
Qed.
