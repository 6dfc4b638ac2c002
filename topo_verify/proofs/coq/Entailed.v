(** Folding is complete: what the fold does not contradict, some world shows (claims 9 and 10;
    docs/semantics.md, section 11).

    L is a log, A a list of assumed edges, p and q are places, W a world, v i the reference dart of
    visit i.

    A log and assumed edges are [consistent] exactly if some world shows the log and has these
    edges. So a rejection is entailed exactly if the fold with its edge contradicts; a
    confirmation is entailed exactly if the fold makes the two darts partners; and a log either
    proves the map or proves nothing. *)
From Coq Require Import Arith Lia List Bool.
Import ListNotations.
From Topo Require Import World Rotation Embedding Augment Log Determined Undetermined Classes Quotient.

(** If a map shows a log, every world in which it is embedded shows it at the corresponding
    darts. *)
Lemma embedded_visits M W L u : is_map M -> is_map W -> embedded M W id -> visits M L u ->
  visits W L u /\ forall p, dart W u p = dart M u p.
Proof.
  intros WM WW E V. assert (Lt := v_lt M L u V). split; [split|].
  - intros i. apply (phi_lt _ _ _ E (u i)); auto.
  - rewrite (v_0 M L u V). apply (phi_root _ _ _ E).
  - intros i p Hp. rewrite <- (v_seen M L u V i p Hp). apply (percept_agree M W id); auto.
  - intros i k Hk. apply (embedded_move M W id WM WW E (u i) k (u (S i))); auto.
    apply (v_door M L u V); auto.
  - intros (i, k). symmetry. apply (embedded_turn M W id WM E); auto.
Qed.

(** If the fold of L with A is consistent, some world shows L and has the edges A: the quotient
    with leaves hung on its open darts.
    Not in the paper. *)
Theorem consistent_possible A L : consistent A L -> possible A L.
Proof.
  intros C. destruct (quotient_exists L A C) as (M & u & Q).
  assert (WM := q_map _ _ _ _ Q). assert (CM := q_connected _ _ _ _ Q).
  destruct (hang_leaves (darts M) M WM CM) as (W & HW & E & _ & _); [lia|].
  destruct (embedded_visits M W L u WM (world_is_map W HW) E (q_visits _ _ _ _ Q)) as [V D].
  exists W, u. split; auto. split; auto. intros p q I. rewrite !D.
  apply (phi_alpha M W id E); [|apply (q_fits _ _ _ _ Q); auto].
  apply turn_lt; auto. apply (v_lt M L u (q_visits _ _ _ _ Q)).
Qed.

(** If some world shows L and has the edges A, the fold of L with A is consistent. *)
Theorem possible_consistent A L : (forall p q, In (p, q) A -> valid L p /\ valid L q) ->
  possible A L -> consistent A L.
