(** What the checks of Table.v prove: a table that passes is a connected map that shows the log
    (claim 9).

    t is a table, L a log. *)
From Coq Require Import Arith Lia List Bool.
Import ListNotations.
From Topo Require Import World Rotation Embedding Augment Log Undetermined Table.

(** A tactic: turn boolean tests that returned true into propositions. *)
Ltac bools := repeat match goal with
  | H : (_ && _) = true |- _ => apply andb_true_iff in H as [? H]
  | H : (_ <? _) = true |- _ => apply Nat.ltb_lt in H
  | H : (_ <=? _) = true |- _ => apply Nat.leb_le in H
  | H : (_ =? _) = true |- _ => apply Nat.eqb_eq in H
  | H : negb (_ =? _) = true |- _ => apply negb_true_iff, Nat.eqb_neq in H
  | H : percept_eqb ?p ?q = true |- _ =>
      let Q := fresh "Eq" in destruct (percept_eqb_spec p q) as [Q|_]; [clear H|discriminate]
  end.

(** A table that [check_table] accepts is a connected map. *)
Lemma check_table_spec t : check_table t = true -> is_map (map_of t) /\ connected (map_of t).
Proof.
  unfold check_table. intros H. bools.
  assert (Hr : forall d, d < length t -> check_row t (length t) d = true).
  { intros d Hd. match goal with H : forallb _ _ = true |- _ =>
      apply (proj1 (forallb_forall _ _) H), in_seq end. lia. }
  unfold check_row in Hr. split.
  - split; simpl; auto.
    + intros d Hd. specialize (Hr d Hd). destruct (row t d) as ((s, r), x). bools. auto.
    + intros d y Hd Hy E. assert (A := Hr d Hd). assert (B := Hr y Hy).
      destruct (row t d) as ((s, r), x), (row t y) as ((s', r'), x'). simpl in E. subst. bools.
      congruence.
    + intros d y Hd E. specialize (Hr d Hd). destruct (row t d) as ((s, r), x). simpl in E. subst.
      bools. destruct (snd (row t y)); [|discriminate]. bools. subst. auto.
  - intros d. induction d as [d IH] using lt_wf_ind. intros Hd. specialize (Hr d Hd). simpl in *.
    destruct (row t d) as ((s, r), x) eqn:Ed. bools.
    match goal with X : _ || _ = true |- _ => apply orb_true_iff in X as [Z|Z] end.
    + apply orb_true_iff in Z as [Z|Z]; bools.
      * rewrite Z. constructor.
      * destruct d as [|d]; [constructor|]. replace (S d - 1) with d in * by lia.
        rewrite <- Z. apply (reach_sigma (map_of t) 0 d), IH; lia.
    + destruct x as [y|]; [|discriminate]. bools.
      destruct (snd (row t y)) as [z|] eqn:Ey; [|discriminate]. bools. subst z.
      apply (reach_alpha _ _ y); [apply IH; lia|]. auto.
Qed.

(** A table that [check_map] accepts is a connected map that shows the log. *)
Lemma check_map_spec t L : check_map t L = true ->
  is_map (map_of t) /\ connected (map_of t) /\ replays (map_of t) L.
Proof.
  unfold check_map. intros H. bools. destruct (check_table_spec t) as [A B]; auto.
  split; auto. split; auto. split; auto. clear - H. simpl root. revert H. generalize 0.
  induction (moves L) as [|(k, p) ms IH]; simpl; auto. intros a Hm.
  destruct (move (map_of t) a k) as [b|]; [|discriminate]. bools. rewrite IH; simpl; congruence.
Qed.

(** Claim 9, the verdict REFUTED: if [refute] accepts, two worlds of different size show the log.
    Not in the paper. *)
Theorem refute_correct L t : refute L t = true -> undetermined L.
Proof.
  unfold refute. intros H. apply andb_true_iff in H as [E H].
  apply check_map_spec in E as (A & B & C).
  destruct (find (fun d => negb (explored (map_of t) d)) (seq 0 (length t))) as [e|] eqn:F.
  - apply find_seq in F as (He & Oe & _). apply (open_undetermined (map_of t) L e); auto; simpl; try lia.
    apply negb_true_iff in Oe. unfold explored in Oe. destruct (alpha (map_of t) e) eqn:Ea; auto.
    discriminate.
  - exfalso. apply negb_true_iff in H. apply not_true_iff_false in H. apply H, forallb_forall.
    intros r Hr. apply (In_nth _ _ (0, 0, None)) in Hr as (d & Hd & <-).
    assert (Q := find_none _ _ F d ltac:(apply in_seq; lia)). unfold explored in Q. simpl in Q.
    unfold row in Q. destruct (snd _); auto.
Qed.
