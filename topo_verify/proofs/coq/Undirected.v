(** A single undirected marker is not enough, whatever the mapper (paper, I; docs/semantics.md,
    section 10).

    W, V   worlds                         a, b    darts: the robot's reference dart
    k, w   a door, doors                  f       a mapper          M    the map that it delivers
    R      a relation between the darts of two worlds

    The robot of this file senses the degree, and whether the marker is here. Two worlds are twins if
    some relation of their darts respects what it senses and every move: then it senses the same in
    both, whatever doors it takes, so a mapper delivers the same map in both. It is wrong in one of
    them if they are not isomorphic.

    Each size from 2 edges on has such twins of one vertex. One has its first loop between neighbours;
    in the other each loop joins opposite darts. Of 2 edges these are m2/7, in the plane, and m2/8, on
    the torus. SCEPTICS READ the definitions up to [maps_it], and [undirected_not_enough]. *)
From Coq Require Import Arith Lia List Bool.
Import ListNotations.
From Topo Require Import World Rotation.

(** What the robot senses of an undirected marker: the degree, and whether the marker is here. *)
Definition sight W a : nat * bool :=
  (degree W a, match marker W a with Some _ => true | None => false end).

(** What it senses behind each of the doors w. *)
Fixpoint sights_behind W a (w : list nat) : option (list (nat * bool)) :=
  match w with
  | [] => Some []
  | k :: w => match move W a k with
              | Some b => option_map (cons (sight W b)) (sights_behind W b w)
              | None => None end
  end.

(** A deterministic mapper: from what was sensed at the start, and the doors so far with what was sensed
    behind each, it computes the next door, or the map that it delivers. *)
Definition Undirected_mapper : Type := nat * bool -> list (nat * (nat * bool)) -> nat + Map.

(** In W the mapper f takes some doors one after the other, and then delivers M. *)
Definition delivers (f : Undirected_mapper) W M := exists w ss,
  sights_behind W (root W) w = Some ss /\
  (forall i k, nth_error w i = Some k -> f (sight W (root W)) (firstn i (combine w ss)) = inl k) /\
  f (sight W (root W)) (combine w ss) = inr M.

(** M with its marker at dart r. *)
Definition marked_at r M := {| darts := darts M; sigma := sigma M; alpha := alpha M; root := r |}.

(** M is W but for the marker: the robot need not know where it points, nor even where it lies. *)
Definition same_map M W := world M /\ exists r, isomorphic (marked_at r M) W.

(** The mapper is right in W: it delivers a map there, and no map that is not W. *)
Definition maps_it f W := (exists M, delivers f W M) /\ forall M, delivers f W M -> same_map M W.

(** R respects what the robot senses, and every move. *)
Definition twinned W V (R : nat -> nat -> Prop) := forall a b, R a b -> sight W a = sight V b /\
  forall k, k < degree W a -> exists c d, move W a k = Some c /\ move V b k = Some d /\ R c d.

(** Twins show the same behind all doors. *)
Lemma twins_look_alike W V R w : twinned W V R -> forall a b, R a b ->
  sights_behind W a w = sights_behind V b w.
Proof.
  intros T. induction w as [|k w IH]; intros a b Rab; simpl; auto.
  destruct (T a b Rab) as [S N]. injection S as D _. destruct (le_lt_dec (degree W a) k) as [L|L].
  - unfold move. rewrite <- D, (proj2 (Nat.ltb_ge _ _) L). auto.
  - destruct (N k L) as (c & d & -> & -> & Rcd). rewrite (proj1 (T c d Rcd)), (IH c d Rcd). auto.
Qed.

(** In twins a mapper delivers the same maps, so it is right in both only if some map is both.
    Not in the paper. *)
Theorem twins_undetermined f W V R : twinned W V R -> R (root W) (root V) ->
  maps_it f W -> maps_it f V -> exists M, same_map M W /\ same_map M V.
Proof.
  intros T Rr ((M & D) & HW) [_ HV]. exists M. split; [apply (HW M D)|]. apply HV.
  destruct D as (w & ss & S & N & E). rewrite (proj1 (T _ _ Rr)) in N, E.
  rewrite (twins_look_alike W V R w T _ _ Rr) in S. exists w, ss. auto.
Qed.

