(** Steered mappers, 3: walking over darts that were crossed, and the ways home on S.

    The letters are those of SteeredMap.v. Such walks prove nothing new ([travels_nothing_left]). *)
From Coq Require Import Arith Lia List Bool Wf_nat.
Import ListNotations.
From Topo Require Import World Rotation Vertices Augment Ways Log Determined Entailed LogFold
  LogFoldExact Steered SteeredFold SteeredMap.

(** The robot can walk any way of the fold. *)
Lemma near_travels W n : world W -> forall L p, replays W L -> near L n (standing L) p -> valid L p ->
  exists m L', m <= n /\ travels W m L L' /\ near L' 0 (standing L') p.
Proof.
  intros HW. induction n as [n IH] using lt_wf_ind. intros L p R N P.
  assert (Shown := replays_shown W L HW R).
  inversion N as [? ? ? k S|n' ? q ? k X N']; subst.
  - exists 0, L. split; [lia|]. split; [constructor|]. eapply near_here; eauto.
  - destruct (replays_visits W L (world_is_map W HW) R) as [v V].
    destruct (turned_mod L Shown k (standing L) (standing_valid L)) as (j & Sj & Lt).
    specialize (Lt W v HW V). change (dart W v (standing L)) with (v (length (moves L))) in Lt.
    destruct (leaves_exists W L v j HW R V Lt) as (L1 & T1).
    assert (R1 := leaves_replays _ _ _ _ T1). assert (Shown1 := replays_shown W L1 HW R1).
    assert (Lat := leaves_longer _ _ _ _ T1). destruct (edge_valid _ _ _ X) as [V1 Vq].
    assert (Xj : on_edge L (turned j (standing L)) q).
    { destruct X as (a & b & K & Sa & Sb). exists a, b. split; auto. split; auto.
      apply same_trans with (turned k (standing L)); auto. apply same_sym. auto. }
    assert (X1 := edge_longer L L1 Lat Shown1 _ _ Xj). assert (E1 := leaves_edge _ _ _ _ T1).
    assert (Same : same nothing L1 (standing L1) q).
    { destruct X1 as (a & b & K & Sa & Sb), E1 as (a' & b' & K' & Sa' & Sb').
      apply same_trans with b'; auto. apply same_trans with b; [|apply same_sym; auto].
      apply (same_link _ _ a' b' a b); auto. apply same_trans with (turned j (standing L)); auto.
      apply same_sym. auto. }
    assert (Q1 : valid L1 q) by (eapply longer_valid; eauto).
    assert (P1 : valid L1 p) by (eapply longer_valid; eauto).
    destruct (IH n') with (L := L1) (p := p) as (m & L' & Le & Tr & Nr); auto.
    + apply (near_trans L1 0 n' (standing L1) q p); [apply near_same; auto|].
      apply (near_longer L L1); auto.
    + exists (S m), L'. split; [lia|]. split; auto. apply travels_by with j L1; auto. exists q. auto.
Qed.

(** Travelling makes the log longer. *)
Lemma travels_longer W n L L' : travels W n L L' -> longer L L' /\
  length (moves L') = n + length (moves L) /\
  (replays W L -> replays W L').
Proof.
  induction 1 as [L|n L k L1 L' _ T1 _ (A & B & C)]; [auto using longer_refl|].
  split; [eapply longer_trans; eauto; eapply leaves_longer; eauto|].
  split; [rewrite B, (leaves_length _ _ _ _ T1); lia|]. intros _. apply C, (leaves_replays _ _ _ _ T1).
Qed.

(** If there is a way, the robot can walk a shortest one. *)
Lemma goes_exists W n L p : world W -> replays W L -> near L n (standing L) p -> valid L p ->
  exists L', goes_to W L p L'.
Proof.
  intros HW R N P. assert (Shown := replays_shown W L HW R).
  destruct (least_way L Shown n _ _ (standing_valid L) P N) as (m & _ & Nm & Least).
  destruct (near_travels W m HW L p R Nm P) as (i & L' & Le & Tr & Nr). exists L', i. split; auto.
  split; auto. intros x Nx. apply Least in Nx. lia.
Qed.

(** A walk is no longer than any way. *)
Lemma goes_cost W L p L' n : goes_to W L p L' -> replays W L -> near L n (standing L) p ->
  longer L L' /\ replays W L' /\ length (moves L') <= n + length (moves L) /\ near L' 0 (standing L') p.
Proof.
  intros (i & Tr & Nr & Least) R N. destruct (travels_longer _ _ _ _ Tr) as (A & B & C).
  split; auto. split; auto. split; auto. apply Least in N. lia.
Qed.

(** A turn leads to the root exactly if the marker is seen in that direction. *)
Lemma marker_turn M a i : is_map M -> a < darts M ->
  turn M i a = root M <-> marker M a = Some (i mod degree M a).
Proof.
  intros WM Ha. destruct (degree_spec M WM a Ha) as (D & _).
  assert (Lt : i mod degree M a < degree M a) by (apply Nat.mod_upper_bound; lia).
  rewrite <- (turn_mod M WM i a Ha). split; [|apply marker_some].
  intros E. destruct (marker_of M a _ Lt E) as (j & Ej). rewrite Ej. f_equal.
  assert (Lj : j < degree M a) by (apply find_seq in Ej; lia).
  apply (turn_eq M WM a); auto. rewrite E. apply marker_some. auto.
Qed.

(** Darts with one percept have one percept when turned, also in different worlds. *)
Lemma percept_turned M N a b k : is_map M -> is_map N -> a < darts M -> b < darts N ->
  percept M a = percept N b -> percept M (turn M k a) = percept N (turn N k b).
Proof.
  intros WM WN Ha Hb E. injection E as Ed Em. unfold percept. rewrite !degree_turn by auto.
  f_equal; auto. unfold marker. rewrite !degree_turn, Ed by auto. apply find_ext. intros j.
  apply eq_true_iff_eq. rewrite !Nat.eqb_eq, <- !turn_add, !marker_turn, Em, Ed by auto. tauto.
Qed.

(** All worlds that show a log show one percept at a place of it. *)
Lemma percept_forced L p V v U u : valid L p -> world V -> world U -> visits V L v -> visits U L u ->
  percept V (dart V v p) = percept U (dart U u p).
Proof.
  intros P HV HU Vv Vu. unfold dart. apply percept_turned; auto; try (apply world_is_map; auto; fail);
    [apply (v_lt _ _ _ Vv)|apply (v_lt _ _ _ Vu)|].
  unfold valid in P. destruct (seen L (fst p)) as [q|] eqn:E; [|tauto].
  rewrite (v_seen _ _ _ Vv _ _ E), (v_seen _ _ _ Vu _ _ E). auto.
Qed.

(** After a move over a dart that was crossed, every world that showed the log shows the longer one. *)
Lemma known_move W L k L1 V v : world W -> leaves_by W L k L1 -> was_crossed L (turned k (standing L)) ->
  world V -> visits V L v -> exists v1, visits V L1 v1 /\ forall p, valid L p ->
    dart V v1 p = dart V v p.
Proof.
  intros HW Td [q X] HV Vi. assert (WW := world_is_map W HW). assert (WV := world_is_map V HV).
  assert (R1 := leaves_replays _ _ _ _ Td). assert (Lat := leaves_longer _ _ _ _ Td).
  destruct (replays_visits W L1 WW R1) as [w Vw]. assert (Vw0 := longer_visits W L L1 w Lat Vw).
  assert (Shown : possible nothing L).
  { exists W, w. split; auto. split; auto. apply fits_nothing. }
  destruct (edge_valid _ _ _ X) as [P Q]. assert (Al := proj1 (edge_iff L Shown _ _ P Q) X).
  destruct Td as (o & -> & _). set (n := length (moves L)) in *.
  assert (Dn : door {| start := start L; moves := moves L ++ [(k, o)] |} n = Some k).
  { unfold door. simpl. rewrite map_app, nth_error_app2; rewrite map_length; auto.
    unfold n. rewrite Nat.sub_diag. auto. }
  assert (Sn : seen {| start := start L; moves := moves L ++ [(k, o)] |} (S n) = Some o).
  { unfold seen. simpl. rewrite map_app, nth_error_app2; rewrite map_length; auto.
    unfold n. rewrite Nat.sub_diag. auto. }
  assert (Mw := v_door _ _ _ Vw n k Dn).
  assert (Kw := move_door _ _ _ _ Mw). unfold move in Mw. rewrite (proj2 (Nat.ltb_lt _ _) Kw) in Mw.
  assert (Ew : w (S n) = dart W w q).
  { specialize (Al W w HW Vw0). rewrite turned_dart in Al. unfold dart, standing in Al. simpl in Al.
    fold n in Al. unfold dart. congruence. }
  exists (fun i => if i <=? n then v i else dart V v q). split; [split|].
  - intros i. destruct (i <=? n); [apply (v_lt _ _ _ Vi)|apply (dart_is V L); auto].
  - apply (v_0 _ _ _ Vi).
  - intros i pc E. destruct (Nat.leb_spec i n) as [Le|Lt].
    + apply (v_seen _ _ _ Vi). destruct i as [|i]; auto. unfold seen in *. simpl in *.
      rewrite map_app, nth_error_app1 in E; auto. rewrite map_length. auto.
    + assert (i = S n) as ->.
      { assert (H : i < length (start L :: map snd (moves L ++ [(k, o)])))
          by (apply nth_error_Some; unfold seen in E; simpl in E; congruence).
        simpl in H. rewrite map_length, app_length in H. simpl in H. fold n in H. lia. }
      rewrite Sn in E. injection E as <-. rewrite <- (v_seen _ _ _ Vw _ _ Sn), Ew.
      apply (percept_forced L); auto.
  - intros i j E. destruct (Nat.leb_spec i n) as [Le|Lt].
    + destruct (Nat.eq_dec i n) as [->|Ne].
      * rewrite Dn in E. injection E as <-. destruct (Nat.leb_spec (S n) n); [lia|].
        assert (Pe := percept_forced L (standing L) V v W w (standing_valid L) HV HW Vi Vw0).
        injection Pe as Pe _. unfold dart, standing in Pe. simpl in Pe. fold n in Pe.
        unfold move. rewrite Pe, (proj2 (Nat.ltb_lt _ _) Kw).
        specialize (Al V v HV Vi). rewrite turned_dart in Al. exact Al.
      * destruct (Nat.leb_spec (S i) n); [|lia]. apply (v_door _ _ _ Vi). unfold door in *.
        simpl in E. rewrite map_app, nth_error_app1 in E; auto. rewrite map_length. unfold n in *. lia.
    + exfalso. assert (H : i < length (map fst (moves L ++ [(k, o)])))
        by (apply nth_error_Some; unfold door in E; simpl in E; congruence).
      rewrite map_length, app_length in H. simpl in H. fold n in H. lia.
  - intros p Pv. unfold dart. assert (H : fst p <= n).
    { unfold valid, seen in Pv. apply nth_error_Some in Pv. simpl in Pv. rewrite map_length in Pv.
      fold n in Pv. lia. }
    destruct (Nat.leb_spec (fst p) n); [auto|lia].
Qed.

(** So it proves nothing new. *)
Lemma known_nothing_left W L k L1 M T : world W -> replays W L -> leaves_by W L k L1 ->
  was_crossed L (turned k (standing L)) -> grounded L M T -> nothing_left L M T -> nothing_left L1 M T.
Proof.
  intros HW R Td X G Sat M' T' St. assert (Shown := replays_shown W L HW R).
  assert (Shown1 := replays_shown W L1 HW (leaves_replays _ _ _ _ Td)).
  assert (Lat := leaves_longer _ _ _ _ Td).
  assert (More := fun V v HV Vi => known_move W L k L1 V v HW Td X HV Vi).
  assert (Edge : forall p q, valid L p -> valid L q -> on_edge L1 p q -> on_edge L p q).
  { intros p q P Q E. apply edge_iff; auto. intros V v HV Vi. destruct (More V v HV Vi)
    as (v1 & V1 & E1).
    rewrite <- !E1 by auto. apply (edge_iff L1); auto; eapply longer_valid; eauto. }
  assert (Same : forall p q, valid L p -> valid L q -> same nothing L1 p q -> same nothing L p q).
  { intros p q P Q E. apply same_iff; auto. intros V v HV Vi. destruct (More V v HV Vi)
    as (v1 & V1 & E1).
    rewrite <- !E1 by auto. apply (same_iff L1); auto; eapply longer_valid; eauto. }
  destruct St as [M T e h O Hh E|M T e p d i O E _ Ref]; assert (Ve := g_valid _ _ _ G e (proj1 O)).
  - apply (Sat (augment_loop M e h) T). apply settles_loop; auto. apply Edge; auto. apply G; auto.
  - assert (C : was_crossed L (T e)).
    { destruct (crossed_can_tell L Shown (T e) Ve) as [C|N]; auto. exfalso.
      destruct X as [q X]. destruct (edge_valid _ _ _ X) as [Vk Vq].
      assert (X1 := edge_longer L L1 Lat Shown1 _ _ X). assert (E1 := leaves_edge _ _ _ _ Td).
      assert (Hq : same nothing L1 (standing L1) q).
      { destruct X1 as (a & b & K & Sa & Sb), E1 as (a' & b' & K' & Sa' & Sb').
        apply same_trans with b'; auto. apply same_trans with b; [|apply same_sym; auto].
        apply (same_link _ _ a' b' a b); auto. apply same_trans with (turned k (standing L)); auto.
        apply same_sym. auto. }
      assert (To : forall a b, valid L a -> on_edge L a b -> ~ same nothing L1 (T e) a).
      { intros a b Va (c & c' & Kc & Sc & Sc') S. apply N. exists b, c, c'. split; auto. split; auto.
        apply same_trans with a; auto. }
      destruct E as (a & b & K & Sa & _). destruct Td as (o & -> & _).
      apply arcs_links in K. simpl in K. clear - K Sa To X Vk Vq Hq.
      assert (Old : forall ms i, In (a, b) (arcs_of_moves i (ms ++ [(k, o)])) ->
        In (a, b) (arcs_of_moves i ms) \/ a = (i + length ms, k) \/ a = (S (i + length ms), 0)).
      { intros ms. induction ms as [|(j, r) ms IH]; intros i I; simpl in I.
        - rewrite Nat.add_0_r. destruct I as [I|[I|[]]]; injection I as <- _; auto.
        - destruct I as [I|[I|I]]; simpl; auto. apply IH in I. rewrite <- Nat.add_succ_comm. tauto. }
      apply Old in K as [K|[->| ->]].
      - apply arcs_links in K. apply (To a b); auto; [eapply link_valid; eauto|].
        exists a, b. split; auto. split; constructor.
      - apply (To _ _ Vk X). unfold turned, standing. simpl. rewrite Nat.add_0_r. exact Sa.
      - apply (To q _ Vq (edge_sym _ _ _ X)). apply same_trans with (2 := Hq).
        unfold standing. simpl. rewrite app_length. simpl. rewrite Nat.add_1_r. exact Sa. }
    destruct C as [q C]. destruct (edge_valid _ _ _ C) as [_ Q]. unfold valid in Q.
    destruct (seen L (fst q)) as [(dq, mq)|] eqn:Eq; [|tauto].
    eapply Sat. apply (settles_new L M T e q dq mq); auto.
    intros h Hh S. apply (Ref h Hh). apply consistent_possible in S as (V & v & HV & Vi & F).
    destruct (More V v HV Vi) as (v1 & V1 & E1). assert (Vh := g_valid _ _ _ G h Hh).
    apply possible_consistent.
    + intros x y [I|[]]. injection I as <- <-. split; eapply longer_valid; eauto.
    + exists V, v1. split; auto. split; auto. intros x y [I|[]]. injection I as <- <-.
      rewrite !E1 by auto. apply F. simpl. auto.
Qed.

(** So after a walk over darts that were crossed nothing is left to settle. *)
Lemma travels_nothing_left W n L L' M T : world W -> travels W n L L' -> replays W L -> grounded L M T ->
  nothing_left L M T -> nothing_left L' M T.
Proof.
  intros HW. induction 1 as [L|n L k L1 L' X Td _ IH]; intros R G Sat; auto. apply IH.
  - apply (leaves_replays _ _ _ _ Td).
  - apply (grounded_longer L); auto. apply (leaves_longer _ _ _ _ Td).
  - apply (known_nothing_left W L k L1 M T); auto.
Qed.

(** Every dart of S has a way home, over fewer edges than S has vertices. *)
Lemma home_exists M h : is_map M -> connected M -> h < darts M -> exists w, home_way M h w.
Proof.
  intros WM CM Hh. assert (Hr := root_lt M WM). destruct (tree_good M (root M) WM Hr) as [G R].
  specialize (R h (CM h Hh)). apply in_map_iff in R as ((u, (n, b)) & E & I). simpl in E. subst u.
  assert (B := branch_of_in M (root M) _ _ G I). simpl in B.
  destruct (descend_spec M (root M) WM _ G n h b Hh I) as (A1 & A2 & A3 & A4).
  destruct (door_between_spec M WM _ (root M) A2 Hr A3) as [_ D].
  exists (fst (descend M (tree_from M (root M)) n h)). split; [|eauto].
  rewrite A1. assert (F : far_from M (tree_from M (root M)) h = n) by (unfold far_from; rewrite B; auto).
  rewrite <- F. unfold deep. assert (L := list_max_le (map (far_from M (tree_from M (root M)))
    (seq 0 (darts M))) (deep M)). destruct L as [L _]. specialize (L (le_n _)).
  rewrite Forall_forall in L. apply L, in_map, in_seq. lia.
Qed.

(** No distance on S is as great as its number of vertices. *)
Lemma deep_lt M : is_map M -> connected M -> deep M <= vertices M - 1.
Proof.
  intros WM CM. assert (Hr := root_lt M WM). destruct (tree_good M (root M) WM Hr) as [G R].
  apply list_max_le, Forall_forall. intros x I. apply in_map_iff in I as (d & <- & I).
  apply in_seq in I. assert (Hd : d < darts M) by lia.
  specialize (R d (CM d Hd)). apply in_map_iff in R as ((u, (n, b)) & E & J). simpl in E. subst u.
  assert (B := branch_of_in M (root M) _ _ G J). simpl in B. unfold far_from. rewrite B. simpl.
  assert (X := t_less M (root M) _ G _ _ _ J). assert (Y := found_le M (root M) WM _ G). lia.
Qed.

(** The unexplored darts beside e. *)
Lemma other_hypotheses M e : open M e -> exists l, (forall h, h < darts M -> h <> e ->
  alpha M h = None -> In h l) /\
  length l <= darts M - known M - 1.
Proof.
  intros [He Oe]. set (l := filter (fun h => negb (explored M h)) (seq 0 (darts M))).
  assert (Len : forall n, length (filter (fun h => negb (explored M h)) (seq 0 n)) + count
    (explored M) n = n).
  { intros n. induction n as [|n IH]; auto. rewrite seq_S, filter_app, app_length. simpl.
    destruct (explored M n); simpl; lia. }
  specialize (Len (darts M)). fold (known M) l in Len.
  assert (Mem : forall h, h < darts M -> alpha M h = None -> In h l).
  { intros h Hh Oh. apply filter_In. split; [apply in_seq; lia|]. unfold explored. rewrite Oh. auto. }
  exists (remove Nat.eq_dec e l). split.
  - intros h Hh N Oh. apply in_in_remove; auto.
  - assert (X := remove_length_lt Nat.eq_dec l e (Mem e He Oe)). lia.
Qed.
