(** The judge is right about what a mapper declares on the way: claims 2 to 5 (docs/semantics.md,
    section 9).

    The letters are those of Claims.v and Judge.v; s is the stage before a step. *)
From Coq Require Import Arith Lia List NArith Bool.
Import ListNotations.
From Topo Require Import World Rotation Log AnyWorld Augment Events Claims Judge JudgeRun JudgeMemory
  JudgeCorrect.

(** The map of a world is a world, if it has a dart. *)
Lemma ground_world w : a_world w -> 0 < darts (ground w) -> world (ground w).
Proof. destruct w; simpl; auto. lia. Qed.

(** Its root is 0, if it has none. *)
Lemma ground_root w : a_world w -> darts (ground w) = 0 -> root (ground w) = 0.
Proof. destruct w as [|W]; simpl; auto. intros HW E. assert (R := root_lt W (world_is_map W HW)). lia.
  Qed.

(** The doors of steps after others. *)
Lemma doors_app a b : doors_of (a ++ b) = doors_of a ++ doors_of b.
Proof. unfold doors_of, acts, log_after. simpl. rewrite !flat_map_app, map_app. auto. Qed.

Section Decisions.
Variable W : Map.
Hypotheses (HW : 0 < darts W -> world W) (HR : darts W = 0 -> root W = 0).
Notation at_stage past := (fold_left (next_stage W) past (first_stage W)).

(** At a step that is judged the stage follows the run. *)
Lemma judged_follows t past d : judged W t past d -> follows W past (at_stage past).
Proof. intros [Sp _]. apply run_spec; auto. Qed.

(** A test that is false at each step that is judged. *)
Lemma nowhere_iff t test (C : list step -> step -> Prop) :
  (forall past d, judged W t past d -> (test (at_stage past) d = false <-> C past d)) ->
  (somewhere W t test = false <-> forall past d, judged W t past d -> C past d).
Proof.
  intros H. rewrite (nowhere_spec W HW HR). split; intros A past d J; apply (H past d J), A, J.
Qed.

(** If all augmentations that are judged are true and all doors exist, every step is judged. *)
Lemma all_sane t : (forall past ev, judged W t past (Act ev) -> grows ev -> is_so W past ev) ->
  (exists a, stands W (steps t) a) -> sane W (steps t).
Proof.
  intros G St. cut (forall past after, steps t = past ++ after -> sane W past).
  { intros H. apply (H (steps t) []). rewrite app_nil_r. auto. }
  intros past. induction past as [|d past IH] using rev_ind; intros after E.
  - split; [exists (root W); reflexivity|]. intros [|b before] ev rest Q; discriminate.
  - rewrite <- app_assoc in E. specialize (IH _ E). apply sane_snoc. split; auto. split.
    + destruct St as (a & St). unfold stands in *. rewrite E, app_assoc, doors_app, walk_app in St.
      destruct (walk W (root W) (doors_of (past ++ [d]))); [eauto|discriminate].
    + intros ev -> Gr. apply (G past ev); auto. split; eauto.
Qed.

(** Claim 5, of the augmentations. *)
Lemma grown_spec t : somewhere W t (wrongly_grown W) = false <->
  forall past ev, judged W t past (Act ev) -> grows ev -> is_so W past ev.
