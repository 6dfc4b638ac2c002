(** Rejection without motion by the rules history and records (docs/semantics.md, section 7; claim
    3).

    M is the map, W the world, phi their correspondence. T is the table of records: T d w is what
    was seen behind the open dart d after the further relative doors w. Rule [prefix] compares fewer
    percepts than [history], so what is proved of [history] holds for it.

    The theorems: true records never reject a true hypothesis, and records stay true. *)
From Coq Require Import Arith Lia List Bool.
Import ListNotations.
From Topo Require Import World Rotation Embedding Augment.

(** A table of records: for a dart and relative doors, the percept seen there, if there was one. *)
Definition table := nat -> list nat -> option Percept.

(** Every record of T agrees with the world. *)
Definition true_table M W phi (T : table) := forall d w q, d < darts M -> T d w = Some q ->
  exists b c, alpha W (phi d) = Some b /\ walk W b w = Some c /\ percept W c = q.

(** The percepts ps were seen behind one open dart, the first after the doors u, the next ones
    after each further door of w: do they agree with its records t? The comparison stops where
    there is no record. *)
Fixpoint deeper (t : list nat -> option Percept) u w ps : bool :=
  match t u, ps with
  | Some q, p :: ps => percept_eqb q p &&
                       match w with k :: w => deeper t (u ++ [k]) w ps | [] => true end
  | _, _ => true
  end.

(** Trace the doors w on the map from dart h: do the percepts ps agree with the map, and behind
    an open dart with its records? *)
Fixpoint agrees M (T : table) h w ps : bool :=
  match w, ps with
  | k :: w, p :: ps' =>
      (k <? degree M h) &&
      match alpha M (turn M k h) with
      | Some x => percept_eqb (percept M x) p && agrees M T x w ps'
      | None => deeper (T (turn M k h)) [] w ps
      end
  | _, _ => true
  end.

Section Rules.
Variables (M W : Map) (phi : nat -> nat) (T : table).
Hypotheses (WM : is_map M) (WW : is_map W) (E : embedded M W phi) (HT : true_table M W phi T).

(** Percepts that the world shows behind an open dart agree with true records of it. *)
Lemma deeper_true d : d < darts M -> forall w u b c ps, alpha W (phi d) = Some b ->
  walk W b u = Some c -> percepts W c w = Some ps -> deeper (T d) u w (percept W c :: ps) = true.
Proof.
  intros Hd w. induction w as [|k w IH]; simpl; intros u b c ps Hb Hc Hw;
    destruct (T d u) as [q|] eqn:Hq; auto.
  all: assert (q = percept W c) as ->
         by (destruct (HT d u q Hd Hq) as (b' & c' & B & C & <-); congruence).
  all: destruct (percept_eqb_spec (percept W c) (percept W c)) as [_|N]; [simpl|destruct N; auto]; auto.
  destruct (move W c k) as [c'|] eqn:Em; [|discriminate].
  destruct (percepts W c' w) as [qs|] eqn:Eq; [|discriminate]. injection Hw as <-.
  apply IH with b; auto. rewrite walk_app, Hc. simpl. rewrite Em. auto.
Qed.

(** Claim 3: rules history and records, hence prefix, never reject the true hypothesis.
    Paper, III-B: Tracing stops at an unexplored edge. *)
Theorem agrees_true w : forall h ps, h < darts M ->
  percepts W (phi h) w = Some ps -> agrees M T h w ps = true.
Proof.
  induction w as [|k w IH]; simpl; intros h ps Hh Hw; auto.
  destruct (move W (phi h) k) as [b|] eqn:Em; [|discriminate].
  destruct (percepts W b w) as [qs|] eqn:Eq; [|discriminate]. injection Hw as <-.
  unfold move in Em. rewrite (embedded_degree M W phi) in Em by auto.
  destruct (k <? degree M h) eqn:Ek; [|discriminate]. simpl.
  rewrite <- (embedded_turn M W phi) in Em by auto.
  assert (L : turn M k h < darts M) by (apply turn_lt; auto).
  destruct (alpha M (turn M k h)) as [x|] eqn:Ex.
  - assert (Hx : x < darts M) by (eapply alpha_ok; eauto).
    apply (phi_alpha _ _ _ E) in Ex; auto. replace b with (phi x) in * by congruence.
    rewrite (percept_agree M W phi) by auto.
    destruct (percept_eqb_spec (percept M x) (percept M x)) as [_|N]; [simpl; auto|destruct N; auto].
  - apply deeper_true with b; auto.
Qed.

(** A record made after validation is true. The doors executed from a known dart n lead on the
    map to x and there through the open dart turn k x; what was seen at their end is a record of
    that dart.
    Paper, III-C: After e is validated, what was seen behind unexplored edges is recorded. *)
Theorem record_true n u k v x c : n < darts M -> walk M n u = Some x ->
  walk W (phi n) (u ++ k :: v) = Some c ->
  exists b, alpha W (phi (turn M k x)) = Some b /\ walk W b v = Some c.
Proof.
  intros Hn Hu Hw. rewrite walk_app, (forward_walk M W phi WM WW E u n x) in Hw by auto.
  assert (Hx : x < darts M) by (eapply walk_lt; eauto). simpl in Hw.
  destruct (move W (phi x) k) as [b|] eqn:Em; [|discriminate]. exists b. split; auto.
  unfold move in Em. rewrite (embedded_turn M W phi) by auto.
  destruct (k <? degree W (phi x)); [auto|discriminate].
Qed.
End Rules.

(** Records stay true when a vertex is added, since each is relative to a known dart. *)
Theorem records_new M W phi T e d a : true_table M W phi T ->
  (forall x w, darts M <= x -> T x w = None) ->
  true_table (augment_new M e d) W (extend phi (darts M) W a) T.
Proof.
  intros HT Out x w q _ Hq. unfold extend. destruct (Nat.ltb_spec x (darts M)) as [L|L].
  - apply HT; auto.
  - rewrite Out in Hq by auto. discriminate.
Qed.
