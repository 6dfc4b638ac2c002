(** Evidence exists wherever it is needed: what follows from a log, the programs of Checker.v accept
    with the evidence that [saturating] computes (claims 9 and 10; docs/proofs.md).

    L is a log, extra the list of assumed edges, rho gives each visit a rank, W is a world, v i the
    reference dart of visit i; the other letters are those of Checker.v.

    These are the converses of the theorems of CheckerCorrect.v. They hold for logs of fewer than
    2^40 visits, since the checker follows at most 40 parents. A log whose visits are as many is
    never checked: a certificate has at most a million doors. *)
From Coq Require Import Arith Lia List Bool PArith FMapPositive.
Import ListNotations.
From Topo Require Import World Rotation Embedding Augment Log Determined Undetermined Classes
  Quotient Entailed Table TableCorrect Numbered Checker CheckerCorrect Ranked Saturated Complete
  Conflicts.

Local Opaque fuel.

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
    [saturating] computes from the log.
    Not in the paper. *)
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
    to.
    Not in the paper. *)
Theorem impossible_accepts L : few_visits L -> (forall W, world W -> ~ replays W L) ->
  impossible L (saturating L []) (first_conflict L []) = true.
Proof.
  intros Few N. unfold impossible. destruct (legal L) eqn:Legal; auto. simpl.
  apply (first_conflict_shown L [] Few Legal (nothing_recorded L)).
  intros (W & v & HW & V & _). apply (N W HW), (visits_replays W L v V).
Qed.

(** Claim 10, reject: wherever no world that shows a legal log has an edge from p to q, the checker
    accepts the conflict that [saturating] leads to if this edge is assumed.
    Not in the paper. *)
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
    a table with that evidence.
    Not in the paper. *)
Theorem certified_accepts W L : world W -> replays W L -> few_visits L -> closed L ->
  exists t, certified L t (saturating L []) = true.
Proof.
  intros HW R Few C.
  destruct (table_exists W L (world_is_map W HW) (world_connected W HW) R) as (t & A & B).
  exists t. unfold certified. rewrite A, (proves_accepts W L HW R Few C).
  rewrite (proj2 B (world_total W HW)). auto.
Qed.

(** Claim 9, the verdict REFUTED where worlds exist: wherever two worlds that differ show a log, the
    checker accepts a table.
    Not in the paper. *)
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
    shows it, the checker accepts the arc that joins them after [saturating].
    Not in the paper. *)
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

(** Rule folding on a log: keep the hypothesis that an edge leads from p to q unless merging all that
    follows from it ends in a conflict. *)
Definition folding_keeps L p q := match conflict_found L [(p, q)] with
  | None => true | Some _ => false end.

(** Claim 10: folding, as a program, keeps exactly the hypotheses that are true in some world that
    shows the log.
    Not in the paper. *)
Theorem folding_exact L p q : few_visits L -> legal L = true -> on_record L p -> on_record L q ->
  folding_keeps L p q = true <->
  exists W v, world W /\ visits W L v /\ alpha W (dart W v (abs p)) = Some (dart W v (abs q)).
Proof.
  intros Few Legal P Q.
  assert (Rec : forall a b, In (a, b) [(p, q)] -> on_record L a /\ on_record L b).
  { intros a b [I|[]]. injection I as <- <-. auto. }
  assert (Iff := conflict_found_iff L [(p, q)] Few Legal Rec). unfold folding_keeps.
  transitivity (conflict_found L [(p, q)] = None);
    [destruct (conflict_found L [(p, q)]); split; congruence|].
  rewrite Iff. unfold possible, fits. simpl. split; intros (W & v & HW & V & E); exists W, v.
  - split; auto.
  - split; auto. split; auto. intros a b [I|[]]. injection I as <- <-. auto.
Qed.
