(** The mapper of Mapper.v validates rightly: it confirms the true hypothesis, or none is true
    (claims 3, 4, 6 and 7).

    W is the world, M the map, phi their correspondence; v is the robot; e is the dart being
    explored, a the dart of the world behind it, H the hypotheses. The policies, the motion and the
    rule fulfil the contracts of Mapper.v, and nothing else is known of them.

    [facing v b c]: the robot v, whose reference dart in W is b, faces dart c. What the robot does
    moves it from one such dart to another; each lemma says to which, and at what cost. t is the trail,
    u the trail as it was at vu, o as it was when the rule learned last. *)
From Coq Require Import Arith Lia List Bool Permutation.
Import ListNotations.
From Topo Require Import World Rotation Embedding Vertices Augment Program Mapper.

(** Filtering makes no list longer. *)
Lemma filter_shorter {A} (f : A -> bool) l : length (filter f l) <= length l.
Proof. induction l as [|x l IH]; simpl; auto. destruct (f x); simpl; lia. Qed.

(** Filtering an element out makes a list shorter. *)
Lemma filter_out_less {A} (f : A -> bool) l x : In x l -> f x = false -> length (filter f l) < length l.
Proof.
  intros I F. induction l as [|y l IH]; simpl in *; [tauto|].
  assert (B := filter_shorter f l). destruct I as [->|I]; [rewrite F; lia|].
  apply IH in I. destruct (f y); simpl; lia.
Qed.

Section Percepts.
Variable M : Map.

(** The percepts of a walk by u ++ v are those by u, then those by v. *)
Lemma percepts_app u v : forall a b, walk M a u = Some b -> percepts M a (u ++ v) =
  match percepts M a u, percepts M b v with Some ps, Some qs => Some (ps ++ qs) | _, _ => None end.
Proof.
  induction u as [|k u IH]; simpl; intros a b Hw.
  - injection Hw as <-. destruct (percepts M a v); auto.
  - destruct (move M a k) as [c|]; [|discriminate]. rewrite (IH c b Hw).
    destruct (percepts M c u); simpl; auto. destruct (percepts M b v); auto.
Qed.

(** Percepts are sensed exactly along walks, one for each door. *)
Lemma percepts_walk w : forall a, match percepts M a w, walk M a w with
  | Some ps, Some _ => length ps = length w | None, None => True | _, _ => False end.
Proof.
  induction w as [|k w IH]; simpl; intros a; auto. destruct (move M a k) as [b|]; auto.
  specialize (IH b). destruct (percepts M b w), (walk M b w); simpl; auto.
Qed.

(** The first percepts are those of the first doors. *)
Lemma percepts_firstn s : forall a w ps, percepts M a w = Some ps ->
  percepts M a (firstn s w) = Some (firstn s ps).
Proof.
  induction s as [|s IH]; simpl; auto. intros a [|k w] ps E; simpl in *; [injection E as <-; auto|].
  destruct (move M a k) as [b|]; [|discriminate]. destruct (percepts M b w) as [qs|] eqn:Q;
    [|discriminate]. injection E as <-. simpl. rewrite (IH b w qs Q). auto.
Qed.

(** The first doors of a walk are a walk. *)
Lemma walk_firstn s w a b : walk M a w = Some b ->
  exists c, walk M a (firstn s w) = Some c /\ walk M c (skipn s w) = Some b.
Proof.
  rewrite <- (firstn_skipn s w) at 1. rewrite walk_app.
  destruct (walk M a (firstn s w)) as [c|]; [eauto|discriminate].
Qed.
End Percepts.

(** If two walks by the same doors show the same percepts, so do their ends. *)
Lemma same_end M W u : forall h a ps x c, percept M h = percept W a -> percepts M h u = Some ps ->
  percepts W a u = Some ps -> walk M h u = Some x -> walk W a u = Some c -> percept M x = percept W c.
