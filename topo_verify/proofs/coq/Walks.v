(** A walk that proves a map: when every visit is joined to a sight of the marker by edges of the
    breadth-first tree, and every edge is crossed, the log of the walk is closed (docs/semantics.md,
    section 11).

    W is a world; depth and up describe a breadth-first tree of it; a, b, c, d are darts of W. A
    walk ds is the list of the darts by which a robot leaves. W' is any world that shows the log of
    the walk; a' is a dart of it.

    Let W' show the log. The tree gives every dart b of W a dart [image b] of W': go down the tree
    by the same doors. Where the walk and its copy in W' stand at a dart and at its image, they do
    so before and after every move over a tree edge; and they do so wherever the marker is seen. So
    they do all the way, if between two chords the marker is seen. If every edge is crossed, the
    image keeps everything: W' has as many darts as W. A log that is shown by worlds of one size
    only is closed. *)
From Coq Require Import Arith Lia List Bool.
Import ListNotations.
From Topo Require Import World Rotation Vertices Log Determined Undetermined Entailed Distance
  Tree Pendant.

(** The door that leads out by d, counted from dart a of the same vertex. *)
Definition door_to W a d :=
  match find (fun k => turn W k a =? d) (seq 0 (degree W a)) with Some k => k | None => 0 end.

(** What is recorded on the walk that leaves by ds, begun with reference dart a: doors and percepts. *)
Fixpoint trail W a ds := match ds with
  | [] => []
  | d :: ds => (door_to W a d, percept W (opposite W d)) :: trail W (opposite W d) ds end.

(** The log of the walk from the root. *)
Definition walk_log W ds := {| start := percept W (root W); moves := trail W (root W) ds |}.

(** b is a dart of the vertex of a. *)
Definition beside W a b := exists k, b = turn W k a.

(** The walk that leaves by ds can be made from a: each dart is at the vertex where the robot is. *)
Fixpoint path W a ds := match ds with
  | [] => True
  | d :: ds => beside W a d /\ d < darts W /\ path W (opposite W d) ds end.

(** Between two chords of the walk the marker is seen, and behind the last chord it is. Lost says
    that a chord was crossed and the marker was not seen since then. *)
Fixpoint homing W depth up (lost : bool) ds := match ds with
  | [] => negb lost
  | d :: ds => if in_tree W depth up d
               then homing W depth up (lost && negb (depth (opposite W d) =? 0)) ds
               else negb lost && homing W depth up (negb (depth (opposite W d) =? 0)) ds end.

Section Steps.
Variable W : Map.
Hypothesis HW : world W.
Let WW := world_is_map W HW.

(** The door to turn m a is m modulo the degree. *)
Lemma door_to_turn m a : a < darts W -> door_to W a (turn W m a) = m mod degree W a.
Proof.
  intros Ha. destruct (degree_spec W WW a Ha) as (D & _). unfold door_to.
  assert (B : m mod degree W a < degree W a) by (apply Nat.mod_upper_bound; lia).
  destruct (find _ _) as [k|] eqn:F.
  - apply find_seq in F as (I & E & _). apply Nat.eqb_eq in E. apply (turn_eq W WW a); auto; [lia|].
    rewrite E. symmetry. apply turn_mod; auto.
  - assert (N := find_none _ _ F (m mod degree W a)). cbv beta in N.
    rewrite turn_mod, Nat.eqb_refl in N by auto. discriminate N. apply in_seq. lia.
Qed.

(** Turning by that door leads to the dart, and the vertex has that door. *)
Lemma door_to_ok a d : a < darts W -> beside W a d ->
  turn W (door_to W a d) a = d /\ door_to W a d < degree W a.
Proof.
  intros Ha (m & ->). rewrite door_to_turn by auto. destruct (degree_spec W WW a Ha) as (D & _).
  split; [apply turn_mod; auto|apply Nat.mod_upper_bound; lia].
Qed.

