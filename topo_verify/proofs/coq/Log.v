(** Logs without a world: folding and its contradictions (docs/semantics.md, section 11).

    A log L is the percept at the start and a list of doors with the percepts behind them. Visit 0
    is the start, visit i comes after i moves. A place p, q, r is a pair (visit, offset): a dart of
    the visited vertex, counted from the reference dart of the visit. A is a list of assumed edges.
    W is a world, v i the reference dart of visit i in it.

    [same] is the least set of identifications that the log and A force. SCEPTICS READ [Log] and
    [replays], and for claim 10 [visits], [dart] and [possible]. *)
From Coq Require Import Arith Lia List Bool.
Import ListNotations.
From Topo Require Import World Rotation.

(** A log: the percept at the start, then doors and the percepts behind them. *)
Record Log := { start : Percept; moves : list (nat * Percept) }.

(** The percept of visit i. *)
Definition seen L i := nth_error (start L :: map snd (moves L)) i.

(** The door taken from visit i; None after the last move. *)
Definition door L i := nth_error (map fst (moves L)) i.

(** The log as it was after i moves. *)
Definition cut L i := {| start := start L; moves := firstn i (moves L) |}.

(** Claims 1 and 9: the world shows this log. A robot that starts at the root and takes these
    doors senses these percepts. *)
Definition replays W L := percept W (root W) = start L /\
  percepts W (root W) (map fst (moves L)) = Some (map snd (moves L)).

(** v gives each visit its reference dart in W: the root at the start, the percepts of the log,
    and the moves of the world by the doors of the log. *)
Record visits W L (v : nat -> nat) : Prop := {
  v_lt : forall i, v i < darts W;
  v_0 : v 0 = root W;
  v_seen : forall i p, seen L i = Some p -> percept W (v i) = p;
  v_door : forall i k, door L i = Some k -> move W (v i) k = Some (v (S i)) }.

(** If a world shows a log, each visit has a reference dart. *)
Lemma replays_visits W L : is_map W -> replays W L -> exists v, visits W L v.
Proof.
  intros WW [Hs Hp]. cut (forall ms a, a < darts W ->
    percepts W a (map fst ms) = Some (map snd ms) -> exists v, (forall i, v i < darts W) /\ v 0 = a /\
    (forall i p, nth_error (map snd ms) i = Some p -> percept W (v (S i)) = p) /\
    (forall i k, nth_error (map fst ms) i = Some k -> move W (v i) k = Some (v (S i)))).
  { intros H. destruct (H _ _ (root_lt W WW) Hp) as (v & A & B & C & D).
    exists v. split; auto. intros [|i] p Hi; [|apply C; auto].
    injection Hi as <-. rewrite B. auto. }
  clear - WW. intros ms. induction ms as [|(k, p) ms IH]; simpl; intros a Ha H.
  - exists (fun _ => a). repeat split; auto; intros [|i] ? E; discriminate.
  - destruct (move W a k) as [b|] eqn:Em; [|discriminate].
    destruct (percepts W b (map fst ms)) as [ps|] eqn:Ep; [|discriminate].
    injection H as H1 H2. destruct (IH b) as (v & A & B & C & D).
    + eapply move_lt; eauto.
    + congruence.
    + exists (fun i => match i with 0 => a | S i => v i end). repeat split.
      * intros [|i]; auto.
      * intros [|i] q E; [injection E as <-; rewrite B; auto|apply C; auto].
      * intros [|i] q E; [injection E as <-; rewrite B; auto|apply D; auto].
Qed.

(** If each visit has a reference dart, the world shows the log. *)
Lemma visits_replays M L v : visits M L v -> replays M L.
Proof.
  intros V. split; [rewrite <- (v_0 M L v V); apply (v_seen M L v V); auto|].
  rewrite <- (v_0 M L v V).
  assert (A := fun i p => v_seen M L v V (S i) p). assert (B := v_door M L v V).
  unfold seen, door in *. simpl in A. clear V. revert v A B.
  induction (moves L) as [|(k, p) ms IH]; simpl; auto. intros v A B.
  rewrite (B 0 k) by auto. rewrite (A 0 p) by auto.
  rewrite (IH (fun i => v (S i))); auto.
Qed.

(** A place: a visit, and an offset from its reference dart. *)
Definition place := (nat * nat)%type.

(** The visit of p is one of the log. *)
Definition valid L (p : place) := seen L (fst p) <> None.

(** Edges that are assumed, each as the pair of its places. *)
Definition assumed_edges := list (place * place).

(** No edge is assumed. *)
Definition nothing : assumed_edges := [].