Proof.
  rewrite (nowhere_iff t _ (fun past d => match d with
    | Act ev => grows ev -> is_so W past ev | _ => True end)).
  - split; intros H past; [intros ev J; apply (H past (Act ev) J)|intros [e H'|ev] J; auto].
  - intros past [e H|ev] J; [simpl; tauto|]. assert (F := judged_follows t past _ J).
    rewrite (holds_spec W HW HR past _ ev F). destruct ev; simpl; rewrite ?negb_false_iff; tauto.
Qed.

(** Claim 5, of the end: no dart is left unexplored. *)
Lemma all_explored t : sane W (steps t) ->
  (existsb (is_open (chart (last_stage W t))) (seq 0 (darts (chart (last_stage W t)))) = false <->
  forall d, ~ open_dart (S_after W (steps t)) d).
Proof.
  intros Sp. assert (F := proj2 (run_spec W HW HR (steps t)) Sp). unfold last_stage.
  rewrite <- (fo_chart _ _ _ F), <- not_true_iff_false, existsb_exists. split.
  - intros N d O. apply N. exists d. rewrite is_open_spec. split; auto. apply in_seq. destruct O. lia.
  - intros N (d & _ & O). apply is_open_spec in O. apply (N d O).
Qed.

(** Claim 4. *)
Lemma confirmed_spec t : somewhere W t (wrongly_confirmed W) = false <->
  forall past e h, judged W t past (Act (Confirm e h)) -> is_so W past (Confirm e h).
Proof.
  rewrite (nowhere_iff t _ (fun past d => match d with
    | Act (Confirm e h) => is_so W past (Confirm e h) | _ => True end)).
  - split; intros H past; [intros e h J; apply (H past _ J)|].
    intros [e H'|[k p|e h|e h|e h n|e a n]] J; auto.
  - intros past d J. assert (F := judged_follows t past _ J).
    destruct d as [e H|[k p|e h|e h|e h n|e a n]]; cbn [wrongly_confirmed]; try tauto.
    rewrite (holds_spec W HW HR past _ _ F), negb_false_iff. tauto.
Qed.

(** No dart of S is the end of an edge. *)
Lemma no_end past s e : follows W past s ->
  (existsb (fun h => event_true W (chart s) (images s) (Confirm e h)) (seq 0 (darts (chart s))) = false
    <->
  forall h, ~ is_so W past (Confirm e h)).
Proof.
  intros F. rewrite <- not_true_iff_false, existsb_exists. split.
  - intros N h T. apply N. exists h. rewrite <- (holds_spec W HW HR past s _ F). split; auto.
    apply (holds_image W HW HR past s _ F) in T. destruct T as (_ & [L _] & _). apply in_seq. lia.
  - intros N (h & _ & T). apply (N h). apply (holds_spec W HW HR past s _ F). auto.
Qed.

(** The edge that is asked about. *)
Lemma asked_about_e past e : sane W past ->
  (match asked (at_stage past) with Some e' => e' =? e | None => false end = true <-> posed_last past e).
Proof.
  intros Sp. rewrite <- (asked_spec W HW HR past e Sp). destruct (asked (at_stage past)) as [e'|].
  - rewrite Nat.eqb_eq. split; congruence.
  - split; discriminate.
Qed.

(** The dart of the world that an unexplored dart of S is. *)
Lemma its_dart past s e : follows W past s -> is_open (chart s) e = true ->
  at_image (images s) e < darts W /\ means W past e (at_image (images s) e).
Proof.
  intros F O. assert (O' := proj1 (is_open_spec _ _) O).
  assert (L : at_image (images s) e < darts W).
  { apply (phi_lt _ _ _ (fo_image _ _ _ F)). rewrite <- (fo_chart _ _ _ F). apply O'. }
  split; auto. apply (means_spec W HW HR past s e _ F L). auto.
Qed.

(** Whatever dart is meant, it is one of the world, at the edge of that name. *)
Lemma meant past s e x : follows W past s -> means W past e x ->
  x < darts W /\ is_open (chart s) e = true /\ edge_key W x = key_of W s e.
Proof.
  intros F M. assert (L : x < darts W).
  { destruct M as (phi & E & O & One). apply (one_edge_lt W HW HR (phi e)); auto.
    apply (phi_lt _ _ _ E). apply O. }
  split; auto. apply (means_spec W HW HR past s e x F L). auto.
Qed.

(** No hypothesis for an edge is unexplored and in question. *)
Lemma none_left past e : let s := at_stage past in sane W past -> is_open (chart s) e = true ->
  (match left_over s (key_of W s e) with [] => false | _ => true end = false <->
  forall x h, means W past e x -> open_dart (S_after W past) h -> ~ in_question W past x h).
Proof.
  intros s Sp O. assert (F := proj2 (run_spec W HW HR past) Sp). fold s in F.
  assert (Ch := fo_chart _ _ _ F). rewrite <- Ch.
  assert (Q : forall q, In q (left_over s (key_of W s e)) <->
    In q (questions s) /\ fst q = key_of W s e /\ open_dart (chart s) (snd q)).
  { intros q. unfold left_over. rewrite filter_In, andb_true_iff, Nat.eqb_eq, is_open_spec. tauto. }
  split.
  - intros N x h M Oh I. destruct (meant past s e x F M) as (L & _ & K).
    apply (questions_spec W HW HR past x h Sp L) in I. fold s in I.
    destruct (left_over s (key_of W s e)) as [|q l]; [|discriminate].
    apply (Q (edge_key W x, h)). auto.
  - intros N. destruct (left_over s (key_of W s e)) as [|(y, h) l]; auto. exfalso.
    destruct (proj1 (Q (y, h)) (or_introl eq_refl)) as (I & Ey & Oh). simpl in Ey, Oh.
    destruct (its_dart past s e F O) as [L M]. apply (N _ h M Oh).
    apply (questions_spec W HW HR past _ h Sp L). fold s. unfold key_of in Ey. rewrite <- Ey. auto.
Qed.

(** Claim 3. *)
Lemma kept_spec t : somewhere W t (wrongly_dropped W) = false <->
  (forall past e h, judged W t past (Act (Reject e h)) -> ~ is_so W past (Confirm e h)) /\
  forall past e a d, judged W t past (Act (New e a d)) ->
    (forall h, ~ is_so W past (Confirm e h)) /\
    (posed_last past e -> is_so W past (New e a d) -> forall x h, means W past e x ->
      open_dart (S_after W past) h -> ~ in_question W past x h).
Proof.
  rewrite (nowhere_iff t _ (fun past d => match d with
    | Act (Reject e h) => ~ is_so W past (Confirm e h)
    | Act (New e a d) => (forall h, ~ is_so W past (Confirm e h)) /\
        (posed_last past e -> is_so W past (New e a d) -> forall x h, means W past e x ->
          open_dart (S_after W past) h -> ~ in_question W past x h)
    | _ => True end)).
  - split.
    + intros H. split; [intros past e h J; apply (H past _ J)|intros past e a d J; apply (H past _ J)].
    + intros [A B] past [e H|[k p|e h|e h|e h n|e a n]] J; auto.
  - intros past d J. assert (F := judged_follows t past _ J). assert (Sp := proj1 J).
    destruct d as [e H|[k p|e h|e h|e h n|e a n]]; cbn [wrongly_dropped]; try tauto.
    + rewrite (holds_spec W HW HR past _ _ F), <- not_true_iff_false. tauto.
    + rewrite orb_false_iff, (no_end past _ e F). apply and_iff_compat_l.
      rewrite !andb_false_iff, <- !not_true_iff_false, (asked_about_e past e Sp).
      rewrite <- (holds_spec W HW HR past _ (New e a n) F). split.
      * intros [[N|N]|N] P T; try tauto. apply (none_left past e Sp).
        -- apply (holds_spec W HW HR past _ _ F) in T. simpl in T. rewrite !andb_true_iff in T. tauto.
        -- apply not_true_iff_false. auto.
      * intros H. destruct (match asked (at_stage past) with Some e' => e' =? e | None => false end)
          eqn:A.
        -- apply (asked_about_e past e Sp) in A.
           destruct (event_true W (chart (at_stage past)) (images (at_stage past)) (New e a n)) eqn:T.
           ++ right. rewrite not_true_iff_false. apply (none_left past e Sp).
              ** simpl in T. rewrite !andb_true_iff in T. tauto.
              ** apply H; auto. apply (holds_spec W HW HR past _ _ F). auto.
           ++ left. right. rewrite (holds_spec W HW HR past _ _ F). congruence.
        -- left. left. rewrite <- (asked_about_e past e Sp). congruence.
Qed.

(** Claim 2. *)
Lemma posed_spec t : somewhere W t (wrongly_posed W) = false <->
  (forall past e H, judged W t past (Pose e H) ->
    (exists x, means W past e x /\ crossed_edge W past x) /\
    (forall h, In h H -> open_dart (S_after W past) h) /\
    forall h, is_so W past (Confirm e h) -> In h H) /\
  forall past ev, judged W t past (Act ev) -> match ev with
    | Loop e _ _ | New e _ _ => posed_last past e
    | _ => True end.
Proof.
  rewrite (nowhere_iff t _ (fun past d => match d with
    | Pose e H => (exists x, means W past e x /\ crossed_edge W past x) /\
        (forall h, In h H -> open_dart (S_after W past) h) /\
        forall h, is_so W past (Confirm e h) -> In h H
    | Act (Loop e _ _) | Act (New e _ _) => posed_last past e
    | _ => True end)).
  - split.
    + intros H. split; [intros past e H' J; apply (H past _ J)|].
      intros past ev J. specialize (H past _ J). destruct ev; auto.
    + intros [A B] past [e H|ev] J; [apply (A past e H J)|]. specialize (B past ev J). destruct ev; auto.
  - intros past d J. assert (F := judged_follows t past _ J). assert (Sp := proj1 J).
    destruct d as [e H|[k p|e h|e h|e h n|e a n]]; cbn [wrongly_posed]; try tauto;
      rewrite ?negb_false_iff, ?(asked_about_e past e Sp); try tauto.
    set (s := at_stage past) in *. rewrite !andb_true_iff, !forallb_forall, and_assoc.
    assert (Both : forall A B C D : Prop, (A <-> C) -> (B <-> D) -> (A /\ B <-> C /\ D)) by tauto.
    apply Both; [|apply Both].
    + split.
      * intros [O X]. destruct (its_dart past s e F O) as [L M]. eexists. split; [exact M|].
        apply (crossings_spec W HW HR past _ Sp L), X.
      * intros (x & M & C). destruct (meant past s e x F M) as (L & O & K). split; auto.
        rewrite <- K. apply (crossings_spec W HW HR past x Sp L), C.
    + rewrite <- (fo_chart _ _ _ F). split; intros A h I; apply is_open_spec; auto.
    + split.
      * intros A h T. assert (L : h < darts (chart s)).
        { apply (holds_image W HW HR past s _ F) in T. destruct T as (_ & [L _] & _). auto. }
        specialize (A h ltac:(apply in_seq; lia)). apply (holds_spec W HW HR past s _ F) in T.
        rewrite T in A. apply mem_in. auto.
      * intros A h _. destruct (event_true W (chart s) (images s) (Confirm e h)) eqn:T; auto. simpl.
        apply mem_in, A, (holds_spec W HW HR past s _ F), T.
Qed.
End Decisions.

(** Claim 2: the judge is right about the hypotheses that are posed. Not in the paper. *)
Theorem judge_claim2 w t : a_world w ->
  right_about (judge_posed w t) (declares w t is_pose) (true_hypothesis_posed w t).
Proof.
  intros Hw. apply judged_right, posed_spec; [apply ground_world|apply ground_root]; auto.
Qed.

(** Claim 3: the judge is right about the hypotheses that are rejected or dropped. Not in the paper. *)
Theorem judge_claim3 w t : a_world w -> right_about (judge_kept w t)
  (declares w t (fun d => is_pose d || is_reject d)) (true_hypothesis_kept w t).
Proof.
  intros Hw. apply judged_right, kept_spec; [apply ground_world|apply ground_root]; auto.
Qed.

(** Claim 4: the judge is right about the hypotheses that are confirmed. Not in the paper. *)
Theorem judge_claim4 w t : a_world w -> right_about (judge_confirmed w t)
  (declares w t (fun d => is_pose d || is_confirm d)) (no_false_confirm w t).
Proof.
  intros Hw. apply judged_right, confirmed_spec; [apply ground_world|apply ground_root]; auto.
Qed.

(** Claim 5: the judge is right about the map. Not in the paper. *)
Theorem judge_claim5 w t : a_world w -> right_about (judge_map w t) true (map_isomorphic w t).
Proof.
  intros Hw. assert (HW := ground_world w Hw). assert (HR := ground_root w Hw).
  apply judged_right. unfold map_isomorphic. cbv zeta. set (W := ground w) in *.
  rewrite !orb_false_iff, negb_false_iff, (grown_spec W HW HR), right_end_spec, and_assoc by auto.
  split.
  - intros (A & B & C). split; auto. split; auto. intros St (ev & I & G).
    assert (Sp := all_sane W t A St). apply (all_explored W HW HR t Sp).
    destruct St as (a & St). unfold last_stage in *. rewrite position_spec in C.
    unfold stands in St. rewrite St in C. apply andb_false_iff in C as [C|C]; auto.
    exfalso. apply not_true_iff_false in C. apply C, existsb_exists. exists (Act ev). split; auto.
    destruct ev; simpl in *; tauto.
  - intros (A & B & C). split; auto. split; auto. unfold last_stage at 1. rewrite position_spec.
    destruct (walk W (root W) (doors_of (steps t))) as [a|] eqn:St; auto.
    assert (Sp := all_sane W t A (ex_intro _ a St)). apply andb_false_iff.
    destruct (existsb grows_b (steps t)) eqn:G; auto. right. apply (all_explored W HW HR t Sp).
    apply C; [exists a; auto|]. apply existsb_exists in G as (d & I & G).
    destruct d as [e H|ev]; [discriminate|]. exists ev. split; auto. destruct ev; simpl in *; auto.
    all: discriminate.
Qed.