(** The door to the dart itself is 0. *)
Lemma door_to_self a : a < darts W -> door_to W a a = 0.
Proof.
  intros Ha. change a with (turn W 0 a) at 2. rewrite door_to_turn by auto.
  destruct (degree_spec W WW a Ha) as (D & _). apply Nat.mod_0_l. lia.
Qed.

(** [beside] is symmetric. *)
Lemma beside_sym a b : a < darts W -> beside W a b -> beside W b a.
Proof. intros Ha (k & ->). destruct (turn_back W WW k a Ha) as (j & E). exists j. auto. Qed.

(** [beside] is transitive. *)
Lemma beside_trans a b c : beside W a b -> beside W b c -> beside W a c.
Proof. intros (k & ->) (j & ->). exists (j + k). rewrite turn_add. auto. Qed.

(** A dart is beside itself. *)
Lemma beside_refl a : beside W a a.
Proof. exists 0. auto. Qed.

(** The world shows the log of a walk that can be made in it. *)
Lemma walk_percepts ds : forall a, a < darts W -> path W a ds ->
  percepts W a (map fst (trail W a ds)) = Some (map snd (trail W a ds)).
Proof.
  induction ds as [|d ds IH]; simpl; auto. intros a Ha (A & Hd & P).
  destruct (door_to_ok a d Ha A) as [E B]. unfold move. rewrite (proj2 (Nat.ltb_lt _ _) B), E.
  rewrite (opposite_alpha W HW d Hd), IH; auto. apply (opposite_ok W HW d Hd).
Qed.

(** The world shows the log of a walk from its root. *)
Lemma walk_replays ds : path W (root W) ds -> replays W (walk_log W ds).
Proof. intros P. split; auto. apply walk_percepts; auto. apply root_lt; auto. Qed.

(** A walk has as many moves as darts by which it leaves. *)
Lemma trail_length ds : forall a, length (trail W a ds) = length ds.
Proof. induction ds as [|d ds IH]; simpl; auto. Qed.
End Steps.

Section Image.
Variables (W W' : Map) (depth up : nat -> nat).
Hypotheses (HW : world W) (HW' : world W') (B : breadth_first W depth up).
Let WW := world_is_map W HW.
Let WW' := world_is_map W' HW'.
Let opposite_ok := opposite_ok W HW.
Let depth_turn := depth_turn W depth up HW B.

(** The image of b, whose vertex has depth n: from the root of W' down the tree by the same doors. *)
Fixpoint image_at n b := match n with
  | 0 => turn W' (door_to W (root W) b) (root W')
  | S n => turn W' (door_to W (up b) b) (opposite W' (image_at n (opposite W (up b)))) end.

(** The image of b. *)
Definition image b := image_at (depth b) b.

(** The dart at the vertex of b by which the tree enters it; the root at v0. *)
Definition anchor b := match depth b with 0 => root W | S _ => up b end.

(** The image of the anchor. *)
Definition anchor_image b :=
  match depth b with 0 => root W' | S n => opposite W' (image_at n (opposite W (up b))) end.

(** The image of a dart is found by turning from that of its anchor. *)
Lemma image_anchor b : image b = turn W' (door_to W (anchor b) b) (anchor_image b).
Proof. unfold image, anchor, anchor_image. destruct (depth b); auto. Qed.

