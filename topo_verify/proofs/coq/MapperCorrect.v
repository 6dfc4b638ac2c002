(** The mapper of Mapper.v ends with the world, whatever its policies, its motion and its rule; and
    what that costs (claims 5 and 7).

    W is the world, M the map, phi their correspondence; v is the robot, b its reference dart in W;
    e is the dart being explored, a the dart of the world behind it, H the hypotheses; T is what the
    rule remembers, t the trail, u the trail behind e. The policies, the motion and the rule fulfil the
    contracts of Mapper.v, and nothing else is known of them.

    The proof is the invariant [invariant]: [initial_invariant] says that it holds at the start,
    [round_spec] that a round keeps it, [explore_invariant] that it holds at the end and implies
    the claim. Each of the m rounds walks to e, which takes at most n - 1 moves, crosses it, and tests
    at most 2m - 1 hypotheses with at most 2(n - 1) moves each. *)
From Coq Require Import Arith Lia List Bool Permutation.
Import ListNotations.
From Topo Require Import World Rotation Embedding Vertices Augment Program Mapper Validation.

Section Correct.
Variables (pick : Map -> nat -> option nat) (path : Map -> nat -> nat -> list nat * nat)
          (order : Map -> list nat -> list nat) (motion : Motion) (rule : Rule)
          (true_of : Map -> Map -> (nat -> nat) -> robot_trail -> memory rule -> Prop).
Hypotheses (Gpick : good_pick pick) (Gpath : good_path path) (Gorder : good_order order)
           (Gmotion : good_motion motion) (Grule : good_rule rule true_of).
Variable W : Map.
Hypothesis HW : world W.
Let WW : is_map W := world_is_map W HW.

(** The invariant of exploration: the map is well formed, connected and embedded in the world, the
    robot faces the dart of the world that corresponds to the map's dart p, the trail led to where it
    is, and what the rule remembers is true. *)
Definition invariant (st : state rule) b := let '(M, p, v, T, t) := st in
  is_map M /\ connected M /\ p < darts M /\ led W t b /\
  exists phi, embedded M W phi /\ true_of M W phi t T /\ facing W v b (phi p).

(** The invariant holds at the start. *)
Lemma initial_invariant : invariant (initial_state rule (percept W (root W))) (root W).
Proof.
  assert (R := root_lt W WW). destruct (degree_spec W WW _ R) as (A & B & C).
  assert (E := embedded_initial W WW).
  refine (conj (is_map_initial _ A) (conj (connected_initial _ A) (conj A (conj (conj eq_refl
    eq_refl) (ex_intro _ _ (conj E (conj _ _))))))); [|unfold facing; simpl; auto].
  apply (fresh_true rule true_of Grule); auto. apply is_map_initial, A.
Qed.

(** H contains exactly the darts that can be the other end of e. *)
Lemma hypotheses_spec M e q h : In h (hypotheses order M e q) <->
  h < darts M /\ h <> e /\ alpha M h = None /\ same_signature (percept M h) q = true.
Proof.
  assert (P := fun l => conj (Permutation_in h (Gorder M l))
    (Permutation_in h (Permutation_sym (Gorder M l)))).
  unfold hypotheses. rewrite (P _ : In h (order M _) <-> In h _), filter_In, in_seq, !andb_true_iff.
  unfold explored. destruct (alpha M h), (Nat.eqb_spec h e); simpl; intuition (try lia; congruence).
Qed.

(** There are fewer hypotheses than darts. *)
Lemma hypotheses_less M e q : e < darts M -> S (length (hypotheses order M e q)) <= darts M.
Proof.
  intros He. set (H := hypotheses order M e q).
  change (S (length H)) with (length (e :: H)). rewrite <- (seq_length (darts M) 0).
  apply NoDup_incl_length.
  - constructor; [intros I; apply hypotheses_spec in I; tauto|].
    apply (Permutation_NoDup (Permutation_sym (Gorder M _))), NoDup_filter, seq_NoDup.
  - intros h [<-|I]; apply in_seq; [|apply hypotheses_spec in I]; lia.
Qed.

(** A round keeps the invariant and explores two more darts, at a cost of at least 1 and at most
    n + (darts - 1) * 2(n - 1), where n is the number of vertices of the map. *)
