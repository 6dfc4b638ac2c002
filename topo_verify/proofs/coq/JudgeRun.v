(** The judge follows the run: at each stage it knows where the robot stands and what S is in the
    world (docs/semantics.md, section 9).

    The letters are those of Claims.v and Judge.v. [run_spec] says that steps are live exactly while
    every door exists and every augmentation is true, and that S and its images are right then;
    [holds_spec], that what an event declares is judged rightly. *)
From Coq Require Import Arith Lia List NArith Bool.
Import ListNotations.
From Topo Require Import World Rotation Embedding Log AnyWorld Augment Vertices Events Table LogFold
  Claims
  Judge.

(** [mem] decides membership. *)
Lemma mem_in x l : mem x l = true <-> In x l.
Proof.
  unfold mem. rewrite existsb_exists. split.
  - intros (y & I & E). apply Nat.eqb_eq in E. subst. auto.
  - intros I. exists x. rewrite Nat.eqb_refl. auto.
Qed.

(** [is_open] decides whether a dart is unexplored. *)
Lemma is_open_spec M d : is_open M d = true <-> open_dart M d.
Proof.
  unfold is_open, open_dart, explored. rewrite andb_true_iff, Nat.ltb_lt, negb_true_iff.
  destruct (alpha M d); intuition discriminate.
Qed.

(** One more step: the doors. *)
Lemma doors_snoc past d : doors_of (past ++ [d]) = doors_of past ++
  match d with Act (Move k _) => [k] | _ => [] end.
Proof.
  unfold doors_of, acts, log_after. simpl. rewrite !flat_map_app, map_app. f_equal.
  destruct d as [e H|[k p|e h|e h|e h n|e a n]]; auto.
Qed.

(** One more step: S. *)
Lemma S_snoc W past d : S_after W (past ++ [d]) = match d with
  | Act ev => drawn (S_after W past) ev | Pose _ _ => S_after W past end.
Proof.
  unfold S_after, map_after, acts. rewrite flat_map_app, fold_left_app. destruct d; auto.
Qed.

(** The last step of a list that is split: it is the middle, or belongs to the rest. *)
Lemma split_snoc {X} (l : list X) x before y after : l ++ [x] = before ++ y :: after ->
  (l = before /\ x = y /\ after = []) \/ exists rest, after = rest ++ [x] /\ l = before ++ y :: rest.
Proof.
  destruct after as [|z rest _] using rev_ind; intros E.
  - apply app_inj_tail in E as [-> ->]. auto.
  - right. exists rest. rewrite app_comm_cons, app_assoc in E. apply app_inj_tail in E as [-> ->]. auto.
Qed.

(** Correspondences that agree on the darts of a map. *)
Lemma embedded_agree M W f g : is_map M -> (forall d, d < darts M -> f d = g d) -> embedded M W f ->
  embedded M W g.
Proof.
  intros WM A E. split.
  - intros d Hd. rewrite <- A by auto. apply (phi_lt _ _ _ E); auto.
  - intros d e Hd He. rewrite <- !A by auto. apply (phi_inj _ _ _ E); auto.
  - intros d Hd. rewrite <- !A by (auto; apply sigma_lt; auto). apply (phi_sigma _ _ _ E); auto.
  - intros d e Hd Hx. destruct (alpha_ok M WM d e Hd Hx) as (L & _). rewrite <- !A by auto.
    apply (phi_alpha _ _ _ E); auto.
  - rewrite <- A by (apply root_lt; auto). apply (phi_root _ _ _ E).
Qed.

(** What is true of one of them is true of the other. *)
Lemma true_event_agree W M f g ev : (forall d, d < darts M -> f d = g d) -> true_event W M f ev ->
  true_event W M g ev.
Proof.
  unfold true_event, open_dart. intros A. destruct ev as [k p|e h|e h|e h n|e a n]; auto.
  - intros ([Le Oe] & [Lh Oh] & N). rewrite <- !A by auto. auto.
  - intros ([Le Oe] & [Lh Oh] & N). rewrite <- !A by auto. auto.
  - intros ([Le Oe] & [Lh Oh] & N). rewrite <- !A by auto. auto.
  - intros ([Le Oe] & E & b & Eb & D & N). split; auto. split; auto. exists b. rewrite <- A by auto.
    split; auto. split; auto. intros h Lh. rewrite <- A by auto. auto.
Qed.

(** What an augmentation does not change, and whether it is true. *)
Lemma extended_spec W s ev e new : let z := extended W s ev e new in position z = position s /\
  faithful z = event_true W (chart s) (images s) ev /\ walked_edges z = walked_edges s /\
    asked z = None /\
  questions z = questions s /\ poses z = poses s.
Proof. unfold extended. destruct (event_true W (chart s) (images s) ev); simpl; auto 10. Qed.

