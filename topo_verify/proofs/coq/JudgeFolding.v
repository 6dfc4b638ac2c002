(** The judge is right about contradictions: its fold with one more edge, which goes on behind a
    contradiction, meets those that follow (claim 8; docs/semantics.md, sections 9 and 13).

    L is a log that some world shows, f labels, R arcs; p, q, x, y are places, r a tie, l a list of ties,
    lab a label of each place; the other letters are those of Claims.v and Judge.v. *)
From Coq Require Import Arith Lia List NArith Bool.
Import ListNotations.
From Topo Require Import World Rotation Log Determined Classes Entailed LogFold LogFoldExact Claims
  Judge JudgeCitations.

(** [kind_eqb] decides equality. *)
Lemma kind_eqb_eq k l : kind_eqb k l = true <-> k = l.
Proof.
  destruct k as [(d, m)|], l as [(e, n)|]; simpl; split; try discriminate; auto.
  - rewrite andb_true_iff, Nat.eqb_eq, eqb_true_iff. intros [-> ->]. auto.
  - intros E. injection E as -> ->. rewrite Nat.eqb_refl, eqb_reflx. auto.
Qed.

(** Two ties are alongside if place and kind are equal. *)
Lemma alongside_spec r r' : alongside r r' = true <-> fst (fst r) = fst (fst r') /\
  snd (fst r) = snd (fst r').
Proof. unfold alongside. rewrite andb_true_iff, place_eqb_eq, kind_eqb_eq. tauto. Qed.

(** Two places that are pulled together. *)
Lemma pulled_some l x y : pulled_together l = Some (x, y) -> x <> y /\ exists r r', In r l /\ In r' l /\
  alongside r r' = true /\ snd r = x /\ snd r' = y.
