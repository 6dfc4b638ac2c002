(** The policies random, whatever the generator chooses (docs/semantics.md, section 5).

    A generator remembers how often it was asked, and a policy in Coq is a function of S. But S tells
    how many edges have been explored, and so which choice it is: pick and order are asked once for
    each edge, or order not at all where there is no hypothesis. Here c and ks are any sequences of
    choices: c i is the one that picks the dart after i edges, ks i are those that shuffle the
    hypotheses then. What holds for every sequence holds for the choices of Python's generator in any
    run.

    M is a map, p the dart where the robot is, e a dart, k a choice, l a list of darts. *)
From Coq Require Import Arith Lia List Bool Permutation.
Import ListNotations.
From Topo Require Import World Vertices Augment Program Mapper Ways ReferencePolicies Algorithms.

(** How many edges of the map have been explored. *)
Definition edges_explored M := Nat.div2 (known M).

(** Pick policy random: the choice, modulo their number, counts the open darts. *)
Definition chosen_dart (c : nat -> nat) M (p : nat) :=
  nth_error (opens M) (c (edges_explored M) mod length (opens M)).

(** The elements of l in the order in which the choices take them out, each modulo the number left. *)
Fixpoint dealt ks (l : list nat) := match ks with
  | [] => l
  | k :: ks => let i := k mod length l in match skipn i l with
      | [] => l | x :: rest => x :: dealt ks (firstn i l ++ rest) end end.

(** Order policy random. *)
Definition shuffled (ks : nat -> list nat) M l := dealt (ks (edges_explored M)) l.

(** Whatever the choices, the pick policy fulfils its contract. *)
Theorem chosen_dart_good c : good_pick (chosen_dart c).
Proof.
  apply pick_among. intros M p. unfold chosen_dart. set (i := _ mod _).
  destruct (nth_error (opens M) i) as [e|] eqn:E; [apply (nth_error_In _ _ E)|].
  apply nth_error_None in E. destruct (opens M) as [|d l]; auto. unfold i in E.
  assert (B := Nat.mod_upper_bound (c (edges_explored M)) (length (d :: l))).
  simpl length in *. lia.
Qed.

(** Dealing permutes. *)
Lemma dealt_permutes ks : forall l, Permutation (dealt ks l) l.
Proof.
  induction ks as [|k ks IH]; simpl; intros l; auto. set (i := k mod length l).
  destruct (skipn i l) as [|x rest] eqn:E; auto. eapply perm_trans; [apply perm_skip, IH|].
  rewrite <- (firstn_skipn i l) at 2. rewrite E. apply Permutation_middle.
Qed.

(** Whatever the choices, the order policy fulfils its contract. *)
Theorem shuffled_good ks : good_order (shuffled ks).
Proof. intros M l. apply dealt_permutes. Qed.

(** Every open dart can be chosen: no pick of a generator is left out. *)
Theorem chosen_dart_any M e : e < darts M -> alpha M e = None -> exists k, forall c p,
  c (edges_explored M) = k -> chosen_dart c M p = Some e.
Proof.
  intros He Oe. destruct (In_nth_error (opens M) e) as [k E]; [apply opens_spec; auto|].
  exists k. intros c p <-. unfold chosen_dart. rewrite Nat.mod_small; auto.
  apply nth_error_Some. congruence.
Qed.

(** Every permutation can be dealt: no order of a generator is left out. *)
Theorem dealt_any l' : forall l, Permutation l l' -> exists ks, dealt ks l = l'.
Proof.
  induction l' as [|x l' IH]; intros l P.
  - exists []. apply Permutation_sym, Permutation_nil in P. auto.
  - destruct (in_split x l) as (a & b & ->); [apply (Permutation_in x (Permutation_sym P)); left; auto|].
    destruct (IH (a ++ b)) as [ks E].
    { apply Permutation_cons_inv with x. eapply perm_trans; [apply Permutation_middle|auto]. }
    exists (length a :: ks). simpl. rewrite Nat.mod_small by (rewrite app_length; simpl; lia).
    rewrite skipn_app, skipn_all, firstn_app, firstn_all, Nat.sub_diag. simpl.
    rewrite app_nil_r. f_equal. auto.
Qed.

(** Claims 5 and 7 with random policies: whatever the choices, an algorithm of the paper ends with
    the world, within the bound.
    Paper, I, II-C: With a directional marker the world can be mapped deterministically. *)
Theorem random_mapped A c ks W : maps_all A -> world W -> exists M b ms m,
  perform W (root W) (run_of A (chosen_dart c) way_to (shuffled ks) (darts W) (percept W (root W))) =
    Some (M, b, ms) /\
  isomorphic M W /\ darts W = 2 * m /\
  m <= length ms <= m * (vertices W + (2 * m - 1) * (2 * (vertices W - 1))).
Proof. intros G. apply G; [apply chosen_dart_good|apply way_to_good|apply shuffled_good]. Qed.
