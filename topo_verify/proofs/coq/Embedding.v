(** One hypothesis, in both directions: claims 2, 3, 4 and 5 (docs/semantics.md, sections 6 and 9).

    M is the map so far (S in docs/semantics.md), W the world, phi: M -> W the correspondence of
    their darts. e is an open dart, a the dart of the world behind it, h a hypothesis: the claim
    that e leads to h, that is phi h = a.

    From M to W: what M predicts, W shows, so a true hypothesis is never contradicted. From W to
    M: walks are injective, so a walk that ends at the marker, facing in the right direction,
    began at the dart where it was believed to begin. *)
From Coq Require Import Arith Lia List Bool.
Import ListNotations.
From Topo Require Import World Rotation.

Section Embedding.
Variables (M W : Map) (phi : nat -> nat).
Hypotheses (WM : is_map M) (WW : is_map W) (E : embedded M W phi).

(** The correspondence commutes with turning. *)
Lemma embedded_turn k d : d < darts M -> phi (turn M k d) = turn W k (phi d).
Proof.
  intros Hd. induction k as [|k IH]; simpl; auto. rewrite (phi_sigma _ _ _ E), IH; auto using turn_lt.
Qed.

(** Corresponding darts have the same degree. *)
Lemma embedded_degree d : d < darts M -> degree W (phi d) = degree M d.
Proof.
  intros Hd. destruct (degree_spec M WM d Hd) as (A & B & C).
  apply degree_unique; auto using (phi_lt _ _ _ E).
  - rewrite <- embedded_turn, B; auto.
  - intros k Hk H. rewrite <- embedded_turn in H by auto.
    apply (C k Hk). apply (phi_inj _ _ _ E) in H; auto using turn_lt.
Qed.

(** Corresponding darts show the same percept (claim 1). *)
Theorem percept_agree d : d < darts M -> percept W (phi d) = percept M d.
Proof.
  intros Hd. unfold percept, marker. rewrite embedded_degree by auto. f_equal.
  apply find_ext. intros j. rewrite <- embedded_turn, <- (phi_root _ _ _ E) by auto.
  destruct (Nat.eqb_spec (turn M j d) (root M)) as [->|N]; [apply Nat.eqb_refl|].
  apply Nat.eqb_neq. intros H. apply N, (phi_inj _ _ _ E); auto using turn_lt, root_lt.
Qed.

(** A move on M is a move in W between the corresponding darts. *)
Lemma embedded_move d k x : d < darts M -> move M d k = Some x -> move W (phi d) k = Some (phi x).
Proof.
  unfold move. intros Hd H. rewrite embedded_degree by auto.
  destruct (k <? degree M d); [|discriminate].
  rewrite <- embedded_turn by auto. apply (phi_alpha _ _ _ E); auto using turn_lt.
Qed.

(** A walk on M is a walk in W between the corresponding darts. *)
Theorem forward_walk w : forall d x, d < darts M ->
  walk M d w = Some x -> walk W (phi d) w = Some (phi x).
Proof.
  induction w as [|k w IH]; simpl; intros d x Hd H; [congruence|].
  destruct (move M d k) as [y|] eqn:Em; [|discriminate].
  rewrite (embedded_move _ _ _ Hd Em). apply IH; auto. eapply move_lt; eauto.
Qed.

(** Claim 3: as long as the walk stays on explored darts of the map, the robot senses exactly
    what the map predicts. So a true hypothesis is kept.
    Paper, II-C: The expected perception is the row of signatures on that way. *)
Theorem forward w : forall d ps, d < darts M ->
  percepts M d w = Some ps -> percepts W (phi d) w = Some ps.
Proof.
  induction w as [|k w IH]; simpl; intros d ps Hd H; [congruence|].
  destruct (move M d k) as [y|] eqn:Em; [|discriminate].
  assert (Hy : y < darts M) by (eapply move_lt; eauto).
  rewrite (embedded_move _ _ _ Hd Em), percept_agree by auto.
  destruct (percepts M y w) as [qs|] eqn:Eq; [|discriminate].
  rewrite (IH _ _ Hy Eq). auto.
Qed.

(** Claim 3, by motion: if a percept differs from what M predicts for h, e does not lead to h.
    Paper, II-C: At the first mismatch the hypothesis is rejected, and the robot goes back to vu.
    *)
Corollary mismatch_refutes e h a w ps : h < darts M ->
  alpha W (phi e) = Some a -> percepts M h w = Some ps -> percepts W a w <> Some ps ->
  alpha W (phi e) <> Some (phi h).
Proof. intros Hh Ha Hs Hw H. apply Hw. replace a with (phi h) by congruence. apply forward; auto. Qed.

