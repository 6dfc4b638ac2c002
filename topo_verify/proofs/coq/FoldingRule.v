(** Rule folding, as the mapper runs it, and the algorithm with it (docs/semantics.md, section 8; claims
    3, 4, 5, 7 and 10).

    M      the map S                    W, phi   a world, the correspondence of the darts of M
    e, h   the open dart, a hypothesis  L        the log: the moves so far, which the trail t lists
    T      what the rule remembers      i, p     a visit of the log, a place of it
    o, u   the trail when the rule learned last, and behind e

    The rule remembers where in the log each dart of S was seen. To judge h it folds the log, and asks
    whether e may lead to h, or must. No world is looked at.

    SCEPTICS READ [place_seen], [log_of], [rule_folding] and [folding], and LogFold.v where they want to
    know how it is computed: [folding_rule_exact] says what it comes to. *)
From Coq Require Import Arith Lia List Bool.
Import ListNotations.
From Topo Require Import World Rotation Embedding Vertices Augment Program Mapper Validation Rules
  Algorithms Log Determined LogFold LogFoldExact.

(** What the rule remembers: darts of S, each with a place where it was seen. *)
Definition places : Type := list (nat * place).

(** The place of dart x. Those of v0 were seen at the start, where the reference dart is dart 0. *)
Definition place_seen (T : places) x := match find (fun r => fst r =? x) T with
  | Some r => snd r | None => (0, x) end.

(** The log of a trail. What was sensed at the start is what S shows there. *)
Definition log_of M (t : robot_trail) := {| start := percept M (root M); moves := rev t |}.

(** What [judge] says of the places of e and a hypothesis in the fold of the log. *)
Definition by_fold (judge : Log -> option (list place * list (place * place)) -> place -> place -> bool)
  M (T : places) e t : hypothesis -> bool :=
  let L := log_of M t in let F := fold_of L in let p := place_seen T e in
  fun c => judge L F p (place_seen T (fst c)).

(** Rule folding: it keeps h if the fold of the log allows that e leads to h, and concludes h if e leads
    to h in the fold. It learns where the darts of vu are seen: from their dart of entry on. *)
Definition rule_folding : Rule :=
  {| memory := places; fresh := [];
     keep := fun M e _ T _ t => by_fold allows M T e t;
     concludes := fun M e _ T _ t => by_fold partners M T e t;
     learn := fun M _ h T _ u =>
       map (fun k => (turn M k h, (length u, k))) (seq 0 (degree M h)) ++ T |}.

(** The algorithm folding. *)
Definition folding : algorithm := (rule_folding, overlap).

(** What the rule remembers is true: each dart of S is at its place, which is one of the log. *)
Definition true_places M W (phi : nat -> nat) t (T : places) := forall x, x < darts M ->
  fst (place_seen T x) <= length t /\
  forall v, visits W (log_of M t) v -> dart W v (place_seen T x) = phi x.

(** A world that shows a longer log shows what came before. *)
Lemma visits_before W L ns v : visits W {| start := start L; moves := moves L ++ ns |} v -> visits W L v.
Proof.
  intros [A B C D]. split; auto; unfold seen, door in *; simpl in *; rewrite ?map_app in *.
  - intros i p E. apply C. destruct i as [|i]; auto. simpl in *.
    rewrite nth_error_app1; auto. apply nth_error_Some. congruence.
  - intros i k E. apply D. rewrite nth_error_app1; auto. apply nth_error_Some. congruence.
Qed.

(** The doors of a log lead to its last visit. *)
Lemma visits_end W L v : visits W L v ->
  walk W (root W) (map fst (moves L)) = Some (v (length (moves L))).
Proof.
  intros V. rewrite <- (v_0 W L v V). assert (D := v_door W L v V). unfold door in D. clear V.
  revert v D. induction (moves L) as [|(k, q) ms IH]; simpl; intros v D; auto.
  rewrite (D 0 k eq_refl). apply (IH (fun i => v (S i))). intros i j E. apply (D (S i) j E).
Qed.

(** What was learned last is looked up first. *)
Lemma place_seen_app l T x : place_seen (l ++ T) x = match find (fun r => fst r =? x) l with
  | Some r => snd r | None => place_seen T x end.
Proof.
  unfold place_seen. induction l as [|r l IH]; simpl; auto. destruct (fst r =? x); auto.
Qed.

Section Places.
Variables (M W : Map) (phi : nat -> nat).
Hypotheses (WM : is_map M) (HW : world W) (E : embedded M W phi).
Let WW : is_map W := world_is_map W HW.

