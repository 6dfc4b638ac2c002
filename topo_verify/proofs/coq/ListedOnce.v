(** The list of worlds holds every rooted map exactly once (docs/semantics.md, section 12).

    The letters are those of Listed.v. If two sequences differ, then so do the partners, or the degrees,
    of the least open dart at the first step in which they differ, and the maps before that step are
    embedded in both worlds in the same way. A world that contains the map so far says which step is
    next. *)
From Coq Require Import Arith Lia List Bool.
Import ListNotations.
From Topo Require Import World Rotation Embedding Augment AnyWorld Numbered Listed.

(** Where a step sends the least open dart, in all that follows. *)
Definition partner_of M s := match s with Meet j => nth j (tl (open_darts M)) 0 | Hang _ => darts M end.

(** In all that follows a step, the least open dart and its partner are partners, and a new vertex keeps
    its degree. *)
Lemma growths_first n M v r s rest e others : has_open M (S v) -> open_darts M = e :: others ->
  In (s :: rest) (growths (S n) (S v) r) -> let W := fold_left grown (s :: rest) M in
  alpha W e = Some (partner_of M s) /\ embedded (grown M s) W (fun x => x) /\
  match s with Meet j => partner_of M s < darts M | Hang d => degree W (darts M) = d end.
Proof.
  intros H Eo I. destruct (has_open_first M v H) as (e' & others' & E' & Lo & He & Oe & R).
  rewrite Eo in E'. injection E' as <- <-.
  destruct (has_open_grown n M v r s rest H I) as (u & q & K & J & D & Q).
  destruct (growths_right n _ _ _ _ K J) as (HW & _ & E). simpl.
  assert (G : alpha (grown M s) e = Some (partner_of M s) /\ e < darts (grown M s) /\
    match s with Meet j => partner_of M s < darts M | Hang d => degree (grown M s) (darts M) = d end).
  { clear J E D. unfold grown, partner_of in *. rewrite Eo in *. simpl tl.
    destruct s as [j|d]; destruct Q as (L & -> & ->); simpl alpha; unfold join; rewrite Nat.eqb_refl.
    - rewrite (nth_indep others 0 e) by lia. destruct (R j L) as (A & _). auto.
    - split; [auto|split; [simpl; lia|]]. destruct K as [WN _].
      assert (T : forall k, k < d -> turn (augment_new M e d) k (darts M) = darts M + k).
      { intros k. induction k as [|k IH]; simpl; [lia|]. intros Lk. rewrite IH by lia.
        unfold grow. cases. }
      apply degree_unique; auto; [simpl; lia|lia| |].
      + destruct d as [|d]; [lia|]. simpl. rewrite T by lia. unfold grow. cases.
      + intros k Lk. rewrite T; lia. }
  destruct G as (A & L & B).
  split; [apply (phi_alpha _ _ _ E e (partner_of M s) L A)|split; [exact E|]].
  destruct s as [j|d]; auto. transitivity (degree (grown M (Hang d)) (darts M)); [|exact B].
  apply (embedded_degree _ _ _ (proj1 K) (world_is_map _ HW) E).
  unfold grown. rewrite Eo. simpl. lia.
Qed.

(** Sequences that lead from one map to isomorphic worlds are one sequence. *)
Lemma growths_differ n : forall M u r ss ts, has_open M u -> In ss (growths n u r) ->
  In ts (growths n u r) -> isomorphic (fold_left grown ss M) (fold_left grown ts M) -> ss = ts.
Proof.
  induction n as [|n IH]; intros M u r ss ts H I J Iso.
  - destruct u; [|destruct I]. simpl in I, J. destruct (r =? 0); [|destruct I].
    destruct I as [<-|[]], J as [<-|[]]. auto.
  - assert (I' := I). assert (J' := J). apply in_growths in I' as (s & ss' & v & -> & -> & Is & I').
    apply in_growths in J' as (t & ts' & v' & -> & V & Js & J'). injection V as <-.
    apply in_growths_next in Is, Js.
    destruct (has_open_first M v H) as (e & others & Eo & Lo & He & _ & R).
    destruct (growths_first n M v r s ss' e others H Eo I) as (A & E & B).
    destruct (growths_first n M v r t ts' e others H Eo J) as (A' & E' & B').
    destruct (growths_right (S n) M (S v) r _ H I) as (WV & DV & EV).
    destruct (growths_right (S n) M (S v) r _ H J) as (WW & DW & EW).
    set (V := fold_left grown (s :: ss') M) in *. set (W := fold_left grown (t :: ts') M) in *.
    destruct Iso as [Len (phi & F & Rest)]. destruct H as (WM & CM & LM).
    assert (U := embedded_unique M W _ _ CM WM (embedded_after _ _ _ _ _ EV F) EW). simpl in U.
    assert (LV : partner_of M s < darts V).
    { apply (alpha_ok V (world_is_map V WV) e); auto. apply (phi_lt _ _ _ EV). auto. }
    assert (P : partner_of M t = phi (partner_of M s)).
    { assert (Q := phi_alpha _ _ _ F e (partner_of M s) (phi_lt _ _ _ EV e He) A). rewrite (U e He) in Q.
      congruence. }
    assert (s = t) as <-.
    { destruct s as [j|d], t as [k|d'].
      - f_equal. rewrite (U _ B) in P. simpl in P. rewrite Eo in P. simpl in P.
        assert (O := open_darts_once M). rewrite Eo in O. apply NoDup_cons_iff in O as [_ O].
        symmetry. apply (proj1 (NoDup_nth others 0) O); auto; lia.
      - rewrite (U _ B) in P. simpl in P, B. lia.
      - assert (Q := U _ B'). assert (C := phi_lt _ _ _ EV _ B').
        assert (Same : partner_of M (Meet k) = partner_of M (Hang d)) 
          by (apply (phi_inj _ _ _ F); congruence).
        simpl in Same, B'. lia.
      - f_equal. change (degree W (partner_of M (Hang d')) = d') in B'. rewrite P in B'.
        rewrite <- B, <- B'. symmetry.
        apply (embedded_degree V W phi (world_is_map V WV) (world_is_map W WW) F). auto. }
    f_equal. assert (H := conj WM (conj CM LM) : has_open M (S v)).
    destruct (has_open_grown n M v r s ss' H I) as (u & q & K & I1 & _ & S1).
    destruct (has_open_grown n M v r s ts' H J) as (u' & q' & _ & J1 & _ & S2).
    apply (IH (grown M s) u q); auto.
    + destruct s as [j|d]; destruct S1 as (_ & -> & ->), S2 as (_ & -> & ->); auto.
    + split; [exact Len|exists phi; auto].
Qed.

(** The steps by which M, embedded in W by phi, becomes W: at the least open dart W says what is next. *)
Fixpoint steps_to n W M phi := match n, open_darts M with
  | S n, e :: rest => match alpha W (phi e) with
    | Some a => match find (fun j => phi (nth j rest e) =? a) (seq 0 (length rest)) with
      | Some j => Meet j :: steps_to n W (grown M (Meet j)) phi
      | None => let d := degree W a in
          Hang d :: steps_to n W (grown M (Hang d)) (extend phi (darts M) W a) end
    | None => [] end
  | _, _ => [] end.

(** The plan of a world with m edges. *)
Definition plan_of m W := (degree W (root W),
  steps_to m W (initial (degree W (root W))) (fun x => turn W x (root W))).

(** A map without open darts is the world that it is embedded in. *)
Lemma none_open M W phi : has_open M 0 -> world W -> embedded M W phi -> isomorphic M W.
Proof.
  intros (WM & CM & L) HW E. apply (closed_isomorphic M W phi WM E); [apply HW|]. intros d Hd Od.
  apply length_zero_iff_nil in L. assert (J : In d (open_darts M)) by (apply in_open_darts; auto).
  rewrite L in J. destruct J.
Qed.

(** These steps are listed, and a world comes out of them, up to the numbering of its darts. *)
Lemma steps_to_right n : forall M u r W phi, has_open M u -> world W -> embedded M W phi ->
  darts W = darts M + r -> u + r = 2 * n -> let ss := steps_to n W M phi in
  In ss (growths n u r) /\ isomorphic (fold_left grown ss M) W.
Proof.
  induction n as [|n IH]; intros M u r W phi H HW E Len Sum; assert (WW := world_is_map W HW).
  - assert (u = 0) as -> by lia. assert (r = 0) as -> by lia. split; [left; auto|].
    apply (none_open M W phi); auto.
  - destruct u as [|v]; [exfalso; destruct (none_open M W phi H HW E); lia|].
    destruct (has_open_first M v H) as (e & others & Eo & Lo & He & Oe & R). assert (H' := H).
    destruct H' as (WM & CM & LM). assert (Le := phi_lt _ _ _ E e He). cbn [steps_to]. rewrite Eo.
    destruct (alpha W (phi e)) as [a|] eqn:Ha; [|destruct (world_total W HW (phi e) Le Ha)].
    destruct (find (fun j => phi (nth j others e) =? a) (seq 0 (length others))) as [j|] eqn:F.
    + apply find_seq in F as (Lj & Ej & _). apply Nat.eqb_eq in Ej. rewrite Lo in Lj. simpl in Lj.
      destruct Lj as [_ Lj]. destruct (has_open_meet M v j H Lj) as [K D].
      assert (E' : embedded (grown M (Meet j)) W phi).
      { unfold grown. rewrite Eo. apply embedded_loop; auto; [apply R; auto|congruence]. }
      destruct (IH (grown M (Meet j)) (v - 1) r W phi K HW E') as [I Iso]; [lia|lia|].
      split; [|exact Iso]. apply in_growths. exists (Meet j). eexists _, v.
      split; [reflexivity|]. rewrite in_growths_next. auto.
    + assert (New : is_new M phi a).
      { intros h Lh Eh. destruct (posed M W phi WM WW E e a h He Oe Ha Lh Eh) as (N & Oh & _).
        assert (I : In h (open_darts M)) by (apply in_open_darts; auto). rewrite Eo in I.
        destruct I as [I|I]; [congruence|]. destruct (In_nth others h e I) as (j & Lj & Ej).
        assert (Z := find_none _ _ F j ltac:(apply in_seq; lia)). cbv beta in Z.
        rewrite Ej, Eh, Nat.eqb_refl in Z. discriminate. }
      assert (La : a < darts W) by (apply (alpha_ok W WW) in Ha; auto; apply Ha).
      destruct (degree_spec W WW a La) as (Pd & _). cbv zeta. set (d := degree W a) in *.
      destruct (has_open_hang M v d H Pd) as [K D].
      assert (E' : embedded (grown M (Hang d)) W (extend phi (darts M) W a))
        by (unfold grown; rewrite Eo; apply embedded_new; auto).
      assert (Le' := pigeon _ _ _ (phi_lt _ _ _ E') (phi_inj _ _ _ E')).
      destruct (IH (grown M (Hang d)) (v + d - 1) (r - d) W _ K HW E') as [I Iso]; [lia|lia|].
      split; [|exact Iso]. apply in_growths. exists (Hang d). eexists _, v.
      split; [reflexivity|]. rewrite in_growths_next. split; [auto|]. split; [lia|auto].
Qed.

(** The plan of a world is listed, and the world comes out of it. *)
Lemma plan_of_right m W : world W -> darts W = 2 * m ->
  In (plan_of m W) (plans m) /\ isomorphic (planned (plan_of m W)) W.
Proof.
  intros HW Len. assert (WW := world_is_map W HW). assert (R := root_lt W WW).
  destruct (degree_spec W WW _ R) as (Pd & _). assert (E := embedded_initial W WW). unfold plan_of.
  set (d := degree W (root W)) in *. assert (Le := pigeon _ _ _ (phi_lt _ _ _ E) (phi_inj _ _ _ E)).
  simpl in Le. assert (H := has_open_initial d Pd).
  destruct (steps_to_right m (initial d) d (2 * m - d) W _ H HW E) as [I Iso]; simpl darts; try lia.
  split; [|exact Iso]. apply in_plans. split; [lia|auto].
Qed.

(** Every world with m edges is listed, up to the numbering of its darts.
    Not in the paper. *)
Theorem listed_every W m : world W -> darts W = 2 * m ->
  exists V, In (Edges V) (listed m) /\ isomorphic V W.
Proof.
  intros HW Len. destruct (plan_of_right m W HW Len) as [I Iso]. exists (planned (plan_of m W)).
  split; [|exact Iso]. assert (R := root_lt W (world_is_map W HW)). destruct m as [|m]; [lia|].
  apply (in_map (fun p => Edges (planned p))), I.
Qed.

(** Plans of isomorphic worlds are one plan. *)
Lemma plans_differ m p q : In p (plans m) -> In q (plans m) ->
  isomorphic (planned p) (planned q) -> p = q.
Proof.
  destruct p as (d, ss), q as (c, ts). intros I J Iso. apply in_plans in I as [L I], J as [L' J].
  assert (Hd := has_open_initial d ltac:(lia)). assert (Hc := has_open_initial c ltac:(lia)).
  destruct (growths_right _ _ _ _ _ Hd I) as (A & _ & E).
  destruct (growths_right _ _ _ _ _ Hc J) as (B & _ & F).
  assert (First : forall x, 0 < x -> degree (initial x) (root (initial x)) = x).
  { intros x Lx. assert (T : forall k, k < x -> turn (initial x) k 0 = k).
    { intros k. induction k as [|k IH]; simpl; auto. intros Lk. rewrite IH by lia. unfold grow. cases. }
    apply degree_unique; simpl; auto; [apply is_map_initial; auto| |].
    - destruct x as [|x]; [lia|]. simpl. rewrite T by lia. unfold grow. cases.
    - intros k Lk. rewrite T; lia. }
  assert (Deg : forall x W, 0 < x -> world W -> embedded (initial x) W (fun y => y) ->
    degree W (root W) = x).
  { intros x W Lx HW Ex. assert (R := phi_root _ _ _ Ex). cbv beta in R. rewrite <- R.
    transitivity (degree (initial x) (root (initial x))); [|auto].
    apply (embedded_degree _ _ _ (is_map_initial x Lx) (world_is_map W HW) Ex).
    apply root_lt, is_map_initial, Lx. }
  assert (c = d) as ->.
  { destruct Iso as (_ & phi & G & _). unfold planned in G. simpl fst in G. simpl snd in G.
    assert (WA := world_is_map _ A). assert (WB := world_is_map _ B).
    assert (P := embedded_degree _ _ _ WA WB G _ (root_lt _ WA)). rewrite (phi_root _ _ _ G) in P.
    rewrite (Deg d _ ltac:(lia) A E), (Deg c _ ltac:(lia) B F) in P. auto. }
  f_equal. apply (growths_differ m _ d (2 * m - d) ss ts Hd I J Iso).
Qed.

(** Lists without repetition that share no element, one after the other. *)
Lemma nodup_flat_map {A B} (f : A -> list B) l : NoDup l -> (forall x, In x l -> NoDup (f x)) ->
  (forall x y z, In z (f x) -> In z (f y) -> x = y) -> NoDup (flat_map f l).
Proof.
  intros Nl F G. induction Nl as [|x l N Nl IH]; simpl; [constructor|]. simpl in F.
  apply nodup_append; auto. intros z I J. apply in_flat_map in J as (y & J & K).
  rewrite (G x y z I K) in N. auto.
Qed.

(** Putting an element in front of lists, or a number beside them, makes none of them equal. *)
Lemma nodup_in_front {A B} (f : A -> B) l : (forall x y, f x = f y -> x = y) -> NoDup l ->
  NoDup (map f l).
Proof.
  intros F. induction 1 as [|x l N Nl IH]; simpl; constructor; auto.
  intros I. apply in_map_iff in I as (y & E & I). apply F in E as ->. auto.
Qed.

(** No sequence is listed twice. *)
Lemma growths_once n : forall u r, NoDup (growths n u r).
Proof.
  assert (Front : forall c l (ss : list growth), In ss (map (cons c) l) -> exists rest, ss = c :: rest)
    by (intros c l ss I; apply in_map_iff in I as (rest & <- & _); eauto).
  induction n as [|n IH]; intros [|u] r; simpl; try constructor.
  - destruct (r =? 0); repeat constructor. intros [].
  - apply nodup_flat_map.
    + apply nodup_append; try (apply nodup_in_front; [congruence|apply seq_NoDup]). intros c I J.
      apply in_map_iff in I as (j & <- & _). apply in_map_iff in J as (d & Q & _). discriminate.
    + intros [j|d] _; apply nodup_in_front; auto; congruence.
    + intros x y z I J. apply Front in I as (? & ->). apply Front in J as (? & Q). congruence.
Qed.

(** No plan is listed twice. *)
Lemma plans_once m : NoDup (plans m).
Proof.
  apply nodup_flat_map; [apply seq_NoDup| |].
  - intros d _. apply nodup_in_front; [congruence|apply growths_once].
  - intros x y z I J. apply in_map_iff in I as (a & <- & _), J as (b & Q & _). congruence.
Qed.

(** No two listed worlds are isomorphic.
    Not in the paper. *)
Theorem listed_once m i j V W : nth_error (listed m) i = Some (Edges V) ->
  nth_error (listed m) j = Some (Edges W) -> isomorphic V W -> i = j.
Proof.
  destruct m as [|m]; [destruct i as [|[|i]]; discriminate|]. unfold listed. rewrite !nth_error_map.
  destruct (nth_error (plans (S m)) i) as [p|] eqn:I; [|discriminate].
  destruct (nth_error (plans (S m)) j) as [q|] eqn:J; [|discriminate]. simpl. intros P Q Iso.
  injection P as <-. injection Q as <-.
  apply (proj1 (NoDup_nth_error _) (plans_once (S m))); [apply nth_error_Some; congruence|].
  rewrite I, J. f_equal. apply (plans_differ (S m)); auto; eapply nth_error_In; eauto.
Qed.
