(** Merging until all is merged finds a conflict exactly where no world exists (claims 9 and 10;
    docs/proofs.md).

    L is a log, extra the list of assumed edges, rho gives each visit a rank; the other letters are
    those of Checker.v.

    [markers_ranked] says that the invariant of Ranked.v holds at the beginning, [fold_from_merged]
    that from any union-find with that invariant all is merged at the end or a conflict is found,
    and [conflict_found_iff] what a conflict means. *)
From Coq Require Import Arith Lia List Bool PArith FMapPositive.
Import ListNotations.
From Topo Require Import World Rotation Embedding Augment Log Determined Undetermined Classes
  Quotient Entailed Table TableCorrect Checker CheckerCorrect Ranked Saturated Complete.

Local Opaque fuel.

(** The log has fewer visits than the checker can follow. *)
Definition few_visits L := length (sights L) < 2 ^ fuel.

(** The place is one of the log, and its offset is below the degree of its visit. *)
Definition on_record L p := exists d, tidy L d p.

Section Decides.
Variables (L : Log) (extra : list (pplace * pplace)).
Notation T := (table_of (sights L)).
Notation D := (table_of (edges L extra)).
Notation find := PositiveMap.find.
Notation rep := (rep T fuel).
Hypothesis Few : few_visits L.
Hypothesis Legal : legal L = true.
Hypothesis Recorded : forall p q, In (p, q) extra -> on_record L p /\ on_record L q.

(** The roots are at most as many as the visits. *)
Lemma roots_few U : roots L U <= length (sights L).
Proof.
  unfold roots, mass, all_visits. generalize 1%positive.
  induction (sights L) as [|a l IH]; intros y; simpl; auto. specialize (IH (Pos.succ y)).
  unfold own at 1. destruct (find y U); lia.
Qed.

(** The ranks at the beginning fit the union-find in which nothing is merged. *)
Lemma empty_ranked : ranked L (PositiveMap.empty _) rank_0.
Proof.
  split; try (intros x y o E; rewrite PositiveMap.gempty in E; discriminate).
  - intros x S. exists x. rewrite PositiveMap.gempty. auto.
  - unfold mass, all_visits, sights. cbn [enum map fst list_sum].
    assert (G : forall (l : list Percept) y, y <> 1%positive -> list_sum (map
      (own (PositiveMap.empty _) (fun x => 2 ^ rank_0 x)) (map fst (enum y l))) = length l).
    { clear. intros l. induction l as [|a l IH]; intros y N; auto. cbn [enum map fst list_sum].
      assert (O : own (PositiveMap.empty pplace) (fun x => 2 ^ rank_0 x) y = 1).
      { unfold own, rank_0. rewrite PositiveMap.gempty. destruct (Pos.eqb_spec y 1); tauto. }
      change (own (PositiveMap.empty pplace) (fun x => 2 ^ rank_0 x) y + list_sum (map
        (own (PositiveMap.empty _) (fun x => 2 ^ rank_0 x)) (map fst (enum (Pos.succ y) l))) =
        S (length l)).
      rewrite O, IH; [auto|]. apply Pos.succ_not_1. }
    change (own (PositiveMap.empty pplace) (fun x => 2 ^ rank_0 x) 1 + list_sum (map
      (own (PositiveMap.empty _) (fun x => 2 ^ rank_0 x)) (map fst (enum (Pos.succ 1)
      (map snd (moves L))))) <= S (S (length (map snd (moves L))))).
    rewrite G by discriminate. unfold own. rewrite PositiveMap.gempty. simpl. lia.
  - intros x S. unfold rank_0. destruct (Pos.eqb_spec x 1) as [->|]; auto.
    unfold sign, sights in S.
    rewrite (table_of_find (start L :: map snd (moves L)) 1 (start L) eq_refl) in S.
    destruct (start L); discriminate.
Qed.

(** A visit that is a root represents its places. *)
Lemma rep_root U rho p : ranked L U rho -> sign L (fst p) <> None -> find (fst p) U = None ->
  rep U p = p.
Proof.
  intros R S N. exact (leads_det L U _ _ (rep_spec L Few U rho p R S) _ (leads_root L U p N)).
Qed.

(** If all visits that saw the marker have the degree of the start, the invariant holds at the
    beginning, and all these visits are merged with the start. *)
Lemma markers_ranked d0 : find 1%positive T = Some (d0, Some 0) ->
  (forall x d j, find x T = Some (d, Some j) -> d = d0 /\ j < d) ->
  let U := markers T (sights L) in ranked L U rank_0 /\
  forall x d j, find x T = Some (d, Some j) -> rep U (x, j) = rep U (1%positive, 0).
