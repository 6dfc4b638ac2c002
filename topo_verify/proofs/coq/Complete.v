(** A saturated union-find has merged all that is identified, and where it shows no conflict some
    world exists (claims 9 and 10; docs/proofs.md).

    L is a log, extra the list of assumed edges, assumed the same list with places of the log, rho
    gives each visit a rank; the other letters are those of Checker.v.

    [markers_ranked] says that the invariant of Ranked.v holds at the beginning, [same_merged] that
    nothing is left to merge at the end, and [saturated_decides] that the fold is consistent if no
    conflict is found. *)
From Coq Require Import Arith Lia List Bool PArith FMapPositive.
Import ListNotations.
From Topo Require Import World Rotation Embedding Augment Log Determined Undetermined Classes
  Quotient Entailed Table Checker CheckerCorrect Ranked Saturated.

Local Opaque fuel.

(** Moves that [legal_moves] accepts, after a legal percept of degree d: all percepts are legal, and
    all doors exist. *)
Lemma legal_moves_spec ms : forall a, legal_percept a = true -> legal_moves (fst a) ms = true ->
  (forall i d m, nth_error (a :: map snd ms) i = Some (d, m) ->
    0 < d /\ forall j, m = Some j -> j < d) /\
  forall i k, nth_error (map fst ms) i = Some k ->
    exists d m, nth_error (a :: map snd ms) i = Some (d, m) /\ k < d.
Proof.
  assert (One : forall d m, legal_percept (d, m) = true -> 0 < d /\ forall j, m = Some j -> j < d).
  { unfold legal_percept. simpl. intros d m H. apply andb_true_iff in H as [A B].
    apply Nat.ltb_lt in A. split; auto. intros j ->. apply Nat.ltb_lt, B. }
  induction ms as [|(k, p) ms IH]; intros a P H; simpl in H.
  - split; [|intros [|i] k E; discriminate].
    intros [|[|i]] d m E; try discriminate. injection E as ->. apply (One d m P).
  - apply andb_true_iff in H as [H M]. apply andb_true_iff in H as [K Q]. apply Nat.ltb_lt in K.
    destruct (IH p Q M) as [A B]. split.
    + intros [|i] d m E; [injection E as ->; apply (One d m P)|apply (A i d m E)].
    + intros [|i] k' E; [|apply (B i k' E)]. injection E as <-. destruct a as (d, m).
      exists d, m. auto.
Qed.

(** What a legal log is. *)
Lemma legal_spec L : legal L = true -> (exists d, seen L 0 = Some (d, Some 0)) /\
  (forall i d m, seen L i = Some (d, m) -> 0 < d /\ forall j, m = Some j -> j < d) /\
  forall i k, door L i = Some k -> exists d m, seen L i = Some (d, m) /\ k < d.
Proof.
  unfold legal. intros H. apply andb_true_iff in H as [H M]. apply andb_true_iff in H as [P S].
  split; [|apply (legal_moves_spec (moves L) (start L) P M)].
  unfold seen. destruct (start L) as (d, [[|j]|]); try discriminate. exists d. auto.
Qed.

(** Equal ranks are as good. *)
Lemma ranked_ext L U rho rho' : (forall x, rho x = rho' x) -> ranked L U rho -> ranked L U rho'.
Proof.
  intros E [A B C M O]. split; auto.
  - intros x y o F. rewrite <- !E. eauto.
  - intros x S. destruct (C x S) as (r & H). exists r. rewrite <- !E. auto.
  - eapply Nat.le_trans; [|exact M]. unfold mass. apply Nat.eq_le_incl. f_equal. apply map_ext.
    intros x. unfold own. rewrite E. auto.
  - intros x S. rewrite <- E. auto.
Qed.

Section Complete.
Variables (L : Log) (extra : list (pplace * pplace)).
Notation assumed := (map abs2 extra).
Notation T := (table_of (sights L)).
Notation D := (table_of (edges L extra)).
Notation find := PositiveMap.find.
Notation rep := (rep T fuel).
Notation unite := (unite T).
Notation tidy := (tidy L).
Notation sign := (sign L).
Notation ranked := (ranked L).

Hypothesis Legal : legal L = true.
Hypothesis Tidy : forall p q, In (p, q) extra -> (exists d, tidy d p) /\ exists d, tidy d q.

