(** Evidence exists wherever it is needed: what follows from a log, the programs of Checker.v accept
    with the evidence that [saturating] computes (claims 9 and 10; docs/mechanised.md).

    L is a log, extra the list of assumed edges, rho gives each visit a rank, W is a world, v i the
    reference dart of visit i; the other letters are those of Checker.v.

    These are the converses of the theorems of CheckerCorrect.v. They hold for logs of fewer than
    2^40 visits, since the checker follows at most 40 parents. A log whose visits are as many is
    never checked: a certificate has at most a million doors. *)
From Coq Require Import Arith Lia List Bool PArith FMapPositive.
Import ListNotations.
From Topo Require Import World Rotation Embedding Augment Log Determined Undetermined Classes
  Quotient Entailed Table TableCorrect Numbered Checker CheckerCorrect Ranked Saturated Complete.

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
  - destruct (unite_spec L Few U rank_0 d0 (1%positive, 0) (x, j) R) as (A & _ & B & C & F).
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

(** If the evidence leads to no conflict, the union-find is ranked and saturated, and all visits
    that saw the marker are merged with the start. *)
Lemma saturated_invariant : conflict_found L extra = None -> let U := saturated_fold L extra in
  exists rho, ranked L U rho /\ all_merged L extra U /\
  forall x d j, find x T = Some (d, Some j) -> j < d /\ rep U (x, j) = rep U (1%positive, 0).