Proof.
  induction u as [|k u IH]; simpl; intros h a ps x c E P Q X C.
  - injection X as <-. injection C as <-. auto.
  - destruct (move M h k) as [y|]; [|discriminate]. destruct (move W a k) as [b|]; [|discriminate].
    destruct (percepts M y u) as [qs|] eqn:P'; [|discriminate].
    destruct (percepts W b u) as [rs|] eqn:Q'; [|discriminate]. simpl in P, Q.
    apply (IH y b qs); auto; [congruence|]. rewrite Q'. congruence.
Qed.

(** A program that keeps the trail does the same; if the trail led to where the robot was, it leads to
    where the robot is now. *)
Lemma does_with_trail {A} W a (p : program A) t Q : does W a p Q -> led W t a ->
  does W a (with_trail p t) (fun r b n => Q (fst r) b n /\ later t (snd r) /\ led W (snd r) b).
Proof.
  intros (x & b & ms & P & H) [L1 L2]. exists (x, rev ms ++ t), b, ms.
  rewrite perform_with_trail, P. apply perform_moves in P as [P1 P2].
  split; auto. split; auto. split; [exists (rev ms); auto|]. unfold led. simpl.
  rewrite rev_app_distr, rev_involutive, !map_app, walk_app, L1. split; auto.
  rewrite (percepts_app W _ _ _ _ L1), L2, P2. auto.
Qed.

(** Later is transitive. *)
Lemma later_trans t u r : later t u -> later u r -> later t r.
Proof. intros [l ->] [k ->]. exists (k ++ l). apply app_assoc. Qed.

(** Every trail is as late as itself. *)
Lemma later_refl t : later t t.
Proof. exists []. auto. Qed.

(** The robot v senses what there is at dart b of the world, and has turned to face dart c. *)
Definition facing W (v : robot) b c :=
  b < darts W /\ fst v = percept W b /\ snd v < degree W b /\ turn W (snd v) b = c.

Section Moves.
Variable W : Map.
Hypothesis HW : world W.
Let WW : is_map W := world_is_map W HW.

(** [go_on] makes the move of the world from the dart that the robot faces. *)
Lemma go_on_spec v b c k : facing W v b c -> k < degree W c ->
  does W b (go_on v k) (fun v' s n => move W c k = Some s /\ facing W v' s s /\ n = 1).
Proof.
  destruct v as [q t]. intros (Lb & Hq & Ht & <-) Hk. unfold go_on. simpl in *. subst q. simpl.
  rewrite degree_turn in Hk by auto.
  assert (Lm : (t + k) mod degree W b < degree W b) by (apply Nat.mod_upper_bound; lia).
  assert (L : turn W k (turn W t b) < darts W) by auto using turn_lt.
  destruct (alpha W (turn W k (turn W t b))) as [s|] eqn:Es; [|destruct (world_total W HW _ L Es)].
  assert (Ls : s < darts W) by (eapply alpha_ok; eauto).
  apply does_leave with s.
  - unfold move. rewrite (proj2 (Nat.ltb_lt _ _) Lm), turn_mod, Nat.add_comm, turn_add by auto. auto.
  - apply does_return. unfold move. rewrite degree_turn by auto.
    rewrite (proj2 (Nat.ltb_lt _ _) Hk). repeat split; auto. simpl. apply degree_spec; auto.
Qed.

(** [go_back] undoes a move: afterwards the robot faces the dart from which it left. *)
Lemma go_back_spec v b c k y : facing W v b c -> y < darts W -> move W y k = Some c ->
  does W b (go_back v k) (fun v' b' n => facing W v' b' y /\ n = 1).
Proof.
  destruct v as [q t]. intros (Lb & Hq & Ht & <-) Ly Hm. unfold go_back. simpl in *. subst q.
  unfold move in Hm. destruct (Nat.ltb_spec k (degree W y)) as [Hk|]; [|discriminate].
  apply (alpha_ok W WW) in Hm; auto using turn_lt. destruct Hm as (_ & _ & Hm).
  apply does_leave with (turn W k y).
  - unfold move. rewrite (proj2 (Nat.ltb_lt _ _) Ht). auto.
  - apply does_return. split; auto. unfold facing. simpl. rewrite degree_turn by auto.
    repeat split; auto using turn_lt.
    + apply Nat.mod_upper_bound. lia.
    + rewrite <- (degree_turn W WW k y) at 2 by auto.
      rewrite turn_mod, <- turn_add by auto using turn_lt.
      replace (degree W y - k + k) with (degree W y) by lia. apply degree_spec; auto.