(** The next stage does not turn the robot but by a move. *)
Lemma position_next W s d : position (next_stage W s d) = match d with
  | Act (Move k _) => match position s with Some a => move W a k | None => None end
  | _ => position s end.
Proof.
  destruct d as [e H|[k p|e h|e h|e h n|e a n]]; simpl; unfold after_move, answered;
    try destruct (live s);
    try destruct (is_open (chart s) e); auto; try apply extended_spec; destruct (position s) eqn:E; auto.
Qed.

Section Run.
Variable W : Map.
Hypotheses (HW : 0 < darts W -> world W) (HR : darts W = 0 -> root W = 0).
Notation at_stage past := (fold_left (next_stage W) past (first_stage W)).

(** The stage knows where the robot stands. *)
Lemma position_spec past : position (at_stage past) = walk W (root W) (doors_of past).
Proof.
  induction past as [|d past IH] using rev_ind; auto.
  rewrite fold_left_app, doors_snoc, walk_app, <- IH. simpl fold_left. rewrite position_next.
  destruct d as [e H|[k p|e h|e h|e h n|e a n]]; destruct (position (at_stage past)) as [b|]; simpl;
    auto.
  destruct (move W b k); auto.
Qed.

(** The stage has S and its images. *)
Record follows past s : Prop := {
  fo_chart : chart s = S_after W past;
  fo_image : drawn_by W past (at_image (images s));
  fo_map : 0 < darts (chart s) -> is_map (chart s) /\ connected (chart s);
  fo_length : length (images s) = darts (chart s) }.

(** S has no dart in a world without one. *)
Lemma follows_world past s : follows past s -> 0 < darts (chart s) -> world W.
Proof.
  intros F L. apply HW. apply Nat.lt_le_trans with (S (at_image (images s) 0)); [lia|].
  apply (phi_lt _ _ _ (fo_image _ _ F)). rewrite <- (fo_chart _ _ F). auto.
Qed.

(** Whatever embeds S agrees with the images. *)
Lemma follows_unique past s phi : follows past s -> drawn_by W past phi ->
  forall d, d < darts (chart s) -> phi d = at_image (images s) d.
Proof.
  intros F E d Ld. destruct (fo_map _ _ F) as [WM CM]; [lia|].
  apply (embedded_unique (chart s) W); auto; rewrite (fo_chart _ _ F); auto. apply F.
Qed.

(** A declared event holds exactly if it is true of the images. *)
Lemma holds_image past s ev : follows past s ->
  (is_so W past ev <-> true_event W (chart s) (at_image (images s)) ev).
Proof.
  intros F. split.
  - intros (phi & E & T). rewrite <- (fo_chart _ _ F) in T.
    apply (true_event_agree W _ phi); auto. apply (follows_unique past); auto.
  - intros T. exists (at_image (images s)). rewrite <- (fo_chart _ _ F). split; auto. apply F.
Qed.

(** [ends_in] decides where an edge ends. *)
Lemma ends_in_spec l e h : ends_in W l e h = true <-> alpha W (at_image l e) = Some (at_image l h).
Proof.
  unfold ends_in. destruct (alpha W (at_image l e)); [|intuition discriminate].
  rewrite Nat.eqb_eq. intuition congruence.
Qed.

(** The images list the darts of S. *)
Lemma mem_image s b : length (images s) = darts (chart s) ->
  mem b (images s) = true <-> exists h, h < darts (chart s) /\ at_image (images s) h = b.
Proof.
  intros L. rewrite mem_in. split.
  - intros I. apply (In_nth _ _ 0) in I. rewrite L in I. auto.
  - intros (h & Lh & <-). apply nth_In. lia.
Qed.

(** [event_true] decides whether a declared event is true. *)
Lemma holds_spec past s ev : follows past s -> (is_so W past ev <->
  event_true W (chart s) (images s) ev = true).
Proof.
  intros F. rewrite (holds_image past s) by auto. assert (L := fo_length _ _ F).
  destruct ev as [k p|e h|e h|e h n|e a n]; simpl; rewrite ?andb_true_iff, ?is_open_spec, ?negb_true_iff.
  - tauto.
  - rewrite <- not_true_iff_false, ends_in_spec. tauto.
  - rewrite ends_in_spec. tauto.
  - rewrite ends_in_spec, Nat.eqb_eq. tauto.
  - rewrite Nat.eqb_eq. split.
    + intros (O & E & b & -> & D & N). split; auto. rewrite andb_true_iff, Nat.eqb_eq, negb_true_iff.
      split; auto. apply not_true_iff_false. rewrite mem_image by auto. intros (h & Lh & Eh).
      apply (N h); auto.
    + intros ((O & E) & H). destruct (alpha W (at_image (images s) e)) as [b|]; [|discriminate].
      rewrite andb_true_iff, Nat.eqb_eq, negb_true_iff in H. destruct H as [D N].
      split; auto. split; auto. exists b. split; auto. split; auto. intros h Lh Eh.
      apply not_true_iff_false in N. apply N. apply mem_image; eauto.
