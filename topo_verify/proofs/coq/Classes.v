(** The classes of a fold are decidable, and each has a representative (docs/semantics.md, section
    11).

    L is a log, assumed a list of assumed edges whose fold is consistent; p, q are places; c numbers
    the classes: it gives each place a number.

    [same] is an inductive closure. To decide it without an axiom, number all places differently,
    and merge class numbers until the rules ask for no more merges. Only finitely many places
    matter: those with offsets below the degree. *)
From Coq Require Import Arith Lia List Bool.
Import ListNotations.
From Topo Require Import World Rotation Embedding Augment Log Determined Undetermined.

(** Whether some element of a list satisfies P is decidable if P is. *)
Lemma in_dec_exists {A} (P : A -> Prop) l : (forall x, P x \/ ~ P x) ->
  (exists x, In x l /\ P x) \/ forall x, In x l -> ~ P x.
Proof.
  intros same_dec. induction l as [|a l [(x & I & H)|IH]]; [right; intros ? []|left; exists x;
    simpl; auto|].
  destruct (same_dec a); [left; exists a; simpl; auto|]. right. intros x [<-|I]; auto.
Qed.

Section Quotient.
Variables (L : Log) (assumed : assumed_edges).
Hypothesis (Cons : consistent assumed L).

(** The degree at every visit is positive. *)
Lemma deg_pos i d m : seen L i = Some (d, m) -> 0 < d.
Proof. apply (c_percept assumed L Cons). Qed.

(** If the next darts of two places are identified, so are the places. *)
Lemma back_place i a j b : valid L (i, a) -> valid L (j, b) ->
  same assumed L (i, S a) (j, S b) -> same assumed L (i, a) (j, b).
Proof.
  unfold valid; simpl. intros VA VB Q.
  destruct (seen L i) as [(d, m)|] eqn:Ei; [|destruct VA; auto].
  destruct (seen L j) as [(e, n)|] eqn:Ej; [|destruct VB; auto].
  assert (e = d) as -> by (symmetry; eapply (c_degree assumed L Cons); eauto).
  assert (P := deg_pos i d m Ei).
  assert (F : forall i m k, seen L i = Some (d, m) -> same assumed L (i, d - 1 + S k) (i, k)).
  { intros i0 m0 k E. replace (d - 1 + S k) with (k + d) by lia.
    rewrite <- (Nat.add_0_r k) at 2. apply same_turn, (same_full assumed L i0 d m0 E). }
  apply same_trans with (i, d - 1 + S a); [apply same_sym; eauto|].
  apply same_trans with (j, d - 1 + S b); [apply same_turn; auto|eauto].
Qed.

(** All places of the log with offsets below the degree. *)
Definition all_places := flat_map (fun i => map (pair i)
  (seq 0 (match seen L i with Some (d, _) => d | None => 0 end))) (seq 0 (S (length (moves L)))).

(** The places of that list are places of the log. *)
Lemma listed_valid p : In p all_places -> valid L p.
Proof.
  intros H. apply in_flat_map in H as (i & _ & H). apply in_map_iff in H as (k & <- & H).
  unfold valid; simpl. destruct (seen L i); [discriminate|destruct H].
Qed.

(** All edges crossed or assumed, in both directions. *)
Definition all_links := flat_map (fun i => match door L i with
  | Some k => [((i, k), (S i, 0)); ((S i, 0), (i, k))] | None => [] end) (seq 0 (length (moves L)))
  ++ assumed ++ map (fun l => (snd l, fst l)) assumed.

(** That list contains exactly the pairs in [link]. *)
Lemma all_links_spec p q : link assumed L p q <-> In (p, q) all_links.
Proof.
  unfold all_links. rewrite !in_app_iff, in_flat_map, in_map_iff. split.
  - assert (B : forall i k, door L i = Some k -> In i (seq 0 (length (moves L)))).
    { intros i k E. apply in_seq. unfold door in E.
      assert (H : nth_error (map fst (moves L)) i <> None) by congruence.
      apply nth_error_Some in H. rewrite map_length in H. lia. }
    intros [i k E|i k E|x y X _ _|x y X _ _]; auto.
    1, 2: left; exists i; rewrite E; simpl; eauto.
    right. right. exists (x, y). auto.
  - intros [(i & _ & H)|[H|((x, y) & E & H)]].
    + destruct (door L i) as [k|] eqn:E; [|destruct H].
      destruct H as [H|[H|[]]]; injection H as <- <-; constructor; auto.
    + apply link_assumed; auto; apply (c_assumed assumed L Cons p q H).
    + injection E as <- <-. apply link_assumed_back; auto; apply (c_assumed assumed L Cons x y H).
Qed.