(** One vertex with m loops: its darts in their order, and this partner of each. *)
Definition one_vertex m (partner : nat -> nat) := {| darts := 2 * m;
  sigma := fun d => if S d =? 2 * m then 0 else S d; alpha := fun d => Some (partner d); root := 0 |}.

(** The first loop joins neighbours, and each other one is around the next: 0-1, then 2-(2m-1), 3-(2m-2)
    and so on. *)
Definition nested m := one_vertex m (fun d => if d <? 2 then 1 - d else 2 * m + 1 - d).

(** Each loop joins opposite darts. *)
Definition opposed m := one_vertex m (fun d => if d <? m then d + m else d - m).

Section One_vertex.
Variables (m : nat) (partner : nat -> nat).
Hypotheses (Pm : 0 < m) (P : forall d, d < 2 * m ->
  partner d < 2 * m /\ partner d <> d /\ partner (partner d) = d).
Notation W := (one_vertex m partner).

(** Turning counts the darts in their order. *)
Lemma turn_loops k d : d < 2 * m -> k <= 2 * m ->
  turn W k d = if d + k <? 2 * m then d + k else d + k - 2 * m.
Proof.
  intros Hd. induction k as [|k IH]; intros Hk; [simpl|].
  - destruct (Nat.ltb_spec (d + 0) (m + (m + 0))); lia.
  - cbn [turn]. rewrite IH by lia. cbn [sigma one_vertex].
    destruct (Nat.ltb_spec (d + k) (2 * m)), (Nat.ltb_spec (d + S k) (2 * m));
      match goal with |- context [S ?x =? _] => destruct (Nat.eqb_spec (S x) (2 * m)) end; lia.
Qed.

(** It is a world. *)
Lemma one_vertex_world : world W.
Proof.
  assert (WM : is_map W).
  { split; cbn [darts sigma alpha root one_vertex]; [| |intros d e Hd E; injection E as <-|lia].
    - intros d Hd. destruct (Nat.eqb_spec (S d) (2 * m)); lia.
    - intros d e Hd He. destruct (Nat.eqb_spec (S d) (2 * m)), (Nat.eqb_spec (S e) (2 * m)); lia.
    - destruct (P d Hd) as (A & B & ->). auto. }
  split; auto; [discriminate|]. intros d Hd. cbn [darts one_vertex] in Hd.
  assert (T := turn_loops d 0 ltac:(lia) ltac:(lia)).
  rewrite (proj2 (Nat.ltb_lt _ _)) in T by lia. simpl (0 + d) in T. rewrite <- T.
  apply reach_turn, reach_here.
Qed.

(** Everywhere the robot sees all 2 m darts and the marker. *)
Lemma sight_loops d : d < 2 * m -> sight W d = (2 * m, true).
Proof.
  intros Hd. assert (WM := world_is_map W one_vertex_world).
  assert (D : degree W d = 2 * m).
  { apply degree_unique; auto; [lia| |].
    - rewrite turn_loops by lia. rewrite (proj2 (Nat.ltb_ge _ _)) by lia. lia.
    - intros k Hk. rewrite turn_loops by lia. destruct (Nat.ltb_spec (d + k) (2 * m)); lia. }
  unfold sight. rewrite D. destruct (marker_of W d (if d =? 0 then 0 else 2 * m - d)) as (j & ->); auto.
  - rewrite D. destruct (Nat.eqb_spec d 0); lia.
  - rewrite turn_loops by (destruct (Nat.eqb_spec d 0); lia). cbn [root one_vertex].
    destruct (Nat.eqb_spec d 0) as [->|N]; [simpl; destruct (Nat.ltb_spec 0 (m + (m + 0))); lia|].
    destruct (Nat.ltb_spec (d + (2 * m - d)) (2 * m)); lia.
Qed.

(** Every door leads to a dart of the one vertex. *)
Lemma move_loops d k : d < 2 * m -> k < 2 * m -> exists e, move W d k = Some e /\ e < 2 * m.
Proof.
  intros Hd Hk. assert (D := f_equal fst (sight_loops d Hd) : degree W d = 2 * m).
  unfold move. rewrite D, (proj2 (Nat.ltb_lt _ _) Hk). eexists. split; [reflexivity|]. apply P.
  apply (turn_lt W (world_is_map W one_vertex_world)). auto.
Qed.
End One_vertex.

