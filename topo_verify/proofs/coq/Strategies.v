(** The mapper of Mapper.v as one of all mappers: it is right in every world and ends in every world,
    so its cost lies between LB and the bound of claim 7 (docs/semantics.md, sections 9 and 11).

    p is a program, W a world, ms moves, L a log, M the map that is delivered, f a strategy.

    Sound.v speaks of strategies: functions from the log so far to the next door or the map. A program
    is one: it is told the percepts of the log and asked what it does next. *)
From Coq Require Import Arith Lia List Bool.
Import ListNotations.
From Topo Require Import World Rotation Vertices Program Mapper Validation MapperCorrect Log Sound
  Distance LeastCost Algorithms.

(** What a program does after some moves: it asks for a door, or delivers its result, or it would not
    have made these moves. *)
Inductive answer (A : Type) : Type := Asks (k : nat) | Delivers (x : A) | Lost.
Arguments Asks {A}.
Arguments Delivers {A}.
Arguments Lost {A}.

(** The answer of p after the moves ms. *)
Fixpoint answer_after {A} (p : program A) (ms : list (nat * Percept)) : answer A := match p, ms with
  | Return x, [] => Delivers x
  | Leave k g, [] => Asks k
  | Leave k g, (j, q) :: ms => if j =? k then answer_after (g q) ms else Lost
  | _, _ => Lost
  end.

(** The mapper as a strategy. Each of its rounds makes a move, so that the log bounds their number. *)
Definition strategy_of (f : nat -> Percept -> program Map) : Strategy := fun L =>
  match answer_after (f (S (length (moves L))) (start L)) (moves L) with
  | Asks k => inl k | Delivers M => inr M | Lost => inl 0 end.

(** After the moves that it made in a world, a program gives its result; before each, it asked for its
    door. *)
Lemma perform_after {A} W (p : program A) : forall a x b ms, perform W a p = Some (x, b, ms) ->
  answer_after p ms = Delivers x /\
  forall i k, nth_error (map fst ms) i = Some k -> answer_after p (firstn i ms) = Asks k.
Proof.
  induction p as [y|k g IH|]; simpl; intros a x b ms E; [|destruct (move W a k) as [c|]|];
    try discriminate.
  - injection E as <- <- <-. split; auto. intros [|i] k Ei; discriminate.
  - destruct (perform W c _) as [((y, d), ns)|] eqn:P; [|discriminate]. injection E as <- <- <-.
    apply IH in P as [P1 P2]. rewrite Nat.eqb_refl. split; auto. intros [|i] j Ej; simpl in *.
    + congruence.
    + rewrite Nat.eqb_refl. auto.
Qed.

(** Programs that go on in ways that give the same answers give the same answers. *)
Lemma after_bind {A B} (p : program A) (f g : A -> program B) : forall ms,
  (forall x ns, length ns <= length ms -> answer_after (f x) ns <> Lost ->
    answer_after (g x) ns = answer_after (f x) ns) ->
  answer_after (bind p f) ms <> Lost -> answer_after (bind p g) ms = answer_after (bind p f) ms.
Proof.
  induction p as [x|k h IH|]; intros ms H N.
  - apply (H x ms); auto.
  - destruct ms as [|(j, q) ms]; [auto|]. change (bind (Leave k h) f) with (Leave k (fun q => bind (h q)
      f)) in *. change (bind (Leave k h) g) with (Leave k (fun q => bind (h q) g)).
    simpl in *. destruct (j =? k); auto.
  - auto.
Qed.

Section Fuel.
Variables (pick : Map -> nat -> option nat) (path : Map -> nat -> nat -> list nat * nat)
          (order : Map -> list nat -> list nat) (motion : Motion) (rule : Rule).

(** A round begins with a move. *)
Lemma round_moves st e : exists k g, round path order motion rule st e = Leave k g.
Proof.
  destruct st as ((((M, p), v), T), t). unfold round. destruct (path M e p) as (w, k).
  destruct w; simpl; eexists; eexists; reflexivity.
Qed.

(** With fuel for one round more than moves the answer does not depend on the fuel. *)
Lemma enough_fuel n : forall st ms j,
  answer_after (explore pick path order motion rule n st) ms <> Lost ->
  length ms < j ->
  answer_after (explore pick path order motion rule j st) ms =
  answer_after (explore pick path order motion rule n st) ms.