Proof.
  intros Val (W & v & HW & V & F). assert (WW := world_is_map W HW).
  assert (Lt := v_lt W L v V). assert (Same := same_sound W L v A HW V F).
  assert (Seen : forall i d m, seen L i = Some (d, m) -> degree W (v i) = d /\ marker W (v i) = m).
  { intros i d m E. apply (v_seen W L v V) in E. injection E as <- <-. auto. }
  split; auto.
  - exists (degree W (root W)). unfold seen. simpl.
    assert (P := v_seen W L v V 0 (start L) eq_refl). rewrite (v_0 W L v V) in P. rewrite <- P.
    unfold percept. do 2 f_equal. unfold marker.
    destruct (degree_spec W WW (root W)) as (D & _); [apply root_lt; auto|].
    destruct (degree W (root W)); [lia|]. simpl. rewrite Nat.eqb_refl. auto.
  - intros i d m E. destruct (Seen i d m E) as [<- Hm].
    split; [apply degree_spec; auto|]. intros j ->. apply find_seq in Hm. lia.
  - intros i k d m K E. destruct (Seen i d m E) as [<- _].
    apply (v_door W L v V) in K. eapply move_door; eauto.
  - intros i a j b d m e n S E E'. apply Same in S. unfold dart in S. simpl in S.
    destruct (Seen i d m E) as [<- _], (Seen j e n E') as [<- _].
    rewrite <- (degree_turn W WW a), <- (degree_turn W WW b (v j)), S; auto.
  - intros i a j b d m e n S E E' ->. apply Same in S. unfold dart in S. simpl in S.
    destruct (Seen i d (Some m) E) as [_ Hm], (Seen j e None E') as [_ Hn].
    apply marker_some in Hm; auto.
    destruct (same_vertex_mark W WW a b (v i) (v j) m) as (x & Hx); auto. congruence.
  - intros i a b d m S E La Lb. apply Same in S. unfold dart in S. simpl in S.
    destruct (Seen i d m E) as [<- _]. apply (turn_eq W WW (v i)); auto.
  - intros p q K S. apply Same in S. apply (link_sound W L v A HW V F) in K.
    apply (alpha_ok W WW) in K; [|apply dart_lt with L; auto]. destruct K as (_ & N & _). auto.
Qed.

(** Claim 10: no world that shows L has an edge from p to q exactly if the fold with that edge is
    inconsistent.
    Not in the paper. *)
Theorem rejection_entailed_iff L p q : valid L p -> valid L q ->
  ((forall W v, world W -> visits W L v -> alpha W (dart W v p) <> Some (dart W v q)) <->
   ~ consistent [(p, q)] L).
Proof.
  intros P Q. split.
  - intros R C. apply consistent_possible in C as (W & v & HW & V & F).
    apply (R W v HW V), F. simpl. auto.
  - intros N W v HW V E. apply N, possible_consistent.
    + intros x y [I|[]]. injection I as <- <-. auto.
    + exists W, v. split; auto. split; auto. intros x y [I|[]]. injection I as <- <-. auto.
Qed.

(** Claim 10: every world that shows L has an edge from p to q exactly if the fold of L alone
    makes p and q partners.
    Not in the paper. *)
Theorem confirmation_entailed_iff L p q : consistent nothing L -> valid L p -> valid L q ->
  ((forall W v, world W -> visits W L v -> alpha W (dart W v p) = Some (dart W v q)) <->
   exists p' q', link nothing L p' q' /\ same nothing L p p' /\ same nothing L q q').
Proof.
  intros C P Q. split.
  - intros R. destruct (quotient_exists L nothing C) as (M & u & Qu).
    assert (WM := q_map _ _ _ _ Qu). assert (CM := q_connected _ _ _ _ Qu).
    assert (Lt := v_lt M L u (q_visits _ _ _ _ Qu)).
    assert (Ld : forall x, dart M u x < darts M) by (intros x; apply turn_lt; auto).
    destruct (hang_leaves (darts M) M WM CM) as (W & HW & E & _ & O); [lia|].
    destruct (embedded_visits M W L u WM (world_is_map W HW) E (q_visits _ _ _ _ Qu)) as [V D].
    specialize (R W u HW V). rewrite !D in R.
    destruct (alpha M (dart M u p)) as [x|] eqn:Ex.
    + destruct (q_link _ _ _ _ Qu p P) as (p' & q' & K & S & Eq); [congruence|].
      exists p', q'. split; auto. split; auto. apply (q_same _ _ _ _ Qu); auto.
      * eapply link_valid, link_sym; eauto.
      * rewrite Ex in Eq. injection Eq as <-. apply (phi_alpha M W id E) in Ex; auto.
        unfold id in Ex. congruence.
    + destruct (O (dart M u p) (Ld p) Ex) as (x & Hx & Lx). specialize (Ld q).
      assert (x = dart M u q) by congruence. lia.
  - intros (p1 & q1 & K & S & S1) W v HW V.
    apply (same_sound W L v nothing HW V (fits_nothing W v)) in S, S1. rewrite S, S1.
    apply (link_sound W L v nothing HW V (fits_nothing W v)); auto.
Qed.

(** Claim 9: a log that some world shows is closed or undetermined.
    Not in the paper. *)
Theorem closed_or_undetermined W L : world W -> replays W L -> closed L \/ undetermined L.
Proof.
  intros HW R. apply replays_visits in R as [v V]; [|apply HW].
  assert (C : consistent nothing L).
  { apply possible_consistent; [intros p q []|]. exists W, v. split; auto. split; auto. intros p q []. }
  destruct (quotient_exists L nothing C) as (M & u & Q).
  destruct (open_or_closed M) as [(e & He & Oe)|T].
  - right. apply (open_undetermined M L e); auto; try apply Q.
    apply (visits_replays M L u), Q.
  - left. intros p P. destruct (q_link _ _ _ _ Q p P) as (q & r & K & S & _); [|eauto].
    apply T, turn_lt; [apply Q|]. apply (v_lt M L u (q_visits _ _ _ _ Q)).
Qed.

(** Claim 9: a log is closed exactly if all worlds that show it are isomorphic.
    Not in the paper. *)
Theorem closed_iff_determined W L : world W -> replays W L ->
  (closed L <-> forall W', world W' -> replays W' L -> isomorphic W W').
Proof.
  intros HW R. split; [intros C W' HW' R'; apply (closed_determines L); auto|].
  intros H. destruct (closed_or_undetermined W L HW R) as [C|(W1 & W2 & H1 & H2 & R1 & R2 & N)]; auto.
  destruct N. destruct (H W1 H1 R1) as [<- _], (H W2 H2 R2) as [<- _]. auto.
Qed.
