(** Breadth-first trees on the map, and the ways that lead along them (docs/semantics.md, sections 3, 4
    and 6).

    M is a map, r the dart where the tree is rooted, p, e darts. A vertex is known by its lowest dart.
    A branch says for a vertex its distance from the root and its dart that leads towards the root.
    Vertices are scanned in the order in which they were found, their darts in ascending order.

    The invariant of the search is [good_tree]: the branches lead to the root, each over a branch with
    a lesser distance. *)
From Coq Require Import Arith Lia List Bool.
Import ListNotations.
From Topo Require Import World Rotation Embedding Vertices Augment Mapper.

(** The lowest dart of the vertex of a. *)
Definition lowest M a := fold_right Nat.min a (map (fun k => turn M k a) (seq 0 (degree M a))).

(** A branch: a vertex, its distance, and its dart that leads towards the root, None at the root. *)
Definition branch : Type := nat * (nat * option nat).

(** Add the vertex of dart o at this distance, unless it was found before. *)
Definition sprout M far (found : list branch) o := let v := lowest M o in
  if existsb (fun x => fst x =? v) found then found else found ++ [(v, (far, Some o))].

(** Scan the darts of a vertex that was found, in ascending order. *)
Definition scan M (found : list branch) (x : branch) := fold_left
  (fun found d => match alpha M d with Some o => sprout M (S (fst (snd x))) found o | None => found end)
  (map (fun k => turn M k (fst x)) (seq 0 (degree M (fst x)))) found.

(** Scan the vertices from number i on, in the order in which they were found. *)
Fixpoint outward M n i found := match n with
  | 0 => found
  | S n => match nth_error found i with
           | Some x => outward M n (S i) (scan M found x) | None => found end
  end.

(** The breadth-first tree that is rooted at the vertex of r. *)
Definition tree_from M r := outward M (darts M) 0 [(lowest M r, (0, None))].

(** The branch of a vertex. *)
Definition branch_of (t : list branch) v := find (fun x => fst x =? v) t.

(** The distance of the vertex of d. *)
Definition far_from M t d :=
  match branch_of t (lowest M d) with Some x => fst (snd x) | None => 0 end.

(** The door from p to dart d of the same vertex. *)
Definition door_between M p d :=
  match find (fun k => turn M k p =? d) (seq 0 (degree M p)) with Some k => k | None => 0 end.

(** The doors from p along n branches, and the dart where they end. *)
Fixpoint descend M t n p : list nat * nat := match n with
  | 0 => ([], p)
  | S n => match branch_of t (lowest M p) with
    | Some (_, (_, Some o)) => match alpha M o with
        | Some y => let (w, q) := descend M t n y in (door_between M p o :: w, q)
        | None => ([], p) end
    | _ => ([], p)
    end
  end.

(** The doors to the vertex of e from p, along the tree rooted there, and the last turn to e. *)
Definition way_to M e := let t := tree_from M e in fun p =>
  let (w, q) := descend M t (far_from M t p) p in (w, door_between M q e).

Section Lowest.
Variable M : Map.
Hypothesis WM : is_map M.

(** The lowest dart is the least one of the vertex. *)
Lemma lowest_first a : a < darts M -> lowest M a = first_dart M a.
Proof.
  intros Ha. destruct (degree_spec M WM a Ha) as (D & _).
  assert (Min : forall l, (forall x, In x (a :: l) -> fold_right Nat.min a l <= x) /\
    In (fold_right Nat.min a l) (a :: l)).
  { intros l. induction l as [|y l [A B]]; simpl; [split; auto; intros x [<-|[]]; auto|]. split.
    - intros x [<-|[<-|I]]; [specialize (A a (or_introl eq_refl))| |specialize (A x (or_intror I))]; lia.
    - destruct (Nat.min_spec y (fold_right Nat.min a l)) as [[_ ->]|[_ ->]]; auto.
      destruct B; auto. }
  destruct (Min (map (fun k => turn M k a) (seq 0 (degree M a)))) as [A B]. fold (lowest M a) in A, B.
  assert (V : lowest M a < darts M /\ at_vertex M a (lowest M a) = true).
  { destruct B as [<-|B].
    - split; auto. apply (at_vertex_iff M WM); auto. exists 0. auto.
    - apply in_map_iff in B as (k & <- & _). split; [apply turn_lt; auto|].
      apply (at_vertex_iff M WM); eauto. }
  destruct (first_dart_at M WM a Ha) as [L F]. apply Nat.le_antisymm.
  - apply A. right. unfold at_vertex in F. apply existsb_exists in F as (k & I & E).
    apply Nat.eqb_eq in E. apply in_map_iff. eauto.
  - unfold first_dart in *. destruct (find _ _) as [x|] eqn:Fx.
    + apply find_seq in Fx as (_ & _ & N). destruct (Nat.le_gt_cases x (lowest M a)); auto.
      rewrite N in V; [destruct V; discriminate|lia].
    + assert (N := find_none _ _ Fx (lowest M a)). rewrite (proj2 V) in N. discriminate N.
      apply in_seq. lia.
