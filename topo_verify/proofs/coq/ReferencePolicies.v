(** The reference policies and the others, each with its contract (docs/semantics.md, section 5).

    nearest      the open dart with the least distance from the robot; ties: the lowest dart
    shortest     the hypotheses by the length of the way home, then by dart
    first_open, last_open, oldest, newest    by dart, ascending or descending

    M is a map, p the dart where the robot is, l a list of darts. *)
From Coq Require Import Arith Lia List Bool Permutation.
Import ListNotations.
From Topo Require Import World Augment Mapper Ways.

(** The darts that are unexplored. *)
Definition opens M := filter (fun d => negb (explored M d)) (seq 0 (darts M)).

(** An element for which f is least; the first of those. *)
Fixpoint least (f : nat -> nat) l := match l with
  | [] => None
  | d :: l => match least f l with Some b => if f b <? f d then Some b else Some d | None => Some d end
  end.

(** Pick policy nearest. *)
Definition nearest M p := let t := tree_from M p in least (far_from M t) (opens M).

(** Pick policy first: the lowest open dart. *)
Definition first_open M (p : nat) := hd_error (opens M).

(** Pick policy last: the highest open dart. *)
Definition last_open M (p : nat) := hd_error (rev (opens M)).

(** Insert a dart with its key behind those whose keys are not greater. *)
Fixpoint insert_key (x : nat * nat) l := match l with
  | [] => [x] | y :: l => if fst x <? fst y then x :: y :: l else y :: insert_key x l end.

(** Order policy shortest. The hypotheses come in ascending order, which is kept among equals. *)
Definition shortest M l := let t := tree_from M (root M) in
  map snd (fold_left (fun l x => insert_key x l) (map (fun h => (far_from M t h, h)) l) []).

(** Order policy oldest: the hypotheses come in ascending order. *)
Definition oldest (M : Map) (l : list nat) := l.

(** Order policy newest. *)
Definition newest (M : Map) (l : list nat) := rev l.

(** The open darts are those without a partner. *)
Lemma opens_spec M d : In d (opens M) <-> d < darts M /\ alpha M d = None.
Proof.
  unfold opens, explored. rewrite filter_In, in_seq. destruct (alpha M d); simpl; intuition
    (try lia; discriminate).
Qed.

(** A policy that chooses among the open darts if there is one fulfils its contract. *)
Lemma pick_among pick : (forall M p, match pick M p with
  | Some e => In e (opens M) | None => opens M = [] end) -> good_pick pick.
Proof.
  intros H M p. specialize (H M p). destruct (pick M p) as [e|]; [apply opens_spec; auto|].
  intros d Hd Od. assert (I := proj2 (opens_spec M d) (conj Hd Od)). rewrite H in I. destruct I.
Qed.

(** The least element of a list is in the list. *)
Lemma least_in f l : match least f l with Some d => In d l | None => l = [] end.
Proof.
  induction l as [|d l IH]; simpl; auto. destruct (least f l) as [b|]; auto.
  destruct (_ <? _); auto.
Qed.

(** Pick policy nearest fulfils its contract. *)
Theorem nearest_good : good_pick nearest.
Proof. apply pick_among. intros M p. apply least_in. Qed.

(** Pick policy first fulfils its contract. *)
Theorem first_open_good : good_pick first_open.
Proof. apply pick_among. intros M p. unfold first_open. destruct (opens M); simpl; auto. Qed.

(** Pick policy last fulfils its contract. *)
Theorem last_open_good : good_pick last_open.
Proof.
  apply pick_among. intros M p. unfold last_open. destruct (rev (opens M)) as [|d l] eqn:E; simpl.
  - rewrite <- (rev_involutive (opens M)), E. auto.
  - apply in_rev. rewrite E. left. auto.
Qed.

(** Inserting adds one element. *)
Lemma insert_key_permutes x l : Permutation (insert_key x l) (x :: l).
Proof.
  induction l as [|y l IH]; simpl; auto. destruct (_ <? _); auto.
  apply perm_trans with (y :: x :: l); [auto|apply perm_swap].
Qed.

(** Order policy shortest fulfils its contract. *)
Theorem shortest_good : good_order shortest.
Proof.
  intros M l. unfold shortest. set (key := far_from M (tree_from M (root M))).
  assert (S : forall k acc, Permutation (fold_left (fun l x => insert_key x l) k acc) (k ++ acc)).
  { intros k. induction k as [|x k IH]; simpl; intros acc; auto. eapply perm_trans; [apply IH|].
    eapply perm_trans; [apply Permutation_app_head, insert_key_permutes|].
    apply Permutation_sym, Permutation_middle. }
  eapply perm_trans; [apply Permutation_map, S|]. rewrite app_nil_r, map_map, map_id. auto.
Qed.

(** Order policy oldest fulfils its contract. *)
Theorem oldest_good : good_order oldest.
Proof. intros M l. apply Permutation_refl. Qed.

(** Order policy newest fulfils its contract. *)
Theorem newest_good : good_order newest.
Proof. intros M l. apply Permutation_sym, Permutation_rev. Qed.