(** The normal form of a place: its offset reduced modulo the degree. *)
Definition normal (p : place) : place := match seen L (fst p) with
  | Some (d, _) => (fst p, snd p mod d) | None => p end.

(** The next dart clockwise at the same visit. *)
Definition next_place (p : place) : place := (fst p, S (snd p)).

(** A place is identified with its normal form. *)
Lemma normal_same p : same assumed L p (normal p).
Proof.
  destruct p as (i, k). unfold normal; simpl. destruct (seen L i) as [(d, m)|] eqn:E; [|constructor].
  apply (same_mod assumed L i k d m E).
Qed.

(** The normal forms of places of the log are in [all_places]. *)
Lemma normal_listed p : valid L p -> In (normal p) all_places.
Proof.
  destruct p as (i, k). unfold valid, normal; simpl. intros A.
  destruct (seen L i) as [(d, m)|] eqn:Ei; [clear A|destruct A; auto].
  apply in_flat_map. exists i. split.
  - apply in_seq. assert (i < length (start L :: map snd (moves L)))
      by (apply nth_error_Some; unfold seen in Ei; congruence).
    simpl in *. rewrite map_length in *. lia.
  - rewrite Ei. apply in_map, in_seq. assert (P := deg_pos i d m Ei).
    assert (H := Nat.mod_upper_bound k d). lia.
Qed.

(** Turning a place and turning its normal form give the same normal form. *)
Lemma normal_next p : normal (next_place (normal p)) = normal (next_place p).
Proof.
  destruct p as (i, k). unfold normal, next_place; simpl. destruct (seen L i) as [(d, m)|] eqn:E;
    simpl; rewrite E; auto.
  f_equal. assert (P := deg_pos i d m E).
  change (S (k mod d)) with (1 + k mod d). rewrite Nat.add_mod_idemp_r by lia. auto.
Qed.

(** The next darts of identified places are identified. *)
Lemma next_same p q : same assumed L p q -> same assumed L (next_place p) (next_place q).
Proof. destruct p as (i, a), q as (j, b). apply (same_turn assumed L 1). Qed.

(** The numbering c is sound: places with equal class numbers are identified. *)
Definition sound_classes (c : place -> nat) := forall p q, In p all_places -> In q all_places ->
  c p = c q -> same assumed L p q.

(** The numbering c is incomplete: two identified places have different class numbers. *)
Definition incomplete (c : place -> nat) := exists p q, In p all_places /\ In q all_places /\
  same assumed L p q /\ c p <> c q.