Proof.
  induction n as [|n IH]; intros st ms [|j] N L; try lia; simpl in *; destruct (pick _ _) as [e|]; auto.
  - destruct N. auto.
  - destruct (round_moves st e) as (k & g & R). rewrite R in *.
    destruct ms as [|(i, q) ms]; [auto|]. simpl in L.
    change (answer_after (bind (Leave k g) (explore pick path order motion rule n)) ((i, q) :: ms)) with
      (if i =? k then answer_after (bind (g q) (explore pick path order motion rule n)) ms
       else Lost) in *.
    change (answer_after (bind (Leave k g) (explore pick path order motion rule j)) ((i, q) :: ms)) with
      (if i =? k then answer_after (bind (g q) (explore pick path order motion rule j)) ms else Lost).
    destruct (i =? k); auto. apply after_bind; auto. intros x ns Ln Nx. apply IH; auto. lia.
Qed.
End Fuel.

(** Lists of pairs are equal if their first and their second parts are. *)
Lemma pairs_eq {A B} (l k : list (A * B)) : map fst l = map fst k -> map snd l = map snd k -> l = k.
Proof.
  revert k. induction l as [|(a, b) l IH]; intros [|(c, d) k]; simpl; try discriminate; auto.
  intros E F. injection E as -> E. injection F as -> F. f_equal. auto.
Qed.

(** If a world shows two logs that begin with the same doors, the logs begin alike. *)
Lemma same_doors W L K i : replays W L -> replays W K ->
  firstn i (map fst (moves L)) = firstn i (map fst (moves K)) -> cut L i = cut K i.
Proof.
  intros [SL PL] [SK PK] E. unfold cut. f_equal; [congruence|].
  apply pairs_eq; rewrite <- !firstn_map; auto.
  apply (percepts_firstn W i) in PL, PK. rewrite E in PL. congruence.
Qed.

(** A strategy ends in a world with one log only. *)
Lemma one_log f W L K M N : replays W L -> replays W K -> ends f L M -> ends f K N -> M = N.
Proof.
  intros RL RK [DL EL] [DK EK].
  assert (Cut : forall i, i <= length (moves L) -> i <= length (moves K) -> cut L i = cut K i).
  { intros i Li Lk. apply (same_doors W); auto. induction i as [|i IH]; auto.
    assert (C : cut L i = cut K i) by (apply (same_doors W); auto; apply IH; lia).
    assert (D : forall J, i < length (moves J) -> exists k, door J i = Some k).
    { intros J H. unfold door. destruct (nth_error _ i) as [k|] eqn:X; eauto.
      apply nth_error_None in X. rewrite map_length in X. lia. }
    destruct (D L) as [k Hk]; [lia|]. destruct (D K) as [j Hj]; [lia|].
    assert (k = j) as ->.
    { assert (A := DL i k Hk). assert (B := DK i j Hj). rewrite C in A. congruence. }
    unfold door in Hk, Hj.
    assert (Add : forall (l : list nat) x, nth_error l i = Some x -> firstn (S i) l = firstn i l ++ [x]).
    { clear. induction i as [|i IH]; intros [|y l] x E; simpl in *; try discriminate.
      - congruence.
      - rewrite <- (IH l x E). auto. }
    rewrite (Add _ j Hk), (Add _ j Hj), IH by lia. auto. }
  assert (All : forall J, cut J (length (moves J)) = J).
  { intros [s ms]. unfold cut. simpl. rewrite firstn_all. auto. }
  assert (Longer : forall J H, length (moves J) < length (moves H) ->
    cut J (length (moves J)) = cut H (length (moves J)) -> forall X Y, f J = inr X ->
    (forall i k, door H i = Some k -> f (cut H i) = inl k) -> f H = inr Y -> False).
  { intros J H Lt C X Y FJ DH _. rewrite All in C. assert (D := DH (length (moves J))).
    rewrite <- C, FJ in D. unfold door in D. destruct (nth_error _ _) as [k|] eqn:E.
    - discriminate (D k eq_refl).
    - apply nth_error_None in E. rewrite map_length in E. lia. }
  destruct (lt_eq_lt_dec (length (moves L)) (length (moves K))) as [[Lt|Eq]|Lt].
  - destruct (Longer L K Lt (Cut _ (le_n _) ltac:(lia)) M N); auto.
  - assert (C := Cut (length (moves L)) (le_n _) ltac:(lia)). rewrite All, Eq, All in C. congruence.
  - destruct (Longer K L Lt (eq_sym (Cut (length (moves K)) ltac:(lia) (le_n _))) N M); auto.
