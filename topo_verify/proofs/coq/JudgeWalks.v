(** The judge remembers walks behind edges: the doors since the last pose, the sequences, and what they
    show behind unexplored darts; and so it is right about cited percepts that disagree (claim 8;
    docs/semantics.md, section 9).

    z is the memo before a step, s its stage; M the map S; the other letters are those of Claims.v,
    Judge.v and JudgeCitations.v. *)
From Coq Require Import Arith Lia List NArith Bool.
Import ListNotations.
From Topo Require Import World Rotation Embedding Log AnyWorld Augment Vertices Events LogFold Claims
  Judge JudgeCitations JudgeRun JudgeMemory JudgeDecisions.

(** [cites] decides whether a percept is cited. *)
Lemma cites_spec o p : cites o p = true <-> o = Some p.
Proof.
  destruct o as [q|]; simpl; [|split; discriminate].
  destruct (percept_eqb_spec q p) as [->|N]; split; auto; try discriminate. congruence.
Qed.

(** [may_cite] decides whether no other one is. *)
Lemma may_cite_spec o p : may_cite o p = true <-> o = None \/ o = Some p.
Proof.
  destruct o as [q|]; simpl; [|tauto].
  destruct (percept_eqb_spec q p) as [->|N]; split; auto; try discriminate. intros [|]; congruence.
Qed.

(** [is_none] decides whether nothing is. *)
Lemma is_none_spec {X} (o : option X) : is_none o = true <-> o = None.
Proof. destruct o; simpl; split; auto; discriminate. Qed.

(** [doors_begin] decides whether doors begin a list. *)
Lemma doors_begin_spec v : forall l, doors_begin v l = true <-> exists u, l = v ++ u.
Proof.
  induction v as [|k v IH]; intros [|j l]; simpl.
  - split; auto. exists []. auto.
  - split; auto. exists (j :: l). auto.
  - split; [discriminate|]. intros (u & E). discriminate.
  - rewrite andb_true_iff, Nat.eqb_eq, IH. split.
    + intros [-> (u & ->)]. exists u. auto.
    + intros (u & E). injection E as -> ->. eauto.
Qed.

(** Doors that begin each other are equal. *)
Lemma doors_equal v w : doors_begin v w && doors_begin w v = true <-> v = w.
Proof.
  rewrite andb_true_iff, !doors_begin_spec. split.
  - intros [(a & ->) (b & E)]. rewrite <- app_assoc in E. rewrite <- (app_nil_r v) in E at 1.
    apply app_inv_head in E. symmetry in E. apply app_eq_nil in E as [-> _]. symmetry. apply app_nil_r.
  - intros ->. split; exists []; symmetry; apply app_nil_r.
Qed.

(** Tracing stays on the map. *)
Lemma traced_lt M w : is_map M -> forall h d rest, h < darts M -> traced M h w = (d, rest) ->
  d < darts M.
Proof.
  intros WM. induction w as [|k w IH]; simpl; intros h d rest Lh E.
  - injection E as <- <-. auto.
  - assert (Lt := turn_lt M WM k h Lh). destruct (alpha M (turn M k h)) as [x|] eqn:Ex.
    + apply IH in E; auto. apply (alpha_ok M WM _ _ Lt Ex).
    + injection E as <- <-. auto.
Qed.

Section Rejections.
Variable W : Map.
Hypotheses (HW : 0 < darts W -> world W) (HR : darts W = 0 -> root W = 0).
Variable t : trace.
Notation said := (cited t).
Notation at_stage past := (fold_left (next_stage W) past (first_stage W)).

(** The stage and the memo after these steps. *)
Definition judge_at past := fold_left (fun x d => (next_stage W (fst x) d,
  next_memo W said (fst x) (snd x) d)) past (first_stage W, first_memo t).
Notation memo_at past := (snd (judge_at past)).

(** The stage is the one that the judge of the other claims has. *)
Lemma judge_at_stage past : fst (judge_at past) = at_stage past.
Proof.
  induction past as [|d past IH] using rev_ind; auto. unfold judge_at in *.
  rewrite !fold_left_app. simpl. rewrite IH. auto.
Qed.

(** The memo one step later. *)
Lemma memo_snoc past d : memo_at (past ++ [d]) = next_memo W said (at_stage past) (memo_at past) d.
Proof.
  assert (E := judge_at_stage past). unfold judge_at in *. rewrite fold_left_app. simpl. rewrite E. auto.
