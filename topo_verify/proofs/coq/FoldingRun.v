(** The map S of the algorithm folding is a part of the fold of its log, and all of it follows from the
    log; the rest of the fold are ghosts (docs/semantics.md, section 8; claims 5, 7, 9 and 10).

    M      the map S                     st       a state: map, dart, robot, memory, trail
    T      what the rule remembers       W, phi   a world, the correspondence of the darts of M
    t      the trail                     ms       the moves that were made, L the log of them
    x, y   darts of M                    p        a program; in [map_in_fold], the dart of the robot

    A mapper is deterministic: in every world that shows it the same log it has done the same, so its
    map, which is right in each, follows from the log ([shown_same]). *)
From Coq Require Import Arith Lia List Bool.
Import ListNotations.
From Topo Require Import World Rotation Embedding Vertices Augment Program Mapper Validation
  MapperCorrect Rules Ways ReferencePolicies Algorithms Log Determined Undetermined Quotient Entailed
  LogFold LogFoldExact FoldingRule Sound Distance LeastCost Strategies AnyMapper.

(** The moves that p made in one world it makes in every world that shows them. *)
Lemma shown_same {A} (p : program A) W W' : forall a a' x b ms, perform W a p = Some (x, b, ms) ->
  percepts W' a' (map fst ms) = Some (map snd ms) -> exists b', perform W' a' p = Some (x, b', ms).
