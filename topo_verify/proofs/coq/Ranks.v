(** Ranks: each place of the list of worlds is computed without the list, and back (docs/semantics.md,
    section 12).

    The letters are those of Listed.v; k is a rank, a place of the list, counted from 0 as a binary
    number; t is half of u + r, the number of edges to come.

    A list of lists, one for each element of another list, is found by how long they are: [block] finds
    the list into which a rank falls, and the rank within it. The lengths are read from the table of the
    closed formula, [formula], of which each row is computed from the one before. *)
From Coq Require Import Arith NArith Lia List Bool.
Import ListNotations.
From Topo Require Import World Embedding Augment AnyWorld Numbered Listed ListedOnce.

(** The sum of some binary numbers. *)
Fixpoint sum_of (l : list N) := match l with [] => 0%N | x :: l => N.add x (sum_of l) end.

(** From the row of the formula for t, which holds F(2t - r, r) for r = 0, ..., 2t, the row for t + 1. *)
Definition next_row t (l : list N) :=
  map (fun r => (N.of_nat (2 * t + 1 - r) * nth r l 0 + sum_of (firstn r l))%N) (seq 0 (2 * t + 2)) ++
  [0%N].

(** The rows for t and n - 1 more, l being the row for t. *)
Fixpoint rows_from n t l := match n with 0 => [] | S n => l :: rows_from n (S t) (next_row t l) end.

(** The rows for 0, ..., n - 1. *)
Definition formula_rows n := rows_from n 0 [1%N].

(** The block into which rank k falls, if the blocks are so long, and the rank within it. *)
Fixpoint block (lengths : list N) k : nat * N := match lengths with
  | [] => (0, k)
  | x :: l => if (k <? x)%N then (0, k) else let (i, k') := block l (k - x)%N in (S i, k') end.

(** The place of the first element that satisfies f. *)
Fixpoint place_where {A} (f : A -> bool) l := match l with
  | [] => 0 | x :: l => if f x then 0 else S (place_where f l) end.

(** Are two steps equal? *)
Definition growth_eqb s s' := match s, s' with
  | Meet j, Meet k => j =? k | Hang d, Hang e => d =? e | _, _ => false end.

Section Formula.
Variable F : nat -> nat -> N.

(** How many sequences begin with the step s, where n edges follow it and r darts are to be created. *)
Definition beginning n r s := match s with Meet _ => F n r | Hang d => F n (r - d) end.

(** The sequence of rank k. *)
Fixpoint sequence_at n u r k : list growth := match n, u with
  | S n, S u => let l := growths_next u r in
      let (i, k) := block (map (beginning n r) l) k in let s := nth i l (Meet 0) in
      s :: match s with
           | Meet _ => sequence_at n (u - 1) r k
           | Hang d => sequence_at n (u + d - 1) (r - d) k end
  | _, _ => [] end.

(** The rank of a sequence. *)
Fixpoint sequence_rank n u r ss : N := match n, u, ss with
  | S n, S u, s :: ss => let l := growths_next u r in
      N.add (sum_of (map (beginning n r) (firstn (place_where (growth_eqb s) l) l))) match s with
        | Meet _ => sequence_rank n (u - 1) r ss
        | Hang d => sequence_rank n (u + d - 1) (r - d) ss end
  | _, _, _ => 0%N end.

(** How many plans there are with a first vertex of degree d. *)
Definition rooted m d := F m (2 * m - d).

(** The plan of rank k. *)
Definition plan_at m k := let (i, k) := block (map (rooted m) (seq 1 (2 * m))) k in
  (S i, sequence_at m (S i) (2 * m - S i) k).

(** The rank of a plan. *)
Definition plan_rank m (p : nat * list growth) := N.add (sum_of (map (rooted m) (seq 1 (fst p - 1))))
  (sequence_rank m (fst p) (2 * m - fst p) (snd p)).
End Formula.

(** The numbers F(2n - r, r), read from the rows for at most m edges. *)
Definition by_rows (rows : list (list N)) n r := nth r (nth n rows []) 0%N.

(** The number of worlds with m > 0 edges. *)
Definition world_number m := let F := by_rows (formula_rows (S m)) in
  sum_of (map (rooted F m) (seq 1 (2 * m))).

(** The world of rank k among those with m > 0 edges. *)
Definition unrank m k := planned (plan_at (by_rows (formula_rows (S m))) m k).