(** The start of the log is what the world shows. *)
Lemma log_start t : log_of M t = {| start := percept W (root W); moves := rev t |}.
Proof.
  unfold log_of. rewrite <- (phi_root _ _ _ E), (percept_agree M W phi); auto. apply (root_lt M WM).
Qed.

(** A trail that led to b shows a log; its last visit is b. *)
Lemma led_visits t b : led W t b -> exists v, visits W (log_of M t) v /\ v (length t) = b.
Proof.
  intros [L1 L2]. rewrite log_start.
  destruct (replays_visits W {| start := percept W (root W); moves := rev t |} WW) as [v V];
    [split; auto|].
  exists v. split; auto. apply visits_end in V. simpl in V. rewrite rev_length in V. congruence.
Qed.

(** A place of the log up to now is one of the log. *)
Lemma place_valid T o t x : true_places M W phi o T -> later o t -> x < darts M ->
  valid (log_of M t) (place_seen T x).
Proof.
  intros HT [l ->] Lx. destruct (HT x Lx) as [Le _].
  unfold valid, seen. apply nth_error_Some. simpl. rewrite map_length, rev_length, app_length. lia.
Qed.

(** A world that shows the log now shows the log as it was. *)
Lemma visits_earlier o t v : later o t -> visits W (log_of M t) v -> visits W (log_of M o) v.
Proof.
  intros [l ->] V. apply (visits_before W (log_of M o) (rev l)). simpl. rewrite <- rev_app_distr. auto.
Qed.

(** In a grown map the places stay true, and those of the darts of vu are true. *)
Lemma places_grow N psi T o u t h : embedded N W psi -> is_map N ->
  (forall x, x < darts M -> psi x = phi x) -> true_places M W phi o T -> later o u -> later u t ->
  h < darts N -> led W u (psi h) ->
  (forall x, darts M <= x < darts N -> exists k, turn W k (psi h) = psi x) ->
  true_places N W psi t (learn rule_folding N 0 h T [] u).
Proof.
  intros EN WN Same HT Ou Ut Lh Led New x Lx.
  assert (Start : forall t, log_of N t = log_of M t).
  { intros r. rewrite log_start. unfold log_of.
    rewrite <- (phi_root _ _ _ EN), (percept_agree N W psi); auto. apply (root_lt N WN). }
  assert (Len : length o <= length u /\ length u <= length t)
    by (destruct Ou as [l ->], Ut as [j ->]; rewrite !app_length; lia).
  rewrite Start. simpl learn. rewrite place_seen_app. destruct (find _ _) as [(y, p)|] eqn:F.
  - apply find_some in F as [I Ey]. apply Nat.eqb_eq in Ey. simpl in Ey. subst y.
    apply in_map_iff in I as (k & Ek & _). injection Ek as <- <-. simpl. split; [lia|]. intros v V.
    apply (visits_earlier u t v Ut), visits_end in V. simpl in V. rewrite rev_length in V.
    unfold dart. simpl. rewrite (embedded_turn N W psi) by auto. destruct Led as [Led _]. congruence.
  - destruct (Nat.lt_ge_cases x (darts M)) as [Old|Young].
    + destruct (HT x Old) as [Le H]. split; [lia|]. intros v V. rewrite Same by auto. apply H.
      apply (visits_earlier o t); auto. destruct Ou as [l ->], Ut as [j ->]. exists (j ++ l).
      apply app_assoc.
    + destruct (New x) as [k Ek]; auto. destruct (degree_spec N WN h Lh) as (D & _).
      assert (Below : k mod degree N h < degree N h) by (apply Nat.mod_upper_bound; lia).
      assert (Q := find_none _ _ F (turn N (k mod degree N h) h, (length u, k mod degree N h))).
      simpl in Q. rewrite (proj2 (Nat.eqb_eq _ _)) in Q.
      * discriminate Q. apply in_map_iff. eexists. split; [reflexivity|]. apply in_seq. lia.
      * rewrite (turn_mod N WN) by auto. apply (phi_inj _ _ _ EN); auto using turn_lt.
        rewrite (embedded_turn N W psi); auto.
Qed.
End Places.

(** Claim 10 for rule folding, wherever the mapper asks it: it keeps h exactly if e leads to h in some
    world that shows the log, and concludes h exactly if e leads to h in all of them. The log is the
    whole history: all moves since the start. So the rule rejects exactly what no world allows.
    Not in the paper. *)
