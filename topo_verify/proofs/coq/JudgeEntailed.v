(** The judge is right about decisions: each must follow from the steps before it (claim 10;
    docs/semantics.md, sections 9 and 11).

    z is the history before an event, L its log, M the map S, W0 a world that shows the log; the other
    letters are those of Claims.v and Judge.v. *)
From Coq Require Import Arith Lia List NArith Bool.
Import ListNotations.
From Topo Require Import World Rotation Embedding Log AnyWorld Augment Determined Entailed Accepted
  Events Judged DecisionsCorrect DecisionsAccepted LogFold LogFoldExact Claims Judge JudgeRun JudgeEnds
    JudgeCorrect.

(** The history is right: it has the log and S, and in every world that shows the log S is embedded so
    that each dart is that of its place. *)
Record history_right p past z : Prop := {
  hr_log : so_far z = log_after p past;
  hr_map : sketched z = map_after p past;
  hr_length : length (spots z) = darts (sketched z);
  hr_valid : forall d, d < darts (sketched z) -> valid (so_far z) (spot z d);
  hr_connected : connected (sketched z);
  hr_embedded : forall W v, world W -> visits W (so_far z) v -> is_map (sketched z) /\
    embedded (sketched z) W (fun d => dart W v (spot z d)) }.

(** The degree of a place is that of its vertex. *)
Lemma degree_there_spec L W v q : world W -> visits W L v -> valid L q ->
  degree W (dart W v q) = degree_there L q.
Proof.
  intros HW V Q. unfold valid in Q. destruct (seen L (fst q)) as [(n, m)|] eqn:E; [|tauto].
  unfold degree_there. rewrite (degree_seen L _ _ _ E). apply (v_seen W L v V) in E.
  injection E as E _. unfold dart. rewrite degree_turn; [auto|apply HW|apply V].
Qed.

(** The place behind a crossed dart is behind it in every world. *)
Lemma place_behind_true L q r : possible nothing L -> valid L q -> place_behind L q = Some r ->
  valid L r /\ forall W v, world W -> visits W L v -> alpha W (dart W v q) = Some (dart W v r).
Proof.
  intros P Q. unfold place_behind. destruct (fold_exists L P) as (f & R & -> & I).
  specialize (I nothing). destruct (find _ R) as [(x, y)|] eqn:E; [|discriminate].
  simpl. intros H. injection H as ->. apply find_some in E as [Ir E]. apply place_eqb_eq in E.
  simpl in E. destruct (f_arcs _ _ _ _ _ _ I (x, r)) as (_ & Vr & a & b & K & Sa & Sb);
    [apply in_or_app; auto|]. simpl in *. split; auto. intros W v HW V. assert (F := fits_nothing W v).
  assert (Sq := f_forced _ _ _ _ _ _ I q Q). rewrite <- E in Sq.
  rewrite (same_sound W L v nothing HW V F _ _ Sq), (same_sound W L v nothing HW V F _ _ Sa),
    (same_sound W L v nothing HW V F _ _ Sb). apply (link_sound W L v nothing HW V F). auto.
Qed.

(** If all worlds have a vertex of one degree behind a dart, it was crossed. *)
Lemma place_behind_there L q d : possible nothing L -> valid L q ->
  (forall W v, world W -> visits W L v -> exists b, alpha W (dart W v q) = Some b /\ degree W b = d) ->
  exists r, place_behind L q = Some r.