Qed.

(** Darts with the same lowest dart are at the same vertex, each a turn of the other. *)
Lemma lowest_turn a b : a < darts M -> b < darts M -> lowest M a = lowest M b ->
  exists k, k < degree M a /\ turn M k a = b.
Proof.
  intros Ha Hb E. rewrite !lowest_first in E by auto. apply (first_dart_eq M WM) in E; auto.
  unfold at_vertex in E. apply existsb_exists in E as (k & I & E). apply in_seq in I.
  apply Nat.eqb_eq in E. exists k. split; auto. lia.
Qed.

(** Turning does not change the lowest dart. *)
Lemma turn_lowest a k : a < darts M -> lowest M (turn M k a) = lowest M a.
Proof.
  intros Ha. rewrite !lowest_first by auto using turn_lt. symmetry.
  apply (first_dart_eq M WM); auto using turn_lt. apply (at_vertex_iff M WM); eauto.
Qed.

(** The lowest dart is a dart, and its own lowest dart. *)
Lemma lowest_own a : a < darts M -> lowest M a < darts M /\ lowest M (lowest M a) = lowest M a.
Proof.
  intros Ha. rewrite (lowest_first a Ha). destruct (first_dart_at M WM a Ha) as [L A]. split; auto.
  rewrite (lowest_first _ L). symmetry. apply (first_dart_eq M WM); auto.
Qed.

(** The door leads to the dart. *)
Lemma door_between_spec p d : p < darts M -> d < darts M -> lowest M p = lowest M d ->
  door_between M p d < degree M p /\ turn M (door_between M p d) p = d.
Proof.
  intros Hp Hd E. destruct (lowest_turn p d Hp Hd E) as (k & Hk & Ek). unfold door_between.
  destruct (find _ _) as [j|] eqn:F.
  - apply find_seq in F as (A & B & _). apply Nat.eqb_eq in B. split; auto. lia.
  - assert (N := find_none _ _ F k). simpl in N. rewrite Ek, Nat.eqb_refl in N. discriminate N.
    apply in_seq. lia.
Qed.

End Lowest.

Section Trees.
Variables (M : Map) (r : nat).
Hypotheses (WM : is_map M) (Hr : r < darts M).

(** The invariant of the search: the vertices found are different; the root is one of them; each other
    one has a dart that leads to one with a distance that is less by one; and each distance is less
    than the number of vertices found. *)
Record good_tree (found : list branch) : Prop := {
  t_apart : NoDup (map fst found);
  t_own : forall v, In v (map fst found) -> v < darts M /\ lowest M v = v;
  t_root : In (lowest M r) (map fst found);
  t_less : forall v n o, In (v, (n, o)) found -> n < length found;
  t_back : forall v n o, In (v, (n, o)) found -> match o with
    | None => v = lowest M r /\ n = 0
    | Some o => o < darts M /\ lowest M o = v /\ exists y m b, alpha M o = Some y /\
                In (lowest M y, (m, b)) found /\ n = S m end }.

(** The invariant holds for the root alone. *)
Lemma good_tree_start : good_tree [(lowest M r, (0, None))].
Proof.
  split; simpl; auto.
  - constructor; [intros []|constructor].
  - intros v [<-|[]]. apply (lowest_own M WM); auto.
  - intros v n o [E|[]]. injection E as <- <- <-. auto.
  - intros v n o [E|[]]. injection E as <- <- <-. auto.
Qed.

