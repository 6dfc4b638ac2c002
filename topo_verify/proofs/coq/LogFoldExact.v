(** Folding a log, as the program of LogFold.v, is exact: what it says of an edge is what the worlds say
    that show the log (docs/semantics.md, sections 8 and 11; claim 10).

    L is a log that some world shows, A a list of assumed edges; p, q are places, f labels, R arcs, r
    an arc, W a world, v i the reference dart of visit i. No bound is set on the log. *)
From Coq Require Import Arith Lia List Bool.
Import ListNotations.
From Topo Require Import World Rotation Mapper Log Determined Entailed LogFold.

(** The links of the log are its arcs_of_moves. *)
Lemma arcs_links L p q : In (p, q) (arcs_of_moves 0 (moves L)) <-> link nothing L p q.
Proof.
  assert (G : forall ms i, In (p, q) (arcs_of_moves i ms) <-> exists n k,
    nth_error (map fst ms) n = Some k /\
    ((p = (i + n, k) /\ q = (S (i + n), 0)) \/ (p = (S (i + n), 0) /\ q = (i + n, k)))).
  { intros ms. induction ms as [|(k, o) ms IH]; intros i; cbn [arcs_of_moves In map fst].
    - split; [intros []|]. intros ([|n] & k & E & _); discriminate.
    - rewrite IH. split.
      + intros [E|[E|(n & j & E & H)]].
        * injection E as <- <-. exists 0, k. rewrite Nat.add_0_r. auto.
        * injection E as <- <-. exists 0, k. rewrite Nat.add_0_r. auto.
        * exists (S n), j. split; auto. replace (i + S n) with (S i + n) by lia. auto.
      + intros ([|n] & j & E & H); simpl in E.
        * injection E as ->. rewrite Nat.add_0_r in H. destruct H as [[-> ->]|[-> ->]]; auto.
        * right. right. exists n, j. split; auto. replace (S i + n) with (i + S n) by lia. auto. }
  rewrite G. split.
  - intros (n & k & E & [[-> ->]|[-> ->]]); [apply link_out|apply link_back]; auto.
  - intros [n k E|n k E|x y []|x y []]; exists n, k; auto.
Qed.

Section Folded.
Variables (L : Log) (A : assumed_edges).
Notation s := (percepts_of L).
Notation found := (found s).
Notation degree_at := (degree_at s).
Notation good_labels := (good_labels L).
Notation sign_at := (sign_at L).
Notation forced := (forced L A).
Hypothesis Shown : possible nothing L.
Notation plain := (plain L Shown).
Notation normal_normal := (normal_normal L).
Notation normal_valid := (normal_valid L).

(** Some links of the log and of the assumed edges. *)
Variable arcs : list (place * place).
Hypothesis Both_ways : forall p q, In (p, q) arcs -> In (q, p) arcs.

(** The invariant of folding: the labels take for one only what is one, the marker's place among them;
    each arc is one of the fold; those that are done leave from normal places, each from another; they
    stand for all of [arcs]; and where one of these would arrive at its own place, this is still to be
    found out. *)
Record folding_on f (done todo : list (place * place)) : Prop := {
  f_good : good_labels f;
  f_forced : forced f;
  f_marked : forall i d j, seen L i = Some (d, Some j) -> found f (i, j) = found f (0, 0);
  f_arcs : forall r, In r (done ++ todo) -> valid L (fst r) /\ valid L (snd r) /\
    exists p q, link A L p q /\ same A L (fst r) p /\ same A L (snd r) q;
  f_normal : forall r, In r done -> found f (fst r) = fst r;
  f_apart : forall r r', In r done -> In r' done -> fst r = fst r' -> r = r';
  f_all : forall p q, In (p, q) arcs -> exists r, In r (done ++ todo) /\
    found f p = found f (fst r) /\ found f q = found f (snd r);
  f_own : forall p q, In (p, q) arcs -> found f p = found f q -> exists r, In r todo /\
    found f (fst r) = found f (snd r) }.

