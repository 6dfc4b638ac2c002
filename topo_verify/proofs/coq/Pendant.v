(** Pendant trees: the parts of a breadth-first tree that hang on it and lead to no chord
    (docs/semantics.md, section 11).

    W is a world; b, c, x are darts, each standing for its vertex; depth and up describe a
    breadth-first tree (Distance.v); q is a stalk, the dart by which an edge of a pendant tree
    leads to the parent. SCEPTICS READ [parent], [climb], [below], [pendant], [hanging], [height]
    and [stalks]. *)
From Coq Require Import Arith Lia List Bool.
Import ListNotations.
From Topo Require Import World Rotation Vertices Distance Tree.

(** The dart by which one arrives at the parent of the vertex of b. *)
Definition parent W (up : nat -> nat) b := opposite W (up b).

(** The j-th ancestor of b in the tree. *)
Fixpoint climb W up j b := match j with 0 => b | S j => climb W up j (parent W up b) end.

(** Is the vertex of b on the tree path from x to v0? Then x is below b. *)
Definition below W (depth up : nat -> nat) b x :=
  (depth b <=? depth x) && at_vertex W b (climb W up (depth x - depth b) x).

(** Is the vertex of b in a pendant tree: not v0, and no end of a chord is below it? *)
Definition pendant W depth up b := (0 <? depth b) &&
  negb (existsb (fun x => negb (in_tree W depth up x) && below W depth up b x) (seq 0 (darts W))).

(** How many vertices of pendant trees are on the tree path from b to v0, among the first n. *)
Fixpoint hanging W depth up n b := match n with
  | 0 => 0
  | S n => if pendant W depth up b then S (hanging W depth up n (parent W up b)) else 0 end.

(** How many edges the vertex of b is away from where its pendant tree is attached; 0 if it is in
    no pendant tree. *)
Definition height W depth up b := hanging W depth up (depth b) b.

(** The edges of the pendant trees, each given by its dart that leads to the parent. *)
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

(** The depth of the parent is one less, and up is a dart of the vertex. *)
Lemma parent_ok b : b < darts W -> 0 < depth b ->
  up b < darts W /\ parent b < darts W /\ S (depth (parent b)) = depth b /\
  depth (up b) = depth b /\ up (up b) = up b.
Proof.
  intros Hb P. destruct (bf_up W depth up B b Hb P) as [(k & U) E].
  assert (Hu : up b < darts W) by (rewrite U; apply turn_lt; auto).
  split; auto. split; [apply opposite_ok; auto|]. split; auto.
  destruct (depth_turn k b Hb) as [X Y]. rewrite <- U in X, Y. auto.
Qed.

(** All darts of a vertex have the same parent. *)
Lemma parent_turn k b : b < darts W -> parent (turn W k b) = parent b.
Proof. intros Hb. unfold Pendant.parent. destruct (depth_turn k b Hb) as [_ ->]. auto. Qed.

(** The parent of the j-th ancestor is the ancestor j + 1. *)
Lemma climb_S j : forall b, climb (S j) b = parent (climb j b).
Proof. induction j as [|j IH]; intros b; auto. simpl in *. rewrite <- IH. auto. Qed.

(** All darts of a vertex are below the same vertices. *)
Lemma below_turn k b x : b < darts W -> x < darts W -> below b (turn W k x) = below b x.
Proof.
  intros Hb Hx. unfold Pendant.below. destruct (depth_turn k x Hx) as [-> _].
  destruct (Nat.leb_spec (depth b) (depth x)); auto. simpl.
  destruct (depth x - depth b) as [|m]; simpl; [|rewrite parent_turn; auto].
  apply eq_true_iff_eq. rewrite !(at_vertex_iff W WW) by auto. split; intros (j & E).
  - destruct (turn_back W WW k x Hx) as (i & F). exists (i + j). rewrite turn_add, E. auto.
  - exists (k + j). rewrite turn_add, E. auto.
Qed.

(** The same darts are below all darts of a vertex. *)
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

(** A vertex with a smaller depth than b is not below b. *)
Lemma below_nearer b x : depth x < depth b -> below b x = false.
Proof. intros L. unfold Pendant.below. rewrite (proj2 (Nat.leb_gt _ _) L). auto. Qed.

(** A vertex with a greater depth than b is below b exactly if its parent is. *)
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

(** All darts of a vertex are in a pendant tree, or none is. *)
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

