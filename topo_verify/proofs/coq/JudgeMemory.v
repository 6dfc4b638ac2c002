(** What the judge remembers: the edges that were crossed, the edge that was posed last, the
    hypotheses in question; and so what it says of claims 2 to 4 (docs/semantics.md, section 9).

    The letters are those of Claims.v and Judge.v. *)
From Coq Require Import Arith Lia List NArith Bool.
Import ListNotations.
From Topo Require Import World Rotation Embedding Log AnyWorld Augment Vertices Events Table LogFold
  Claims
  Judge JudgeRun.

(** [add_once] adds one element. *)
Lemma mem_insert x y l : mem x (add_once y l) = true <-> y = x \/ mem x l = true.
Proof.
  unfold add_once. destruct (mem y l) eqn:E; rewrite !mem_in in *; simpl; [|tauto].
  split; [tauto|]. intros [->|I]; auto.
Qed.

(** [add_pair_once] adds one pair. *)
Lemma in_insert_pair q r l : In q (add_pair_once r l) <-> r = q \/ In q l.
Proof.
  unfold add_pair_once. destruct (existsb (place_eqb r) l) eqn:E; simpl; [|tauto].
  split; [tauto|]. intros [->|I]; auto. apply existsb_exists in E as (p & I & E).
  apply place_eqb_eq in E as ->. auto.
Qed.

(** Asking for several hypotheses adds each. *)
Lemma in_asked x H l y h : In (y, h) (fold_right (fun h l => add_pair_once (x, h) l) l H) <->
  (x = y /\ In h H) \/ In (y, h) l.
Proof.
  induction H as [|g H IH]; simpl; [tauto|]. rewrite in_insert_pair, IH.
  split; [|intuition (subst; auto)].
  intros [E|[[E I]|I]]; auto. injection E as <- <-. auto.
Qed.

(** What is posed last, one step later. *)
Lemma posed_last_snoc past d e : posed_last (past ++ [d]) e <-> match d with
  | Pose e' _ => e' = e | Act ev => ~ grows ev /\ posed_last past e end.
