(** The eight algorithms in all worlds, the one without an edge among them (claims 5 and 7;
    docs/semantics.md, sections 1 and 9).

    w is any world, the point or a world W with edges; p is a program that is told the first percept,
    A an algorithm, M a map, L a log, ms the moves, m the number of edges.

    In the point a mapper is told degree 0. Its map S has no dart, so no dart is open: it delivers S
    at once, without a move. SCEPTICS READ the definitions of this file. *)
From Coq Require Import Arith Lia List.
Import ListNotations.
From Topo Require Import World Rotation Vertices Augment Program Mapper MapperCorrect Algorithms Log
  AnyWorld Sound Edgeless Strategies.

(** This is a world: the point is one. *)
Definition is_world w := match w with Point => True | Edges W => world W end.

(** How many darts there are: none in the point. *)
Definition darts_in w := match w with Point => 0 | Edges W => darts W end.

(** How many vertices there are: one in the point. *)
Definition vertices_in w := match w with Point => 1 | Edges W => vertices W end.

(** The robot is told the first percept and performs p: the result and the moves. In the point there
    is no door to leave by. *)
Definition perform_in {A} w (p : Percept -> program A) := match w with
  | Point => match p nothing_there with Return x => Some (x, []) | _ => None end
  | Edges W => match perform W (root W) (p (percept W (root W))) with
      | Some (x, _, ms) => Some (x, ms) | None => None end end.

(** What a delivered map describes: without a dart it is the point. *)
Definition described M := if darts M =? 0 then Point else Edges M.

(** In every world and with all policies the algorithm ends with a map that is the world. It makes at
    least m moves and at most m (n + (2m - 1) 2(n - 1)): none in the point. *)
Definition maps_any (A : algorithm) := forall pick path order w, good_pick pick -> good_path path ->
  good_order order -> is_world w -> exists M ms m,
  perform_in w (run_of A pick path order (darts_in w)) = Some (M, ms) /\ alike (described M) w /\
  darts_in w = 2 * m /\
  m <= length ms <= m * (vertices_in w + (2 * m - 1) * (2 * (vertices_in w - 1))).

(** In the point every mapper delivers a map without darts at once, whatever its parts. *)
Lemma point_explored A pick path order fuel : good_pick pick ->
  run_of A pick path order fuel nothing_there = Return (initial 0).
Proof.
  intros G. assert (P := G (initial 0) 0). unfold run_of, mapper.
  destruct fuel; simpl in *; destruct (pick (initial 0) 0) as [e|]; auto; destruct P as [P _];
    inversion P.
Qed.

(** A map that is a world with edges describes that world. *)
Lemma described_edges M W : world W -> isomorphic M W -> described M = Edges M.
Proof.
  intros HW [D _]. unfold described. assert (R := root_lt W (world_is_map W HW)). rewrite D.
  destruct (Nat.eqb_spec (darts W) 0); auto. lia.
Qed.

(** Claims 5 and 7 in all worlds: an algorithm that maps every world with edges maps the point, too. *)
Theorem any_mapped A : maps_all A -> maps_any A.
Proof.
  intros G pick path order [|W] Gp Gw Go HW; simpl in *.
  - exists (initial 0), [], 0. rewrite point_explored by auto. simpl. auto.
  - destruct (G pick path order W Gp Gw Go HW) as (M & b & ms & m & P & I & D & C).
    exists M, ms, m. rewrite P, (described_edges M W HW I). auto.
Qed.

(** The eight algorithms of the paper map every world, with edges or not.
    Paper, I, II-C: With a directional marker the world can be mapped deterministically. *)
Theorem all_eight_mapped : Forall maps_any [basic; enhancement_i; enhancement_ii; enhancement_ii_i;
  enhancement_iii_one; enhancement_iii_one_i; enhancement_iii_all; enhancement_iii_all_i].
Proof.
  repeat constructor; apply any_mapped;
    first [apply basic_correct | apply enhancement_i_correct | apply enhancement_ii_correct |
      apply enhancement_iii_one_correct | apply enhancement_iii_all_correct].
Qed.

(** The strategy of an algorithm in all worlds. *)
Definition strategy_in A pick path order : any_strategy := fun L =>
  match strategy A pick path order L with inl k => inl k | inr M => inr (described M) end.

(** In every world the strategy ends, with a log that the world shows, the right map, and a cost
    within the bound. *)
Theorem strategy_in_ends A pick path order : maps_all A -> good_pick pick -> good_path path ->
  good_order order -> forall w, is_world w -> exists L M m,
  shows_log w L /\ ends_any (strategy_in A pick path order) L M /\ alike M w /\ darts_in w = 2 * m /\
  m <= length (moves L) <= m * (vertices_in w + (2 * m - 1) * (2 * (vertices_in w - 1))).
Proof.
  intros G Gp Gw Go [|W] HW; simpl in HW.
  - exists {| start := nothing_there; moves := [] |}, Point, 0. simpl. repeat split; auto.
    + intros [|i] k E; discriminate.
    + unfold strategy_in, strategy, strategy_of. simpl start. rewrite point_explored by auto. auto.
  - destruct (strategy_ends A pick path order G Gp Gw Go W HW)
      as (L & M & m & R & (Ed & El) & I & D & C).
    exists L, (described M), m. split; [simpl; auto|].
    split; [|rewrite (described_edges M W HW I); auto].
    split; unfold strategy_in; [intros i k E; rewrite (Ed i k E)|rewrite El]; auto.
Qed.

(** Claim 5 in the model of all mappers: the strategy is right in every world, with edges or not.
    Not in the paper. *)
Theorem strategy_in_sound A pick path order : maps_all A -> good_pick pick -> good_path path ->
  good_order order -> sound_any (strategy_in A pick path order).
Proof.
  intros G Gp Gw Go [|W] L M Sh [Ed El]; unfold strategy_in in *.
  - destruct Sh as [E F]. unfold strategy, strategy_of in El. rewrite E, F, point_explored in El by auto.
    simpl in El. injection El as <-. simpl. auto.
  - destruct Sh as [HW R]. destruct (strategy A pick path order L) as [k|N] eqn:S; [discriminate|].
    injection El as <-. assert (I : isomorphic N W).
    { apply (strategy_sound A pick path order G Gp Gw Go W L); auto. split; auto. intros i k D.
      assert (X := Ed i k D). destruct (strategy A pick path order (cut L i)); congruence. }
    rewrite (described_edges N W HW I). auto.
Qed.