Proof.
  induction l as [|r l IH]; simpl; [discriminate|]. destruct (find _ l) as [r'|] eqn:F.
  - intros E. injection E as <- <-. apply find_some in F as [I F]. apply andb_true_iff in F as [A N].
    apply negb_true_iff in N. split; [|exists r, r'; auto]. intros E.
    apply place_eqb_eq in E. congruence.
  - intros E. destruct (IH E) as (N & s & s' & I & I' & H). split; auto. exists s, s'. auto.
Qed.

(** If none are, ties alongside lead to one place. *)
Lemma pulled_none l : pulled_together l = None -> forall r r', In r l -> In r' l ->
  alongside r r' = true -> snd r = snd r'.
Proof.
  induction l as [|s l IH]; simpl; [tauto|]. destruct (find _ l) as [s'|] eqn:F; [discriminate|].
  intros N. assert (G : forall r, In r l -> alongside s r = true -> snd s = snd r).
  { intros r I A. assert (X := find_none _ _ F r I). simpl in X. rewrite A in X.
    apply negb_false_iff, place_eqb_eq in X. auto. }
  assert (Sym : forall r r', alongside r r' = true -> alongside r' r = true).
  { intros r r'. rewrite !alongside_spec. intuition congruence. }
  intros r r' [<-|I] [<-|I'] A; auto. symmetry. auto.
Qed.

(** The places that are one by the ties: the least equivalence that they force. *)
Inductive tied_as_one (l : list tie) : place -> place -> Prop :=
| tied_refl x : tied_as_one l x x
| tied_sym x y : tied_as_one l x y -> tied_as_one l y x
| tied_trans x y z : tied_as_one l x y -> tied_as_one l y z -> tied_as_one l x z
| tied_both r r' : In r l -> In r' l -> tied_as_one l (fst (fst r)) (fst (fst r')) ->
    snd (fst r) = snd (fst r') -> tied_as_one l (snd r) (snd r').

(** [tied_up] finds these, if the steps are as many as labels. *)
Lemma tied_up_from l n : forall lab ends, (forall x y, lab x = lab y -> tied_as_one l x y) ->
  (forall r, In r l -> In (lab (snd r)) ends) -> length ends <= n ->
  let final := tied_up n lab l in forall x y, final x = final y <-> tied_as_one l x y.
Proof.
  assert (Closed : forall lab : place -> place, (forall x y, lab x = lab y -> tied_as_one l x y) ->
    (forall r r', In r l -> In r' l -> lab (fst (fst r)) = lab (fst (fst r')) ->
      snd (fst r) = snd (fst r') -> lab (snd r) = lab (snd r')) ->
    forall x y, lab x = lab y <-> tied_as_one l x y).
  { intros lab Sound C x y. split; auto. induction 1; auto; congruence. }
  induction n as [|n IH]; intros lab ends Sound Ends Le; cbn [tied_up]; cbv zeta.
  - apply Closed; auto. intros r r' I. apply Ends in I. destruct ends; [destruct I|simpl in Le; lia].
  - destruct (pulled_together _) as [(a, b)|] eqn:P.
    + apply pulled_some in P as (N & s & s' & I & I' & A & <- & <-).
      apply in_map_iff in I as (r & <- & I), I' as (r' & <- & I'). simpl in *.
      apply alongside_spec in A as [K T]. simpl in K, T.
      assert (One : tied_as_one l (snd r) (snd r')) by (apply tied_both; auto).
      set (a := lab (snd r)) in *. set (b := lab (snd r')) in *.
      apply IH with (ends := remove place_eq_dec a ends).
      * intros x y E. destruct (place_eqb (lab x) a) eqn:Ex, (place_eqb (lab y) a) eqn:Ey; auto.
        -- apply place_eqb_eq in Ex, Ey. apply Sound. congruence.
        -- apply place_eqb_eq in Ex. apply tied_trans with (snd r); auto.
           apply tied_trans with (snd r'); auto.
        -- apply place_eqb_eq in Ey. apply tied_trans with (snd r'); auto.
           apply tied_trans with (snd r); [apply tied_sym; auto|]. apply Sound. auto.
      * intros s Is. destruct (place_eqb (lab (snd s)) a) eqn:Es.
        -- apply in_in_remove; auto. apply Ends; auto.
        -- apply in_in_remove; [|apply Ends; auto]. intros E. apply place_eqb_eq in E. congruence.
      * assert (length (remove place_eq_dec a ends) < length ends); [|lia].
        apply remove_length_lt. apply Ends. auto.
    + apply Closed; auto. intros r r' I I' K T.
      set (g := fun r : tie => (lab (fst (fst r)), snd (fst r), lab (snd r))) in *.
      apply (pulled_none _ P (g r) (g r')); try (apply in_map; auto).
      apply alongside_spec. simpl. auto.
Qed.

(** Steps as many as ties are enough. *)
Lemma tied_up_spec l x y :
  tied_up (length l) (fun x => x) l x = tied_up (length l) (fun x => x) l y <-> tied_as_one l x y.
Proof.
  apply (tied_up_from l (length l) _ (map snd l)); [|intros r I; apply in_map; auto|
    rewrite map_length; auto]. intros a b <-. apply tied_refl.
Qed.

(** Places that are one are places of the log, or neither is. *)
Lemma same_both_valid A L x y : same A L x y -> (valid L x <-> valid L y).
Proof.
  induction 1 as [x|x y _ IH|x y z _ IH _ IH'|k i a j b _ IH|i d m E|i d j E|x y x' y' B C _ _];
    unfold valid in *; simpl in *; try tauto.
  - rewrite E. unfold seen. simpl. split; congruence.
  - apply link_sym, link_valid in B. apply link_sym, link_valid in C. unfold valid in *. simpl in *.
    tauto.
Qed.

(** Places of the log look alike exactly if their signs are equal. *)
Lemma looks_like_sign L x y : valid L x -> valid L y ->
  (looks_like L x y <-> sign_at L (fst x) = sign_at L (fst y)).
Proof.
  unfold valid, looks_like, sign_at. destruct (seen L (fst x)) as [(d, m)|]; [|tauto].
  destruct (seen L (fst y)) as [(e, n)|]; [|tauto]. intros _ _.
  destruct m, n; split; intuition (congruence || discriminate).
Qed.

Section Contradictions.
Variables (L : Log) (p q : place) (f : list place) (R : list (place * place)).
Hypotheses (Shown : possible nothing L) (P : valid L p) (Q : valid L q).
Hypothesis I : folding_on L nothing (arcs_of_moves 0 (moves L)) f R [].
Notation A := [(p, q)].
Notation n := (found (percepts_of L) f).
Notation by_edge := (edge_ties L f R p q).
Notation l := (by_edge ++ turn_ties L f).
Notation good := (f_good _ _ _ _ _ _ I).

(** Places that are one in the fold of the log have one label. *)
Lemma labels_of_same x y : same nothing L x y -> n x = n y.
Proof.
  apply (folded_same L nothing Shown _ f R I). intros a b. apply arcs_links.
Qed.

(** A label is one with its place. *)
Lemma label_is_place x : valid L x -> same nothing L x (n x).
Proof. apply (f_forced _ _ _ _ _ _ I). Qed.

(** It is a place of the log. *)
Lemma label_valid x : valid L x -> valid L (n x).
Proof. apply normal_valid, good. Qed.

(** Places of the log with one label are one dart. *)
Lemma label_one x : valid L x -> one_dart A L x (n x).
Proof. intros V. apply one_same; auto. apply label_is_place. auto. Qed.

(** Each tie by an edge is a link, up to places that are one. *)
Lemma edge_tie r : In r by_edge -> exists a b, link A L a b /\ valid L a /\ valid L b /\
  fst (fst r) = n a /\ snd (fst r) = sign_at L (fst b) /\ snd r = n b.
Proof.
  unfold edge_ties. intros Ir. apply in_map_iff in Ir as ((a, b) & <- & Ir). simpl.
  apply in_app_or in Ir as [Ir|Ir].
  - destruct (f_arcs _ _ _ _ _ _ I (a, b)) as (Va & Vb & a' & b' & K & Sa & Sb).
    { rewrite app_nil_r. auto. }
    simpl in *. exists a', b'. split.
    { destruct K as [i k E|i k E|x y []|x y []]; [apply link_out|apply link_back]; auto. }
    assert (Va' := proj1 (same_both_valid _ _ _ _ Sa) Va).
    assert (Vb' := proj1 (same_both_valid _ _ _ _ Sb) Vb).
    rewrite (labels_of_same _ _ Sa), (labels_of_same _ _ Sb). repeat split; auto.
    assert (S1 := normal_sign L f b good). assert (S2 := normal_sign L f b' good).
    rewrite (labels_of_same _ _ Sb) in S1. congruence.
  - destruct Ir as [E|[E|[]]]; injection E as <- <-; [exists p, q|exists q, p]; repeat split; auto.
    + apply link_assumed; simpl; auto.
    + apply link_assumed_back; simpl; auto.
Qed.

(** Each link is a tie. *)
Lemma tie_of_link a b : link A L a b -> In (n a, sign_at L (fst b), n b) by_edge.
Proof.
  intros K. unfold edge_ties. apply in_map_iff.
  assert (Old : link nothing L a b -> exists r, In r R /\ n (fst r) = n a /\ n (snd r) = n b).
  { intros K'. apply arcs_links in K'. destruct (f_all _ _ _ _ _ _ I a b K') as (r & Ir & Ea & Eb).
    rewrite app_nil_r in Ir. exists r. auto. }
  assert (G : link nothing L a b -> exists x, (n (fst x), sign_at L (fst (snd x)), n (snd x)) =
    (n a, sign_at L (fst b), n b) /\ In x (R ++ [(p, q); (q, p)])).
  { intros K'. destruct (Old K') as (r & Ir & Ea & Eb). exists r. split; [|apply in_or_app; auto].
    assert (Sr := normal_sign L f (snd r) good). assert (Sb := normal_sign L f b good).
    rewrite Eb in Sr. apply f_equal2; [apply f_equal2|]; [exact Ea| |exact Eb].
    exact (eq_trans (eq_sym Sr) Sb). }
  destruct K as [i k E|i k E|x y [E|[]] _ _|x y [E|[]] _ _].
  - apply G, link_out, E.
  - apply G, link_back, E.
  - injection E as <- <-. exists (p, q). split; auto. apply in_or_app. simpl. auto.
  - injection E as <- <-. exists (q, p). split; auto. apply in_or_app. simpl. auto.
Qed.

(** The places of the fold are the labels of the places of the log. *)
Lemma fold_places_spec x : In x (fold_places L f) <-> valid L x /\ n x = x.
Proof.
  unfold fold_places. rewrite in_flat_map. split.
  - intros (i & Ii & Ix). apply filter_In in Ii as [Ii E]. apply in_seq in Ii.
    apply Nat.eqb_eq in E. apply in_map_iff in Ix as (a & <- & Ia). apply in_seq in Ia.
    assert (Lab := l_first L f good i). rewrite E in Lab. split.
    + unfold valid, seen. simpl. apply nth_error_Some. unfold percepts_of in Ii. simpl in *. lia.
    + unfold found. simpl. rewrite Lab. simpl. f_equal. apply Nat.mod_small. lia.
  - intros [V E]. exists (fst x). split.
    + apply filter_In. split.
      * apply in_seq. unfold valid, seen in V. apply nth_error_Some in V. unfold percepts_of.
        simpl in *. lia.
      * apply Nat.eqb_eq. unfold found in E. destruct (label_of f (fst x)) as (j, o) eqn:F.
        simpl. rewrite <- E. auto.
    + assert (B := normal_below L Shown f x good V). rewrite E in B. destruct x as (i, a).
      simpl in *. apply in_map_iff. exists a. split; auto. apply in_seq. lia.
Qed.

(** Turning a label. *)
Lemma label_next i a : n (i, S a) = n (fst (n (i, a)), S (snd (n (i, a)))).
Proof.
  assert (T := normal_turn L f i 1 a).
  assert (T' := normal_turn L f (fst (n (i, a))) 1 (snd (n (i, a)))).
  simpl plus in T, T'. rewrite T, T'. rewrite <- surjective_pairing, normal_normal by apply good. auto.
Qed.

(** What is one is tied. *)
Lemma one_tied x y : one_dart A L x y -> valid L x /\ valid L y /\ tied_as_one l (n x) (n y).
Proof.
  induction 1 as [x y V S|x y _ IH|x y z _ IH _ IH'|i a j b _ IH|x y x' y' K K' _ IH Lk].
  - split; auto. split; [apply (same_both_valid _ _ _ _ S); auto|]. rewrite (labels_of_same _ _ S).
    apply tied_refl.
  - destruct IH as (V & V' & T). auto using tied_sym.
  - destruct IH as (V & V' & T), IH' as (_ & V'' & T'). split; auto. split; auto.
    apply tied_trans with (n y); auto.
  - destruct IH as (V & V' & T). split; auto. split; auto. rewrite (label_next i), (label_next j).
    assert (G : forall z, valid L z -> In (n z, None, n (fst (n z), S (snd (n z)))) l).
    { intros z Vz. apply in_or_app. right. apply in_map_iff. exists (n z). split; auto.
      apply fold_places_spec. split; [apply label_valid; auto|apply normal_normal, good]. }
    apply (tied_both l _ _ (G _ V) (G _ V')); auto.
  - apply link_sym in K as K1, K' as K1'. apply link_valid in K1, K1'. split; auto. split; auto.
    apply tie_of_link in K, K'.
    apply (tied_both l _ _ (in_or_app _ _ _ (or_introl K)) (in_or_app _ _ _ (or_introl K'))).
    + apply IH.
    + simpl. apply looks_like_sign; auto.
Qed.

(** Ties are of a kind: by an edge, or by turning. *)
Lemma tie_cases r : In r l -> In r by_edge \/ snd (fst r) = None /\ exists i a, fst (fst r) = (i, a) /\
  valid L (i, a) /\ snd r = n (i, S a).
Proof.
  intros Ir. apply in_app_or in Ir as [Ir|Ir]; auto. right. apply in_map_iff in Ir as ((i, a) & <- & Ix).
  simpl. split; auto. exists i, a. apply fold_places_spec in Ix. split; auto. split; [apply Ix|auto].
Qed.

(** What is tied is one. *)
Lemma tied_one x y : tied_as_one l x y -> x = y \/ one_dart A L x y.
Proof.
  induction 1 as [x|x y _ IH|x y z _ IH _ IH'|r r' Ir Ir' _ IH E]; auto.
  - destruct IH; auto using one_sym.
  - destruct IH as [->|IH], IH' as [<-|IH']; auto. right. apply one_trans with y; auto.
  - right. apply tie_cases in Ir, Ir'.
    assert (Key : forall x y, x = y \/ one_dart A L x y -> valid L x -> one_dart A L x y).
    { intros x y [->|O] V; auto. apply one_same; auto. apply same_refl. }
    destruct Ir as [Ir|[N (i & a & K & V & T)]], Ir' as [Ir'|[N' (i' & a' & K' & V' & T')]].
    + apply edge_tie in Ir as (a & b & Ln & Va & Vb & Ka & Ta & Sa), Ir' as (a' & b' & Ln' & Va' & Vb' &
        Ka' & Ta' & Sa').
      rewrite Ka, Ka' in IH. apply Key in IH; [|apply label_valid; auto].
      rewrite Sa, Sa'. apply one_trans with b; [apply one_sym, label_one; auto|].
      apply one_trans with b'; [|apply label_one; auto]. apply (one_end A L a b a' b'); auto.
      * apply one_trans with (n a); [apply label_one; auto|].
        apply one_trans with (n a'); [auto|apply one_sym, label_one; auto].
      * apply looks_like_sign; auto. congruence.
    + exfalso. apply edge_tie in Ir as (a & b & _ & _ & Vb & _ & Ta & _).
      apply (proj1 (valid_sign L b)) in Vb. congruence.
    + exfalso. apply edge_tie in Ir' as (a' & b & _ & _ & Vb & _ & Ta & _).
      apply (proj1 (valid_sign L b)) in Vb. congruence.
    + rewrite K, K' in IH. apply Key in IH; auto. apply one_next in IH.
      rewrite T, T'. apply one_trans with (i, S a); [apply one_sym, label_one; auto|].
      apply one_trans with (i', S a'); [auto|apply label_one; auto].
Qed.

(** Labels are equal exactly where places of the log are one. *)
Lemma tied_iff x y : valid L x -> valid L y ->
  (tied_up (length l) (fun z => z) l (n x) = tied_up (length l) (fun z => z) l (n y) <->
  one_dart A L x y).
Proof.
  intros V V'. rewrite tied_up_spec. split; [|intros O; apply one_tied in O; apply O].
  intros T. apply tied_one in T. apply one_trans with (n x); [apply label_one; auto|].
  apply one_trans with (n y); [|apply one_sym, label_one; auto]. destruct T as [->|T]; auto.
  apply one_same; [apply label_valid; auto|apply same_refl].
Qed.

(** [contradicts] finds the contradictions that follow. *)
Lemma contradicts_found apart pairs c :
  (forall x y, In (x, y) pairs -> valid L x /\ valid L y /\ apart x y) ->
  (forall x y, apart x y -> valid L x -> valid L y ->
    exists x' y', In (x', y') pairs /\ same nothing L x x' /\ same nothing L y y') ->
  (contradicts L (Some (f, R)) p q pairs c = true <-> follows_from_edges A L apart c).
Proof.
  intros In_pairs Of_pairs. unfold contradicts. cbv zeta.
  set (lab := tied_up _ _ l). assert (One := fun x y => tied_iff x y). fold lab in One.
  destruct c.
  - rewrite existsb_exists. split.
    + intros (r & Ir & E). apply existsb_exists in E as (r' & Ir' & E).
      apply andb_true_iff in E as [E N]. apply place_eqb_eq in E.
      apply negb_true_iff, not_true_iff_false in N. rewrite kind_eqb_eq in N.
      apply edge_tie in Ir as (a & b & K & Va & Vb & Ka & Ta & _), Ir' as (a' & b' & K' & Va' & Vb' &
        Ka' & Ta' & _).
      rewrite Ka, Ka' in E. apply One in E; auto. apply (unlike_follows A L apart a b a' b'); auto.
      rewrite looks_like_sign by auto. congruence.
    + intros C. inversion C as [a b a' b' K K' O N| | |]. subst.
      assert (V := one_tied _ _ O). destruct V as (Va & Va' & _).
      assert (Vb := link_valid _ _ _ _ (link_sym _ _ _ _ K)).
      assert (Vb' := link_valid _ _ _ _ (link_sym _ _ _ _ K')).
      apply tie_of_link in K, K'. eexists. split; [exact K|]. apply existsb_exists. eexists.
      split; [exact K'|]. simpl. apply andb_true_iff. split; [apply place_eqb_eq, One; auto|].
      apply negb_true_iff, not_true_iff_false. rewrite kind_eqb_eq. intros E. apply N.
      apply looks_like_sign; auto.
  - rewrite existsb_exists. split.
    + intros ((i, a) & Ix & E). apply existsb_exists in E as ((j, b) & Iy & E). simpl in E.
      rewrite !andb_true_iff, Nat.eqb_eq, Nat.ltb_lt, place_eqb_eq in E. destruct E as [[<- Lt] E].
      apply fold_places_spec in Ix as [V E1], Iy as [V' E2].
      assert (B := normal_below L Shown f _ good V'). rewrite E2 in B. simpl in B.
      rewrite <- E1, <- E2 in E. apply One in E; auto.
      unfold valid in V. simpl in V. destruct (seen L i) as [(d, m)|] eqn:Sn; [|tauto].
      rewrite (degree_seen L _ _ _ Sn) in B. apply (turned_follows A L apart i a b d m); auto.
    + intros C. inversion C as [|i a b d m Sn Lt Lb O| |]. subst.
      assert (Va : valid L (i, a)) by (unfold valid; simpl; congruence).
      assert (Vb : valid L (i, b)) by (unfold valid; simpl; congruence).
      assert (Eq : fst (n (i, a)) = fst (n (i, b))).
      { unfold found. simpl. destruct (label_of f i). auto. }
      assert (Ne : snd (n (i, a)) <> snd (n (i, b))).
      { intros E. assert (En : n (i, a) = n (i, b))
          by (rewrite (surjective_pairing (n (i, a))), (surjective_pairing (n (i, b))); congruence).
        assert (S : same nothing L (i, a) (i, b)).
        { apply same_trans with (n (i, a)); [apply label_is_place; auto|]. rewrite En.
          apply same_sym, label_is_place. auto. }
        apply (c_turn _ _ (plain L Shown) i a b d m) in S; auto; lia. }
      assert (G : forall x y, valid L x -> valid L y -> fst (n x) = fst (n y) -> snd (n x) < snd (n y) ->
        one_dart A L x y -> exists x, In x (fold_places L f) /\ existsb (fun y => (fst x =? fst y) &&
          (snd x <? snd y) && place_eqb (lab x) (lab y)) (fold_places L f) = true).
      { intros x y Vx Vy E Lx Ox. exists (n x). split.
        - apply fold_places_spec. split; [apply label_valid; auto|apply normal_normal, good].
        - apply existsb_exists. exists (n y). split.
          + apply fold_places_spec. split; [apply label_valid; auto|apply normal_normal, good].
          + rewrite !andb_true_iff, Nat.eqb_eq, Nat.ltb_lt, place_eqb_eq. split; auto.
            apply One; auto. }
      destruct (Nat.lt_gt_cases (snd (n (i, a))) (snd (n (i, b)))) as [Cases _].
      destruct (Cases Ne); [apply (G (i, a) (i, b))|apply (G (i, b) (i, a))]; auto using one_sym.
  - rewrite existsb_exists. split.
    + intros (r & Ir & E). apply place_eqb_eq in E.
      apply edge_tie in Ir as (a & b & K & Va & Vb & Ka & _ & Sa). rewrite Ka, Sa in E.
      apply One in E; auto. apply (own_end_follows A L apart a b); auto.
    + intros C. inversion C as [| |a b K O|]. subst. destruct (one_tied _ _ O) as (Va & Vb & _).
      apply tie_of_link in K. eexists. split; [exact K|]. apply place_eqb_eq, One; auto.
  - rewrite existsb_exists. split.
    + intros ((x, y) & Ip & E). apply place_eqb_eq in E. simpl in E.
      destruct (In_pairs x y Ip) as (Vx & Vy & Ap). apply One in E; auto.
      apply (two_of_S_follow A L apart x y); auto.
    + intros C. inversion C as [| | |x y Ap O]. subst. destruct (one_tied _ _ O) as (Vx & Vy & _).
      destruct (Of_pairs x y Ap Vx Vy) as (x' & y' & Ip & Sx & Sy). exists (x', y'). split; auto. simpl.
      rewrite <- (labels_of_same _ _ Sx), <- (labels_of_same _ _ Sy). apply place_eqb_eq, One; auto.
  - split; [discriminate|]. intros C. inversion C.
Qed.
End Contradictions.
