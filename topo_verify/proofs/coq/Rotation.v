(** Turning, degrees, doors and walks in any map, explored or not (docs/semantics.md, sections 1 and
    2).

    M is a map; a, b, c, d are darts; i, j, k are offsets; w is a list of doors. sigma is a
    permutation, so turning returns to its dart after exactly [degree] steps. Every move can be
    undone, so walks by one and the same list of doors are injective.

    The file begins with lemmas on lists and counting and ends with the decidable equality of
    percepts, and with one world. *)
From Coq Require Import Arith Lia List Bool.
Import ListNotations.
From Topo Require Import World.

(** If f is injective on a list without duplicates, the mapped list has no duplicates. *)
Lemma nodup_map (f : nat -> nat) l : NoDup l ->
  (forall i j, In i l -> In j l -> f i = f j -> i = j) -> NoDup (map f l).
Proof.
  induction 1 as [|x l Hx Hl IH]; intros Hf; simpl; constructor.
  - rewrite in_map_iff. intros (y & E & Hy).
    rewrite (Hf y x) in Hy; simpl; auto.
  - apply IH; intros; apply Hf; simpl; auto.
Qed.

(** The pigeonhole principle: an injection of n numbers into m numbers exists only if n <= m. *)
Lemma pigeon (f : nat -> nat) n m : (forall i, i < n -> f i < m) ->
  (forall i j, i < n -> j < n -> f i = f j -> i = j) -> n <= m.
Proof.
  intros Hlt Hinj.
  rewrite <- (seq_length n 0), <- (seq_length m 0), <- (map_length f (seq 0 n)).
  apply NoDup_incl_length.
  - apply nodup_map; [apply seq_NoDup|].
    intros i j Hi Hj. apply in_seq in Hi, Hj. apply Hinj; lia.
  - intros y Hy. apply in_map_iff in Hy as (i & <- & Hi).
    apply in_seq in Hi. apply in_seq. specialize (Hlt i). lia.
Qed.

(** What [find] returns on an interval is the least number that satisfies f. *)
Lemma find_seq f n : forall s k, find f (seq s n) = Some k ->
  s <= k < s + n /\ f k = true /\ forall j, s <= j < k -> f j = false.
Proof.
  induction n as [|n IH]; simpl; intros s k E; [discriminate|].
  destruct (f s) eqn:Fs.
  - injection E as <-. repeat split; auto; try lia; intros; lia.
  - destruct (IH _ _ E) as (A & B & C). repeat split; auto; try lia.
    intros j Hj. destruct (Nat.eq_dec j s) as [->|]; auto. apply C; lia.
Qed.

(** [find] depends on the values of f only. *)
Lemma find_ext (f g : nat -> bool) l :
  (forall x, f x = g x) -> find f l = find g l.
Proof. intros H; induction l as [|x l IH]; simpl; auto. rewrite H, IH; auto. Qed.

Section Rotation.
Variable M : Map.
Hypothesis WF : is_map M.

(** Turning maps darts to darts. *)
Lemma turn_lt k a : a < darts M -> turn M k a < darts M.
Proof. induction k; simpl; auto. intros; apply sigma_lt; auto. Qed.

(** Turning by k is injective. *)
Lemma turn_inj k a b : a < darts M -> b < darts M -> turn M k a = turn M k b -> a = b.
Proof.
  induction k as [|k IH]; simpl; auto. intros Ha Hb E. apply IH; auto.
  apply (sigma_inj M WF); auto using turn_lt.
Qed.

(** Turning by j + k is turning by k, then by j. *)
Lemma turn_add j k a : turn M (j + k) a = turn M j (turn M k a).
Proof. induction j; simpl; congruence. Qed.

(** If two turns of a dart agree, turning by their difference returns to the dart. *)
Lemma turn_period i j a : a < darts M -> i < j -> turn M i a = turn M j a -> turn M (j - i) a = a.
Proof.
  intros Ha Hij E. apply (turn_inj i); auto using turn_lt.
  rewrite <- turn_add. replace (i + (j - i)) with j by lia. auto.
Qed.

(** The degree is the least positive turn that returns to the dart. *)
Lemma degree_spec a : a < darts M ->
  0 < degree M a /\ turn M (degree M a) a = a /\
  forall k, 0 < k < degree M a -> turn M k a <> a.
