(** Steered mappers: the loop of algorithms/beyond/steering.py, with any choice of the next edge,
    of the next door, and of the ways home (docs/homing.md).

    SCEPTICS READ ALL OF THIS FILE. It contains definitions only. [homing] and [planner] are such
    mappers: what they weigh decides between steps that [steers] allows. docs/proofs.md says which lines
    of Python correspond.

    L    the log so far                    M      the map S
    T    where each dart of S was seen     p, q   places of the log
    e    a dart of U, to be settled        h      a hypothesis for e
    k    a door                            w      what is left of a way home
    n    a number of moves                 W      a world

    The fold of the log is not computed here: [same] of Log.v says which places are one in it, and
    [consistent] whether it contradicts. *)
From Coq Require Import Arith List.
Import ListNotations.
From Topo Require Import World Vertices Augment Ways Log.

(** The dart k doors clockwise from p. *)
Definition turned k (p : place) : place := (fst p, k + snd p).

(** The robot's reference dart. *)
Definition standing L : place := (length (moves L), 0).

(** In the fold an edge leads from p to q. *)
Definition on_edge L p q := exists p' q', link nothing L p' q' /\ same nothing L p p' /\
  same nothing L q q'.

(** The dart p was crossed. *)
Definition was_crossed L p := exists q, on_edge L p q.

(** The vertex of q is at most n crossed edges away from the vertex of p. *)
Inductive near L : nat -> place -> place -> Prop :=
| near_here n p q k : same nothing L (turned k p) q -> near L n p q
| near_cross n p q r k : on_edge L (turned k p) q -> near L n q r -> near L (S n) p r.

(** In W the robot leaves by door k: L' is the longer log. *)
Definition leaves_by W L k L' := exists q,
  L' = {| start := start L; moves := moves L ++ [(k, q)] |} /\ replays W L'.

(** The robot makes n moves over darts that were crossed. *)
Inductive travels W : nat -> Log -> Log -> Prop :=
| travels_not L : travels W 0 L L
| travels_by n L k L1 L' : was_crossed L (turned k (standing L)) -> leaves_by W L k L1 ->
  travels W n L1 L' ->
    travels W (S n) L L'.

(** The robot walks to the vertex of p, over the least number of crossed edges. *)
Definition goes_to W L p L' := exists n, travels W n L L' /\ near L' 0 (standing L') p /\
  forall x, near L x (standing L) p -> n <= x.

(** Dart e of S is unexplored. *)
Definition open M e := e < darts M /\ alpha M e = None.

(** Some world that shows L has an edge from e to h: the fold with this edge has no contradiction. *)
Definition supposed L (T : nat -> place) e h := consistent [(T e, T h)] L.

(** What the log proves of one more edge: e ends in h, a dart of S; or every hypothesis for e is refuted,
    and the place p behind e, of degree d, is a new vertex. *)
Inductive settles L : Map -> (nat -> place) -> Map -> (nat -> place) -> Prop :=
| settles_loop M T e h : open M e -> h < darts M -> on_edge L (T e) (T h) ->
    settles L M T (augment_loop M e h) T
| settles_new M T e p d m : open M e -> on_edge L (T e) p -> seen L (fst p) = Some (d, m) ->
    (forall h, h < darts M -> ~ supposed L T e h) ->
    settles L M T (augment_new M e d) (fun x => if x <? darts M then T x else turned (x - darts M) p).

(** All that the log proves is settled, in any order. *)
Inductive settles_all L : Map -> (nat -> place) -> Map -> (nat -> place) -> Prop :=
| settles_end M T : (forall M' T', ~ settles L M T M' T') -> settles_all L M T M T
| settles_more M T M1 T1 M' T' : settles L M T M1 T1 -> settles_all L M1 T1 M' T' ->
  settles_all L M T M' T'.

(** What claim 7 grants for each edge of a map with n vertices and m edges. *)
Definition grant n m := n + (2 * m - 1) * (2 * (n - 1)).

(** The greatest distance of a vertex of S from v0. *)
Definition deep M := list_max (map (far_from M (tree_from M (root M))) (seq 0 (darts M))).

(** What the mapper asks before it takes a door of its choice: after one more move, settling any edge by
    ways home is within the bound of claim 7. From the robot to S there are a moves at most; j edges are
    settled. *)
Definition affords L M (T : nat -> place) := exists a x j,
  x < darts M /\ near L a (standing L) (T x) /\ known M = 2 * j /\
  length (moves L) + 1 + a + 1 + vertices M + 1 + (darts M - known M) * (2 * deep M) <=
  (j + 1) * grant (vertices M) ((darts M + 1) / 2).

(** The doors w lead home from dart h of S, over no more edges than the greatest distance. *)
Definition home_way M h w := length w <= deep M /\
  exists x k, walk M h w = Some x /\ turn M k x = root M.

(** What the mapper does next: it chooses an edge; it settles e, which was crossed; or it walks the way
    home of h: it is known up to the place p, and the doors w are left. *)
Inductive task := Chooses | Behind (e : nat) | Tries (e h : nat) (p : place) (w : list nat).

(** The log, S, where its darts were seen, and what the mapper does next. *)
Inductive situation := At (L : Log) (M : Map) (T : nat -> place) (t : task).

(** It settles e, or chooses an edge if e is settled. *)
Definition next_task M e := match alpha M e with None => Behind e | Some _ => Chooses end.

(** The way home of h goes on from where the robot stands, until h is refuted or e is settled. *)
Inductive goes_on L M T e h w : task -> Prop :=
| goes_on_settled : alpha M e <> None -> goes_on L M T e h w Chooses
| goes_on_refuted : alpha M e = None -> ~ supposed L T e h -> goes_on L M T e h w (Behind e)
| goes_on_home : alpha M e = None -> supposed L T e h -> goes_on L M T e h w (Tries e h (standing L) w).

(** The steps of a steered mapper in W, with the lines of docs/homing.md: it takes any of them. *)
Inductive steers W : situation -> situation -> Prop :=
| step_beside L M T e : open M e -> was_crossed L (T e) -> (* 3 4: it goes on from where it stands *)
    steers W (At L M T Chooses) (At L M T (Behind e))
| step_reach L M T e p L' : open M e -> on_edge L (T e) p -> goes_to W L p L' -> (* 3 4 *)
    steers W (At L M T Chooses) (At L' M T (Behind e))
| step_cross L M T e L1 k L' M' T' : open M e -> ~ was_crossed L (T e) -> (* 3 4 14 to 17 *)
    goes_to W L (T e) L1 -> same nothing L1 (turned k (standing L1)) (T e) -> leaves_by W L1 k L' ->
    settles_all L' M T M' T' ->
    steers W (At L M T Chooses) (At L' M' T' (next_task M' e))
| step_door L M T e k L' M' T' : affords L M T -> (* 9 13 14 to 17: any door *)
    leaves_by W L k L' -> settles_all L' M T M' T' ->
    steers W (At L M T (Behind e)) (At L' M' T' Chooses)
| step_try L M T e p h w : h < darts M -> supposed L T e h -> (* 6 7: any hypothesis, any way home *)
    on_edge L (T e) p -> home_way M h w ->
    steers W (At L M T (Behind e)) (At L M T (Tries e h p w))
| step_known L M T e h p k w q : on_edge L (turned k p) q -> (* 8: a door that was crossed *)
    steers W (At L M T (Tries e h p (k :: w))) (At L M T (Tries e h q w))
| step_home L M T e h p k w L1 i L' M' T' t : ~ was_crossed L (turned k p) -> (* 8 14 to 17 *)
    goes_to W L p L1 -> same nothing L1 (turned i (standing L1)) (turned k p) -> leaves_by W L1 i L' ->
    settles_all L' M T M' T' -> goes_on L' M' T' e h w t ->
    steers W (At L M T (Tries e h p (k :: w))) (At L' M' T' t).

(** At the start S is v0, whose darts are seen from its reference dart on. *)
Definition opening W := At {| start := percept W (root W); moves := [] |}
  (initial (degree W (root W))) (fun x => (0, x)) Chooses.

(** The situations that a run in W can reach, whatever the mapper chooses. *)
Inductive runs W : situation -> Prop :=
| runs_opening : runs W (opening W)
| runs_step s s' : runs W s -> steers W s s' -> runs W s'.

(** The mapper stops when no dart of S is unexplored, and delivers S. *)
Definition stops s := match s with At L M T t => t = Chooses /\ forall e, ~ open M e end.
