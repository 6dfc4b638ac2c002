(** Policies that fulfil the contracts of Mapper.v: the lowest open dart, breadth-first ways, rules
    none and history (docs/semantics.md, sections 5 and 7).

    With them the mapper is the algorithm [basic], and [basic] with the rule [history]. M is the
    map, W the world. *)
From Coq Require Import Arith Lia List Bool Permutation.
Import ListNotations.
From Topo Require Import World Rotation Embedding Augment Records Mapper MapperCorrect Search.

(** Pick the lowest open dart. *)
Definition first_open M (p : nat) := find (fun d => negb (explored M d)) (seq 0 (darts M)).

(** It is open, and it exists as long as a dart is open. *)
Theorem first_open_good : good_pick first_open.
Proof.
  intros M p. unfold first_open. destruct (find _ _) as [e|] eqn:F.
  - apply find_some in F as [H F]. apply in_seq in H. unfold explored in F.
    split; [lia|]. destruct (alpha M e); [discriminate|auto].
  - intros d Hd. assert (Q := find_none _ _ F d). unfold explored in Q. cbv beta in Q.
    destruct (alpha M d); [discriminate|]. discriminate Q. apply in_seq; lia.
Qed.

(** Rule none rejects no hypothesis without motion. *)
Definition rule_none (M : Map) (log : list (list nat * list Percept)) (h : nat) := true.

(** Rule history rejects h if percepts of doors that were executed behind this edge contradict
    the map traced from h. *)
Definition rule_history M (log : list (list nat * list Percept)) h :=
  forallb (fun l => agrees M (fun _ _ => None) h (fst l) (snd l)) log.

(** Rule none keeps the true hypothesis (claim 3). *)
Theorem rule_none_good : good_keep rule_none.
Proof. red; auto. Qed.

(** Rule history keeps the true hypothesis (claim 3). *)
Theorem rule_history_good : good_keep rule_history.
Proof.
  intros M W phi a log h WM WW E Hh Hlog Eh. apply forallb_forall. intros [w ps] Hin.
  apply (agrees_true M W phi); auto; [red; discriminate|]. subst a. apply Hlog; auto.
Qed.

(** The map that exploring W with this rule ends with. *)
Definition explores rule W := option_map (fun st => fst (fst st))
  (explore nat (percept W) (move W) first_open bfs_path (fun _ H => H) rule (darts W)
    (initial_state nat (percept W) (root W))).

(** With a rule that keeps the true hypothesis that map is isomorphic to W. *)
Lemma explores_correct rule W : good_keep rule -> world W ->
  exists M, explores rule W = Some M /\ isomorphic M W.
Proof.
  intros K HW. destruct (explore_correct first_open bfs_path (fun _ H => H) rule first_open_good
    (proj1 bfs_path_good) (fun _ l => Permutation_refl l) K W HW (darts W)) as (st & E & I); [lia|].
  exists (fst (fst st)). unfold explores. rewrite E. auto.
Qed.

(** Claim 5 for [basic]: in every world it ends with a map isomorphic to the world. *)
Theorem basic_correct W : world W -> exists M, explores rule_none W = Some M /\ isomorphic M W.
Proof. apply explores_correct, rule_none_good. Qed.

(** Claim 5 for [basic] with rule history. *)
Theorem history_correct W : world W -> exists M, explores rule_history W = Some M /\ isomorphic M W.
Proof. apply explores_correct, rule_history_good. Qed.