Lemma round_spec M p v T t b e : invariant (M, p, v, T, t) b -> e < darts M -> alpha M e = None ->
  does W b (round path order motion rule (M, p, v, T, t) e) (fun st b' cost => invariant st b' /\
    known (map_in rule st) = 2 + known M /\
    1 <= cost <= vertices M + (darts M - 1) * (2 * (vertices M - 1))).
Proof.
  intros (WM & CM & Hp & Lt & phi & E & HT & Hv) He Oe. unfold round.
  destruct (Gpath M p e WM CM Hp He) as (Sp & q & Hw & Hk & Eq). destruct (path M e p) as (w, k).
  simpl in Sp, Hw, Hk, Eq. assert (Lq := walk_lt M WM w p q Hp Hw).
  destruct (alpha W (phi e)) as [a|] eqn:Ha;
    [|destruct (world_total W HW (phi e) (phi_lt _ _ _ E e He) Ha)].
  assert (La : a < darts W) by (eapply alpha_ok; eauto; apply (phi_lt _ _ _ E); auto).
  assert (Hwk : walk W (phi p) (w ++ [k]) = Some a).
  { rewrite walk_app, (forward_walk M W phi WM WW E w p q) by auto. simpl.
    unfold move. rewrite (embedded_degree M W phi) by auto.
    rewrite (proj2 (Nat.ltb_lt _ _) Hk), <- (embedded_turn M W phi), Eq, Ha by auto. auto. }
  eapply does_bind; [apply does_with_trail; auto; apply (execute_spec W HW w k v b (phi p) a Hv Hwk)|].
  intros (r, u) b1 n1 ((-> & Hr & ->) & Hu & Lu). simpl fst in *; simpl snd in *.
  assert (Eu : fst r = percept W a) by apply Hr. rewrite Eu.
  set (home := path M (root M)). set (H := hypotheses order M e (percept W a)).
  assert (Home : forall g, In g (map (fun h => (h, fst (home h))) H) ->
    leads_home M (vertices M - 1) g /\ In (fst g) H /\ snd g = fst (home (fst g))).
  { intros g I. apply in_map_iff in I as (h & <- & I). split; [|auto].
    apply hypotheses_spec in I as (Lh & _).
    destruct (Gpath M h (root M) WM CM Lh (root_lt M WM)) as (Sh & x & Hx & Hj & Ex).
    repeat split; simpl; auto; [fold home in Sh; lia|]. exists x. eauto. }
  assert (NH := hypotheses_less M e (percept W a) He). fold H in NH.
  eapply does_bind.
  { apply (test_all_spec motion rule true_of Gmotion Grule M W phi T t e a WM HW E HT He Oe Ha
      (vertices M - 1) _ [] [] [] r u a a); auto; [intros s []|intros g I; apply Home, I]. }
  intros ((o, log), (r', t')) b2 n2 (Hlog & Ht' & Lt' & Hc & Ho). rewrite map_length in Hc. simpl in Hc.
  assert (B : length H * (2 * (vertices M - 1)) <= (darts M - 1) * (2 * (vertices M - 1)))
    by (apply Nat.mul_le_mono_r; lia).
  destruct o as [(h, x)|].
  - destruct Ho as (Eh & (w' & I) & Lx & Hr'). apply Home in I as (_ & I & _). simpl in I.
    apply hypotheses_spec in I as (Lh & Nh & Oh & _).
    assert (Hal : alpha W (phi e) = Some (phi h)) by congruence.
    assert (WL := is_map_loop M e h WM He Lh Nh Oe Oh). assert (EL := embedded_loop M W phi e h WW E He
      Lh Hal).
    apply does_return. split; [|split; [apply loop_two_more; auto|lia]].
    refine (conj WL (conj (connected_loop M e h Oe Oh CM) (conj Lx (conj Lt'
      (ex_intro _ phi (conj EL (conj _ Hr'))))))).
    apply (loop_true rule true_of Grule) with t; auto; rewrite Eh; auto.
  - destruct Ho as [Hr' Hn]. destruct (degree_spec W WW a La) as (D & _).
    assert (N : is_new M phi a).
    { intros h Lh Eh. destruct (posed M W phi WM WW E e a h He Oe Ha Lh Eh) as (A & A' & A'').
      apply (Hn (h, fst (home h))); auto. apply in_map_iff. exists h. split; auto.
      apply hypotheses_spec. repeat split; auto. rewrite A''. apply same_signature_refl. }
    assert (WN := is_map_new M e _ WM He Oe D). assert (EN := embedded_new M W phi e a WM WW E He Ha N).
    apply does_return. split; [|split; [apply new_two_more; auto|lia]].
    refine (conj WN (conj (connected_new M e _ WM He Oe CM) (conj _ (conj Lt' (ex_intro _ _
      (conj EN (conj _ _))))))).
    + simpl. lia.
    + apply (new_true rule true_of Grule) with t; auto.
    + unfold extend. rewrite Nat.ltb_irrefl, Nat.sub_diag. auto.
Qed.

(** From every state with the invariant, and with fuel for the edges left, exploration delivers a
    map isomorphic to the world. The r rounds cost at least r and at most r times the bound of a
    round. *)
Lemma explore_invariant fuel : forall st b, invariant st b ->
  darts W <= 2 * fuel + known (map_in rule st) ->
  does W b (explore pick path order motion rule fuel st) (fun M _ cost => isomorphic M W /\
    exists r, darts W = 2 * r + known (map_in rule st) /\
    r <= cost <= r * (vertices W + (darts W - 1) * (2 * (vertices W - 1)))).
Proof.
  induction fuel as [|fuel IH]; intros ((((M, p), v), T), t) b I Hf; simpl in *;
    assert (G := Gpick M p); assert (I' := I); destruct I' as (WM & CM & Hp & _ & phi & E & _);
    assert (Size : darts M <= darts W) by (apply (pigeon phi); apply E);
    destruct (pick M p) as [e|].
  1: { destruct G as [He Oe]. assert (known M < darts M); [|lia]. apply count_lt with e; auto.
       unfold explored. rewrite Oe. auto. }
  1, 3: assert (Iso := closed_isomorphic M W phi WM E (world_connected W HW) G);
        apply does_return; split; auto; exists 0; rewrite (known_all M G), (proj1 Iso); lia.
  destruct G as [He Oe].
  assert (V := embedded_vertices M W phi WM WW E).
  eapply does_bind; [apply (round_spec M p v T t b e I He Oe)|].
  intros st b1 n1 (I1 & K1 & C1). eapply does_weaken; [apply (IH st b1 I1); lia|].
  intros M' b2 n2 (Iso & r & D & C2). split; auto. exists (S r). split; [lia|].
  set (n := vertices W) in *.
  assert (B : (darts M - 1) * (2 * (vertices M - 1)) <= (darts W - 1) * (2 * (n - 1)))
    by (apply Nat.mul_le_mono; lia).
  simpl. lia.
Qed.

(** The mapper as a whole: it begins with what is sensed at the start. *)
Definition mapper fuel : Percept -> program Map :=
  fun q => explore pick path order motion rule fuel (initial_state rule q).

(** Claims 5 and 7: in every world, and for all policies, motions and rules that fulfil their
    contracts, exploration ends after at most as many rounds as the world has edges, with a map
    isomorphic to the world. It costs at least m moves and at most m (n + (2m - 1) 2(n - 1)), where
    the world has m edges and n vertices.
    Paper, I, II-C: With a directional marker the world can be mapped deterministically. *)
Theorem explore_correct fuel : darts W <= 2 * fuel ->
  does W (root W) (mapper fuel (percept W (root W))) (fun M _ cost =>
    isomorphic M W /\ exists m, darts W = 2 * m /\
    m <= cost <= m * (vertices W + (2 * m - 1) * (2 * (vertices W - 1)))).
Proof.
  intros Hf. eapply does_weaken; [apply (explore_invariant fuel _ _ initial_invariant); lia|].
  intros M b n (Iso & r & D & C). split; auto. exists r.
  change (darts W = 2 * r + known (initial (degree W (root W)))) in D.
  assert (Z : known (initial (degree W (root W))) = 0).
  { unfold known. generalize (darts (initial (degree W (root W)))). intros k.
    induction k as [|k IH]; simpl; auto. }
  rewrite Z in D. split; [lia|]. replace (2 * r - 1) with (darts W - 1) by lia. exact C.
Qed.
End Correct.