Proof.
  intros H U. unfold conflict_found in H.
  assert (None_of := find_none _ _ H). clear H.
  destruct (legal_spec L Legal) as ((d0 & S0) & Percepts & _).
  assert (F1 : find 1%positive T = Some (d0, Some 0)) by (apply table_of_find, S0).
  assert (Lt : forall x d j, find x T = Some (d, Some j) -> j < d).
  { intros x d j E. apply table_of_spec in E. apply (proj2 (Percepts _ _ _ E)). auto. }
  assert (Same : forall x d j, find x T = Some (d, Some j) -> d = d0 /\ j < d).
  { intros x d j E. split; [|eauto].
    assert (C := None_of (Marked x)). simpl check_conflict in C. rewrite E in C.
    unfold apart in C. cbn [fst] in C. rewrite F1, E in C.
    destruct (Nat.eqb_spec d0 d) as [->|N]; auto. exfalso. simpl in C.
    assert (I : In (Marked x) (all_conflicts L extra)).
    { unfold all_conflicts. apply in_or_app. right. apply in_or_app. left. apply in_map.
      apply (visit_listed L). unfold sign. rewrite E. discriminate. }
    apply C in I. discriminate. }
  destruct (markers_ranked d0 F1 Same) as [R Marks].
  assert (Ends : tidy_ends L extra) by (apply legal_ends; auto).
  destruct (saturation_ends L extra Few Ends (S (length (sights L))) _ _ R) as (R' & K & Z).
  { assert (Q := roots_few (markers T (sights L))). lia. }
  change (fold_left _ _ _) with U in R', K, Z.
  destruct Z as [(s & I & C)|Sat].
  - exfalso. rewrite None_of in C; [discriminate|]. unfold all_conflicts. apply in_or_app. left.
    apply in_map, I.
  - exists (ranks_after L extra (S (length (sights L))) (markers T (sights L)) rank_0).
    split; [exact R'|]. split; [exact Sat|]. intros x d j E. split; [eauto|].
    destruct (Same _ _ _ E) as [-> Lj].
    apply (K d0); [split; [eauto|auto]|split; [eauto|simpl; lia]|eauto].
Qed.

(** The evidence decides: if it leads to no conflict, the fold is consistent. *)
Theorem saturated_decides : conflict_found L extra = None -> consistent (map abs2 extra) L.
Proof.
  intros H. destruct (saturated_invariant H) as (rho & R & Sat & Marks).
  apply (unopposed_consistent L extra Legal Recorded Few _ rho R Sat).
  - intros x d j E. apply (Marks x d j E).
  - assert (None_of := find_none _ _ H). intros x.
    destruct (find x D) as [e|] eqn:E; [|simpl; rewrite E; auto].
    apply None_of. unfold all_conflicts. do 2 (apply in_or_app; right). apply in_map.
    apply table_of_spec in E. destruct (in_enum (edges L extra) 1 _ _ E) as (y & I & Y).
    apply in_map_iff. exists (y, e). split; auto. simpl. apply Pos2Nat.inj.
    rewrite Y, Pos2Nat.inj_1. unfold num. assert (Q := Pos2Nat.is_pos x). lia.
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
  destruct (saturated_invariant P) as (rho & R & Sat & Marks).
  destruct (same_merged L extra Legal Recorded Few _ rho R Sat Marks _ _ S) as [Eq|(_ & _ & Eq)].
  - rewrite <- (norm_abs L d p Tp), <- (norm_abs L e q Tq), Eq. auto.
  - rewrite (norm_abs L d p Tp), (norm_abs L e q Tq) in Eq. exact Eq.
Qed.
End Decides.

(** A log that a world shows is legal, and possible. *)
Lemma shown_possible W L : world W -> replays W L -> legal L = true /\ possible nothing L.
Proof.
  intros HW R. split; [apply (legal_shown W L HW R)|].
  apply replays_visits in R as [v V]; [|apply HW]. exists W, v. split; auto. split; auto. intros p q [].
Qed.

(** No edge is assumed. *)
Lemma nothing_recorded L p q : In (p, q) [] -> on_record L p /\ on_record L q.
Proof. intros []. Qed.

(** A dart that was noted stays noted. *)
Lemma cover_keeps T D U C a x k : In k (offsets C x) -> In k (offsets (cover T D U C a) x).
Proof.
  intros I. unfold cover. destruct (arc_ends D a) as [(p, q)|]; auto.
  destruct (rep T fuel U p) as (y, j). destruct (existsb _ _); auto.
  unfold offsets. destruct (Pos.eq_dec x y) as [->|N].
  - rewrite PositiveMap.gss. simpl. auto.
  - rewrite PositiveMap.gso; auto.
Qed.

(** The dart by which an arc leaves is noted. *)
Lemma cover_notes T D U C a p q x k : arc_ends D a = Some (p, q) -> rep T fuel U p = (x, k) ->
  In k (offsets (cover T D U C a) x).
Proof.
  intros E R. unfold cover. rewrite E, R. destruct (existsb (Nat.eqb k) (offsets C x)) eqn:B.
  - apply existsb_exists in B as (j & I & B). apply Nat.eqb_eq in B as ->. auto.
  - unfold offsets. rewrite PositiveMap.gss. simpl. auto.
Qed.

(** [covered] notes the darts by which all arcs of the list leave. *)
Lemma covered_complete T D U l b y p q x k : In y (map fst (enum 1 l)) ->
  arc_ends D (b, y) = Some (p, q) -> rep T fuel U p = (x, k) -> In k (offsets (covered T D U l) x).
Proof.
  unfold covered. generalize (enum 1 l) (PositiveMap.empty (list nat)). intros e.
  induction e as [|m e IH]; intros C I E R; [destruct I|].
  cbn [fold_left]. destruct I as [I|I]; [|apply IH; auto].
  subst y. clear IH.
  assert (N : In k (offsets (cover T D U (cover T D U C (true, fst m)) (false, fst m)) x)).
  { destruct b; [apply cover_keeps|]; eapply cover_notes; eauto. }
  revert N. generalize (cover T D U (cover T D U C (true, fst m)) (false, fst m)). clear.
  induction e as [|m e IH]; intros C N; auto. cbn [fold_left]. apply IH. auto using cover_keeps.
Qed.

(** Claim 9: wherever a log is closed and some world shows it, the checker accepts the evidence that
    [saturating] computes from the log. *)
Theorem proves_accepts W L : world W -> replays W L -> few_visits L -> closed L ->
  proves L (saturating L []) = true.
Proof.
  intros HW R Few C. destruct (shown_possible W L HW R) as [Legal P].
  unfold proves. fold (saturated_fold L []). unfold check_closed. apply forallb_forall.
  intros (x, (d, m)) I. cbn [fst snd]. apply enum_1 in I.
  assert (Dp := proj1 (proj1 (proj2 (legal_spec L Legal)) _ _ _ I)).
  rewrite (proj2 (Nat.ltb_lt _ _) Dp). simpl. apply forallb_forall. intros i Li. apply in_seq in Li.
  assert (F : PositiveMap.find x (table_of (sights L)) = Some (d, m)) by (apply table_of_find, I).
  assert (V : valid L (abs (x, i))) by (unfold valid, abs, seen, sights in *; cbn [fst]; congruence).
  destruct (C _ V) as (p & q & K & S).
  destruct (link_arc L [] p q K) as (a & p' & q' & E & <- & <-).
  destruct (legal_ends L [] Legal (nothing_recorded L) a p' q' E) as [Tp _].
  assert (Q := identified_merged L [] Few Legal (nothing_recorded L) (x, i) p' P
    ltac:(exists d; split; [exists m; auto|simpl; lia]) Tp S).
  destruct (rep _ _ _ (x, i)) as (y, k). apply existsb_exists. exists k. split; [|apply Nat.eqb_refl].
  assert (A := arc_listed L [] a p' q' E). unfold all_arcs in A. apply in_flat_map in A as (z & Iz & A).
  assert (a = (fst a, z)) as Ea by (destruct A as [<-|[<-|[]]]; auto).
  apply (covered_complete _ _ _ _ (fst a) z p' q'); auto. rewrite <- Ea. auto.
Qed.

(** Claim 9: wherever no world shows a log, the checker accepts the conflict that [saturating] leads
    to. *)
Theorem impossible_accepts L : few_visits L -> (forall W, world W -> ~ replays W L) ->
  impossible L (saturating L []) (first_conflict L []) = true.
Proof.
  intros Few N. unfold impossible. destruct (legal L) eqn:Legal; auto. simpl.
  apply (first_conflict_shown L [] Few Legal (nothing_recorded L)).
  intros (W & v & HW & V & _). apply (N W HW), (visits_replays W L v V).
Qed.

(** Claim 10, reject: wherever no world that shows a legal log has an edge from p to q, the checker
    accepts the conflict that [saturating] leads to if this edge is assumed. *)
Theorem rejected_accepts L p q : few_visits L -> legal L = true -> on_record L p -> on_record L q ->
  (forall W v, world W -> visits W L v -> alpha W (dart W v (abs p)) <> Some (dart W v (abs q))) ->
  rejected L p q (saturating L [(p, q)]) (first_conflict L [(p, q)]) = true.
Proof.
  intros Few Legal P Q N.
  assert (Rec : forall a b, In (a, b) [(p, q)] -> on_record L a /\ on_record L b).
  { intros a b [I|[]]. injection I as <- <-. auto. }
  assert (Mem : forall a, on_record L a -> PositiveMap.mem (fst a) (table_of (sights L)) = true).
  { intros a (d & (m & F) & _). rewrite PositiveMap.mem_find, F. auto. }
  unfold rejected. rewrite !Mem by auto. simpl andb.
  apply (first_conflict_shown L [(p, q)] Few Legal Rec).
  intros (W & v & HW & V & F). apply (N W v HW V), (F (abs p) (abs q)). simpl. auto.
Qed.

(** Claim 9, the verdict PROVED: wherever a log is closed and some world shows it, the checker accepts
    a table with that evidence. *)
Theorem certified_accepts W L : world W -> replays W L -> few_visits L -> closed L ->
  exists t, certified L t (saturating L []) = true.
Proof.
  intros HW R Few C.
  destruct (table_exists W L (world_is_map W HW) (world_connected W HW) R) as (t & A & B).
  exists t. unfold certified. rewrite A, (proves_accepts W L HW R Few C).
  rewrite (proj2 B (world_total W HW)). auto.
Qed.

(** Claim 9, the verdict REFUTED where worlds exist: wherever two worlds that differ show a log, the
    checker accepts a table. *)
Theorem refute_accepts L : undetermined L -> exists t, refute L t = true.
Proof.
  intros (W & W' & HW & HW' & R & R' & N). destruct (shown_possible W L HW R) as [_ P].
  apply possible_consistent in P; [|intros p q []].
  destruct (quotient_exists L nothing P) as (M & u & Q).
  destruct (table_exists M L) as (t & A & B); try apply Q; [apply (visits_replays M L u), Q|].
  exists t. unfold refute. rewrite A. simpl. apply negb_true_iff, not_true_iff_false. intros T.
  apply N. apply (closed_determines L); auto. intros p V.
  destruct (q_link _ _ _ _ Q p V) as (q & r & K & S & _); [|eauto].
  apply (proj1 B T), turn_lt; [apply Q|]. apply (v_lt M L u (q_visits _ _ _ _ Q)).
Qed.

(** The first arc that joins the classes of p and q. *)
Definition joining_arc L p q := match List.find (check_partners (table_of (sights L))
  (table_of (edges L [])) (saturated_fold L []) p q) (all_arcs L []) with
  | Some a => a | None => (true, 1%positive) end.

(** Claim 10, confirm: wherever every world that shows a log has an edge from p to q, and some world
    shows it, the checker accepts the arc that joins them after [saturating]. *)
Theorem confirmed_accepts W L p q : world W -> replays W L -> few_visits L ->
  on_record L p -> on_record L q ->
  (forall W v, world W -> visits W L v -> alpha W (dart W v (abs p)) = Some (dart W v (abs q))) ->
  confirmed L p q (saturating L []) (joining_arc L p q) = true.
Proof.
  intros HW R Few P Q H. destruct (shown_possible W L HW R) as [Legal Pos].
  assert (V : forall a, on_record L a -> valid L (abs a)).
  { intros a (d & (m & F) & _). apply table_of_spec in F. unfold valid, abs, seen, sights in *.
    cbn [fst]. congruence. }
  assert (C : consistent nothing L) by (apply possible_consistent; [intros a b []|auto]).
  apply confirmation_entailed_iff in H as (p1 & q1 & K & S & S'); auto.
  destruct (link_arc L [] p1 q1 K) as (a & p' & q' & E & <- & <-).
  destruct (legal_ends L [] Legal (nothing_recorded L) a p' q' E) as [Tp Tq].
  unfold confirmed. fold (saturated_fold L []). unfold joining_arc.
  destruct (List.find _ _) as [b|] eqn:F; [apply (find_some _ _ F)|].
  assert (B := find_none _ _ F a (arc_listed L [] a p' q' E)). unfold check_partners in B.
  rewrite E in B.
  rewrite (identified_merged L [] Few Legal (nothing_recorded L) p p' Pos P Tp S) in B.
  rewrite (identified_merged L [] Few Legal (nothing_recorded L) q q' Pos Q Tq S') in B.
  rewrite !pplace_eqb_refl in B. discriminate.
Qed.