(** The numbering c is closed under the rules of [same], so no rule asks for another merge. *)
Record saturated (c : place -> nat) : Prop := {
  f_turn : forall p q, In p all_places -> In q all_places -> c p = c q ->
           c (normal (next_place p)) = c (normal (next_place q));
  f_mark : forall i d j, seen L i = Some (d, Some j) -> c (normal (i, j)) = c (normal (0, 0));
  f_link : forall p q p' q', link assumed L p q -> link assumed L p' q' ->
    c (normal p) = c (normal p') ->
           c (normal q) = c (normal q') }.

(** Two identified places of the log whose normal forms have different class numbers make c
    incomplete. *)
Lemma incomplete_intro c p q : valid L p -> valid L q -> same assumed L p q ->
  c (normal p) <> c (normal q) -> incomplete c.
Proof.
  intros P Q S N. exists (normal p), (normal q). repeat split; auto using normal_listed.
  eapply same_trans; [apply same_sym, normal_same|]. eapply same_trans; [exact S|apply normal_same].
Qed.

(** A sound numbering is incomplete or saturated. *)
Lemma incomplete_or_saturated c : sound_classes c -> incomplete c \/ saturated c.
Proof.
  intros HS.
  destruct (in_dec_exists (fun x => c (fst x) = c (snd x) /\ c (normal (next_place (fst x))) <> c
    (normal (next_place (snd x))))
    (list_prod all_places all_places)) as [((p, q) & I & E & N)|N1].
  { intros (p, q); simpl. destruct (Nat.eq_dec (c p) (c q)), (Nat.eq_dec (c (normal (next_place p)))
      (c (normal (next_place q)))); tauto. }
  { apply in_prod_iff in I as [P Q]. left.
    apply (incomplete_intro c (next_place p) (next_place q)); auto.
    - apply (listed_valid p P).
    - apply (listed_valid q Q).
    - apply next_same, HS; auto. }
  destruct (in_dec_exists (fun i => match seen L i with
      | Some (d, Some j) => c (normal (i, j)) <> c (normal (0, 0)) | _ => False end)
    (seq 0 (S (length (moves L))))) as [(i & I & N)|N2].
  { intros i. destruct (seen L i) as [(d, [j|])|]; auto.
    destruct (Nat.eq_dec (c (normal (i, j))) (c (normal (0, 0)))); tauto. }
  { destruct (seen L i) as [(d, [j|])|] eqn:E; try contradiction. left.
    apply (incomplete_intro c (i, j) (0, 0)); auto; [unfold valid; simpl; congruence|discriminate|].
    apply (same_mark assumed L i d j E). }
  destruct (in_dec_exists (fun x => c (normal (fst (fst x))) = c (normal (fst (snd x))) /\
      c (normal (snd (fst x))) <> c (normal (snd (snd x)))) (list_prod all_links all_links))
    as [(((p, q), (p', q')) & I & E & N)|N3].
  { intros ((p, q), (p', q')); simpl.
    destruct (Nat.eq_dec (c (normal p)) (c (normal p'))), (Nat.eq_dec (c (normal q)) (c (normal
      q'))); tauto. }
  { apply in_prod_iff in I as [I I']. apply all_links_spec in I, I'. left. simpl in E, N.
    apply (incomplete_intro c q q'); eauto using link_valid, link_sym.
    apply (same_link assumed L p q p' q'); auto. eapply same_trans; [apply normal_same|].
    eapply same_trans; [|apply same_sym, normal_same]. apply HS; eauto using normal_listed, link_valid. }
  right. split.
  - intros p q P Q E. destruct (Nat.eq_dec (c (normal (next_place p))) (c (normal (next_place q))));
      auto.
    destruct (N1 (p, q)); [apply in_prod_iff; auto|auto].
  - intros i d j E. destruct (Nat.eq_dec (c (normal (i, j))) (c (normal (0, 0)))); auto.
    destruct (N2 i); [|rewrite E; auto]. apply in_seq.
    assert (i < length (start L :: map snd (moves L)))
      by (apply nth_error_Some; unfold seen in E; congruence).
    simpl in *. rewrite map_length in *. lia.
  - intros p q p' q' K K' E. destruct (Nat.eq_dec (c (normal q)) (c (normal q'))); auto.
    apply all_links_spec in K, K'. destruct (N3 ((p, q), (p', q'))); [apply in_prod_iff; auto|auto].
Qed.

(** If a sound numbering uses numbers below m only, merging ends with a sound and saturated one.
    Each merge frees one number. *)
Lemma saturate m : forall c, (forall p, In p all_places -> c p < m) -> sound_classes c ->
  exists c, sound_classes c /\ saturated c.
Proof.
  induction m as [|m IH]; intros c Hm HS.
  - assert (P : valid L (0, 0)) by discriminate. specialize (Hm _ (normal_listed _ P)). lia.
  - destruct (incomplete_or_saturated c HS) as [(p & q & P & Q & S & N)|F]; [|eauto].
    cut (forall p q, In p all_places -> In q all_places -> same assumed L p q -> c p < c q ->
      exists c, sound_classes c /\ saturated c).
    { intros G. destruct (lt_eq_lt_dec (c p) (c q)) as [[X|X]|X]; [eauto|tauto|].
      apply (G q p); auto. apply same_sym; auto. }
    clear p q P Q S N. intros p q P Q Spq N.
    apply (IH (fun x => if c x =? c q then c p else if c x =? m then c q else c x)).
    + intros x X. assert (A := Hm x X). assert (B := Hm q Q). cases.
    + intros x y X Y E. assert (A := Hm x X). assert (B := Hm y Y). assert (Cq := Hm q Q).
      assert (HP : forall x, In x all_places -> c x = c p -> same assumed L x p) by (intros;
        apply HS; auto).
      assert (HQ : forall x, In x all_places -> c x = c q -> same assumed L x p).
      { intros z Z Ez. apply same_trans with q; [apply HS; auto|apply same_sym; auto]. }
      destruct (Nat.eqb_spec (c x) (c q)) as [Ex|Ex], (Nat.eqb_spec (c y) (c q)) as [Ey|Ey].
      * apply same_trans with p; [|apply same_sym]; auto.
      * destruct (Nat.eqb_spec (c y) m); [lia|].
        apply same_trans with p; [|apply same_sym]; auto.
      * destruct (Nat.eqb_spec (c x) m); [lia|].
        apply same_trans with p; [|apply same_sym]; auto.
      * destruct (Nat.eqb_spec (c x) m), (Nat.eqb_spec (c y) m); try lia; apply HS; auto; lia.
Qed.

(** Equality of places is decidable. *)
Definition place_eq_dec (p q : place) : {p = q} + {p <> q}.
Proof. repeat decide equality. Defined.

(** The position of p in a list; the length of the list if p is not in it. *)
Fixpoint index (l : list place) p := match l with
  | [] => 0 | q :: l => if place_eq_dec p q then 0 else S (index l p) end.

(** The position of an element is less than the length, and the element is there. *)
Lemma index_spec l p : In p l -> index l p < length l /\ nth (index l p) l (0, 0) = p.
Proof.
  induction l as [|q l IH]; simpl; [intros []|]. intros H.
  destruct (place_eq_dec p q) as [->|N]; [split; auto; lia|].
  destruct H as [->|H]; [tauto|]. apply IH in H as [A B]. split; auto; lia.
Qed.

(** Identification of places is decidable. *)
Theorem same_dec p q : same assumed L p q \/ ~ same assumed L p q.
Proof.
  destruct (saturate (length all_places) (index all_places)) as (c & HS & F).
  - intros x X. apply index_spec; auto.
  - intros x y X Y E. apply index_spec in X as [_ <-], Y as [_ <-]. rewrite E. constructor.
  - assert (G : forall p q, same assumed L p q -> p = q \/
      valid L p /\ valid L q /\ c (normal p) = c (normal q)).
    { clear p q. induction 1 as [p|p q _ IH|p q r _ IH _ IH'|k i a j b _ IH|i d m E|i d j E
                                |p q p' q' K K' _ IH]; auto.
      - destruct IH as [->|(A & B & E)]; auto.
      - destruct IH as [->|(A & B & E)]; auto. destruct IH' as [<-|(A' & B' & E')]; auto.
        right. repeat split; auto. congruence.
      - destruct IH as [Eq|(A & B & E)]; [injection Eq as -> ->; auto|]. right. repeat split; auto.
        induction k as [|k IHk]; simpl; auto.
        change (i, S (k + a)) with (next_place (i, k + a)).
        change (j, S (k + b)) with (next_place (j, k + b)).
        rewrite <- (normal_next (i, k + a)), <- (normal_next (j, k + b)).
        apply (f_turn c F); auto using normal_listed.
      - right. assert (Vi : valid L (i, 0)) by (unfold valid; simpl; congruence). repeat split; auto.
        unfold normal; simpl. rewrite E. assert (P := deg_pos i d m E).
        rewrite Nat.mod_same, Nat.mod_0_l by lia. auto.
      - right. repeat split; [unfold valid; simpl; congruence|discriminate|apply (f_mark c F i d j E)].
      - right. repeat split; eauto using link_valid, link_sym. apply (f_link c F p q p' q'); auto.
        destruct IH as [->|(_ & _ & E)]; auto. }
    destruct (place_eq_dec p q) as [->|N]; [left; constructor|].
    assert (VD : forall p, valid L p \/ ~ valid L p).
    { intros x. unfold valid. destruct (seen L (fst x)); [left; discriminate|auto]. }
    destruct (VD p) as [P|P]; [|right; intros S; apply G in S; tauto].
    destruct (VD q) as [Q|Q]; [|right; intros S; apply G in S; tauto].
    destruct (Nat.eq_dec (c (normal p)) (c (normal q))) as [E|E]; [|right; intros S; apply G in S;
      tauto].
    left. eapply same_trans; [apply normal_same|]. eapply same_trans; [|apply same_sym, normal_same].
    apply HS; auto using normal_listed.
Qed.

(** From every list of places, one representative of each class can be chosen. *)
Lemma representatives l : exists R, (forall r, In r R -> In r l) /\
  (forall p, In p l -> exists x, x < length R /\ same assumed L p (nth x R (0, 0))) /\
  (forall x y, x < length R -> y < length R -> same assumed L (nth x R (0, 0)) (nth y R (0, 0)) ->
    x = y).
Proof.
  induction l as [|p l (R & A & B & C)].
  - exists []. repeat split; simpl; auto; [intros ? []|lia].
  - destruct (in_dec_exists (same assumed L p) R (same_dec p)) as [(r & I & S)|N].
    + exists R. split; [simpl; auto|]. split; auto. intros q [<-|Q]; auto.
      apply (In_nth _ _ (0, 0)) in I as (x & Hx & <-). eauto.
    + exists (p :: R). split; [simpl; intros r [->|Hr]; auto|]. split.
      * intros q [<-|Q]; [exists 0; simpl; split; [lia|constructor]|].
        destruct (B q Q) as (x & Hx & Sq). exists (S x). simpl. split; [lia|auto].
      * intros [|x] [|y] Hx Hy S; simpl in *; auto.
        -- destruct (N _ (nth_In R (0, 0) (n := y) ltac:(lia)) S).
        -- destruct (N _ (nth_In R (0, 0) (n := x) ltac:(lia)) (same_sym _ _ _ _ S)).
        -- f_equal. apply C; auto; lia.
Qed.

End Quotient.
