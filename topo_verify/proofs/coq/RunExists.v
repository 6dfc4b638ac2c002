(** Every world has a justified run to its end: every false hypothesis can be refuted by walking
    (claim 8).

    M is the map so far, T the table of records, W the world, phi their correspondence; h is a
    hypothesis, a the dart of the world behind the open dart e.

    So [run_isomorphic] is not vacuous, and an exploration that rejects until at most one
    hypothesis is left ends. *)
From Coq Require Import Arith Lia List Bool.
Import ListNotations.
From Topo Require Import World Rotation Embedding Augment Records Folding Run.

(** Every dart that can be reached can be walked to: some doors lead to its vertex. *)
Lemma reach_walk M p d : is_map M -> p < darts M -> reach M p d ->
  exists w q k, walk M p w = Some q /\ k < degree M q /\ turn M k q = d.
Proof.
  intros WM Hp. induction 1 as [|d _ (w & q & k & Hw & Hk & <-)|d e _ (w & q & k & Hw & Hk & <-) He].
  - exists [], p, 0. repeat split. apply degree_spec; auto.
  - assert (Lq := walk_lt M WM w p q Hp Hw). exists w, q, (S k mod degree M q).
    rewrite turn_mod by auto. repeat split; auto. apply Nat.mod_upper_bound. lia.
  - assert (Lq := walk_lt M WM w p q Hp Hw). exists (w ++ [k]), e, 0.
    rewrite walk_app, Hw. simpl. unfold move. rewrite (proj2 (Nat.ltb_lt _ _) Hk), He.
    repeat split. apply degree_spec; auto. apply (alpha_ok M WM) in He; [apply He|apply turn_lt; auto].
Qed.

(** Claim 8: a false hypothesis h that shows the same percept is refuted on every way from h to
    the marker that the map knows. *)
Lemma refutable M W T phi : is_map M -> world W -> embedded M W phi -> forall w h a r j, h < darts M ->
  a < darts W -> percept M h = percept W a -> walk M h w = Some r -> marker M r = Some j -> a <> phi h ->
  exists w ps, percepts W a w = Some ps /\ agrees M T h w ps = false.
