(** From one move of a log to the next no merge is left among old arcs (claim 10;
    docs/proofs.md).

    L is the log so far, L' the log one move later, W0 a world that shows both, y the last
    visit of L', rho gives each visit a rank; y0 is the visit at which the union-find was last merged
    to the end; the other letters are those of Decisions.v.

    The invariant of the walk is [walking]: the union-find is ranked, and no merge is left among the
    arcs before y0. A move adds a visit that nothing was merged with, so it leaves no merge among old
    arcs ([onward_walking]). Hence the next merge has a new arc, and [settle] stops before it. *)
From Coq Require Import Arith Lia List Bool PArith FMapPositive.
Import ListNotations.
From Topo Require Import World Rotation Embedding Augment Log Determined Undetermined Classes
  Quotient Entailed Table Checker CheckerCorrect Ranked Saturated Complete Conflicts Accepted
  Events Decisions DecisionsCorrect Judged.

Local Opaque fuel.

(** Both arcs of a step were there at visit y. *)
Definition both_before y (s : arc * arc) := Pos.ltb (snd (fst s)) y && Pos.ltb (snd (snd s)) y.

(** The evidence is empty, or its first step has an arc that was not there at visit y. *)
Definition later_first y (ev : evidence) :=
  match ev with [] => true | s :: _ => negb (both_before y s) end.

(** The invariant of the walk: all is ranked, the markers are merged, and what the arcs before y0 ask
    to be merged is merged. *)
Record walking L m rho y0 : Prop := {
  wk_true : true_moment L m;
  wk_ranked : ranked L (unified m) rho;
  wk_marks : marks_merged L (unified m);
  wk_old : forall s p q, meet (table_of (sights L)) (table_of (edges L [])) (unified m) s =
    Some (p, q) ->
    both_before y0 s = true ->
    rep (table_of (sights L)) fuel (unified m) p = rep (table_of (sights L)) fuel (unified m) q;
  wk_y : Pos.le y0 (here m) }.

(** The same moment with all merges that are left. *)
Definition merged_on L m rho := {| here := here m; sighted := sighted m; crossed := crossed m;
  unified := fold_from L [] (unified m) rho |}.

Section Settle.
Variables (L : Log) (W0 : Map) (v0 : nat -> nat) (m : moment) (rho : positive -> nat) (y0 : positive).
Hypotheses (HW0 : world W0) (V0 : visits W0 L v0) (Few : few_visits L) (Walk : walking L m rho y0).
Notation T := (table_of (sights L)).
Notation D := (table_of (edges L [])).

