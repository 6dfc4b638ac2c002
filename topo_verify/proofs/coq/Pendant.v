(** Pendant trees: what hangs on a breadth-first tree and leads to no loop (section 11).

    SCEPTICS READ [climb], [below], [pendant], [height] and [stalks]. *)
From Coq Require Import Arith Lia List Bool.
Import ListNotations.
From Topo Require Import World Rotation Vertices Distance Tree.

(** The dart by which one comes from a dart's vertex to the vertex nearer to the root's. *)
Definition parent W (up : nat -> nat) b := opposite W (up b).

(** So many vertices nearer. *)
Fixpoint climb W up j b := match j with 0 => b | S j => climb W up j (parent W up b) end.

(** Does the way from x to the root's vertex lead through the vertex of b? *)
Definition below W (depth up : nat -> nat) b x :=
  (depth b <=? depth x) && at_vertex W b (climb W up (depth x - depth b) x).

(** Is the vertex of b in a pendant tree: not the root's, and no end of a chord below it? *)
Definition pendant W depth up b := (0 <? depth b) &&
  negb (existsb (fun x => negb (in_tree W depth up x) && below W depth up b x) (seq 0 (darts W))).

(** How many vertices of pendant trees are on the way, of at most n that are looked at. *)
Fixpoint hanging W depth up n b := match n with
  | 0 => 0
  | S n => if pendant W depth up b then S (hanging W depth up n (parent W up b)) else 0 end.

(** How high a dart's vertex is above where its pendant tree is attached; 0 if it is in none. *)
Definition height W depth up b := hanging W depth up (depth b) b.

(** The edges of the pendant trees, each by its dart that leads nearer. *)
Definition stalks W depth up :=
  filter (fun q => pendant W depth up q && (up q =? q)) (seq 0 (darts W)).

Section Pendant.
Variables (W : Map) (depth up : nat -> nat).
Hypotheses (HW : world W) (B : breadth_first W depth up).
Let WW := world_is_map W HW.
Let opposite_ok := opposite_ok W HW.
Let depth_turn := depth_turn W depth up HW B.
Notation parent := (parent W up).
Notation climb := (climb W up).
Notation below := (below W depth up).
Notation pendant := (pendant W depth up).
Notation hanging := (hanging W depth up).
Notation height := (height W depth up).
Notation in_tree := (in_tree W depth up).
Notation nearer := (nearer depth up).

(** The parent is one nearer. *)
Lemma parent_ok b : b < darts W -> 0 < depth b ->
  up b < darts W /\ parent b < darts W /\ S (depth (parent b)) = depth b /\
  depth (up b) = depth b /\ up (up b) = up b.
Proof.
  intros Hb P. destruct (bf_up W depth up B b Hb P) as [(k & U) E].
  assert (Hu : up b < darts W) by (rewrite U; apply turn_lt; auto).
  split; auto. split; [apply opposite_ok; auto|]. split; auto.
  destruct (depth_turn k b Hb) as [X Y]. rewrite <- U in X, Y. auto.
Qed.

(** Darts of one vertex have one parent. *)
Lemma parent_turn k b : b < darts W -> parent (turn W k b) = parent b.
Proof. intros Hb. unfold Pendant.parent. destruct (depth_turn k b Hb) as [_ ->]. auto. Qed.

(** Climbing ends with a step as it begins with one. *)
Lemma climb_S j : forall b, climb (S j) b = parent (climb j b).
Proof. induction j as [|j IH]; intros b; auto. simpl in *. rewrite <- IH. auto. Qed.

(** Turning does not change what is below. *)
Lemma below_turn k b x : b < darts W -> x < darts W -> below b (turn W k x) = below b x.
Proof.
  intros Hb Hx. unfold Pendant.below. destruct (depth_turn k x Hx) as [-> _].
  destruct (Nat.leb_spec (depth b) (depth x)); auto. simpl.
  destruct (depth x - depth b) as [|m]; simpl; [|rewrite parent_turn; auto].
  apply eq_true_iff_eq. rewrite !(at_vertex_iff W WW) by auto. split; intros (j & E).
  - destruct (turn_back W WW k x Hx) as (i & F). exists (i + j). rewrite turn_add, E. auto.
  - exists (k + j). rewrite turn_add, E. auto.
Qed.

(** Nor below what it is. *)
Lemma turn_below k b x : b < darts W -> below (turn W k b) x = below b x.
Proof.
  intros Hb. unfold Pendant.below. destruct (depth_turn k b Hb) as [-> _]. f_equal. symmetry.
  apply at_vertex_eq; auto. apply at_vertex_iff; eauto.
Qed.

(** A vertex is below itself. *)
Lemma below_self b : b < darts W -> below b b = true.
Proof.
  intros Hb. unfold Pendant.below. rewrite Nat.leb_refl, Nat.sub_diag. simpl.
  apply (at_vertex_iff W WW); auto. exists 0. auto.
Qed.

(** What is nearer is not below. *)
Lemma below_nearer b x : depth x < depth b -> below b x = false.
Proof. intros L. unfold Pendant.below. rewrite (proj2 (Nat.leb_gt _ _) L). auto. Qed.

(** What is farther is below if its parent is. *)
Lemma below_parent b x : x < darts W -> depth b < depth x -> below b x = below b (parent x).
Proof.
  intros Hx L. destruct (parent_ok x Hx) as (_ & _ & D & _); [lia|]. unfold Pendant.below.
  replace (depth x - depth b) with (S (depth (parent x) - depth b)) by lia. simpl.
  f_equal. apply eq_true_iff_eq. rewrite !Nat.leb_le. lia.
Qed.

(** What is below b is below the parent of b. *)
Lemma below_up b x : b < darts W -> x < darts W -> 0 < depth b -> below b x = true ->
  below (parent b) x = true.
Proof.
  intros Hb Hx P H. unfold Pendant.below in *. apply andb_true_iff in H as [L A].
  apply Nat.leb_le in L. destruct (parent_ok b Hb P) as (_ & Hp & D & _).
  apply andb_true_iff. split; [apply Nat.leb_le; lia|].
  replace (depth x - depth (parent b)) with (S (depth x - depth b)) by lia. rewrite climb_S.
  apply (at_vertex_iff W WW) in A as (k & <-); auto. rewrite parent_turn; auto.
  apply (at_vertex_iff W WW); auto. exists 0. auto.
Qed.

(** Darts of one vertex are in a pendant tree together. *)
Lemma pendant_turn k b : b < darts W -> pendant (turn W k b) = pendant b.
Proof.
  intros Hb. unfold Pendant.pendant. destruct (depth_turn k b Hb) as [-> _]. do 2 f_equal.
  induction (seq 0 (darts W)) as [|x l IH]; simpl; auto. rewrite turn_below, IH; auto.
Qed.

(** No end of a chord is below a vertex of a pendant tree. *)
Lemma pendant_chord b x : x < darts W -> pendant b = true -> in_tree x = false -> below b x = false.
Proof.
  unfold Pendant.pendant. intros Hx P T. apply andb_true_iff in P as [_ P].
  apply negb_true_iff in P. destruct (below b x) eqn:E; auto. rewrite <- P. symmetry.
  apply existsb_exists.
  exists x. rewrite T, E. split; auto. apply in_seq. lia.
Qed.

(** An end of a chord is in no pendant tree. *)
Lemma chord_pendant b : b < darts W -> in_tree b = false -> pendant b = false.
Proof.
  intros Hb T. destruct (pendant b) eqn:P; auto. apply (pendant_chord b b) in P; auto.
  rewrite below_self in P; auto.
Qed.

(** What hangs on a pendant tree is part of it. *)
Lemma pendant_parent b : b < darts W -> 0 < depth b -> pendant (parent b) = true -> pendant b = true.
Proof.
  intros Hb D P. unfold Pendant.pendant. apply andb_true_iff. split; [apply Nat.ltb_lt; auto|].
  apply negb_true_iff. destruct (existsb _ _) eqn:E; auto. apply existsb_exists in E as (x & I & E).
  apply in_seq in I. apply andb_true_iff in E as [T E]. apply negb_true_iff in T.
  apply below_up in E; auto; [|lia]. rewrite pendant_chord in E; auto. lia.
Qed.

(** The height in a pendant tree is one more than that of the parent. *)
Lemma height_pendant b : b < darts W -> pendant b = true -> height b = S (height (parent b)).
Proof.
  intros Hb P. assert (D : 0 < depth b).
  { apply andb_true_iff in P as [P _]. apply Nat.ltb_lt in P. auto. }
  destruct (parent_ok b Hb D) as (_ & _ & E & _). unfold Pendant.height. rewrite <- E.
  simpl Pendant.hanging. rewrite P. auto.
Qed.

(** Elsewhere it is 0. *)
Lemma height_none b : pendant b = false -> height b = 0.
Proof. intros P. unfold Pendant.height. destruct (depth b); simpl; auto. rewrite P. auto. Qed.

(** It is the same for all darts of a vertex. *)
Lemma height_turn k b : b < darts W -> height (turn W k b) = height b.
Proof.
  intros Hb. destruct (pendant b) eqn:P.
  - rewrite (height_pendant (turn W k b)), (height_pendant b), parent_turn; auto.
    + apply turn_lt; auto.
    + rewrite pendant_turn; auto.
  - rewrite (height_none (turn W k b)), (height_none b); auto. rewrite pendant_turn; auto.
Qed.

(** The edge of a dart that leads nearer leads to the parent. *)
Lemma nearer_ok c : c < darts W -> nearer c = true ->
  0 < depth c /\ up c = c /\ opposite W c = parent c /\ S (depth (parent c)) = depth c.
Proof.
  intros Hc N. unfold Tree.nearer in N. apply andb_true_iff in N as [P U].
  apply Nat.ltb_lt in P. apply Nat.eqb_eq in U. destruct (parent_ok c Hc P) as (_ & _ & D & _).
  repeat split; auto. unfold Pendant.parent. rewrite U. auto.
Qed.

(** Of an edge one dart only leads nearer. *)
Lemma nearer_one c : c < darts W -> nearer c = true -> nearer (opposite W c) = false.
Proof.
  intros Hc N. destruct (nearer (opposite W c)) eqn:N'; auto. exfalso.
  destruct (opposite_ok c Hc) as (Ho & _ & Oo).
  apply nearer_ok in N as (_ & _ & O & D); auto. apply nearer_ok in N' as (_ & _ & O' & D'); auto.
  rewrite Oo in O'. rewrite <- O' in D'. rewrite O in D'. lia.
Qed.

(** A stalk is a dart in a pendant tree that leads nearer. *)
Lemma stalk_ok q : In q (stalks W depth up) ->
  q < darts W /\ pendant q = true /\ up q = q /\ nearer q = true.
Proof.
  intros I. apply filter_In in I as [I E]. apply in_seq in I. apply andb_true_iff in E as [P U].
  assert (D := P). apply andb_true_iff in D as [D _]. unfold Tree.nearer. rewrite D, U.
  apply Nat.eqb_eq in U. repeat split; auto. lia.
Qed.

(** Two stalks are two edges. *)
Lemma stalk_edge q c : In q (stalks W depth up) -> c < darts W -> nearer c = true ->
  edge W c = edge W q -> c = q.
Proof.
  intros I Hc N E. apply stalk_ok in I as (Hq & _ & _ & Nq).
  assert (X := nearer_one c Hc N). assert (Y := nearer_one q Hq Nq).
  destruct (opposite_ok c Hc) as (_ & _ & O). destruct (opposite_ok q Hq) as (_ & _ & O').
  destruct (edge_or W c) as [A|A], (edge_or W q) as [A'|A']; rewrite A, A' in E; try congruence.
Qed.

(** Crossing an edge, one comes below a stalk or leaves it exactly if the edge is the stalk. *)
Lemma below_nearer_edge q c : In q (stalks W depth up) -> c < darts W -> nearer c = true ->
  below q (opposite W c) = xorb (below q c) (edge W c =? edge W q).
Proof.
  intros I Hc N. assert (Q := stalk_ok q I). destruct Q as (Hq & _ & Uq & _).
  destruct (nearer_ok c Hc N) as (P & U & -> & D).
  destruct (Nat.eqb_spec (edge W c) (edge W q)) as [E|E].
  - apply stalk_edge in E as ->; auto. rewrite below_self, below_nearer; auto. lia.
  - rewrite xorb_false_r. destruct (lt_eq_lt_dec (depth q) (depth c)) as [[L|L]|L].
    + symmetry. apply below_parent; auto.
    + rewrite below_nearer by lia. symmetry. unfold Pendant.below.
      rewrite L, Nat.leb_refl, Nat.sub_diag.
      simpl. destruct (at_vertex W q c) eqn:A; auto. destruct E.
      apply (at_vertex_iff W WW) in A as (k & A); auto. destruct (depth_turn k q Hq) as [_ F].
      rewrite A in F. congruence.
    + rewrite !below_nearer; auto; lia.
Qed.

(** The same for every edge. *)
Lemma below_edge q b : In q (stalks W depth up) -> b < darts W ->
  below q (opposite W b) = xorb (below q b) (edge W b =? edge W q).
Proof.
  intros I Hb. destruct (opposite_ok b Hb) as (Ho & _ & Oo).
  destruct (nearer b) eqn:N; [apply below_nearer_edge; auto|].
  destruct (nearer (opposite W b)) eqn:N'.
  - assert (H := below_nearer_edge q _ I Ho N'). rewrite Oo, edge_opposite in H by auto. rewrite H.
    destruct (below q (opposite W b)), (edge W b =? edge W q); auto.
  - destruct (stalk_ok q I) as (Hq & P & _ & Nq).
    assert (T : in_tree b = false) by (unfold Tree.in_tree; rewrite N, N'; auto).
    rewrite !pendant_chord; auto; [|rewrite in_tree_opposite; auto].
    destruct (Nat.eqb_spec (edge W b) (edge W q)) as [E|E]; auto. exfalso.
    destruct (opposite_ok q Hq) as (_ & _ & O').
    destruct (edge_or W b) as [A|A], (edge_or W q) as [A'|A']; rewrite A, A' in E; congruence.
Qed.

(** So many stalks as the height are above a dart, at most. *)
Lemma stalks_above d : forall b, b < darts W -> depth b = d ->
  length (filter (fun q => below q b) (stalks W depth up)) <= height b.
Proof.
  assert (Nodup : forall f, NoDup (filter f (stalks W depth up))).
  { intros f. apply NoDup_filter, NoDup_filter, seq_NoDup. }
  induction d as [|d IH]; intros b Hb D.
  - destruct (filter _ _) as [|q l] eqn:F; simpl; [lia|]. exfalso.
    assert (I : In q (q :: l)) by (left; auto). rewrite <- F in I.
    apply filter_In in I as [I E]. apply stalk_ok in I as (Hq & _ & _ & N).
    apply nearer_ok in N as (P & _); auto. rewrite below_nearer in E; [discriminate|lia].
  - destruct (parent_ok b Hb) as (Hu & Hp & E & Du & Uu); [lia|].
    specialize (IH (parent b) Hp ltac:(lia)).
    assert (Case : forall q, In q (stalks W depth up) -> below q b = true ->
      below q (parent b) = true \/ q = up b /\ pendant b = true).
    { intros q I A. destruct (stalk_ok q I) as (Hq & P & U & _).
      destruct (lt_eq_lt_dec (depth q) (depth b)) as [[L|L]|L].
      - left. rewrite <- below_parent; auto.
      - right. unfold Pendant.below in A. rewrite L, Nat.leb_refl, Nat.sub_diag in A. simpl in A.
        apply (at_vertex_iff W WW) in A as (k & <-); auto. rewrite pendant_turn by auto.
        destruct (depth_turn k q Hq) as [_ ->]. auto.
      - rewrite below_nearer in A; [discriminate|auto]. }
    destruct (pendant b) eqn:P.
    + rewrite height_pendant by auto. apply Nat.le_trans with
        (length (up b :: filter (fun q => below q (parent b)) (stalks W depth up))); [|simpl; lia].
      apply NoDup_incl_length; auto. intros q I. apply filter_In in I as [I A].
      destruct (Case q I A) as [A'|[-> _]]; [right; apply filter_In; auto|left; auto].
    + rewrite height_none by auto. rewrite <- (height_none (parent b)).
      * apply Nat.le_trans with (2 := IH). apply NoDup_incl_length; auto. intros q I.
        apply filter_In in I as [I A]. destruct (Case q I A) as [A'|[_ X]]; [|discriminate].
        apply filter_In; auto.
      * destruct (pendant (parent b)) eqn:P'; auto. apply pendant_parent in P'; auto; [congruence|lia].
Qed.
End Pendant.