(** Claim 4: a confirmed hypothesis is true. Of the percepts only the last one is used: it shows
    the marker in the predicted direction.
    Paper, II-C: If all match up to the marker's direction at v0, the hypothesis is confirmed. *)
Theorem confirm a h w c r j : a < darts W -> h < darts M ->
  walk W a w = Some c -> walk M h w = Some r ->
  marker M r = Some j -> marker W c = Some j -> a = phi h.
Proof.
  intros Ha Hh Hw Hs Hr Hc.
  assert (Lr : r < darts M) by (eapply walk_lt; eauto).
  assert (Lc : c < darts W) by (eapply walk_lt; eauto).
  apply marker_some in Hr, Hc; auto.
  apply (walk_inj W WW w a (phi h) (phi r)); auto using (phi_lt _ _ _ E), forward_walk.
  rewrite Hw. f_equal. apply (turn_inj W WW j); auto using (phi_lt _ _ _ E).
  rewrite <- embedded_turn, Hr, Hc by auto. symmetry. apply (phi_root _ _ _ E).
Qed.

(** Claim 2: if the true end h of the open dart e is known, h is open, differs from e, and shows
    the percept of the place where the robot arrived. So h is among the hypotheses.
    Paper, II-C: Each unexplored edge whose known end has the signature of vu is a hypothesis. *)
Theorem posed e a h : e < darts M -> alpha M e = None -> alpha W (phi e) = Some a ->
  h < darts M -> phi h = a -> h <> e /\ alpha M h = None /\ percept M h = percept W a.
Proof.
  intros He Oe Ha Hh <-. repeat split.
  - intros ->. apply (alpha_ok W WW) in Ha; auto using (phi_lt _ _ _ E). apply Ha; auto.
  - destruct (alpha M h) as [x|] eqn:Ex; auto. exfalso.
    assert (Hx := phi_alpha _ _ _ E _ _ Hh Ex).
    apply (alpha_ok W WW) in Ha; auto using (phi_lt _ _ _ E). destruct Ha as (_ & _ & Ha).
    apply (alpha_ok M WM) in Ex; auto. destruct Ex as (Lx & _ & Ex).
    assert (x = e) by (apply (phi_inj _ _ _ E); auto; congruence). congruence.
  - symmetry. apply percept_agree; auto.
Qed.

(** Claim 5: an embedded map without open darts is isomorphic to a connected world. *)
Theorem closed_isomorphic : connected W -> (forall d, d < darts M -> alpha M d <> None) ->
  isomorphic M W.
Proof.
  intros HC Hc.
  assert (Onto : forall b, b < darts W -> exists d, d < darts M /\ phi d = b).
  { intros b Hb. apply HC in Hb. induction Hb as [|b _ (d & Hd & <-)|b c _ (d & Hd & <-) Hal].
    - exists (root M). split; [apply root_lt; auto|apply (phi_root _ _ _ E)].
    - exists (sigma M d). split; [apply sigma_lt; auto|apply (phi_sigma _ _ _ E); auto].
    - destruct (alpha M d) as [x|] eqn:Ex; [|destruct (Hc d); auto].
      exists x. split; [eapply alpha_ok; eauto|]. apply (phi_alpha _ _ _ E) in Ex; auto. congruence. }
  split.
  2: { exists phi. split; [exact E|split; [exact Onto|]]. intros d Hd.
       destruct (alpha M d) as [x|] eqn:Ex; [apply (phi_alpha _ _ _ E); auto|destruct (Hc d); auto]. }
  apply Nat.le_antisymm.
  - apply (pigeon phi); apply E.
  - set (inv := fun b => match find (fun d => phi d =? b) (seq 0 (darts M)) with
                         | Some d => d | None => 0 end).
    assert (Hinv : forall b, b < darts W -> inv b < darts M /\ phi (inv b) = b).
    { intros b Hb. unfold inv. destruct (find _ _) as [d|] eqn:F.
      - apply find_seq in F as (A & B & _). apply Nat.eqb_eq in B. split; auto; lia.
      - exfalso. destruct (Onto b Hb) as (d & Hd & Ed).
        assert (F' := find_none _ _ F d). cbv beta in F'.
        rewrite Ed, Nat.eqb_refl in F'. discriminate F'. apply in_seq; lia. }
    apply (pigeon inv); [apply Hinv|].
    intros i j Hi Hj Eij. destruct (Hinv i Hi) as [_ <-], (Hinv j Hj) as [_ <-]. congruence.
Qed.
End Embedding.
(** Claim 5: a connected map is embedded in a world in at most one way, since a rooted map has no
    automorphism but the identity.
    Paper, II-C: When U is empty, S is isomorphic to the world. *)
Theorem embedded_unique M W phi psi : connected M -> is_map M -> embedded M W phi -> embedded M W psi ->
  forall d, d < darts M -> phi d = psi d.
Proof.
  intros CM WM E F d Hd. assert (R := CM d Hd). revert Hd.
  assert (L := fun x => reach_sym M (root M) x WM (root_lt M WM)).
  induction R as [|x R IH|x y R IH Hy]; intros Hd.
  - rewrite (phi_root _ _ _ E), (phi_root _ _ _ F). auto.
  - destruct (L x R) as [Lx _]. rewrite (phi_sigma _ _ _ E), (phi_sigma _ _ _ F), IH; auto.
  - destruct (L x R) as [Lx _]. assert (A := phi_alpha _ _ _ E x y Lx Hy).
    assert (B := phi_alpha _ _ _ F x y Lx Hy). rewrite IH in A by auto. congruence.
Qed.