Proof.
  intros WM HW E w. assert (WW := world_is_map W HW).
  induction w as [|k w IH]; simpl; intros h a r j Hh Ha P Hw Hj N.
  - injection Hw as <-. destruct N. apply (confirm M W phi WM WW E a h [] a h j); auto.
    injection P as _ P. congruence.
  - destruct (move M h k) as [y|] eqn:Ey; [|discriminate].
    assert (Hy := move_lt M WM h k y Hh Ey). assert (Ey' := Ey). unfold move in Ey'.
    destruct (k <? degree M h) eqn:Hk; [|discriminate].
    assert (La := turn_lt W WW k a Ha). destruct (alpha W (turn W k a)) as [b|] eqn:Eb;
      [|destruct (world_total W HW _ La Eb)].
    assert (Em : move W a k = Some b) by (injection P as P _; unfold move; rewrite <- P, Hk; auto).
    destruct (percept_eqb_spec (percept M y) (percept W b)) as [Eq|Ne].
    + destruct (IH y b r j Hy (move_lt W WW a k b Ha Em) Eq Hw Hj) as (v & ps & Hv & Hn).
      { intros ->. apply N. apply (walk_inj W WW [k] a (phi h) (phi y)); auto.
        - apply (phi_lt _ _ _ E); auto.
        - simpl. rewrite Em; auto.
        - simpl. rewrite (embedded_move M W phi WM WW E h k y); auto. }
      exists (k :: v), (percept W b :: ps). simpl. rewrite Em, Hv, Hk, Ey', Hn.
      simpl. rewrite andb_false_r. auto.
    + exists [k], [percept W b]. simpl. rewrite Em, Hk, Ey'. simpl.
      destruct (percept_eqb_spec (percept M y) (percept W b)); [contradiction|auto].
Qed.

(** Progress: as long as a dart is open, a justified run has a next augmentation. *)
Theorem run_step W M T e : world W -> run W M T -> e < darts M -> alpha M e = None ->
  exists M' T', run W M' T' /\ known M' = 2 + known M.
Proof.
  intros HW R Le Oe. assert (WW := world_is_map W HW).
  destruct (run_true W M T HW R) as (WM & CM & _ & phi & E & _). assert (Lr := root_lt M WM).
  destruct (alpha W (phi e)) as [a|] eqn:Ha;
    [|destruct (world_total W HW (phi e) (phi_lt _ _ _ E e Le) Ha)].
  assert (La : a < darts W) by (apply (alpha_ok W WW) in Ha; [apply Ha|apply (phi_lt _ _ _ E); auto]).
  assert (Hb : behind M W e a).
  { destruct (reach_walk M (root M) e WM Lr (CM e Le)) as (u & q & k & Hu & Hk & Eq).
    assert (Lq := walk_lt M WM u _ q Lr Hu). split; auto. exists u, k, q. repeat split; auto.
    rewrite walk_app, <- (phi_root _ _ _ E), (forward_walk M W phi WM WW E u _ q) by auto.
    simpl. unfold move. rewrite (embedded_degree M W phi) by auto. rewrite (proj2 (Nat.ltb_lt _ _) Hk).
    rewrite <- (embedded_turn M W phi), Eq, Ha by auto. auto. }
  assert (Home : forall h, h < darts M -> exists w r j, walk M h w = Some r /\ marker M r = Some j).
  { intros h Lh. destruct (reach_sym M (root M) h WM Lr (CM h Lh)) as [_ B].
    destruct (reach_walk M h (root M) WM Lh B) as (w & r & k & Hw & Hk & Er).
    destruct (marker_of M r k Hk Er) as [j Hj]. eauto. }
  destruct (find (fun h => phi h =? a) (seq 0 (darts M))) as [h|] eqn:F.
  - apply find_seq in F as (Lh & Eh & _). apply Nat.eqb_eq in Eh.
    destruct (posed M W phi WM WW E e a h Le Oe Ha) as (N & Oh & _); auto; [lia|].
    destruct (Home h) as (w & r & j & Hw & Hj); [lia|].
    eexists _, _. split; [apply (run_loop W M T e a h w r (phi r) j); auto; try lia|
                          apply loop_two_more; auto; lia].
    + rewrite <- Eh. apply (forward_walk M W phi); auto; lia.
    + assert (P : percept W (phi r) = percept M r)
        by (apply (percept_agree M W phi); auto; eapply (walk_lt M WM w h); eauto; lia).
      injection P as _ P. congruence.
  - destruct (degree_spec W WW a La) as (D & _).
    eexists _, _. split; [apply (run_new W M T e a); auto|apply new_two_more; auto].
    intros h Lh _ _ P. left. destruct (Home h Lh) as (w & r & j & Hw & Hj).
    apply (refutable M W T phi WM HW E w h a r j); auto. intros Ea.
    assert (Q := find_none _ _ F h). cbv beta in Q. rewrite <- Ea, Nat.eqb_refl in Q.
    discriminate Q. apply in_seq; lia.
Qed.

(** Every world has a justified run that ends with the world.
    Not in the paper. *)
Theorem run_exists W : world W -> exists M T, run W M T /\ isomorphic M W.
Proof.
  intros HW.
  assert (G : forall n M T, run W M T -> darts W <= n + known M ->
    exists M T, run W M T /\ isomorphic M W).
  { intros n. induction n as [n IH] using lt_wf_ind. intros M T R L.
    destruct (find (fun d => negb (explored M d)) (seq 0 (darts M))) as [e|] eqn:F.
    - apply find_seq in F as (He & Oe & _). apply negb_true_iff in Oe.
      assert (known M < darts M) by (apply count_lt with e; auto; lia).
      destruct (run_true W M T HW R) as (_ & _ & _ & phi & E & _).
      assert (darts M <= darts W) by (apply (pigeon phi); apply E).
      destruct (run_step W M T e HW R) as (M' & T' & R' & K); [lia| |].
      { unfold explored in Oe. destruct (alpha M e); [discriminate|auto]. }
      apply (IH (n - 2) ltac:(lia) M' T'); auto. lia.
    - exists M, T. split; auto. apply (run_isomorphic W M T HW R). intros d Hd Od.
      assert (Q := find_none _ _ F d). unfold explored in Q. cbv beta in Q. rewrite Od in Q.
      discriminate Q. apply in_seq; lia. }
  apply (G (darts W) _ _ (run_start W)). lia.
Qed.
