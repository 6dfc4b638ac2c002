(** What the judge says of the map that is delivered and of the log as a whole (docs/semantics.md,
    sections 9 and 11; claims 1, 5 and 9).

    M is a delivered map, W a world, phi their correspondence; l a list of pairs, d, e darts of M, b,
    c darts of W; L a log. *)
From Coq Require Import Arith Lia List NArith Bool.
Import ListNotations.
From Topo Require Import World Rotation Embedding Log AnyWorld Determined Entailed Events Table Numbered
  LogFold LogFoldExact Claims Judge.

(** [check_moves] accepts just the percepts that the map shows. *)
Lemma check_moves_iff W ms : forall a, check_moves W a ms = true <->
  percepts W a (map fst ms) = Some (map snd ms).
Proof.
  intros a. split; [|apply check_moves_shown]. revert a.
  induction ms as [|(k, p) ms IH]; simpl; auto. intros a H.
  destruct (move W a k) as [b|]; [|discriminate]. apply andb_true_iff in H as [E H].
  destruct (percept_eqb_spec (percept W b) p) as [->|]; [|discriminate]. rewrite (IH b H). auto.
Qed.

(** [shows_b] decides whether a world shows a log. *)
Lemma shows_spec w L : a_world w -> (shows_b (ground w) L = true <-> shows_log w L).
Proof.
  intros Hw. unfold shows_b. rewrite andb_true_iff, check_moves_iff. destruct w as [|W]; simpl.
  - change (percept _ 0) with nothing_there.
    destruct (percept_eqb_spec nothing_there (start L)) as [<-|N].
    + destruct (moves L) as [|(k, p) ms]; simpl; split; intros [A B]; split; auto; discriminate.
    + split; intros [E B]; [discriminate|]. destruct N. auto.
  - unfold replays. destruct (percept_eqb_spec (percept W (root W)) (start L)) as [->|N].
    + tauto.
    + split; [intros [E _]; discriminate|]. intros (_ & E & _). congruence.
Qed.

(** [closed_b] decides whether a log that some world shows is closed. *)
Lemma closed_spec L : possible nothing L -> (closed_b L = true <-> closed L).
Proof.
  intros P. destruct (fold_exists L P) as (f & R & E & I). unfold closed_b. rewrite E. clear E.
  specialize (I nothing). set (s := percepts_of L).
  assert (All : forall a b, link nothing L a b -> In (a, b) (arcs_of_moves 0 (moves L)))
    by (intros a b; apply arcs_links).
  assert (Same := folded_same L nothing P _ f R I All).
  assert (Seen : forall i, seen L i = nth_error s i) by reflexivity.
  rewrite forallb_forall. split.
  - intros H (i, k) V. unfold valid in V. simpl in V.
    destruct (seen L i) as [(n, m)|] eqn:Si; [|tauto].
    assert (Li : i < length s) by (apply nth_error_Some; rewrite <- Seen; congruence).
    assert (Di : degree_at s i = n) by (unfold degree_at; rewrite <- Seen, Si; auto).
    assert (Pn := proj1 (c_percept nothing L (plain L P) _ _ _ Si)).
    assert (Lk : k mod n < n) by (apply Nat.mod_upper_bound; lia).
    specialize (H i ltac:(apply in_seq; lia)). rewrite forallb_forall in H.
    specialize (H (k mod n) ltac:(apply in_seq; lia)). apply existsb_exists in H as (r & Ir & Er).
    apply place_eqb_eq in Er.
    destruct (f_arcs _ _ _ _ _ _ I r) as (Vr & _ & p & q & K & Sp & _); [apply in_or_app; auto|].
    exists p, q. split; auto. apply same_trans with (i, k mod n);
      [apply (same_mod nothing L i k n m Si)|].
    apply same_trans with (fst r); auto. rewrite Er. apply (f_forced _ _ _ _ _ _ I (i, k mod n)).
    unfold valid. simpl. congruence.
  - intros C i Ii. apply forallb_forall. intros k Ik. apply existsb_exists. apply in_seq in Ii.
    destruct (C (i, k)) as (p & q & K & Sp).
    { unfold valid. simpl. rewrite Seen. apply nth_error_Some. lia. }
    destruct (f_all _ _ _ _ _ _ I p q (All _ _ K)) as (r & Ir & Er & _). rewrite app_nil_r in Ir.
    exists r. split; auto. apply place_eqb_eq. fold s in Same, Er. rewrite (Same _ _ Sp), Er.
    symmetry. apply (f_normal _ _ _ _ _ _ I). auto.
Qed.