(** The search finds at most as many vertices as the map has. *)
Lemma found_le found : good_tree found -> length found <= vertices M.
Proof.
  intros G. replace (length found) with (length (map fst found)) by apply map_length.
  apply vertices_most.
  - intros a I. apply (t_own _ G a I).
  - replace (map (first_dart M) (map fst found)) with (map fst found); [apply (t_apart _ G)|].
    rewrite <- (map_id (map fst found)) at 1. apply map_ext_in. intros a I.
    destruct (t_own _ G a I) as [L E]. rewrite <- (lowest_first M WM); auto.
Qed.

(** The list g begins with f. *)
Definition begins {A} (f g : list A) := exists l, g = f ++ l.

(** What is in f is in g. *)
Lemma begins_incl {A} (f g : list A) : begins f g -> incl f g.
Proof. intros [l ->]. apply incl_appl, incl_refl. Qed.

(** A list begins with itself. *)
Lemma begins_refl {A} (f : list A) : begins f f.
Proof. exists []. rewrite app_nil_r. auto. Qed.

(** Beginning with is transitive. *)
Lemma begins_trans {A} (f g h : list A) : begins f g -> begins g h -> begins f h.
Proof. intros [l ->] [k ->]. exists (l ++ k). rewrite app_assoc. auto. Qed.

(** Adding a neighbour keeps the invariant and what was found, and the neighbour is found. *)
Lemma sprout_good found n b d o : good_tree found -> d < darts M -> In (lowest M d, (n, b)) found ->
  alpha M d = Some o -> good_tree (sprout M (S n) found o) /\
  begins found (sprout M (S n) found o) /\ In (lowest M o) (map fst (sprout M (S n) found o)).
Proof.
  intros G Hd I Ho. assert (Lo : o < darts M /\ alpha M o = Some d)
    by (apply (alpha_ok M WM) in Ho; tauto). destruct Lo as [Lo Hod].
  unfold sprout. cbv zeta. destruct (existsb _ _) eqn:X.
  - split; auto. split; [apply begins_refl|]. apply existsb_exists in X as (x & Ix & Ex).
    apply Nat.eqb_eq in Ex. rewrite <- Ex. apply in_map; auto.
  - assert (N : ~ In (lowest M o) (map fst found)).
    { intros In0. apply in_map_iff in In0 as (x & Ex & Ix).
      assert (existsb (fun x => fst x =? lowest M o) found = true); [|congruence].
      apply existsb_exists. exists x. split; auto. apply Nat.eqb_eq; auto. }
    split; [|split; [eexists; reflexivity|rewrite map_app; apply in_or_app; right; left; auto]].
    split.
    + rewrite map_app. apply (NoDup_Add (a := lowest M o) (l := map fst found)).
      * assert (A := Add_app (lowest M o) (map fst found) []). rewrite app_nil_r in A. exact A.
      * split; auto. apply G.
    + intros v Iv. rewrite map_app in Iv. apply in_app_or in Iv as [Iv|[<-|[]]].
      * apply (t_own _ G); auto.
      * apply (lowest_own M WM); auto.
    + rewrite map_app. apply in_or_app. left. apply G.
    + intros v m x Iv. rewrite app_length. simpl. apply in_app_or in Iv as [Iv|[E|[]]].
      * apply (t_less _ G) in Iv. lia.
      * injection E as <- <- <-. apply (t_less _ G) in I. lia.
    + intros v m x Iv. apply in_app_or in Iv as [Iv|[E|[]]].
      * apply (t_back _ G) in Iv. destruct x as [x|]; auto.
        destruct Iv as (A & B & y & k & c & C1 & C2 & C3). split; auto. split; auto.
        exists y, k, c. split; auto. split; auto. apply in_or_app. auto.
      * injection E as <- <- <-. split; auto. split; auto. exists d, n, b. split; auto. split; auto.
        apply in_or_app. auto.
Qed.

(** All neighbours of the vertex v were found. *)
Definition scanned (found : list branch) v := forall d o, d < darts M -> lowest M d = v ->
  alpha M d = Some o ->
  In (lowest M o) (map fst found).

(** Scanning keeps the invariant and what was found, and finds all neighbours. *)
Lemma scan_good found x : good_tree found -> In x found -> good_tree (scan M found x) /\
  begins found (scan M found x) /\ scanned (scan M found x) (fst x).
