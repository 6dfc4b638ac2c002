(** Union by rank: the chains of parents stay within the fuel of the checker (claims 9 and 10;
    docs/proofs.md).

    L is a log, d a degree, r a root, z a place, rho gives each visit a rank; the other letters are
    those of Checker.v.

    The invariant of the union-find is [ranked]: ranks grow towards the roots, and the visits are
    at least as many as the roots of rank r times 2^r. So with fewer than 2^40 visits no chain is
    longer than 40 parents, and [rep] ends at a root ([rep_spec]). [unite_spec] says that each merge
    keeps the invariant if the root of higher rank stays a root. *)
From Coq Require Import Arith Lia List Bool PArith FMapPositive.
Import ListNotations.
From Topo Require Import World Rotation Log Table Checker CheckerCorrect.

(** The number of entries of a numbered list. *)
Lemma find_enum {X} (l : list X) : forall y t x a, nth_error l (Pos.to_nat x - Pos.to_nat y) = Some a ->
  Pos.to_nat y <= Pos.to_nat x ->
  PositiveMap.find x (fold_left (fun t (xa : positive * X) => PositiveMap.add (fst xa) (snd xa) t)
    (enum y l) t) = Some a.
Proof.
  assert (Keep : forall (l : list X) y t x, Pos.to_nat x < Pos.to_nat y ->
    PositiveMap.find x (fold_left (fun t (xa : positive * X) => PositiveMap.add (fst xa) (snd xa) t)
      (enum y l) t) = PositiveMap.find x t).
  { clear. intros l. induction l as [|b l IH]; simpl; intros y t x Lt; auto.
    rewrite IH by (rewrite Pos2Nat.inj_succ; lia). apply PositiveMap.gso. intros ->. lia. }
  induction l as [|b l IH]; intros y t x a H Le; [destruct (_ - _); discriminate|].
  cbn [enum fold_left fst snd]. destruct (Nat.eq_dec (Pos.to_nat x) (Pos.to_nat y)) as [E|N].
  - rewrite E, Nat.sub_diag in H. injection H as ->. apply Pos2Nat.inj in E as ->.
    rewrite Keep by (rewrite Pos2Nat.inj_succ; lia). apply PositiveMap.gss.
  - apply IH; rewrite ?Pos2Nat.inj_succ; try lia.
    replace (Pos.to_nat x - Pos.to_nat y) with (S (Pos.to_nat x - S (Pos.to_nat y))) in H by lia.
    auto.
Qed.

(** The binary map of a list has all its elements. *)
Lemma table_of_find {X} (l : list X) x a :
  nth_error l (num x) = Some a -> PositiveMap.find x (table_of l) = Some a.
Proof.
  intros H. apply find_enum; [|apply Pos2Nat.is_pos]. rewrite Pos2Nat.inj_1, Nat.sub_1_r. auto.
Qed.

(** The binary number of a visit. *)
Lemma num_of i : num (Pos.of_succ_nat i) = i.
Proof. unfold num. rewrite SuccNat2Pos.id_succ. auto. Qed.

Local Opaque fuel.

Section Ranked.
Variable L : Log.
Notation T := (table_of (sights L)).
Notation find := PositiveMap.find.
Notation rep := (rep T fuel).
Notation unite := (unite T).

(** A place whose offset is below the degree of its visit. *)
Definition tidy d (p : pplace) := (exists m, find (fst p) T = Some (d, m)) /\ snd p < d.

