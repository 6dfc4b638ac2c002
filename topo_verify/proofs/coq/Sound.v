(** A mapper that is right in every world leaves a closed log in each (claims 7 and 9;
    docs/semantics.md, section 11).

    f is a mapper, L a log, M the map that it delivers, W a world.

    The theorems hold for every deterministic mapper. If it ends with an open dart, there are two
    worlds in which it makes the same moves and delivers the same map, so it is wrong in one of
    them. A mapper that is right in every world therefore pays for a closed log, which costs at
    least one move for each edge. SCEPTICS READ [Strategy], [ends] and [sound]. *)
From Coq Require Import Arith Lia List.
Import ListNotations.
From Topo Require Import World Rotation Log Determined Undetermined Entailed.

(** A deterministic mapper: from the log so far it computes the next door, or the map that it
    delivers. *)
Definition Strategy := Log -> nat + Map.

(** In the worlds that show L, the mapper f takes the doors of L one after the other and then
    delivers M. *)
Definition ends (f : Strategy) L M :=
  (forall i k, door L i = Some k -> f (cut L i) = inl k) /\ f L = inr M.

(** The mapper f is right in every world in which it ends. *)
Definition sound f := forall W L M, world W -> replays W L -> ends f L M -> isomorphic M W.

(** Claim 9: a mapper that is right in every world ends with a closed log in every world.
    Not in the paper. *)
Theorem sound_closed f : sound f ->
  forall W L M, world W -> replays W L -> ends f L M -> closed L.
Proof.
  intros S W L M HW R E.
  destruct (closed_or_undetermined W L HW R) as [C|(W1 & W2 & H1 & H2 & R1 & R2 & N)]; auto.
  destruct N. rewrite <- (proj1 (S W1 L M H1 R1 E)). apply (S W2 L M H2 R2 E).
Qed.

(** Claim 9, the converse: a mapper that ends only with closed logs, and delivers worlds that
    show them, is right in every world.
    Not in the paper. *)
Theorem closed_sound f :
  (forall L M, ends f L M -> closed L /\ world M /\ replays M L) -> sound f.
Proof.
  intros H W L M HW R E. destruct (H L M E) as (C & HM & RM). apply (closed_determines L); auto.
Qed.

(** In a world that shows a closed log, every dart is an end of an edge that was crossed. *)
Lemma closed_crossed W L v b : world W -> visits W L v -> closed L -> b < darts W ->
  exists i k, door L i = Some k /\ (b = turn W k (v i) \/ b = v (S i)).
Proof.
  intros HW V C Hb. destruct (met W L v HW V C b Hb) as (p & P & <-).
  destruct (C p P) as (q & r & K & S).
  apply (same_sound W L v nothing HW V (fits_nothing W v)) in S. rewrite S. clear S.
  destruct K as [i k K|i k K|x y []|x y []]; exists i, k; auto.
Qed.

(** A closed log has at least m moves, where the world has 2 m darts. *)
Lemma closed_cost W L : world W -> replays W L -> closed L -> darts W <= 2 * length (moves L).
Proof.
  intros HW R C.
  apply replays_visits in R as [v V]; [|apply HW]. set (n := length (moves L)).
  set (met_at := map (fun i => v (Datatypes.S i)) (seq 0 n) ++
    map (fun i => turn W (nth i (map fst (moves L)) 0) (v i)) (seq 0 n)).
  replace (2 * n) with (length met_at)
    by (unfold met_at; rewrite app_length, !map_length, seq_length; lia).
  rewrite <- (seq_length (darts W) 0). apply NoDup_incl_length; [apply seq_NoDup|].
  intros b Hb. apply in_seq in Hb.
  destruct (closed_crossed W L v b HW V C) as (i & k & D & B); [lia|].
  assert (I : i < n).
  { unfold n. rewrite <- (map_length fst). apply nth_error_Some. unfold door in D. congruence. }
  apply in_or_app. destruct B as [-> | ->]; [right|left]; apply in_map_iff; exists i.
  - rewrite (nth_error_nth _ _ _ D). split; auto. apply in_seq. lia.
  - split; auto. apply in_seq. lia.
Qed.

(** Claim 7, the lower bound for every mapper that is right in every world: it makes at least m
    moves, where the world has 2 m darts.
    Paper, I, II-B: O(m) is a trivial lower bound. *)
Theorem sound_cost f : sound f -> forall W L M, world W -> replays W L -> ends f L M ->
  darts W <= 2 * length (moves L).
Proof. intros S W L M HW R E. apply closed_cost; auto. eapply sound_closed; eauto. Qed.
