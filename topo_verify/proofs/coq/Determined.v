(** A closed log proves the map: all worlds that show it are isomorphic (claim 9; docs/semantics.md,
    section 11).

    L is a log, W and W' worlds that show it, v i the reference dart of visit i, A the assumed
    edges, p and q places, b a dart.

    [same_sound]: identified places are one dart in every world that shows the log.
    [same_complete]: if the log is closed, places that are one dart in some world are identified.
    The reason is that the fold is a covering with one copy of v0, since every visit of v0 saw
    the marker. *)
From Coq Require Import Arith Lia List Bool.
Import ListNotations.
From Topo Require Import World Rotation Embedding Augment Log.

(** Every world fits the empty list of assumed edges. *)
Lemma fits_nothing W v : fits W v nothing.
Proof. intros p q []. Qed.

Section Sound.
Variables (W : Map) (L : Log) (v : nat -> nat) (A : assumed_edges).
Hypotheses (HW : world W) (V : visits W L v) (F : fits W v A).
Let WW := world_is_map W HW.

(** The dart of a place is a dart of the world. *)
Lemma dart_lt p : dart W v p < darts W.
Proof. apply turn_lt; [apply WW|apply V]. Qed.

(** Linked places are the two darts of an edge of the world. *)
Lemma link_sound p q : link A L p q -> alpha W (dart W v p) = Some (dart W v q).
Proof.
  assert (H : forall i k, door L i = Some k -> alpha W (dart W v (i, k)) = Some (dart W v (S i, 0))).
  { intros i k E. apply (v_door W L v V) in E. unfold move in E.
    destruct (_ <? _); [auto|discriminate]. }
  intros [i k E|i k E|x y X _ _|x y X _ _]; auto; apply (alpha_ok W WW); auto using dart_lt.
Qed.

(** A full turn does not change the dart. *)
Lemma full_sound i d m k : seen L i = Some (d, m) -> dart W v (i, d + k) = dart W v (i, k).
Proof.
  intros E. apply (v_seen W L v V) in E. injection E as <- _. unfold dart; simpl.
  rewrite Nat.add_comm, turn_add. f_equal. apply degree_spec; [apply WW|apply V].
Qed.

(** Identified places are one dart in every world that shows the log and has the assumed edges. *)
Theorem same_sound p q : same A L p q -> dart W v p = dart W v q.
Proof.
  induction 1 as [p|p q _ IH|p q r _ IH _ IH'|k i a j b _ IH|i d m E|i d j E
                 |p q p' q' B C _ IH]; try congruence; unfold dart in *; simpl in *.
  - rewrite !turn_add. congruence.
  - rewrite <- (Nat.add_0_r d). apply (full_sound i d m 0 E).
  - apply (v_seen W L v V) in E. injection E as _ E. rewrite (v_0 W L v V).
    apply marker_some in E; auto.
  - apply link_sound in B, C. unfold dart in *. congruence.
Qed.

End Sound.

Section Closed.
Variables (W : Map) (L : Log) (v : nat -> nat).
Hypotheses (HW : world W) (V : visits W L v).
Let WW := world_is_map W HW.
Let N := fits_nothing W v.
Notation dart_lt := (dart_lt W L v HW V).
Notation link_sound := (link_sound W L v nothing HW V N).
Notation same_sound := (same_sound W L v nothing HW V N).
Notation full_sound := (full_sound W L v HW V).

(** A place that is the root in the world is identified with the place (0, 0): its visit saw the
    marker. *)
Lemma home p : valid L p -> dart W v p = root W -> same nothing L p (0, 0).
Proof.
  destruct p as (i, k). intros P H. unfold valid in P; simpl in P.
  destruct (seen L i) as [(d, m)|] eqn:E; [clear P|destruct P; auto].
  assert (S := v_seen W L v V i _ E). injection S as Hd Hm.
  assert (Li := v_lt W L v V i). unfold dart in H; simpl in H.
  destruct (degree_spec W WW _ Li) as (D & _).
  rewrite <- (turn_mod W WW) in H by auto.
  assert (B : k mod degree W (v i) < degree W (v i)) by (apply Nat.mod_upper_bound; lia).
  destruct (marker_of W _ _ B H) as [j Hj]. rewrite Hj in Hm.
  assert (J : j < degree W (v i)) by (apply find_seq in Hj as (Hj & _); lia).
  apply marker_some in Hj; auto.
  assert (k mod degree W (v i) = j) by (apply (turn_eq W WW (v i)); auto; congruence).
  apply same_trans with (i, k mod d); [apply (same_mod nothing L i k d m E)|].
  subst. apply (same_mark nothing L i (degree W (v i))). auto.
Qed.

(** From here on the log is closed. *)
Hypothesis C : closed L.

(** If the log is closed, every dart of the world is the dart of a place. *)
Lemma met b : b < darts W -> exists p, valid L p /\ dart W v p = b.
Proof.
  intros Hb. apply (world_connected W HW) in Hb.
  induction Hb as [|b _ ((i, k) & P & <-)|b c _ (p & P & <-) Hc].
  - exists (0, 0). split; [discriminate|apply (v_0 W L v V)].
  - exists (i, S k). auto.
  - destruct (C p P) as (q & r & A & B). exists r.
    split; [eapply link_valid, link_sym; eauto|].
    apply same_sound in B. apply link_sound in A. congruence.
Qed.

