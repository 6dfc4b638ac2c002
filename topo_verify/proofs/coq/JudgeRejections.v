(** The judge is right about rejections: what each cites must disagree (claim 8; docs/semantics.md,
    section 9).

    z is the memo before a step, y the history in it, s its stage; M the map S, V a world that shows the
    log; the other letters are those of Claims.v, Judge.v and JudgeCitations.v. *)
From Coq Require Import Arith Lia List NArith Bool.
Import ListNotations.
From Topo Require Import World Rotation Embedding Log AnyWorld Augment Vertices Determined Undetermined
  Quotient Entailed Events Judged DecisionsCorrect DecisionsAccepted LogFold LogFoldExact Claims Judge
  JudgeCitations JudgeRun JudgeMemory JudgeEnds JudgeCorrect JudgeDecisions JudgeEntailed JudgeFolding
  JudgeWalks.

(** Places that are one dart in every world that shows the log are one in its fold. *)
Lemma one_everywhere L p q : possible nothing L -> valid L p -> valid L q ->
  (forall W v, world W -> visits W L v -> dart W v p = dart W v q) -> same nothing L p q.
Proof.
  intros Pos P Q H. assert (C := plain L Pos). destruct (quotient_exists L nothing C) as (M & u & Qu).
  assert (WM := q_map _ _ _ _ Qu). assert (CM := q_connected _ _ _ _ Qu).
  destruct (hang_leaves (darts M) M WM CM) as (W & HW & E & _ & _); [lia|].
  destruct (embedded_visits M W L u WM (world_is_map W HW) E (q_visits _ _ _ _ Qu)) as [V D].
  apply (q_same _ _ _ _ Qu); auto. rewrite <- !D. auto.
Qed.

(** A rejection or a confirmation leaves a right history right. *)
Lemma history_unchanged p past y ev : history_right p past y ->
  match ev with Reject _ _ | Confirm _ _ => True | _ => False end ->
  history_right p (past ++ [ev]) (next_history y ev).
Proof.
  intros [EL EM Len Val C Em] K.
  destruct ev as [k q|e h|e h|e h m|e a m]; try tauto;
    (split; simpl; auto; [rewrite log_after_snoc, app_nil_r, EL; reflexivity|];
    rewrite map_after_snoc; auto).
Qed.

Section World.
Variables (W : Map) (t : trace).
Hypothesis HW : world W.
Notation said := (cited t).
Notation at_stage past := (fold_left (next_stage W) past (first_stage W)).
Notation memo_at past := (snd (judge_at W t past)).
Notation p0 := (percept_at_start t).

(** The history of the memo, where it is kept: it is right while S is proved. *)
Lemma history_kept past v : cites_folding t = true -> visits W (log_after p0 (acts past)) v ->
  let proved := forall before ev after, past = before ++ Act ev :: after -> grows ev ->
    event_follows p0 (acts before) ev in
  match proved_history (memo_at past) with
  | Some y => history_right p0 (acts past) y /\ proved
  | None => ~ proved end.
