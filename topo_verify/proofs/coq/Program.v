(** Programs that a robot performs: what a mapper is, before anything is known of worlds
    (docs/semantics.md, section 2).

    p, f  programs      W     a world            a, b, c   darts: the robot's reference dart
    k     a door        q     a percept          ms        moves: doors, and the percepts behind
    t     a trail: the moves since the start, the last one first

    A program is told percepts and asks for doors. It is given no world, so it cannot look at one.
    SCEPTICS READ [program] and [perform]. The cost of a performance is the number of its moves. *)
From Coq Require Import Arith Lia List.
Import ListNotations.
From Topo Require Import World Rotation.

(** A program ends with a result, or leaves by door k and goes on with what is sensed behind it,
    or is stuck. *)
Inductive program (A : Type) : Type :=
| Return (x : A)
| Leave (k : nat) (go_on_with : Percept -> program A)
| Stuck.
Arguments Return {A}.
Arguments Leave {A}.
Arguments Stuck {A}.

(** Do p, and then what f says of its result. *)
Fixpoint bind {A B} (p : program A) (f : A -> program B) : program B :=
  match p with
  | Return x => f x
  | Leave k g => Leave k (fun q => bind (g q) f)
  | Stuck => Stuck
  end.

(** The robot performs p in W, its reference dart being a: the result, its last reference dart, and
    its moves. None: the program was stuck, or asked for a door that is not there. *)
Fixpoint perform {A} W a (p : program A) : option (A * nat * list (nat * Percept)) :=
  match p with
  | Return x => Some (x, a, [])
  | Leave k g =>
    match move W a k with
    | Some b => match perform W b (g (percept W b)) with
                | Some (x, c, ms) => Some (x, c, (k, percept W b) :: ms) | None => None end
    | None => None
    end
  | Stuck => None
  end.

(** Performing one program after the other: the moves follow one another. *)
Lemma perform_bind {A B} W (p : program A) (f : A -> program B) : forall a,
  perform W a (bind p f) =
  match perform W a p with
  | Some (x, b, ms) => match perform W b (f x) with
                       | Some (y, c, ns) => Some (y, c, ms ++ ns) | None => None end
  | None => None
  end.
Proof.
  induction p as [x|k g IH|]; simpl; intros a; auto.
  - destruct (perform W a (f x)) as [((y, c), ns)|]; auto.
  - destruct (move W a k) as [b|]; auto. rewrite IH.
    destruct (perform W b (g _)) as [((x, c), ms)|]; auto.
    destruct (perform W c (f x)) as [((y, d), ns)|]; auto.
Qed.

(** The moves of a performance are a walk of the world, with its percepts. *)
Lemma perform_moves {A} W (p : program A) : forall a x b ms, perform W a p = Some (x, b, ms) ->
  walk W a (map fst ms) = Some b /\ percepts W a (map fst ms) = Some (map snd ms).
Proof.
  induction p as [y|k g IH|]; simpl; intros a x b ms E; [|destruct (move W a k) as [c|] eqn:Em|];
    try discriminate.
  - injection E as <- <- <-. auto.
  - destruct (perform W c _) as [((y, d), ns)|] eqn:P; [|discriminate]. injection E as <- <- <-.
    apply IH in P as [P1 P2]. simpl. rewrite Em, P1, P2. auto.
Qed.

(** Performed in W from dart a, the program p ends; its result x, its last reference dart b and its
    cost n are as Q says. *)
Definition does {A} W a (p : program A) (Q : A -> nat -> nat -> Prop) :=
  exists x b ms, perform W a p = Some (x, b, ms) /\ Q x b (length ms).

(** A result costs nothing. *)
Lemma does_return {A} W a (x : A) (Q : A -> nat -> nat -> Prop) : Q x a 0 -> does W a (Return x) Q.
Proof. intros H. exists x, a, []. auto. Qed.

(** Leaving by a door that is there costs 1. *)
Lemma does_leave {A} W a b k g (Q : A -> nat -> nat -> Prop) : move W a k = Some b ->
  does W b (g (percept W b)) (fun x c n => Q x c (S n)) -> does W a (Leave k g) Q.
Proof.
  intros Em (x & c & ms & P & H). exists x, c, ((k, percept W b) :: ms). simpl. rewrite Em, P. auto.
Qed.

(** One program after the other: their costs add up. *)
Lemma does_bind {A B} W a (p : program A) (f : A -> program B) Q R : does W a p Q ->
  (forall x b n, Q x b n -> does W b (f x) (fun y c m => R y c (n + m))) -> does W a (bind p f) R.
Proof.
  intros (x & b & ms & P & H) F. destruct (F x b _ H) as (y & c & ns & P' & H').
  exists y, c, (ms ++ ns). rewrite perform_bind, P, P', app_length. auto.
Qed.

(** What implies what was asked for is enough. *)
Lemma does_weaken {A} W a (p : program A) (Q R : A -> nat -> nat -> Prop) : does W a p Q ->
  (forall x b n, Q x b n -> R x b n) -> does W a p R.
Proof. intros (x & b & ms & P & H) F. exists x, b, ms. auto. Qed.

(** A trail: the moves since the start, the last one first. *)
Definition robot_trail : Type := list (nat * Percept).

(** Do p, and keep the trail: its result, and the moves so far. *)
Fixpoint with_trail {A} (p : program A) (t : robot_trail) : program (A * robot_trail) :=
  match p with
  | Return x => Return (x, t)
  | Leave k g => Leave k (fun q => with_trail (g q) ((k, q) :: t))
  | Stuck => Stuck
  end.

(** Recording changes nothing that is done, and records just the moves that are made. *)
Lemma perform_with_trail {A} W (p : program A) : forall a t, perform W a (with_trail p t) =
  match perform W a p with
  | Some (x, b, ms) => Some ((x, rev ms ++ t), b, ms) | None => None end.
Proof.
  induction p as [x|k g IH|]; simpl; intros a t; auto. destruct (move W a k) as [b|]; auto.
  rewrite IH. destruct (perform W b (g _)) as [((x, c), ms)|]; auto.
  simpl. rewrite <- app_assoc. auto.
Qed.

(** The trail t' begins with the moves of t. *)
Definition later (t t' : robot_trail) := exists ms, t' = ms ++ t.

(** In W, the moves t lead from the root to b, and show what was sensed. *)
Definition led W t b := walk W (root W) (map fst (rev t)) = Some b /\
  percepts W (root W) (map fst (rev t)) = Some (map snd (rev t)).
Arguments bind : simpl never.
Arguments does : simpl never.
