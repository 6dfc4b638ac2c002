(** Merging until nothing is left to merge: evidence, computed from a log alone (claims 9 and 10;
    docs/proofs.md).

    L is a log, extra the list of assumed edges, rho gives each visit a rank, n is a number of
    steps; the other letters are those of Checker.v.

    [saturation] looks for two arcs that leave by one dart and arrive at two, and merges these,
    again and again, until it finds none, or the two cannot be one dart. The invariant is [ranked];
    the union-find that results shows a conflict, or has merged all ([saturation_ends]). It is slow, and
    nobody runs it on long logs: what the theorems of Accepted.v need is that it exists. *)
From Coq Require Import Arith Lia List Bool PArith FMapPositive.
Import ListNotations.
From Topo Require Import World Rotation Log Table Checker CheckerCorrect Ranked.

Local Opaque fuel.

Section Saturated.
Variables (L : Log) (extra : list (pplace * pplace)).
Notation T := (table_of (sights L)).
Notation D := (table_of (edges L extra)).
Notation find := PositiveMap.find.
Notation rep := (rep T fuel).
Notation unite := (unite T).
Notation tidy := (tidy L).
Notation ranked := (ranked L).

(** All arcs: every edge in both directions. *)
Definition all_arcs := flat_map (fun x : positive => [(true, x); (false, x)])
  (map fst (enum 1 (edges L extra))).

(** The two arcs leave by one dart and arrive at two. *)
Definition pending U (s : arc * arc) := match meet T D U s with
  | Some (p, q) => negb (pplace_eqb (rep U p) (rep U q)) | None => false end.

(** The next merge, if there is one: the two arcs, and the two places where they arrive. *)
Definition next_merge U := match List.find (pending U) (list_prod all_arcs all_arcs) with
  | Some s => match meet T D U s with
    | Some (p, q) => if apart T U p q then None else Some (s, p, q) | None => None end
  | None => None end.

(** At most n merges, one after the other; the root of lower rank goes under the other one. *)
Fixpoint saturation n U rho : evidence := match n with
  | 0 => []
  | S n => match next_merge U with
    | Some (s, p, q) => let x := fst (rep U p) in let y := fst (rep U q) in
        if rho y <=? rho x then s :: saturation n (unite U p q) (raised rho x y)
        else (snd s, fst s) :: saturation n (unite U q p) (raised rho y x)
    | None => [] end end.

(** The ranks after these merges. *)
Fixpoint ranks_after n U rho : positive -> nat := match n with
  | 0 => rho
  | S n => match next_merge U with
    | Some (s, p, q) => let x := fst (rep U p) in let y := fst (rep U q) in
        if rho y <=? rho x then ranks_after n (unite U p q) (raised rho x y)
        else ranks_after n (unite U q p) (raised rho y x)
    | None => rho end end.

(** No two arcs leave by one dart and arrive at two. *)
Definition all_merged U := forall s p q, meet T D U s = Some (p, q) -> rep U p = rep U q.