Qed.

(** The memo knows the number of the next step. *)
Lemma next_step_spec past : next_step (walk_behind (memo_at past)) = length past.
Proof.
  induction past as [|d past IH] using rev_ind; auto. rewrite memo_snoc, app_length, Nat.add_1_r, <- IH.
  destruct d as [e H|ev]; simpl; auto. destruct (alpha W _); auto.
Qed.

(** The memo has the last pose, and the walk since then. *)
Lemma memo_since before e H after : (forall d, In d after -> is_pose d = false) ->
  let z := memo_at (before ++ Pose e H :: after) in posed_hypotheses z = H /\
  walk_behind z = fold_left (led_on W said) after
    match alpha W (at_image (images (at_stage before)) e) with
    | Some b => setting_out (S (length before)) (position (at_stage before)) b
    | None => setting_out (S (length before)) None 0 end.
Proof.
  induction after as [|d after IH] using rev_ind; intros N; cbv zeta.
  - rewrite memo_snoc. simpl. rewrite next_step_spec. split; reflexivity.
  - destruct IH as [A B]; [intros x I; apply N, in_or_app; auto|].
    rewrite app_comm_cons, app_assoc, memo_snoc.
    assert (X := N d ltac:(apply in_or_app; simpl; auto)). destruct d as [e' H'|ev]; [discriminate|].
    cbn [next_memo posed_hypotheses walk_behind]. rewrite A, B, fold_left_app. split; reflexivity.
Qed.

(** What comes before sane steps is sane. *)
Lemma sane_before a b : sane W (a ++ b) -> sane W a.
Proof.
  induction b as [|d b IH] using rev_ind; [rewrite app_nil_r; auto|].
  rewrite app_assoc, (sane_snoc W). intros [Sp _]. auto.
Qed.

(** S does not grow while no augmentation is declared. *)
Lemma S_quiet past after : (forall d, In d after -> grows_b d = false) ->
  S_after W (past ++ after) = S_after W past.
Proof.
  induction after as [|d after IH] using rev_ind; intros N; [rewrite app_nil_r; auto|].
  rewrite app_assoc, S_snoc, IH by (intros x I; apply N, in_or_app; auto).
  assert (X := N d ltac:(apply in_or_app; simpl; auto)).
  destruct d as [e H|[k p|e h|e h|e h m|e a m]]; auto; discriminate.
Qed.

(** The stage knows where an edge ends. *)
Lemma ends_at_spec past s e b : follows W past s ->
  (ends_at W past e b <-> is_open (chart s) e = true /\ alpha W (at_image (images s) e) = Some b).
Proof.
  intros F. rewrite is_open_spec. unfold ends_at. rewrite <- (fo_chart W _ _ F). split.
  - intros (phi & E & O & Eb). split; auto.
    rewrite <- (follows_unique W HW HR past s phi F E) by apply O. auto.
  - intros [O Eb]. exists (at_image (images s)). split; [apply F|auto].
Qed.

(** The stage and the memo know the last pose. *)
Lemma posed_with_spec past e b H o : sane W past -> ends_at W past e b ->
  (posed_with W said past e H b o <-> asked (at_stage past) = Some e /\
    H = posed_hypotheses (memo_at past) /\ o = walk_behind (memo_at past)).
