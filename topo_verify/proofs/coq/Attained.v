(** LB is paid: in every world some mapper makes exactly LB moves, and that mapper ends with the right
    map in every world (docs/semantics.md, section 11).

    W0     the given world               L0    the log of its tour, ms the moves of it to come
    W      any world, b a dart of it     t     the trail: all moves since the start
    q      the percept where the robot is        go    what is done from the root in another world

    The mapper takes the doors of the tour as long as it senses what the tour of W0 shows. If it senses
    all of it, the world is W0, since that log proves its map. At the first difference it goes back by
    the moves that it made, and explores as algorithm basic does. *)
From Coq Require Import Arith Lia List Bool.
Import ListNotations.
From Topo Require Import World Rotation Vertices Augment Embedding Program Mapper Validation
  MapperCorrect Rules Ways ReferencePolicies Algorithms Log Determined Sound Distance LeastCost Tour
  Strategies.

(** Follow the moves ms of the tour; at the first difference go back to the root, and on from there. *)
Fixpoint tour_or (go : robot -> robot_trail -> program Map) (W0 : Map) (ms : list (nat * Percept)) t
  : program Map :=
  match ms with
  | [] => Return W0
  | (k, q) :: ms => Leave k (fun p => let t := (k, p) :: t in
      if percept_eqb p q then tour_or go W0 ms t
      else bind (with_trail (undo (p, 0) (map fst t)) t) (fun vt => go (fst vt) (snd vt)))
  end.

(** Explore as basic does, from the root, with this fuel; the robot may have turned. *)
Definition explore_on fuel (v : robot) t :=
  explore nearest way_to shortest retrace rule_none fuel (initial (fst (fst v)), 0, v, tt, t).

(** The mapper for W0 with the log L0: what is sensed at the start is compared, too. *)
Definition tour_mapper (W0 : Map) L0 fuel (q : Percept) : program Map :=
  if percept_eqb q (start L0) then tour_or (explore_on fuel) W0 (moves L0) []
  else explore_on fuel (q, 0) [].

(** Every door of the moves ms is there, if q is sensed where they begin. *)
Fixpoint doors_there (q : Percept) (ms : list (nat * Percept)) := match ms with
  | [] => True | (k, p) :: ms => k < fst q /\ doors_there p ms end.

(** The doors of a log are there. *)
Lemma doors_there_shown W ms : forall a, percepts W a (map fst ms) = Some (map snd ms) ->
  doors_there (percept W a) ms.
Proof.
  induction ms as [|(k, p) ms IH]; simpl; auto. intros a E. unfold move in E.
  destruct (Nat.ltb_spec k (degree W a)) as [L|]; [|discriminate].
  destruct (alpha W (turn W k a)) as [b|]; [|discriminate].
  destruct (percepts W b (map fst ms)) as [ps|] eqn:P; [|discriminate]. injection E as <- Es.
  split; auto. apply IH. congruence.
Qed.

(** From the root exploration ends with the world. *)
Lemma explore_on_right W v t b fuel : world W -> facing W v b (root W) -> led W t b ->
  darts W <= 2 * fuel -> does W b (explore_on fuel v t) (fun M _ _ => isomorphic M W).
Proof.
  intros HW F Lt Lf. assert (WW := world_is_map W HW). assert (R := root_lt W WW).
  destruct (degree_spec W WW _ R) as (A & _). destruct reference_policies_good as (Gp & Gw & Go).
  assert (Lb : b < darts W) by apply F.
  assert (D : fst (fst v) = degree W (root W)).
  { destruct F as (_ & E & _ & <-). rewrite E. simpl. symmetry. apply degree_turn; auto. }
  unfold explore_on. rewrite D. eapply does_weaken.
  - apply (explore_invariant nearest way_to shortest retrace rule_none _ Gp Gw Go retrace_good
      rule_none_good W HW fuel (initial (degree W (root W)), 0, v, tt, t)).
    + refine (conj (is_map_initial _ A) (conj (connected_initial _ A) (conj A (conj Lt
        (ex_intro _ _ (conj (embedded_initial W WW) (conj I _))))))). exact F.
    + lia.
  - simpl. intros M c n [Iso _]. exact Iso.
Qed.

