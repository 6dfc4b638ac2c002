(** The bound of claim 7: m <= cost <= m * (n + (2m - 1) * 2(n - 1)).

    m is the number of edges, n of vertices; M is the map, W the world, v a robot that counts its
    moves, u the same robot without its count.

    The mapper is given a robot that counts its moves. It decides as with one that does not
    count, since both see the same. Each of the m rounds walks to e, which takes at most n - 1
    moves, crosses it, and tests at most 2m - 1 hypotheses with at most 2(n - 1) moves each. With
    n = 1 the bound is m. *)
From Coq Require Import Arith Lia List Bool Permutation.
Import ListNotations.
From Topo Require Import World Rotation Embedding Vertices Augment Records Mapper MapperCorrect Search
  Policies.

Section Counted.
Variables (St : Type) (see : St -> Percept) (go : St -> nat -> option St).
Variables (path : Map -> nat -> nat -> list nat * nat) (order : Map -> list nat -> list nat)
          (keep : Map -> list (list nat * list Percept) -> nat -> bool).

(** A robot that counts sees what the robot sees. *)
Definition see_counted (s : St * nat) := see (fst s).

(** It goes where the robot goes, and adds 1 to its count. *)
Definition go_counted (s : St * nat) k := option_map (fun t => (t, S (snd s))) (go (fst s) k).

Notation counting_robot := ((St * nat) * nat)%type.

(** Claim 6: the cost is the number of moves. *)
Definition cost (v : counting_robot) := snd (fst v).

(** The robot without its count. *)
Definition uncounted (v : counting_robot) : St * nat := (fst (fst v), snd v).

Notation go_on' := (go_on (St * nat) see_counted go_counted).
Notation go_back' := (go_back (St * nat) see_counted go_counted).
Notation execute' := (execute (St * nat) see_counted go_counted).
Notation follow' := (follow (St * nat) see_counted go_counted).
Notation test_all' := (test_all (St * nat) see_counted go_counted path keep).
Notation round' := (round (St * nat) see_counted go_counted path order keep).
Notation go_on := (go_on St see go).
Notation go_back := (go_back St see go).
Notation execute := (execute St see go).
Notation follow := (follow St see go).
Notation test_all := (test_all St see go path keep).
Notation round := (round St see go path order keep).

(** Going on costs 1. *)
Lemma go_on_counted v k u : go_on (uncounted v) k = Some u ->
  exists v', go_on' v k = Some v' /\ uncounted v' = u /\ cost v' = S (cost v).