Section Same.
Variables M W : Map.
Hypothesis HW : world W.
Notation paired := (paired M W).
Notation following_pairs := (following_pairs M W).

(** Dart b is in a pair. *)
Definition is_paired (l : list (nat * nat)) b := exists d, In (d, b) l.

(** Pairing up adds some of the pairs, and covers their second darts. *)
Lemma pair_up_all ns : forall l, exists xs, fold_left pair_up ns l = xs ++ l /\ incl xs ns /\
  (NoDup (map snd l) -> NoDup (map snd (xs ++ l))) /\ forall q, In q ns -> is_paired (xs ++ l) (snd q).
Proof.
  induction ns as [|q ns IH]; intros l; simpl.
  - exists []. simpl. repeat split; auto; intros ? [].
  - destruct (IH (pair_up l q)) as (xs & E & Inc & ND & Cov). rewrite E. clear IH E. unfold pair_up in *.
    destruct (existsb (fun p => snd p =? snd q) l) eqn:X.
    + exists xs. split; auto. split; [intros r Ir; right; auto|]. split; auto.
      intros r [<-|Ir]; [|auto]. apply existsb_exists in X as ((d, b) & I & Eb). apply Nat.eqb_eq in Eb.
      simpl in Eb. subst. exists d. apply in_or_app. auto.
    + exists (xs ++ [q]). rewrite <- app_assoc. simpl. split; auto. split.
      * intros r Ir. apply in_app_or in Ir as [Ir|[<-|[]]]; [right; auto|left; auto].
      * split.
        -- intros N. apply ND. simpl. constructor; auto. intros I. apply in_map_iff in I as (p & Ep & I).
           assert (T : existsb (fun p => snd p =? snd q) l = true); [|congruence].
           apply existsb_exists. exists p. rewrite Ep, Nat.eqb_refl. auto.
        -- intros r [<-|Ir]; auto. destruct q as (d, b). exists d. apply in_or_app. simpl. auto.
Qed.

(** The list has the pairs that follow from its own. *)
Definition pairs_complete l := forall p q, In p l -> In q (following_pairs p) -> is_paired l (snd q).

(** A pairs_complete list stays as it is, in the second darts that it covers. *)
Lemma paired_grows n : forall l, incl l (paired n l).
Proof.
  induction n as [|n IH]; intros l p I; simpl; auto.
  apply IH. destruct (pair_up_all (flat_map following_pairs l) l) as (xs & -> & _).
  apply in_or_app. auto.
Qed.

(** After as many rounds as W has darts, the list is complete. *)
Lemma paired_saturated n : forall l, NoDup (map snd l) -> (forall p, In p l -> snd p < darts W) ->
  darts W < n + length l -> pairs_complete (paired n l).
