(** The map S grows: its first vertex, then loops and new vertices (docs/semantics.md, sections 3
    and 4).

    M is the map S, W the world, phi their correspondence; e is the open dart that was explored, h
    the dart that it is joined with, a the dart of the world behind e, d the degree of a new vertex.

    Each augmentation keeps the map well formed, connected and embedded in the world (claim 5).
    Each explores two more darts, so there are as many rounds as edges. *)
From Coq Require Import Arith Lia List Bool.
Import ListNotations.
From Topo Require Import World Rotation Embedding.

(** The partner function after e and h have become partners. *)
Definition join (f : nat -> option nat) e h x :=
  if x =? e then Some h else if x =? h then Some e else f x.

(** The rotation after a new vertex: its darts are n, n+1, ..., n+d-1 in clockwise order, the
    entry dart first. *)
Definition grow (f : nat -> nat) n d x :=
  if x <? n then f x else if S x <? n + d then S x else n.

(** The map at the start: v0 of degree d without explored darts; dart 0 is the root. *)
Definition initial d := {| darts := d; sigma := grow id 0 d; alpha := fun _ => None; root := 0 |}.

(** Augmentation by a loop: e and h become partners. *)
Definition augment_loop M e h :=
  {| darts := darts M; sigma := sigma M; alpha := join (alpha M) e h; root := root M |}.

(** Augmentation by a new vertex of degree d: e and its first dart become partners. *)
Definition augment_new M e d :=
  {| darts := darts M + d; sigma := grow (sigma M) (darts M) d;
     alpha := join (fun x => if x <? darts M then alpha M x else None) e (darts M); root := root M |}.

(** The correspondence after a new vertex: its darts correspond to those of the vertex of a. *)
Definition extend (phi : nat -> nat) n W a x := if x <? n then phi x else turn W (x - n) a.

(** A tactic: split on every comparison of numbers, and close the goals that arithmetic closes. *)
Ltac cases := repeat match goal with
  | H : Some _ = Some _ |- _ => injection H as H
  | |- context [?a =? ?b] => destruct (Nat.eqb_spec a b)
  | |- context [?a <? ?b] => destruct (Nat.ltb_spec a b)
  | H : context [?a =? ?b] |- _ => destruct (Nat.eqb_spec a b)
  | H : context [?a <? ?b] |- _ => destruct (Nat.ltb_spec a b)
  end; subst; try lia; try discriminate.

(** Dart a of the world corresponds to no dart of the map. *)
Definition is_new M (phi : nat -> nat) a := forall h, h < darts M -> phi h <> a.

(** If a dart of the world is new to the map, so is every dart of its vertex. *)
Lemma new_vertex M W phi a : is_map M -> is_map W -> embedded M W phi -> a < darts W -> is_new M phi a ->
  forall h k, h < darts M -> k < degree W a -> phi h <> turn W k a.
Proof.
  intros WM WW E Ha N h k Hh Hk Eq. destruct (degree_spec W WW a Ha) as (_ & B & _).
  apply (N (turn M (degree W a - k) h)); [apply turn_lt; auto|].
  rewrite (embedded_turn M W phi WM E), Eq, <- turn_add by auto.
  replace (degree W a - k + k) with (degree W a) by lia. auto.
Qed.

(** The map at the start is well formed. *)
Lemma is_map_initial d : 0 < d -> is_map (initial d).
Proof.
  intros Hd. split; simpl; auto; unfold grow; intros; cases.
Qed.

(** The map at the start is embedded in the world at v0. *)
Lemma embedded_initial W : is_map W -> embedded (initial (degree W (root W))) W (fun x => turn W x
  (root W)).
Proof.
  intros WW. assert (R := root_lt W WW). destruct (degree_spec W WW _ R) as (A & B & C).
  split; simpl; auto; try discriminate.
  - intros; apply turn_lt; auto.
  - intros d e Hd He. apply turn_eq; auto.
  - intros d Hd. unfold grow; cases; simpl; auto.
    change (root W = turn W (S d) (root W)). replace (S d) with (degree W (root W)) by lia. auto.
Qed.

(** Joining two different open darts keeps the map well formed. *)
Lemma is_map_loop M e h : is_map M -> e < darts M -> h < darts M -> h <> e ->
  alpha M e = None -> alpha M h = None -> is_map (augment_loop M e h).
Proof.
  intros WM He Hh N Oe Oh. split; simpl; try apply WM.
  intros d x Hd. unfold join. intros Hx. cases; auto.
  all: apply (alpha_ok M WM) in Hx; auto; intuition congruence.
Qed.

(** Claim 5: joining e and h keeps the map embedded if the world has that edge. *)
Theorem embedded_loop M W phi e h : is_map W -> embedded M W phi -> e < darts M -> h < darts M ->
  alpha W (phi e) = Some (phi h) -> embedded (augment_loop M e h) W phi.