Proof.
  destruct v as ((s, c), t). unfold Mapper.go_on, uncounted, see_counted, go_counted. simpl.
  destruct (go s _) as [s'|]; simpl; [|discriminate].
  intros E. injection E as <-. eauto.
Qed.

(** Going back costs 1. *)
Lemma go_back_counted v k u : go_back (uncounted v) k = Some u ->
  exists v', go_back' v k = Some v' /\ uncounted v' = u /\ cost v' = S (cost v).
Proof.
  destruct v as ((s, c), t). unfold Mapper.go_back, uncounted, see_counted, go_counted. simpl.
  destruct (go s _) as [s'|]; simpl; [|discriminate].
  intros E. injection E as <-. eauto.
Qed.

(** Taking the doors w costs their number. *)
Lemma execute_counted w : forall v u, execute (uncounted v) w = Some u ->
  exists v', execute' v w = Some v' /\ uncounted v' = u /\ cost v' = length w + cost v.
Proof.
  induction w as [|k w IH]; simpl; intros v u E.
  - injection E as <-. exists v. auto.
  - destruct (go_on (uncounted v) k) as [x|] eqn:G; [|discriminate].
    apply go_on_counted in G as (y & -> & <- & C). destruct (IH y u E) as (v' & -> & U & C').
    exists v'. repeat split; auto. lia.
Qed.

(** Validation by w costs at most its length, and twice that if it fails. *)
Lemma follow_counted M w : forall x v b qs u, follow M x w (uncounted v) = Some (b, qs, u) ->
  exists v', follow' M x w v = Some (b, qs, v') /\ uncounted v' = u /\
  cost v <= cost v' <= (if b then 1 else 2) * length w + cost v.
Proof.
  induction w as [|k w IH]; simpl; intros x v b qs u E.
  - injection E as <- <- <-. exists v. repeat split; auto; lia.
  - destruct (move M x k) as [y|]; [|discriminate].
    destruct (go_on (uncounted v) k) as [z|] eqn:G; [|discriminate].
    apply go_on_counted in G as (v1 & -> & <- & C1).
    change (see_counted (fst v1)) with (see (fst (uncounted v1))).
    destruct (percept_eqb _ _).
    + destruct (follow M y w (uncounted v1)) as [((b1, qs1), u1)|] eqn:F; [|discriminate].
      apply IH in F as (v2 & -> & U & C2). destruct b1.
      * injection E as <- <- <-. exists v2. repeat split; auto; lia.
      * subst u1. destruct (go_back (uncounted v2) k) as [u3|] eqn:B; [|discriminate].
        injection E as <- <- <-. apply go_back_counted in B as (v3 & -> & U3 & C3).
        exists v3. repeat split; auto; lia.
    + destruct (go_back (uncounted v1) k) as [u3|] eqn:B; [|discriminate].
      injection E as <- <- <-. apply go_back_counted in B as (v3 & -> & U3 & C3).
      exists v3. repeat split; auto; lia.
Qed.

(** Testing costs at most twice the longest way for each hypothesis. *)
Lemma test_all_counted M pu n : forall H log v o u,
  (forall h, In h H -> length (fst (path M h (root M))) <= n) ->
  test_all M pu log (uncounted v) H = Some (o, u) ->
  exists v', test_all' M pu log v H = Some (o, v') /\ uncounted v' = u /\
  cost v <= cost v' <= length H * (2 * n) + cost v.
Proof.
  intros H. induction H as [|h H IH]; simpl; intros log v o u Short E.
  - injection E as <- <-. exists v. repeat split; auto; lia.
  - assert (S' : forall g, In g H -> length (fst (path M g (root M))) <= n) by auto.
    assert (Sh := Short h (or_introl eq_refl)).
    assert (Skip : forall log, test_all M pu log (uncounted v) H = Some (o, u) ->
      exists v', test_all' M pu log v H = Some (o, v') /\ uncounted v' = u /\
      cost v <= cost v' <= 2 * n + length H * (2 * n) + cost v).
    { intros l X. destruct (IH l v o u S' X) as (v' & -> & U & C).
      exists v'. repeat split; auto; lia. }
    destruct (keep M log h); auto. destruct (percept_eqb (percept M h) pu); auto.
    destruct (follow M h (fst (path M h (root M))) (uncounted v)) as [((b, qs), u1)|] eqn:F;
      [|discriminate].
    apply follow_counted in F as (v1 & -> & <- & C1). destruct b.
    + injection E as <- <-. exists v1. repeat split; auto; nia.
    + apply (IH _ v1 o u S') in E as (v' & -> & U & C). exists v'. repeat split; auto; nia.
Qed.

(** If no way is longer than n, a round costs at least 1 and at most n + 1 + (darts - 1) * 2n. *)
Lemma round_counted M p v e n M' p' u : (forall q d, q < darts M -> d < darts M ->
    length (fst (path M q d)) <= n) -> p < darts M -> e < darts M -> root M < darts M ->
  (forall l, Permutation (order M l) l) ->
  round (M, p, uncounted v) e = Some (M', p', u) ->
  exists v', round' (M, p, v) e = Some (M', p', v') /\ uncounted v' = u /\
  S (cost v) <= cost v' <= S n + (darts M - 1) * (2 * n) + cost v.
Proof.
  intros Short Hp He Hr Perm. unfold Mapper.round. assert (Sp := Short p e Hp He).
  destruct (path M p e) as (w, k). simpl in Sp.
  destruct (execute (uncounted v) (w ++ [k])) as [x|] eqn:X; [|discriminate].
  apply execute_counted in X as (v1 & -> & <- & C1). rewrite app_length in C1. simpl in C1.
  change (see_counted (fst v1)) with (see (fst (uncounted v1))). set (pu := see (fst (uncounted v1))).
  set (H := hypotheses order M e pu).
  assert (LH : forall h, In h H -> h < darts M /\ h <> e).
  { intros h I. apply (Permutation_in h (Perm _)), filter_In in I as [I B]. apply in_seq in I.
    apply andb_true_iff in B as [B _]. apply andb_true_iff in B as [B _].
    apply negb_true_iff, Nat.eqb_neq in B. split; [lia|auto]. }
  assert (NH : S (length H) <= darts M).
  { change (S (length H)) with (length (e :: H)). rewrite <- (seq_length (darts M) 0).
    apply NoDup_incl_length.
    - constructor; [intros I; apply LH in I; tauto|].
      apply (Permutation_NoDup (Permutation_sym (Perm _))), NoDup_filter, seq_NoDup.
    - intros a [<-|I]; apply in_seq; [|apply LH in I]; lia. }
  destruct (test_all M pu [] (uncounted v1) H) as [(o, u2)|] eqn:T; [|discriminate].
  apply (test_all_counted M pu n) in T as (v2 & -> & <- & C2).
  2: { intros h I. apply Short; auto. apply LH, I. }
  assert (Bound : length H * (2 * n) <= (darts M - 1) * (2 * n)) by (apply Nat.mul_le_mono_r; lia).
  destruct o as [h|].
  - destruct (walk M h _) as [r|]; [|discriminate]. intros E. injection E as <- <- <-.
    exists v2. repeat split; auto; lia.
  - intros E. injection E as <- <- <-. exists v2. repeat split; auto; lia.
Qed.
End Counted.

Section Bound.
Variables (pick : Map -> nat -> option nat) (path : Map -> nat -> nat -> list nat * nat)
          (order : Map -> list nat -> list nat)
          (keep : Map -> list (list nat * list Percept) -> nat -> bool).
Hypotheses (Gpick : good_pick pick) (Gpath : good_path path) (Gshort : short_path path)
           (Gorder : good_order order) (Gkeep : good_keep keep).
Variable W : Map.
Hypothesis HW : world W.
Let WW := world_is_map W HW.
Let see := see_counted nat (percept W).
Let go := go_counted nat (move W).
Let n := vertices W.

(** The cost of all rounds: r rounds cost at least r and at most r times the bound of a round. *)
Lemma explore_counted fuel : forall M p v, invariant W (M, p, uncounted nat v) ->
  darts W <= 2 * fuel + known M ->
  exists M' p' v' r, explore (nat * nat) see go pick path order keep fuel (M, p, v) = Some (M', p',
    v') /\
  isomorphic M' W /\ darts W = 2 * r + known M /\
  r + cost nat v <= cost nat v' <= r * (n + (darts W - 1) * (2 * (n - 1))) + cost nat v.
Proof.
  induction fuel as [|fuel IH]; simpl; intros M p v I Hf; assert (G := Gpick M p);
    assert (I' := I); destruct I' as (WM & CM & _ & Hp & phi & E & _);
    assert (Size : darts M <= darts W) by (apply (pigeon phi); apply E);
    destruct (pick M p) as [e|].
  - destruct G as [He Oe]. assert (known M < darts M); [|lia]. apply count_lt with e; auto.
    unfold explored. rewrite Oe. auto.
  - assert (Iso := closed_isomorphic M W phi WM E (world_connected W HW) G).
    assert (Eq := proj1 Iso). exists M, p, v, 0.
    split; auto. split; auto. rewrite (known_all M G). lia.
  - destruct G as [He Oe].
    destruct (round_spec path order keep Gpath Gorder Gkeep W HW M p (uncounted nat v) e I He Oe)
      as (M1 & p1 & u1 & R & I1 & K1).
    assert (V := embedded_vertices M W phi WM WW E). fold n in V.
    apply (round_counted nat (percept W) (move W) path order keep M p v e (n - 1)) in R
      as (v1 & R & U & C); auto.
    + unfold see, go. rewrite R. subst u1.
      destruct (IH M1 p1 v1 I1) as (M' & p' & v' & r & X & Iso & D & C'); [lia|].
      exists M', p', v', (S r). split; auto. split; auto. split; [lia|].
      assert ((darts M - 1) * (2 * (n - 1)) <= (darts W - 1) * (2 * (n - 1)))
        by (apply Nat.mul_le_mono_r; lia).
      assert (N1 : 1 <= n) by (assert (Short := Gshort M p e WM CM Hp He); lia).
      simpl. lia.
    + intros q d Hq Hd. assert (H := Gshort M q d WM CM Hq Hd). lia.
    + apply root_lt; auto.
  - assert (Iso := closed_isomorphic M W phi WM E (world_connected W HW) G).
    assert (Eq := proj1 Iso). exists M, p, v, 0.
    split; auto. split; auto. rewrite (known_all M G). lia.
Qed.

(** Claim 7, for all policies with short ways: the map is isomorphic to the world, and the cost
    is within the bound; m is the number of edges, n of vertices. *)
Theorem cost_within_bound : exists m M p v,
  explore (nat * nat) see go pick path order keep (darts W) (initial_state (nat * nat) see (root W, 0)) =
    Some (M, p, v) /\
  isomorphic M W /\ darts W = 2 * m /\
  m <= cost nat v <= m * (n + (2 * m - 1) * (2 * (n - 1))).
Proof.
  destruct (explore_counted (darts W) (initial (degree W (root W))) 0 (root W, 0, 0))
    as (M & p & v & m & X & Iso & D & C); [apply (initial_invariant W HW)|lia|].
  exists m, M, p, v. split; [exact X|]. split; auto.
  assert (known (initial (degree W (root W))) = 0) as Z.
  { unfold known. generalize (darts (initial (degree W (root W)))). intros k.
    induction k as [|k IH]; simpl; auto. }
  rewrite Z in D. split; [lia|]. replace (2 * m - 1) with (darts W - 1) by lia.
  unfold cost in C at 1. simpl in C. unfold cost in *. simpl in *. lia.
Qed.
End Bound.

(** Claim 7 for [basic]. *)
Theorem basic_cost W : world W -> exists m M p v,
  explore (nat * nat) (see_counted nat (percept W)) (go_counted nat (move W)) first_open bfs_path
    (fun _ H => H) rule_none (darts W)
    (initial_state (nat * nat) (see_counted nat (percept W)) (root W, 0)) =
    Some (M, p, v) /\
  isomorphic M W /\ darts W = 2 * m /\
  m <= cost nat v <= m * (vertices W + (2 * m - 1) * (2 * (vertices W - 1))).
Proof.
  apply cost_within_bound; auto using first_open_good, rule_none_good; try apply bfs_path_good.
  intros M l. apply Permutation_refl.
Qed.