Proof.
  assert (Lt : forall p q, snd p < darts W -> In q (following_pairs p) -> snd q < darts W).
  { assert (WW := world_is_map W HW). intros (d, b) q Lb. simpl in Lb. unfold Judge.following_pairs.
    simpl.
    intros [<-|I]; [apply sigma_lt; auto|]. destruct (alpha M d); [|destruct I].
    destruct (alpha W b) as [c|] eqn:Eb; [|destruct I]. destruct I as [<-|[]]. simpl.
    apply (alpha_ok W WW) in Eb; auto. apply Eb. }
  assert (Most : forall l : list (nat * nat), NoDup (map snd l) -> (forall p, In p l ->
    snd p < darts W) ->
    length l <= darts W).
  { intros l N B. rewrite <- (map_length snd), <- (seq_length (darts W) 0).
    apply NoDup_incl_length; auto.
    intros b I. apply in_map_iff in I as (p & <- & I). apply in_seq. specialize (B p I). lia. }
  induction n as [|n IH]; intros l N B L; [specialize (Most l N B); lia|]. simpl.
  destruct (pair_up_all (flat_map following_pairs l) l) as (xs & E & Inc & ND & Cov). rewrite E.
  destruct xs as [|x xs].
  - simpl in *. assert (St : pairs_complete l).
    { intros p q Ip Iq. apply Cov. apply in_flat_map. eauto. }
    clear - St E. assert (K : forall n, paired n l = l).
    { intros m. induction m as [|m IH]; simpl; auto. rewrite E. auto. }
    rewrite K. auto.
  - apply IH; auto.
    + intros p I. apply in_app_or in I as [I|I]; auto. apply Inc in I.
      apply in_flat_map in I as (p' & I' & I). apply (Lt p'); auto.
    + rewrite app_length. simpl. lia.
Qed.

(** The pairs of a correspondence. *)
Lemma paired_right phi n : is_map M -> embedded M W phi -> forall l,
  (forall p, In p l -> fst p < darts M /\ snd p = phi (fst p)) ->
  forall p, In p (paired n l) -> fst p < darts M /\ snd p = phi (fst p).
Proof.
  intros WM E. induction n as [|n IH]; simpl; auto. intros l R. apply IH.
  destruct (pair_up_all (flat_map following_pairs l) l) as (xs & -> & Inc & _).
  intros p I. apply in_app_or in I as [I|I]; auto. apply Inc, in_flat_map in I as ((d, b) & I' & I).
  destruct (R _ I') as [Ld Eb]. simpl in Ld, Eb. unfold Judge.following_pairs in I. simpl in I.
  destruct I as [<-|I]; simpl.
  - split; [apply sigma_lt; auto|]. rewrite Eb. symmetry. apply (phi_sigma _ _ _ E); auto.
  - destruct (alpha M d) as [e|] eqn:Ed; [|destruct I]. rewrite Eb in I.
    rewrite (phi_alpha _ _ _ E d e) in I by auto. destruct I as [<-|[]]. simpl. split; auto.
    apply (alpha_ok M WM) in Ed; auto. apply Ed.
Qed.

(** [same_world] decides whether M is well formed and the world W. *)
Lemma same_world_spec : same_world M W = true <-> world M /\ isomorphic M W.
Proof.
  assert (WW := world_is_map W HW). unfold same_world. cbv zeta. set (l := pairing M W).
  set (f := forth l). set (g := back l).
  rewrite !andb_true_iff, forallb_forall, Nat.ltb_lt, Nat.eqb_eq. split.
  - intros ((R & ER) & H).
    assert (Hd : forall d, d < darts M -> (f d < darts W /\ g (f d) = d /\ sigma M d < darts M /\
      f (sigma M d) = sigma W (f d)) /\ exists e, alpha M d = Some e /\ e < darts M /\
      alpha W (f d) = Some (f e)).
    { intros d Ld. specialize (H d ltac:(apply in_seq; lia)).
      rewrite !andb_true_iff, !Nat.ltb_lt, !Nat.eqb_eq in H. destruct H as ((((A & B) & C) & D) & E).
      split; auto. destruct (alpha M d) as [e|]; [|discriminate].
      destruct (alpha W (f d)) as [b|]; [|discriminate]. rewrite andb_true_iff, Nat.ltb_lt,
        Nat.eqb_eq in E.
      destruct E as [Le <-]. eauto. }
    assert (Inj : forall d e, d < darts M -> e < darts M -> f d = f e -> d = e).
    { intros d e Ld Le Q. destruct (Hd d Ld) as ((_ & <- & _) & _), (Hd e Le) as ((_ & <- & _) & _).
      congruence. }
    assert (WM : is_map M).
    { split; auto.
      - intros d Ld. apply (Hd d Ld).
      - intros d e Ld Le Q. apply Inj; auto. apply (sigma_inj W WW); try apply Hd; auto.
        destruct (Hd d Ld) as ((_ & _ & _ & <-) & _), (Hd e Le) as ((_ & _ & _ & <-) & _). congruence.
      - intros d e Ld Q. destruct (Hd d Ld) as ((Lf & _) & e' & Q' & Le & Af). rewrite Q in Q'.
        injection Q' as <-. destruct (alpha_ok W WW _ _ Lf Af) as (_ & N & Back).
        split; auto. split; [congruence|]. destruct (Hd e Le) as (_ & e' & Q' & Le' & Ae).
        rewrite Q'. f_equal. apply Inj; auto. congruence. }
    assert (E : embedded M W f).
    { split; auto; intros d; [apply Hd|intros; apply Hd; auto|].
      intros e Ld Q. destruct (Hd d Ld) as (_ & e' & Q' & _ & Af). congruence. }
    assert (Tot : forall d, d < darts M -> alpha M d <> None).
    { intros d Ld. destruct (Hd d Ld) as (_ & e & -> & _). discriminate. }
    split; [|apply (closed_isomorphic M W f); auto; apply HW]. split; auto.
    assert (Back : forall b, reach W (root W) b -> exists d, d < darts M /\ f d = b /\
      reach M (root M) d).
    { intros b. induction 1 as [|b _ (d & Ld & <- & Rd)|b c _ (d & Ld & <- & Rd) Ac].
      - exists (root M). repeat split; auto. constructor.
      - destruct (Hd d Ld) as ((_ & _ & Ls & Es) & _). exists (sigma M d). repeat split; auto.
        apply reach_sigma. auto.
      - destruct (Hd d Ld) as (_ & e & Ae & Le & Af). exists e. split; auto. split; [congruence|].
        apply (reach_alpha M _ d); auto. }
    intros d Ld. destruct (Back (f d)) as (d' & Ld' & Q & Rd).
    { apply (world_connected W HW). apply Hd. auto. }
    apply Inj in Q as ->; auto.
  - intros (HM & _ & phi & E & Onto & _). assert (WM := world_is_map M HM). assert (R := root_lt M WM).
    assert (Right : forall p, In p l -> fst p < darts M /\ snd p = phi (fst p)).
    { apply (paired_right phi); auto. intros p [<-|[]]. simpl. split; auto. symmetry.
      apply (phi_root _ _ _ E). }
    assert (Sat : pairs_complete l).
    { apply paired_saturated; simpl.
      - constructor; auto. constructor.
      - intros p [<-|[]]. simpl. apply root_lt; auto.
      - lia. }
    assert (Cov : forall b, reach W (root W) b -> is_paired l b).
    { intros b. induction 1 as [|b _ (d & I)|b c _ (d & I) Ac].
      - exists (root M). apply paired_grows. left. auto.
      - apply (Sat _ (sigma M d, sigma W b) I). left. auto.
      - destruct (Right _ I) as [Ld Eb]. simpl in Ld, Eb. assert (T := world_total M HM d Ld).
        destruct (alpha M d) as [e|] eqn:Ed; [|tauto]. apply (Sat _ (e, c) I).
        unfold Judge.following_pairs. simpl. rewrite Ed, Ac. simpl. auto. }
    assert (Hit : forall d, d < darts M -> In (d, phi d) l).
    { intros d Ld. destruct (Cov (phi d)) as (d' & I).
      { apply (world_connected W HW), (phi_lt _ _ _ E). auto. }
      destruct (Right _ I) as [Ld' Q]. simpl in *. apply (phi_inj _ _ _ E) in Q; auto. subst. auto. }
    assert (F : forall d, d < darts M -> f d = phi d).
    { intros d Ld. unfold f, forth. destruct (find _ l) as [p|] eqn:Q.
      - apply find_some in Q as [I Q]. apply Nat.eqb_eq in Q. rewrite <- Q. apply Right. auto.
      - apply (find_none _ _ Q (d, phi d)) in Hit; auto. simpl in Hit. rewrite Nat.eqb_refl in Hit.
        discriminate. }
    assert (G : forall d, d < darts M -> g (phi d) = d).
    { intros d Ld. unfold g, back. destruct (find _ l) as [p|] eqn:Q.
      - apply find_some in Q as [I Q]. apply Nat.eqb_eq in Q. destruct (Right _ I) as [Lp Ep].
        apply (phi_inj _ _ _ E); auto. congruence.
      - apply (find_none _ _ Q (d, phi d)) in Hit; auto. simpl in Hit. rewrite Nat.eqb_refl in Hit.
        discriminate. }
    split; [split; auto; rewrite F by auto; apply (phi_root _ _ _ E)|].
    intros d Id. apply in_seq in Id. assert (Ld : d < darts M) by lia. assert (Ls := sigma_lt M WM d Ld).
    rewrite !F, G by auto. rewrite (phi_sigma _ _ _ E), !Nat.eqb_refl by auto.
    rewrite (proj2 (Nat.ltb_lt _ _) Ls), (proj2 (Nat.ltb_lt _ _) (phi_lt _ _ _ E d Ld)). simpl.
    assert (T := world_total M HM d Ld). destruct (alpha M d) as [e|] eqn:Ed; [|tauto].
    rewrite (phi_alpha _ _ _ E d e) by auto. apply (alpha_ok M WM) in Ed; auto. destruct Ed as (Le & _).
    rewrite F, Nat.eqb_refl, (proj2 (Nat.ltb_lt _ _) Le); auto.
Qed.
End Same.

(** [is_right] decides whether a delivered map is the world. *)
Lemma is_right_spec D w : a_world w -> (is_right D w = true <-> right_map D w).
Proof.
  intros Hw. destruct w as [|W]; simpl.
  - destruct (rotations D) as [|[|x l] [|l' ls]], (pairs D); intuition discriminate.
  - unfold right_delivery. rewrite !andb_true_iff, forallb_forall, Nat.eqb_eq, same_world_spec,
      Forall_forall
      by auto. split.
    + intros ((A & B) & C). split; [|tauto]. intros r Ir. apply A in Ir. destruct r; congruence.
    + intros (A & B & C). split; [|tauto]. split; [|auto]. intros r Ir. apply A in Ir.
      destruct r; congruence.
Qed.
