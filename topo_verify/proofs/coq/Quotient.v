(** A consistent fold is a map: its darts are the classes of places (docs/semantics.md, section 11).

    L is a log, assumed a list of assumed edges whose fold is consistent; p, q, r are places; M
    is the map, u i the reference dart of visit i in it. *)
From Coq Require Import Arith Lia List Bool.
Import ListNotations.
From Topo Require Import World Rotation Embedding Augment Log Determined Undetermined Classes.

Section Map.
Variables (L : Log) (assumed : assumed_edges).
Hypothesis (Cons : consistent assumed L).
Notation same := (same assumed L).
Notation link := (link assumed L).
Notation valid := (valid L).

(** M is the quotient of the places by [same]: it is a connected map that shows the log and has
    the assumed edges; two places are one dart exactly if they are identified; every dart is a
    place; every explored edge was crossed or assumed. *)
Record quotient (M : Map) (u : nat -> nat) : Prop := {
  q_map : is_map M;
  q_connected : connected M;
  q_visits : visits M L u;
  q_fits : fits M u assumed;
  q_same : forall p q, valid p -> valid q -> dart M u p = dart M u q -> same p q;
  q_onto : forall d, d < darts M -> exists p, valid p /\ dart M u p = d;
  q_link : forall p, valid p -> alpha M (dart M u p) <> None -> exists q r, link q r /\ same p q /\
           alpha M (dart M u p) = Some (dart M u r) }.

(** If its darts are the classes of places, a map shows at each visit the percept of the log. *)
Lemma marker_percept M u : is_map M -> (forall i, u i < darts M) -> u 0 = root M ->
  (forall p q, valid p -> valid q -> dart M u p = dart M u q <-> same p q) ->
  forall i p, seen L i = Some p -> percept M (u i) = p.
