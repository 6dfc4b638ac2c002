(** Parities (sums modulo 2), linear equations modulo 2, and a comparison of two sums level by
    level.

    f, g are predicates, l, m lists; a row r is an equation, a variable e an unknown, z a
    solution; t is a level. LeastCost.v and Loops.v use these lemmas. *)
From Coq Require Import Arith Lia List Bool.
Import ListNotations.

(** The parity of the number of elements that satisfy f. *)
Definition parity {X} (f : X -> bool) l := fold_right (fun x b => xorb (f x) b) false l.

(** The parity of a concatenation is the sum of the parities. *)
Lemma parity_app {X} (f : X -> bool) l m : parity f (l ++ m) = xorb (parity f l) (parity f m).
Proof.
  induction l as [|x l IH]; simpl; [symmetry; apply xorb_false_l|]. rewrite IH. symmetry.
  apply xorb_assoc.
Qed.

(** The parity depends only on the values of f on the elements. *)
Lemma parity_ext {X} (f g : X -> bool) l : (forall x, In x l -> f x = g x) -> parity f l = parity g l.
Proof. induction l as [|x l IH]; simpl; intros H; auto. rewrite H, IH; auto. Qed.

(** If no element satisfies f, the parity is 0. *)
Lemma parity_none {X} (f : X -> bool) l : (forall x, In x l -> f x = false) -> parity f l = false.
Proof. induction l as [|x l IH]; simpl; intros H; auto. rewrite H, IH; auto. Qed.

(** The parity of a sum of predicates is the sum of their parities. *)
Lemma parity_xor {X} (f g : X -> bool) l :
  parity (fun x => xorb (f x) (g x)) l = xorb (parity f l) (parity g l).
Proof.
  induction l as [|x l IH]; simpl; auto. rewrite IH.
  destruct (f x), (g x), (parity f l), (parity g l); auto.
Qed.

(** A constant factor can be moved out of the parity. *)
Lemma parity_and {X} b (f : X -> bool) l : parity (fun x => b && f x) l = b && parity f l.
Proof. destruct b; simpl; auto. apply parity_none; auto. Qed.

(** A double sum can be computed by rows or by columns. *)
Lemma parity_swap {X Y} (f : X -> Y -> bool) l m :
  parity (fun x => parity (f x) m) l = parity (fun y => parity (fun x => f x y) l) m.
Proof.
  induction l as [|x l IH]; simpl; [symmetry; apply parity_none; auto|].
  rewrite IH, <- parity_xor. auto.
Qed.

(** The sum of z over the elements that equal e is z e. *)
Lemma parity_pick (z : nat -> bool) l e : NoDup l -> (z e = true -> In e l) ->
  parity (fun x => z x && (x =? e)) l = z e.
Proof.
  intros N. induction N as [|x l Hx N IH]; simpl; intros H.
  - destruct (z e); auto.
  - destruct (Nat.eqb_spec x e) as [->|D].
    + rewrite parity_none, andb_true_r, xorb_false_r; auto. intros y I.
      destruct (Nat.eqb_spec y e) as [->|_]; [destruct (Hx I)|apply andb_false_r].
    + rewrite andb_false_r, xorb_false_l. apply IH. intros E. destruct (H E); [destruct D|]; auto.
Qed.

(** A homogeneous system modulo 2 with fewer equations than unknowns has a nonzero solution. *)
Lemma solution k : forall rows (vars : list nat), length rows = k -> k < length vars -> NoDup vars ->
  exists z : nat -> bool, (exists e, In e vars /\ z e = true) /\
    (forall e, z e = true -> In e vars) /\
    forall r, In r rows -> parity (fun e => z e && r e) vars = false.