(** If the log is closed, places that are one dart are identified. *)
Theorem same_complete p q : valid L p -> valid L q -> dart W v p = dart W v q -> same nothing L p q.
Proof.
  assert (R := world_connected W HW (dart W v q) (dart_lt q)). remember (dart W v q) as b eqn:Hq.
  intros P Q Hp. symmetry in Hq. revert p q P Q Hp Hq.
  induction R as [|b R IH|b c R IH Hc]; intros p q P Q Hp Hq.
  - apply same_trans with (0, 0); [|apply same_sym]; apply home; auto.
  - assert (B : b < darts W) by (apply (reach_sym W (root W) b WW (root_lt W WW) R)).
    assert (H : forall p, valid L p -> dart W v p = sigma W b ->
      exists p', valid L p' /\ dart W v p' = b /\ same nothing L p (fst p', S (snd p'))).
    { clear p q P Q Hp Hq. intros (i, k) P H. destruct (seen L i) as [(d, m)|] eqn:E;
        [clear P|destruct P; auto].
      assert (D : 0 < d).
      { assert (S := v_seen W L v V i _ E). injection S as <- _. apply degree_spec; auto. apply V. }
      assert (Eq : S (d - 1 + k) = d + k) by lia.
      exists (i, d - 1 + k). repeat split.
      - unfold valid; simpl. congruence.
      - apply (sigma_inj W WW); auto using dart_lt. rewrite <- H, <- (full_sound i d m k E), <- Eq. auto.
      - simpl fst; simpl snd. rewrite Eq, Nat.add_comm. apply same_sym.
        rewrite <- (Nat.add_0_r k) at 2. apply same_turn, (same_full nothing L i d m E). }
    destruct (H p P Hp) as ((i, k) & P' & Hp' & Sp), (H q Q Hq) as ((j, l) & Q' & Hq' & Sq).
    apply same_trans with (i, 1 + k); auto. apply same_trans with (j, 1 + l); [|apply same_sym; auto].
    apply same_turn, IH; auto.
  - destruct (C p P) as (p1 & p2 & Lp & Sp), (C q Q) as (q1 & q2 & Lq & Sq).
    apply same_trans with p1; auto. apply same_trans with q1; [|apply same_sym; auto].
    apply (same_link nothing L p2 p1 q2 q1); auto using link_sym.
    assert (B : b < darts W) by (apply (reach_sym W (root W) b WW (root_lt W WW) R)).
    apply (alpha_ok W WW) in Hc as (_ & _ & Hc); auto.
    apply IH; try (eapply link_valid, link_sym; eauto).
    all: apply link_sound in Lp, Lq; apply same_sound in Sp, Sq; congruence.
Qed.
End Closed.

(** Finitely many existential statements have a common choice function. *)
Lemma choice {X} (x0 : X) (R : nat -> X -> Prop) n : (forall b, b < n -> exists x, R b x) ->
  exists f, forall b, b < n -> R b (f b).
Proof.
  induction n as [|n IH]; intros H; [exists (fun _ => x0); lia|].
  destruct IH as [f Hf]; [auto|]. destruct (H n) as [x Hx]; auto.
  exists (fun b => if b =? n then x else f b). intros b Hb.
  destruct (Nat.eqb_spec b n) as [->|]; auto. apply Hf. lia.
Qed.

(** Claim 9: all worlds that show a closed log are isomorphic. *)
Theorem closed_determines L W W' : closed L -> world W -> world W' ->
  replays W L -> replays W' L -> isomorphic W W'.
Proof.
  intros C HW HW' R R'. assert (WW := world_is_map W HW). assert (WW' := world_is_map W' HW').
  apply replays_visits in R as [v V]; auto. apply replays_visits in R' as [v' V']; auto.
  set (rel := fun b x => exists p, valid L p /\ dart W v p = b /\ dart W' v' p = x).
  destruct (choice 0 rel (darts W)) as [phi Hphi].
  { intros b Hb. destruct (met W L v HW V C b Hb) as (p & P & E). exists (dart W' v' p), p. auto. }
  assert (F : forall b x, rel b x -> phi b = x).
  { intros b x (p & P & <- & <-).
    destruct (Hphi (dart W v p) (dart_lt W L v HW V p)) as (q & Q & E & <-).
    apply (same_sound W' L v' nothing HW' V' (fits_nothing W' v')), (same_complete W L v HW V C q
      p); auto. }
  apply (closed_isomorphic W W' phi); auto; [|apply HW'|apply HW]. split.
  - intros d Hd. destruct (Hphi d Hd) as (p & _ & _ & <-). eapply dart_lt; eauto.
  - intros d e Hd He E. destruct (Hphi d Hd) as (p & P & <- & E1), (Hphi e He) as (q & Q & <- & E2).
    apply (same_sound W L v nothing HW V (fits_nothing W v)), (same_complete W' L v' HW' V' C p q);
      auto. congruence.
  - intros d Hd. destruct (Hphi d Hd) as ((i, k) & P & <- & <-).
    apply F. exists (i, S k). auto.
  - intros d e Hd He. destruct (Hphi d Hd) as (p & P & <- & <-).
    destruct (C p P) as (q & r & A & B).
    assert (B' := same_sound W' L v' nothing HW' V' (fits_nothing W' v') p q B).
    apply (same_sound W L v nothing HW V (fits_nothing W v)) in B.
    assert (A' := link_sound W' L v' nothing HW' V' (fits_nothing W' v') q r A).
    assert (K := link_valid nothing L r q (link_sym nothing L q r A)).
    apply (link_sound W L v nothing HW V (fits_nothing W v)) in A.
    rewrite B', A'. f_equal. symmetry. apply F. exists r. split; auto. split; auto. congruence.
  - apply F. exists (0, 0). split; [discriminate|]. split; [apply V|apply V'].
Qed.