(** The rank of a world with m > 0 edges. *)
Definition world_rank m W := plan_rank (by_rows (formula_rows (S m))) m (plan_of m W).

(** A number from the sum of the numbers, and back. *)
Lemma sum_of_nat l : sum_of (map N.of_nat l) = N.of_nat (list_sum l).
Proof. induction l as [|x l IH]; simpl; auto. rewrite IH. lia. Qed.

(** The sum of two lists. *)
Lemma sum_of_app l l' : sum_of (l ++ l') = (sum_of l + sum_of l')%N.
Proof. induction l as [|x l IH]; simpl; auto. rewrite IH. lia. Qed.

(** The first elements of a list, one more. *)
Lemma firstn_S_nth {A} (l : list A) x k : k < length l -> firstn (S k) l = firstn k l ++ [nth k l x].
Proof.
  revert k. induction l as [|y l IH]; simpl; intros k L; [lia|]. destruct k as [|k]; auto.
  simpl. rewrite <- IH by lia. auto.
Qed.

(** The row for t. *)
Fixpoint formula_row t := match t with 0 => [1%N] | S t => next_row t (formula_row t) end.

(** The rows are these. *)
Lemma rows_from_right n : forall t, rows_from n t (formula_row t) = map formula_row (seq t n).
Proof. induction n as [|n IH]; intros t; simpl; auto. f_equal. apply (IH (S t)). Qed.

(** Each row has its length, and holds the numbers of the formula. *)
Lemma formula_row_right t : length (formula_row t) = 2 * t + 1 /\
  forall r, r <= 2 * t -> nth r (formula_row t) 0%N = N.of_nat (completions t (2 * t - r) r).
Proof.
  induction t as [|t [L IH]]; [split; auto; intros r Hr; assert (r = 0) as -> by lia; auto|].
  cbn [formula_row]. unfold next_row. split; [rewrite app_length, map_length, seq_length; simpl; lia|].
  intros r Hr. destruct (Nat.eq_dec r (2 * S t)) as [->|N].
  - rewrite app_nth2; rewrite map_length, seq_length; [|lia].
    replace (2 * S t - (2 * t + 2)) with 0 by lia. rewrite Nat.sub_diag. simpl. auto.
  - rewrite app_nth1 by (rewrite map_length, seq_length; lia).
    rewrite (nth_indep _ _ ((fun r => (N.of_nat (2 * t + 1 - r) * nth r (formula_row t) 0 +
      sum_of (firstn r (formula_row t)))%N) 0)) by (rewrite map_length, seq_length; lia).
    rewrite (map_nth (fun r => (N.of_nat (2 * t + 1 - r) * nth r (formula_row t) 0 +
      sum_of (firstn r (formula_row t)))%N)), seq_nth, Nat.add_0_l by lia.
    replace (2 * S t - r) with (S (2 * t + 1 - r)) by lia. cbn [completions].
    rewrite Nat2N.inj_add, Nat2N.inj_mul. f_equal.
    + destruct (Nat.eq_dec r (2 * t + 1)) as [->|N']; [rewrite !Nat.sub_diag; auto|].
      rewrite IH by lia. do 3 f_equal; lia.
    + rewrite <- sum_of_nat, map_map. assert (Sum : forall k, k <= 2 * t + 1 -> k <= r ->
        sum_of (firstn k (formula_row t)) = sum_of (map (fun d => N.of_nat (completions t
          (2 * t + 1 - r + d - 1) (r - d))) (seq (S (r - k)) k))).
      { intros k. induction k as [|k IHk]; auto. intros L1 L2.
        assert (Lk : k < length (formula_row t)) by lia.
        rewrite (firstn_S_nth _ 0%N) by auto. rewrite sum_of_app, IHk, IH by lia.
        replace (seq (S (r - S k)) (S k)) with ((r - k) :: seq (S (r - k)) k)
          by (simpl; do 2 f_equal; lia).
        simpl. rewrite N.add_0_r, N.add_comm. f_equal. do 2 f_equal; lia. }
      rewrite (Sum r) by lia. rewrite Nat.sub_diag. auto.
Qed.

(** The rows say what the formula says. *)
Lemma by_rows_right m n u r : n <= m -> u + r = 2 * n ->
  by_rows (formula_rows (S m)) n r = N.of_nat (length (growths n u r)).
Proof.
  intros L E. unfold by_rows, formula_rows. change [1%N] with (formula_row 0). rewrite rows_from_right.
  rewrite (nth_indep _ _ (formula_row 0))
    by (rewrite map_length, seq_length; lia).
  rewrite (map_nth formula_row), seq_nth, growths_length by lia. simpl plus.
  rewrite (proj2 (formula_row_right n)) by lia. do 2 f_equal. lia.
Qed.

(** A rank below the sum falls into a block. *)
Lemma block_right lengths : forall k, (k < sum_of lengths)%N -> let (i, k') := block lengths k in
  i < length lengths /\ (k' < nth i lengths 0)%N /\ (k = sum_of (firstn i lengths) + k')%N.
Proof.
  induction lengths as [|x l IH]; simpl; intros k Lk; [lia|]. destruct (N.ltb_spec k x) as [L|L].
  - simpl. lia.
  - specialize (IH (k - x)%N). destruct (block l (k - x)%N) as [i k'].
    destruct IH as (A & B & C); [lia|]. simpl. lia.
Qed.

(** The elements of one of the lists are behind those of the lists before it. *)
Lemma nth_flat_map {A B} (f : A -> list B) l x0 : forall i k, i < length l ->
  k < length (f (nth i l x0)) ->
  nth_error (flat_map f l) (list_sum (map (fun x => length (f x)) (firstn i l)) + k) =
  nth_error (f (nth i l x0)) k.
Proof.
  induction l as [|x l IH]; simpl; intros i k Li Lk; [lia|]. destruct i as [|i]; simpl.
  - rewrite nth_error_app1; auto.
  - rewrite nth_error_app2 by lia. rewrite <- IH by (auto; lia). f_equal. lia.
Qed.

Section Ranked_list.
Variable m : nat.
Notation F := (by_rows (formula_rows (S m))).

(** How many sequences begin with a step. *)
Lemma beginning_right n v r s : S n <= m -> S v + r = 2 * S n -> In s (growths_next v r) ->
  beginning F n r s = N.of_nat (length (map (cons s) match s with
    | Meet _ => growths n (v - 1) r | Hang d => growths n (v + d - 1) (r - d) end)).
Proof.
  intros L E I. rewrite map_length. apply in_growths_next in I.
  destruct s as [j|d]; apply by_rows_right; lia.
Qed.

(** As binary numbers, the lengths of the lists are those of the formula. *)
Lemma lengths_right {A B} (f : A -> N) (g : A -> list B) l :
  (forall x, In x l -> f x = N.of_nat (length (g x))) ->
  sum_of (map f l) = N.of_nat (list_sum (map (fun x => length (g x)) l)).
Proof.
  intros H. rewrite <- sum_of_nat, map_map. f_equal. apply map_ext_in. auto.
Qed.

(** The first elements are elements. *)
Lemma in_firstn {A} (x : A) i l : In x (firstn i l) -> In x l.
Proof. intros I. rewrite <- (firstn_skipn i l). apply in_or_app. auto. Qed.

(** The sequence of rank k stands at place k of the list. *)
Lemma sequence_at_right n : forall u r k, n <= m -> u + r = 2 * n ->
  (k < N.of_nat (length (growths n u r)))%N ->
  nth_error (growths n u r) (N.to_nat k) = Some (sequence_at F n u r k).
Proof.
  induction n as [|n IH]; intros u r k L E Lk.
  - assert (u = 0) as -> by lia. assert (r = 0) as -> by lia. simpl in *.
    replace k with 0%N by lia. auto.
  - destruct u as [|v]; [simpl in Lk; lia|]. cbn [growths sequence_at] in *. rewrite flat_map_sum in Lk.
    assert (B := beginning_right n v r). rewrite <- (lengths_right (beginning F n r)) in Lk
      by (intros s I; apply B; auto).
    assert (R := block_right _ k Lk). cbv zeta.
    destruct (block (map (beginning F n r) (growths_next v r)) k) as [i k'].
    rewrite map_length in R. destruct R as (Li & Lk' & ->).
    rewrite (nth_indep _ 0%N (beginning F n r (Meet 0))), map_nth in Lk' by (rewrite map_length; auto).
    assert (I := nth_In (growths_next v r) (Meet 0) Li). rewrite (B _ L E I) in Lk'.
    rewrite firstn_map, (lengths_right _ (fun s => map (cons s) match s with
      | Meet _ => growths n (v - 1) r | Hang d => growths n (v + d - 1) (r - d) end))
      by (intros s J; apply B; auto; apply in_firstn in J; auto).
    rewrite N2Nat.inj_add, Nat2N.id, (nth_flat_map _ _ (Meet 0)) by (auto; lia).
    apply in_growths_next in I. rewrite map_length in Lk'.
    destruct (nth i (growths_next v r) (Meet 0)) as [j|d];
      rewrite nth_error_map, IH by (auto; lia); auto.
Qed.

(** Steps are compared. *)
Lemma growth_eqb_spec s s' : reflect (s = s') (growth_eqb s s').
Proof.
  destruct s as [j|d], s' as [k|e]; simpl; try (constructor; discriminate);
    [destruct (Nat.eqb_spec j k)|destruct (Nat.eqb_spec d e)]; constructor; congruence.
Qed.

(** An element is at its place. *)
Lemma place_where_right s l : In s l -> place_where (growth_eqb s) l < length l /\
  nth (place_where (growth_eqb s) l) l (Meet 0) = s.
Proof.
  induction l as [|x l IH]; simpl; [intros []|]. intros I. destruct (growth_eqb_spec s x) as [->|N].
  - split; [lia|auto].
  - destruct IH; [destruct I; [congruence|auto]|]. split; [lia|auto].
Qed.

(** A sequence stands at the place of its rank. *)
Lemma sequence_rank_right n : forall u r ss, n <= m -> u + r = 2 * n -> In ss (growths n u r) ->
  nth_error (growths n u r) (N.to_nat (sequence_rank F n u r ss)) = Some ss.
Proof.
  induction n as [|n IH]; intros u r ss L E I.
  - assert (u = 0) as -> by lia. assert (r = 0) as -> by lia. destruct I as [<-|[]]. auto.
  - assert (I' := I). apply in_growths in I' as (s & rest & v & -> & -> & Is & J).
    cbn [growths sequence_rank].
    assert (B := beginning_right n v r). destruct (place_where_right s _ Is) as [Li Ni]. cbv zeta.
    set (i := place_where (growth_eqb s) (growths_next v r)) in *.
    rewrite (lengths_right _ (fun s => map (cons s) match s with
      | Meet _ => growths n (v - 1) r | Hang d => growths n (v + d - 1) (r - d) end))
      by (intros s' J'; apply B; auto; apply in_firstn in J'; auto).
    apply in_growths_next in Is.
    set (q := match s with Meet _ => _ | Hang d => _ end). assert (Q : nth_error match s with
      | Meet _ => growths n (v - 1) r | Hang d => growths n (v + d - 1) (r - d) end
      (N.to_nat q) = Some rest)
      by (destruct s as [j|d]; apply IH; auto; lia).
    rewrite N2Nat.inj_add, Nat2N.id, (nth_flat_map _ _ (Meet 0)), Ni.
    + rewrite nth_error_map, Q. auto.
    + auto.
    + rewrite Ni, map_length. apply nth_error_Some. congruence.
Qed.

(** The plans with a first vertex of degree d are as many as the formula says. *)
Lemma rooted_right d : In d (seq 1 (2 * m)) ->
  rooted F m d = N.of_nat (length (map (pair d) (growths m d (2 * m - d)))).
Proof. intros I. apply in_seq in I. rewrite map_length. apply by_rows_right; lia. Qed.

(** The plan of rank k stands at place k of the list. *)
Lemma plan_at_right k : (k < world_number m)%N ->
  nth_error (plans m) (N.to_nat k) = Some (plan_at F m k).
Proof.
  intros Lk. assert (R := block_right _ k Lk). unfold plan_at.
  destruct (block (map (rooted F m) (seq 1 (2 * m))) k) as [i k']. rewrite map_length, seq_length in R.
  destruct R as (Li & Lk' & ->).
  rewrite (nth_indep _ 0%N (rooted F m 0)), map_nth, seq_nth in Lk'
    by (rewrite ?map_length, ?seq_length; auto).
  rewrite rooted_right in Lk' by (apply in_seq; lia). unfold plans.
  rewrite firstn_map, (lengths_right _ (fun d => map (pair d) (growths m d (2 * m - d))))
    by (intros d I; apply in_firstn in I; apply rooted_right; auto).
  rewrite N2Nat.inj_add, Nat2N.id, (nth_flat_map _ _ 0) by (rewrite ?seq_length, ?seq_nth; auto; lia).
  rewrite seq_nth by auto. rewrite map_length in Lk'. simpl plus in *.
  rewrite nth_error_map, sequence_at_right by (auto; lia). auto.
Qed.

(** A plan stands at the place of its rank. *)
Lemma plan_rank_right p : In p (plans m) ->
  nth_error (plans m) (N.to_nat (plan_rank F m p)) = Some p.
Proof.
  destruct p as (d, ss). intros I. apply in_plans in I as [L I]. unfold plan_rank. simpl fst. simpl snd.
  assert (Q := sequence_rank_right m d (2 * m - d) ss ltac:(lia) ltac:(lia) I).
  assert (S1 : seq 1 (d - 1) = firstn (d - 1) (seq 1 (2 * m))).
  { replace (2 * m) with (d - 1 + (2 * m - (d - 1))) by lia. rewrite seq_app, firstn_app, seq_length.
    rewrite Nat.sub_diag, firstn_O, app_nil_r, firstn_all2; auto. rewrite seq_length. lia. }
  rewrite S1, (lengths_right _ (fun d => map (pair d) (growths m d (2 * m - d))))
    by (intros x J; apply in_firstn in J; apply rooted_right; auto).
  unfold plans. assert (Nd : nth (d - 1) (seq 1 (2 * m)) 0 = d) by (rewrite seq_nth; lia).
  rewrite N2Nat.inj_add, Nat2N.id, (nth_flat_map _ _ 0), Nd.
  - rewrite nth_error_map, Q. auto.
  - rewrite seq_length. lia.
  - rewrite Nd, map_length. apply nth_error_Some. congruence.
Qed.

(** The ranks are those of the list. *)
Lemma world_number_plans : N.to_nat (world_number m) = length (plans m).
Proof.
  unfold world_number, plans. rewrite (lengths_right _ (fun d => map (pair d) (growths m d (2 * m - d))))
    by apply rooted_right. rewrite Nat2N.id, flat_map_sum. auto.
Qed.
End Ranked_list.

(** The world of rank k stands at place k of the list of all worlds, and the list is as long as
    [world_number] says.
    Not in the paper. *)
Theorem unrank_listed m k : 0 < m -> (k < world_number m)%N ->
  nth_error (listed m) (N.to_nat k) = Some (Edges (unrank m k)) /\
  length (listed m) = N.to_nat (world_number m).
Proof.
  intros Pm Lk. destruct m as [|m]; [lia|]. unfold listed.
  rewrite nth_error_map, plan_at_right, map_length, world_number_plans; auto.
Qed.

(** The rank of the world of rank k is k.
    Not in the paper. *)
Theorem rank_unrank m k : (k < world_number m)%N -> world_rank m (unrank m k) = k.
Proof.
  intros Lk. assert (P := plan_at_right m k Lk). unfold world_rank, unrank.
  set (p := plan_at _ m k) in *. assert (I := nth_error_In _ _ P).
  assert (plan_of m (planned p) = p) as ->.
  { destruct p as (d, ss). assert (J := I). apply in_plans in J as [L J].
    destruct (growths_right _ _ _ _ _ (has_open_initial d ltac:(lia)) J) as (A & B & _).
    assert (Len : darts (planned (d, ss)) = 2 * m)
      by (unfold planned; simpl fst; simpl snd; rewrite B; simpl; lia).
    destruct (plan_of_right m (planned (d, ss)) A Len) as [K Iso]. apply (plans_differ m); auto. }
  apply N2Nat.inj, (proj1 (NoDup_nth_error (plans m)) (plans_once m)).
  - rewrite <- world_number_plans. assert (Q := plan_rank_right m p I).
    rewrite world_number_plans. apply nth_error_Some. congruence.
  - rewrite (plan_rank_right m p I). auto.
Qed.

(** The world of the rank of a world is that world.
    Not in the paper. *)
Theorem unrank_rank m W : world W -> darts W = 2 * m -> (world_rank m W < world_number m)%N /\
  isomorphic (unrank m (world_rank m W)) W.
Proof.
  intros HW Len. destruct (plan_of_right m W HW Len) as [I Iso].
  assert (Q := plan_rank_right m (plan_of m W) I). unfold world_rank.
  set (k := plan_rank _ m (plan_of m W)) in *. assert (Lk : (k < world_number m)%N).
  { assert (L : nth_error (plans m) (N.to_nat k) <> None) by congruence. apply nth_error_Some in L.
    rewrite <- world_number_plans in L. lia. }
  split; [auto|]. unfold unrank. rewrite (plan_at_right m k Lk) in Q. injection Q as ->. auto.
Qed.