(** The robot that follows the tour of W0 in W ends with W. *)
Lemma tour_or_right W0 L0 W fuel : world W0 -> replays W0 L0 -> closed L0 -> world W ->
  start L0 = percept W (root W) -> darts W <= 2 * fuel -> forall ms t b, led W t b ->
  doors_there (percept W b) ms -> moves L0 = rev t ++ ms ->
  does W b (tour_or (explore_on fuel) W0 ms t) (fun M _ _ => isomorphic M W).
Proof.
  intros H0 R0 C0 HW S Lf. assert (WW := world_is_map W HW). assert (Lr := root_lt W WW).
  intros ms. induction ms as [|(k, q) ms IH]; intros t b Lt D E; cbn [tour_or].
  - apply does_return. apply (closed_determines L0); auto. rewrite app_nil_r in E. split; [auto|].
    rewrite E. apply Lt.
  - destruct D as [Lk D]. simpl in Lk. assert (Lb := walk_lt W WW _ _ _ Lr (proj1 Lt)).
    assert (Lx := turn_lt W WW k b Lb).
    destruct (alpha W (turn W k b)) as [c|] eqn:Ec; [|destruct (world_total W HW _ Lx Ec)].
    assert (M : move W b k = Some c) by (unfold move; rewrite (proj2 (Nat.ltb_lt _ _) Lk); auto).
    assert (Lc := move_lt W WW b k c Lb M). apply does_leave with c; auto.
    cbv zeta. assert (Lt' : led W ((k, percept W c) :: t) c).
    { destruct Lt as [L1 L2]. unfold led. simpl. rewrite !map_app, walk_app, L1. simpl. rewrite M.
      split; auto. rewrite (percepts_app W _ _ _ _ L1), L2. simpl. rewrite M. auto. }
    destruct (percept_eqb_spec (percept W c) q) as [<-|N].
    + eapply does_weaken; [apply (IH _ c Lt' D); simpl; rewrite <- app_assoc; auto|auto].
    + destruct (degree_spec W WW c Lc) as (P & _).
      assert (F0 : facing W (percept W c, 0) c c) by (unfold facing; simpl; auto).
      assert (Back : walk W (root W) (rev (map fst ((k, percept W c) :: t))) = Some c)
        by (rewrite <- map_rev; apply Lt').
      eapply does_bind; [apply does_with_trail; [|exact Lt'];
        apply (undo_spec W HW (map fst ((k, percept W c) :: t)) _ c c (root W) F0 Lr Back)|].
      intros (v, t') d n ((F & _) & _ & Lt2). simpl in F, Lt2.
      apply (explore_on_right W v t' d fuel); auto.
Qed.

(** In every world the mapper ends with the world. *)
Lemma tour_mapper_right W0 L0 W fuel : world W0 -> replays W0 L0 -> closed L0 -> world W ->
  darts W <= 2 * fuel ->
  does W (root W) (tour_mapper W0 L0 fuel (percept W (root W))) (fun M _ _ => isomorphic M W).
Proof.
  intros H0 R0 C0 HW Lf. assert (WW := world_is_map W HW). assert (Lr := root_lt W WW).
  unfold tour_mapper. destruct (percept_eqb_spec (percept W (root W)) (start L0)) as [E|N].
  - apply (tour_or_right W0 L0 W fuel); auto; [split; auto|].
    rewrite E. destruct R0 as [S P]. rewrite <- S. apply doors_there_shown, P.
  - apply explore_on_right; auto; [|split; auto]. destruct (degree_spec W WW _ Lr) as (P & _).
    unfold facing. simpl. auto.
Qed.

(** In W0 it makes the moves of the tour. *)
Lemma tour_or_moves W0 go ms : forall a t, percepts W0 a (map fst ms) = Some (map snd ms) ->
  exists b, perform W0 a (tour_or go W0 ms t) = Some (W0, b, ms).
Proof.
  induction ms as [|(k, q) ms IH]; simpl; intros a t E; [eauto|].
  destruct (move W0 a k) as [b|]; [|discriminate].
  destruct (percepts W0 b (map fst ms)) as [ps|] eqn:P; [|discriminate]. injection E as <- Es.
  subst ps. destruct (percept_eqb_spec (percept W0 b) (percept W0 b)) as [_|N]; [|destruct N; auto].
  destruct (IH b ((k, percept W0 b) :: t) P) as (c & ->). eauto.
Qed.

(** With fuel for one round more than moves the answer does not depend on the fuel. *)
Lemma tour_fuel W0 L0 q n ms : answer_after (tour_mapper W0 L0 n q) ms <> Lost ->
  answer_after (tour_mapper W0 L0 (S (length ms)) q) ms = answer_after (tour_mapper W0 L0 n q) ms.
Proof.
  unfold tour_mapper. assert (G : forall v t ns j, length ns < j ->
    answer_after (explore_on n v t) ns <> Lost ->
    answer_after (explore_on j v t) ns = answer_after (explore_on n v t) ns)
    by (intros; apply enough_fuel; auto).
  destruct (percept_eqb q (start L0)); [|intros N; apply G; auto].
  assert (H : forall l ns t j, length ns < j ->
    answer_after (tour_or (explore_on n) W0 l t) ns <> Lost ->
    answer_after (tour_or (explore_on j) W0 l t) ns = answer_after (tour_or (explore_on n) W0 l t) ns).
  { intros l. induction l as [|(k, p) l IH]; intros ns t j L N; auto. destruct ns as [|(i, r) ns]; auto.
    simpl in *. destruct (i =? k); auto. destruct (percept_eqb r p); [apply IH; auto; lia|].
    apply after_bind; auto. intros x rest Le Nx. apply G; auto. lia. }
  intros N. apply H; auto.
Qed.

(** Section 11: for every world there is a mapper that makes exactly LB moves in it, and that ends with
    the right map in every world.
    Not in the paper. *)
Theorem least_cost_attained W0 depth up : world W0 -> breadth_first W0 depth up -> exists f,
  (forall W, world W -> exists L M, replays W L /\ ends f L M /\ isomorphic M W) /\ sound f /\
  exists L, replays W0 L /\ ends f L W0 /\ length (moves L) = least_cost W0 depth up.
Proof.
  intros H0 B. destruct (tour_exact W0 depth up H0 B) as (R0 & C0 & E0).
  set (L0 := tour_log W0 depth up) in *. clearbody L0. exists (strategy_of (tour_mapper W0 L0)).
  assert (Ends : forall W L M n b, replays W L -> start L = percept W (root W) ->
    perform W (root W) (tour_mapper W0 L0 n (percept W (root W))) = Some (M, b, moves L) ->
    ends (strategy_of (tour_mapper W0 L0)) L M).
  { intros W L M n b R S P. apply perform_after in P as [P1 P2]. unfold strategy_of. split; simpl.
    - intros i k Di. assert (Q := P2 i k Di). rewrite S, tour_fuel with (n := n), Q; auto.
      rewrite Q. discriminate.
    - rewrite S, tour_fuel with (n := n), P1; auto. rewrite P1. discriminate. }
  assert (All : forall W, world W -> exists L M, replays W L /\
    ends (strategy_of (tour_mapper W0 L0)) L M /\ isomorphic M W).
  { intros W HW. destruct (tour_mapper_right W0 L0 W (darts W) H0 R0 C0 HW ltac:(lia))
      as (M & b & ms & P & Iso). exists {| start := percept W (root W); moves := ms |}, M.
    assert (R : replays W {| start := percept W (root W); moves := ms |})
      by (split; auto; apply (perform_moves _ _ _ _ _ _ P)).
    split; [auto|split; [|auto]]. apply (Ends W _ M (darts W) b); auto. }
  split; [exact All|split].
  - intros W L M HW R E. destruct (All W HW) as (K & N & RK & EK & Iso).
    rewrite (one_log _ W L K M N R RK E EK). auto.
  - exists L0. split; [auto|split; [|auto]]. destruct R0 as [S P].
    destruct (tour_or_moves W0 (explore_on 0) (moves L0) (root W0) [] P) as (b & Q).
    apply (Ends W0 L0 W0 0 b); [split; auto|auto|]. unfold tour_mapper.
    rewrite S. destruct (percept_eqb_spec (start L0) (start L0)) as [_|N]; [auto|destruct N; auto].
Qed.