(** Degrees are positive. *)
Lemma degrees_positive x d m : find x T = Some (d, m) -> 0 < d.
Proof.
  intros E. apply table_of_spec in E. exact (proj1 (proj1 (proj2 (legal_spec L Legal)) _ _ _ E)).
Qed.

(** Every place where an edge ends is tidy. *)
Lemma legal_ends : tidy_ends L extra.
Proof.
  assert (G : forall p q, In (p, q) (edges L extra) -> (exists d, tidy d p) /\ exists d, tidy d q).
  { intros p q I. unfold edges in I. apply in_app_iff in I as [I|I]; [|auto].
    apply in_map_iff in I as ((x, k) & E & I). injection E as <- <-. apply enum_1 in I.
    assert (V := link_valid nothing L _ _ (link_back nothing L _ _ I)).
    destruct (proj2 (proj2 (legal_spec L Legal)) _ _ I) as (d & m & E & Lt).
    split; [exists d; split; auto; exists m; apply table_of_find, E|].
    unfold valid in V. cbn [fst] in V. rewrite <- num_succ in V.
    destruct (seen L (num (Pos.succ x))) as [(e, n)|] eqn:Es; [|destruct V; auto].
    exists e. split; [exists n; apply table_of_find, Es|].
    exact (proj1 (proj1 (proj2 (legal_spec L Legal)) _ _ _ Es)). }
  intros a p q E. unfold arc_ends in E. destruct (find (snd a) D) as [(r, s)|] eqn:F; [|discriminate].
  apply table_of_spec, nth_error_In, G in F. destruct F as [A B].
  destruct (fst a); injection E as <- <-; auto.
Qed.

(** A place of the log, with a binary visit and its offset below the degree. *)
Definition norm (p : place) : pplace := reduced T (Pos.of_succ_nat (fst p), snd p).

(** The binary map has the percept of every visit. *)
Lemma seen_find i d m : seen L i = Some (d, m) -> find (Pos.of_succ_nat i) T = Some (d, m).
Proof. intros E. apply table_of_find. rewrite num_of. exact E. Qed.

(** A place of the log in its normal form is tidy. *)
Lemma norm_tidy p : valid L p -> exists d m, seen L (fst p) = Some (d, m) /\ tidy d (norm p) /\
  norm p = (Pos.of_succ_nat (fst p), snd p mod d).
Proof.
  destruct p as (i, k). unfold valid. cbn [fst]. intros V.
  destruct (seen L i) as [(d, m)|] eqn:E; [|tauto]. exists d, m. split; auto.
  assert (F := seen_find i d m E). unfold norm. cbn [fst snd]. rewrite (reduced_tidy L _ _ _ _ F).
  split; auto. split; [exists m; auto|]. simpl. apply Nat.mod_upper_bound.
  apply degrees_positive in F. lia.
Qed.

(** The normal form of a tidy place is the place. *)
Lemma norm_abs d p : tidy d p -> norm (abs p) = p.
Proof.
  destruct p as (x, k). intros [(m & F) Lt]. cbn [fst snd] in *. unfold norm, abs. cbn [fst snd].
  assert (E : Pos.of_succ_nat (num x) = x).
  { apply Pos2Nat.inj. rewrite SuccNat2Pos.id_succ. unfold num. assert (H := Pos2Nat.is_pos x). lia. }
  rewrite E, (reduced_tidy L _ _ _ _ F), Nat.mod_small; auto.
Qed.

(** Each link is an arc. *)
Lemma link_arc p q : link assumed L p q -> exists a p' q', arc_ends D a = Some (p', q') /\
  abs p' = p /\ abs q' = q.