Qed.

(** The strategy of an algorithm with these policies. *)
Definition strategy (A : algorithm) pick path order := strategy_of (run_of A pick path order).

(** In every world the strategy ends, with a log that the world shows, the right map, and a cost
    within the bound.
    Paper, I, II-C: With a directional marker the world can be mapped deterministically. *)
Theorem strategy_ends A pick path order : maps_all A -> good_pick pick -> good_path path ->
  good_order order -> forall W, world W -> exists L M m,
  replays W L /\ ends (strategy A pick path order) L M /\ isomorphic M W /\ darts W = 2 * m /\
  m <= length (moves L) <= m * (vertices W + (2 * m - 1) * (2 * (vertices W - 1))).
Proof.
  intros G Gp Gw Go W HW. destruct (G pick path order W Gp Gw Go HW) as (M & b & ms & m & P & I & D & C).
  exists {| start := percept W (root W); moves := ms |}, M, m. split.
  { apply perform_moves in P as [_ P]. split; auto. }
  split; [|auto]. apply perform_after in P as [P1 P2].
  assert (Fuel : forall ns,
    answer_after (run_of A pick path order (darts W) (percept W (root W))) ns <> Lost ->
    answer_after (run_of A pick path order (S (length ns)) (percept W (root W))) ns =
    answer_after (run_of A pick path order (darts W) (percept W (root W))) ns)
    by (intros ns N; apply enough_fuel; auto).
  unfold strategy, strategy_of. split; simpl.
  - intros i k Di. assert (Q := P2 i k Di). rewrite Fuel, Q; auto. rewrite Q. discriminate.
  - rewrite Fuel, P1; auto. rewrite P1. discriminate.
Qed.

(** Claim 5 in the model of all mappers: the strategy is right in every world.
    Paper, I, II-C: With a directional marker the world can be mapped deterministically. *)
Theorem strategy_sound A pick path order : maps_all A -> good_pick pick -> good_path path ->
  good_order order -> sound (strategy A pick path order).
Proof.
  intros G Gp Gw Go W L M HW R E.
  destruct (strategy_ends A pick path order G Gp Gw Go W HW) as (K & N & m & RK & EK & I & _).
  rewrite (one_log _ W L K M N R RK E EK). auto.
Qed.

(** Claim 7 and section 11 in one model: LB <= cost <= bound, for every algorithm of the paper and
    whatever its policies, in every world. The log that it leaves is closed: it proves the map.
    Paper, I, II-B: O(m) is a trivial lower bound. *)
Theorem between_bounds A pick path order : maps_all A -> good_pick pick -> good_path path ->
  good_order order -> forall W depth up, world W -> breadth_first W depth up -> exists L M m,
  replays W L /\ ends (strategy A pick path order) L M /\ isomorphic M W /\ closed L /\
  darts W = 2 * m /\
  least_cost W depth up <= length (moves L) <= m * (vertices W + (2 * m - 1) * (2 * (vertices W - 1))).
Proof.
  intros G Gp Gw Go W depth up HW B. assert (S := strategy_sound A pick path order G Gp Gw Go).
  destruct (strategy_ends A pick path order G Gp Gw Go W HW) as (L & M & m & R & E & I & D & C).
  exists L, M, m. assert (K := sound_closed _ S W L M HW R E).
  assert (LB := sound_least_cost (strategy A pick path order) depth up). intuition eauto.
Qed.

(** For the basic algorithm with the reference policies. *)
Corollary basic_between : forall W depth up, world W -> breadth_first W depth up -> exists L M m,
  replays W L /\ ends (strategy basic ReferencePolicies.nearest Ways.way_to ReferencePolicies.shortest)
    L M /\ isomorphic M W /\ closed L /\ darts W = 2 * m /\
  least_cost W depth up <= length (moves L) <= m * (vertices W + (2 * m - 1) * (2 * (vertices W - 1))).
Proof. apply between_bounds; [apply basic_correct|apply reference_policies_good..]. Qed.