Proof.
  intros Ci. induction past as [|d past IH] using rev_ind; intros V; cbv zeta.
  - simpl. rewrite Ci. split.
    + apply first_history_right. exists W, v. split; auto. split; auto. apply fits_nothing.
    + intros [|b before] ev after E; discriminate.
  - rewrite acts_app in V. assert (V' := visits_past W v _ _ _ V). specialize (IH V'). cbv zeta in IH.
    rewrite (memo_snoc W t).
    assert (Split : (forall before ev after, past ++ [d] = before ++ Act ev :: after -> grows ev ->
      event_follows p0 (acts before) ev) <-> (forall before ev after, past = before ++ Act ev :: after ->
      grows ev -> event_follows p0 (acts before) ev) /\ forall ev, d = Act ev -> grows ev ->
      event_follows p0 (acts past) ev).
    { split.
      - intros H. split.
        + intros before ev after -> G. apply (H before ev (after ++ [d])); auto.
          rewrite <- app_assoc. auto.
        + intros ev -> G. apply (H past ev []); auto.
      - intros [H G] before ev after E Gr. apply split_snoc in E as [(<- & -> & _)|(rest & _ & E)]; auto.
        apply (H before ev rest); auto. }
    destruct d as [e H|ev].
    + cbn [next_memo proved_history]. rewrite acts_app. simpl acts. rewrite app_nil_r.
      destruct (proved_history (memo_at past)) as [y|]; rewrite Split.
      * destruct IH as [A B]. split; auto. split; auto. intros ev E. discriminate.
      * intros [A _]. auto.
    + cbn [next_memo proved_history]. rewrite acts_app. change (acts [Act ev]) with [ev].
      destruct (proved_history (memo_at past)) as [y|]; [|rewrite Split; intros [A _]; auto].
      destruct IH as [Hy B].
      assert (Pos : possible nothing (so_far y)).
      { rewrite (hr_log _ _ _ Hy). exists W, v. split; auto. split; auto. apply fits_nothing. }
      assert (Fo := follows_spec p0 (acts past) y Hy Pos ev).
      destruct (grows_b (Act ev)) eqn:G; simpl negb; cbn [orb].
      * assert (Gr : grows ev) by (destruct ev; simpl in *; auto; discriminate).
        destruct (follows_b y ev); rewrite Split.
        -- split; [apply next_history_right; auto; apply Fo; auto|]. split; auto.
           intros ev' E _. injection E as <-. apply Fo. auto.
        -- intros [_ N]. specialize (N ev eq_refl Gr). apply Fo in N. discriminate.
      * rewrite Split. split.
        -- destruct ev as [k q|e h|e h|e h m|e a m]; try discriminate.
           ++ apply next_history_right; auto. apply (follows_spec p0 (acts past) y Hy Pos). auto.
           ++ apply history_unchanged; auto.
           ++ apply history_unchanged; auto.
        -- split; auto. intros ev' E Gr. injection E as <-.
           destruct ev; simpl in *; try tauto; discriminate.
Qed.

Section History.
Variables (past : list step) (v : nat -> nat) (y : history).
Hypotheses (V : visits W (log_after p0 (acts past)) v) (Hy : history_right p0 (acts past) y).
Notation L := (so_far y).
Notation M := (sketched y).

(** The log is possible. *)
Lemma history_possible : possible nothing L.
Proof. rewrite (hr_log _ _ _ Hy). exists W, v. split; auto. split; auto. apply fits_nothing. Qed.