(** After all merges the moment is ready. *)
Lemma settled_ready : exists rho', ready L (merged_on L m rho) rho'.
Proof.
  destruct (shown_possible W0 L HW0 (visits_replays W0 L v0 V0)) as [Legal Pos].
  destruct Walk as [(N & HT & HD & HU) R Mk _ _].
  assert (Nil : forall a b, In (a, b) [] -> valid L (abs a) /\ valid L (abs b)) by (intros a b []).
  assert (HU' : true_uf L [] (fold_from L [] (unified m) rho)) by (apply glues_sound; auto).
  destruct (conflict_from L [] (unified m) rho) as [c|] eqn:F.
  - exfalso. apply find_some in F as [_ F].
    apply (check_conflict_sound L [] Nil _ c HU' F Pos).
  - destruct (fold_from_merged L [] Few Legal (nothing_recorded L) _ rho R Mk F)
      as (rho' & R' & Sat & Mk').
    exists rho'. split; auto.
    + do 3 (split; auto).
    + intros x d j E. apply (Mk' x d j E).
Qed.

(** The arcs of a next merge were there. *)
Lemma next_merge_before U s p q : next_merge L [] U = Some (s, p, q) ->
  both_before (here m) s = true /\ pending L [] U s = true.
Proof.
  unfold next_merge. destruct (List.find _ _) as [s'|] eqn:F; [|discriminate].
  apply find_some in F as [_ F]. destruct (meet T D U s') as [(p', q')|] eqn:M; [|discriminate].
  destruct (apart T U p' q'); [discriminate|]. intros E. injection E as -> _ _. split; auto.
  assert (G : forall a r, arc_ends D a = Some r -> Pos.ltb (snd a) (here m) = true).
  { intros a r E. unfold arc_ends in E.
    destruct (PositiveMap.find (snd a) D) as [e|] eqn:Fe; [|discriminate].
    apply table_of_spec in Fe. apply Pos.ltb_lt, Pos2Nat.inj_lt.
    assert (Lt : num (snd a) < length (edges L [])) by (apply nth_error_Some; congruence).
    unfold edges in Lt. rewrite app_nil_r, map_length, enum_length, map_length in Lt.
    destruct Walk as [(N & _) _ _ _ _]. rewrite <- N in Lt. unfold num in Lt.
    assert (A := Pos2Nat.is_pos (snd a)). assert (B := Pos2Nat.is_pos (here m)). lia. }
  unfold meet in M. unfold both_before.
  destruct (arc_ends D (fst s)) as [(a, b)|] eqn:E1; [|discriminate].
  destruct (arc_ends D (snd s)) as [(c, d)|] eqn:E2; [|discriminate].
  rewrite (G _ _ E1), (G _ _ E2). auto.
Qed.

(** So were those of all merges. *)
Lemma saturation_before n : forall U rho, forallb (both_before (here m))
  (saturation L [] n U rho) = true.
Proof.
  induction n as [|n IH]; intros U r; auto. cbn [saturation].
  destruct (next_merge L [] U) as [((s, p), q)|] eqn:F; auto.
  destruct (next_merge_before U s p q F) as [B _]. cbn zeta.
  destruct (_ <=? _); cbn [forallb]; rewrite IH, ?B; auto.
  unfold both_before in *. cbn [fst snd]. rewrite andb_comm in B. rewrite B. auto.
Qed.

(** The first merge has a new arc. *)
Lemma saturating_later : later_first y0 (saturating_from L [] (unified m) rho) = true.
Proof.
  unfold saturating_from. cbn [saturation].
  destruct (next_merge L [] (unified m)) as [((s, p), q)|] eqn:F; auto.
  destruct (next_merge_before _ s p q F) as [_ P]. cbn zeta.
  assert (N : both_before y0 s = false).
  { apply not_true_iff_false. intros B. unfold pending in P.
    destruct (meet T D (unified m) s) as [(a, b)|] eqn:M; [|discriminate].
    rewrite (wk_old _ _ _ _ Walk s a b M B), pplace_eqb_refl in P. discriminate. }
  destruct (_ <=? _); cbn [later_first]; [rewrite N; auto|].
  unfold both_before in *. cbn [fst snd]. rewrite andb_comm, N. auto.
Qed.

(** [settle] does exactly these merges, if what is left starts with a new arc. *)
Lemma settle_merges ev : later_first (here m) ev = true ->
  settle m (saturating_from L [] (unified m) rho ++ ev) = (merged_on L m rho, ev).
Proof.
  intros Lf. assert (B := saturation_before (S (length (sights L))) (unified m) rho).
  unfold merged_on, fold_from. fold (saturating_from L [] (unified m) rho) in B.
  destruct Walk as [(N & HT & HD & _) _ _ _ _]. rewrite <- HT, <- HD. revert B.
  generalize (saturating_from L [] (unified m) rho). clear - Lf. intros l.
  assert (G : forall U, forallb (both_before (here m)) l = true ->
    settle {| here := here m; sighted := sighted m; crossed := crossed m; unified := U |} (l ++ ev) =
    ({| here := here m; sighted := sighted m; crossed := crossed m;
        unified := fold_left (glue (sighted m) (crossed m)) l U |}, ev)).
  { induction l as [|s l IH]; intros U B; cbn [app fold_left].
    - destruct ev as [|s ev]; auto. simpl in *. fold (both_before (here m) s).
      apply negb_true_iff in Lf. rewrite Lf. auto.
    - cbn [forallb] in B. apply andb_true_iff in B as [B1 B2]. cbn [settle here].
      fold (both_before (here m) s). rewrite B1. apply (IH _ B2). }
  intros B. rewrite <- (G (unified m) B). destruct m; auto.
Qed.
End Settle.

Section Onward.
Variables (L : Log) (W0 : Map) (v0 : nat -> nat) (m : moment) (rho : positive -> nat) (y0 : positive)
  (a : nat * Percept).
Let L' := {| start := start L; moves := moves L ++ [a] |}.
Hypotheses (HW0 : world W0) (V0 : visits W0 L v0) (V0' : visits W0 L' v0) (Few' : few_visits L')
  (Walk : walking L m rho y0).
Notation T := (table_of (sights L)).
Notation T' := (table_of (sights L')).
Notation y := (Pos.succ (here m)).

(** The table of percepts has one more entry. *)
Lemma onward_table : T' = PositiveMap.add y (snd a) T /\ sign L y = None.
Proof.
  destruct Walk as [(N & _) _ _ _ _].
  assert (Y : num y = length (sights L)) by (rewrite num_succ, N; unfold sights; simpl;
    rewrite map_length; auto).
  split.
  - unfold L', sights. simpl. rewrite map_app, app_comm_cons. apply table_of_snoc. exact Y.
  - unfold sign. destruct (PositiveMap.find y T) as [p|] eqn:E; auto. exfalso.
    apply table_of_spec in E. rewrite Y in E.
    assert (Lt : length (sights L) < length (sights L)) by (apply nth_error_Some; congruence). lia.
Qed.

(** Old visits keep their signs. *)
Lemma sign_onward x : sign L x <> None -> PositiveMap.find x T' = PositiveMap.find x T /\
  sign L' x = sign L x.
Proof.
  destruct onward_table as [E N]. intros S. assert (x <> y) by congruence.
  assert (F : PositiveMap.find x T' = PositiveMap.find x T) by (rewrite E; apply PositiveMap.gso; auto).
  split; auto. unfold sign. rewrite F. auto.
Qed.

(** The union-find is ranked in the longer log. *)
Lemma ranked_onward : ranked L' (unified m) rho /\ PositiveMap.find y (unified m) = None.
Proof.
  destruct onward_table as [E N]. destruct (wk_ranked _ _ _ _ Walk) as [A B C M O].
  assert (Ny : PositiveMap.find y (unified m) = None).
  { destruct (PositiveMap.find y (unified m)) as [(z, o)|] eqn:F; auto. destruct (B _ _ _ F). tauto. }
  split; auto. split; auto.
  - intros x z o F. destruct (B x z o F) as [B1 B2]. assert (Sz : sign L z <> None) by congruence.
    rewrite (proj2 (sign_onward x B2)), (proj2 (sign_onward z Sz)). auto.
  - intros x S. destruct (sign L x) as [w|] eqn:Sx.
    + destruct (C x) as (r & C1 & C2 & C3); [congruence|]. exists r.
      rewrite (proj2 (sign_onward r C2)). auto.
    + exists x. split; auto. destruct (PositiveMap.find x (unified m)) as [(z, o)|] eqn:F; auto.
      destruct (B _ _ _ F). tauto.
  - assert (Sights : sights L' = sights L ++ [snd a])
      by (unfold L', sights; simpl; rewrite map_app; auto).
    assert (Visits : all_visits L' = all_visits L ++ [y]).
    { unfold all_visits. rewrite Sights, (enum_snoc _ 1 y), map_app; auto.
      destruct Walk as [(Nm & _) _ _ _ _]. unfold num in Nm. rewrite Pos2Nat.inj_succ, Pos2Nat.inj_1.
      unfold sights. simpl. rewrite map_length, <- Nm. assert (Q := Pos2Nat.is_pos (here m)). lia. }
    assert (Ow : own (unified m) (fun x => 2 ^ rho x) y = 1).
    { unfold own. rewrite Ny, (O y N). auto. }
    unfold mass in *. rewrite Visits, map_app, list_sum_app, Sights, app_length. cbn [map length].
    change (list_sum [own (unified m) (fun x => 2 ^ rho x) y])
      with (own (unified m) (fun x => 2 ^ rho x) y + 0). rewrite Ow. lia.
  - intros x S. apply O. destruct (sign L x) as [w|] eqn:Sx; auto.
    rewrite (proj2 (sign_onward x ltac:(congruence))) in S. congruence.
Qed.

(** Old places lead where they led. *)
Lemma rep_onward p : sign L (fst p) <> None ->
  rep T' fuel (unified m) p = rep T fuel (unified m) p.
Proof.
  intros S. destruct ranked_onward as [R' _]. assert (R := wk_ranked _ _ _ _ Walk).
  assert (Few : few_visits L).
  { unfold few_visits in *. eapply Nat.le_lt_trans; [|exact Few']. unfold L', sights. simpl.
    rewrite map_app, app_length. apply le_n_S, Nat.le_add_r. }
  assert (Up : forall p r, leads L (unified m) p r -> sign L (fst p) <> None ->
    leads L' (unified m) p r).
  { intros q r H. induction H as [q N|q z o r E _ IH]; intros Sq; [constructor; auto|].
    destruct (rk_sign _ _ _ R _ z o E) as [A B]. assert (Sz : sign L z <> None) by congruence.
    apply leads_up with z o; auto.
    assert (Rd : reduced T' (z, snd q + o) = reduced T (z, snd q + o)).
    { unfold reduced. cbn [fst]. rewrite (proj1 (sign_onward z Sz)). auto. }
    fold T'. rewrite Rd. apply IH. unfold reduced. cbn [fst].
    destruct (PositiveMap.find z T) as [(d, k)|]; auto. }
  assert (S' : sign L' (fst p) <> None) by (rewrite (proj2 (sign_onward _ S)); auto).
  exact (leads_det L' _ _ _ (rep_spec L' Few' _ rho p R' S') _ (Up _ _ (rep_spec L Few _ rho p R S) S)).
Qed.

(** After the move, too: and what saw the marker is merged with the start. *)
Lemma onward_merged : exists rho', ranked L' (unified (onward m a)) rho' /\
  (forall p, (exists d, tidy L d p) -> rep T' fuel (unified (onward m a)) p =
    rep T fuel (unified m) p) /\
  forall d j, snd a = (d, Some j) ->
    rep T' fuel (unified (onward m a)) (y, j) = rep T' fuel (unified (onward m a)) (1%positive, 0).
Proof.
  destruct onward_table as [E N]. destruct ranked_onward as [R' Ny].
  assert (R := wk_ranked _ _ _ _ Walk).
  destruct (wk_true _ _ _ _ Walk) as (_ & HT & _).
  assert (Old : forall p, (exists d, tidy L d p) -> sign L (fst p) <> None).
  { intros p (d & Tp). destruct (tidy_sign L d p Tp) as (w & ->). discriminate. }
  destruct (snd a) as (d, [j|]) eqn:Ea.
  2: { assert (Eq : unified (onward m a) = unified m) by (simpl; rewrite Ea; auto).
       rewrite Eq. exists rho. split; [exact R'|]. split; [|discriminate].
       intros p P. apply rep_onward, Old, P. }
  assert (Leg := legal_shown W0 L' HW0 (visits_replays W0 L' v0 V0')).
  destruct (legal_spec L' Leg) as ((d0 & S0) & Percepts & _).
  assert (Fy : PositiveMap.find y T' = Some (d, Some j)) by (rewrite E; apply PositiveMap.gss).
  assert (F1 : PositiveMap.find 1%positive T' = Some (d0, Some 0)) by (apply table_of_find, S0).
  assert (Fy' := Fy). apply table_of_spec in Fy'.
  destruct (Percepts _ _ _ Fy') as [Pd Lj]. specialize (Lj j eq_refl).
  assert (Cons : consistent nothing L').
  { apply possible_consistent; [intros q r []|]. apply (shown_possible W0 L' HW0).
    apply (visits_replays W0 L' v0 V0'). }
  assert (d0 = d) as ->.
  { symmetry. apply (c_degree nothing L' Cons (num y) j 0 0 d (Some j) d0 (Some 0)); auto.
    apply (same_mark nothing L' (num y) d j Fy'). }
  assert (T1 : tidy L d (1%positive, 0)).
  { split; [|exact Pd]. exists (Some 0). apply table_of_find. unfold seen in S0. exact S0. }
  assert (Rep1 := rep_onward (1%positive, 0) (Old _ (ex_intro _ d T1))).
  assert (Sy : sign L' (fst (y, j)) <> None) by (cbn [fst]; unfold sign; fold T'; rewrite Fy;
    discriminate).
  assert (RepY := rep_root L' Few' (unified m) rho (y, j) R' Sy Ny).
  assert (Few : few_visits L).
  { unfold few_visits in *. eapply Nat.le_lt_trans; [|exact Few']. unfold L', sights. simpl.
    rewrite map_app, app_length. apply le_n_S, Nat.le_add_r. }
  assert (Root : forall p, (exists d, tidy L d p) -> sign L (fst (rep T fuel (unified m) p)) <> None).
  { intros p (e & Tp). assert (Sp := Old p (ex_intro _ e Tp)).
    destruct (leads_tidy L _ rho p _ R (rep_spec L Few _ rho p R Sp) e Tp) as [_ <-]. auto. }
  assert (NotY : forall p, (exists d, tidy L d p) -> fst (rep T' fuel (unified m) p) <> y).
  { intros p P Q. apply (Root p P). rewrite <- (rep_onward p (Old p P)), Q. auto. }
  destruct (unite_spec L' Few' (unified m) rho d (1%positive, 0) (y, j) R') as (A & _ & B & _ & _ & G).
  - split; [exists (Some 0); exact F1|exact Pd].
  - split; [exists (Some j); exact Fy|exact Lj].
  - cbn [fst]. unfold sign. fold T'. rewrite F1, Fy. auto.
  - rewrite RepY. apply NotY. exists d. exact T1.
  - rewrite RepY. cbn [fst]. rewrite (rk_out _ _ _ R y N). apply Nat.le_0_l.
  - assert (Eq : unified (onward m a) = unite T' (unified m) (1%positive, 0) (y, j)).
    { rewrite E, <- HT, <- Ea. simpl. rewrite Ea. auto. }
    rewrite Eq. eexists. split; [exact A|]. split.
    + intros p (e & Tp). rewrite <- (rep_onward p (Old p (ex_intro _ e Tp))). apply (G e).
      * destruct Tp as [(n & Fp) Lp]. split; auto. exists n.
        rewrite (proj1 (sign_onward (fst p) (Old p (ex_intro _ e (conj (ex_intro _ n Fp) Lp))))). auto.
      * rewrite RepY. apply NotY. eauto.
    + intros e i Q. injection Q as <- <-. symmetry. exact B.
Qed.

(** One move keeps the invariant of the walk. *)
Lemma onward_walking : exists rho', walking L' (onward m a) rho' y0.
Proof.
  destruct onward_merged as (rho' & R' & Old & New). exists rho'.
  destruct onward_table as [E N]. assert (Tm := wk_true _ _ _ _ Walk).
  assert (Tm' := onward_true L m a Tm). fold L' in Tm'.
  assert (Leg := legal_shown W0 L HW0 (visits_replays W0 L v0 V0)).
  destruct (legal_spec L Leg) as ((d0 & S0) & Percepts & _).
  assert (T1 : tidy L d0 (1%positive, 0)).
  { split; [exists (Some 0); apply table_of_find, S0|]. apply (proj1 (Percepts _ _ _ S0)). }
  split; auto.
  - intros x d j F. destruct (Pos.eq_dec x y) as [->|Nx].
    + fold T' in F. rewrite E, PositiveMap.gss in F. apply (New d j). congruence.
    + fold T' in F. rewrite E, PositiveMap.gso in F by auto. assert (F' := F). apply table_of_spec in F'.
      fold T'. rewrite (Old (x, j)), (Old (1%positive, 0)) by
        (eexists; eauto; split; eauto; apply (proj2 (Percepts _ _ _ F')); auto).
      apply (wk_marks _ _ _ _ Walk x d j F).
  - intros s p q M B. assert (Ly := wk_y _ _ _ _ Walk).
    assert (Arc : forall b, Pos.ltb (snd b) y0 = true ->
      arc_ends (table_of (edges L' [])) b = arc_ends (table_of (edges L [])) b).
    { intros b Lb. apply Pos.ltb_lt in Lb. destruct Tm as (_ & _ & HD & _), Tm' as (_ & _ & HD' & _).
      unfold arc_ends. rewrite <- HD', <- HD. simpl. rewrite PositiveMap.gso; auto. intros Q. lia. }
    unfold both_before in B. apply andb_true_iff in B as [B1 B2]. unfold meet in M.
    rewrite (Arc _ B1), (Arc _ B2) in M.
    destruct (arc_ends _ (fst s)) as [(p1, q1)|] eqn:E1; [|discriminate].
    destruct (arc_ends _ (snd s)) as [(p2, q2)|] eqn:E2; [|discriminate].
    assert (Ends := legal_ends L [] Leg (nothing_recorded L)).
    destruct (Ends _ _ _ E1) as [P1 Q1], (Ends _ _ _ E2) as [P2 Q2].
    fold T' in M |- *. rewrite (Old p1 P1), (Old p2 P2) in M.
    destruct (pplace_eqb _ _) eqn:Eq; [|discriminate]. injection M as <- <-.
    rewrite (Old q1 Q1), (Old q2 Q2). apply (wk_old _ _ _ _ Walk s q1 q2).
    + unfold meet. rewrite E1, E2, Eq. auto.
    + unfold both_before. rewrite B1, B2. auto.
  - simpl. assert (Ly := wk_y _ _ _ _ Walk). lia.
Qed.
End Onward.
