(** Steered mappers, 1: what the fold of a log says of places, and that it can be decided.

    L is a log that some world shows; p, q, r are places of it, k turns, n numbers of moves; W a world,
    v i the reference dart of visit i. *)
From Coq Require Import Arith Lia List Bool Wf_nat.
Import ListNotations.
From Topo Require Import World Rotation Log Determined Entailed LogFold LogFoldExact FoldingRun Steered.

(** Identified places are places of the log, or neither is. *)
Lemma same_valid A L p q : same A L p q -> valid L p <-> valid L q.
Proof.
  induction 1 as [p|p q _ IH|p q r _ IH _ IH'|k i a j b _ IH|i d m E|i d j E|p q p' q' B C _ _];
    unfold valid in *; simpl in *; try tauto.
  - split; intros _; [discriminate|rewrite E; discriminate].
  - apply link_sym, link_valid in B. apply link_sym, link_valid in C. unfold valid in *. tauto.
Qed.

(** The ends of an edge of the fold are places of the log. *)
Lemma edge_valid L p q : on_edge L p q -> valid L p /\ valid L q.
Proof.
  intros (a & b & K & Sp & Sq). split; [apply (same_valid _ _ _ _ Sp)|apply (same_valid _ _ _ _ Sq)].
  - eapply link_valid; eauto.
  - eapply link_valid, link_sym; eauto.
Qed.

(** Edges of the fold go both ways. *)
Lemma edge_sym L p q : on_edge L p q -> on_edge L q p.
Proof. intros (a & b & K & Sp & Sq). exists b, a. auto using link_sym. Qed.

(** Turning twice. *)
Lemma turned_turned j k p : turned j (turned k p) = turned (j + k) p.
Proof. unfold turned. simpl. f_equal. lia. Qed.

(** Identified places are identified when turned. *)
Lemma turned_same A L k p q : same A L p q -> same A L (turned k p) (turned k q).
Proof. destruct p, q. unfold turned. simpl. apply same_turn. Qed.

(** The dart of a world at a turned place. *)
Lemma turned_dart W v k p : dart W v (turned k p) = turn W k (dart W v p).
Proof. unfold dart, turned. simpl. apply turn_add. Qed.

(** The dart of a world at a place. *)
Lemma dart_is W L v p : visits W L v -> is_map W -> dart W v p < darts W.
Proof. intros V WW. apply turn_lt; auto. apply (v_lt _ _ _ V). Qed.

Section Shown.
Variable L : Log.
Hypothesis Shown : possible nothing L.

(** Identified places are one dart in all worlds that show the log. *)
Lemma same_iff p q : valid L p -> valid L q ->
  same nothing L p q <-> forall W v, world W -> visits W L v -> dart W v p = dart W v q.
Proof.
  intros P Q. split; [|apply same_everywhere; auto].
  intros S W v HW V. apply (same_sound W L v nothing); auto using fits_nothing.
Qed.

(** An edge of the fold is an edge of all worlds that show the log. *)
Lemma edge_iff p q : valid L p -> valid L q ->
  on_edge L p q <-> forall W v, world W -> visits W L v -> alpha W (dart W v p) = Some (dart W v q).
Proof. intros P Q. symmetry. apply confirmation_entailed_iff; auto. apply (plain L Shown). Qed.

(** A place of the log has one percept, its visit's. *)
Lemma valid_seen p : valid L p -> exists d m, seen L (fst p) = Some (d, m) /\ 0 < d.
Proof.
  unfold valid. destruct (seen L (fst p)) as [(d, m)|] eqn:E; [|tauto]. exists d, m. split; auto.
  apply (proj1 (c_percept _ _ (plain L Shown) _ _ _ E)).
Qed.

(** Turning counts modulo the degree. *)
Lemma turned_mod k p : valid L p -> exists j, same nothing L (turned k p) (turned j p) /\
  forall W v, world W -> visits W L v -> j < degree W (dart W v p).
Proof.
  intros P. destruct (valid_seen p P) as (d & m & E & D). exists (k mod d).
  assert (De : forall W v, world W -> visits W L v -> degree W (dart W v p) = d).
  { intros W v HW V. unfold dart. rewrite degree_turn; [|apply HW|apply (v_lt _ _ _ V)].
    apply (v_seen _ _ _ V) in E. injection E as E _. auto. }
  split.
  - apply same_iff; auto. intros W v HW V. rewrite !turned_dart, <- (De W v HW V). symmetry.
    apply turn_mod; [apply HW|]. apply (dart_is W L); auto. apply HW.
  - intros W v HW V. rewrite (De W v HW V). apply Nat.mod_upper_bound. lia.
Qed.

(** Turning can be undone. *)
Lemma turned_back k p : valid L p -> exists j, same nothing L (turned j (turned k p)) p.
Proof.
  intros P. destruct (valid_seen p P) as (d & m & E & D). exists (d * k - k). rewrite turned_turned.
  replace (d * k - k + k) with (k * d) by nia. apply same_iff; auto. intros W v HW V.
  assert (WW := world_is_map W HW). assert (Lt := dart_is W L v p V WW).
  assert (De : degree W (dart W v p) = d).
  { unfold dart. rewrite degree_turn; auto; [|apply (v_lt _ _ _ V)].
    apply (v_seen _ _ _ V) in E. injection E as E _. auto. }
  rewrite turned_dart, <- turn_mod, De, Nat.mod_mul by (auto; lia). auto.
Qed.

(** Ways begin at any dart of a vertex. *)
Lemma near_turned n k p q : valid L p -> near L n p q -> near L n (turned k p) q.
Proof.
  intros P. destruct (turned_back k p P) as (j & B). destruct 1 as [n p q i S|n p q r i X N].
  - apply near_here with (i + j). rewrite <- turned_turned. apply same_trans with (turned i p); auto.
    apply turned_same; auto.
  - apply near_cross with q (i + j); auto. destruct X as (a & b & K & Sp & Sq). exists a, b. split; auto.
    split; auto. rewrite <- turned_turned. apply same_trans with (turned i p); auto.
    apply turned_same; auto.
Qed.

(** Ways follow one another. *)
Lemma near_trans n m p q r : near L n p q -> near L m q r -> near L (n + m) p r.
Proof.
  induction 1 as [n p q i S|n p q s i X N IH]; intros R.
  - revert q S R. intros q S R. assert (G : near L m p r).
    { destruct R as [m q r j Q|m q r s j X R].
      - apply near_here with (j + i). rewrite <- turned_turned.
        apply same_trans with (turned j q); auto. apply turned_same; auto.
      - apply near_cross with r (j + i); auto. destruct X as (a & b & K & Sp & Sq). exists a, b.
        split; auto. split; auto. rewrite <- turned_turned. apply same_trans with (turned j q); auto.
        apply turned_same; auto. }
    clear - G. induction G; [eapply near_here; eauto|].
    rewrite Nat.add_succ_r. eapply near_cross; eauto.
  - simpl. eapply near_cross; eauto.
Qed.

(** A longer bound is one. *)
Lemma near_more n m p q : near L n p q -> n <= m -> near L m p q.
Proof.
  intros N. revert m. induction N as [n p q i S|n p q s i X N IH]; intros m Le.
  - eapply near_here; eauto.
  - destruct m as [|m]; [lia|]. apply near_cross with q i; auto. apply IH. lia.
Qed.

(** A place is near itself. *)
Lemma near_self p : near L 0 p p.
Proof. apply near_here with 0. destruct p. constructor. Qed.

(** Identified places are near. *)
Lemma near_same p q : same nothing L p q -> near L 0 p q.
Proof. intros S. apply near_here with 0. destruct p. auto. Qed.

(** Whether P holds can be decided. *)
Definition can_tell (P : Prop) := P \/ ~ P.

(** Whether something in a list has a property can be decided if it can of each. *)
Lemma can_tell_list {X} (P : X -> Prop) l : (forall x, In x l -> can_tell (P x)) ->
  can_tell (exists x, In x l /\ P x).
Proof.
  induction l as [|x l IH]; intros D; [right; intros (x & [] & _)|].
  destruct (D x (or_introl eq_refl)) as [H|H]; [left; exists x; simpl; auto|].
  destruct IH as [(y & I & Y)|N]; [intros y I; apply D; simpl; auto|left; exists y; simpl; auto|].
  right. intros (y & [<-|I] & Y); eauto.
Qed.

(** Whether two places are identified can be decided: the program of LogFold.v does. *)
Lemma same_can_tell p q : valid L p -> valid L q -> can_tell (same nothing L p q).
Proof.
  intros P Q. destruct (fold_exists L Shown) as (f & R & _ & I). specialize (I nothing).
  assert (F := f_forced _ _ _ _ _ _ I).
  assert (All : forall a b, link nothing L a b -> In (a, b) (arcs_of_moves 0 (moves L)))
    by (intros a b; apply arcs_links).
  assert (Same := folded_same L nothing Shown _ f R I All).
  destruct (place_eqb (found (percepts_of L) f p) (found (percepts_of L) f q)) eqn:E.
  - left. apply place_eqb_eq in E. apply same_trans with (found (percepts_of L) f p); [apply F; auto|].
    rewrite E. apply same_sym, F; auto.
  - right. intros S. apply Same, place_eqb_eq in S. congruence.
Qed.

(** So can whether they are at one vertex, *)
Lemma reached_can_tell p q : valid L p -> valid L q -> can_tell (exists k,
  same nothing L (turned k p) q).
Proof.
  intros P Q. destruct (valid_seen p P) as (d & m & E & D).
  destruct (can_tell_list (fun k => same nothing L (turned k p) q) (seq 0 d)) as [(k & _ & S)|N].
  - intros k _. apply same_can_tell; auto.
  - left. eauto.
  - right. intros (k & S). apply N. exists (k mod d).
    split; [apply in_seq; assert (k mod d < d) by (apply Nat.mod_upper_bound; lia); lia|].
    apply same_trans with (turned k p); auto. apply same_sym. destruct p as (i, a). unfold turned.
    simpl in *. apply same_trans with (i, (k + a) mod d); [apply (same_mod _ _ _ _ _ _ E)|].
    apply same_trans with (i, (k mod d + a) mod d).
    + rewrite Nat.add_mod_idemp_l by lia. constructor.
    + apply same_sym, (same_mod _ _ _ _ _ _ E).
Qed.

(** whether a dart was crossed, *)
Lemma crossed_can_tell p : valid L p -> can_tell (was_crossed L p).
Proof.
  intros P. destruct (can_tell_list (fun r => same nothing L p (fst r)) (arcs_of_moves 0 (moves L)))
    as [((a, b) & I & S)|N].
  - intros (a, b) I. apply same_can_tell; auto. apply arcs_links in I. eapply link_valid; eauto.
  - left. exists b, a, b. split; [apply arcs_links; auto|]. split; auto. constructor.
  - right. intros (q & a & b & K & Sp & Sq). apply N. exists (a, b). split; [apply arcs_links;
    auto|auto].
Qed.

(** whether an edge of the fold leads from one place to another, *)
Lemma edge_can_tell p q : valid L p -> valid L q -> can_tell (on_edge L p q).
Proof.
  intros P Q. destruct (can_tell_list (fun r => same nothing L p (fst r) /\ same nothing L q (snd r))
    (arcs_of_moves 0 (moves L))) as [((a, b) & I & S & S')|N].
  - intros (a, b) I. apply arcs_links in I. simpl.
    destruct (same_can_tell p a P) as [S|S]; [eapply link_valid; eauto| |right; tauto].
    destruct (same_can_tell q b Q) as [S'|S']; [eapply link_valid, link_sym; eauto| |right; tauto].
    left. auto.
  - left. exists a, b. split; [apply arcs_links; auto|auto].
  - right. intros (a & b & K & Sp & Sq). apply N. exists (a, b). split; [apply arcs_links; auto|auto].
Qed.

(** whether one vertex is near another, *)
Lemma near_can_tell n : forall p q, valid L p -> valid L q -> can_tell (near L n p q).
Proof.
  induction n as [|n IH]; intros p q P Q; destruct (reached_can_tell p q P Q) as [(k & S)|N];
    try (left; eapply near_here; eauto; fail).
  - right. intros R. inversion R; subst. eauto.
  - destruct (can_tell_list (fun r => (exists k, same nothing L (turned k p) (fst r)) /\
    near L n (snd r) q)
      (arcs_of_moves 0 (moves L))) as [((a, b) & I & (k & S) & R)|M].
    + intros (a, b) I. apply arcs_links in I. simpl.
      destruct (reached_can_tell p a P) as [S|S]; [eapply link_valid; eauto| |right; tauto].
      destruct (IH b q) as [R|R]; auto; [eapply link_valid, link_sym; eauto|left; auto|right; tauto].
    + left. apply near_cross with b k; auto. exists a, b. split; [apply arcs_links; auto|].
      split; auto. constructor.
    + right. intros R. inversion R as [? ? ? k S|? ? s ? k X R']; subst; [eauto|]. apply M.
      destruct X as (a & b & K & Sp & Sq). exists (a, b). split; [apply arcs_links; auto|]. simpl.
      split; [eauto|]. apply (near_trans 0 n b s q); auto. apply near_same, same_sym; auto.
Qed.

(** If there is a way, there is a shortest one. *)
Lemma least_way n p q : valid L p -> valid L q -> near L n p q ->
  exists m, m <= n /\ near L m p q /\ forall x, near L x p q -> m <= x.
Proof.
  intros P Q N. destruct (dec_inh_nat_subset_has_unique_least_element (fun n => near L n p q))
    as (m & (Nm & Least) & _); eauto.
  intros k. apply near_can_tell; auto.
Qed.

(** Whether a hypothesis is refuted can be decided. *)
Lemma consistent_can_tell p q : valid L p -> valid L q -> can_tell (consistent [(p, q)] L).
Proof.
  intros P Q. assert (X := allows_exact L p q Shown P Q). assert (Y := rejection_entailed_iff L p q P Q).
  destruct (allows L (fold_of L) p q) eqn:E.
  - left. destruct X as [X _]. destruct (X eq_refl) as (W & v & HW & V & Ed).
    apply possible_consistent; [intros a b [I|[]]; injection I as <- <-; auto|].
    exists W, v. split; auto. split; auto. intros a b [I|[]]. injection I as <- <-. auto.
  - right. apply Y. intros W v HW V Ed. destruct X as [_ X]. discriminate X. eauto.
Qed.
End Shown.