(** The place of a dart of S is seen as it. *)
Lemma seen_as_spot d : d < darts M -> seen_as t past d (spot y d).
Proof.
  intros Ld. unfold seen_as. cbv zeta. rewrite <- (hr_log _ _ _ Hy), <- (hr_map _ _ _ Hy).
  split; [apply (hr_valid _ _ _ Hy); auto|]. intros V' v' phi HV Vi E.
  destruct (hr_embedded _ _ _ Hy V' v' HV Vi) as [WM E']. symmetry.
  apply (embedded_unique M V' phi (fun d => dart V' v' (spot y d))); auto. apply (hr_connected _ _ _ Hy).
Qed.

(** Any place that is seen as it is one with that place. *)
Lemma seen_as_one d x : d < darts M -> seen_as t past d x -> same nothing L x (spot y d).
Proof.
  intros Ld. unfold seen_as. cbv zeta. rewrite <- (hr_log _ _ _ Hy), <- (hr_map _ _ _ Hy).
  intros [Vx S]. apply one_everywhere; auto; [apply history_possible|apply (hr_valid _ _ _ Hy); auto|].
  intros V' v' HV Vi. destruct (hr_embedded _ _ _ Hy V' v' HV Vi) as [_ E].
  apply (S V' v' _ HV Vi E).
Qed.

(** [contradicts] finds the contradictions that follow with an edge from e to h. *)
Lemma contradicts_spec e h c : e < darts M -> h < darts M ->
  (contradicts L (fold_of L) (spot y e) (spot y h) (spots_apart y) c = true <->
  exists p q, seen_as t past e p /\ seen_as t past h q /\
    follows_from_edges [(p, q)] (log_after p0 (acts past)) (two_vertices t past) c).
Proof.
  intros Le Lh. assert (Pos := history_possible).
  assert (WM : is_map M).
  { rewrite <- (hr_log _ _ _ Hy) in V. apply (hr_embedded _ _ _ Hy W v HW V). }
  destruct (fold_exists L Pos) as (f & R & Ef & I). specialize (I nothing).
  assert (G := f_good _ _ _ _ _ _ I). rewrite Ef.
  assert (Val := hr_valid _ _ _ Hy).
  assert (Found : forall p q, valid L p -> valid L q ->
    (contradicts L (Some (f, R)) p q (spots_apart y) c = true <->
     follows_from_edges [(p, q)] L (two_vertices t past) c)).
  { intros p q P Q. apply contradicts_found; auto.
    - intros a b Iab. unfold spots_apart in Iab. apply in_flat_map in Iab as (d & Id & Iab).
      apply in_map_iff in Iab as (d' & E & Id'). injection E as <- <-. apply filter_In in Id' as [Id' N].
      apply in_seq in Id, Id'. split; [apply Val; lia|]. split; [apply Val; lia|].
      exists d, d'. rewrite <- (hr_map _ _ _ Hy). split; [lia|]. split; [lia|]. split.
      + intros k E. apply negb_true_iff, not_true_iff_false in N. apply N.
        apply at_vertex_iff; [auto|lia|eauto].
      + split; apply seen_as_spot; lia.
    - intros a b (d & d' & Ld & Ld' & N & Sa & Sb) _ _. rewrite <- (hr_map _ _ _ Hy) in Ld, Ld', N.
      exists (spot y d), (spot y d'). split; [|split; apply seen_as_one; auto].
      unfold spots_apart. apply in_flat_map. exists d. split; [apply in_seq; lia|].
      apply in_map_iff. exists d'. split; auto. apply filter_In. split; [apply in_seq; lia|].
      apply negb_true_iff, not_true_iff_false. rewrite at_vertex_iff by auto. intros (k & E).
      apply (N k E). }
  rewrite <- (hr_log _ _ _ Hy). split.
  - intros C. exists (spot y e), (spot y h). split; [apply seen_as_spot; auto|].
    split; [apply seen_as_spot; auto|]. apply Found; auto.
  - intros (p & q & Sp & Sq & C).
    assert (P : valid L p) by (rewrite (hr_log _ _ _ Hy); apply Sp).
    assert (Q : valid L q) by (rewrite (hr_log _ _ _ Hy); apply Sq).
    apply Found in C; auto. rewrite <- C.
    assert (Label := labels_of_same L f R Pos I).
    assert (Sign : forall a b, same nothing L a b -> sign_at L (fst b) = sign_at L (fst a)).
    { intros a b S. assert (S1 := normal_sign L f a G). assert (S2 := normal_sign L f b G).
      rewrite (Label _ _ S) in S1. congruence. }
    assert (Se := seen_as_one e p Le Sp). assert (Sh := seen_as_one h q Lh Sq).
    unfold contradicts, edge_ties. rewrite !map_app. simpl map.
    rewrite (Label _ _ Se), (Label _ _ Sh), (Sign _ _ Se), (Sign _ _ Sh). auto.
Qed.
End History.

(** [contradicted] decides whether the cited contradiction is met. *)
Lemma contradicted_spec past e h g phi b : judged W t past (Act (Reject e h)) ->
  cited t (length past) = Some g -> by_rule g = ByFolding -> drawn_by W past phi ->
  open_dart (S_after W past) e -> open_dart (S_after W past) h ->
  (contradicted W (shows_b W (trace_log t)) (at_stage past) (memo_at past) e h b g = true <->
  contradiction_met (Edges W) t past phi e h b g).
Proof.
  intros [Sp (after & El)] Eg Rule Dr [Le Oe] [Lh Oh].
  assert (HR : darts W = 0 -> root W = 0)
    by (intros Z; assert (R := root_lt W (world_is_map W HW)); lia).
  assert (F := proj2 (run_spec W (fun _ => HW) HR past) Sp).
  assert (Im : phi h = at_image (images (at_stage past)) h).
  { apply (follows_unique W (fun _ => HW) HR past _ phi F Dr). rewrite (fo_chart W _ _ F). auto. }
  unfold contradicted, contradiction_met. cbv zeta. change (ground (Edges W)) with W.
  rewrite !andb_true_iff, !is_none_spec, !may_cite_spec, Nat.eqb_eq, Im.
  change (shows_b W (trace_log t)) with (shows_b (ground (Edges W)) (trace_log t)).
  rewrite (shows_spec (Edges W)) by (simpl; auto). fold (percepts_true (Edges W) t).
  assert (Ci : cites_folding t = true).
  { apply existsb_exists. exists (length past). rewrite Eg, Rule. split; auto.
    apply in_seq. rewrite El, app_length. simpl. lia. }
  assert (Rest : percepts_true (Edges W) t -> (match proved_history (memo_at past), contradiction g with
      | Some y, Some c => contradicts (so_far y) (fold_of (so_far y)) (spot y e) (spot y h)
          (spots_apart y) c
      | _, _ => false end = true <->
    (forall before ev after, past = before ++ Act ev :: after -> grows ev -> follows_from t before ev) /\
    exists c p q, contradiction g = Some c /\ seen_as t past e p /\ seen_as t past h q /\
      follows_from_edges [(p, q)] (log_after p0 (acts past)) (two_vertices t past) c)).
  { intros [_ Rp]. assert (Rp' := Rp). apply replays_visits in Rp' as [v V]; [|apply HW].
    assert (V' : visits W (log_after p0 (acts past)) v).
    { unfold trace_log in V. rewrite El, acts_app in V. apply (visits_past W v _ _ _ V). }
    assert (H := history_kept past v Ci V'). cbv zeta in H.
    assert (Pr : (forall before ev after, past = before ++ Act ev :: after -> grows ev ->
        event_follows p0 (acts before) ev) <->
      forall before ev after, past = before ++ Act ev :: after -> grows ev -> follows_from t before ev).
    { split; intros X before ev rest E Gr; [split; [eauto|]|apply (X before ev rest E Gr)].
      intros [S1 _]. apply (edges_seen W _ HW Rp S1). }
    rewrite <- Pr. destruct (proved_history (memo_at past)) as [y|].
    - destruct H as [Hy B]. assert (Ld : darts (sketched y) = darts (S_after W past)).
      { rewrite (hr_map _ _ _ Hy). unfold S_after. f_equal. f_equal.
        assert (S := v_seen W _ v V' 0 p0 eq_refl). rewrite (v_0 W _ v V') in S. auto. }
      destruct (contradiction g) as [c|].
      + rewrite (contradicts_spec past v y V' Hy e h c) by lia. split.
        * intros (p & q & X). split; auto. exists c, p, q. auto.
        * intros [_ (c' & p & q & E & X)]. injection E as <-. eauto.
      + split; [discriminate|]. intros [_ (c & p & q & E & _)]. discriminate.
    - split; [discriminate|]. intros [X _]. tauto. }
  tauto.
Qed.
End World.

(** [justified] decides whether a rejection is justified. *)
Lemma justified_spec w t past e h : a_world w -> let W := ground w in
  judged W t past (Act (Reject e h)) ->
  let s := fold_left (next_stage W) past (first_stage W) in
  (justified W (cited t) (shows_b W (trace_log t)) s (snd (judge_at W t past)) e h = true <->
  exists g phi H b o, cited t (length past) = Some g /\ drawn_by W past phi /\
    open_dart (S_after W past) e /\ open_dart (S_after W past) h /\ alpha W (phi e) = Some b /\
    posed_with W (cited t) past e H b o /\ In h H /\ match by_rule g with
      | ByFolding => contradiction_met w t past phi e h b g
      | _ => percepts_disagree W (cited t) past phi h b o g end).
Proof.
  intros Hw. cbv zeta. set (W := ground w). intros J. assert (Sp := proj1 J).
  assert (HW := ground_world w Hw). assert (HR := ground_root w Hw). fold W in HW, HR.
  assert (F := proj2 (run_spec W HW HR past) Sp). unfold justified. rewrite next_step_spec.
  set (s := fold_left (next_stage W) past (first_stage W)) in *. set (z := snd (judge_at W t past)).
  assert (Rule : forall g phi b, cited t (length past) = Some g -> drawn_by W past phi ->
    open_dart (S_after W past) e -> open_dart (S_after W past) h ->
    (match by_rule g with ByFolding => contradicted W (shows_b W (trace_log t)) s z e h b g
      | _ => disagreeing W s z h b g end = true <-> match by_rule g with
      | ByFolding => contradiction_met w t past phi e h b g
      | _ => percepts_disagree W (cited t) past phi h b (walk_behind z) g end)).
  { intros g phi b Eg Dr Oe Oh. destruct (by_rule g) eqn:R; try (apply disagreeing_spec; auto).
    destruct w as [|W'].
    - exfalso. destruct Oe as [L _]. apply (phi_lt _ _ _ Dr) in L. simpl in L. lia.
    - apply contradicted_spec; auto. }
  assert (Asked : match asked s with Some e' => e' =? e | None => false end = true <-> asked s = Some e).
  { destruct (asked s) as [e'|]; [rewrite Nat.eqb_eq|]; split; congruence. }
  split.
  - destruct (cited t (length past)) as [g|] eqn:Eg; [|discriminate].
    rewrite !andb_true_iff, !is_open_spec, mem_in, Asked, (fo_chart W _ _ F).
    intros ((((Oe & Oh) & M) & As) & X).
    destruct (alpha W (at_image (images s) e)) as [b|] eqn:Eb; [|discriminate].
    assert (En : ends_at W past e b).
    { apply (ends_at_spec W HW HR past s); auto. rewrite is_open_spec, (fo_chart W _ _ F). auto. }
    exists g, (at_image (images s)), (posed_hypotheses z), b, (walk_behind z).
    assert (Dr := fo_image W _ _ F). repeat (split; [solve [auto]|]).
    split; [apply (posed_with_spec W HW HR t past e b); auto|]. split; auto.
    apply Rule; auto.
  - intros (g & phi & H & b & o & Eg & Dr & Oe & Oh & Eb & Po & I & X). rewrite Eg.
    assert (En : ends_at W past e b) by (exists phi; auto).
    apply (posed_with_spec W HW HR t past e b) in Po as (As & -> & ->); auto.
    apply (ends_at_spec W HW HR past s) in En as [_ ->]; auto.
    rewrite !andb_true_iff, !is_open_spec, mem_in, Asked, (fo_chart W _ _ F).
    split; auto. apply (Rule g phi b); auto.
Qed.

(** The judge looks at every rejection that is judged. *)
Lemma unjustified_spec W t sure l : forall past,
  let s := fold_left (next_stage W) past (first_stage W) in
  (unjustified W (cited t) sure s (snd (judge_at W t past)) l = false <->
  forall before e h after, l = before ++ Act (Reject e h) :: after ->
    let s := fold_left (next_stage W) (past ++ before) (first_stage W) in live s = true ->
    justified W (cited t) sure s (snd (judge_at W t (past ++ before))) e h = true).
Proof.
  induction l as [|d l IH]; intros past; cbv zeta; cbn [unjustified].
  - split; auto. intros _ [|x before] e h after E; discriminate.
  - specialize (IH (past ++ [d])). cbv zeta in IH. rewrite memo_snoc, fold_left_app in IH. simpl in IH.
    rewrite orb_false_iff, IH. split.
    + intros [A B] [|x before] e h after E; injection E as -> E.
      * rewrite app_nil_r. intros Lv. rewrite Lv in A. apply negb_false_iff in A. auto.
      * specialize (B before e h after E). rewrite <- app_assoc in B. auto.
    + intros B. split.
      * destruct d as [e H|[k p|e h|e h|e h n|e a n]]; auto.
        specialize (B [] e h l eq_refl). rewrite app_nil_r in B. destruct (live _); auto.
        rewrite B; auto.
      * intros before e h after ->. specialize (B (d :: before) e h after eq_refl).
        rewrite <- app_assoc. auto.
Qed.

(** Claim 8: the judge is right about the evidence of rejections. Not in the paper. *)
Theorem judge_claim8 w t : a_world w -> right_about (judge_justified w t)
  (declares w t (fun d => is_pose d || is_reject d)) (rejection_justified w t).
Proof.
  intros Hw. apply judged_right. unfold rejection_justified. cbv zeta. set (W := ground w).
  assert (HW := ground_world w Hw). assert (HR := ground_root w Hw). fold W in HW, HR.
  rewrite (unjustified_spec W t (shows_b W (trace_log t)) (steps t) []). simpl app. split.
  - intros A past e h J. apply (justified_spec w t past e h Hw J).
    destruct J as [Sp (after & E)]. apply (A past e h after E). apply (run_spec W HW HR past). auto.
  - intros A past e h after E. cbv zeta. intros Lv.
    assert (J : judged W t past (Act (Reject e h))).
    { split; [apply (run_spec W HW HR past), Lv|exists after; auto]. }
    apply (justified_spec w t past e h Hw J), A. auto.
Qed.
