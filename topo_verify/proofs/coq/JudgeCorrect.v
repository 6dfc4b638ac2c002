(** What the judge says is right: it says [Failed] of a claim exactly where the claim is violated
    (docs/semantics.md, section 9).

    The letters are those of Claims.v and Judge.v; s is the stage before a step. *)
From Coq Require Import Arith Lia List NArith Bool.
Import ListNotations.
From Topo Require Import World Rotation Log AnyWorld Vertices Entailed Accepted Events Delivered
  Claims Judge JudgeRun JudgeMemory JudgeEnds.

(** The judgement is right about a claim C, if [spoken] says whether the trace declares what the claim
    speaks of: it is [Failed] exactly if so and C is violated; and if so and it is not, C holds. *)
Definition right_about (j : judgement) (spoken : bool) (C : Prop) :=
  (fst (fst j) = Failed <-> spoken = true /\ ~ C) /\ (spoken = true -> fst (fst j) <> Failed -> C).

(** A judgement is right if the test decides the claim. *)
Lemma judged_right spoken wrong n m (C : Prop) : (wrong = false <-> C) ->
  right_about (judged_as spoken wrong n m) spoken C.
Proof.
  intros H. unfold right_about, judged_as. destruct spoken; simpl.
  - destruct wrong; simpl.
    + split; [|intros _ N; destruct N; auto]. split; auto. intros _. split; auto. intros T.
      apply H in T. discriminate.
    + assert (T := proj1 H eq_refl). split; auto.
      destruct (n =? m); [|destruct (n =? 0)]; split; intros; try discriminate; tauto.
  - split; [|discriminate]. split; [discriminate|]. intros [E _]. discriminate.
Qed.

(** Claim 1: the judge is right about the percepts. Not in the paper. *)
Theorem judge_claim1 w t : a_world w -> right_about (judge_percepts w t) true (percepts_true w t).
Proof.
  intros Hw. apply judged_right. unfold percepts_true. rewrite negb_false_iff.
  apply shows_spec; auto.
Qed.

(** Claim 6: the judge is right about the reported cost. Not in the paper. *)
Theorem judge_claim6 t : right_about (judge_cost t) true (cost_honest t).
Proof.
  unfold judge_cost, cost_honest. destruct (finish t) as [[[c|] D]|]; apply judged_right.
  - rewrite negb_false_iff, Nat.eqb_eq. split; [|intros H; apply (H _ c eq_refl); auto].
    intros -> r c' E Ec. injection E as <-. injection Ec as <-. auto.
  - split; auto. intros _ r c E Ec. injection E as <-. discriminate.
  - split; auto. intros _ r c E. discriminate.
Qed.

(** Claim 7: the judge is right about the bounds of the cost. Not in the paper. *)
Theorem judge_claim7 w t : right_about (judge_bound w t) true (cost_in_bound w t).
Proof.
  unfold judge_bound, cost_in_bound, has_finish. cbv zeta. apply judged_right.
  rewrite negb_false_iff, andb_true_iff, orb_true_iff, !Nat.leb_le.
  destruct (finish t); simpl; intuition congruence.
Qed.

(** The right map is delivered. *)
Lemma right_end_spec w t : a_world w ->
  (right_end w t = true <-> exists D, delivered_in t D /\ right_map D w).
Proof.
  intros Hw. unfold right_end, delivered_in. destruct (finish t) as [r|].
  - destruct (reported_map r) as [D|] eqn:Er.
    + rewrite is_right_spec by auto. split; [intros H; exists D; eauto|].
      intros (D' & (r' & E & E') & H). injection E as <-. congruence.
    + split; [discriminate|]. intros (D' & (r' & E & E') & _). injection E as <-. congruence.
  - split; [discriminate|]. intros (D' & (r' & E & _) & _). discriminate.
Qed.

(** Claim 9: the judge is right about what the history proves. Not in the paper. *)
Theorem judge_claim9 w t : a_world w -> right_about (judge_entailed w t)
  (declares w t (fun _ => false) || has_finish t) (map_entailed w t).
Proof.
  intros Hw. apply judged_right.
  rewrite negb_false_iff, !andb_true_iff, shows_spec, right_end_spec by auto.
  unfold map_entailed, percepts_true. split.
  - intros ((Sh & D & Del & R) & C). split; auto. exists D. split; auto. intros w' Sh'.
    destruct w as [|W], w' as [|W']; auto.
    + destruct Sh as [E _], Sh' as [HW' Rp]. destruct (edges_seen W' _ HW' Rp E).
    + destruct Sh as [HW Rp], Sh' as [E _]. destruct (edges_seen W _ HW Rp E).
    + destruct Sh as [HW Rp], Sh' as [HW' Rp'], R as (A & B & C' & Iso). split; auto. split; auto.
      split; auto. apply (isomorphic_trans _ W); auto.
      apply (proj1 (closed_iff_determined W _ HW Rp)); auto.
      apply closed_spec; auto. apply (shown_possible W); auto.
  - intros (Sh & D & Del & R). split; [split; eauto|]. destruct w as [|W]; auto.
    destruct Sh as [HW Rp]. apply closed_spec; [apply (shown_possible W); auto|].
    destruct (closed_or_undetermined W _ HW Rp) as [C|(W1 & W2 & H1 & H2 & R1 & R2 & N)]; auto.
    destruct N. destruct (R (Edges W1) (conj H1 R1)) as (_ & _ & _ & <- & _).
    destruct (R (Edges W2) (conj H2 R2)) as (_ & _ & _ & <- & _). auto.
Qed.