Proof.
  assert (Find : forall e, In e (edges L extra) -> exists x, find x D = Some e).
  { intros e I. apply In_nth_error in I as (i & I). exists (Pos.of_succ_nat i).
    apply table_of_find. rewrite num_of. auto. }
  assert (Out : forall i k, door L i = Some k -> exists x, num x = i /\
    exists y, find y D = Some ((x, k), (Pos.succ x, 0))).
  { intros i k E. destruct (in_enum (map fst (moves L)) 1 i k E) as (x & I & X).
    exists x. split; [unfold num; rewrite X, Pos2Nat.inj_1; lia|]. apply Find, in_app_iff. left.
    apply in_map_iff. exists (x, k). auto. }
  intros [i k E|i k E|x y I _ _|x y I _ _].
  - destruct (Out i k E) as (x & X & y & F). exists (true, y), (x, k), (Pos.succ x, 0).
    unfold arc_ends. simpl. rewrite F. unfold abs. simpl. rewrite num_succ, X. auto.
  - destruct (Out i k E) as (x & X & y & F). exists (false, y), (Pos.succ x, 0), (x, k).
    unfold arc_ends. simpl. rewrite F. unfold abs. simpl. rewrite num_succ, X. auto.
  - apply in_map_iff in I as ((a, b) & E & I). injection E as <- <-.
    destruct (Find (a, b)) as (x & F); [apply in_app_iff; auto|]. exists (true, x), a, b.
    unfold arc_ends. simpl. rewrite F. auto.
  - apply in_map_iff in I as ((a, b) & E & I). injection E as <- <-.
    destruct (Find (a, b)) as (x & F); [apply in_app_iff; auto|]. exists (false, x), b, a.
    unfold arc_ends. simpl. rewrite F. auto.
Qed.

Hypothesis Few : length (sights L) < 2 ^ fuel.

(** The two places have the same representative. *)
Definition merged U p q := valid L p /\ valid L q /\ rep U (norm p) = rep U (norm q).

(** Merged places are at visits with the same sign. *)
Lemma merged_sign U rho p q : ranked U rho -> merged U p q ->
  sign (Pos.of_succ_nat (fst p)) = sign (Pos.of_succ_nat (fst q)).
