(** Policies that exist: the lowest open dart, breadth-first ways; rules none and history.

    With them the mapper is the algorithm [basic], and [basic] with the rule [history]. *)
From Coq Require Import Arith Lia List Bool Permutation.
Import ListNotations.
From Topo Require Import World Rotation Embedding Augment Records Mapper MapperCorrect Search.

(** The lowest open dart. *)
Definition first_open M (p : nat) := find (fun d => negb (explored M d)) (seq 0 (darts M)).

(** It is open, and there is one as long as any is. *)
Theorem first_open_good : good_pick first_open.
Proof.
  intros M p. unfold first_open. destruct (find _ _) as [e|] eqn:F.
  - apply find_some in F as [H F]. apply in_seq in H. unfold explored in F.
    split; [lia|]. destruct (alpha M e); [discriminate|auto].
  - intros d Hd. assert (Q := find_none _ _ F d). unfold explored in Q. cbv beta in Q.
    destruct (alpha M d); [discriminate|]. discriminate Q. apply in_seq; lia.
Qed.

(** Rule none rejects nothing without motion. *)
Definition rule_none (M : Map) (log : list (list nat * list Percept)) (h : nat) := true.

(** Rule history traces what was executed. *)
Definition rule_history M (log : list (list nat * list Percept)) h :=
  forallb (fun l => agrees M (fun _ _ => None) h (fst l) (snd l)) log.

(** Claim 3 for rule none. *)
Theorem rule_none_good : good_keep rule_none.
Proof. red; auto. Qed.

(** Claim 3 for rule history. *)
Theorem rule_history_good : good_keep rule_history.
Proof.
  intros M W phi a log h WM WW E Hh Hlog Eh. apply forallb_forall. intros [w ps] Hin.
  apply (agrees_true M W phi); auto; [red; discriminate|]. subst a. apply Hlog; auto.
Qed.

(** The map that exploring W ends with. *)
Definition explores rule W := option_map (fun st => fst (fst st))
  (explore nat (percept W) (move W) first_open bfs_path (fun _ H => H) rule (darts W)
    (initial_state nat (percept W) (root W))).

(** It is the world. *)
Lemma explores_correct rule W : good_keep rule -> world W ->
  exists M, explores rule W = Some M /\ isomorphic M W.
Proof.
  intros K HW. destruct (explore_correct first_open bfs_path (fun _ H => H) rule first_open_good
    (proj1 bfs_path_good) (fun _ l => Permutation_refl l) K W HW (darts W)) as (st & E & I); [lia|].
  exists (fst (fst st)). unfold explores. rewrite E. auto.
Qed.

(** Claim 5 for [basic]: in every world of any size it ends with the world. *)
Theorem basic_correct W : world W -> exists M, explores rule_none W = Some M /\ isomorphic M W.
Proof. apply explores_correct, rule_none_good. Qed.

(** Claim 5 for [basic] with rule history. *)
Theorem history_correct W : world W -> exists M, explores rule_history W = Some M /\ isomorphic M W.
Proof. apply explores_correct, rule_history_good. Qed.