(** A list is divided by a test. *)
Lemma divided {X} (t : X -> bool) l : length (filter (fun x => negb (t x)) l) + length (filter t l) =
  length l.
Proof. induction l as [|x l IH]; simpl; auto. destruct (t x); simpl; lia. Qed.

(** Folding keeps the invariant; it ends with all arcs done, or no world is possible. *)
Lemma absorb_spec n : forall f done todo, folding_on f done todo ->
  (let t := length done + length todo in t * S t + length todo <= n) ->
  match absorb s n f done todo with
  | Some (g, R) => folding_on g R [] | None => ~ consistent A L end.
Proof.
  induction n as [|n IH]; intros f done [|(p, q) todo] I Le; cbn [absorb]; auto.
  { simpl in Le. lia. }
  assert (H := f_arcs _ _ _ I (p, q)). destruct H as (P & Q & p1 & q1 & K & Sp & Sq).
  { apply in_or_app. simpl. auto. }
  simpl in P, Q, Sp, Sq. assert (G := f_good _ _ _ I). assert (F := f_forced _ _ _ I). cbv zeta.
  destruct (place_eqb (found f p) (found f q)) eqn:Own.
  { apply place_eqb_eq in Own. intros C. apply (c_edge A L C p1 q1 K).
    apply same_trans with p; [apply same_sym; auto|]. apply same_trans with q; auto.
    apply same_trans with (found f p); auto. rewrite Own. apply same_sym; auto. }
  assert (No : found f p <> found f q) by (intros X; apply place_eqb_eq in X; congruence). clear Own.
  (* What is to be found out of an own end is not found out by this arc. *)
  assert (Still : forall a b, In (a, b) arcs -> found f a = found f b ->
    exists r, In r todo /\ found f (fst r) = found f (snd r)).
  { intros a b Iab Eab. destruct (f_own _ _ _ I a b Iab Eab) as (r & [<-|Ir] & Er); eauto. tauto. }
  destruct (find _ done) as [(k, q')|] eqn:Fd.
  - apply find_some in Fd as [Ik Ek]. simpl in Ek. apply place_eqb_eq in Ek. subst k.
    destruct (f_arcs _ _ _ I (found f p, q')) as (P' & Q' & p2 & q2 & K' & Sp' & Sq').
    { apply in_or_app. auto. }
    simpl in P', Q', Sp', Sq'.
    assert (Same : same A L q q').
    { apply same_trans with q1; auto. apply same_trans with q2; [|apply same_sym; auto].
      apply (same_link A L p1 q1 p2 q2); auto. apply same_trans with p; [apply same_sym; auto|].
      apply same_trans with (found f p); auto. }
    assert (U := united_spec L A Shown f q q' G Q Q').
    destruct (place_eqb (found f q) (found f q')) eqn:Eq.
    { apply place_eqb_eq in Eq. apply IH; [|simpl in *; lia]. split; try apply I; auto.
      - intros r Ir. apply (f_arcs _ _ _ I). apply in_app_iff in Ir. apply in_app_iff. simpl. tauto.
      - intros a b Iab. destruct (f_all _ _ _ I a b Iab) as (r & Ir & Ea & Eb).
        apply in_app_iff in Ir as [Ir|[<-|Ir]]; [exists r| |exists r]; rewrite ?in_app_iff; auto.
        exists (found f p, q'). rewrite in_app_iff. simpl in *. rewrite normal_normal by auto.
        split; auto. split; congruence. }
    assert (Ne : found f q <> found f q') by (intros X; apply place_eqb_eq in X; congruence).
    specialize (U Ne). destruct (united s f _ _) as [g|]; [|apply U; auto].
    set (y := Nat.max _ _). set (again := fun r : place * place => fst (fst r) =? y).
    assert (D := divided again done).
    apply IH; [|cbv zeta in *; rewrite app_length; cbn [length] in Le;
      rewrite (Nat.add_assoc (length (filter (fun r => negb (again r)) done))), D; lia].
    assert (In_of : forall r, In r (filter (fun r => negb (again r)) done ++ filter again done ++ todo)
      <-> In r (done ++ todo)).
    { intros r. rewrite !in_app_iff, !filter_In. destruct (again r); simpl; intuition auto. }
    assert (Keeps := j_keeps _ _ _ _ _ _ U).
    assert (Moved : forall a b, In (a, b) arcs -> fst (found f a) = y -> found g a = found g b ->
      exists r, In r (filter again done ++ todo) /\ found g (fst r) = found g (snd r)).
    { intros a b Iab Ya E. destruct (f_all _ _ _ I a b Iab) as (r & Ir & Ea & Eb).
      assert (E' : found g (fst r) = found g (snd r))
        by (rewrite <- (Keeps _ _ Ea), <- (Keeps _ _ Eb); auto).
      apply in_app_iff in Ir as [Ir|[<-|Ir]].
      - exists r. split; auto. apply in_app_iff. left. apply filter_In. split; auto.
        unfold again. rewrite <- (f_normal _ _ _ I r Ir), <- Ea, Ya. apply Nat.eqb_refl.
      - exists (found f p, q'). simpl in *. split.
        + apply in_app_iff. left. apply filter_In. split; auto. unfold again. simpl.
          rewrite <- Ea, Ya. apply Nat.eqb_refl.
        + rewrite <- (j_one _ _ _ _ _ _ U), <- E'. apply Keeps, normal_normal; auto.
      - exists r. split; auto. apply in_app_iff. auto. }
    split.
    + apply U.
    + apply (j_forced _ _ _ _ _ _ U); auto.
    + intros i d j E. apply Keeps, (f_marked _ _ _ I i d j E).
    + intros r Ir. apply (f_arcs _ _ _ I). apply In_of in Ir. apply in_app_iff in Ir.
      apply in_app_iff. simpl. tauto.
    + intros r Ir. apply filter_In in Ir as [Ir N]. apply negb_true_iff, Nat.eqb_neq in N.
      assert (E := f_normal _ _ _ I r Ir). rewrite (j_other _ _ _ _ _ _ U); [auto|]. rewrite E. auto.
    + intros r r' Ir Ir'. apply filter_In in Ir as [Ir _]. apply filter_In in Ir' as [Ir' _].
      apply (f_apart _ _ _ I); auto.
    + intros a b Iab. destruct (f_all _ _ _ I a b Iab) as (r & Ir & Ea & Eb).
      apply in_app_iff in Ir as [Ir|[<-|Ir]].
      * exists r. split; [apply In_of, in_app_iff; auto|auto].
      * exists (found f p, q'). split; [apply In_of, in_app_iff; auto|]. simpl in *. split.
        -- apply Keeps. rewrite normal_normal; auto.
        -- rewrite <- (j_one _ _ _ _ _ _ U). auto.
      * exists r. split; [apply In_of, in_app_iff; auto|auto].
    + intros a b Iab E. destruct (Nat.eq_dec (fst (found f a)) y) as [Ya|Na]; [eauto|].
      destruct (Nat.eq_dec (fst (found f b)) y) as [Yb|Nb]; [apply (Moved b a); auto|].
      rewrite !(j_other _ _ _ _ _ _ U) in E by auto.
      destruct (Still a b Iab E) as (r & Ir & Er). exists r. rewrite in_app_iff. auto.
  - apply IH; [|simpl in *; lia].
    split; try apply I; auto.
    + intros r Ir. simpl in Ir. destruct Ir as [<-|Ir].
      * simpl. split; [apply normal_valid; auto|]. split; [apply normal_valid; auto|].
        exists p1, q1. split; auto. split; [apply same_trans with p|apply same_trans with q]; auto;
          apply same_sym; auto.
      * apply (f_arcs _ _ _ I). apply in_app_iff in Ir. apply in_app_iff. simpl. tauto.
    + intros r [<-|Ir]; [apply normal_normal; auto|apply (f_normal _ _ _ I); auto].
    + assert (New : forall r, In r done -> fst r <> found f p).
      { intros r Ir E. apply (find_none _ _ Fd) in Ir. apply place_eqb_eq in E. congruence. }
      intros r r' [<-|Ir] [<-|Ir'] E; simpl in E; auto.
      * destruct (New r' Ir'). auto.
      * destruct (New r Ir). auto.
      * apply (f_apart _ _ _ I); auto.
    + intros a b Iab. destruct (f_all _ _ _ I a b Iab) as (r & Ir & Ea & Eb).
      apply in_app_iff in Ir as [Ir|[<-|Ir]].
      * exists r. split; [simpl; rewrite in_app_iff; auto|auto].
      * exists (found f p, found f q). simpl in *. split; auto. rewrite !normal_normal; auto.
      * exists r. split; [simpl; rewrite in_app_iff; auto|auto].
Qed.

(** With steps enough. *)
Lemma absorbed_spec f done todo : folding_on f done todo -> match absorbed s f done todo with
  | Some (g, R) => folding_on g R [] | None => ~ consistent A L end.
Proof. intros I. apply absorb_spec; auto. cbv zeta. nia. Qed.

(** If all links are done, places that are one in the fold have one normal form. *)
Lemma folded_same f R : folding_on f R [] -> (forall p q, link A L p q -> In (p, q) arcs) ->
  forall p q, same A L p q -> found f p = found f q.
Proof.
  intros I All. assert (G := f_good _ _ _ I).
  induction 1 as [p|p q _ IH|p q r _ IH _ IH'|k i a j b _ IH|i d m E|i d j E
                 |p q p' q' B C _ IH]; try congruence.
  - rewrite !normal_turn, IH. auto.
  - assert (D := sign_degree L _ _ (normal_sign L f (i, 0) G)). cbn [fst] in D.
    rewrite (degree_seen L _ _ _ E) in D.
    unfold found in *. simpl in *. destruct (label_of f i) as (z, o). simpl in *. f_equal. rewrite D.
    rewrite Nat.add_0_r. assert (P := proj1 (c_percept _ _ plain _ _ _ E)).
    replace (o + d) with (o + 1 * d) by lia. apply Nat.mod_add. lia.
  - apply (f_marked _ _ _ I i d j E).
  - destruct (f_all _ _ _ I p q (All _ _ B)) as (r & Ir & E1 & E2).
    destruct (f_all _ _ _ I p' q' (All _ _ C)) as (r' & Ir' & E1' & E2'). rewrite app_nil_r in *.
    replace r' with r in *; [congruence|]. apply (f_apart _ _ _ I); auto.
    rewrite <- (f_normal _ _ _ I r Ir), <- (f_normal _ _ _ I r' Ir'). congruence.
Qed.

(** If all links are done, the fold is consistent. *)
Lemma folded_consistent f R : folding_on f R [] -> (forall p q, link A L p q -> In (p, q) arcs) ->
  (forall p q, In (p, q) A -> valid L p /\ valid L q) ->
  consistent A L.
Proof.
  intros I All Val. assert (G := f_good _ _ _ I). assert (Same := folded_same f R I All).
  assert (Sign : forall i a j b, same A L (i, a) (j, b) -> sign_at i = sign_at j).
  { intros i a j b S. assert (Ni := normal_sign L f (i, a) G). assert (Nj := normal_sign L f (j, b) G).
    rewrite (Same _ _ S) in Ni. cbn [fst] in *. congruence. }
  split; auto; try apply plain.
  - intros i a j b d m e n S E F. apply Sign in S. unfold sign_at in S. rewrite E, F in S. congruence.
  - intros i a j b d m e n S E F. apply Sign in S. unfold sign_at in S. rewrite E, F in S.
    destruct n; [discriminate|congruence].
  - intros i a b d m S E La Lb. apply Same in S.
    assert (D := sign_degree L _ _ (normal_sign L f (i, 0) G)). cbn [fst] in D.
    rewrite (degree_seen L _ _ _ E) in D.
    unfold found in *. simpl in *. destruct (label_of f i) as (z, o). simpl in *. rewrite D in S.
    injection S as S.
    assert (Q : forall x, x < d -> x = (x + o mod d + (d - o mod d)) mod d).
    { intros x Lx. assert (o mod d < d) by (apply Nat.mod_upper_bound; lia).
      replace (x + o mod d + (d - o mod d)) with (x + 1 * d) by lia.
      rewrite Nat.mod_add by lia. symmetry. apply Nat.mod_small. auto. }
    rewrite (Q a La), (Q b Lb). rewrite (Nat.add_comm (a + _)), (Nat.add_comm (b + _)).
    rewrite <- (mod_early (d - o mod d) (a + _)), <- (mod_early (d - o mod d) (b + _)).
    do 2 f_equal. rewrite !mod_early, (Nat.add_comm a), (Nat.add_comm b). auto.
  - intros p q K S. apply Same in S. destruct (f_own _ _ _ I p q (All _ _ K) S) as (r & [] & _).
Qed.

End Folded.

(** The first labels: visits that saw the marker are found at the start. *)
Lemma first_label l : forall i n, nth n (first_labels i l) (i + n, 0) = match nth_error l n with
  | Some (d, Some j) => (0, (d - j) mod d) | _ => (i + n, 0) end.
Proof.
  induction l as [|(d, [j|]) l IH]; intros i [|n]; cbn [first_labels nth nth_error]; auto;
    try rewrite Nat.add_0_r; auto; rewrite <- Nat.add_succ_comm; apply IH.
Qed.

(** There are as many labels as visits. *)
Lemma first_labels_length l : forall i, length (first_labels i l) = length l.
Proof. induction l as [|(d, [j|]) l IH]; intros i; simpl; auto. Qed.

(** Crossings go both ways. *)
Lemma arcs_back L p q : In (p, q) (arcs_of_moves 0 (moves L)) -> In (q, p) (arcs_of_moves 0 (moves L)).
Proof. rewrite !arcs_links. apply link_sym. Qed.

Section Start.
Variables (L : Log) (A : assumed_edges).
Hypothesis Shown : possible nothing L.
Notation plain := (plain L Shown).
Notation s := (percepts_of L).

(** The invariant holds before the first arc. *)
Lemma start_folding : let arcs := arcs_of_moves 0 (moves L) in
  folding_on L A arcs (first_labels 0 s) [] arcs.
Proof.
  assert (Lab : forall i, label_of (first_labels 0 s) i = match seen L i with
    | Some (d, Some j) => (0, (d - j) mod d) | _ => (i, 0) end)
    by (intros i; apply (first_label s 0 i)).
  assert (Pos := fun i d m E => proj1 (c_percept _ _ plain i d m E)).
  destruct (c_start _ _ plain) as (d0 & S0).
  assert (Deg : forall i d j, seen L i = Some (d, Some j) -> d = d0 /\ j < d).
  { intros i d j E. split; [|apply (c_percept _ _ plain _ _ _ E); auto].
    apply (c_degree _ _ plain i j 0 0 d (Some j) d0 (Some 0)); auto.
    apply (same_mark _ _ _ _ _ E). }
  assert (D0 := degree_seen L _ _ _ S0). assert (P0 := Pos _ _ _ S0).
  assert (Mod0 : d0 mod d0 = 0) by (apply Nat.mod_same; lia).
  assert (L0 : label_of (first_labels 0 s) 0 = (0, 0)) by (rewrite Lab, S0, Nat.sub_0_r, Mod0; auto).
  assert (Crossed : forall p q, In (p, q) (arcs_of_moves 0 (moves L)) -> link A L p q).
  { intros p q I. apply arcs_links in I. destruct I as [i k E|i k E|x y []|x y []];
      [apply link_out|apply link_back]; auto. }
  split.
  - split; [apply first_labels_length| |].
    + intros i. rewrite Lab. unfold sign_at.
      destruct (seen L i) as [(d, [j|])|] eqn:E; cbn [fst]; rewrite ?E; auto.
      rewrite S0. destruct (Deg _ _ _ E) as [-> _]. auto.
    + intros i. rewrite (Lab i). destruct (seen L i) as [(d, [j|])|] eqn:E; cbn [fst]; auto;
        rewrite Lab, E; auto.
  - intros (i, k) V. unfold valid in V. simpl in V. unfold found. simpl fst. rewrite Lab.
    destruct (seen L i) as [(d, [j|])|] eqn:E; [| |tauto]; simpl snd.
    + destruct (Deg _ _ _ E) as [-> Lj]. rewrite D0, Nat.add_comm, mod_early.
      apply same_trans with (0, k + (d0 - j)); [|apply (same_mod _ _ _ _ _ _ S0)].
      apply same_trans with (i, k + (d0 - j) + j).
      * replace (k + (d0 - j) + j) with (k + d0) by lia. rewrite <- (Nat.add_0_r k) at 1.
        apply same_turn, same_sym, (same_full _ _ _ _ _ E).
      * rewrite <- (Nat.add_0_r (k + (d0 - j))) at 2. apply same_turn, (same_mark _ _ _ _ _ E).
    + rewrite (degree_seen L _ _ _ E). apply (same_mod _ _ _ _ _ _ E).
  - intros i d j E. unfold found. simpl fst. rewrite L0, Lab, E. simpl snd.
    destruct (Deg _ _ _ E) as [-> Lj]. rewrite D0, Nat.add_comm, mod_early.
    replace (j + (d0 - j)) with d0 by lia. rewrite Mod0, Nat.mod_0_l by lia. auto.
  - intros (p, q) I. simpl in I. apply Crossed in I. simpl.
    split; [eapply link_valid, I|]. split; [eapply link_valid, link_sym, I|].
    exists p, q. split; auto. split; apply same_refl.
  - intros r [].
  - intros r r' [].
  - intros p q I. exists (p, q). auto.
  - intros p q I E. exists (p, q). auto.
Qed.

(** The fold of the log keeps the invariant, whatever is assumed beside. *)
Lemma fold_spec : match fold_of L with
  | Some (f, R) => folding_on L A (arcs_of_moves 0 (moves L)) f R [] | None => ~ consistent A L end.
Proof. apply (absorbed_spec L A Shown _ (arcs_back L)), start_folding. Qed.
End Start.

(** The fold of a log that some world shows has no contradiction. *)
Lemma fold_exists L : possible nothing L -> exists f R, fold_of L = Some (f, R) /\
  forall A, folding_on L A (arcs_of_moves 0 (moves L)) f R [].
Proof.
  intros S. assert (N := fold_spec L nothing S). assert (H := fun A => fold_spec L A S).
  destruct (fold_of L) as [(f, R)|]; [exists f, R; auto|]. destruct N. apply (plain L S).
Qed.

(** Claim 10, reject: for a log that some world shows, the program allows an edge exactly if the edge is
    in some world that shows the log.
    Not in the paper. *)
Theorem allows_exact L p q : possible nothing L -> valid L p -> valid L q ->
  allows L (fold_of L) p q = true <->
  exists W v, world W /\ visits W L v /\ alpha W (dart W v p) = Some (dart W v q).
Proof.
  intros S P Q. set (A := [(p, q)]).
  assert (Val : forall a b, In (a, b) A -> valid L a /\ valid L b).
  { intros a b [I|[]]. injection I as <- <-. auto. }
  transitivity (possible A L).
  2: { split; intros (W & v & HW & V & E); exists W, v; split; auto; split; auto.
       - apply E. left. auto.
       - intros a b [I|[]]. injection I as <- <-. auto. }
  destruct (fold_exists L S) as (f & R & -> & I). specialize (I A). unfold allows.
  set (arcs := arcs_of_moves 0 (moves L) ++ [(p, q); (q, p)]).
  assert (Both : In (p, q) A) by (left; auto).
  assert (J : folding_on L A arcs f R [(p, q); (q, p)]).
  { split; try apply I.
    - intros r Ir. apply in_app_or in Ir as [Ir|Ir].
      + apply (f_arcs _ _ _ _ _ _ I). apply in_or_app. auto.
      + destruct Ir as [<-|[<-|[]]]; simpl; split; auto; split; auto; do 2 eexists;
          (split; [|split; apply same_refl]); auto using link_assumed, link_assumed_back.
    - intros a b Iab. apply in_app_or in Iab as [Iab|Iab].
      + destruct (f_all _ _ _ _ _ _ I a b Iab) as (r & Ir & E). exists r. split; auto.
        rewrite app_nil_r in Ir. apply in_or_app. auto.
      + exists (a, b). split; auto. apply in_or_app. auto.
    - intros a b Iab Eab. apply in_app_or in Iab as [Iab|Iab]; [|exists (a, b); auto].
      destruct (f_own _ _ _ _ _ _ I a b Iab Eab) as (r & [] & _). }
  assert (Back : forall a b, In (a, b) arcs -> In (b, a) arcs).
  { intros a b Iab. apply in_app_or in Iab. apply in_or_app.
    destruct Iab as [Iab|[Eab|[Eab|[]]]]; [left; apply arcs_back; auto| |];
      injection Eab as <- <-; simpl; auto. }
  assert (Links : forall a b, link A L a b -> In (a, b) arcs).
  { intros a b K. apply in_or_app. destruct K as [i k E|i k E|a b [E|[]] _ _|a b [E|[]] _ _].
    - left. apply arcs_links, link_out. auto.
    - left. apply arcs_links, link_back. auto.
    - injection E as <- <-. simpl. auto.
    - injection E as <- <-. simpl. auto. }
  assert (H := absorbed_spec L A S arcs Back f R _ J).
  assert (Iff : consistent A L <-> possible A L)
    by (split; [apply consistent_possible|apply possible_consistent; auto]).
  destruct (absorbed _ f R _) as [(g, Z)|].
  - assert (C := folded_consistent L A S arcs g Z H Links Val). tauto.
  - split; [discriminate|]. tauto.
Qed.

(** Claim 10, confirm: for a log that some world shows, the program joins two places by an edge exactly
    if the edge is in all worlds that show the log.
    Not in the paper. *)
Theorem partners_exact L p q : possible nothing L -> valid L p -> valid L q ->
  partners L (fold_of L) p q = true <->
  forall W v, world W -> visits W L v -> alpha W (dart W v p) = Some (dart W v q).
Proof.
  intros S P Q. rewrite confirmation_entailed_iff by (auto; apply (plain L S)).
  destruct (fold_exists L S) as (f & R & -> & I). specialize (I nothing). unfold partners.
  assert (G := f_good _ _ _ _ _ _ I). assert (F := f_forced _ _ _ _ _ _ I).
  assert (All : forall a b, link nothing L a b -> In (a, b) (arcs_of_moves 0 (moves L)))
    by (intros a b; apply arcs_links).
  assert (Same := folded_same L nothing S _ f R I All).
  rewrite existsb_exists. split.
  - intros (r & Ir & E). apply andb_true_iff in E as [E1 E2]. apply place_eqb_eq in E1, E2.
    destruct (f_arcs _ _ _ _ _ _ I r) as (Vr & Wr & a & b & K & Sa & Sb); [apply in_or_app; auto|].
    exists a, b. split; auto. split.
    + apply same_trans with (fst r); auto. rewrite E1. apply F. auto.
    + apply same_trans with (snd r); auto. apply same_trans with (found (percepts_of L) f (snd r)).
      * rewrite E2. apply F. auto.
      * apply same_sym, F. auto.
  - intros (a & b & K & Sa & Sb). destruct (f_all _ _ _ _ _ _ I a b (All _ _ K)) as (r & Ir & E1 & E2).
    rewrite app_nil_r in Ir. exists r. split; auto. apply andb_true_iff. rewrite !place_eqb_eq.
    rewrite (Same _ _ Sa), (Same _ _ Sb), E1, E2. split; auto.
    symmetry. apply (f_normal _ _ _ _ _ _ I). auto.
Qed.