Proof.
  intros G I. destruct x as (v, (n, b)). unfold scan. simpl fst; simpl snd.
  destruct (t_own _ G v (in_map fst _ _ I)) as [Lv Ev]. simpl in Lv, Ev.
  assert (Scan : forall l found, good_tree found -> In (v, (n, b)) found ->
    (forall d, In d l -> d < darts M /\ lowest M d = v) ->
    let after := fold_left (fun found d => match alpha M d with
      | Some o => sprout M (S n) found o | None => found end) l found in
    good_tree after /\ begins found after /\ forall d o, In d l -> alpha M d = Some o ->
      In (lowest M o) (map fst after)).
  { intros l. induction l as [|d l IH]; cbn [fold_left]; intros f Gf If Hl.
    - split; auto. split; [apply begins_refl|]. intros d o [].
    - destruct (Hl d (or_introl eq_refl)) as [Ld Ed].
      destruct (alpha M d) as [o|] eqn:Ho.
      + destruct (sprout_good f n b d o Gf Ld) as (G1 & S1 & N1); auto; [rewrite Ed; auto|].
        destruct (IH (sprout M (S n) f o) G1 (begins_incl _ _ S1 _ If)) as (G2 & S2 & N2).
        { intros; apply Hl; right; auto. }
        split; auto. split; [eapply begins_trans; eauto|]. intros d' o' [<-|I'] Ho'; eauto.
        replace o' with o by congruence. apply (incl_map fst (begins_incl _ _ S2)); auto.
      + destruct (IH f Gf If) as (G2 & S2 & N2); [intros; apply Hl; right; auto|].
        split; auto. split; auto. intros d' o' [<-|I'] Ho'; [congruence|eauto]. }
  destruct (Scan (map (fun k => turn M k v) (seq 0 (degree M v))) found G I) as (G1 & S1 & N1).
  { intros d Id. apply in_map_iff in Id as (k & <- & _). split; [apply turn_lt; auto|].
    rewrite (turn_lowest M WM); auto. }
  split; auto. split; auto. intros d o Ld Ed Ho. apply (N1 d o); auto.
  destruct (lowest_turn M WM v d Lv Ld) as (k & Hk & Ek); [congruence|].
  apply in_map_iff. exists k. split; auto. apply in_seq. lia.
Qed.

(** With enough fuel the search ends when all vertices found were scanned. *)
Lemma outward_good n : forall i found, good_tree found -> darts M <= n + i ->
  (forall j x, j < i -> nth_error found j = Some x -> scanned found (fst x)) ->
  good_tree (outward M n i found) /\
  forall x, In x (outward M n i found) -> scanned (outward M n i found) (fst x).
Proof.
  assert (V := vertices_le M WM).
  assert (End : forall i found, good_tree found -> length found <= i ->
    (forall j x, j < i -> nth_error found j = Some x -> scanned found (fst x)) ->
    forall x, In x found -> scanned found (fst x)).
  { intros i f G L H x I. apply In_nth_error in I as [j Ej]. apply (H j x); auto.
    assert (j < length f) by (apply nth_error_Some; congruence). lia. }
  induction n as [|n IH]; simpl; intros i found G L H.
  - split; auto. apply (End i); auto. apply found_le in G. lia.
  - destruct (nth_error found i) as [x|] eqn:Ex.
    + destruct (scan_good found x G (nth_error_In _ _ Ex)) as (G1 & S1 & N1).
      assert (Lf : i < length found) by (apply nth_error_Some; congruence).
      assert (Keep : forall y, scanned found y -> scanned (scan M found x) y).
      { intros y Hy d o Ld Ed Ho. apply (incl_map fst (begins_incl _ _ S1)), (Hy d o); auto. }
      apply IH; auto; [lia|]. intros j y Hj Ey. destruct S1 as [l El].
      rewrite El, nth_error_app1 in Ey by lia.
      destruct (Nat.eq_dec j i) as [->|]; [replace y with x by congruence; auto|].
      apply Keep, (H j); auto. lia.
    + split; auto. apply (End i); auto. apply nth_error_None; auto.
Qed.

(** The tree fulfils the invariant, and has a branch for every vertex that can be reached. *)
Lemma tree_good : good_tree (tree_from M r) /\
  forall d, reach M r d -> In (lowest M d) (map fst (tree_from M r)).
Proof.
  destruct (outward_good (darts M) 0 _ good_tree_start) as [G F]; [lia|intros; lia|].
  fold (tree_from M r) in G, F. split; auto.
  assert (L := fun d => reach_sym M r d WM Hr).
  induction 1 as [|d R IH|d o R IH Ho].
  - apply (t_root _ G).
  - destruct (L d R) as [Ld _]. rewrite (turn_lowest M WM d 1 Ld : lowest M (sigma M d) = _); auto.
  - destruct (L d R) as [Ld _]. apply in_map_iff in IH as (x & Ex & Ix).
    apply (F x Ix d o); auto.
Qed.

(** A vertex has one branch at most, and [branch_of] finds it. *)
Lemma branch_of_in t x : good_tree t -> In x t -> branch_of t (fst x) = Some x.
Proof.
  intros G I. unfold branch_of. destruct (find (fun y => fst y =? fst x) t) as [y|] eqn:F.
  - apply find_some in F as [Iy Ey]. apply Nat.eqb_eq in Ey. f_equal.
    assert (A := t_apart _ G). clear G. induction t as [|z t IH]; simpl in *; [tauto|].
    inversion A as [|? ? N A']. subst. destruct I as [->|I], Iy as [->|Iy]; auto.
    + destruct N. rewrite <- Ey. apply in_map; auto.
    + destruct N. rewrite Ey. apply in_map; auto.
  - assert (N := find_none _ _ F x I). simpl in N. rewrite Nat.eqb_refl in N. discriminate.
Qed.

(** Descending from p takes as many doors as the distance says, and ends at the root's vertex. *)
Lemma descend_spec t : good_tree t -> forall n p b, p < darts M -> In (lowest M p, (n, b)) t ->
  length (fst (descend M t n p)) = n /\ snd (descend M t n p) < darts M /\
  lowest M (snd (descend M t n p)) = lowest M r /\
  walk M p (fst (descend M t n p)) = Some (snd (descend M t n p)).
Proof.
  intros G n. induction n as [|n IH]; intros p b Hp I; assert (B := t_back _ G _ _ _ I); simpl.
  - repeat split; auto. destruct b as [o|]; [|apply B].
    destruct B as (_ & _ & y & m & c & _ & _ & E). discriminate.
  - rewrite (branch_of_in t _ G I : branch_of t (lowest M p) = _).
    destruct b as [o|]; [|destruct B; discriminate].
    destruct B as (Lo & Eo & y & m & c & Ey & Iy & En). injection En as <-. rewrite Ey.
    assert (Ly : y < darts M) by (apply (alpha_ok M WM) in Ey; tauto).
    destruct (IH y c Ly Iy) as (A1 & A2 & A3 & A4).
    destruct (door_between_spec M WM p o Hp Lo) as [D1 D2]; [auto|].
    destruct (descend M t n y) as (w, q). simpl in *. repeat split; auto.
    unfold move. rewrite (proj2 (Nat.ltb_lt _ _) D1), D2, Ey. auto.
Qed.
End Trees.

(** The ways of the tree lead to their dart and are shorter than the number of vertices.
    Not in the paper. *)
Theorem way_to_good : good_path way_to.
Proof.
  intros M p e WM CM Hp He. destruct (tree_good M e WM He) as [G R].
  assert (Re : reach M e p).
  { apply reach_trans with (root M); [|apply CM; auto].
    apply (reach_sym M (root M) e); auto. apply root_lt; auto. }
  apply R, in_map_iff in Re as ((v, (n, b)) & Ev & I). simpl in Ev. subst v.
  assert (B := branch_of_in M e _ _ G I). simpl in B.
  destruct (descend_spec M e WM _ G n p b Hp I) as (A1 & A2 & A3 & A4).
  unfold way_to, far_from. rewrite B. simpl fst; simpl snd.
  destruct (descend M (tree_from M e) n p) as (w, q). simpl in *.
  destruct (door_between_spec M WM q e A2 He A3) as [D1 D2].
  split; [simpl|exists q; simpl; auto]. apply (t_less _ _ _ G) in I. apply (found_le M e WM) in G. lia.
Qed.