Proof.
  induction p as [y|k g IH|]; simpl; intros a a' x b ms P H; [|destruct (move W a k) as [c|]|];
    try discriminate.
  - injection P as <- _ <-. eauto.
  - destruct (perform W c _) as [((y, d), ns)|] eqn:Q; [|discriminate]. injection P as <- _ <-.
    simpl in H. destruct (move W' a' k) as [c'|]; [|discriminate].
    destruct (percepts W' c' (map fst ns)) as [ps|] eqn:R; [|discriminate]. cbn [option_map] in H.
    assert (percept W' c' = percept W c /\ ps = map snd ns) as [Ec ->] by (split; congruence).
    rewrite Ec. destruct (IH _ _ _ _ _ _ Q R) as (b' & ->). eauto.
Qed.

(** The result of p has a trail: t with the moves that p makes. *)
Definition tells {A} (told : A -> robot_trail) (p : program A) t := forall W a x b ms,
  perform W a p = Some (x, b, ms) -> told x = rev ms ++ t.

(** A result that was there before tells the trail as it was. *)
Lemma tells_return {A} told (x : A) : tells told (Return x) (told x).
Proof. intros W a y b ms E. injection E as <- _ <-. auto. Qed.

(** What is stuck tells nothing. *)
Lemma tells_stuck {A} (told : A -> robot_trail) t : tells told Stuck t.
Proof. intros W a x b ms E. discriminate E. Qed.

(** A program that keeps the trail tells it. *)
Lemma tells_with_trail {A} (p : program A) t : tells snd (with_trail p t) t.
Proof.
  intros W a x b ms E. rewrite perform_with_trail in E.
  destruct (perform W a p) as [((y, c), ns)|]; [|discriminate]. injection E as <- _ <-. auto.
Qed.

(** One program after the other. *)
Lemma tells_bind {A B} (p : program A) (f : A -> program B) told told' t : tells told p t ->
  (forall x, tells told' (f x) (told x)) -> tells told' (bind p f) t.
Proof.
  intros P F W a y c ms E. rewrite perform_bind in E.
  destruct (perform W a p) as [((x, b), ns)|] eqn:Ex; [|discriminate].
  destruct (perform W b (f x)) as [((z, d), os)|] eqn:Ey; [|discriminate]. injection E as <- _ <-.
  rewrite (F x _ _ _ _ _ Ey), (P _ _ _ _ _ Ex), rev_app_distr, app_assoc. auto.
Qed.

Section Rounds.
Variables (pick : Map -> nat -> option nat) (path : Map -> nat -> nat -> list nat * nat)
          (order : Map -> list nat -> list nat) (motion : Motion) (rule : Rule)
          (true_of : Map -> Map -> (nat -> nat) -> robot_trail -> memory rule -> Prop).
Hypotheses (Gpick : good_pick pick) (Gpath : good_path path) (Gorder : good_order order)
           (Gmotion : good_motion motion) (Grule : good_rule rule true_of).

(** The trail of a state. *)
Definition trail_in (st : state rule) := let '(_, _, _, _, t) := st in t.

(** Explore n darts, one after the other, unless none is open before. *)
Fixpoint rounds n (st : state rule) : program (state rule) := match n with
  | 0 => Return st
  | S n => match pick (map_in rule st) (dart_in rule st) with
    | Some e => bind (round path order motion rule st e) (rounds n) | None => Return st end
  end.

(** Validation tells the trail. *)
Lemma test_all_tells M e pu T n : forall log ds qs v t H,
  tells (fun r => snd (snd r)) (test_all motion rule n M e pu T log ds qs v t H) t.
Proof.
  induction n as [|n IH]; intros log ds qs v t H; cbn [test_all].
  - eapply tells_bind; [apply tells_with_trail|]. intros x. apply (tells_return (fun r => snd (snd r))).
  - destruct (find _ _) as [(h, w)|].
    { unfold concluded. destruct (snd (fst v)).
      - apply (tells_return (fun r => snd (snd r))).
      - eapply tells_bind; [apply tells_with_trail|]. intros x.
        apply (tells_return (fun r => snd (snd r))). }
    destruct (motion ds _) as [((h, w), s)|].
    2: { eapply tells_bind; [apply tells_with_trail|]. intros x.
         apply (tells_return (fun r => snd (snd r))). }
    eapply tells_bind; [apply tells_with_trail|]. intros (v1, t1). simpl snd.
    destruct (percepts M h w), (walk M h (firstn s w)), (walk M h w); try apply tells_stuck.
    destruct (_ && _); [|apply IH]. eapply tells_bind; [apply tells_with_trail|].
    intros (((matched, more), v2), t2). simpl snd.
    destruct matched; [apply (tells_return (fun r => snd (snd r)))|apply IH].
Qed.

(** A round tells the trail. *)
Lemma round_tells st e : tells trail_in (round path order motion rule st e) (trail_in st).
Proof.
  destruct st as ((((M, p), v), T), t). unfold round. destruct (path M e p) as (w, k).
  eapply tells_bind; [apply tells_with_trail|]. intros (v1, u). simpl snd.
  eapply tells_bind; [apply test_all_tells|]. intros ((o, log), (v2, t2)). simpl snd.
  destruct o as [(h, x)|]; apply (tells_return trail_in).
Qed.

(** The trail of a state is the moves that were made. *)
Lemma rounds_tells n : forall st, tells trail_in (rounds n st) (trail_in st).
Proof.
  induction n as [|n IH]; intros st; simpl; [apply tells_return|].
  destruct (pick _ _) as [e|]; [|apply tells_return].
  eapply tells_bind; [apply round_tells|exact IH].
Qed.

(** The invariant of exploration holds after each round. *)
Lemma rounds_invariant W (HW : world W) n : forall st b, invariant rule true_of W st b ->
  does W b (rounds n st) (fun st b _ => invariant rule true_of W st b).
Proof.
  induction n as [|n IH]; intros st b I; simpl; [apply does_return; auto|].
  destruct st as ((((M, p), v), T), t). simpl. assert (G := Gpick M p).
  destruct (pick M p) as [e|]; [|apply does_return; auto]. destruct G as [He Oe].
  eapply does_bind; [apply (round_spec path order motion rule true_of) with (e := e); eauto|].
  intros st' b' k (I' & _). apply (IH st' b' I').
Qed.

(** The trail after some rounds lists all moves; and in every world that shows these moves the invariant
    holds after them, with the same state: S is embedded in each, so what was built follows from the log.
    Not in the paper. *)
Theorem rounds_entailed W n st b ms : world W ->
  perform W (root W) (rounds n (initial_state rule (percept W (root W)))) = Some (st, b, ms) ->
  rev ms = trail_in st /\
  forall W', world W' -> replays W' {| start := percept W (root W); moves := ms |} ->
    exists b', invariant rule true_of W' st b'.
Proof.
  intros HW P. split.
  - rewrite (rounds_tells _ _ _ _ _ _ _ P). simpl. symmetry. apply app_nil_r.
  - intros W' HW' [Rs Rm]. simpl in Rs, Rm. destruct (shown_same _ _ _ _ _ _ _ _ P Rm) as (b' & P').
    assert (I := initial_invariant rule true_of Grule W' HW'). rewrite Rs in I.
    destruct (rounds_invariant W' HW' n _ _ I) as (st' & b2 & ms' & P2 & I2).
    rewrite P' in P2. injection P2 as <- <- <-. eauto.
Qed.
End Rounds.

(** Places that are one dart in all worlds that show a log are one in its fold. *)
Lemma same_everywhere L p q : possible nothing L -> valid L p -> valid L q ->
  (forall W v, world W -> visits W L v -> dart W v p = dart W v q) -> same nothing L p q.
Proof.
  intros S P Q All. destruct (quotient_exists L nothing (plain L S)) as (M & u & Qu).
  assert (WM := q_map _ _ _ _ Qu).
  destruct (hang_leaves (darts M) M WM (q_connected _ _ _ _ Qu)) as (W & HW & E & _); [lia|].
  destruct (embedded_visits M W L u WM (world_is_map W HW) E (q_visits _ _ _ _ Qu)) as [V D].
  apply (q_same _ _ _ _ Qu); auto. rewrite <- !D. auto.
Qed.

Section Folding.
Variables (pick : Map -> nat -> option nat) (path : Map -> nat -> nat -> list nat * nat)
          (order : Map -> list nat -> list nat).
Hypotheses (Gpick : good_pick pick) (Gpath : good_path path) (Gorder : good_order order).
Variables (W : Map) (n : nat) (M : Map) (p : nat) (v : robot) (T : places) (t : robot_trail) (b : nat)
          (ms : list (nat * Percept)).
Hypothesis HW : world W.

(** In the world W, after n rounds, the algorithm folding has this state, and has made these moves. *)
Hypothesis Ran :
  perform W (root W) (rounds pick path order overlap rule_folding n
    (initial_state rule_folding (percept W (root W)))) = Some ((M, p, v, T, t), b, ms).
Let L := {| start := percept W (root W); moves := ms |}.

(** The log of the trail is the log of all moves; and in every world that shows it S is embedded, each
    dart at its place. *)
Lemma placed : is_map M /\ log_of M t = L /\ possible nothing L /\
  forall W' u, world W' -> visits W' L u -> exists phi, embedded M W' phi /\ true_places M W' phi t T /\
  forall x, x < darts M -> valid L (place_seen T x) /\ dart W' u (place_seen T x) = phi x.
Proof.
  destruct (rounds_entailed pick path order overlap rule_folding true_places Gpick Gpath Gorder
    overlap_good rule_folding_good W n _ b ms HW Ran) as [Et All].
  simpl trail_in in Et. subst t. assert (Log : is_map M -> forall W' phi, world W' ->
    embedded M W' phi -> replays W' L -> log_of M (rev ms) = L).
  { intros WM W' phi HW' E [Rs _]. rewrite (log_start M W' phi), rev_involutive; auto.
    unfold L. f_equal. exact Rs. }
  assert (R : replays W L).
  { destruct (perform_moves _ _ _ _ _ _ Ran) as [_ R]. split; auto. }
  destruct (All W HW R) as (c & WM & _ & _ & _ & phi & E & _).
  assert (EL := Log WM W phi HW E R). split; auto. split; auto. split.
  { destruct (replays_visits W L (world_is_map W HW) R) as [u V]. exists W, u. auto using fits_nothing. }
  intros W' u HW' V. assert (R' := visits_replays W' L u V).
  destruct (All W' HW' R') as (c' & _ & _ & _ & _ & psi & E' & HT & _).
  exists psi. split; auto. split; auto. intros x Lx. rewrite <- EL. split.
  - apply (place_valid M W' psi T (rev ms)); auto. apply later_refl.
  - apply HT; auto. rewrite EL. auto.
Qed.

(** S is a part of the fold of the log: the places of its darts are different darts of the fold, turned
    and joined in the fold as in S, from the marker on. What else the log shows are the ghosts.
    Not in the paper. *)
Theorem map_in_fold : log_of M t = L /\
  (forall x y, x < darts M -> y < darts M ->
    same nothing L (place_seen T x) (place_seen T y) -> x = y) /\
  (forall x, x < darts M -> let (i, k) := place_seen T x in
    same nothing L (place_seen T (sigma M x)) (i, S k)) /\
  (forall x y, x < darts M -> alpha M x = Some y ->
    partners L (fold_of L) (place_seen T x) (place_seen T y) = true) /\
  same nothing L (place_seen T (root M)) (0, 0).
Proof.
  destruct placed as (WM & EL & S & All). split; auto. assert (S' := S).
  destruct S' as (W0 & u & HW0 & V & _). destruct (All W0 u HW0 V) as (phi & E & _ & At).
  assert (R := root_lt M WM). split; [|split; [|split]].
  - intros x y Lx Ly H. apply (phi_inj _ _ _ E); auto. destruct (At x Lx) as [_ <-], (At y Ly) as [_ <-].
    apply (same_sound W0 L u nothing); auto using fits_nothing.
  - intros x Lx. assert (Ls := sigma_lt M WM x Lx). destruct (place_seen T x) as (i, k) eqn:Ex.
    apply same_everywhere; auto; [apply At; auto| |].
    + destruct (At x Lx) as [P _]. rewrite Ex in P. exact P.
    + intros W' w HW' V'. destruct (All W' w HW' V') as (psi & E' & _ & At').
      rewrite (proj2 (At' _ Ls)), (phi_sigma _ _ _ E') by auto.
      rewrite <- (proj2 (At' x Lx)), Ex. auto.
  - intros x y Lx Exy. assert (Ly : y < darts M) by (apply (alpha_ok M WM) in Exy; tauto).
    apply partners_exact; auto; [apply At; auto..|]. intros W' w HW' V'.
    destruct (All W' w HW' V') as (psi & E' & _ & At').
    rewrite (proj2 (At' x Lx)), (proj2 (At' y Ly)). apply (phi_alpha _ _ _ E'); auto.
  - apply same_everywhere; auto; [apply At; auto|discriminate|]. intros W' w HW' V'.
    destruct (All W' w HW' V') as (psi & E' & _ & At').
    rewrite (proj2 (At' _ R)), (phi_root _ _ _ E'). symmetry. apply (v_0 _ _ _ V').
Qed.

(** A hypothesis that the rule concludes is the only one that it keeps. *)
Lemma concluded_last u c e h g w w' pu log : later t u -> led W u c ->
  e < darts M -> h < darts M -> g < darts M ->
  concludes rule_folding M e pu T log u (h, w) = true ->
  keep rule_folding M e pu T log u (g, w') = true -> g = h.
Proof.
  intros Tu Lu Le Lh Lg C K. destruct placed as (WM & EL & S & All).
  destruct (perform_moves _ _ _ _ _ _ Ran) as [_ R].
  destruct (replays_visits W L (world_is_map W HW)) as [v0 V0]; [split; auto|].
  destruct (All W v0 HW V0) as (phi & E & HT & _).
  destruct (folding_rule_exact M W phi T t u c e h w pu log) as [_ Xh]; auto.
  destruct (folding_rule_exact M W phi T t u c e g w' pu log) as [Xg _]; auto.
  apply Xg in K. destruct K as (W' & x & HW' & V & K).
  rewrite (proj1 Xh C W' x HW' V) in K. injection K as K.
  assert (V' := visits_earlier M W' t u x Tu V). rewrite EL in V'.
  destruct (All W' x HW' V') as (psi & E' & _ & At').
  apply (phi_inj _ _ _ E'); auto. rewrite <- (proj2 (At' g Lg)), <- (proj2 (At' h Lh)). auto.
Qed.
(** Claim 4 for rule folding, as section 8 says it: the rule concludes h exactly if vu is a vertex of S
    in the fold, so that it cannot be new, and h is the only hypothesis that is left.
    Not in the paper. *)
Theorem concluded_iff u c e h w pu log : later t u -> led W u c -> e < darts M -> h < darts M ->
  concludes rule_folding M e pu T log u (h, w) = true <->
  (exists x, x < darts M /\ partners (log_of M u) (fold_of (log_of M u)) (place_seen T e)
    (place_seen T x) = true) /\
  keep rule_folding M e pu T log u (h, w) = true /\
  forall g w', g < darts M -> keep rule_folding M e pu T log u (g, w') = true -> g = h.
Proof.
  intros Tu Lu Le Lh. destruct placed as (WM & EL & S & All).
  destruct (perform_moves _ _ _ _ _ _ Ran) as [_ R].
  destruct (replays_visits W L (world_is_map W HW)) as [v0 V0]; [split; auto|].
  destruct (All W v0 HW V0) as (phi & E & HT & _).
  destruct (led_visits M W phi WM HW E u c Lu) as (x0 & Vx & _).
  assert (Kept : forall x w', x < darts M -> concludes rule_folding M e pu T log u (x, w') = true ->
    keep rule_folding M e pu T log u (x, w') = true).
  { intros x w' Lx C. destruct (folding_rule_exact M W phi T t u c e x w' pu log) as [X Y]; auto.
    apply X. exists W, x0. split; auto. split; auto. apply Y; auto. }
  split.
  - intros C. split; [exists h; auto|]. split; auto. intros g w' Lg K.
    apply (concluded_last u c e h g w w' pu log); auto.
  - intros ((x & Lx & Px) & _ & Only). assert (C : concludes rule_folding M e pu T log u (x, w) = true)
      by exact Px. rewrite (Only x w) in C; auto.
Qed.
End Folding.

(** The algorithm folding as one of all mappers: right in every world, with a log that proves the map,
    and with a cost between LB and the bound of claim 7.
    Not in the paper. *)
Theorem folding_between pick path order : good_pick pick -> good_path path -> good_order order ->
  sound (strategy folding pick path order) /\
  forall W depth up, world W -> breadth_first W depth up -> exists L M m,
  replays W L /\ ends (strategy folding pick path order) L M /\ isomorphic M W /\ closed L /\
  darts W = 2 * m /\
  least_cost W depth up <= length (moves L) <= m * (vertices W + (2 * m - 1) * (2 * (vertices W - 1))).
Proof.
  intros Gp Gw Go. split; [apply strategy_sound|apply between_bounds]; auto using folding_correct.
Qed.

(** The algorithm folding maps every world, with edges or not, within the bound.
    Not in the paper. *)
Theorem folding_mapped : maps_any folding.
Proof. apply any_mapped, folding_correct. Qed.