(** A vertex whose parent is in a pendant tree is in a pendant tree. *)
Lemma pendant_parent b : b < darts W -> 0 < depth b -> pendant (parent b) = true -> pendant b = true.
Proof.
  intros Hb D P. unfold Pendant.pendant. apply andb_true_iff. split; [apply Nat.ltb_lt; auto|].
  apply negb_true_iff. destruct (existsb _ _) eqn:E; auto. apply existsb_exists in E as (x & I & E).
  apply in_seq in I. apply andb_true_iff in E as [T E]. apply negb_true_iff in T.
  apply below_up in E; auto; [|lia]. rewrite pendant_chord in E; auto. lia.
Qed.

(** In a pendant tree the height of a vertex is one more than that of its parent. *)
Lemma height_pendant b : b < darts W -> pendant b = true -> height b = S (height (parent b)).
Proof.
  intros Hb P. assert (D : 0 < depth b).
  { apply andb_true_iff in P as [P _]. apply Nat.ltb_lt in P. auto. }
  destruct (parent_ok b Hb D) as (_ & _ & E & _). unfold Pendant.height. rewrite <- E.
  simpl Pendant.hanging. rewrite P. auto.
Qed.

(** Outside of the pendant trees the height is 0. *)
Lemma height_none b : pendant b = false -> height b = 0.
Proof. intros P. unfold Pendant.height. destruct (depth b); simpl; auto. rewrite P. auto. Qed.

(** All darts of a vertex have the same height. *)
Lemma height_turn k b : b < darts W -> height (turn W k b) = height b.
Proof.
  intros Hb. destruct (pendant b) eqn:P.
  - rewrite (height_pendant (turn W k b)), (height_pendant b), parent_turn; auto.
    + apply turn_lt; auto.
    + rewrite pendant_turn; auto.
  - rewrite (height_none (turn W k b)), (height_none b); auto. rewrite pendant_turn; auto.
Qed.

(** A dart that leads to the parent has the parent as its opposite, whose depth is one less. *)
Lemma nearer_ok c : c < darts W -> nearer c = true ->
  0 < depth c /\ up c = c /\ opposite W c = parent c /\ S (depth (parent c)) = depth c.
Proof.
  intros Hc N. unfold Tree.nearer in N. apply andb_true_iff in N as [P U].
  apply Nat.ltb_lt in P. apply Nat.eqb_eq in U. destruct (parent_ok c Hc P) as (_ & _ & D & _).
  repeat split; auto. unfold Pendant.parent. rewrite U. auto.
Qed.

(** At most one dart of an edge leads to a parent. *)
Lemma nearer_one c : c < darts W -> nearer c = true -> nearer (opposite W c) = false.
Proof.
  intros Hc N. destruct (nearer (opposite W c)) eqn:N'; auto. exfalso.
  destruct (opposite_ok c Hc) as (Ho & _ & Oo).
  apply nearer_ok in N as (_ & _ & O & D); auto. apply nearer_ok in N' as (_ & _ & O' & D'); auto.
  rewrite Oo in O'. rewrite <- O' in D'. rewrite O in D'. lia.
Qed.

(** A stalk is a dart in a pendant tree that leads to the parent. *)
Lemma stalk_ok q : In q (stalks W depth up) ->
  q < darts W /\ pendant q = true /\ up q = q /\ nearer q = true.
Proof.
  intros I. apply filter_In in I as [I E]. apply in_seq in I. apply andb_true_iff in E as [P U].
  assert (D := P). apply andb_true_iff in D as [D _]. unfold Tree.nearer. rewrite D, U.
  apply Nat.eqb_eq in U. repeat split; auto. lia.
Qed.

(** Different stalks are different edges: a dart that leads to a parent over the edge of q is q. *)
Lemma stalk_edge q c : In q (stalks W depth up) -> c < darts W -> nearer c = true ->
  edge W c = edge W q -> c = q.
Proof.
  intros I Hc N E. apply stalk_ok in I as (Hq & _ & _ & Nq).
  assert (X := nearer_one c Hc N). assert (Y := nearer_one q Hq Nq).
  destruct (opposite_ok c Hc) as (_ & _ & O). destruct (opposite_ok q Hq) as (_ & _ & O').
  destruct (edge_or W c) as [A|A], (edge_or W q) as [A'|A']; rewrite A, A' in E; try congruence.
Qed.

(** Of the two ends of a tree edge exactly one is below the stalk q if the edge is that of q;
    else both or neither are. *)
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

(** The same holds for every edge. *)
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

(** At most as many stalks have b below them as the height of b. *)
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