Proof.
  intros Sp En.
  assert (Since : forall before H after, past = before ++ Pose e H :: after ->
    (forall d, In d after -> match d with Pose _ _ => False | Act ev => ~ grows ev end) ->
    H = posed_hypotheses (memo_at past) /\ fold_left (led_on W said) after
      (setting_out (S (length before)) (walk W (root W) (doors_of before)) b) =
      walk_behind (memo_at past)).
  { intros before H' after -> N. destruct (memo_since before e H' after) as [A B].
    { intros d I. apply N in I. destruct d; tauto. }
    split; [auto|]. rewrite B. f_equal.
    assert (Sb : sane W before) by (apply sane_before in Sp; auto).
    assert (F := proj2 (run_spec W HW HR before) Sb).
    assert (E : ends_at W before e b).
    { unfold ends_at, drawn_by in *. rewrite <- (S_quiet before (Pose e H' :: after)); auto.
      intros d [<-|I]; auto. apply N in I. destruct d as [?|[]]; simpl in *; tauto. }
    apply (ends_at_spec before _ e b F) in E as [_ ->]. rewrite <- (position_spec W). auto. }
  rewrite (asked_spec W HW HR past e Sp). split.
  - intros (before & after & E & N & ->). destruct (Since before H after E N) as [A B].
    split; [exists before, H, after; auto|]. auto.
  - intros ((before & H' & after & E & N) & -> & ->). destruct (Since before H' after E N) as [<- <-].
    exists before, after. auto.
Qed.

(** What was seen, one step later. *)
Lemma was_seen_snoc past x d v : was_seen W said (past ++ [x]) d v <-> was_seen W said past d v \/
  exists ev e a H b o s k u, x = Act ev /\
  match ev with Loop e' a' _ | New e' a' _ => e' = e /\ a' = a | _ => False end /\
  ends_at W past e b /\ posed_with W said past e H b o /\ In s (sequences o) /\
  traced (S_after W (past ++ [x])) a s = (d, k :: v ++ u).
Proof.
  split.
  - intros (earlier & ev & rest & e & a & H & b & o & s & k & u & E & X).
    apply split_snoc in E as [(<- & -> & _)|(rest' & -> & ->)]; [right|left].
    + exists ev, e, a, H, b, o, s, k, u. auto.
    + exists earlier, ev, rest', e, a, H, b, o, s, k, u. auto.
  - intros [(earlier & ev & rest & e & a & H & b & o & s & k & u & -> & X)|
      (ev & e & a & H & b & o & s & k & u & -> & X)].
    + exists earlier, ev, (rest ++ [x]), e, a, H, b, o, s, k, u. rewrite <- app_assoc. auto.
    + exists past, ev, [], e, a, H, b, o, s, k, u. auto.
Qed.

(** The memo knows what was seen behind unexplored darts. *)
Lemma seen_behind_spec past d v : sane W past ->
  (existsb (fun r => (fst r =? d) && doors_begin v (snd r)) (seen_behind (memo_at past)) = true <->
  was_seen W said past d v).
Proof.
  assert (Ex : forall l : list (nat * list nat),
    existsb (fun r => (fst r =? d) && doors_begin v (snd r)) l = true <->
    exists u, In (d, v ++ u) l).
  { intros l. rewrite existsb_exists. split.
    - intros ((d', v') & I & E). apply andb_true_iff in E as [E1 E2]. apply Nat.eqb_eq in E1.
      apply doors_begin_spec in E2 as (u & E2). simpl in *. subst. eauto.
    - intros (u & I). eexists. split; [exact I|]. simpl. rewrite Nat.eqb_refl. apply doors_begin_spec.
      eauto. }
  induction past as [|x past IH] using rev_ind; intros Sx.
  - simpl. split; [discriminate|]. intros ([|y l] & ev & rest & e & a & H & b & o & s & k & u & E & _);
      discriminate.
  - assert (Sx' := Sx). apply sane_snoc in Sx' as (Sp & _ & G). specialize (IH Sp). rewrite Ex in *.
    assert (F := proj2 (run_spec W HW HR past) Sp). rewrite was_seen_snoc, <- IH, memo_snoc.
    set (s := at_stage past) in *. set (z := memo_at past) in *.
    destruct x as [e H|ev].
    + simpl. split; [auto|].
      intros [?|(ev & e' & a & H' & b & o & s' & k & u & E & _)]; [auto|discriminate].
    + assert (Grown : forall e a, match ev with Loop e' a' _ | New e' a' _ => e' = e /\ a' = a
          | _ => False end -> (exists u, In (d, v ++ u) match asked s with
            | Some e' => if e' =? e then flat_map (shown_behind (drawn (chart s) ev) a)
                (sequences (walk_behind z)) ++ seen_behind z else seen_behind z
            | None => seen_behind z end) <->
          (exists u, In (d, v ++ u) (seen_behind z)) \/ exists ev' e a H b o s' k u, Act ev = Act ev' /\
          match ev' with Loop e' a' _ | New e' a' _ => e' = e /\ a' = a | _ => False end /\
          ends_at W past e b /\ posed_with W said past e H b o /\ In s' (sequences o) /\
          traced (S_after W (past ++ [Act ev])) a s' = (d, k :: v ++ u)).
      { intros e a K. assert (Gr : grows ev) by (destruct ev; simpl; tauto).
        assert (T := G ev eq_refl Gr).
        assert (En : exists b, ends_at W past e b).
        { destruct T as (phi & E & T). destruct ev as [k p|e' h|e' h|e' h n|e' a' n]; try tauto;
            destruct K as [-> ->]; simpl in T.
          - exists (phi a), phi. tauto.
          - destruct T as (O & _ & b & Eb & _). exists b, phi. auto. }
        destruct En as (b & En).
        assert (Dr : S_after W (past ++ [Act ev]) = drawn (chart s) ev)
          by (rewrite S_snoc, (fo_chart W _ _ F); auto).
        assert (Fl : forall u, In (d, v ++ u) (flat_map (shown_behind (drawn (chart s) ev) a)
          (sequences (walk_behind z))) <-> exists s' k, In s' (sequences (walk_behind z)) /\
          traced (drawn (chart s) ev) a s' = (d, k :: v ++ u)).
        { intros u. rewrite in_flat_map. unfold shown_behind. split.
          - intros (s' & Is & I). exists s'. destruct (traced _ a s') as (d', [|k v']); [destruct I|].
            destruct I as [E|[]]. injection E as -> ->. eauto.
          - intros (s' & k & Is & E). exists s'. rewrite E. simpl. auto. }
        rewrite Dr. split.
        - intros (u & I). destruct (asked s) as [e'|] eqn:As; [|eauto].
          destruct (Nat.eqb_spec e' e) as [->|]; [|eauto]. apply in_app_or in I as [I|I]; [|eauto].
          apply Fl in I as (s' & k & Is & E). right.
          exists ev, e, a, (posed_hypotheses z), b, (walk_behind z), s', k, u.
          split; auto. split; auto. split; auto. split; auto.
          apply (posed_with_spec past e b); auto.
        - intros [(u & I)|(ev' & e' & a' & H & b' & o & s' & k & u & E & K' & En' & Po & Is & Tr)].
          + exists u. destruct (asked s) as [e'|]; auto. destruct (e' =? e); auto.
            apply in_or_app. auto.
          + injection E as <-. assert (e' = e /\ a' = a) as [-> ->].
            { destruct ev; try tauto; destruct K as [<- <-], K' as [<- <-]; auto. }
            apply (posed_with_spec past e b') in Po as (As & _ & ->); auto. fold s in As.
            rewrite As, Nat.eqb_refl. exists u. apply in_or_app. left. apply Fl. eauto. }
      assert (Same : match ev with Loop _ _ _ | New _ _ _ => False | _ => True end ->
        (exists u, In (d, v ++ u) (seen_behind z)) <->
          (exists u, In (d, v ++ u) (seen_behind z)) \/ exists ev' e a H b o s' k u, Act ev = Act ev' /\
          match ev' with Loop e' a' _ | New e' a' _ => e' = e /\ a' = a | _ => False end /\
          ends_at W past e b /\ posed_with W said past e H b o /\ In s' (sequences o) /\
          traced (S_after W (past ++ [Act ev])) a s' = (d, k :: v ++ u)).
      { intros N. split; auto.
        intros [?|(ev' & e' & a & H' & b & o & s' & k & u & E & K & _)]; auto. injection E as <-.
        destruct ev; tauto. }
      destruct ev as [k p|e h|e h|e h n|e a n]; simpl seen_behind; try (apply Same; exact I).
      * apply (Grown e h). auto.
      * apply (Grown e a). auto.
Qed.

(** What is expected, of S or of what was seen. *)
Lemma expectation_spec past g phi d rest y : sane W past -> drawn_by W past phi ->
  d < darts (S_after W past) ->
  (expectation W (at_stage past) (memo_at past) g d rest = Some y <-> match rest with
  | [] => record_cited g = None /\ y = percept (S_after W past) d
  | _ :: v => record_cited g = Some (d, v) /\ was_seen W said past d v /\
      exists c z, alpha W (phi d) = Some c /\ walk W c v = Some z /\ y = percept W z end).
Proof.
  intros Sp Dr Ld. assert (F := proj2 (run_spec W HW HR past) Sp). unfold expectation.
  rewrite (fo_chart W _ _ F). rewrite <- (fo_chart W _ _ F) in Ld.
  rewrite (follows_unique W HW HR past _ phi F Dr d Ld).
  destruct rest as [|k v], (record_cited g) as [(d', v')|].
  - split; [discriminate|]. intros [E _]. discriminate.
  - split; [intros E; injection E as <-; auto|]. intros [_ ->]. auto.
  - assert (B : (d' =? d) && doors_begin v v' && doors_begin v' v = true <-> (d', v') = (d, v)).
    { rewrite <- andb_assoc, andb_true_iff, Nat.eqb_eq, doors_equal. split.
      - intros [-> ->]. auto.
      - intros E. injection E as -> ->. auto. }
    assert (Sn := seen_behind_spec past d v Sp).
    destruct ((d' =? d) && doors_begin v v' && doors_begin v' v); simpl.
    + rewrite (proj1 B eq_refl). destruct (existsb _ _).
      * destruct (alpha W _) as [c|].
        -- destruct (walk W c v) as [z|] eqn:Wz; simpl.
           ++ split.
              ** intros E. injection E as <-. split; auto. split; [apply Sn; auto|]. eauto.
              ** intros (_ & _ & c' & z' & Ec & Ez & ->). injection Ec as <-. congruence.
           ++ split; [discriminate|]. intros (_ & _ & c' & z' & Ec & Ez & _). injection Ec as <-.
              congruence.
        -- split; [discriminate|]. intros (_ & _ & c' & z' & Ec & _). discriminate.
      * split; [discriminate|]. intros (_ & X & _). apply Sn in X. discriminate.
    + split; [discriminate|]. intros [E _]. injection E as -> ->.
      assert (X := proj2 B eq_refl). discriminate.
  - split; [discriminate|]. intros [E _]. discriminate.
Qed.

(** [disagreeing] decides whether the cited percepts disagree. *)
Lemma disagreeing_spec past phi h b g : sane W past -> drawn_by W past phi ->
  open_dart (S_after W past) h -> (disagreeing W (at_stage past) (memo_at past) h b g = true <->
  percepts_disagree W said past phi h b (walk_behind (memo_at past)) g).
Proof.
  intros Sp Dr [Lh _]. assert (F := proj2 (run_spec W HW HR past) Sp).
  unfold disagreeing, percepts_disagree. rewrite andb_true_iff, is_none_spec.
  apply and_iff_compat_l. destruct (word_cited _ g) as [w|].
  2: { split; [discriminate|]. intros (w & x & y & E & _). discriminate. }
  destruct (walk W b w) as [x|] eqn:Ex.
  2: { split; [discriminate|]. intros (w' & x & y & E & E' & _). injection E as <-. congruence. }
  rewrite (fo_chart W _ _ F). destruct (traced (S_after W past) h w) as (d, rest) eqn:Tr.
  assert (Ld : d < darts (S_after W past)).
  { rewrite <- (fo_chart W _ _ F) in Lh, Tr |- *.
    apply (traced_lt (chart (at_stage past)) w) with h rest; auto. apply (fo_map W _ _ F). lia. }
  assert (X := fun y => expectation_spec past g phi d rest y Sp Dr Ld).
  assert (At : match traced_at g with Some d' => d' =? d | None => true end = true <->
    traced_at g = None \/ traced_at g = Some d).
  { destruct (traced_at g) as [d'|]; [|tauto]. rewrite Nat.eqb_eq. split; [intros ->; auto|].
    intros [E|E]; congruence. }
  rewrite !andb_true_iff, cites_spec, At. split.
  - intros [[Ob A] E]. destruct (expectation _ _ _ _ _ _) as [y|]; [|discriminate].
    apply andb_true_iff in E as [E N]. apply cites_spec in E.
    exists w, x, y. split; auto. split; auto. split; auto. split; auto. split.
    + intros ->. destruct (percept_eqb_spec (percept W x) (percept W x)); [discriminate|tauto].
    + rewrite Tr. split; auto. apply X. auto.
  - intros (w' & x' & y & E & E' & Ob & Ey & N & H). injection E as <-.
    rewrite Ex in E'. injection E' as <-.
    rewrite Tr in H. destruct H as [A H]. apply X in H. rewrite H. split; auto.
    apply andb_true_iff. split; [apply cites_spec; auto|].
    destruct (percept_eqb_spec y (percept W x)); [tauto|auto].
Qed.
End Rejections.