Qed.

(** [execute] makes the walk of the world, and the robot faces the dart by which it came in. *)
Lemma execute_spec w k : forall v b c y, facing W v b c -> walk W c (w ++ [k]) = Some y ->
  does W b (execute v (w ++ [k])) (fun v' d n => d = y /\ facing W v' y y /\ n = S (length w)).
Proof.
  induction w as [|j w IH]; simpl; intros v b c y Hv Hw.
  - destruct (move W c k) as [x|] eqn:Em; [|discriminate]. injection Hw as <-.
    apply (does_bind _ _ (go_on v k) Return _ _ (go_on_spec v b c k Hv (move_door _ _ _ _ Em))).
    intros v' s n (Es & Hv' & ->). apply does_return. replace x with s by congruence. auto.
  - destruct (move W c j) as [x|] eqn:Em; [|discriminate].
    eapply does_bind; [apply (go_on_spec v b c j Hv); eapply move_door; eauto|].
    intros v' s n (Es & Hv' & ->). replace x with s in * by congruence.
    eapply does_weaken; [apply (IH v' s s y); auto|]. simpl. intros u d m (-> & A & ->). auto.
Qed.

(** [undo] goes back to the dart from which the doors led to where the robot is. *)
Lemma undo_spec ks : forall v b c y, facing W v b c -> y < darts W -> walk W y (rev ks) = Some c ->
  does W b (undo v ks) (fun v' b' n => facing W v' b' y /\ n = length ks).
Proof.
  induction ks as [|k ks IH]; simpl; intros v b c y Hv Hy Hw.
  - apply does_return. injection Hw as <-. auto.
  - rewrite walk_app in Hw. destruct (walk W y (rev ks)) as [x|] eqn:Hx; [|discriminate].
    simpl in Hw. destruct (move W x k) as [z|] eqn:Em; [|discriminate]. injection Hw as ->.
    assert (Lx : x < darts W) by (eapply walk_lt; eauto).
    eapply does_bind; [apply (go_back_spec v b c k x); auto|].
    intros v' b' n (Hv' & ->). eapply does_weaken; [apply (IH v' b' x y); auto|].
    simpl. intros u d m [A ->]. auto.
Qed.

(** Validation by motion returns the percepts of the world along w, as far as it went, and costs as
    many moves. If all agree with the map, the robot is at the end of w; else the hypothesis is false
    for every correspondence. *)
Lemma follow_spec M (WM : is_map M) w : forall x v b c r, facing W v b c -> x < darts M ->
  percept M x = percept W c -> walk M x w = Some r ->
  does W b (follow M x w v) (fun res b' n => let '(matched, qs, v') := res in
    n = length qs /\ length qs <= length w /\
    percepts W c (firstn (length qs) w) = Some qs /\
    (exists d, walk W c (firstn (length qs) w) = Some d /\ facing W v' b' d /\
     (matched = true -> length qs = length w /\ percept M r = percept W d)) /\
    (matched = false -> forall phi, embedded M W phi -> phi x <> c)).
Proof.
  induction w as [|k w IH]; simpl; intros x v b c r Hv Hx Hp Hw.
  - apply does_return. injection Hw as <-. simpl. repeat split; auto; [|discriminate].
    exists c. auto.
  - destruct (move M x k) as [y|] eqn:Ey; [|discriminate].
    assert (Hk : k < degree W c) by (injection Hp as <- _; eapply move_door; eauto).
    assert (Hy : y < darts M) by (eapply move_lt; eauto).
    eapply does_bind; [apply (go_on_spec v b c k Hv Hk)|].
    intros u s n (Em & Hu & ->). assert (Eu : fst u = percept W s) by apply Hu.
    rewrite Eu. destruct (percept_eqb_spec (percept M y) (percept W s)) as [Eq|Ne].
    + eapply does_bind; [apply (IH y u s s r); auto|]. intros ((m, qs), u') b' n H.
      simpl in H. destruct H as (-> & Lq & Hq & (d & Hd & Hu' & Ht) & Hf).
      apply does_return. simpl. rewrite Em, Hq. split; [lia|]. split; [lia|]. split; auto. split.
      * exists d. split; auto. split; auto. intros T. destruct (Ht T). auto.
      * intros T phi E Ex. apply (Hf T phi E). apply (embedded_move M W phi) in Ey; auto. congruence.
    + apply does_return. simpl. rewrite Em. split; auto. split; [lia|]. split; auto. split.
      * exists s. split; auto. split; auto. discriminate.
      * intros _ phi E Ex. apply Ne. apply (embedded_move M W phi) in Ey; auto.
        rewrite <- (percept_agree M W phi) by auto. congruence.
Qed.
End Moves.

Section Validation.
Variables (motion : Motion) (rule : Rule)
          (true_of : Map -> Map -> (nat -> nat) -> robot_trail -> memory rule -> Prop).
Hypotheses (Gmotion : good_motion motion) (Grule : good_rule rule true_of).
Variables (M W : Map) (phi : nat -> nat) (T : memory rule) (o : robot_trail) (e a : nat).
Hypotheses (WM : is_map M) (HW : world W) (E : embedded M W phi) (HT : true_of M W phi o T)
           (He : e < darts M) (Oe : alpha M e = None) (Ha : alpha W (phi e) = Some a).
Let WW : is_map W := world_is_map W HW.

(** What the sequences show, the world shows behind e. *)
Definition log_true (log : list sequence) := forall s, In s log -> percepts W a (fst s) = Some (snd s).

(** The hypothesis is a dart of the map, and its doors, at most L, lead from there to the marker. *)
Definition leads_home L (c : hypothesis) := fst c < darts M /\ length (snd c) <= L /\
  exists r k, walk M (fst c) (snd c) = Some r /\ k < degree M r /\ turn M k r = root M.

(** A hypothesis that the rule does not keep is false. *)
Lemma dropped_false log t b L h w : log_true log -> later o t -> led W t b -> leads_home L (h, w) ->
  keep rule M e (percept W a) T log t (h, w) = false -> phi h <> a.
Proof.
  intros Hlog Ot Lt (Lh & _ & r & _ & Hw & _) K Eh. simpl in *.
  rewrite <- Eh, (percept_agree M W phi) in K by auto.
  rewrite (keep_true rule true_of Grule M W phi T e log o t b h w r) in K; auto;
    [discriminate|congruence|].
  rewrite Eh. auto.
Qed.

(** After a conclusion that is true the robot faces the dart of the map that is returned. *)
Lemma concluded_spec h log ds v t b c : h < darts M -> phi h = a -> facing W v b c ->
  walk W a ds = Some c -> led W t b ->
  does W b (concluded M h log ds v t) (fun r b' cost => let '(out, log', (v', t')) := r in
    log' = log /\ later t t' /\ led W t' b' /\ cost <= length ds /\
    exists x, out = Some (h, x) /\ x < darts M /\ facing W v' b' (phi x)).
Proof.
  intros Lh Eh Hv Hw Lt. destruct v as ((d, m), k). unfold concluded. simpl fst. simpl snd.
  assert (Hv' := Hv). destruct Hv' as (Lb & Hq & Hk & Ek). simpl in Hq, Hk, Ek. injection Hq as -> Em.
  assert (La : a < darts W) by (rewrite <- Eh; apply (phi_lt _ _ _ E); auto).
  destruct m as [j|].
  - apply does_return. split; auto. split; [apply later_refl|]. split; auto. split; [lia|].
    eexists. split; [reflexivity|]. assert (R := root_lt M WM). split; [apply turn_lt; auto|].
    replace (phi _) with c; auto. rewrite (embedded_turn M W phi), (phi_root _ _ _ E) by auto.
    assert (Lj : j < degree W b) by (symmetry in Em; apply find_seq in Em; lia).
    symmetry in Em. apply marker_some in Em. rewrite <- Em, <- turn_add, <- Ek.
    replace (k + (degree W b - j) + j) with (k + degree W b) by lia.
    rewrite turn_add. f_equal. symmetry. apply degree_spec; auto.
  - eapply does_bind; [apply does_with_trail; auto; apply (undo_spec W HW (rev ds) _ b c a Hv La)|].
    { rewrite rev_involutive. auto. }
    intros (v, t') b' n ((Hv' & ->) & Ht & Lt'). apply does_return. rewrite rev_length.
    split; auto. split; auto. split; auto. split; [lia|]. exists h. rewrite Eh. auto.
Qed.

(** The hypothesis of which a shared door showed something else than the map is false. *)
Lemma compared_false h w s qs ds ps : h < darts M -> percepts W a ds = Some qs ->
  firstn s w = firstn s ds -> percepts M h w = Some ps ->
  percept_eqb (percept M h) (percept W a) && percepts_eqb (firstn s ps) (firstn s qs) = false ->
  phi h <> a.
Proof.
  intros Lh Hq Ew Hp B Eh. rewrite <- Eh in Hq, B. rewrite (percept_agree M W phi) in B by auto.
  apply (percepts_firstn M s) in Hp. apply (percepts_firstn W s) in Hq.
  apply (forward M W phi WM WW E) in Hp; auto. rewrite Ew, Hq in Hp. injection Hp as Hp.
  rewrite Hp in B.
  destruct (percept_eqb_spec (percept M h) (percept M h)); [|tauto].
  destruct (percepts_eqb_spec (firstn s ps) (firstn s ps)); [discriminate|tauto].
Qed.

(** The end of the doors shared is where the map says, if all that they showed agrees. *)
Lemma shared_end h w s qs ds ps x c : percepts W a ds = Some qs -> firstn s w = firstn s ds ->
  percepts M h w = Some ps -> walk M h (firstn s w) = Some x -> walk W a (firstn s ds) = Some c ->
  percept_eqb (percept M h) (percept W a) && percepts_eqb (firstn s ps) (firstn s qs) = true ->
  percept M x = percept W c.
Proof.
  intros Hq Ew Hp Hx Hc B. apply andb_true_iff in B as [B1 B2].
  destruct (percept_eqb_spec (percept M h) (percept W a)) as [Eh|]; [|discriminate].
  destruct (percepts_eqb_spec (firstn s ps) (firstn s qs)) as [Es|]; [|discriminate].
  apply (percepts_firstn M s) in Hp. apply (percepts_firstn W s) in Hq.
  rewrite <- Ew in Hc, Hq. apply (same_end M W _ h a _ x c Eh Hp); auto. congruence.
Qed.

(** Testing returns the true hypothesis, and the robot is where the map says; or it returns None,
    the robot is back, and no hypothesis is true. Each of n tests costs at most 2 L, if no way home
    has more than L doors. *)
Lemma test_all_spec L n : forall log ds qs v t b c H, facing W v b c ->
  walk W a ds = Some c -> percepts W a ds = Some qs -> log_true log -> later o t -> led W t b ->
  length H <= n -> (forall g, In g H -> leads_home L g) ->
  does W b (test_all motion rule n M e (percept W a) T log ds qs v t H) (fun r b' cost =>
    let '(out, log', (v', t')) := r in log_true log' /\ later t t' /\ led W t' b' /\
    cost <= n * (2 * L) + length ds /\
    match out with
    | Some (h, x) => phi h = a /\ (exists w, In (h, w) H) /\ x < darts M /\ facing W v' b' (phi x)
    | None => facing W v' b' a /\ forall g, In g H -> phi (fst g) <> a
    end).
Proof.
  assert (La : a < darts W) by (eapply alpha_ok; eauto; apply (phi_lt _ _ _ E); auto).
  induction n as [|n IH]; intros log ds qs v t b c H Hv Hw Hq Hlog Ot Lt Hn HH; cbn [test_all].
  all: assert (None_spec : forall (none : forall g, In g H -> phi (fst g) <> a) m,
    does W b (bind (with_trail (undo v (rev ds)) t) (fun vt => Return (@None (nat * nat), log, vt)))
      (fun r b' cost =>
    let '(out, log', (v', t')) := r in log_true log' /\ later t t' /\ led W t' b' /\
    cost <= m + length ds /\
    match out with
    | Some (h, x) => phi h = a /\ (exists w, In (h, w) H) /\ x < darts M /\ facing W v' b' (phi x)
    | None => facing W v' b' a /\ forall g, In g H -> phi (fst g) <> a
    end)) by (intros none m; eapply does_bind;
      [apply does_with_trail; auto;
       apply (undo_spec W HW (rev ds) v b c a Hv La); rewrite rev_involutive; auto|];
      intros (v', t') b' k ((Hv' & ->) & Ht & Lt'); apply does_return; rewrite rev_length;
      repeat split; auto; try apply Lt'; [lia|apply Hv'..]).
  { apply None_spec. destruct H; [intros ? []|simpl in Hn; lia]. }
  set (K := filter (keep rule M e (percept W a) T log t) H).
  assert (Dropped : forall g, In g H -> ~ In g K -> phi (fst g) <> a).
  { intros (h, w) I N. apply (dropped_false log t b L h w Hlog Ot Lt (HH _ I)).
    destruct (keep rule M e (percept W a) T log t (h, w)) eqn:B; auto. destruct N.
    apply filter_In. auto. }
  destruct (find (concludes rule M e (percept W a) T log t) K) as [(h, w)|] eqn:F.
  { apply find_some in F as [Ik F]. apply filter_In in Ik as [Ih _].
    assert (Lh := proj1 (HH _ Ih)). simpl in Lh.
    apply (conclude_true rule true_of Grule M W phi T e log o t a b h w) in F; auto.
    eapply does_weaken; [apply (concluded_spec h log ds v t b c); auto|].
    intros ((out, log'), (v', t')) b' cost (-> & At & Ld & C & x & -> & Lx & Fx).
    split; auto. split; auto. split; auto. split; [lia|]. split; auto. eauto. }
  assert (G := Gmotion ds K). destruct (motion ds K) as [((h, w), s)|].
  2: { apply None_spec. intros g I. apply Dropped; auto. rewrite G. intros []. }
  destruct G as (Ih & Lsd & Lsw & Ew). simpl fst in *; simpl snd in *.
  assert (IH' : In (h, w) H) by (apply filter_In in Ih; tauto).
  destruct (HH _ IH') as (Lh & Lw & r & k & Hr & Hk & Er). simpl in Lh, Lw, Hr.
  set (K' := filter (fun c => negb (fst c =? h)) K).
  assert (NK : length K' <= n).
  { assert (LK : length K <= length H) by apply filter_shorter.
    assert (length K' < length K); [|lia]. apply filter_out_less with (h, w); auto.
    simpl. rewrite Nat.eqb_refl. auto. }
  assert (HK : forall g, In g K' -> In g H)
    by (intros g I; apply filter_In in I as [I _]; apply filter_In in I; tauto).
  assert (Lost : phi h <> a -> (forall g, In g K' -> phi (fst g) <> a) ->
    forall g, In g H -> phi (fst g) <> a).
  { intros N F' g I. destruct (in_dec (fun x y : hypothesis => ltac:(repeat decide equality)) g K)
      as [IK|NI]; [|apply Dropped; auto].
    destruct (Nat.eq_dec (fst g) h) as [->|Ng]; auto. apply F', filter_In. split; auto.
    apply negb_true_iff, Nat.eqb_neq. auto. }
  destruct (walk_firstn W s ds a c Hw) as (d & Hd & Hd').
  destruct (walk_firstn M s w h r Hr) as (x & Hx & Hxr).
  assert (Ld : d < darts W) by (eapply walk_lt; eauto).
  assert (Lx : x < darts M) by (eapply walk_lt; eauto).
  eapply does_bind; [apply does_with_trail; auto; apply (undo_spec W HW (rev (skipn s ds)) v b c d);
    auto; rewrite rev_involutive; auto|].
  intros (v1, t1) b1 m1 ((Hv1 & ->) & Ht1 & Lt1). simpl fst in *; simpl snd in *.
  rewrite rev_length, skipn_length. assert (Ot1 := later_trans _ _ _ Ot Ht1).
  assert (P := percepts_walk M w h). rewrite Hr in P.
  destruct (percepts M h w) as [ps|] eqn:Hps; [|destruct P]. rewrite Hx, Hr.
  destruct (_ && _) eqn:B.
  - assert (Ep := shared_end h w s qs ds ps x d Hq Ew Hps Hx Hd B).
    eapply does_bind; [apply does_with_trail; auto;
      apply (follow_spec W HW M WM (skipn s w) x v1 b1 d r); auto|].
    intros (((matched, more), v2), t2) b2 m2 ((-> & Lm & Hm & (y & Hy & Hv2 & Ht) & Hf) & Ht2 & Lt2).
    simpl fst in *; simpl snd in *. rewrite skipn_length in Lm.
    assert (Ot2 := later_trans _ _ _ Ot1 Ht2). assert (T2 := later_trans _ _ _ Ht1 Ht2).
    assert (Hwalk : walk W a (firstn s ds ++ firstn (length more) (skipn s w)) = Some y)
      by (rewrite walk_app, Hd; auto).
    assert (Hperc : percepts W a (firstn s ds ++ firstn (length more) (skipn s w)) =
                    Some (firstn s qs ++ more)).
    { rewrite (percepts_app W _ _ a d Hd), Hm, (percepts_firstn W s a ds qs Hq). auto. }
    destruct matched.
    + destruct (Ht eq_refl) as [Lq Epr]. rewrite Lq, firstn_all, <- Ew, firstn_skipn in Hwalk.
      destruct (marker_of M r k Hk Er) as [j Hj].
      assert (Eh : a = phi h).
      { apply (confirm M W phi WM WW E a h w y r j); auto. injection Epr as _ Epr. congruence. }
      apply does_return. split; auto. split; auto. split; auto.
      split; [rewrite skipn_length in Lq; lia|]. split; auto.
      split; [eauto|]. split; [eapply walk_lt; eauto|].
      apply (forward_walk M W phi) in Hr; auto. rewrite <- Eh, Hwalk in Hr.
      injection Hr as <-. auto.
    + assert (N : phi h <> a).
      { intros Eh. apply (Hf eq_refl phi E). apply (forward_walk M W phi) in Hx; auto.
        rewrite Eh, Ew, Hd in Hx. congruence. }
      eapply does_weaken; [apply (IH _ _ _ v2 t2 b2 y K' Hv2 Hwalk Hperc); auto|].
      { intros q [<-|I]; auto. }
      intros ((out, log'), (v', t')) b' cost (Hl & Hla & Hle & Hc & Ho). split; auto.
      split; [eapply later_trans; eauto|]. split; auto. split.
      * rewrite app_length, !firstn_length, skipn_length in Hc. lia.
      * destruct out as [(h', x')|]; [|destruct Ho; auto].
        destruct Ho as (A & (w' & I) & C). split; auto. split; eauto.
  - assert (N := compared_false h w s qs ds ps Lh Hq Ew Hps B).
    eapply does_weaken; [apply (IH log (firstn s ds) (firstn s qs) v1 t1 b1 d K' Hv1 Hd); auto|].
    { apply percepts_firstn; auto. }
    intros ((out, log'), (v', t')) b' cost (Hl & Hla & Hle & Hc & Ho). split; auto.
    split; [eapply later_trans; eauto|]. split; auto. split.
    + rewrite firstn_length in Hc. lia.
    + destruct out as [(h', x')|]; [|destruct Ho; auto].
      destruct Ho as (A & (w' & I) & C). split; auto. split; eauto.
Qed.
End Validation.