Proof.
  split.
  - intros (before & H & after & E & A).
    apply split_snoc in E as [(_ & -> & _)|(rest & -> & ->)]; [auto|].
    assert (D := A d ltac:(apply in_or_app; simpl; auto)). destruct d as [e' H'|ev]; [tauto|].
    split; auto. exists before, H, rest. split; auto. intros d I. apply A, in_or_app. auto.
  - destruct d as [e' H|ev].
    + intros ->. exists past, H, []. split; auto. intros d [].
    + intros (G & before & H & after & -> & A). exists before, H, (after ++ [Act ev]).
      rewrite <- app_assoc. split; auto. intros d I. apply in_app_or in I as [I|[<-|[]]]; auto.
      apply A; auto.
Qed.

(** What was crossed, one step later. *)
Lemma crossed_snoc W past d x : crossed_edge W (past ++ [d]) x <-> crossed_edge W past x \/
  exists k p a, d = Act (Move k p) /\ stands W past a /\ one_edge W (turn W k a) x.
Proof.
  split.
  - intros (before & k & p & after & a & E & St & O).
    apply split_snoc in E as [(<- & -> & _)|(rest & -> & ->)]; [right; eauto 6|].
    left. exists before, k, p, rest, a. auto.
  - intros [(before & k & p & after & a & -> & St & O)|(k & p & a & -> & St & O)].
    + exists before, k, p, (after ++ [d]), a. rewrite <- app_assoc. auto.
    + exists past, k, p, [], a. auto.
Qed.

(** What is in question, one step later. *)
Lemma in_question_snoc W past d x h : in_question W (past ++ [d]) x h <-> match d with
  | Pose e H => (means W past e x /\ In h H) \/ in_question W past x h
  | Act (Reject e g) | Act (Confirm e g) => in_question W past x h /\ ~ (g = h /\ means W past e x)
  | Act _ => in_question W past x h end.
Proof.
  assert (Old : in_question W (past ++ [d]) x h -> (exists e H, d = Pose e H /\ means W past e x /\
    In h H) \/
    (in_question W past x h /\ forall e, d = Act (Reject e h) \/ d = Act (Confirm e h) ->
      ~ means W past e x)).
  { intros (before & e & H & after & E & M & I & N).
    apply split_snoc in E as [(<- & -> & _)|(rest & -> & ->)]; [left; eauto|]. right. split.
    - exists before, e, H, rest. repeat split; auto. intros some e' rest' E.
        apply (N some e' (rest' ++ [d])).
      destruct E as [-> | ->]; [left|right]; rewrite <- app_assoc; auto.
    - intros e' E. apply (N rest e' []). destruct E as [-> | ->]; auto. }
  assert (Keep : in_question W past x h ->
    (forall e, d = Act (Reject e h) \/ d = Act (Confirm e h) -> ~ means W past e x) ->
    in_question W (past ++ [d]) x h).
  { intros (before & e & H & after & -> & M & I & N) D. exists before, e, H, (after ++ [d]).
    rewrite <- app_assoc. repeat split; auto. intros some e' rest E.
    assert (E' : exists d', (d' = Act (Reject e' h) \/ d' = Act (Confirm e' h)) /\
      after ++ [d] = some ++ d' :: rest) by (destruct E as [E|E]; eauto).
    destruct E' as (d' & K & E'). apply split_snoc in E' as [(<- & <- & _)|(rest' & -> & ->)].
    - apply D; auto.
    - apply (N some e' rest'). destruct K as [-> | ->]; auto. }
  split.
  - intros Q. apply Old in Q as [(e & H & -> & M & I)|[Q D]]; auto.
    destruct d as [e H|[k p|e g|e g|e g n|e a n]]; auto; split; auto; intros (-> & M); apply (D e); auto.
  - destruct d as [e H|[k p|e g|e g|e g n|e a n]]; try (intros Q; apply Keep; auto; intros e' [E|E];
      discriminate).
    + intros [[M I]|Q].
      * exists past, e, H, []. repeat split; auto. intros [|d some] e' rest [E|E]; discriminate.
      * apply Keep; auto. intros e' [E|E]; discriminate.
    + intros [Q N]. apply Keep; auto. intros e' [E|E]; [|discriminate]. injection E as <- <-. tauto.
    + intros [Q N]. apply Keep; auto. intros e' [E|E]; [discriminate|]. injection E as <- <-. tauto.
Qed.

Section Memory.
Variable W : Map.
Hypotheses (HW : 0 < darts W -> world W) (HR : darts W = 0 -> root W = 0).
Notation at_stage past := (fold_left (next_stage W) past (first_stage W)).

(** A dart of the world makes it one. *)
Lemma some_dart x : x < darts W -> world W.
Proof. intros L. apply HW. lia. Qed.

(** The names of edges tell edges apart. *)
Lemma edge_key_eq x y : x < darts W -> y < darts W -> (edge_key W x = edge_key W y <-> one_edge W x y).
Proof.
  intros Lx Ly. assert (Ww := some_dart x Lx). assert (WW := world_is_map W Ww).
  assert (Tx := world_total W Ww x Lx). assert (Ty := world_total W Ww y Ly).
  unfold edge_key, one_edge.
  destruct (alpha W x) as [x'|] eqn:Ex; [|tauto]. destruct (alpha W y) as [y'|] eqn:Ey; [|tauto].
  destruct (alpha_ok W WW x x' Lx Ex) as (Lx' & Nx & Bx), (alpha_ok W WW y y' Ly Ey) as (Ly' & Ny & By).
  split.
  - intros E. destruct (Nat.eq_dec x y) as [|N]; auto. right. f_equal.
    destruct (Nat.min_spec x x') as [[_ M]|[_ M]], (Nat.min_spec y y') as [[_ M']|[_ M']];
      rewrite M, M' in E; congruence.
  - intros [->|E]; [congruence|]. injection E as ->. assert (y' = x) by congruence. subst.
      apply Nat.min_comm.
Qed.

(** [one_edge] is symmetric, and its darts are darts of the world. *)
Lemma one_edge_lt x y : x < darts W -> one_edge W x y -> y < darts W.
Proof.
  intros L [<-|E]; auto. apply (alpha_ok W (world_is_map W (some_dart x L))) in E; auto. apply E.
Qed.

(** The stage knows the edges on which darts of S lie. *)
Lemma means_spec past s e x : follows W past s -> x < darts W ->
  (means W past e x <-> is_open (chart s) e = true /\ edge_key W x = key_of W s e).
Proof.
  intros F Lx. unfold means, key_of. rewrite is_open_spec.
  assert (Im : open_dart (chart s) e -> at_image (images s) e < darts W).
  { intros [L _]. apply (phi_lt _ _ _ (fo_image W _ _ F)). rewrite <- (fo_chart W _ _ F). auto. }
  rewrite <- (fo_chart W _ _ F). split.
  - intros (phi & E & O & One). split; auto.
    rewrite (follows_unique W HW HR past s phi F E) in One by apply O.
    symmetry. apply edge_key_eq; auto.
  - intros [O E]. exists (at_image (images s)). split; [apply F|]. split; auto.
    apply edge_key_eq; auto.
Qed.

(** The stage knows the edges that were crossed. *)
Lemma crossings_spec past x : sane W past -> x < darts W ->
  (mem (edge_key W x) (walked_edges (at_stage past)) = true <-> crossed_edge W past x).
Proof.
  intros Sp Lx. assert (Ww := some_dart x Lx). assert (WW := world_is_map W Ww). revert Sp.
  induction past as [|d past IH] using rev_ind; intros Sp.
  - simpl. split; [discriminate|]. intros ([|b before] & k & p & after & a & E & _); discriminate.
  - apply sane_snoc in Sp as (Sp & (c & St) & _). specialize (IH Sp).
    rewrite crossed_snoc, <- IH, fold_left_app. simpl fold_left. set (s := at_stage past) in *.
    destruct Sp as ((a & Sa) & _). assert (P : position s = Some a)
    by (unfold s; rewrite position_spec; auto).
    assert (Same : (forall k p, d <> Act (Move k p)) -> walked_edges (next_stage W s d) = walked_edges
      s).
    { intros N. destruct d as [e H|[k p|e h|e h|e h n|e a' n]]; simpl; unfold answered;
        try destruct (live s); try destruct (is_open (chart s) e); auto; try apply extended_spec;
        destruct (N k p); auto. }
    destruct d as [e H|[k p|e h|e h|e h n|e a' n]]; try (rewrite Same by discriminate;
      split; [auto|intros [?|(k & p & a'' & E & _)]; [auto|discriminate]]).
    simpl. unfold after_move. rewrite P. simpl.
    unfold stands in St. rewrite doors_snoc, walk_app, Sa in St. simpl in St.
    destruct (move W a k) as [b|] eqn:Em; [|discriminate].
    assert (La : a < darts W) by (apply (walk_lt W WW _ _ _ (root_lt W WW) Sa)).
    assert (Lt := turn_lt W WW k a La).
    assert (Eb : alpha W (turn W k a) = Some b).
    { unfold move in Em. destruct (k <? degree W a); [auto|discriminate]. }
    assert (Lb : b < darts W) by (apply (alpha_ok W WW) in Eb; [apply Eb|auto]).
    assert (K : edge_key W (turn W k a) = edge_key W b) by (apply edge_key_eq; auto; right; auto).
    rewrite mem_insert, <- K, edge_key_eq by auto. split.
    + intros [O|I]; auto. right. exists k, p, a. auto.
    + intros [I|(k' & p' & a'' & E & Sa' & O)]; auto. injection E as <- <-.
      unfold stands in Sa'. rewrite Sa in Sa'. injection Sa' as <-. auto.
Qed.

(** The stage knows what was posed last. *)
Lemma asked_spec past e : sane W past -> (asked (at_stage past) = Some e <-> posed_last past e).
Proof.
  induction past as [|d past IH] using rev_ind; intros Sp.
  - simpl. split; [discriminate|]. intros ([|b before] & H & after & E & _); discriminate.
  - apply sane_snoc in Sp as (Sp & _). assert (Lv := proj2 (proj1 (run_spec W HW HR past)) Sp).
    rewrite posed_last_snoc, fold_left_app. simpl fold_left. specialize (IH Sp).
    set (s := at_stage past) in *.
    destruct d as [e' H|[k p|e' h|e' h|e' h n|e' a n]]; simpl; rewrite ?Lv, <- ?IH; simpl;
      try (destruct (extended_spec W s (Loop e' h n) e' false) as (_ & _ & _ & -> & _));
      try (destruct (extended_spec W s (New e' a n) e' true) as (_ & _ & _ & -> & _));
        unfold after_move, answered; try destruct (is_open (chart s) e'); try destruct (position s);
          simpl;
      try tauto; try (split; [discriminate|tauto]); split; congruence.
Qed.

(** The stage knows what is in question. *)
Lemma questions_spec past x h : sane W past -> x < darts W ->
  (In (edge_key W x, h) (questions (at_stage past)) <-> in_question W past x h).
Proof.
  intros Sp Lx. revert Sp. induction past as [|d past IH] using rev_ind; intros Sp.
  - simpl. split; [tauto|]. intros ([|b before] & e & H & after & E & _); discriminate.
  - apply sane_snoc in Sp as (Sp & _). destruct (run_spec W HW HR past) as [Lv F].
    apply Lv in Sp as Lv'. specialize (F Sp). specialize (IH Sp). clear Lv.
    rewrite in_question_snoc, fold_left_app. simpl fold_left. set (s := at_stage past) in *.
    assert (M := fun e => means_spec past s e x F Lx).
    assert (Answer : forall e g, In (edge_key W x, h) (questions (answered W s e g)) <->
      In (edge_key W x, h) (questions s) /\ ~ (g = h /\ means W past e x)).
    { intros e g. rewrite M. unfold answered. destruct (is_open (chart s) e); [|intuition discriminate].
      simpl. rewrite filter_In, negb_true_iff, <- not_true_iff_false, place_eqb_eq.
      split; intros [I N]; (split; [auto|]).
      - intros (-> & _ & E). apply N. congruence.
      - intros E. injection E as E ->. apply N. auto. }
    destruct d as [e H|[k p|e g|e g|e g n|e a n]]; simpl; rewrite ?Lv', <- ?IH; simpl; auto; try tauto;
      try (destruct (extended_spec W s (Loop e g n) e false) as (_ & _ & _ & _ & -> & _); tauto);
      try (destruct (extended_spec W s (New e a n) e true) as (_ & _ & _ & _ & -> & _); tauto).
    + rewrite M. destruct (is_open (chart s) e); [rewrite in_asked|]; intuition congruence.
    + unfold after_move. destruct (position s); simpl; tauto.
Qed.

(** The stages of a list are those after its beginnings. *)
Lemma in_stages s d l : forall s0, In (s, d) (stages W s0 l) <->
  exists before after, l = before ++ d :: after /\ s = fold_left (next_stage W) before s0.
Proof.
  induction l as [|d' l IH]; intros s0; simpl.
  - split; [tauto|]. intros ([|b before] & after & E & _); discriminate.
  - rewrite IH. split.
    + intros [E|(before & after & -> & ->)]; [injection E as <- <-; exists [], l; auto|].
      exists (d' :: before), after. auto.
    + intros ([|b before] & after & E & ->); injection E as -> ->; [auto|]. right. eauto.
Qed.

(** A test is true somewhere exactly if it is true of a step that is judged. *)
Lemma somewhere_spec t test : somewhere W t test = true <->
  exists past d, judged W t past d /\ test (at_stage past) d = true.
Proof.
  unfold somewhere. rewrite existsb_exists. split.
  - intros ((s, d) & I & E). apply andb_true_iff in E as [Lv E]. simpl in *.
    apply in_stages in I as (past & after & El & ->). exists past, d. split; auto.
    split; [apply run_spec; auto|eauto].
  - intros (past & d & [Sp (after & El)] & E). exists (at_stage past, d). simpl. split.
    + apply in_stages. eauto.
    + rewrite E, andb_true_r. apply run_spec; auto.
Qed.

(** A test is true nowhere exactly if it is false of every step that is judged. *)
Lemma nowhere_spec t test : somewhere W t test = false <->
  forall past d, judged W t past d -> test (at_stage past) d = false.
Proof.
  rewrite <- not_true_iff_false, somewhere_spec. split.
  - intros N past d J. apply not_true_iff_false. intros T. apply N. exists past, d. auto.
  - intros A (past & d & J & E). rewrite A in E by auto. discriminate.
Qed.
End Memory.