(** A visit's degree, and whether it saw the marker. *)
Definition sign (x : positive) := match find x T with
  | Some (d, m) => Some (d, match m with Some _ => true | None => false end) | None => None end.

(** p leads to the root r, parent by parent. *)
Inductive leads (U : unions) : pplace -> pplace -> Prop :=
| leads_root p : find (fst p) U = None -> leads U p p
| leads_up p y o r : find (fst p) U = Some (y, o) -> leads U (reduced T (y, snd p + o)) r ->
    leads U p r.

(** A place leads to one root only. *)
Lemma leads_det U p r : leads U p r -> forall s, leads U p s -> r = s.
Proof.
  induction 1 as [p N|p y o r E _ IH]; intros s H; inversion H; subst; try congruence.
  apply IH. congruence.
Qed.

(** What a place leads to is a root. *)
Lemma leads_to_root U p r : leads U p r -> find (fst r) U = None.
Proof. induction 1; auto. Qed.

(** Reducing a place at a visit of degree d. *)
Lemma reduced_tidy x a d m : find x T = Some (d, m) -> reduced T (x, a) = (x, a mod d).
Proof. intros E. unfold reduced. simpl. rewrite E. auto. Qed.

(** The visits of the log. *)
Definition all_visits := map fst (enum 1 (sights L)).

(** The mass of a visit: rho of it if it is a root, else 0. *)
Definition own (U : unions) (rho : positive -> nat) (x : positive) :=
  match find x U with None => rho x | Some _ => 0 end.

(** The sum of these masses. *)
Definition mass (U : unions) (rho : positive -> nat) := list_sum (map (own U rho) all_visits).

(** A root has its mass. *)
Lemma own_root U rho x : find x U = None -> own U rho x = rho x.
Proof. unfold own. intros ->. auto. Qed.

(** A child has none. *)
Lemma own_child U rho x z : find x U = Some z -> own U rho x = 0.
Proof. unfold own. intros ->. auto. Qed.

(** Another visit's own mass is not changed by a link. *)
Lemma own_other U rho rho' x z y : x <> y -> rho' x = rho x ->
  own (PositiveMap.add y z U) rho' x = own U rho x.
Proof. intros N E. unfold own. rewrite PositiveMap.gso, E; auto. Qed.

(** The union-find is by rank: ranks grow towards the roots, and a root of rank r has mass 2^r
    of the number of visits. It joins only visits with the same sign. *)
Record ranked (U : unions) (rho : positive -> nat) : Prop := {
  rk_up : forall x y o, find x U = Some (y, o) -> rho x < rho y;
  rk_sign : forall x y o, find x U = Some (y, o) -> sign x = sign y /\ sign x <> None;
  rk_top : forall x, sign x <> None -> exists r, find r U = None /\ sign r <> None /\ rho x <= rho r;
  rk_weight : mass U (fun x => 2 ^ rho x) <= S (length (sights L));
  rk_out : forall x, sign x = None -> rho x = 0 }.

(** The ranks after root y was linked under root x. *)
Definition raised (rho : positive -> nat) x y z :=
  if Pos.eqb z x then Nat.max (rho x) (S (rho y)) else rho z.

(** What has a sign is a visit. *)
Lemma visit_listed x : sign x <> None -> In x all_visits.
Proof.
  unfold sign, all_visits. destruct (find x T) as [p|] eqn:E; [|tauto]. intros _.
  apply table_of_spec in E. apply in_map_iff.
  destruct (in_enum (sights L) 1 _ _ E) as (y & I & Y). exists (y, p). split; auto. simpl.
  apply Pos2Nat.inj. rewrite Y, Pos2Nat.inj_1. unfold num. assert (H := Pos2Nat.is_pos x). lia.
Qed.

(** No visit is listed twice. *)
Lemma visits_NoDup : NoDup all_visits.
Proof.
  unfold all_visits. generalize 1%positive. induction (sights L) as [|a l IH]; intros y; simpl;
    constructor; auto.
  intros H. apply in_map_iff in H as ((x, b) & E & I). simpl in E. subst x. apply enum_in in I as [I _].
  rewrite Pos2Nat.inj_succ in I. lia.
Qed.

(** A tidy place has a sign, with its degree. *)
Lemma tidy_sign d p : tidy d p -> exists m, sign (fst p) = Some (d, m).
Proof. intros [(m & E) _]. unfold sign. rewrite E. eauto. Qed.

(** Along the parents sign and order stay the same. *)
Lemma leads_tidy U rho p r : ranked U rho -> leads U p r -> forall d, tidy d p ->
  tidy d r /\ sign (fst p) = sign (fst r).
Proof.
  intros R. induction 1 as [p N|p y o r E _ IH]; intros d P; auto.
  destruct (rk_sign U rho R _ y o E) as [B C]. destruct (tidy_sign d p P) as (m & Sp).
  assert (Y : exists m, find y T = Some (d, m)).
  { assert (Sy := eq_trans (eq_sym B) Sp). unfold sign in Sy.
    destruct (find y T) as [(e, n)|]; [|discriminate].
    injection Sy as -> _. eauto. }
  destruct Y as (n & Y). rewrite (reduced_tidy _ _ _ _ Y) in IH.
  destruct (IH d) as [A A']; [|split; [exact A|exact (eq_trans B A')]].
  split; [exists n; auto|]. simpl. apply Nat.mod_upper_bound. destruct P as [_ P]. lia.