Proof.
  intros R (P & Q & E). destruct (norm_tidy p P) as (d & m & _ & Tp & Np).
  destruct (norm_tidy q Q) as (e & m' & _ & Tq & Nq).
  assert (A : forall d p, tidy d p -> sign (fst p) = sign (fst (rep U p))).
  { intros f a Ta. destruct (tidy_sign L f a Ta) as (w & W).
    apply (leads_tidy L U rho a _ R (rep_spec L Few U rho a R ltac:(congruence)) f Ta). }
  assert (B := eq_trans (A d _ Tp) (eq_trans (f_equal (fun r => sign (fst r)) E) (eq_sym (A e _ Tq)))).
  rewrite Np, Nq in B. exact B.
Qed.

(** A saturated union-find has merged all that is identified. *)
Lemma same_merged U rho : ranked U rho -> all_merged L extra U ->
  (forall x d j, find x T = Some (d, Some j) -> j < d /\ rep U (x, j) = rep U (1%positive, 0)) ->
  forall p q, same assumed L p q -> p = q \/ merged U p q.
Proof.
  intros R F Marks p q. 
  induction 1 as [p|p q _ IH|p q r _ IH _ IH'|k i a j b _ IH|i d m E|i d j E|p q p' q' K K' _ IH]; auto.
  - destruct IH as [->|(A & B & E)]; auto. right. repeat split; auto.
  - destruct IH as [->|(A & B & E)]; auto. destruct IH' as [<-|(A' & B' & E')].
    + right. repeat split; auto.
    + right. repeat split; auto. congruence.
  - destruct IH as [Eq|M]; [injection Eq as -> ->; auto|]. right.
    assert (S := merged_sign U rho _ _ R M). destruct M as (A & B & E).
    split; [exact A|]. split; [exact B|].
    destruct (norm_tidy _ A) as (d & m & Ei & Ta & Na), (norm_tidy _ B) as (e & n & Ej & Tb & Nb).
    cbn [fst snd] in *. assert (Fi := seen_find _ _ _ Ei). assert (Fj := seen_find _ _ _ Ej).
    assert (e = d) as ->. { unfold sign in S. rewrite Fi, Fj in S. congruence. }
    assert (G : forall a i m, find (Pos.of_succ_nat i) T = Some (d, m) -> tidy d (norm (i, a)) ->
      norm (i, a) = (Pos.of_succ_nat i, a mod d) ->
      rep U (norm (i, k + a)) = (fst (rep U (norm (i, a))), (snd (rep U (norm (i, a))) + k) mod d)).
    { clear - R Few Legal. intros a i m Fi Ta Na. destruct (tidy_sign L d _ Ta) as (w & W).
      assert (Sn : sign (fst (norm (i, a))) <> None).
      { intros N. pose proof (eq_trans (eq_sym W) N) as Q. discriminate Q. }
      assert (X := rep_spec L Few U rho _ R Sn).
      assert (Y := leads_turn L U rho _ _ R X d k Ta).
      assert (Nk : norm (i, k + a) = (fst (norm (i, a)), (snd (norm (i, a)) + k) mod d)).
      { rewrite Na. cbn [fst snd]. unfold norm. cbn [fst snd]. rewrite (reduced_tidy L _ _ _ _ Fi).
        f_equal. rewrite Nat.add_mod_idemp_l by (apply degrees_positive in Fi; lia). f_equal. lia. }
      rewrite Nk.
      assert (Z := rep_spec L Few U rho (fst (norm (i, a)), (snd (norm (i, a)) + k) mod d) R Sn).
      exact (leads_det L _ _ _ Z _ Y). }
    rewrite (G a i m Fi Ta Na), (G b j n Fj Tb Nb), E. auto.
  - right. assert (Fi := seen_find i d m E). assert (P := degrees_positive _ _ _ Fi).
    split; [unfold valid; simpl; congruence|]. split; [unfold valid; simpl; congruence|].
    unfold norm. cbn [fst snd]. rewrite !(reduced_tidy L _ _ _ _ Fi), Nat.mod_same, Nat.mod_0_l by lia.
    auto.
  - right. assert (Fi := seen_find i d _ E). destruct (Marks _ _ _ Fi) as [Lj Er].
    split; [unfold valid; simpl; congruence|]. split; [discriminate|].
    assert (N1 : norm (i, j) = (Pos.of_succ_nat i, j)).
    { unfold norm. cbn [fst snd]. rewrite (reduced_tidy L _ _ _ _ Fi), Nat.mod_small; auto. }
    assert (N0 : norm (0, 0) = (1%positive, 0)).
    { destruct (norm_tidy (0, 0)) as (e & n & _ & [_ Lt] & ->); [discriminate|]. cbn [fst snd] in *.
      destruct e; auto. rewrite Nat.mod_0_l; auto. }
    rewrite N1, N0. exact Er.
  - right. destruct (link_arc p q K) as (a & pp & qq & Ea & <- & <-).
    destruct (link_arc p' q' K') as (a' & pp' & qq' & Ea' & <- & <-).
    destruct (legal_ends _ _ _ Ea) as [(d & Tp) (e & Tq)],
      (legal_ends _ _ _ Ea') as [(d' & Tp') (e' & Tq')].
    split; [eapply link_valid, link_sym, K|]. split; [eapply link_valid, link_sym, K'|].
    rewrite (norm_abs e qq Tq), (norm_abs e' qq' Tq'). apply (F (a, a')). unfold meet. cbn [fst snd].
    rewrite Ea, Ea'. assert (Er : rep U pp = rep U pp').
    { destruct IH as [Eq|(_ & _ & Er)].
      - rewrite <- (norm_abs d pp Tp), <- (norm_abs d' pp' Tp'), Eq. auto.
      - rewrite (norm_abs d pp Tp), (norm_abs d' pp' Tp') in Er. exact Er. }
    rewrite Er. unfold pplace_eqb. rewrite Pos.eqb_refl, Nat.eqb_refl. auto.
Qed.

(** A union-find that is saturated, in which every visit that saw the marker is merged with the
    start, and which shows no conflict, is a consistent fold. *)
Lemma unopposed_consistent U rho : ranked U rho -> all_merged L extra U ->
  (forall x d j, find x T = Some (d, Some j) -> rep U (x, j) = rep U (1%positive, 0)) ->
  (forall x, check_conflict T D U (Alone x) = false) -> consistent assumed L.
Proof.
  intros R F Marks Two.
  destruct (legal_spec L Legal) as (Start & Percepts & Doors).
  assert (SM : forall p q, same assumed L p q -> p = q \/ merged U p q).
  { apply (same_merged U rho R F). intros x d j E. split; [|eauto].
    apply table_of_spec in E. apply (proj2 (Percepts _ _ _ E)). auto. }
  assert (Sg : forall i a j b, same assumed L (i, a) (j, b) ->
    i = j \/ sign (Pos.of_succ_nat i) = sign (Pos.of_succ_nat j)).
  { intros i a j b S. destruct (SM _ _ S) as [Eq|M]; [injection Eq; auto|].
    right. apply (merged_sign U rho _ _ R M). }
  split; auto.
  - intros i k d m K E. destruct (Doors i k K) as (d' & m' & E' & Lt). congruence.
  - intros p q I. apply in_map_iff in I as ((r, s) & E & I). injection E as <- <-.
    destruct (Tidy r s I) as [(d & (m & Fr) & _) (e & (n & Fs) & _)].
    apply table_of_spec in Fr, Fs. unfold valid, abs, seen, sights in *. cbn [fst]. split; congruence.
  - intros i a j b d m e n S E E'. destruct (Sg i a j b S) as [->|Q]; [congruence|].
    unfold Ranked.sign in Q. rewrite (seen_find _ _ _ E), (seen_find _ _ _ E') in Q. congruence.
  - intros i a j b d m e n S E E'. destruct (Sg i a j b S) as [->|Q]; [congruence|].
    unfold Ranked.sign in Q. rewrite (seen_find _ _ _ E), (seen_find _ _ _ E') in Q.
    destruct n; congruence.
  - intros i a b d m S E La Lb. destruct (SM _ _ S) as [Eq|(_ & _ & Q)]; [injection Eq; auto|].
    assert (Fi := seen_find _ _ _ E).
    assert (Nm : forall k, k < d -> norm (i, k) = (Pos.of_succ_nat i, k)).
    { intros k Lk. unfold norm. cbn [fst snd].
      rewrite (reduced_tidy L _ _ _ _ Fi), Nat.mod_small; auto. }
    rewrite !Nm in Q by auto.
    assert (Sn : sign (Pos.of_succ_nat i) <> None).
    { unfold Ranked.sign. rewrite Fi. discriminate. }
    assert (T0 : tidy d (Pos.of_succ_nat i, 0)) by (split; [exists m; auto|simpl; lia]).
    assert (L0 := rep_spec L Few U rho (Pos.of_succ_nat i, 0) R Sn).
    destruct (leads_tidy L U rho _ _ R L0 d T0) as [[_ Lo] _].
    assert (Tn := fun k => leads_turn L U rho _ _ R L0 d k T0). cbn [fst snd] in Tn.
    revert Lo Tn. destruct (rep U (Pos.of_succ_nat i, 0)) as (y, o). cbn [fst snd]. intros Lo Tn.
    assert (G : forall k, k < d -> rep U (Pos.of_succ_nat i, k) = (y, (o + k) mod d)).
    { intros k Lk. specialize (Tn k). rewrite Nat.add_0_l, Nat.mod_small in Tn by auto.
      exact (leads_det L U _ _ (rep_spec L Few U rho (Pos.of_succ_nat i, k) R Sn) _ Tn). }
    rewrite !G in Q by auto. injection Q as Q.
    assert (Back : forall k, k < d -> ((o + k) mod d + (d - o)) mod d = k).
    { intros k Lk. rewrite Nat.add_mod_idemp_l by lia. replace (o + k + (d - o)) with (k + 1 * d) by lia.
      rewrite Nat.mod_add, Nat.mod_small; lia. }
    rewrite <- (Back a La), <- (Back b Lb), Q. auto.
  - intros p q K S. destruct (link_arc p q K) as (a & p' & q' & Ea & <- & <-).
    destruct (legal_ends _ _ _ Ea) as [(d & Tp) (e & Tq)].
    assert (Q : rep U p' = rep U q').
    { destruct (SM _ _ S) as [Eq|(_ & _ & Q)].
      - rewrite <- (norm_abs d p' Tp), <- (norm_abs e q' Tq), Eq. auto.
      - rewrite (norm_abs d p' Tp), (norm_abs e q' Tq) in Q. exact Q. }
    specialize (Two (snd a)). unfold arc_ends in Ea. simpl in Two.
    destruct (find (snd a) D) as [(r, s)|]; [|discriminate].
    assert (Q' : rep U r = rep U s) by (destruct (fst a); congruence).
    rewrite Q', pplace_eqb_refl in Two. discriminate.
Qed.
End Complete.