(** The partners of [nested] are partners. *)
Lemma nested_partners m d : 0 < m -> d < 2 * m -> let p d := if d <? 2 then 1 - d else 2 * m + 1 - d in
  p d < 2 * m /\ p d <> d /\ p (p d) = d.
Proof.
  intros Pm Hd p. unfold p. destruct (Nat.ltb_spec d 2) as [L|L];
    [destruct (Nat.ltb_spec (1 - d) 2)|destruct (Nat.ltb_spec (2 * m + 1 - d) 2)]; lia.
Qed.

(** So are those of [opposed]. *)
Lemma opposed_partners m d : 0 < m -> d < 2 * m -> let p d := if d <? m then d + m else d - m in
  p d < 2 * m /\ p d <> d /\ p (p d) = d.
Proof.
  intros Pm Hd p. unfold p. destruct (Nat.ltb_spec d m) as [L|L];
    [destruct (Nat.ltb_spec (d + m) m)|destruct (Nat.ltb_spec (d - m) m)]; lia.
Qed.

(** No map is both: in [nested] a dart and the next one are partners, in [opposed] no two such are. *)
Lemma not_both m M : 2 <= m -> same_map M (nested m) -> same_map M (opposed m) -> False.
Proof.
  intros Hm [HM (r & _ & phi & [_ I F _ _] & Onto & A)] [_ (s & _ & psi & [G1 _ G _ _] & _ & B)].
  cbn [marked_at darts sigma alpha nested opposed one_vertex] in *.
  destruct (Onto 0) as (x & Hx & X); [lia|].
  assert (Sx : sigma M x < darts M) by (apply (sigma_lt M (world_is_map M HM)), Hx).
  destruct (alpha M x) as [y|] eqn:E; [|destruct (world_total M HM x Hx E)].
  assert (Hy : y < darts M) by (apply (alpha_ok M (world_is_map M HM) x y Hx E)).
  assert (Y := A x Hx). rewrite E, X in Y. simpl in Y. injection Y as Y.
  assert (N := F x Hx). rewrite X, (proj2 (Nat.eqb_neq _ _)) in N by lia.
  assert (y = sigma M x) as -> by (apply I; congruence).
  assert (Z := B x Hx). rewrite E in Z. cbn [option_map] in Z. injection Z as Z. rewrite (G x Hx) in Z.
  assert (L := G1 x Hx).
  destruct (Nat.ltb_spec (psi x) m), (Nat.eqb_spec (S (psi x)) (2 * m)); lia.
Qed.

(** Every size from 2 edges on has twins of one vertex: to a robot with an undirected marker they look
    the same behind all doors, and no map is both.
    Not in the paper. *)
Theorem loops_look_alike m : 2 <= m -> world (nested m) /\ world (opposed m) /\
  twinned (nested m) (opposed m) (fun a b => a < 2 * m /\ b < 2 * m) /\
  ~ exists M, same_map M (nested m) /\ same_map M (opposed m).
Proof.
  intros Hm. assert (P : 0 < m) by lia.
  assert (N := fun d => nested_partners m d P). assert (O := fun d => opposed_partners m d P).
  split; [apply one_vertex_world; auto|]. split; [apply one_vertex_world; auto|].
  split; [|intros (M & A & B); apply (not_both m M Hm A B)].
  intros a b [Ha Hb]. unfold nested, opposed.
  assert (A := sight_loops m _ P N a Ha). assert (B := sight_loops m _ P O b Hb).
  split; [congruence|]. intros k Hk. rewrite (f_equal fst A : degree _ _ = 2 * m) in Hk.
  destruct (move_loops m _ P N a k Ha Hk) as (c & C & Lc).
  destruct (move_loops m _ P O b k Hb Hk) as (d & D & Ld). exists c, d. auto.
Qed.

(** No mapper for an undirected marker is right in all worlds, nor in all worlds of any one size from 2
    edges on.
    Paper, I: A single immovable marker that is undirected is not enough. *)
Theorem undirected_not_enough f m : 2 <= m ->
  ~ forall W, world W -> darts W = 2 * m -> maps_it f W.
Proof.
  intros Hm H. destruct (loops_look_alike m Hm) as (A & B & T & N). apply N.
  apply (twins_undetermined f _ _ _ T); [simpl; lia|apply H; auto..].
Qed.