(** U' has merged all that U has. *)
Definition keeps U U' := forall d a b, tidy d a -> tidy d b -> rep U a = rep U b -> rep U' a = rep U' b.

(** Every place where an edge ends has its offset below the degree. *)
Definition tidy_ends := forall a p q, arc_ends D a = Some (p, q) ->
  (exists d, tidy d p) /\ exists d, tidy d q.

(** A place is equal to itself. *)
Lemma pplace_eqb_refl p : pplace_eqb p p = true.
Proof. unfold pplace_eqb. rewrite Pos.eqb_refl, Nat.eqb_refl. auto. Qed.

(** Every arc that has ends is listed. *)
Lemma arc_listed a p q : arc_ends D a = Some (p, q) -> In a all_arcs.
Proof.
  unfold arc_ends. destruct (find (snd a) D) as [e|] eqn:E; [|discriminate]. intros _.
  apply table_of_spec in E. apply in_flat_map. exists (snd a). split.
  - destruct (in_enum (edges L extra) 1 _ _ E) as (y & I & Y). apply in_map_iff.
    exists (y, e). split; auto. simpl. apply Pos2Nat.inj. rewrite Y, Pos2Nat.inj_1. unfold num.
    assert (H := Pos2Nat.is_pos (snd a)). lia.
  - destruct a as ([], x); simpl; auto.
Qed.

Hypothesis Few : length (sights L) < 2 ^ fuel.
Hypothesis Ends : tidy_ends.

(** Two arcs that meet are listed, meet in either order, and arrive at tidy places. *)
Lemma meet_listed U s p q : meet T D U s = Some (p, q) -> In s (list_prod all_arcs all_arcs) /\
  meet T D U (snd s, fst s) = Some (q, p) /\ (exists d, tidy d p) /\ exists d, tidy d q.
Proof.
  unfold meet. destruct s as (a, b). cbn [fst snd].
  destruct (arc_ends D a) as [(p1, q1)|] eqn:E1; [|discriminate].
  destruct (arc_ends D b) as [(p2, q2)|] eqn:E2; [|discriminate].
  destruct (pplace_eqb (rep U p1) (rep U p2)) eqn:E; [|discriminate]. intros Q. injection Q as <- <-.
  split; [apply in_prod_iff; eauto using arc_listed|]. apply pplace_eqb_eq in E. rewrite E.
  rewrite pplace_eqb_refl. split; [auto|]. split; [eapply Ends, E1|eapply Ends, E2].
Qed.

(** If there is no next merge, two arcs conflict or the union-find is saturated. *)
Lemma next_merge_none U : next_merge U = None ->
  (exists s, In s (list_prod all_arcs all_arcs) /\ check_conflict T D U (Arrive s) = true) \/
  all_merged U.
Proof.
  unfold next_merge. destruct (List.find _ _) as [s|] eqn:F.
  - destruct (meet T D U s) as [(p, q)|] eqn:M.
    + destruct (apart T U p q) eqn:Ap; [|discriminate]. left. exists s. simpl. rewrite M.
      split; auto. apply (find_some _ _ F).
    + apply find_some in F as [_ F]. unfold pending in F. rewrite M in F. discriminate.
  - intros _. right. intros s p q M. destruct (meet_listed U s p q M) as (I & _).
    apply (find_none _ _ F) in I. unfold pending in I. rewrite M in I.
    apply negb_false_iff, pplace_eqb_eq in I. auto.
Qed.

(** A next merge joins two classes whose visits have the same sign, in either order. *)
Lemma next_merge_some U rho s p q : ranked U rho -> next_merge U = Some (s, p, q) ->
  glue T D U s = unite U p q /\ glue T D U (snd s, fst s) = unite U q p /\
  pending U s = true /\ exists d, tidy d p /\ tidy d q /\
  sign L (fst p) = sign L (fst q) /\ fst (rep U p) <> fst (rep U q).
Proof.
  intros R. unfold next_merge. destruct (List.find _ _) as [s'|] eqn:F; [|discriminate].
  destruct (meet T D U s') as [(p', q')|] eqn:M; [|discriminate].
  destruct (apart T U p' q') eqn:Ap; [discriminate|]. intros Eq. injection Eq as -> -> ->.
  destruct (meet_listed U s p q M) as (_ & M' & (d & P) & (e & Q)).
  apply find_some in F as [_ F]. 
  split; [unfold glue; rewrite M; auto|].
  split; [exact (f_equal (fun o => match o with Some (x, y) => unite U x y | None => U end) M')|].
  split; auto. unfold pending in F. rewrite M in F. apply negb_true_iff in F.
  destruct (tidy_sign L d p P) as (m & Sp), (tidy_sign L e q Q) as (m' & Sq).
  destruct P as [(mp & Fp) Lp], Q as [(mq & Fq) Lq].
  unfold apart in Ap. rewrite Fp, Fq in Ap. apply orb_false_iff in Ap as [Ap Bp].
  apply orb_false_iff in Ap as [Ap Cp]. apply negb_false_iff, Nat.eqb_eq in Ap. subst e.
  exists d. split; [split; eauto|]. split; [split; eauto|]. split.
  - unfold sign. rewrite Fp, Fq. destruct mp, mq; auto; discriminate.
  - assert (A : forall a, tidy d a -> tidy d (rep U a)).
    { intros a A. destruct (tidy_sign L d a A) as (w & W).
      apply (leads_tidy L U rho a _ R (rep_spec L Few U rho a R ltac:(congruence)) d A). }
    assert (A1 := A p (conj (ex_intro _ mp Fp) Lp)). assert (A2 := A q (conj (ex_intro _ mq Fq) Lq)).
    revert Bp F A1 A2. destruct (rep U p) as (x, i), (rep U q) as (y, j). cbn [fst snd].
    intros Bp N [(mx & Fx) Lx] [_ Ly] ->. cbn [fst snd] in *. rewrite Pos.eqb_refl, Fx in Bp.
    rewrite (proj2 (Nat.ltb_lt _ _) Lx), (proj2 (Nat.ltb_lt _ _) Ly) in Bp. simpl in Bp.
    rewrite andb_true_r in Bp. apply negb_false_iff, Nat.eqb_eq in Bp. subst.
    rewrite pplace_eqb_refl in N. discriminate.
Qed.

(** Merging ends: with a conflict, or with nothing left to merge. *)
Theorem saturation_ends n : forall U rho, ranked U rho -> roots L U < n ->
  let U' := fold_left (glue T D) (saturation n U rho) U in
  ranked U' (ranks_after n U rho) /\ keeps U U' /\
  ((exists s, In s (list_prod all_arcs all_arcs) /\ check_conflict T D U' (Arrive s) = true) \/
   all_merged U').
Proof.
  induction n as [|n IH]; intros U rho R Le; [lia|]. cbn [saturation ranks_after].
  destruct (next_merge U) as [((s, p), q)|] eqn:Nx.
  2: { split; [exact R|]. split; [intros d a b _ _; auto|]. apply next_merge_none, Nx. }
  destruct (next_merge_some U rho s p q R Nx) as (G & G' & _ & d & P & Q & E & N). cbn zeta.
  destruct (Nat.leb_spec (rho (fst (rep U q))) (rho (fst (rep U p)))) as [X|X].
  - destruct (unite_spec L Few U rho d p q R P Q E N X) as (A & B & _ & C & _).
    cbn [fold_left]. rewrite G. destruct (IH _ _ A ltac:(lia)) as (A' & B' & C').
    split; [exact A'|]. split; [|exact C'].
    intros w a b Ta Tb Q1. apply (B' w a b Ta Tb), (C w a b Ta Tb), Q1.
  - destruct (unite_spec L Few U rho d q p R Q P (eq_sym E) (not_eq_sym N) (Nat.lt_le_incl _ _ X))
      as (A & B & _ & C & _).
    cbn [fold_left]. rewrite G'. destruct (IH _ _ A ltac:(lia)) as (A' & B' & C').
    split; [exact A'|]. split; [|exact C'].
    intros w a b Ta Tb Q1. apply (B' w a b Ta Tb), (C w a b Ta Tb), Q1.
Qed.

(** The ranks before the first merge: the start is above all other visits. *)
Definition rank_0 (x : positive) := if Pos.eqb x 1 then 1 else 0.

(** The evidence that leads on from a union-find until all is merged. *)
Definition saturating_from U rho := saturation (S (length (sights L))) U rho.

(** The union-find after it. *)
Definition fold_from U rho := fold_left (glue T D) (saturating_from U rho) U.

(** All conflicts that there might be. *)
Definition all_conflicts := map Arrive (list_prod all_arcs all_arcs) ++
  map Marked (all_visits L) ++ map Alone (map fst (enum 1 (edges L extra))).

(** The first conflict that the union-find then shows; None if it shows none. *)
Definition conflict_from U rho := List.find (check_conflict T D (fold_from U rho)) all_conflicts.

(** The evidence that a log with assumed edges gives by itself. *)
Definition saturating := saturating_from (markers T (sights L)) rank_0.

(** The union-find after it. *)
Definition saturated_fold := folded L extra saturating.

(** The first conflict that it shows; None if it shows none. *)
Definition conflict_found := conflict_from (markers T (sights L)) rank_0.

(** The same conflict, or any where there is none. *)
Definition first_conflict := match conflict_found with Some c => c | None => Alone 1 end.
End Saturated.