Qed.

(** One more step is sane. *)
Lemma sane_snoc past d : sane W (past ++ [d]) <-> sane W past /\ (exists a, stands W (past ++ [d]) a) /\
  forall ev, d = Act ev -> grows ev -> is_so W past ev.
Proof.
  split.
  - intros [St G]. split; [split|split]; auto.
    + destruct St as (a & St). unfold stands in *. rewrite doors_snoc, walk_app in St.
      destruct (walk W (root W) (doors_of past)); eauto.
    + intros before ev after E. apply (G before ev (after ++ [d])). rewrite E, <- app_assoc. auto.
    + intros ev -> Gr. apply (G past ev []); auto.
  - intros ([_ G] & St & G'). split; auto. intros before ev after E Gr.
    apply split_snoc in E as [(<- & -> & _)|(rest & _ & ->)]; auto. apply (G before ev rest); auto.
Qed.

(** The stage at the start. *)
Lemma follows_start : follows [] (first_stage W).
Proof.
  assert (A : forall x, x < degree W (root W) -> turn W x (root W) =
    at_image (map (fun k => turn W k (root W)) (seq 0 (degree W (root W)))) x).
  { intros x Lx. unfold at_image. rewrite (nth_indep _ 0 (turn W 0 (root W)))
      by (rewrite map_length, seq_length; auto).
    rewrite (map_nth (fun k => turn W k (root W))), seq_nth; auto. }
  destruct (Nat.eq_dec (darts W) 0) as [Z|N].
  - assert (D : degree W (root W) = 0) by (unfold degree; rewrite Z; auto).
    split; simpl; auto; [|rewrite D; simpl; lia..].
    unfold drawn_by, S_after, map_after. simpl. rewrite D. split; simpl; try lia.
    unfold at_image. simpl. rewrite HR; auto.
  - assert (HW' := HW ltac:(lia)). assert (WW := world_is_map W HW').
    destruct (degree_spec W WW (root W) (root_lt W WW)) as (P & _). split; simpl; auto.
    + apply (embedded_agree _ _ (fun x => turn W x (root W))); auto.
      * apply is_map_initial; auto.
      * apply embedded_initial; auto.
    + intros _. split; [apply is_map_initial|apply connected_initial]; auto.
    + rewrite map_length, seq_length. auto.
Qed.

(** A true augmentation keeps the images right. *)
Lemma follows_grown past s ev new e : follows past s -> grows ev -> is_so W past ev ->
  follows (past ++ [Act ev]) (extended W s ev e new).
Proof.
  intros F G T. assert (X := proj1 (holds_spec past s ev F) T). unfold extended. rewrite X. clear X.
  apply (holds_image past s) in T; auto.
  assert (E := fo_image _ _ F). unfold drawn_by in E. rewrite <- (fo_chart _ _ F) in E.
  assert (L := fo_length _ _ F).
  assert (St : S_after W (past ++ [Act ev]) = drawn (chart s) ev) by (rewrite S_snoc, (fo_chart _ _ F);
    auto).
  destruct ev as [k p|e' h|e' h|e' h n|e' a n]; try destruct G.
  - destruct T as ((Le & Oe) & (Lh & Oh) & Ha & _).
    destruct (fo_map _ _ F) as [WM CM]; [lia|]. assert (WW := world_is_map W (follows_world _ _ F
      ltac:(lia))).
    assert (N : h <> e').
    { intros ->. apply (alpha_ok W WW) in Ha; [|apply (phi_lt _ _ _ E); auto]. apply Ha; auto. }
    split; simpl; auto.
    + unfold drawn_by. rewrite St. apply embedded_loop; auto.
    + intros _. split; [apply is_map_loop|apply connected_loop]; auto.
  - destruct T as ((Le & Oe) & -> & b & Ha & D & N).
    destruct (fo_map _ _ F) as [WM CM]; [lia|]. assert (WW := world_is_map W (follows_world _ _ F
      ltac:(lia))).
    assert (Lb : b < darts W).
    { apply (alpha_ok W WW) in Ha; [apply Ha|apply (phi_lt _ _ _ E); auto]. }
    destruct (degree_spec W WW b Lb) as (P & _). rewrite D in P.
    assert (WM' : is_map (augment_new (chart s) e' n)) by (apply is_map_new; auto).
    split; simpl; auto.
    + unfold drawn_by. rewrite St. simpl. rewrite Ha.
      apply (embedded_agree _ _ (extend (at_image (images s)) (darts (chart s)) W b)); auto.
      * simpl. intros x Lx. unfold extend, at_image. destruct (Nat.ltb_spec x (darts (chart s))).
        -- rewrite app_nth1; auto. lia.
        -- rewrite app_nth2, L by lia. rewrite (nth_indep _ 0 (turn W 0 b))
             by (rewrite map_length, seq_length; lia).
           rewrite (map_nth (fun k => turn W k b)), seq_nth by lia. auto.
      * rewrite <- D. apply embedded_new; auto.
    + intros _. split; auto. apply connected_new; auto.
    + rewrite Ha, app_length, map_length, seq_length. lia.
Qed.

(** A step that is no augmentation changes neither S nor the images. *)
Lemma follows_same past s d : follows past s -> grows_b d = false ->
  follows (past ++ [d]) (next_stage W s d).
Proof.
  intros F G.
  assert (Sd : S_after W (past ++ [d]) = S_after W past).
  { rewrite S_snoc. destruct d as [e H|[k p|e h|e h|e h n|e a n]]; auto; discriminate. }
  assert (C : chart (next_stage W s d) = chart s /\ images (next_stage W s d) = images s).
  { destruct d as [e H|[k p|e h|e h|e h n|e a n]]; try discriminate G; simpl;
    unfold after_move, answered;
      try destruct (live s); try destruct (is_open (chart s) e); try destruct (position s); auto. }
  destruct C as [C I], F as [F1 F2 F3 F4]. split; unfold drawn_by in *; rewrite ?C, ?I, ?Sd; auto.
Qed.

(** Deeds are live exactly while every door exists and every augmentation is true. *)
Lemma run_spec past : (live (at_stage past) = true <-> sane W past) /\
  (sane W past -> follows past (at_stage past)).
Proof.
  induction past as [|d past [IHl IHf]] using rev_ind.
  - split; [|intros; apply follows_start]. split; auto. intros _. split; [exists (root W); reflexivity|].
    intros [|b before] ev after E; discriminate.
  - rewrite sane_snoc. unfold stands. rewrite <- position_spec, fold_left_app. simpl fold_left.
    set (s := at_stage past) in *.
    assert (Now : exists b, position (next_stage W s d) = b) by eauto. destruct Now as [now Now].
    destruct (live s) eqn:Lv.
    2: { split; [|intros [Sp _]; apply IHl in Sp; discriminate]. split.
         - assert (X : faithful (next_stage W s d) = faithful s /\
             (position (next_stage W s d) <> None -> position s <> None)).
           { rewrite position_next. destruct d as [e H|[k p|e h|e h|e h n|e a n]]; simpl; rewrite ?Lv;
             auto.
             unfold after_move. destruct (position s); auto. split; auto. discriminate. }
           unfold live in *. destruct X as [X Y]. rewrite X.
           destruct (position (next_stage W s d)), (position s); try congruence.
           destruct Y; congruence.
         - intros [Sp _]. apply IHl in Sp. discriminate. }
    assert (Sp : sane W past) by (apply IHl; auto). assert (F := IHf Sp).
    destruct (grows_b d) eqn:G.
    + destruct d as [e H|ev]; [discriminate|].
      assert (Gr : grows ev) by (destruct ev; simpl; auto; discriminate).
      assert (Nx : exists e new, next_stage W s (Act ev) = extended W s ev e new).
      { destruct ev; try discriminate G; simpl; rewrite Lv; eauto. }
      destruct Nx as (e & new & Nx). rewrite Nx. destruct (extended_spec W s ev e new) as (Ep & Ef &
        _). split.
      * assert (P : position (extended W s ev e new) <> None).
        { rewrite Ep. unfold live in Lv. destruct (position s); congruence. }
        unfold live at 1. destruct (position (extended W s ev e new)) as [a|] eqn:Ea; [|tauto].
        rewrite Ef, <- (holds_spec past s) by auto. split.
        -- intros T. split; auto. split; eauto. intros ev' Q. injection Q as <-. auto.
        -- intros (_ & _ & T). auto.
      * intros (_ & _ & T). apply follows_grown; auto.
    + split; [|intros _; apply follows_same; auto].
      assert (X : faithful (next_stage W s d) = faithful s).
      { destruct d as [e H|[k p|e h|e h|e h n|e a n]]; try discriminate G; simpl; rewrite ?Lv; auto;
          unfold after_move, answered; try destruct (is_open (chart s) e); try destruct (position s);
            auto. }
      unfold live at 1. rewrite X. unfold live in Lv. destruct (position s); [|discriminate].
      destruct (position (next_stage W s d)) as [a|].
      * split; auto. intros _. split; auto. split; eauto. intros ev -> Gr.
        destruct ev; simpl in *; tauto || discriminate.
      * split; [discriminate|]. intros (_ & (a & Ha) & _). discriminate.
Qed.
End Run.