Proof.
  intros F1 Same. assert (P0 : 0 < d0) by (destruct (Same _ _ _ F1); auto).
  cbv zeta. unfold markers.
  (* The visits of [past] are merged; those that come later are roots. *)
  cut (forall rest past U, enum 1 (sights L) = past ++ rest -> ranked L U rank_0 ->
    find 1%positive U = None -> (forall x, ~ In x (map fst past) -> find x U = None) ->
    (forall x d j, In x (map fst past) -> find x T = Some (d, Some j) ->
      rep U (x, j) = rep U (1%positive, 0)) ->
    let U' := fold_left (fun U (v : positive * Percept) => match snd (snd v) with
      | Some j => unite T U (1%positive, 0) (fst v, j) | None => U end) rest U in
    ranked L U' rank_0 /\ forall x d j, In x (all_visits L) -> find x T = Some (d, Some j) ->
      rep U' (x, j) = rep U' (1%positive, 0)).
  { intros H. destruct (H (enum 1 (sights L)) [] (PositiveMap.empty _)) as [A B]; auto.
    - apply empty_ranked.
    - intros x _. apply PositiveMap.gempty.
    - intros x d j [].
    - split; auto. intros x d j E. apply (B x d j); auto.
      apply (visit_listed L). unfold sign. rewrite E. discriminate. }
  intros rest. induction rest as [|(x, (d, m)) rest IH]; intros past U E R N1 Later Before.
  { rewrite app_nil_r in E. split; auto. intros x d j I. apply Before. unfold all_visits in I.
    rewrite E in I. auto. }
  assert (Fx : find x T = Some (d, m)).
  { apply table_of_find, enum_1. rewrite E. apply in_or_app. simpl. auto. }
  assert (New : ~ In x (map fst past)).
  { assert (ND := visits_NoDup L). unfold all_visits in ND. rewrite E, map_app in ND.
    intros I. apply NoDup_remove_2 in ND. apply ND, in_or_app. auto. }
  assert (E' : enum 1 (sights L) = (past ++ [(x, (d, m))]) ++ rest) by (rewrite <- app_assoc; auto).
  assert (In' : forall y, In y (map fst (past ++ [(x, (d, m))])) -> In y (map fst past) \/ x = y).
  { intros y I. rewrite map_app in I. apply in_app_or in I as [I|[I|[]]]; auto. }
  assert (Out : forall y, ~ In y (map fst (past ++ [(x, (d, m))])) -> ~ In y (map fst past) /\ x <> y).
  { intros y I. rewrite map_app in I. split; [intros J|intros ->]; apply I, in_or_app; simpl; auto. }
  cbn [fold_left fst snd]. destruct m as [j|].
  2: { apply (IH (past ++ [(x, (d, None))]) U E' R N1).
    - intros y I. apply Later. apply (Out y I).
    - intros y e j I Fy. destruct (In' y I) as [I'| ->]; [eauto|]. congruence. }
  destruct (Same _ _ _ Fx) as [-> Lj].
  assert (S1 : sign L 1%positive = Some (d0, true)) by (unfold sign; rewrite F1; auto).
  assert (Sx : sign L x = Some (d0, true)) by (unfold sign; rewrite Fx; auto).
  assert (R1 : rep U (1%positive, 0) = (1%positive, 0))
    by (apply (rep_root U rank_0); auto; cbn [fst]; congruence).
  assert (Rx : rep U (x, j) = (x, j))
    by (apply (rep_root U rank_0); auto; cbn [fst]; congruence).
  destruct (Pos.eq_dec x 1) as [->|Nx].
  - assert (j = 0) as -> by congruence.
    assert (Q : unite T U (1%positive, 0) (1%positive, 0) = U).
    { unfold unite. destruct (rep U (1%positive, 0)) as (y, i). rewrite Pos.eqb_refl. auto. }
    rewrite Q. apply (IH (past ++ [(1%positive, (d0, Some 0))]) U E' R N1).
    + intros y I. apply Later. apply (Out y I).
    + intros y e i I Fy. destruct (In' y I) as [I'| <-]; [eauto|]. congruence.
  - destruct (unite_spec L Few U rank_0 d0 (1%positive, 0) (x, j) R) as (A & _ & B & C & F & _).
    + split; [exists (Some 0); auto|auto].
    + split; [exists (Some j); auto|auto].
    + cbn [fst]. congruence.
    + rewrite R1, Rx. cbn [fst]. auto.
    + rewrite R1, Rx. cbn [fst]. unfold rank_0. destruct (Pos.eqb_spec x 1); [tauto|apply Nat.le_0_l].
    + rewrite R1, Rx in A. rewrite Rx in F. cbn [fst] in A, F.
      assert (A' : ranked L (unite T U (1%positive, 0) (x, j)) rank_0).
      { eapply ranked_ext; [|exact A]. intros z. unfold raised, rank_0.
        destruct (Pos.eqb_spec z 1) as [->|]; auto. destruct (Pos.eqb_spec x 1); tauto. }
      apply (IH (past ++ [(x, (d0, Some j))]) _ E' A'); auto.
      * intros y I. destruct (Out y I) as [I1 I2]. apply F; auto.
      * intros y e i I Fy. destruct (In' y I) as [I'| <-].
        -- destruct (Same _ _ _ Fy) as [-> Li]. apply (C d0); [split; eauto|split; eauto|eauto].
        -- assert (i = j) as -> by congruence. symmetry. exact B.
Qed.

(** All visits that saw the marker are merged with the start. *)
Definition marks_merged U := forall x d j, find x T = Some (d, Some j) ->
  rep U (x, j) = rep U (1%positive, 0).

(** If merging on from a union-find leads to no conflict, it is ranked and has merged all at the
    end. *)
Lemma fold_from_merged U rho : ranked L U rho -> marks_merged U -> conflict_from L extra U rho = None ->
  let U' := fold_from L extra U rho in
  exists rho', ranked L U' rho' /\ all_merged L extra U' /\
  forall x d j, find x T = Some (d, Some j) -> j < d /\ rep U' (x, j) = rep U' (1%positive, 0).
Proof.
  intros R Marks H U'. unfold conflict_from in H. assert (None_of := find_none _ _ H). clear H.
  destruct (legal_spec L Legal) as ((d0 & S0) & Percepts & _).
  assert (F1 : find 1%positive T = Some (d0, Some 0)) by (apply table_of_find, S0).
  assert (T1 : tidy L d0 (1%positive, 0)).
  { split; [eauto|]. apply (proj1 (proj1 (proj2 (legal_spec L Legal)) _ _ _ S0)). }
  assert (Ends : tidy_ends L extra) by (apply legal_ends; auto).
  destruct (saturation_ends L extra Few Ends (S (length (sights L))) _ _ R) as (R' & K & Z).
  { assert (Q := roots_few U). lia. }
  change (fold_left _ _ _) with U' in R', K, Z.
  destruct Z as [(s & I & C)|Sat].
  - exfalso. rewrite None_of in C; [discriminate|]. unfold all_conflicts. apply in_or_app. left.
    apply in_map, I.
  - exists (ranks_after L extra (S (length (sights L))) U rho).
    split; [exact R'|]. split; [exact Sat|]. intros x d j E.
    assert (Lj : j < d).
    { assert (E' := E). apply table_of_spec in E'. apply (proj2 (Percepts _ _ _ E')). auto. }
    split; auto. assert (Tx : tidy L d (x, j)) by (split; eauto).
    assert (Sg : forall d p, tidy L d p -> sign L (fst p) = sign L (fst (rep U p))).
    { intros e p Tp. destruct (tidy_sign L e p Tp) as (w & W).
      apply (leads_tidy L U rho p _ R (rep_spec L Few U rho p R ltac:(congruence)) e Tp). }
    assert (Q := eq_trans (Sg d _ Tx) (eq_trans (f_equal (fun r => sign L (fst r)) (Marks x d j E))
      (eq_sym (Sg d0 _ T1)))). cbn [fst] in Q. unfold sign in Q. rewrite E, F1 in Q. injection Q as ->.
    exact (K _ _ _ Tx T1 (Marks _ _ _ E)).
Qed.

(** If merging on from a union-find leads to no conflict, the fold is consistent. *)
Theorem no_conflict_consistent U rho : ranked L U rho -> marks_merged U ->
  conflict_from L extra U rho = None -> consistent (map abs2 extra) L.
Proof.
  intros R0 M0 H. destruct (fold_from_merged U rho R0 M0 H) as (rho' & R & Sat & Marks).
  apply (unopposed_consistent L extra Legal Recorded Few _ rho' R Sat).
  - intros x d j E. apply (Marks x d j E).
  - assert (None_of := find_none _ _ H). intros x.
    destruct (find x D) as [e|] eqn:E; [|simpl; rewrite E; auto].
    apply None_of. unfold all_conflicts. do 2 (apply in_or_app; right). apply in_map.
    apply table_of_spec in E. destruct (in_enum (edges L extra) 1 _ _ E) as (y & I & Y).
    apply in_map_iff. exists (y, e). split; auto. simpl. apply Pos2Nat.inj.
    rewrite Y, Pos2Nat.inj_1. unfold num. assert (Q := Pos2Nat.is_pos x). lia.
Qed.

(** If the evidence of the whole log leads to no conflict, the invariants hold at the beginning. *)
Lemma markers_right : conflict_found L extra = None ->
  ranked L (markers T (sights L)) rank_0 /\ marks_merged (markers T (sights L)).
Proof.
  intros H. unfold conflict_found, conflict_from in H. assert (None_of := find_none _ _ H). clear H.
  destruct (legal_spec L Legal) as ((d0 & S0) & Percepts & _).
  assert (F1 : find 1%positive T = Some (d0, Some 0)) by (apply table_of_find, S0).
  apply (markers_ranked d0 F1). intros x d j E. split.
  2: { apply table_of_spec in E. apply (proj2 (Percepts _ _ _ E)). auto. }
  assert (C := None_of (Marked x)). simpl check_conflict in C. rewrite E in C.
  unfold apart in C. cbn [fst] in C. rewrite F1, E in C.
  destruct (Nat.eqb_spec d0 d) as [->|N]; auto. exfalso. simpl in C.
  assert (I : In (Marked x) (all_conflicts L extra)).
  { unfold all_conflicts. apply in_or_app. right. apply in_or_app. left. apply in_map.
    apply (visit_listed L). unfold sign. rewrite E. discriminate. }
  apply C in I. discriminate.
Qed.

(** The evidence decides: if it leads to no conflict, the fold is consistent. *)
Theorem saturated_decides : conflict_found L extra = None -> consistent (map abs2 extra) L.
Proof.
  intros H. destruct (markers_right H) as [R M]. apply (no_conflict_consistent _ _ R M H).
Qed.

(** The assumed edges join visits of the log. *)
Lemma recorded_known p q : In (p, q) extra -> valid L (abs p) /\ valid L (abs q).
Proof.
  intros I. destruct (Recorded p q I) as [(d & (m & Fp) & _) (e & (n & Fq) & _)].
  apply table_of_spec in Fp, Fq. unfold valid, abs, seen, sights in *. cbn [fst]. split; congruence.
Qed.

(** The evidence leads to no conflict exactly if some world shows the log and has the assumed
    edges. *)
Theorem conflict_found_iff : conflict_found L extra = None <-> possible (map abs2 extra) L.
Proof.
  split; [intros H; apply consistent_possible, saturated_decides, H|].
  intros P. destruct (conflict_found L extra) as [c|] eqn:F; auto. exfalso.
  apply find_some in F as [_ F]. revert P.
  apply (check_conflict_sound L extra recorded_known (saturated_fold L extra) c); auto.
  apply (folded_sound L extra recorded_known).
Qed.

(** Where no world shows the log and has the assumed edges, the checker accepts the first conflict
    that the evidence leads to. *)
Lemma first_conflict_shown : ~ possible (map abs2 extra) L ->
  check_conflict T D (saturated_fold L extra) (first_conflict L extra) = true.
Proof.
  intros N. unfold first_conflict. destruct (conflict_found L extra) as [c|] eqn:F.
  - apply (find_some _ _ F).
  - destruct N. apply conflict_found_iff, F.
Qed.

(** Where some world does, all that is identified is merged: two places that are one dart have the
    same representative. *)
Lemma identified_merged p q : possible (map abs2 extra) L -> on_record L p -> on_record L q ->
  same (map abs2 extra) L (abs p) (abs q) ->
  rep (saturated_fold L extra) p = rep (saturated_fold L extra) q.
Proof.
  intros P (d & Tp) (e & Tq) S. apply conflict_found_iff in P.
  destruct (markers_right P) as [R0 M0].
  destruct (fold_from_merged _ _ R0 M0 P) as (rho & R & Sat & Marks).
  destruct (same_merged L extra Legal Recorded Few _ rho R Sat Marks _ _ S) as [Eq|(_ & _ & Eq)].
  - rewrite <- (norm_abs L d p Tp), <- (norm_abs L e q Tq), Eq. auto.
  - rewrite (norm_abs L d p Tp), (norm_abs L e q Tq) in Eq. exact Eq.
Qed.
End Decides.
