(** The mapper of Mapper.v ends with the world, whatever its policies (claim 5).

    W is the world, M the map, phi their correspondence; v is the robot; e is the dart being
    explored, a the dart of the world behind it, H the hypotheses. The policies fulfil the contracts
    of Mapper.v, and nothing else is known of them.

    The proof is the invariant [invariant]: [initial_invariant] says that it holds at the start,
    [round_spec] that a round keeps it, [explore_invariant] that it holds at the end and implies
    the claim. *)
From Coq Require Import Arith Lia List Bool Permutation.
Import ListNotations.
From Topo Require Import World Rotation Embedding Augment Mapper.

Section Correct.
Variables (pick : Map -> nat -> option nat) (path : Map -> nat -> nat -> list nat * nat)
          (order : Map -> list nat -> list nat)
          (keep : Map -> list (list nat * list Percept) -> nat -> bool).
Hypotheses (Gpick : good_pick pick) (Gpath : good_path path) (Gorder : good_order order)
           (Gkeep : good_keep keep).
Variable W : Map.
Hypothesis HW : world W.
Let WW : is_map W := world_is_map W HW.

Notation go_on := (go_on nat (percept W) (move W)).
Notation go_back := (go_back nat (percept W) (move W)).
Notation execute := (execute nat (percept W) (move W)).
Notation follow := (follow nat (percept W) (move W)).
Notation test_all := (test_all nat (percept W) (move W) path keep).
Notation round := (round nat (percept W) (move W) path order keep).
Notation explore := (explore nat (percept W) (move W) pick path order keep).

(** The dart of the world that the robot faces. *)
Definition current (v : nat * nat) := turn W (snd v) (fst v).

(** The robot is at a dart of the world and has turned by less than the degree. *)
Definition ok (v : nat * nat) := fst v < darts W /\ snd v < degree W (fst v).

(** The robot faces a dart of the world. *)
Lemma ok_current v : ok v -> current v < darts W.
Proof. intros [A _]. apply turn_lt; auto. Qed.

(** [go_on] makes the move of the world from the dart that the robot faces. *)
Lemma go_on_spec v k : ok v -> k < degree W (current v) -> exists s,
  go_on v k = Some (s, 0) /\ ok (s, 0) /\ move W (current v) k = Some s.
Proof.
  destruct v as [a t]. unfold ok, current, Mapper.go_on, move. simpl. intros [La Lt] Hk.
  assert (D := Hk). rewrite degree_turn in D by auto.
  rewrite (proj2 (Nat.ltb_lt _ _) Hk).
  rewrite (proj2 (Nat.ltb_lt ((t + k) mod degree W a) _)) by (apply Nat.mod_upper_bound; lia).
  rewrite turn_mod, Nat.add_comm, turn_add by auto.
  assert (L : turn W k (turn W t a) < darts W) by auto using turn_lt.
  destruct (alpha W (turn W k (turn W t a))) as [s|] eqn:Es; [|destruct (world_total W HW _ L Es)].
  exists s. assert (Ls : s < darts W) by (eapply alpha_ok; eauto).
  repeat split; auto. apply degree_spec; auto.
Qed.

(** [go_back] undoes a move: afterwards the robot faces the dart from which it left. *)
Lemma go_back_spec v a k : ok v -> a < darts W -> move W a k = Some (current v) ->
  exists v', go_back v k = Some v' /\ ok v' /\ current v' = a.
Proof.
  destruct v as [s t]. unfold ok, current, Mapper.go_back, move. simpl. intros [Ls Lt] La Hm.
  destruct (Nat.ltb_spec k (degree W a)) as [Hk|]; [|discriminate].
  apply (alpha_ok W WW) in Hm; auto using turn_lt. destruct Hm as (_ & _ & Hm).
  rewrite (proj2 (Nat.ltb_lt _ _) Lt), Hm.
  eexists. split; [reflexivity|]. simpl. rewrite degree_turn by auto.
  repeat split; auto using turn_lt.
  - apply Nat.mod_upper_bound. lia.
  - rewrite <- (degree_turn W WW k a) at 2 by auto.
    rewrite turn_mod, <- turn_add by auto using turn_lt.
    replace (degree W a - k + k) with (degree W a) by lia. apply degree_spec; auto.
Qed.

(** [execute] makes the walk of the world. *)
Lemma execute_spec w k : forall v b, ok v -> walk W (current v) (w ++ [k]) = Some b ->
  execute v (w ++ [k]) = Some (b, 0) /\ ok (b, 0).