Proof.
  intros Ha. unfold degree.
  destruct (find (fun k => turn M k a =? a) (seq 1 (darts M))) as [k|] eqn:E.
  - apply find_seq in E as (A & B & C). apply Nat.eqb_eq in B.
    repeat split; auto; try lia.
    intros j Hj. apply Nat.eqb_neq, C. lia.
  - exfalso. assert (S (darts M) <= darts M); [|lia].
    assert (N : forall k, 0 < k <= darts M -> turn M k a <> a).
    { intros k Hk. apply Nat.eqb_neq. apply (find_none _ _ E), in_seq. lia. }
    apply (pigeon (fun k => turn M k a)); [intros; apply turn_lt; auto|].
    intros i j Hi Hj Eij. destruct (lt_eq_lt_dec i j) as [[L|L]|L]; auto; exfalso.
    + apply (N (j - i)); [lia|]. apply turn_period; auto.
    + apply (N (i - j)); [lia|]. apply turn_period; auto.
Qed.

(** A positive d that is the least turn returning to a is the degree. *)
Lemma degree_unique a d : a < darts M -> 0 < d -> turn M d a = a ->
  (forall k, 0 < k < d -> turn M k a <> a) -> degree M a = d.
Proof.
  intros Ha Hd E N. destruct (degree_spec a Ha) as (A & B & C).
  destruct (lt_eq_lt_dec (degree M a) d) as [[L|L]|L]; auto; exfalso.
  - apply (N (degree M a)); auto.
  - apply (C d); auto.
Qed.

(** Different turns below the degree lead to different darts. *)
Lemma turn_eq a i j : a < darts M -> i < degree M a -> j < degree M a ->
  turn M i a = turn M j a -> i = j.
Proof.
  intros Ha Hi Hj E. destruct (degree_spec a Ha) as (_ & _ & C).
  destruct (lt_eq_lt_dec i j) as [[L|L]|L]; auto; exfalso.
  - apply (C (j - i)); [lia|]. apply turn_period; auto.
  - apply (C (i - j)); [lia|]. apply turn_period; auto.
Qed.

(** All darts of a vertex have the same degree. *)
Lemma degree_turn k a : a < darts M -> degree M (turn M k a) = degree M a.
Proof.
  intros Ha. destruct (degree_spec a Ha) as (A & B & C).
  apply degree_unique; auto using turn_lt.
  - rewrite <- turn_add, Nat.add_comm, turn_add, B. auto.
  - intros j Hj E. apply (C j Hj). apply (turn_inj k); auto using turn_lt.
    rewrite <- turn_add, Nat.add_comm, turn_add. auto.
Qed.

(** Offsets count modulo the degree. *)
Lemma turn_mod k a : a < darts M -> turn M (k mod degree M a) a = turn M k a.
Proof.
  intros Ha. destruct (degree_spec a Ha) as (A & B & _).
  rewrite (Nat.div_mod k (degree M a)) at 2 by lia.
  rewrite Nat.add_comm, turn_add. f_equal. symmetry.
  induction (k / degree M a) as [|q IH]; [rewrite Nat.mul_0_r; auto|].
  rewrite Nat.mul_succ_r, turn_add, B; auto.
Qed.

(** If the marker is seen in direction j, the dart at offset j is the root. *)
Lemma marker_some a j : marker M a = Some j -> turn M j a = root M.
Proof. intros E. apply find_seq in E as (_ & E & _). apply Nat.eqb_eq; auto. Qed.