Proof.
  intros P Q H. destruct (crossed_behind L q d P Q H) as (a & b & K & S).
  unfold place_behind. destruct (fold_exists L P) as (f & R & -> & I). specialize (I nothing).
  assert (All : forall a b, link nothing L a b -> In (a, b) (arcs_of_moves 0 (moves L)))
    by (intros x y; apply arcs_links).
  assert (Same := folded_same L nothing P _ f R I All).
  destruct (f_all _ _ _ _ _ _ I a b (All _ _ K)) as (r & Ir & E & _). rewrite app_nil_r in Ir.
  destruct (find _ R) as [r'|] eqn:N; [simpl; eauto|]. exfalso.
  apply (find_none _ _ N) in Ir as T. rewrite (Same _ _ S), E, (f_normal _ _ _ _ _ _ I r Ir) in T.
  rewrite (proj2 (place_eqb_eq _ _)) in T; auto. discriminate.
Qed.

(** At a right history an event follows exactly if it is true of the places in all worlds. *)
Lemma follows_places p past z ev : history_right p past z -> (event_follows p past ev <->
  forall W v, world W -> visits W (so_far z) v ->
  true_event W (sketched z) (fun d => dart W v (spot z d)) ev).
Proof.
  intros [EL EM _ _ C Em]. unfold event_follows. rewrite <- EL, <- EM. split.
  - intros H W v HW V. destruct (H W HW (visits_replays W _ v V)) as (phi & E & T).
    destruct (Em W v HW V) as [WM E']. apply (true_event_agree W _ phi); auto.
    apply (embedded_unique (sketched z) W); auto.
  - intros H W HW Rp. apply replays_visits in Rp as [v V]; [|apply HW].
    destruct (Em W v HW V) as [_ E]. eauto.
Qed.

Section Step.
Variables (p : Percept) (past : list event) (z : history).
Hypotheses (H : history_right p past z) (P : possible nothing (so_far z)).
Notation L := (so_far z).
Notation M := (sketched z).

(** [follows_b] decides whether an event follows. *)
Lemma follows_spec ev : follows_b z ev = true <-> event_follows p past ev.
Proof.
  rewrite (follows_places p past z ev H). destruct H as [_ _ _ Val _ Em].
  assert (W0 := P). destruct W0 as (W0 & v0 & HW0 & V0 & _).
  destruct ev as [k q|e h|e h|e h n|e a n]; simpl follows_b; simpl true_event.
  - tauto.
  - rewrite !andb_true_iff, !is_open_spec, negb_true_iff, <- not_true_iff_false. split.
    + intros [[Oe Oh] N] W v HW V. split; auto. split; auto. intros E. apply N.
      apply (allows_exact L); [auto|apply Val, Oe|apply Val, Oh|]. exists W, v. auto.
    + intros T. destruct (T W0 v0 HW0 V0) as (Oe & Oh & _). repeat split; auto; try apply Oe;
        try apply Oh.
      intros A. apply (allows_exact L) in A; [|auto|apply Val, Oe|apply Val, Oh].
      destruct A as (W & v & HW & V & E). apply (T W v HW V). auto.
  - rewrite !andb_true_iff, !is_open_spec. split.
    + intros [[Oe Oh] A] W v HW V. split; auto. split; auto.
      assert (A' := proj1 (partners_exact L _ _ P (Val e (proj1 Oe)) (Val h (proj1 Oh))) A).
        apply A'; auto.
    + intros T. destruct (T W0 v0 HW0 V0) as (Oe & Oh & _). split; [tauto|].
      apply (proj2 (partners_exact L _ _ P (Val e (proj1 Oe)) (Val h (proj1 Oh)))). intros W v HW V.
      apply (T W v HW V).
  - rewrite !andb_true_iff, !is_open_spec, Nat.eqb_eq. split.
    + intros [[[Oe Oh] A] D] W v HW V. split; auto. split; auto.
      assert (A' := proj1 (partners_exact L _ _ P (Val e (proj1 Oe)) (Val h (proj1 Oh))) A).
        split; [apply A'; auto|].
      rewrite <- D. apply degree_there_spec; auto. apply Val, Oh.
    + intros T. destruct (T W0 v0 HW0 V0) as (Oe & Oh & _ & D). split.
      * split; [tauto|]. apply (proj2 (partners_exact L _ _ P (Val e (proj1 Oe)) (Val h (proj1 Oh)))).
        intros W v HW V. apply (T W v HW V).
      * rewrite <- D. symmetry. apply degree_there_spec; auto. apply Val, Oh.
  - rewrite !andb_true_iff, is_open_spec, Nat.eqb_eq. split.
    + intros [[Oe Ea] T] W v HW V. split; auto. split; auto.
      destruct (place_behind L (spot z e)) as [q|] eqn:B; [|discriminate].
      rewrite andb_true_iff, Nat.eqb_eq, forallb_forall in T. destruct T as [D T].
      destruct (place_behind_true L (spot z e) q P (Val e (proj1 Oe)) B) as [Vq Lead].
      exists (dart W v q). split; [apply Lead; auto|]. split.
      { rewrite <- D. apply degree_there_spec; auto. }
      intros h Lh Eh. destruct (Em W v HW V) as [WM E].
      destruct (posed M W _ WM (world_is_map W HW) E e (dart W v q) h (proj1 Oe) (proj2 Oe)
        (Lead W v HW V) Lh Eh) as (N & Oh & _).
      specialize (T h ltac:(apply in_seq; lia)).
      rewrite !orb_true_iff, Nat.eqb_eq, !negb_true_iff, <- !not_true_iff_false, is_open_spec in T.
      destruct T as [[T|T]|T]; [tauto|apply T; split; auto|]. apply T.
      apply (allows_exact L); [auto|apply Val, Oe|apply Val; auto|]. exists W, v.
      rewrite Lead by auto. rewrite Eh. auto.
    + intros T. destruct (T W0 v0 HW0 V0) as (Oe & Ea & b & Eb & Db & _). split; auto.
      destruct (place_behind_there L (spot z e) n P (Val e (proj1 Oe))) as (q & B).
      { intros W v HW V. destruct (T W v HW V) as (_ & _ & c & Ec & Dc & _). eauto. }
      rewrite B. destruct (place_behind_true L (spot z e) q P (Val e (proj1 Oe)) B) as [Vq Lead].
      rewrite andb_true_iff, Nat.eqb_eq, forallb_forall. split.
      * rewrite <- Db, <- (degree_there_spec L W0 v0 q HW0 V0 Vq). f_equal.
        rewrite Lead in Eb by auto. congruence.
      * intros h Ih. apply in_seq in Ih.
        rewrite !orb_true_iff, Nat.eqb_eq, !negb_true_iff, <- !not_true_iff_false.
        destruct (Nat.eq_dec h e) as [|N]; auto. right. intros A.
        apply (allows_exact L) in A; [|auto|apply Val, Oe|apply Val; lia].
        destruct A as (W & v & HW & V & E). destruct (T W v HW V) as (_ & _ & c & Ec & _ & New).
        apply (New h); [lia|]. congruence.
Qed.

(** After an event that follows the history is right again. *)
Lemma next_history_right ev : event_follows p past ev -> history_right p (past ++ [ev]) (next_history z
  ev).
Proof.
  intros F. assert (T := proj1 (follows_places p past z ev H) F). destruct H as [EL EM Len Val C Em].
  assert (W0 := P). destruct W0 as (W0 & v0 & HW0 & V0 & _).
  destruct ev as [k q|e h|e h|e h n|e a n]; simpl next_history.
  - assert (Grow : forall i x, seen L i = Some x ->
      seen {| start := start L; moves := moves L ++ [(k, q)] |} i = Some x).
    { unfold seen. simpl. intros i x E. rewrite map_app, app_comm_cons, nth_error_app1; auto.
      apply nth_error_Some. congruence. }
    split; simpl; auto.
    + rewrite log_after_snoc, <- EL, EL. auto.
    + rewrite map_after_snoc. auto.
    + intros d Ld. assert (Vd := Val d Ld). unfold valid, spot in *. simpl.
      destruct (seen L (fst (nth d (spots z) (0, 0)))) as [x|] eqn:E; [|tauto].
      rewrite (Grow _ x E). discriminate.
    + intros W v HW V. apply Em; auto. apply (visits_shorter W L _ v) in V; auto.
      unfold door. simpl. intros i x E. rewrite map_app, nth_error_app1; auto.
      apply nth_error_Some. congruence.
  - split; simpl; auto; [rewrite log_after_snoc, app_nil_r, EL; reflexivity|].
    rewrite map_after_snoc. auto.
  - split; simpl; auto; [rewrite log_after_snoc, app_nil_r, EL; reflexivity|].
    rewrite map_after_snoc. auto.
  - destruct (T W0 v0 HW0 V0) as ((Le & Oe) & (Lh & Oh) & _).
    split; simpl; auto; [rewrite log_after_snoc, app_nil_r, EL; reflexivity|..].
    + rewrite map_after_snoc, EM. auto.
    + apply connected_loop; auto.
    + intros W v HW V. destruct (Em W v HW V) as [WM E]. destruct (T W v HW V) as (_ & _ & A & _). split.
      * apply is_map_loop; auto. intros ->.
        apply (alpha_ok W (world_is_map W HW)) in A; [tauto|apply (dart_lt W L v HW V)].
      * apply embedded_loop; auto. apply HW.
  - destruct (T W0 v0 HW0 V0) as (Oe & -> & b & Eb & Db & _).
    destruct (place_behind_there L (spot z e) n P (Val e (proj1 Oe))) as (q & B).
    { intros W v HW V. destruct (T W v HW V) as (_ & _ & c & Ec & Dc & _). eauto. }
    rewrite B. destruct (place_behind_true L (spot z e) q P (Val e (proj1 Oe)) B) as [Vq Lead].
    assert (Sp : forall d, spot {| so_far := L; sketched := augment_new M e n;
      spots := spots z ++ map (fun k => (fst q, k + snd q)) (seq 0 n) |} d =
      if d <? darts M then spot z d else if d <? darts M + n then (fst q, d - darts M + snd q)
      else (0, 0)).
    { intros d. unfold spot. simpl. destruct (Nat.ltb_spec d (darts M)).
      - rewrite app_nth1; auto. lia.
      - rewrite app_nth2, Len by lia. destruct (Nat.ltb_spec d (darts M + n)).
        + rewrite (nth_indep _ (0, 0) (fst q, 0 + snd q)) by (rewrite map_length, seq_length; lia).
          rewrite (map_nth (fun k => (fst q, k + snd q))), seq_nth by lia. auto.
        + apply nth_overflow. rewrite map_length, seq_length. lia. }
    split; simpl so_far; simpl sketched; auto.
    + rewrite log_after_snoc, app_nil_r, EL. reflexivity.
    + rewrite map_after_snoc, <- EM. auto.
    + simpl. rewrite app_length, map_length, seq_length. lia.
    + intros d Ld. simpl in Ld. rewrite Sp. destruct (Nat.ltb_spec d (darts M)); [auto|].
      rewrite (proj2 (Nat.ltb_lt _ _) Ld). exact Vq.
    + destruct (Em W0 v0 HW0 V0) as [WM _]. apply connected_new; auto; apply Oe.
    + intros W v HW V. destruct (Em W v HW V) as [WM E].
      destruct (T W v HW V) as (_ & _ & c & Ec & Dc & New). rewrite Lead in Ec by auto.
      injection Ec as <-.
      assert (WM' : is_map (augment_new M e n)).
      { apply is_map_new; auto; try apply Oe. rewrite <- Dc.
        destruct (degree_spec W (world_is_map W HW) _ (dart_lt W L v HW V q)). auto. }
      split; auto.
      apply (embedded_agree _ _ (extend (fun d => dart W v (spot z d)) (darts M) W (dart W v q))); auto.
      * simpl. intros d Ld. rewrite Sp. unfold extend. destruct (Nat.ltb_spec d (darts M)); auto.
        rewrite (proj2 (Nat.ltb_lt _ _) Ld). unfold dart. simpl. symmetry. apply turn_add.
      * rewrite <- Dc. apply embedded_new; auto; try apply HW; try apply Oe.
Qed.
End Step.

(** The history at the start is right. *)
Lemma first_history_right p : possible nothing {| start := p; moves := [] |} ->
  history_right p [] (first_history p).
Proof.
  intros (W0 & v0 & HW0 & V0 & _).
  assert (D : forall W v, world W -> visits W {| start := p; moves := [] |} v ->
    degree W (root W) = fst p /\ 0 < fst p).
  { intros W v HW V. assert (S := v_seen W _ v V 0 p eq_refl). rewrite (v_0 W _ v V) in S.
    apply (f_equal fst) in S. simpl in S. rewrite <- S. split; auto.
    apply degree_spec; [apply HW|]. apply root_lt, HW. }
  assert (Sp : forall d, d < fst p -> spot (first_history p) d = (0, d)).
  { intros d Ld. unfold spot. simpl.
    rewrite (nth_indep _ (0, 0) (0, 0)) by (rewrite map_length, seq_length; auto).
    rewrite (map_nth (fun k => (0, k)) _ 0), seq_nth by auto. auto. }
  destruct (D W0 v0 HW0 V0) as [_ Pos]. split; auto.
  - simpl. rewrite map_length, seq_length. auto.
  - intros d Ld. simpl in Ld. rewrite Sp by auto. unfold valid. discriminate.
  - apply connected_initial. auto.
  - intros W v HW V. destruct (D W v HW V) as [E _]. assert (WM := is_map_initial (fst p) Pos).
    split; auto. apply (embedded_agree _ _ (fun x => turn W x (root W))); auto.
    + simpl. intros d Ld. rewrite Sp by auto. unfold dart. simpl. rewrite (v_0 W _ v V). auto.
    + simpl. rewrite <- E. apply embedded_initial. apply HW.
Qed.

(** All events follow exactly if each decision does. *)
Lemma all_follow_spec p W v es : world W -> forall past z, history_right p past z ->
  visits W (log_after p (past ++ es)) v ->
  (all_follow z es = true <->
  forall before ev after, es = before ++ ev :: after -> is_decision ev = true ->
    event_follows p (past ++ before) ev).
Proof.
  intros HW. induction es as [|x es IH]; intros past z Hz V.
  - split; auto. intros _ [|y before] ev after E; discriminate.
  - assert (V' : visits W (so_far z) v).
    { rewrite (hr_log _ _ _ Hz). apply (visits_past W v p past (x :: es)). auto. }
    assert (P : possible nothing (so_far z)).
    { exists W, v. split; auto. split; auto. apply fits_nothing. }
    simpl. rewrite andb_true_iff, (follows_spec p past z Hz P).
    replace (past ++ x :: es) with ((past ++ [x]) ++ es) in V by (rewrite <- app_assoc; auto). split.
    + intros [F A] [|y before] ev after E De; injection E as <- E.
      * rewrite app_nil_r. auto.
      * replace (past ++ x :: before) with ((past ++ [x]) ++ before) by (rewrite <- app_assoc; auto).
        apply (proj1 (IH _ _ (next_history_right p past z Hz P x F) V) A before ev after E De).
    + intros A. assert (F : event_follows p past x).
      { destruct (is_decision x) eqn:De; [rewrite <- (app_nil_r past); apply (A [] x es); auto|].
        apply (follows_spec p past z Hz P). destruct x; auto; discriminate. }
      split; auto. apply (IH (past ++ [x]) _ (next_history_right p past z Hz P x F) V).
      intros before ev after E De. rewrite <- app_assoc. apply (A (x :: before) ev after); auto.
      rewrite E. auto.
Qed.

(** Where an event is among the steps. *)
Lemma acts_split l : forall before ev after, acts l = before ++ ev :: after ->
  exists past rest, l = past ++ Act ev :: rest /\ acts past = before.
Proof.
  induction l as [|d l IH]; intros before ev after E; [destruct before; discriminate|].
  destruct d as [e H|x]; simpl in E.
  - destruct (IH before ev after E) as (past & rest & -> & <-). exists (Pose e H :: past), rest. auto.
  - destruct before as [|y before]; injection E as -> E; [exists [], l; auto|].
    destruct (IH before ev after E) as (past & rest & -> & <-). exists (Act y :: past), rest. auto.
Qed.

(** The events of two lists of steps. *)
Lemma acts_app a b : acts (a ++ b) = acts a ++ acts b.
Proof. apply flat_map_app. Qed.

(** Claim 10: the judge is right about the decisions. Not in the paper. *)
Theorem judge_claim10 w t : a_world w ->
  right_about (judge_decisions w t) (declares w t decides) (decisions_entailed w t).
Proof.
  intros Hw. apply judged_right. unfold decisions_entailed, percepts_true.
  rewrite negb_false_iff, andb_true_iff, shows_spec by auto.
  unfold trace_log. set (p := percept_at_start t). destruct w as [|W]; split.
  - intros [Sh F]. split; auto. intros past ev after E De. apply negb_true_iff in F.
    apply not_true_iff_false in F. destruct F. apply existsb_exists. exists (Act ev). split; auto.
    rewrite E. apply in_or_app. simpl. auto.
  - intros [Sh F]. split; auto. apply negb_true_iff, not_true_iff_false. intros X.
    apply existsb_exists in X as (d & I & De). destruct d as [e H|ev]; [discriminate|].
    apply in_split in I as (past & after & E). destruct (F past ev after E De) as [_ N]. apply N.
    destruct Sh as [S1 S2]. split; auto. rewrite E, acts_app in S2. unfold log_after in *. simpl in *.
    rewrite flat_map_app in S2. apply app_eq_nil in S2. apply S2.
  - intros [[HW Rp] F]. split; [split; auto|]. intros past ev after E De.
    assert (Rp' := Rp). apply replays_visits in Rp' as [v V]; [|apply HW]. split.
    + apply (proj1 (all_follow_spec p W v (acts (steps t)) HW [] _ (first_history_right p
        (ex_intro _ W (ex_intro _ v (conj HW (conj (visits_past W v p [] _ V) (fits_nothing W v))))))
        V) F (acts past) ev (acts after)); auto. rewrite E, acts_app. auto.
    + intros [S1 _]. apply (edges_seen W _ HW Rp S1).
  - intros [[HW Rp] F]. split; [split; auto|].
    assert (Rp' := Rp). apply replays_visits in Rp' as [v V]; [|apply HW].
    apply (all_follow_spec p W v (acts (steps t)) HW [] _ (first_history_right p
      (ex_intro _ W (ex_intro _ v (conj HW (conj (visits_past W v p [] _ V) (fits_nothing W v)))))) V).
    intros before ev after E De. apply acts_split in E as (past & rest & E & <-).
    apply (F past ev rest E De).
Qed.