(** Images are darts of W'. *)
Lemma image_at_lt n : forall b, image_at n b < darts W'.
Proof.
  assert (R := root_lt W' WW').
  induction n as [|n IH]; intros b; simpl; apply turn_lt; auto.
  apply (Distance.opposite_ok W' HW'). auto.
Qed.

(** The image of the anchor is a dart of W'. *)
Lemma anchor_image_lt b : anchor_image b < darts W'.
Proof.
  unfold anchor_image. destruct (depth b); [apply root_lt; auto|].
  apply (Distance.opposite_ok W' HW'), image_at_lt.
Qed.

(** The image of a dart is a dart of W'. *)
Lemma image_lt b : image b < darts W'.
Proof. apply image_at_lt. Qed.

(** The anchor of b is a dart of the vertex of b. *)
Lemma anchor_ok b : b < darts W -> anchor b < darts W /\ beside W (anchor b) b.
Proof.
  intros Hb. unfold anchor. destruct (depth b) eqn:D.
  - destruct (bf_home W depth up B b Hb D) as (k & E). split; [apply root_lt; auto|exists k; auto].
  - destruct (bf_up W depth up B b Hb) as [(k & U) _]; [lia|].
    assert (up b < darts W) by (rewrite U; apply turn_lt; auto). split; auto.
    apply (beside_sym W HW); auto. exists k. auto.
Qed.

(** Doors from c carry over to a dart r of W' with the same degree. *)
Lemma carry k c b r : c < darts W -> beside W c b -> r < darts W' -> degree W' r = degree W c ->
  turn W' (door_to W c (turn W k b)) r = turn W' k (turn W' (door_to W c b) r).
Proof.
  intros Hc (m & ->) Hr D. rewrite <- !turn_add, !(door_to_turn W HW), <- D by auto.
  rewrite (turn_mod W' WW'), !(turn_add W'), (turn_mod W' WW') by auto. auto.
Qed.

(** If the degrees of b and of its image agree, the image turns as b does. *)
Lemma image_turn k b : b < darts W -> degree W' (image b) = degree W b ->
  image (turn W k b) = turn W' k (image b).
Proof.
  intros Hb D. destruct (anchor_ok b Hb) as (Hc & N).
  assert (A : anchor (turn W k b) = anchor b /\ anchor_image (turn W k b) = anchor_image b).
  { unfold anchor, anchor_image. destruct (depth_turn k b Hb) as [-> ->]. auto. }
  destruct A as [A A']. rewrite !image_anchor in *. rewrite A, A'.
  assert (R := anchor_image_lt b). apply carry; auto.
  rewrite (degree_turn W' WW') in D by auto. rewrite D. destruct N as (m & E). rewrite E at 1.
  apply degree_turn; auto.
Qed.

(** The image of the root is the root. *)
Lemma image_root : image (root W) = root W'.
Proof.
  unfold image. rewrite (bf_root W depth up B). simpl.
  rewrite (door_to_self W HW); auto. apply root_lt; auto.
Qed.

(** The image of a tree edge is an edge. *)
Lemma image_tree d : d < darts W -> in_tree W depth up d = true ->
  alpha W' (image d) = Some (image (opposite W d)).
Proof.
  assert (Up : forall c, c < darts W -> nearer depth up c = true ->
    image c = opposite W' (image (opposite W c))).
  { intros c Hc N. destruct (nearer_ok W depth up HW B c Hc N) as (P & U & O & D).
    rewrite <- O in D. rewrite (image_anchor c). unfold anchor, anchor_image, image.
    destruct (depth c) as [|n]; [lia|]. rewrite U, (door_to_self W HW) by auto. simpl.
    injection D as ->. auto. }
  intros Hd T. assert (I := image_lt (opposite W d)). assert (J := image_lt d).
  apply orb_true_iff in T as [T|T].
  - rewrite Up by auto. rewrite (opposite_alpha W' HW').
    + f_equal. apply (Distance.opposite_ok W' HW'). auto.
    + apply (Distance.opposite_ok W' HW'). auto.
  - destruct (opposite_ok d Hd) as (Ho & _ & O). rewrite (Up _ Ho T), O.
    apply (opposite_alpha W' HW'). auto.
Qed.

(** Where the marker is seen, a dart with the percept of a is the image of a. *)
Lemma image_home a a' : a < darts W -> a' < darts W' -> depth a = 0 ->
  percept W' a' = percept W a -> a' = image a.
Proof.
  intros Ha Ha' Z P. injection P as Dg Mk. assert (R := root_lt W WW). assert (R' := root_lt W' WW').
  assert (N : beside W (root W) a).
  { destruct (bf_home W depth up B a Ha Z) as (m & E). exists m. auto. }
  destruct (door_to_ok W HW _ a R N) as [S _].
  assert (J : exists j, marker W a = Some j).
  { apply (same_vertex_mark W WW (door_to W (root W) a) 0 (root W) a 0); auto. }
  destruct J as [j J]. rewrite J in Mk. apply marker_some in J, Mk.
  assert (D : degree W' (root W') = degree W (root W)).
  { rewrite <- Mk, <- J, (degree_turn W' WW'), (degree_turn W WW); auto. }
  assert (Cy := carry j (root W) a (root W') R N R' D). rewrite J, (door_to_self W HW) in Cy by auto.
  unfold image. rewrite Z. apply (turn_inj W' WW' j); auto; [apply turn_lt; auto|]. simpl.
  rewrite Mk. exact Cy.
Qed.

(** The walk stood at the vertex of b, and its copy in W' at the image, seeing the same. *)
Definition told b := exists a k, a < darts W /\ b = turn W k a /\ percept W' (image a) = percept W a.

(** The walk and its copy stand at darts and their images all the way. From a dart that is not known
    to be at its image the next sight of the marker tells it, for a tree edge is crossed at the image
    exactly if one arrives there. *)
Lemma walk_image ds : forall lost a a', a < darts W -> a' < darts W' -> path W a ds ->
  percept W' a' = percept W a ->
  percepts W' a' (map fst (trail W a ds)) = Some (map snd (trail W a ds)) ->
  homing W depth up lost ds = true -> (lost = false -> a' = image a) ->
  a' = image a /\ forall d, In d ds ->
    told d /\ told (opposite W d) /\ alpha W' (image d) = Some (image (opposite W d)).
Proof.
  induction ds as [|d ds IH]; simpl; intros lost a a' Ha Ha' P Q Ps H L.
  { split; [apply L; destruct lost; auto; discriminate|intros d []]. }
  destruct P as (A & Hd & P). destruct (door_to_ok W HW a d Ha A) as [E _].
  destruct (opposite_ok d Hd) as (Ho & _ & Oo). set (k := door_to W a d) in *.
  destruct (move W' a' k) as [b'|] eqn:M; [|discriminate].
  destruct (percepts W' b' _) as [ps|] eqn:Ps'; [|discriminate]. simpl in Ps.
  assert (Qb' : percept W' b' = percept W (opposite W d)) by congruence.
  assert (Eq : ps = map snd (trail W (opposite W d) ds)) by congruence. rewrite Eq in Ps'. clear Ps Eq.
  assert (Hb' : b' < darts W') by (eapply move_lt; eauto).
  unfold move in M. destruct (k <? degree W' a'); [|discriminate].
  assert (Home : depth (opposite W d) = 0 -> b' = image (opposite W d)).
  { intros. apply image_home; auto. }
  (* If the robot is at the image before the move, it leaves by the image of d. *)
  assert (Leave : a' = image a -> turn W' k a' = image d).
  { intros ->. rewrite <- E. symmetry. apply image_turn; auto. injection Q as Q _. auto. }
  assert (Done : a' = image a -> b' = image (opposite W d) ->
    told d /\ told (opposite W d) /\ alpha W' (image d) = Some (image (opposite W d))).
  { intros X Y. split; [|split].
    - exists a, k. repeat split; auto. congruence.
    - exists (opposite W d), 0. repeat split; auto. congruence.
    - rewrite <- (Leave X), <- Y. auto. }
  destruct (in_tree W depth up d) eqn:T.
  - assert (T' := image_tree d Hd T).
    destruct (IH _ (opposite W d) b' Ho Hb' P Qb' Ps' H) as [Y N].
    { destruct lost; simpl; intros Z.
      { apply Home. destruct (Nat.eqb_spec (depth (opposite W d)) 0); auto. discriminate. }
      rewrite (Leave (L eq_refl)), T' in M. congruence. }
    assert (X : a' = image a).
    { assert (Z : turn W' k a' = image d).
      { rewrite Y in M. apply (alpha_ok W' WW') in M as (_ & _ & M); [|apply turn_lt; auto].
        apply (alpha_ok W' WW') in T' as (_ & _ & T'); [|apply image_lt]. congruence. }
      assert (D : degree W' (image d) = degree W d).
      { rewrite <- Z, <- E, (degree_turn W' WW'), (degree_turn W WW) by auto.
        injection Q as Q _. auto. }
      destruct (turn_back W WW k a Ha) as (j & F). rewrite E in F.
      apply (turn_inj W' WW' k); auto using image_lt. rewrite Z, <- (image_turn k a), E; auto.
      rewrite <- F, image_turn, (degree_turn W' WW'), (degree_turn W WW); auto using image_lt. }
    split; auto. intros c [<-|I]; auto.
  - apply andb_true_iff in H as [K H]. apply negb_true_iff in K. specialize (L K).
    destruct (IH _ (opposite W d) b' Ho Hb' P Qb' Ps' H) as [Y N].
    { intros Z. apply Home. destruct (Nat.eqb_spec (depth (opposite W d)) 0); auto; discriminate. }
    split; auto. intros c [<-|I]; auto.
Qed.

(** From here on the walk has told of every dart, and every edge goes to an edge. *)
Hypothesis Told : forall b, b < darts W -> told b.
Hypothesis Cross : forall b, b < darts W -> alpha W' (image b) = Some (image (opposite W b)).

(** A dart and its image have one degree, so the image turns as the dart does. *)
Lemma image_full k b : b < darts W -> image (turn W k b) = turn W' k (image b).
Proof.
  intros Hb. apply image_turn; auto. destruct (Told b Hb) as (a & j & Ha & -> & Q).
  injection Q as D _. rewrite image_turn, (degree_turn W' WW'), (degree_turn W WW); auto using image_lt.
Qed.

(** Only the root goes to the root. *)
Lemma image_marker b : b < darts W -> image b = root W' -> b = root W.
Proof.
  intros Hb E. destruct (Told b Hb) as (a & k & Ha & -> & Q). injection Q as D Q.
  rewrite image_full in E by auto. assert (I := image_lt a).
  destruct (degree_spec W WW a Ha) as (P & _).
  assert (Lt : k mod degree W a < degree W a) by (apply Nat.mod_upper_bound; lia).
  assert (E' : turn W' (k mod degree W a) (image a) = root W').
  { rewrite <- D, (turn_mod W' WW'); auto. }
  destruct (marker_of W' (image a) (k mod degree W a)) as [j J]; [lia|auto|].
  assert (Lj : j < degree W' (image a)) by (apply find_seq in J as (J & _); lia).
  assert (Mk := J). rewrite Q in Mk. apply marker_some in Mk, J.
  assert (K : k mod degree W a = j) by (apply (turn_eq W' WW' (image a)); auto; [lia|congruence]).
  rewrite <- (turn_mod W WW), K by auto. auto.
Qed.

(** Different darts have different images. *)
Lemma image_inj b c : b < darts W -> c < darts W -> image b = image c -> b = c.
Proof.
  intros Hb Hc. assert (R := world_connected W HW b Hb). clear Hb. revert c Hc.
  induction R as [|b R IH|b e R IH Al]; intros c Hc E.
  - symmetry. apply image_marker; auto. rewrite <- E. apply image_root.
  - assert (Hb : b < darts W) by (apply (reach_sym W (root W) b WW (root_lt W WW) R)).
    destruct (turn_back W WW 1 c Hc) as (j & F). rewrite <- turn_add, Nat.add_1_r in F.
    simpl in F. set (x := turn W j c) in *. assert (Hx : x < darts W) by (apply turn_lt; auto).
    assert (X : b = x).
    { apply IH; auto. apply (turn_inj W' WW' 1); auto using image_lt.
      rewrite <- !image_full by auto. simpl. rewrite F. auto. }
    rewrite X. auto.
  - assert (Hb : b < darts W) by (apply (reach_sym W (root W) b WW (root_lt W WW) R)).
    destruct (opposite_ok c Hc) as (Ho & _ & Oc).
    assert (O : opposite W b = e) by (unfold opposite; rewrite Al; auto).
    assert (X : b = opposite W c).
    { apply IH; auto. assert (A := Cross b Hb). assert (A' := Cross c Hc).
      rewrite O, E in A. apply (alpha_ok W' WW') in A as (_ & _ & A); [|apply image_lt]. congruence. }
    congruence.
Qed.

(** Every dart of W' is an image. *)
Lemma image_onto b' : b' < darts W' -> exists b, b < darts W /\ image b = b'.
Proof.
  intros H. apply (world_connected W' HW') in H.
  induction H as [|b' _ (b & Hb & <-)|b' e _ (b & Hb & <-) Al].
  - exists (root W). split; [apply root_lt; auto|apply image_root].
  - exists (sigma W b). split; [apply (sigma_lt W WW); auto|apply (image_full 1 b Hb)].
  - exists (opposite W b). split; [apply opposite_ok; auto|]. rewrite Cross in Al by auto. congruence.
Qed.

(** W' has as many darts as W. *)
Lemma image_size : darts W' = darts W.
Proof.
  apply Nat.le_antisymm.
  - destruct (choice 0 (fun b' b => b < darts W /\ image b = b') (darts W')) as [f F].
    { apply image_onto. }
    apply (pigeon f); [apply F|]. intros i j Hi Hj E.
    destruct (F i Hi) as [_ <-], (F j Hj) as [_ <-]. congruence.
  - apply (pigeon image); [auto using image_lt|]. auto using image_inj.
Qed.
End Image.

(** A homing walk that crosses every edge has a closed log: it proves the map.
    Not in the paper. *)
Theorem walk_closed W depth up ds : world W -> breadth_first W depth up -> path W (root W) ds ->
  homing W depth up false ds = true ->
  (forall b, b < darts W -> exists d, In d ds /\ edge W d = edge W b) -> closed (walk_log W ds).
Proof.
  intros HW B P H Every. assert (R := walk_replays W HW ds P). assert (WW := world_is_map W HW).
  assert (Lt : forall d, In d ds -> d < darts W).
  { clear - P. revert P. generalize (root W).
    induction ds as [|e ds IH]; simpl; [intros _ _ d []|]. intros a (_ & He & P) d [<-|I]; eauto. }
  assert (Size : forall W', world W' -> replays W' (walk_log W ds) -> darts W' = darts W).
  { intros W' HW' [R0 R1]. assert (WW' := world_is_map W' HW').
    destruct (walk_image W W' depth up HW HW' B ds false (root W) (root W')) as [_ N]; auto.
    { apply root_lt; auto. } { apply root_lt; auto. }
    { intros _. symmetry. apply image_root; auto. }
    assert (Both : forall b, b < darts W -> told W W' depth up b /\
      alpha W' (image W W' depth up b) = Some (image W W' depth up (opposite W b))).
    { intros b Hb. destruct (Every b Hb) as (d & I & E). destruct (N d I) as (T & T' & A).
      destruct (opposite_ok W HW d (Lt d I)) as (_ & _ & Od).
      destruct (opposite_ok W HW b Hb) as (_ & _ & Ob).
      assert (X : b = d \/ b = opposite W d).
      { destruct (edge_or W d) as [F|F], (edge_or W b) as [G|G]; rewrite F, G in E; auto.
        - right. rewrite E. auto.
        - left. rewrite <- Ob, <- E. auto. }
      destruct X as [-> | ->]; auto. split; auto. rewrite Od.
      apply (alpha_ok W' WW') in A; [apply A|]. apply image_lt; auto. }
    apply (image_size W W' depth up); auto; apply Both. }
  destruct (closed_or_undetermined W (walk_log W ds) HW R)
    as [|(W1 & W2 & H1 & H2 & R1 & R2 & N)]; auto.
  destruct N. rewrite (Size W1), (Size W2); auto.
Qed.