Proof.
  induction w as [|j w IH]; simpl; intros v b Hv Hw.
  - destruct (move W (current v) k) as [x|] eqn:Em; [|discriminate].
    destruct (go_on_spec v k Hv) as (s & -> & Hs & Em'); [eapply move_door; eauto|].
    replace b with s by congruence. auto.
  - destruct (move W (current v) j) as [x|] eqn:Em; [|discriminate].
    destruct (go_on_spec v j Hv) as (s & -> & Hs & Em'); [eapply move_door; eauto|].
    apply IH; auto. unfold current. simpl. congruence.
Qed.

(** Validation by motion returns the percepts of the world along w. If all agree with the map,
    the robot is at the end of w; else it is back where it began, and the hypothesis is false for
    every correspondence. *)
Lemma follow_spec M (WM : is_map M) w : forall x v r, ok v -> x < darts M ->
  percept M x = percept W (current v) -> walk M x w = Some r ->
  exists b qs v', follow M x w v = Some (b, qs, v') /\ ok v' /\
    percepts W (current v) (firstn (length qs) w) = Some qs /\
    if b then walk W (current v) w = Some (current v') /\ percept M r = percept W (current v')
    else current v' = current v /\ forall phi, embedded M W phi -> phi x <> current v.
Proof.
  induction w as [|k w IH]; simpl; intros x v r Hv Hx Hp Hw.
  - exists true, [], v. injection Hw as <-. simpl. auto.
  - destruct (move M x k) as [y|] eqn:Ey; [|discriminate].
    assert (Hk : k < degree W (current v)) by (injection Hp as <- _; eapply move_door; eauto).
    destruct (go_on_spec v k Hv Hk) as (s & -> & Hs & Em). simpl.
    assert (Hy : y < darts M) by (eapply move_lt; eauto).
    assert (Back : forall v', ok v' -> current v' = s ->
      exists v2, go_back v' k = Some v2 /\ ok v2 /\ current v2 = current v).
    { intros v' Hv' <-. apply go_back_spec; auto using ok_current. }
    destruct (percept_eqb_spec (percept M y) (percept W s)) as [Eq|Ne].
    + destruct (IH y (s, 0) r Hs Hy Eq Hw) as (b & qs & v' & -> & Hv' & Hq & Hb).
      change (current (s, 0)) with s in *. destruct b.
      * exists true, (percept W s :: qs), v'. simpl. rewrite Em, Hq. auto.
      * destruct Hb as [Ec Hn]. destruct (Back v' Hv' Ec) as (v2 & -> & Hv2 & Ec2).
        exists false, (percept W s :: qs), v2. simpl. rewrite Em, Hq. repeat split; auto; try apply Hv2.
        intros phi HE Ephi. apply (Hn phi HE). apply (embedded_move M W phi) in Ey; auto. congruence.
    + destruct (Back (s, 0) Hs eq_refl) as (v2 & -> & Hv2 & Ec2).
      exists false, [percept W s], v2. simpl. rewrite Em. repeat split; auto; try apply Hv2.
      intros phi HE Ephi. apply Ne. apply (embedded_move M W phi) in Ey; auto.
      rewrite <- (percept_agree M W phi) by auto. congruence.
Qed.

(** Testing returns the true hypothesis, and the robot is where the map says; or it returns None,
    and no hypothesis is true. *)
Lemma test_all_spec M phi a (WM : is_map M) (CM : connected M) (E : embedded M W phi) : forall H log v,
  ok v -> current v = a -> (forall h, In h H -> h < darts M) ->
  (forall w ps, In (w, ps) log -> percepts W a w = Some ps) ->
  exists o v', test_all M (percept W a) log v H = Some (o, v') /\ ok v' /\
    match o with
    | Some h => In h H /\ phi h = a /\
                exists r, walk M h (fst (path M h (root M))) = Some r /\ current v' = phi r
    | None => current v' = a /\ forall h, In h H -> phi h <> a
    end.
Proof.
  intros H. induction H as [|h H IH]; simpl; intros log v Hv Ha HH Hlog.
  { exists None, v. repeat split; auto; apply Hv. }
  assert (Skip : phi h <> a -> forall log v, ok v -> current v = a ->
    (forall w ps, In (w, ps) log -> percepts W a w = Some ps) ->
    exists o v', test_all M (percept W a) log v H = Some (o, v') /\ ok v' /\
    match o with
    | Some h' => (h = h' \/ In h' H) /\ phi h' = a /\
                exists r, walk M h' (fst (path M h' (root M))) = Some r /\ current v' = phi r
    | None => current v' = a /\ forall h', h = h' \/ In h' H -> phi h' <> a
    end).
  { intros N log' u Hu Hua Hl.
    destruct (IH log' u Hu Hua (fun h Hh => HH h (or_intror Hh)) Hl) as (o & u' & -> & Hu' & Ho).
    exists o, u'. repeat split; auto; try apply Hu'. destruct o as [h'|].
    - destruct Ho as (A & B & C). auto.
    - destruct Ho as [A B]. split; auto. intros h' [<-|Hh]; auto. }
  assert (Lh : h < darts M) by auto.
  destruct (keep M log h) eqn:K.
  2: { apply Skip; auto. intros Eh. rewrite (Gkeep M W phi a log h) in K; auto. discriminate. }
  destruct (percept_eqb_spec (percept M h) (percept W a)) as [Ep|Np].
  2: { apply Skip; auto. intros <-. apply Np. symmetry. apply percept_agree; auto. }
  destruct (Gpath M h (root M) WM CM Lh (root_lt M WM)) as (r & Hr & Hk & Er).
  rewrite <- Ha in Ep. destruct (follow_spec M WM _ h v r Hv Lh Ep Hr)
    as ([] & qs & v' & -> & Hv' & Hq & Hb).
  - destruct Hb as [Hw Hp]. exists (Some h), v'.
    destruct (marker_of M r _ Hk Er) as [j Hj].
    assert (Eh : current v = phi h).
    { apply (confirm M W phi WM WW E (current v) h (fst (path M h (root M))) (current v') r j);
        auto using ok_current. injection Hp as _ Hp. congruence. }
    repeat split; auto; try apply Hv'; [congruence|]. exists r. split; auto.
    apply (forward_walk M W phi) in Hr; auto. rewrite <- Eh, Hw in Hr. congruence.
  - destruct Hb as [Hc Hn]. apply Skip; auto; [rewrite <- Ha; auto|congruence|].
    intros w ps [Eq|Hin]; auto. injection Eq as <- <-. congruence.
Qed.

(** The invariant of exploration: the map is well formed, connected and embedded in the world,
    and the robot faces the dart of the world that corresponds to the map's dart p. *)
Definition invariant (st : Map * nat * (nat * nat)) := let '(M, p, v) := st in
  is_map M /\ connected M /\ ok v /\ p < darts M /\ exists phi, embedded M W phi /\ current v = phi p.

(** The invariant holds at the start. *)
Lemma initial_invariant : invariant (initial_state nat (percept W) (root W)).
Proof.
  assert (R := root_lt W WW). destruct (degree_spec W WW _ R) as (A & B & C).
  refine (conj (is_map_initial _ A) (conj (connected_initial _ A) (conj (conj R A) (conj A _)))).
  exists (fun x => turn W x (root W)). split; [apply embedded_initial|]; auto.
Qed.

(** A round keeps the invariant and explores two more darts. *)
Lemma round_spec M p v e : invariant (M, p, v) -> e < darts M -> alpha M e = None ->
  exists M' p' v', round (M, p, v) e = Some (M', p', v') /\ invariant (M', p', v') /\
    known M' = 2 + known M.
Proof.
  intros (WM & CM & Hv & Hp & phi & E & Hcur) He Oe. unfold Mapper.round.
  assert (G := Gpath M p e WM CM Hp He). destruct (path M p e) as [w k].
  destruct G as (q & Hw & Hk & Eq). simpl in *.
  assert (Lq := walk_lt M WM w p q Hp Hw).
  destruct (alpha W (phi e)) as [a|] eqn:Ha;
    [|destruct (world_total W HW (phi e) (phi_lt _ _ _ E e He) Ha)].
  assert (La : a < darts W) by (eapply alpha_ok; eauto; apply (phi_lt _ _ _ E); auto).
  assert (Hwk : walk W (current v) (w ++ [k]) = Some a).
  { rewrite Hcur, walk_app, (forward_walk M W phi WM WW E w p q) by auto. simpl.
    unfold move. rewrite (embedded_degree M W phi) by auto.
    rewrite (proj2 (Nat.ltb_lt _ _) Hk), <- (embedded_turn M W phi), Eq, Ha by auto. auto. }
  destruct (execute_spec w k v a Hv Hwk) as [-> Ok]. simpl fst.
  set (H := hypotheses order M e (percept W a)).
  assert (HH : forall h, In h H <-> h < darts M /\ h <> e /\ alpha M h = None /\
                          same_signature (percept M h) (percept W a) = true).
  { intros h. assert (P := fun l => conj (Permutation_in h (Gorder M l))
      (Permutation_in h (Permutation_sym (Gorder M l)))).
    unfold H, hypotheses. rewrite (P _ : In h (order M _) <-> In h _), filter_In, in_seq, !andb_true_iff.
    unfold explored. destruct (alpha M h), (Nat.eqb_spec h e); simpl; intuition (try lia; congruence). }
  destruct (test_all_spec M phi a WM CM E H [] (a, 0) Ok eq_refl) as ([h|] & v' & -> & Hv' & Ho).
  { intros h Hh. apply HH, Hh. }
  { simpl. tauto. }
  - destruct Ho as (Hin & Eh & r & Hr & Er). rewrite Hr.
    apply HH in Hin as (Lh & Nh & Oh & _).
    exists (augment_loop M e h), r, v'. split; auto. split.
    + refine (conj (is_map_loop M e h WM He Lh Nh Oe Oh) (conj (connected_loop M e h Oe Oh CM)
        (conj Hv' (conj (walk_lt M WM _ h r Lh Hr) _)))).
      exists phi. split; auto. apply embedded_loop; auto. congruence.
    + apply loop_two_more; auto.
  - destruct Ho as [Ec Hn]. destruct (degree_spec W WW a La) as (D & _).
    assert (N : is_new M phi a).
    { intros h Lh Eh. apply (Hn h); auto. apply HH.
      destruct (posed M W phi WM WW E e a h He Oe Ha Lh Eh) as (A & B & C).
      repeat split; auto. rewrite C. apply same_signature_refl. }
    exists (augment_new M e (degree W a)), (darts M), v'. split; auto. split.
    + refine (conj (is_map_new M e _ WM He Oe D) (conj (connected_new M e _ WM He Oe CM)
        (conj Hv' (conj _ _)))); [simpl; lia|].
      exists (extend phi (darts M) W a). split; [apply embedded_new; auto|].
      unfold extend. rewrite Nat.ltb_irrefl, Nat.sub_diag. auto.
    + apply new_two_more; auto.
Qed.

(** From every state with the invariant, and with fuel for the edges left, exploration ends with
    a map isomorphic to the world. *)
Lemma explore_invariant fuel : forall M p v, invariant (M, p, v) -> darts W <= 2 * fuel + known M ->
  exists st, explore fuel (M, p, v) = Some st /\ isomorphic (fst (fst st)) W.
Proof.
  assert (Size : forall M p v, invariant (M, p, v) -> darts M <= darts W).
  { intros M p v (_ & _ & _ & _ & phi & E & _). apply (pigeon phi); apply E. }
  induction fuel as [|fuel IH]; simpl; intros M p v I Hf;
    assert (G := Gpick M p); destruct (pick M p) as [e|].
  - destruct G as [He Oe]. apply Size in I.
    assert (known M < darts M); [|lia]. apply count_lt with e; auto.
    unfold explored. rewrite Oe. auto.
  - exists (M, p, v). split; auto. destruct I as (WM & CM & _ & _ & phi & E & _).
    apply (closed_isomorphic M W phi); auto. apply world_connected; auto.
  - destruct G as [He Oe].
    destruct (round_spec M p v e I He Oe) as (M' & p' & v' & -> & I' & K).
    apply IH; auto. lia.
  - exists (M, p, v). split; auto. destruct I as (WM & CM & _ & _ & phi & E & _).
    apply (closed_isomorphic M W phi); auto. apply world_connected; auto.
Qed.

(** Claim 5: in every world, and for all policies that fulfil their contracts, exploration ends
    after at most as many rounds as the world has edges, with a map isomorphic to the world. *)
Theorem explore_correct fuel : darts W <= 2 * fuel -> exists st,
  explore fuel (initial_state nat (percept W) (root W)) = Some st /\ isomorphic (fst (fst st)) W.
Proof.
  intros Hf. assert (I := initial_invariant). unfold initial_state in *.
  eapply explore_invariant; eauto. lia.
Qed.
End Correct.