Theorem folding_rule_exact M W phi T o t b e h w pu log : world W -> is_map M -> embedded M W phi ->
  true_places M W phi o T -> later o t -> led W t b -> e < darts M -> h < darts M ->
  let L := log_of M t in let p := place_seen T e in let q := place_seen T h in
  (keep rule_folding M e pu T log t (h, w) = true <->
    exists W' v, world W' /\ visits W' L v /\ alpha W' (dart W' v p) = Some (dart W' v q)) /\
  (concludes rule_folding M e pu T log t (h, w) = true <->
    forall W' v, world W' -> visits W' L v -> alpha W' (dart W' v p) = Some (dart W' v q)).
Proof.
  intros HW WM E HT Ot Lt Le Lh L p q. destruct (led_visits M W phi WM HW E t b Lt) as (v & V & _).
  assert (P := place_valid M W phi T o t e HT Ot Le). assert (Q := place_valid M W phi T o t h HT Ot Lh).
  assert (S : possible nothing (log_of M t)) by (exists W, v; auto using fits_nothing).
  split; [apply allows_exact|apply partners_exact]; auto.
Qed.

(** Claims 3 and 4 for rule folding: it rejects only false hypotheses, and concludes only true ones.
    Not in the paper. *)
Theorem rule_folding_good : good_rule rule_folding true_places.
Proof.
  assert (Exact : forall M W phi T e log o t b h w pu, world W -> is_map M -> embedded M W phi ->
    true_places M W phi o T -> later o t -> led W t b -> e < darts M -> h < darts M ->
    (alpha W (phi e) = Some (phi h) -> keep rule_folding M e pu T log t (h, w) = true) /\
    (concludes rule_folding M e pu T log t (h, w) = true -> alpha W (phi e) = Some (phi h))).
  { intros M W phi T e log o t b h w pu HW WM E HT Ot Lt Le Lh.
    destruct (folding_rule_exact M W phi T o t b e h w pu log) as [K C]; auto.
    destruct (led_visits M W phi WM HW E t b Lt) as (v & V & _).
    assert (V' := visits_earlier M W o t v Ot V).
    rewrite K, C, <- (proj2 (HT e Le) v V'), <- (proj2 (HT h Lh) v V').
    split; [intros A; exists W, v; auto|auto]. }
  split.
  - intros W phi d HW WM E x Lx. simpl in Lx. split; simpl; auto. intros v V. unfold dart. simpl.
    rewrite (v_0 _ _ _ V), <- (phi_root _ _ _ E). assert (R := root_lt _ WM).
    rewrite <- (embedded_turn _ _ _ WM E) by auto. f_equal. clear - Lx.
    induction x as [|x IH]; auto. cbn [turn]. rewrite IH by lia. simpl. unfold grow.
    destruct (Nat.ltb_spec (S x) (0 + d)); simpl; lia.
  - intros M W phi T e log o t b h w r HW WM E HT Ot Lt Le _ Lh A _ _.
    apply (Exact M W phi T e log o t b h w (percept M h)); auto.
  - intros M W phi T e log o t a b h w HW WM E HT Ot Lt Le _ Lh A C.
    apply (Exact M W phi T e log o t b h w (percept W a)) in C; auto. congruence.
  - intros M W phi T e h log o u t HW WM E HT Ou Lu Ut Le Lh Oe Oh E' WM' _.
    apply (places_grow M W phi WM HW E _ phi T o u t h); auto. simpl. lia.
  - intros M W phi T e a log o u t HW WM E HT Ou Lu Ut Le Oe Ha N psi EN WN _.
    assert (WW := world_is_map W HW).
    assert (La : a < darts W) by (apply (alpha_ok W WW) in Ha; [apply Ha|apply (phi_lt _ _ _ E); auto]).
    destruct (degree_spec W WW a La) as (D & _).
    assert (Eh : psi (darts M) = a) by (unfold psi, extend; rewrite Nat.ltb_irrefl, Nat.sub_diag; auto).
    apply (places_grow M W phi WM HW E N psi T o u t); auto; try rewrite Eh; auto.
    + intros x Lx. unfold psi, extend. rewrite (proj2 (Nat.ltb_lt _ _) Lx). auto.
    + unfold N. simpl. lia.
    + intros x Lx. exists (x - darts M). unfold psi, extend.
      destruct (Nat.ltb_spec x (darts M)); auto. lia.
Qed.

(** Claims 5 and 7 for the algorithm folding: it maps every world within the bound, with all policies.
    Not in the paper. *)
Theorem folding_correct : maps_all folding.
Proof. apply (cost_within_bound folding _ rule_folding_good overlap_good). Qed.
