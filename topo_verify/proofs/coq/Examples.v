(** Worlds given as lists, the mapper run by Coq, and why the marker needs a direction.

    The counterexample to claim 4 without the direction is in docs/semantics.md, section 10. *)
From Coq Require Import Arith Lia List Bool.
Import ListNotations.
From Topo Require Import World Rotation Embedding Augment Program Ways ReferencePolicies Algorithms.

(** The map with sigma and alpha given as lists, and this root. *)
Definition of_lists s a r := {| darts := length s; sigma := fun d => nth d s 0;
  alpha := fun d => nth_error a d; root := r |}.

(** The lists of sigma and alpha of a map, and its root. *)
Definition to_lists M := (map (sigma M) (seq 0 (darts M)), map (alpha M) (seq 0 (darts M)), root M).

(** The decision procedure for [world]; the tree decides whether the map is connected. *)
Definition is_worldb W := (root W <? darts W) && forallb (fun d => (sigma W d <? darts W) &&
    forallb (fun e => negb (sigma W d =? sigma W e) || (d =? e)) (seq 0 (darts W)) &&
    match alpha W d with
    | Some e => (e <? darts W) && negb (e =? d) &&
                match alpha W e with Some x => x =? d | None => false end
    | None => false
    end && existsb (fun x => fst x =? lowest W d) (tree_from W (root W)))
  (seq 0 (darts W)).

(** What is walked to is reached. *)
Lemma walk_reach M p w : forall a b, reach M p a -> walk M a w = Some b -> reach M p b.
Proof.
  induction w as [|k w IH]; simpl; intros a b R H; [congruence|].
  unfold move in H. destruct (k <? degree M a); [|discriminate].
  destruct (alpha M (turn M k a)) as [c|] eqn:Ec; [|discriminate].
  apply (IH c); auto. apply (reach_alpha _ _ (turn M k a)); auto using reach_turn.
Qed.

(** What [is_worldb] accepts is a world. *)
Theorem is_worldb_true W : is_worldb W = true -> world W.
Proof.
  unfold is_worldb. rewrite andb_true_iff, forallb_forall. intros [R H]. apply Nat.ltb_lt in R.
  assert (D : forall d, d < darts W -> sigma W d < darts W /\
    (forall e, e < darts W -> sigma W d = sigma W e -> d = e) /\
    (exists e, alpha W d = Some e /\ e < darts W /\ e <> d /\ alpha W e = Some d) /\
    existsb (fun x => fst x =? lowest W d) (tree_from W (root W)) = true).
  { intros d Hd. specialize (H d). rewrite in_seq, !andb_true_iff, forallb_forall in H.
    destruct H as [[[A B] C] F]; [lia|]. repeat split; auto.
    - apply Nat.ltb_lt; auto.
    - intros e He Ee. specialize (B e). rewrite in_seq, Ee, Nat.eqb_refl in B.
      apply Nat.eqb_eq, B. lia.
    - destruct (alpha W d) as [e|]; [|discriminate]. exists e. rewrite !andb_true_iff in C.
      destruct C as [[C1 C2] C3]. apply Nat.ltb_lt in C1. apply negb_true_iff, Nat.eqb_neq in C2.
      destruct (alpha W e) as [x|]; [|discriminate]. apply Nat.eqb_eq in C3. subst x. auto. }
  assert (WW : is_map W).
  { split; auto; [apply D|intros d e Hd He; apply D; auto|].
    intros d e Hd He. destruct (D d Hd) as (_ & _ & (x & Hx & Q) & _).
    replace e with x by congruence. auto. }
  split; auto.
  - intros d Hd. destruct (D d Hd) as (_ & _ & (x & Hx & _) & _). congruence.
  - intros d Hd. destruct (D d Hd) as (_ & _ & _ & F).
    apply existsb_exists in F as ((v, (n, b)) & I & E).
    simpl in E. apply Nat.eqb_eq in E. subst v. destruct (tree_good W (root W) WW R) as [G _].
    destruct (descend_spec W (root W) WW _ G n d b Hd I) as (_ & Lq & Eq & Hw).
    destruct (lowest_turn W WW _ _ Lq R Eq) as (k & _ & Ek).
    apply (reach_sym W d (root W)); auto. rewrite <- Ek. apply reach_turn.
    eapply walk_reach; [constructor|exact Hw].
Qed.

(** A torus: two vertices, three edges, sigma = (0 1 2)(3 4 5), alpha = (0 3)(1 4)(2 5). *)
Definition torus := of_lists [1;2;0;4;5;3] [3;4;5;0;1;2] 0.

(** The torus is a world. *)
Example torus_world : world torus. Proof. apply is_worldb_true; reflexivity. Qed.

(** The mapper, run by Coq in the torus, delivers the torus. *)
Example torus_built : option_map (fun run => to_lists (fst (fst run))) (perform torus 0
    (run_of enhancement_ii nearest way_to shortest 6 (percept torus 0))) =
  Some ([1;2;0;4;5;3], [Some 3; Some 4; Some 5; Some 0; Some 1; Some 2], 0).
Proof. reflexivity. Qed.

(** The marker's direction is needed: if the last percept shows the marker without its direction,
    [confirm] fails already in the world of one vertex and two loops (0 1)(2 3).
    Paper, I: A single immovable marker that is undirected is not enough. *)
Example undirected_fails : exists M W phi a h, world W /\ embedded M W phi /\ a < darts W /\ h <
  darts M /\
  degree M h = degree W a /\ marker M h <> None /\ marker W a <> None /\ a <> phi h.
Proof.
  exists (initial 4), (of_lists [1;2;3;0] [1;0;3;2] 0), id, 1, 2.
  split; [apply is_worldb_true; reflexivity|]. split; [split; simpl; auto; try discriminate|].
  { intros d Hd. do 4 (destruct d as [|d]; [reflexivity|]). lia. }
  repeat split; simpl; auto; discriminate.
Qed.