(** p and q are the two darts of an edge that was crossed or is assumed. *)
Inductive link (A : assumed_edges) L : place -> place -> Prop :=
| link_out i k : door L i = Some k -> link A L (i, k) (S i, 0)
| link_back i k : door L i = Some k -> link A L (S i, 0) (i, k)
| link_assumed p q : In (p, q) A -> valid L p -> valid L q -> link A L p q
| link_assumed_back p q : In (p, q) A -> valid L p -> valid L q -> link A L q p.

(** The forced identifications: the least equivalence that is closed under turning, under full
    turns, under the marker, and under partners of one dart. *)
Inductive same (A : assumed_edges) L : place -> place -> Prop :=
| same_refl p : same A L p p
| same_sym p q : same A L p q -> same A L q p
| same_trans p q r : same A L p q -> same A L q r -> same A L p r
| same_turn k i a j b : same A L (i, a) (j, b) -> same A L (i, k + a) (j, k + b)
| same_full i d m : seen L i = Some (d, m) -> same A L (i, d) (i, 0)
| same_mark i d j : seen L i = Some (d, Some j) -> same A L (i, j) (0, 0)
| same_link p q p' q' : link A L p q -> link A L p' q' -> same A L p p' -> same A L q q'.

(** The log is closed: each place is identified with an end of an edge that was crossed, so no
    dart is open. *)
Definition closed L :=
  forall p, valid L p -> exists q r, link nothing L q r /\ same nothing L p q.

(** The dart of the world at place p. *)
Definition dart W v (p : place) := turn W (snd p) (v (fst p)).

(** The assumed edges are edges of the world. *)
Definition fits W v (A : assumed_edges) :=
  forall p q, In (p, q) A -> alpha W (dart W v p) = Some (dart W v q).

(** [link] is symmetric. *)
Lemma link_sym A L p q : link A L p q -> link A L q p.
Proof. intros []; auto using link_out, link_back, link_assumed, link_assumed_back. Qed.

(** The ends of a link are places of the log. *)
Lemma link_valid A L p q : link A L p q -> valid L p.
Proof.
  assert (H : forall i k, door L i = Some k -> seen L i <> None /\ seen L (S i) <> None).
  { unfold door, seen. intros i k E. rewrite !nth_error_Some. simpl.
    assert (i < length (map fst (moves L))) by (apply nth_error_Some; congruence).
    rewrite map_length in *. lia. }
  intros [i k E|i k E|x y _ X _|x y _ _ Y]; auto; unfold valid; simpl; apply (H i k E).
Qed.

(** Offsets count modulo the degree. *)
Lemma same_mod A L i k d m : seen L i = Some (d, m) -> same A L (i, k) (i, k mod d).
Proof.
  intros H. destruct (Nat.eq_dec d 0) as [->|N]; [constructor|].
  rewrite (Nat.div_mod k d N) at 1. induction (k / d) as [|q IH].
  - rewrite Nat.mul_0_r. constructor.
  - apply same_trans with (i, d * q + k mod d); auto.
    replace (d * S q + k mod d) with (d * q + k mod d + d) by lia.
    rewrite <- (Nat.add_0_r (d * q + k mod d)) at 2. apply same_turn, (same_full A L i d m H).
Qed.

(** The fold of L with A has no contradiction (section 11): the marker is at door 0 at the start;
    degrees are positive; every door taken and every direction seen exists; identified visits
    have one degree and see the marker all or none; no vertex is turned against itself; no dart
    is its own partner. *)
Record consistent (A : assumed_edges) L : Prop := {
  c_start : exists d, seen L 0 = Some (d, Some 0);
  c_percept : forall i d m, seen L i = Some (d, m) -> 0 < d /\ forall j, m = Some j -> j < d;
  c_door : forall i k d m, door L i = Some k -> seen L i = Some (d, m) -> k < d;
  c_assumed : forall p q, In (p, q) A -> valid L p /\ valid L q;
  c_degree : forall i a j b d m e n, same A L (i, a) (j, b) ->
             seen L i = Some (d, m) -> seen L j = Some (e, n) -> d = e;
  c_marker : forall i a j b d m e n, same A L (i, a) (j, b) ->
             seen L i = Some (d, Some m) -> seen L j = Some (e, n) -> n <> None;
  c_turn : forall i a b d m, same A L (i, a) (i, b) -> seen L i = Some (d, m) ->
           a < d -> b < d -> a = b;
  c_edge : forall p q, link A L p q -> ~ same A L p q }.

(** Some world shows the log and has the assumed edges. *)
Definition possible (A : assumed_edges) L :=
  exists W v, world W /\ visits W L v /\ fits W v A.