Proof.
  induction k as [|k IH]; intros rows vars Hr L N.
  - destruct rows; [|discriminate]. destruct vars as [|e vars]; [simpl in L; lia|].
    exists (fun x => x =? e). repeat split.
    + exists e. split; [left; auto|]. apply Nat.eqb_refl.
    + intros x E. apply Nat.eqb_eq in E as ->. left; auto.
    + intros r [].
  - destruct rows as [|r rows]; [discriminate|]. injection Hr as Hr.
    destruct (find r vars) as [e|] eqn:F.
    + apply find_some in F as [I R]. apply in_split in I as (l1 & l2 & ->).
      assert (N' := NoDup_remove_1 _ _ _ N). assert (Out := NoDup_remove_2 _ _ _ N).
      set (vars := l1 ++ l2) in *.
      destruct (IH (map (fun s x => xorb (s x) (s e && r x)) rows) vars)
        as (z & (a & Ia & Za) & Su & Eq); [rewrite map_length; auto| |auto|].
      { rewrite app_length in L. simpl in L. unfold vars. rewrite app_length. lia. }
      set (w := parity (fun x => z x && r x) vars).
      assert (Ne : forall x, In x vars -> (x =? e) = false).
      { intros x I. apply Nat.eqb_neq. intros ->. auto. }
      assert (Sum : forall s, parity (fun x => (if x =? e then w else z x) && s x) (l1 ++ e :: l2) =
        xorb (w && s e) (parity (fun x => z x && s x) vars)).
      { intros s. unfold vars. rewrite !parity_app. simpl. rewrite Nat.eqb_refl.
        rewrite (parity_ext _ (fun x => z x && s x) l1), (parity_ext _ (fun x => z x && s x) l2).
        - destruct (w && s e), (parity (fun x => z x && s x) l1); auto;
            destruct (parity (fun x => z x && s x) l2); auto.
        - intros x I. rewrite Ne; auto. apply in_or_app; auto.
        - intros x I. rewrite Ne; auto. apply in_or_app; auto. }
      exists (fun x => if x =? e then w else z x). repeat split.
      * exists a. rewrite Ne by auto. split; auto. apply in_app_or in Ia as [I|I]; apply in_or_app;
          [left|right; right]; auto.
      * intros x. destruct (Nat.eqb_spec x e) as [->|_]; intros H; apply in_or_app.
        -- right; left; auto.
        -- apply Su, in_app_or in H as [I|I]; [left|right; right]; auto.
      * intros s [<-|I]; rewrite Sum.
        -- rewrite R, andb_true_r. apply xorb_nilpotent.
        -- assert (E := Eq (fun x => xorb (s x) (s e && r x))
             (in_map (fun s x => xorb (s x) (s e && r x)) rows s I)). simpl in E.
           rewrite (parity_ext _ (fun x => xorb (z x && s x) (s e && (z x && r x)))) in E
             by (intros x _; destruct (z x), (s x), (s e), (r x); auto).
           rewrite parity_xor, parity_and in E. fold w in E.
           destruct w, (s e), (parity (fun x => z x && s x) vars); auto.
    + destruct (IH rows vars) as (z & Z & Su & Eq); auto; [lia|]. exists z. repeat split; auto.
      intros s [<-|I]; auto. apply parity_none. intros x I.
      rewrite (find_none _ _ F x I). apply andb_false_r.
Qed.

(** How many elements are greater than t. *)
Definition above t l := length (filter (fun x => t <? x) l).

(** A sum of numbers is the number of positive ones plus the sum of the predecessors. *)
Lemma sum_pred l : list_sum l = above 0 l + list_sum (map pred l).
Proof.
  unfold above. induction l as [|x l IH]; simpl; auto.
  rewrite IH. destruct x; simpl; lia.
Qed.

(** As many predecessors are greater than t as elements are greater than t + 1. *)
Lemma above_pred t l : above t (map pred l) = above (S t) l.
Proof.
  unfold above. induction l as [|x l IH]; simpl; auto.
  assert (E : (t <? pred x) = (S t <? x)).
  { apply eq_true_iff_eq. rewrite !Nat.ltb_lt. lia. }
  rewrite E. destruct (S t <? x); simpl; rewrite IH; auto.
Qed.

(** If, for every t, a has at most as many elements greater than t as b, the sum of a is at most
    the sum of b. *)
Lemma sum_by_level a b : (forall t, above t a <= above t b) -> list_sum a <= list_sum b.
Proof.
  enough (H : forall T a b, (forall x, In x a -> x <= T) -> (forall t, above t a <= above t b) ->
    list_sum a <= list_sum b).
  { apply (H (list_max a)). apply Forall_forall, list_max_le. auto. }
  clear a b. intros T. induction T as [|T IH]; intros a b B H.
  - assert (list_sum a = 0); [|lia]. clear H. induction a as [|x a IH]; simpl; auto.
    rewrite IH; [|intros; apply B; right; auto]. assert (X := B x (or_introl eq_refl)). lia.
  - rewrite (sum_pred a), (sum_pred b). assert (H0 := H 0).
    enough (list_sum (map pred a) <= list_sum (map pred b)) by lia. apply IH.
    + intros x I. apply in_map_iff in I as (y & <- & I). apply B in I. lia.
    + intros t. rewrite !above_pred. auto.
Qed.