Qed.

(** Turning a place turns its root's place by as much. *)
Lemma leads_turn U rho p r : ranked U rho -> leads U p r -> forall d k, tidy d p ->
  leads U (fst p, (snd p + k) mod d) (fst r, (snd r + k) mod d).
Proof.
  intros R. induction 1 as [p N|p y o r E _ IH]; intros d k P; [constructor; auto|].
  destruct p as (x, a). cbn [fst snd] in *.
  destruct (rk_sign U rho R _ y o E) as [B C]. destruct (tidy_sign d _ P) as (m & Sp).
  assert (Y : exists m, find y T = Some (d, m)).
  { cbn [fst] in Sp. assert (Sy := eq_trans (eq_sym B) Sp). unfold sign in Sy.
    destruct (find y T) as [(e, n)|]; [|discriminate]. injection Sy as -> _. eauto. }
  destruct Y as (n & Y). rewrite (reduced_tidy _ _ _ _ Y) in IH.
  assert (Pd : d <> 0) by (destruct P as [_ P]; simpl in P; lia).
  specialize (IH d k). simpl in IH. apply leads_up with y o; auto. cbn [fst snd].
  rewrite (reduced_tidy _ _ _ _ Y). rewrite Nat.add_mod_idemp_l in * by auto.
  replace (a + k + o) with (a + o + k) by lia. apply IH.
  split; [exists n; auto|]. simpl. apply Nat.mod_upper_bound. auto.
Qed.

(** Where the places of root y lead after y was linked to the place (x, i). *)
Definition moved y z (r : pplace) := if Pos.eqb (fst r) y then reduced T (fst z, snd r + snd z) else r.

(** A place that led to the root r leads to [moved] r. *)
Lemma leads_moved U y (z p r : pplace) : find y U = None -> find (fst z) U = None -> fst z <> y ->
  leads U p r -> leads (PositiveMap.add y z U) p (moved y z r).
Proof.
  destruct z as (zx, zo). cbn [fst]. intros Ny Nz N.
  assert (F : forall a, fst (reduced T (zx, a)) = zx).
  { intros a. unfold reduced; simpl. destruct (find zx T) as [(d, m)|]; auto. }
  induction 1 as [(px, pa) Np|p w o r E _ IH]; cbn [fst] in *.
  - unfold moved. cbn [fst snd]. destruct (Pos.eqb_spec px y) as [->|Ne].
    + apply (leads_up _ (y, pa) zx zo); [cbn [fst]; apply PositiveMap.gss|]. cbn [snd].
      apply leads_root. rewrite PositiveMap.gso; [|rewrite F; auto]. rewrite F; auto.
    + apply leads_root. cbn [fst]. rewrite PositiveMap.gso; auto.
  - apply leads_up with w o; auto. rewrite PositiveMap.gso; auto. intros Eq. congruence.
Qed.

(** The number of roots. *)
Definition roots U := mass U (fun _ => 1).

(** Two sums that differ at x and y only. *)
Lemma sum_change l (f g : positive -> nat) x y : NoDup l -> In x l -> In y l -> x <> y ->
  (forall z, z <> x -> z <> y -> f z = g z) ->
  list_sum (map f l) + (g x + g y) = list_sum (map g l) + (f x + f y).
Proof.
  assert (One : forall l z (f g : positive -> nat), NoDup l -> In z l ->
    (forall w, In w l -> w <> z -> f w = g w) ->
    list_sum (map f l) + g z = list_sum (map g l) + f z).
  { clear. intros l. induction l as [|a l IH]; intros z f g N I H; [destruct I|].
    inversion N as [|? ? Na Nl]; subst.
    simpl. destruct (Pos.eq_dec a z) as [->|Ne].
    - assert (E : list_sum (map f l) = list_sum (map g l)).
      { f_equal. apply map_ext_in. intros w W. apply H; [simpl; auto|]. intros ->. auto. }
      lia.
    - destruct I as [->|I]; [tauto|]. assert (A := IH z f g Nl I). rewrite (H a) by (simpl; auto).
      specialize (A (fun w W => H w (or_intror W))). lia. }
  intros N X Y Ne H. set (h := fun z => if Pos.eqb z y then f y else g z).
  assert (A := One l x f h N X). assert (B := One l y h g N Y).
  assert (Hy : h y = f y) by (unfold h; rewrite Pos.eqb_refl; auto).
  assert (Hx : h x = g x) by (unfold h; destruct (Pos.eqb_spec x y); tauto).
  assert (A' : list_sum (map f l) + h x = list_sum (map h l) + f x).
  { apply A. intros w _ W. unfold h. destruct (Pos.eqb_spec w y) as [->|]; auto. }
  assert (B' : list_sum (map h l) + g y = list_sum (map g l) + h y).
  { apply B. intros w _ W. unfold h. destruct (Pos.eqb_spec w y); tauto. }
  lia.
Qed.

(** The rank of the root that was kept. *)
Lemma raised_root rho x y : raised rho x y x = Nat.max (rho x) (S (rho y)).
Proof. unfold raised. rewrite Pos.eqb_refl. auto. Qed.

(** Other ranks do not change. *)
Lemma raised_other rho x y z : z <> x -> raised rho x y z = rho z.
Proof. unfold raised. destruct (Pos.eqb_spec z x); tauto. Qed.

(** No rank falls. *)
Lemma raised_grows rho x y z : rho z <= raised rho x y z.
Proof. unfold raised. destruct (Pos.eqb_spec z x) as [->|]; lia. Qed.

(** Linking a root under another that is at least as high keeps the ranks, and lessens the roots. *)
Lemma link_ranked U rho x y o : ranked U rho -> find x U = None -> find y U = None -> x <> y ->
  sign x = sign y -> sign x <> None -> rho y <= rho x ->
  ranked (PositiveMap.add y (x, o) U) (raised rho x y) /\ roots (PositiveMap.add y (x, o) U) < roots U.
Proof.
  intros R Nx Ny N E Sg Le.
  assert (Rx := raised_root rho x y). assert (Ro := raised_other rho x y).
  assert (Rl := raised_grows rho x y). revert Rx Ro Rl.
  generalize (raised rho x y). intros rho' Rx Ro Rl.
  split.
  - split.
    + intros z w o'. destruct (Pos.eq_dec z y) as [->|Z].
      * rewrite PositiveMap.gss. intros Q. injection Q as <- <-. rewrite Rx, Ro; auto; lia.
      * rewrite PositiveMap.gso by auto. intros F. assert (A := rk_up U rho R z w o' F).
        assert (Zx : z <> x).
        { intros Q. rewrite Q in F. assert (X := eq_trans (eq_sym Nx) F). discriminate X. }
        rewrite (Ro z Zx). specialize (Rl w). lia.
    + intros z w o'. destruct (Pos.eq_dec z y) as [->|Z].
      * rewrite PositiveMap.gss. intros Q. injection Q as <- <-. split; congruence.
      * rewrite PositiveMap.gso by auto. apply (rk_sign U rho R).
    + intros z Sz. destruct (rk_top U rho R z Sz) as (r & A & B & C).
      destruct (Pos.eq_dec z x) as [->|Zx].
      { exists x. rewrite PositiveMap.gso by auto. auto. }
      destruct (Pos.eq_dec r y) as [->|Ry].
      * exists x. rewrite PositiveMap.gso by auto. rewrite Rx, (Ro z) by auto. repeat split; auto; lia.
      * exists r. rewrite PositiveMap.gso by auto. rewrite (Ro z) by auto. repeat split; auto.
        specialize (Rl r). lia.
    + eapply Nat.le_trans; [|apply (rk_weight U rho R)]. unfold mass.
      assert (A := sum_change all_visits (own (PositiveMap.add y (x, o) U) (fun z => 2 ^ rho' z))
        (own U (fun z => 2 ^ rho z)) x y visits_NoDup
        (visit_listed x Sg) (visit_listed y ltac:(congruence)) N).
      rewrite (own_child (PositiveMap.add y (x, o) U) _ y (x, o)) in A by apply PositiveMap.gss.
      rewrite (own_root (PositiveMap.add y (x, o) U) _ x), !own_root, Rx in A
        by (auto; rewrite PositiveMap.gso; auto).
      assert (P : 2 ^ Nat.max (rho x) (S (rho y)) <= 2 ^ rho x + 2 ^ rho y).
      { destruct (Nat.eq_dec (rho x) (rho y)) as [Q|Q].
        - rewrite Q, Nat.max_r by lia. simpl. lia.
        - rewrite Nat.max_l by lia. lia. }
      specialize (A (fun z Zx Zy => own_other U _ (fun z => 2 ^ rho' z) z (x, o) y Zy
        (f_equal (Nat.pow 2) (Ro z Zx)))). lia.
    + intros z Z. rewrite Ro by congruence. apply (rk_out U rho R z Z).
  - unfold roots, mass.
    assert (A := sum_change all_visits (own (PositiveMap.add y (x, o) U) (fun _ => 1))
        (own U (fun _ => 1)) x y visits_NoDup
        (visit_listed x Sg) (visit_listed y ltac:(congruence)) N).
    rewrite (own_child (PositiveMap.add y (x, o) U) _ y (x, o)) in A by apply PositiveMap.gss.
    rewrite (own_root (PositiveMap.add y (x, o) U) _ x), !own_root in A
      by (auto; rewrite PositiveMap.gso; auto).
    specialize (A (fun z Zx Zy => own_other U _ (fun _ => 1) z (x, o) y Zy eq_refl)). lia.
Qed.

Hypothesis Few : length (sights L) < 2 ^ fuel.

(** One of the numbers is at most their sum. *)
Lemma sum_in l (f : positive -> nat) x : In x l -> f x <= list_sum (map f l).
Proof.
  induction l as [|y l IH]; simpl; [intros []|]. intros [->|H]; [lia|]. apply IH in H. lia.
Qed.

(** No rank is greater than the fuel. *)
Lemma rank_fuel U rho x : ranked U rho -> sign x <> None -> rho x <= fuel.
Proof.
  intros R X. destruct (rk_top U rho R x X) as (r & N & Sr & Le). apply Nat.le_trans with (rho r); auto.
  assert (W := rk_weight U rho R). unfold mass in W.
  assert (H := sum_in all_visits (own U (fun x => 2 ^ rho x)) r (visit_listed r Sr)).
  rewrite own_root in H by auto.
  apply (Nat.pow_le_mono_r_iff 2); [auto|]. eapply Nat.le_trans; [exact H|].
  eapply Nat.le_trans; [exact W|exact Few].
Qed.

(** With enough fuel for the ranks above it, a place leads to its representative. *)
Lemma rep_leads U rho n : ranked U rho -> forall p : pplace, sign (fst p) <> None ->
  fuel <= rho (fst p) + n ->
  leads U p (Checker.rep T n U p).
Proof.
  intros R. induction n as [|n IH]; intros (x, a) X Le; cbn [Checker.rep fst snd] in *.
  - destruct (find x U) as [(y, o)|] eqn:E; [|constructor; auto].
    assert (A := rk_up U rho R x y o E). destruct (rk_sign U rho R x y o E) as [B C].
    assert (H := rank_fuel U rho y R ltac:(congruence)). exfalso. revert A Le H. generalize fuel. lia.
  - destruct (find x U) as [(y, o)|] eqn:E; [|constructor; auto].
    apply leads_up with y o; auto. cbn [fst snd].
    assert (A := rk_up U rho R x y o E). destruct (rk_sign U rho R x y o E) as [B C].
    assert (F : fst (reduced T (y, a + o)) = y).
    { unfold reduced; simpl. destruct (find y T) as [(d, m)|]; auto. }
    apply IH; [rewrite F; congruence|rewrite F; revert A Le; generalize fuel; lia].
Qed.

(** Every place of a visit leads to its representative, which is a root. *)
Lemma rep_spec U rho p : ranked U rho -> sign (fst p) <> None -> leads U p (rep U p).
Proof. intros R X. apply (rep_leads U rho fuel R); auto. apply Nat.le_add_l. Qed.

(** What [unite] does to two places of one degree with different roots. *)
Lemma unite_spec U rho d p q : ranked U rho -> tidy d p -> tidy d q -> sign (fst p) = sign (fst q) ->
  fst (rep U p) <> fst (rep U q) -> rho (fst (rep U q)) <= rho (fst (rep U p)) ->
  ranked (unite U p q) (raised rho (fst (rep U p)) (fst (rep U q))) /\
    roots (unite U p q) < roots U /\
    rep (unite U p q) p = rep (unite U p q) q /\
    (forall d a b, tidy d a -> tidy d b -> rep U a = rep U b ->
      rep (unite U p q) a = rep (unite U p q) b) /\
    (forall z, find z U = None -> z <> fst (rep U q) -> find z (unite U p q) = None) /\
    forall d a, tidy d a -> fst (rep U a) <> fst (rep U q) -> rep (unite U p q) a = rep U a.
Proof.
  intros R P Q E N Le.
  assert (Lt : forall d a, tidy d a -> leads U a (rep U a)).
  { intros e a A. apply (rep_spec U rho a R). destruct (tidy_sign e a A) as (m & ->). discriminate. }
  destruct (leads_tidy U rho _ _ R (Lt d p P) d P) as [Tp Sp].
  destruct (leads_tidy U rho _ _ R (Lt d q Q) d Q) as [Tq Sq].
  assert (Np := leads_to_root _ _ _ (Lt d p P)). assert (Nq := leads_to_root _ _ _ (Lt d q Q)).
  assert (Lp := Lt d p P). assert (Lq := Lt d q Q).
  unfold Checker.unite. destruct (rep U p) as (x, i) eqn:Ep, (rep U q) as (y, j) eqn:Eq.
  cbn [fst snd] in *. destruct (Pos.eqb_spec x y) as [|_]; [tauto|].
  destruct Tq as [(mq & Fq) Lj], Tp as [(mp & Fp) Li]. cbn [fst snd] in *. rewrite Fq.
  destruct (Nat.leb_spec j d); [|lia]. rewrite (reduced_tidy x _ d mp Fp).
  set (z := (x, (d - j + i) mod d)).
  assert (Sx : sign x = sign y) by (rewrite <- Sp, E; exact Sq).
  assert (Sn : sign x <> None) by (unfold sign; rewrite Fp; discriminate).
  destruct (link_ranked U rho x y ((d - j + i) mod d) R Np Nq N Sx Sn Le) as [R' C].
  fold z in R', C. split; [exact R'|]. split; [exact C|].
  assert (Lt' : forall d a, tidy d a -> leads (PositiveMap.add y z U) a (rep (PositiveMap.add y z U) a)).
  { intros e a A. eapply rep_spec; [exact R'|]. destruct (tidy_sign e a A) as (m & ->). discriminate. }
  assert (M : forall d a, tidy d a -> rep (PositiveMap.add y z U) a = moved y z (rep U a)).
  { intros e a A. apply (leads_det _ _ _ (Lt' e a A)). apply leads_moved; auto. apply (Lt e a A). }
  split; [|split; [|split]].
  - refine (eq_trans (M d p P) (eq_sym (eq_trans (M d q Q) _))).
    rewrite Ep, Eq. unfold moved. cbn [fst snd]. rewrite Pos.eqb_refl.
    destruct (Pos.eqb_spec x y) as [|_]; [tauto|]. unfold z. cbn [fst snd].
    rewrite (reduced_tidy x _ d mp Fp). f_equal. rewrite Nat.add_mod_idemp_r by lia.
    replace (j + (d - j + i)) with (i + 1 * d) by lia. rewrite Nat.mod_add, Nat.mod_small; lia.
  - intros e a b A B Eab. refine (eq_trans (M e a A) (eq_sym (eq_trans (M e b B) _))). rewrite Eab. auto.
  - intros w W Ne. rewrite PositiveMap.gso; auto.
  - intros e a A Ne. refine (eq_trans (M e a A) _). unfold moved.
    destruct (Pos.eqb_spec (fst (rep U a)) y); tauto.
Qed.

(** U' has merged all that U has. *)
End Ranked.