Proof.
  intros WM Lt R S i (d, m) E.
  destruct (c_percept assumed L Cons i d m E) as [Dp Mp].
  assert (V : forall k, valid (i, k)) by (intros k; unfold Log.valid; simpl; congruence).
  assert (V0 : valid (0, 0)) by (unfold Log.valid; simpl; discriminate).
  assert (Deg : degree M (u i) = d).
  { apply (degree_unique M WM); auto.
    - apply (S (i, d) (i, 0)); auto. apply (same_full assumed L i d m E).
    - intros k Hk Q. apply (S (i, k) (i, 0)) in Q; auto.
      apply (c_turn assumed L Cons i k 0 d m) in Q; auto; lia. }
  unfold percept. f_equal; auto. unfold marker. rewrite Deg.
  destruct (find _ _) as [j|] eqn:F.
  - apply find_seq in F as (Hj & Q & _). apply Nat.eqb_eq in Q. rewrite <- R in Q.
    apply (S (i, j) (0, 0)) in Q; auto. destruct m as [j'|].
    + assert (Q' := same_mark assumed L i d j' E). f_equal.
      specialize (Mp j' eq_refl). apply (c_turn assumed L Cons i j j' d (Some j')); auto; try lia.
      apply same_trans with (0, 0); [exact Q|apply same_sym; auto].
    + destruct (c_start assumed L Cons) as (d0 & E0). exfalso.
      apply (c_marker assumed L Cons 0 0 i j d0 0 d None); auto. apply same_sym; auto.
  - destruct m as [j|]; auto. exfalso.
    assert (N := find_none _ _ F j). cbv beta in N.
    assert (Q : turn M j (u i) = root M).
    { rewrite <- R. apply (S (i, j) (0, 0)); auto. apply (same_mark assumed L i d j E). }
    rewrite Q, Nat.eqb_refl in N. discriminate N. apply in_seq. specialize (Mp j eq_refl). lia.
Qed.

(** A consistent fold has a quotient. *)
Theorem quotient_exists : exists M u, quotient M u.
Proof.
  assert (D := same_dec L assumed Cons).
  destruct (representatives L assumed Cons (all_places L)) as (R & RA & RB & RC).
  set (pl := fun x => nth x R (0, 0)). set (n := length R).
  set (cls := fun p x => x < n /\ same p (pl x)).
  assert (PV : forall x, x < n -> valid (pl x)).
  { intros x Hx. apply listed_valid, RA, nth_In; auto. }
  assert (CT : forall p, valid p -> exists x, cls p x).
  { intros p P. destruct (RB (normal L p) (normal_listed L assumed Cons p P)) as (x & Hx & Sx).
    exists x. split; auto. eapply same_trans; [apply normal_same|auto]. }
  assert (CF : forall p q x y, cls p x -> cls q y -> same p q -> x = y).
  { intros p q x y [Hx Sx] [Hy Sy] S. apply RC; auto. fold (pl x) (pl y).
    eapply same_trans; [apply same_sym; exact Sx|]. eapply same_trans; eauto. }
  assert (CS : forall p q x, cls p x -> cls q x -> same p q).
  { intros p q x [_ A] [_ B]. eapply same_trans; [exact A|apply same_sym; auto]. }
  assert (CP : forall x, x < n -> cls (pl x) x) by (intros; split; auto; constructor).
  destruct (choice 0 (fun x y => cls (next_place (pl x)) y) n) as [f Hf].
  { intros x Hx. apply CT. apply (PV x Hx). }
  destruct (choice None (fun x o => match o with
    | Some y => exists q r, link q r /\ same (pl x) q /\ cls r y
    | None => forall q r, link q r -> ~ same (pl x) q end) n) as [g Hg].
  { intros x Hx.
    destruct (in_dec_exists (fun l => same (pl x) (fst l)) (all_links L assumed) (fun l => D _ _))
      as [((q, r) & I & S)|N].
    - apply (all_links_spec L assumed Cons) in I.
      destruct (CT r) as [y Hy]; [eapply link_valid, link_sym; eauto|].
      exists (Some y), q, r. auto.
    - exists None. intros q r I. apply (all_links_spec L assumed Cons) in I. apply (N _ I). }
  destruct (CT (0, 0)) as [o Ho]; [discriminate|].
  set (M := {| darts := n; sigma := f; alpha := g; root := o |}).
  assert (GL : forall q r x y, link q r -> cls q x -> cls r y -> g x = Some y).
  { intros q r x y K Hx Hy. assert (G := Hg x (proj1 Hx)). destruct (g x) as [z|].
    - destruct G as (q' & r' & K' & S & Hz). f_equal. apply (CF r' r); auto.
      apply (same_link assumed L q' r' q r); auto. apply same_sym.
      eapply same_trans; [apply Hx|auto].
    - destruct (G q r K). apply same_sym. apply Hx. }
  assert (WM : is_map M).
  { split; simpl.
    - intros x Hx. apply (Hf x Hx).
    - intros x y Hx Hy E. assert (A := Hf x Hx). assert (B := Hf y Hy). rewrite <- E in B.
      apply (CF (pl x) (pl y)); auto. assert (S := CS _ _ _ A B).
      assert (PX := PV x Hx). assert (PY := PV y Hy). destruct (pl x), (pl y).
      apply (back_place L assumed Cons); auto.
    - intros x y Hx E. assert (G := Hg x Hx). rewrite E in G. destruct G as (q & r & K & S & Hy).
      assert (Hq : cls q x) by (split; [auto|apply same_sym; auto]).
      repeat split; [apply Hy| |apply (GL r q); auto using link_sym].
      intros ->. apply (c_edge assumed L Cons q r K), (CS _ _ _ Hq Hy).
    - apply Ho. }
  assert (Len : forall i p, seen L i = Some p -> i < S (length (moves L))).
  { intros i p E. assert (H : nth_error (start L :: map snd (moves L)) i <> None)
      by (unfold seen in E; congruence).
    apply nth_error_Some in H. simpl in H. rewrite map_length in H. auto. }
  destruct (choice 0 (fun i x => cls (i, 0) x) (S (length (moves L)))) as [w Hw].
  { intros i Hi. apply CT. unfold Log.valid, seen. simpl fst. apply nth_error_Some. simpl.
    rewrite map_length. auto. }
  set (u := fun i => if i <? S (length (moves L)) then w i else o).
  assert (Hu : forall i p, seen L i = Some p -> cls (i, 0) (u i)).
  { intros i p E. apply Len in E. unfold u. rewrite (proj2 (Nat.ltb_lt _ _) E). auto. }
  assert (CD : forall p, valid p -> cls p (dart M u p)).
  { intros (i, k) P. unfold Log.valid in P. simpl in P.
    destruct (seen L i) as [p|] eqn:E; [|destruct P; auto]. unfold dart. simpl fst. simpl snd.
    induction k as [|k [IH1 IH2]]; [apply (Hu i p E)|]. simpl turn.
    destruct (Hf (turn M k (u i)) IH1) as [A B]. split; auto.
    eapply same_trans; [apply (next_same L assumed _ _ IH2)|auto]. }
  assert (DS : forall p q, valid p -> valid q -> dart M u p = dart M u q <-> same p q).
  { intros p q P Q. assert (A := CD p P). assert (B := CD q Q). split; intros E.
    - rewrite E in A. apply (CS _ _ _ A B).
    - apply (CF p q); auto. }
  assert (Ul : forall i, u i < darts M).
  { intros i. unfold u. destruct (Nat.ltb_spec i (S (length (moves L)))); [apply (Hw i);
      auto|apply Ho]. }
  assert (U0 : u 0 = root M).
  { apply (CF (0, 0) (0, 0) (w 0) o (Hw 0 ltac:(lia)) Ho). constructor. }
  assert (Per := marker_percept M u WM Ul U0 DS).
  assert (LS : forall q r, link q r -> alpha M (dart M u q) = Some (dart M u r)).
  { intros q r K. apply (GL q r); auto; apply CD; eauto using link_valid, link_sym. }
  assert (VS : visits M L u).
  { split; auto. intros i k E.
    assert (K := link_out assumed L i k E). assert (V := link_valid _ _ _ _ K).
    apply LS in K. unfold Log.valid in V. simpl in V. unfold move.
    destruct (seen L i) as [(d, m)|] eqn:Ei; [|destruct V; auto].
    assert (P := Per i _ Ei). injection P as P _. rewrite P.
    rewrite (proj2 (Nat.ltb_lt _ _) (c_door assumed L Cons i k d m E Ei)). auto. }
  assert (Onto : forall d, d < darts M -> exists p, valid p /\ dart M u p = d).
  { intros x Hx. exists (pl x). split; [apply (PV x Hx)|].
    apply (CF (pl x) (pl x) _ _ (CD _ (PV x Hx)) (CP x Hx)). constructor. }
  exists M, u. split; auto; clear Per.
  - intros x Hx. destruct (Onto x Hx) as ((i, k) & P & <-).
    unfold Log.valid in P. simpl in P. apply reach_turn. clear Hx.
    destruct (seen L i) as [p|] eqn:E; [clear P; apply Len in E|destruct P; auto]. clear p.
    induction i as [|i IH]; simpl fst; [rewrite U0; constructor|].
    destruct (door L i) as [k'|] eqn:Ek.
    + apply (reach_alpha M (root M) (turn M k' (u i))); [apply reach_turn, IH; lia|].
      apply (LS (i, k') (S i, 0)). constructor; auto.
    + unfold door in Ek. apply nth_error_None in Ek. rewrite map_length in Ek. lia.
  - intros p q I. destruct (c_assumed assumed L Cons p q I). apply LS, link_assumed; auto.
  - intros p q P Q E. apply DS; auto.
  - intros p P N. assert (Hp := CD p P). assert (G := Hg _ (proj1 Hp)).
    change (alpha M) with g in *. destruct (g (dart M u p)) as [y|] eqn:E; [|destruct N; auto].
    destruct G as (q & r & K & S & Hy). exists q, r. split; auto.
    split; [eapply same_trans; [apply Hp|auto]|].
    f_equal. apply (CF r r); auto; [|constructor]. apply CD. eapply link_valid, link_sym; eauto.
Qed.
End Map.