Proof.
  intros WW E He Hh H. destruct E as [E1 E2 E3 E4 E5]. split; simpl; auto.
  intros d x Hd. unfold join. intros Hx.
  assert (H' := H). apply (alpha_ok W WW) in H'; auto. cases; try apply H'; auto.
Qed.

(** Adding a vertex behind an open dart keeps the map well formed. *)
Lemma is_map_new M e d : is_map M -> e < darts M -> alpha M e = None -> 0 < d ->
  is_map (augment_new M e d).
Proof.
  intros WM He Oe Hd. assert (L := sigma_lt M WM). split; simpl.
  - intros x Hx. unfold grow. specialize (L x). cases.
  - intros x y Hx Hy. unfold grow. assert (Lx := L x). assert (Ly := L y).
    intros Exy. cases; auto. apply (sigma_inj M WM); auto.
  - intros x y Hx. unfold join. intros Hy. cases; auto.
    all: try (apply (alpha_ok M WM) in Hy; auto; destruct Hy as (Ly & Ny & Hy)).
    all: repeat split; auto; try lia; congruence.
  - assert (R := root_lt M WM). lia.
Qed.

(** Claim 5: adding a vertex behind e keeps the map embedded if the vertex behind e is new to it. *)
Theorem embedded_new M W phi e a : is_map M -> is_map W -> embedded M W phi -> e < darts M ->
  alpha W (phi e) = Some a -> is_new M phi a ->
  embedded (augment_new M e (degree W a)) W (extend phi (darts M) W a).
Proof.
  intros WM WW E He Ha N.
  assert (La : a < darts W) by (eapply alpha_ok; eauto; apply (phi_lt _ _ _ E); auto).
  assert (V := new_vertex M W phi a WM WW E La N).
  destruct (degree_spec W WW a La) as (A & B & _).
  assert (LM := sigma_lt M WM). split; simpl; unfold extend.
  - intros x Hx. cases; [apply (phi_lt _ _ _ E); auto|apply turn_lt; auto].
  - intros x y Hx Hy Exy. cases.
    + apply (phi_inj _ _ _ E); auto.
    + apply V in Exy; lia.
    + symmetry in Exy. apply V in Exy; lia.
    + apply (turn_eq W WW) in Exy; lia.
  - intros x Hx. unfold grow. specialize (LM x). cases.
    + apply (phi_sigma _ _ _ E); auto.
    + replace (S x - darts M) with (S (x - darts M)) by lia. auto.
    + rewrite Nat.sub_diag. change (a = turn W (S (x - darts M)) a).
      replace (S (x - darts M)) with (degree W a) by lia. auto.
  - intros x y Hx. unfold join. intros Hy. cases; auto.
    + apply (phi_alpha _ _ _ E); auto.
    + rewrite Ha, Nat.sub_diag; auto.
    + apply (alpha_ok M WM) in Hy; lia.
    + rewrite Nat.sub_diag. simpl. eapply alpha_ok; eauto. apply (phi_lt _ _ _ E); auto.
  - assert (R := root_lt M WM). cases. apply (phi_root _ _ _ E).
Qed.

(** The map at the start is connected. *)
Lemma connected_initial d : 0 < d -> connected (initial d).
Proof.
  intros Hd x. simpl. induction x as [|x IH]; intros Hx; [constructor|].
  replace (S x) with (sigma (initial d) x) by (simpl; unfold grow; cases).
  apply reach_sigma, IH. lia.
Qed.

(** Joining two open darts keeps the map connected. *)
Lemma connected_loop M e h : alpha M e = None -> alpha M h = None -> connected M ->
  connected (augment_loop M e h).
Proof.
  intros Oe Oh C d Hd. apply C in Hd. simpl in *. induction Hd as [|d _ IH|d x _ IH Hx].
  - constructor.
  - apply (reach_sigma (augment_loop M e h)); auto.
  - apply (reach_alpha _ _ d); auto. simpl. unfold join. cases; congruence.
Qed.

(** Adding a vertex behind an open dart keeps the map connected. *)
Lemma connected_new M e d : is_map M -> e < darts M -> alpha M e = None -> connected M ->
  connected (augment_new M e d).
Proof.
  intros WM He Oe C. set (N := augment_new M e d).
  assert (Old : forall x, reach M (root M) x -> x < darts M /\ reach N (root M) x).
  { induction 1 as [|x _ (Lx & IH)|x y _ (Lx & IH) Hy].
    - split; [apply root_lt; auto|constructor].
    - split; [apply sigma_lt; auto|].
      replace (sigma M x) with (sigma N x) by (simpl; unfold grow; cases). apply reach_sigma; auto.
    - assert (Ly : y < darts M) by (eapply alpha_ok; eauto).
      split; auto. apply (reach_alpha _ _ x); auto. simpl. unfold join. cases; congruence. }
  assert (New : forall i, i < d -> reach N (root M) (darts M + i)).
  { intros i. induction i as [|i IH]; intros Hi.
    - rewrite Nat.add_0_r. apply (reach_alpha _ _ e); [apply Old, C; auto|].
      simpl. unfold join. cases; auto.
    - replace (darts M + S i) with (sigma N (darts M + i)) by (simpl; unfold grow; cases).
      apply reach_sigma, IH. lia. }
  intros x Hx. simpl in *. destruct (Nat.ltb_spec x (darts M)) as [L|L].
  - apply Old, C; auto.
  - replace x with (darts M + (x - darts M)) by lia. apply New. lia.
Qed.

(** How many numbers below n satisfy p. *)
Fixpoint count (p : nat -> bool) n :=
  match n with 0 => 0 | S n => (if p n then 1 else 0) + count p n end.

(** Is dart d explored? *)
Definition explored M d := match alpha M d with Some _ => true | None => false end.

(** The number of explored darts. *)
Definition known M := count (explored M) (darts M).

(** The count depends on the values of p only. *)
Lemma count_ext p q n : (forall x, x < n -> p x = q x) -> count p n = count q n.
Proof. intros H. induction n as [|n IH]; simpl; auto. rewrite H, IH by auto. auto. Qed.

(** If e < n does not satisfy p, adding e to p raises the count by one. *)
Lemma count_more p e n : e < n -> p e = false ->
  count (fun x => (x =? e) || p x) n = S (count p n).
Proof.
  intros He Pe. induction n as [|n IH]; [lia|]. simpl.
  destruct (Nat.eqb_spec n e) as [->|].
  - rewrite Pe. simpl. f_equal. apply count_ext. intros x Hx. cases; auto.
  - rewrite IH by lia. simpl. lia.
Qed.

(** At most n numbers below n satisfy p. *)
Lemma count_le p n : count p n <= n.
Proof. induction n as [|n IH]; simpl; auto. destruct (p n); simpl; lia. Qed.

(** If one number below n does not satisfy p, fewer than n do. *)
Lemma count_lt p n e : e < n -> p e = false -> count p n < n.
Proof. intros He Pe. apply (count_more p e n He) in Pe. unfold lt. rewrite <- Pe. apply count_le. Qed.

(** A loop raises the number of explored darts by two. *)
Theorem loop_two_more M e h : e < darts M -> h < darts M -> h <> e ->
  alpha M e = None -> alpha M h = None -> known (augment_loop M e h) = 2 + known M.
Proof.
  intros He Hh N Oe Oh. unfold known, explored. simpl. unfold join.
  rewrite <- (count_more _ h), <- (count_more _ e); auto.
  - apply count_ext. intros x _. cases; auto.
  - cases. rewrite Oe. auto.
  - rewrite Oh; auto.
Qed.

(** A new vertex raises the number of explored darts by two. *)
Theorem new_two_more M e d : e < darts M -> alpha M e = None -> 0 < d ->
  known (augment_new M e d) = 2 + known M.
Proof.
  intros He Oe Hd. unfold known, explored. simpl. unfold join.
  set (old := fun x => (x <? darts M) && match alpha M x with Some _ => true | None => false end).
  assert (C : forall k, count old (k + darts M) =
                        count (fun x => match alpha M x with Some _ => true | None => false end)
                          (darts M)).
  { intros k. induction k as [|k IH]; simpl.
    - apply count_ext. intros x Hx. unfold old. cases; auto.
    - rewrite IH. unfold old. cases; auto. }
  rewrite <- (C d), (Nat.add_comm d), <- (count_more old (darts M)), <- (count_more _ e); try lia.
  - apply count_ext. intros x _. unfold old. cases; auto.
  - unfold old. cases. rewrite Oe; auto.
  - unfold old. cases; auto.
Qed.

(** If no dart is open, all darts are explored. *)
Lemma known_all M : (forall d, d < darts M -> alpha M d <> None) -> known M = darts M.
Proof.
  intros T. unfold known. rewrite (count_ext _ (fun _ => true)).
  - clear T. induction (darts M) as [|n IH]; simpl; congruence.
  - intros d Hd. unfold explored. destruct (alpha M d) eqn:E; auto. destruct (T d Hd E).
Qed.

(** Either some dart is open, or none is. *)
Lemma open_or_closed M : (exists e, e < darts M /\ alpha M e = None) \/
  (forall d, d < darts M -> alpha M d <> None).
Proof.
  destruct (find (fun d => negb (explored M d)) (seq 0 (darts M))) as [e|] eqn:F.
  - left. apply find_seq in F as (He & Oe & _). exists e. split; [lia|].
    unfold explored in Oe. destruct (alpha M e); [discriminate|auto].
  - right. intros d Hd Od. assert (Q := find_none _ _ F d). unfold explored in Q. cbv beta in Q.
    rewrite Od in Q. discriminate Q. apply in_seq. lia.
Qed.