(** From every dart of the root's vertex the marker is seen. *)
Lemma marker_of a k : k < degree M a -> turn M k a = root M -> exists j, marker M a = Some j.
Proof.
  intros Hk E. unfold marker.
  destruct (find (fun j => turn M j a =? root M) (seq 0 (degree M a))) as [j|] eqn:F; eauto.
  exfalso. assert (G := find_none _ _ F k). cbv beta in G.
  rewrite E, Nat.eqb_refl in G. discriminate G. apply in_seq; lia.
Qed.

(** If one dart of a vertex sees the marker, so does every other. *)
Lemma same_vertex_mark i j a b m : a < darts M -> b < darts M ->
  turn M i a = turn M j b -> turn M m a = root M -> exists n, marker M b = Some n.
Proof.
  intros Ha Hb E Hm. destruct (degree_spec a Ha) as (A & B & _).
  apply (marker_of b ((m + (degree M a * i - i) + j) mod degree M b)).
  - apply Nat.mod_upper_bound. destruct (degree_spec b Hb); lia.
  - rewrite turn_mod, turn_add, <- E, <- turn_add by auto.
    replace (m + (degree M a * i - i) + i) with (m + degree M a * i)
      by (assert (i <= degree M a * i) by nia; lia).
    rewrite turn_add. replace (turn M (degree M a * i) a) with a; auto.
    rewrite <- turn_mod, Nat.mul_comm, Nat.mod_mul by (auto || lia). auto.
Qed.

(** A move exists only for a door below the degree. *)
Lemma move_door a k b : move M a k = Some b -> k < degree M a.
Proof. unfold move. destruct (Nat.ltb_spec k (degree M a)); [auto|discriminate]. Qed.

(** A move leads to a dart. *)
Lemma move_lt a k b : a < darts M -> move M a k = Some b -> b < darts M.
Proof.
  unfold move. intros Ha E. destruct (k <? degree M a); [|discriminate].
  eapply alpha_ok in E; auto using turn_lt. apply E.
Qed.

(** Walks are injective: if the same doors lead from a and from b to the same dart, a = b. The
    reason is that every move can be undone. *)
Lemma walk_inj w : forall a b c, a < darts M -> b < darts M ->
  walk M a w = Some c -> walk M b w = Some c -> a = b.
Proof.
  induction w as [|k w IH]; simpl; intros a b c Ha Hb; [congruence|].
  destruct (move M a k) as [a'|] eqn:Ea; [|discriminate].
  destruct (move M b k) as [b'|] eqn:Eb; [|discriminate].
  intros E1 E2. assert (a' = b') as <-
    by (eapply IH; [eapply move_lt, Ea|eapply move_lt, Eb| |]; eauto).
  unfold move in *. destruct (k <? degree M a), (k <? degree M b); try discriminate.
  apply alpha_ok in Ea, Eb; auto using turn_lt.
  apply (turn_inj k); auto. destruct Ea as (_ & _ & Ea), Eb as (_ & _ & Eb). congruence.
Qed.

(** A walk ends at a dart. *)
Lemma walk_lt w : forall a b, a < darts M -> walk M a w = Some b -> b < darts M.
Proof.
  induction w as [|k w IH]; simpl; intros a b Ha E; [congruence|].
  destruct (move M a k) eqn:Em; [|discriminate]. apply move_lt in Em; eauto.
Qed.

(** A walk by u ++ v is a walk by u, then a walk by v. *)
Lemma walk_app u v a : walk M a (u ++ v) =
  match walk M a u with Some b => walk M b v | None => None end.
Proof.
  revert a. induction u as [|k u IH]; simpl; intros a; auto.
  destruct (move M a k); auto.
Qed.
End Rotation.
(** If d can be reached, so can every dart of its vertex. *)
Lemma reach_turn M p k d : reach M p d -> reach M p (turn M k d).
Proof. intros; induction k; simpl; auto using reach_sigma. Qed.

(** Reachability is transitive. *)
Lemma reach_trans M a b c : reach M a b -> reach M b c -> reach M a c.
Proof. intros H; induction 1; eauto using reach_sigma, reach_alpha. Qed.

(** Reachability is symmetric, and what is reached from a dart is a dart. *)
Lemma reach_sym M a b : is_map M -> a < darts M -> reach M a b -> b < darts M /\ reach M b a.
Proof.
  intros WM Ha. induction 1 as [|d _ (Ld & IH)|d e _ (Ld & IH) He].
  - split; auto. constructor.
  - split; [apply sigma_lt; auto|]. apply reach_trans with d; auto.
    destruct (degree_spec M WM d Ld) as (A & B & _).
    rewrite <- B at 2. replace (degree M d) with (degree M d - 1 + 1) by lia.
    rewrite turn_add. apply reach_turn. constructor.
  - apply (alpha_ok M WM) in He; auto. destruct He as (Le & _ & He).
    split; auto. apply reach_trans with d; auto. apply (reach_alpha _ _ e); auto. constructor.
Qed.

(** The decision procedure for equality of percepts. *)
Definition percept_eqb (p q : Percept) : bool :=
  (fst p =? fst q) &&
  match snd p, snd q with
  | Some i, Some j => i =? j | None, None => true | _, _ => false
  end.
Arguments percept_eqb : simpl never.

(** [percept_eqb] decides equality of percepts. *)
Lemma percept_eqb_spec p q : reflect (p = q) (percept_eqb p q).
Proof.
  destruct p as [d i], q as [c j]. unfold percept_eqb; simpl.
  destruct (Nat.eqb_spec d c), i as [i|], j as [j|]; simpl; try (constructor; congruence).
  destruct (Nat.eqb_spec i j); constructor; congruence.
Qed.

(** The world of one edge: what is said of all worlds, and of the maps in them, is not vacuous. *)
Definition edge_alone := {| darts := 2; sigma := fun d => d; alpha := fun d => Some (1 - d);
  root := 0 |}.

(** It is a world, and a map embedded in itself. *)
Example edge_alone_world : world edge_alone /\ embedded edge_alone edge_alone (fun d => d).
Proof.
  split; [|split; auto]. split; [split|..]; simpl; auto; try discriminate.
  - intros [|[|d]] e L H; simpl in *; injection H as <-; repeat split; lia.
  - intros [|[|d]] L; [constructor|apply reach_alpha with 0; [constructor|reflexivity]|].
    simpl in L. lia.
Qed.
