(** Every connected map has a table that the checks of Table.v accept (claim 9).

    M is a connected map, ord a list of its darts, t a table, L a log.

    The darts are numbered by discovery: those of the root's vertex, then again and again those of
    a vertex behind an edge of a vertex that is numbered, from its entry on. The invariant is
    [discovery]. The table says for each dart of that list where the others are in it. *)
From Coq Require Import Arith Lia List Bool.
Import ListNotations.
From Topo Require Import World Rotation Embedding Augment Log Determined Undetermined Classes Table
  TableCorrect.

(** The place of x in a list. *)
Fixpoint index_of (x : nat) l := match l with
  | [] => 0
  | y :: l => if x =? y then 0 else S (index_of x l) end.

(** The place of an element is below the length, and the element is there. *)
Lemma index_of_in x l : In x l -> index_of x l < length l /\ nth (index_of x l) l 0 = x.
Proof.
  induction l as [|y l IH]; simpl; [intros []|]. intros I.
  destruct (Nat.eqb_spec x y) as [->|N]; [split; auto; lia|].
  destruct IH; [destruct I; congruence|]. split; [lia|auto].
Qed.

(** In a list without repetition every element is at its place only. *)
Lemma index_of_nth l : NoDup l -> forall i, i < length l -> index_of (nth i l 0) l = i.
Proof.
  intros ND i Li. destruct (index_of_in (nth i l 0) l (nth_In l 0 Li)) as [A B].
  apply (proj1 (NoDup_nth l 0) ND); auto.
Qed.

(** Two lists without repetition and without a common element, one after the other. *)
Lemma nodup_append {A} (l l' : list A) : NoDup l -> NoDup l' -> (forall x, In x l -> ~ In x l') ->
  NoDup (l ++ l').
Proof.
  intros Nl B. induction Nl as [|x l N Nl IH]; simpl; auto. intros D. constructor.
  - intros I. apply in_app_or in I as [I|I]; [auto|]. apply (D x); auto.
  - apply IH. intros y I. apply D. auto.
Qed.

Section Numbered.
Variable M : Map.
Hypotheses (WM : is_map M) (CM : connected M).

(** The darts of the vertex of e, from e on. *)
Definition orbit e := map (fun k => turn M k e) (seq 0 (degree M e)).

(** The list [ord] numbers some vertices by discovery: it starts at the root; whole vertices are
    listed; each dart but the first follows the one before it, or is joined with an earlier one. *)
Record discovery (ord : list nat) : Prop := {
  nb_lt : forall d, In d ord -> d < darts M;
  nb_once : NoDup ord;
  nb_some : 0 < length ord;
  nb_root : nth 0 ord 0 = root M;
  nb_sigma : forall d, In d ord -> In (sigma M d) ord;
  nb_before : forall i, S i < length ord -> sigma M (nth i ord 0) = nth (S i) ord 0 \/
    exists j, j <= i /\ alpha M (nth (S i) ord 0) = Some (nth j ord 0) }.

(** The darts of an orbit are turns. *)
Lemma in_orbit e d : In d (orbit e) -> exists k, k < degree M e /\ d = turn M k e.
Proof.
  intros I. apply in_map_iff in I as (k & <- & I). apply in_seq in I. exists k. split; [lia|auto].
Qed.

(** Its length is the degree. *)
Lemma orbit_length e : length (orbit e) = degree M e.
Proof. unfold orbit. rewrite map_length, seq_length. auto. Qed.

(** Its elements in order. *)
Lemma orbit_nth e k : k < degree M e -> nth k (orbit e) 0 = turn M k e.
Proof.
  intros Lk. unfold orbit.
  rewrite (nth_indep _ 0 (turn M 0 e)) by (rewrite map_length, seq_length; auto).
  rewrite (map_nth (fun k => turn M k e)), seq_nth; auto.
Qed.

(** No dart is listed twice. *)
Lemma orbit_once e : e < darts M -> NoDup (orbit e).
Proof.
  intros Le. apply nodup_map; [apply seq_NoDup|]. intros i j I J E. apply in_seq in I, J.
  apply (turn_eq M WM e); auto; lia.
Qed.

(** The next dart of each is listed, too. *)
Lemma orbit_sigma e d : e < darts M -> In d (orbit e) -> In (sigma M d) (orbit e).
Proof.
  intros Le I. apply in_orbit in I as (k & Lk & ->). destruct (degree_spec M WM e Le) as (Pd & Full & _).
  change (sigma M (turn M k e)) with (turn M (S k) e). apply in_map_iff.
  destruct (Nat.eq_dec (S k) (degree M e)) as [E|N].
  - exists 0. rewrite E, Full. split; auto. apply in_seq. lia.
  - exists (S k). split; auto. apply in_seq. lia.
Qed.

(** The root's vertex is a discovery. *)
Lemma first_discovery : discovery (orbit (root M)).
Proof.
  assert (R := root_lt M WM). destruct (degree_spec M WM _ R) as (Pd & _). split.
  - intros d I. apply in_orbit in I as (k & _ & ->). apply turn_lt; auto.
  - apply orbit_once; auto.
  - rewrite orbit_length. auto.
  - rewrite orbit_nth; auto.
  - intros d. apply orbit_sigma; auto.
  - intros i Li. rewrite orbit_length in Li. left. rewrite !orbit_nth by lia. auto.
Qed.

(** If an end of an edge is numbered and the other is not, the vertex of the other can be numbered
    next. *)
Lemma next_discovery ord d e : discovery ord -> In d ord -> alpha M d = Some e -> ~ In e ord ->
  discovery (ord ++ orbit e).
Proof.
  intros [A B C R S F] I E N. destruct (alpha_ok M WM d e (A d I) E) as (Le & _ & E').
  destruct (degree_spec M WM e Le) as (Pd & Full & _).
  assert (Turn : forall k a, In a ord -> In (turn M k a) ord).
  { intros k. induction k as [|k IH]; simpl; auto. }
  assert (Apart : forall x, In x ord -> ~ In x (orbit e)).
  { intros x Ix Io. apply in_orbit in Io as (k & Lk & ->). apply N.
    assert (G := Turn (degree M e - k) _ Ix). rewrite <- turn_add in G.
    replace (degree M e - k + k) with (degree M e) in G by lia. rewrite Full in G. auto. }
  split.
  - intros x J. apply in_app_or in J as [J|J]; auto. apply in_orbit in J as (k & _ & ->).
    apply turn_lt; auto.
  - apply nodup_append; auto. apply orbit_once; auto.
  - rewrite app_length. lia.
  - rewrite app_nth1; auto.
  - intros x J. apply in_app_or in J as [J|J]; apply in_or_app; auto. right. apply orbit_sigma; auto.
  - intros i Li. rewrite app_length, orbit_length in Li.
    destruct (lt_eq_lt_dec (Datatypes.S i) (length ord)) as [[L|L]|L].
    + rewrite !app_nth1 by lia. destruct (F i L) as [G|(j & Lj & G)]; auto. right. exists j.
      rewrite app_nth1 by lia. auto.
    + right. exists (index_of d ord). destruct (index_of_in d ord I) as [Lx Nx].
      rewrite app_nth2, app_nth1, L, Nat.sub_diag, orbit_nth, Nx by lia. simpl. split; [lia|auto].
    + left. rewrite !app_nth2, !orbit_nth by lia.
      replace (Datatypes.S i - length ord) with (Datatypes.S (i - length ord)) by lia. auto.
Qed.

(** All darts can be numbered. *)
Lemma discovery_exists : exists ord, discovery ord /\ forall d, d < darts M -> In d ord.
Proof.
  cut (forall n ord, discovery ord -> darts M < n + length ord ->
    exists ord, discovery ord /\ forall d, d < darts M -> In d ord).
  { intros H. apply (H (S (darts M)) (orbit (root M))); [apply first_discovery|lia]. }
  intros n. induction n as [|n IH]; intros ord Nb Le.
  - exfalso. assert (Q : length ord <= length (seq 0 (darts M))).
    { apply NoDup_incl_length; [apply Nb|]. intros d I. apply in_seq.
      apply (nb_lt ord Nb) in I. lia. }
    rewrite seq_length in Q. lia.
  - destruct (in_dec_exists (fun d => exists e, alpha M d = Some e /\ ~ In e ord) ord)
      as [(d & I & e & E & N)|All].
    + intros d. destruct (alpha M d) as [e|]; [|right; intros (e & E & _); discriminate].
      destruct (in_dec Nat.eq_dec e ord) as [I|N]; [right|left; eauto].
      intros (x & E & N). injection E as <-. auto.
    + apply (IH (ord ++ orbit e)); [apply next_discovery with d; auto|].
      rewrite app_length, orbit_length.
      destruct (degree_spec M WM e) as (Pd & _); [|lia].
      apply (alpha_ok M WM d e); auto. apply (nb_lt ord Nb); auto.
    + exists ord. split; auto. intros d Ld. apply CM in Ld.
      induction Ld as [|d _ J|d e _ J E].
      * rewrite <- (nb_root ord Nb). apply nth_In, Nb.
      * apply (nb_sigma ord Nb); auto.
      * destruct (in_dec Nat.eq_dec e ord) as [K|K]; auto. destruct (All d J). eauto.
Qed.

(** The table of a discovery. *)
Definition table_by ord : map_table := map (fun d => (index_of (sigma M d) ord,
  index_of (turn M (degree M d - 1) d) ord, option_map (fun e => index_of e ord) (alpha M d))) ord.

(** A map whose darts are all numbered is isomorphic to its table, which [check_table] accepts. *)
Lemma table_by_right ord : discovery ord -> (forall d, d < darts M -> In d ord) ->
  check_table (table_by ord) = true /\
  embedded M (map_of (table_by ord)) (fun d => index_of d ord) /\
  (total (table_by ord) = true <-> forall d, d < darts M -> alpha M d <> None).
Proof.
  intros Nb All. assert (Len : length (table_by ord) = length ord) by apply map_length.
  assert (Row : forall i, i < length ord -> let d := nth i ord 0 in
    row (table_by ord) i = (index_of (sigma M d) ord, index_of (turn M (degree M d - 1) d) ord,
      option_map (fun e => index_of e ord) (alpha M d))).
  { intros i Li. unfold row. rewrite (nth_indep _ _ ((fun d => (index_of (sigma M d) ord,
      index_of (turn M (degree M d - 1) d) ord, option_map (fun e => index_of e ord) (alpha M d))) 0))
      by (rewrite Len; auto).
    apply (map_nth (fun d => (index_of (sigma M d) ord,
      index_of (turn M (degree M d - 1) d) ord, option_map (fun e => index_of e ord) (alpha M d)))). }
  assert (RowAt : forall d, d < darts M -> row (table_by ord) (index_of d ord) =
    (index_of (sigma M d) ord, index_of (turn M (degree M d - 1) d) ord,
      option_map (fun e => index_of e ord) (alpha M d))).
  { intros d Ld. destruct (index_of_in d ord (All d Ld)) as [A B]. rewrite (Row _ A), B. auto. }
  assert (Lt : forall d, d < darts M -> index_of d ord < length ord)
    by (intros d Ld; apply index_of_in, All, Ld).
  split; [|split].
  - unfold check_table. rewrite Len. rewrite (proj2 (Nat.ltb_lt _ _) (nb_some ord Nb)). simpl.
    apply forallb_forall. intros i Li. apply in_seq in Li. destruct Li as [_ Li]. simpl in Li.
    assert (Ld := nb_lt ord Nb _ (nth_In ord 0 Li)).
    assert (Ix := index_of_nth ord (nb_once ord Nb) i Li).
    assert (Before := nb_before ord Nb). specialize (Row i Li). cbv zeta in Row.
    unfold check_row. rewrite Row. remember (nth i ord 0) as d eqn:Ed.
    assert (Ls := sigma_lt M WM d Ld). rewrite (proj2 (Nat.ltb_lt _ _) (Lt _ Ls)), (RowAt _ Ls). simpl.
    assert (Back : turn M (degree M (sigma M d) - 1) (sigma M d) = d).
    { change (sigma M d) with (turn M 1 d). rewrite (degree_turn M WM) by auto.
      rewrite <- turn_add. destruct (degree_spec M WM d Ld) as (Pd & Full & _).
      replace (degree M d - 1 + 1) with (degree M d) by lia. auto. }
    rewrite Back, Ix, Nat.eqb_refl. simpl.
    assert (Pair : match option_map (fun e => index_of e ord) (alpha M d) with
      | Some e => (e <? length ord) && negb (e =? i) &&
          match snd (row (table_by ord) e) with Some y => y =? i | None => false end
      | None => true end = true).
    { destruct (alpha M d) as [e|] eqn:E; auto. simpl.
      destruct (alpha_ok M WM d e Ld E) as (Le & N & E'). rewrite (RowAt e Le), E'. simpl.
      rewrite Ix, Nat.eqb_refl, (proj2 (Nat.ltb_lt _ _) (Lt e Le)). simpl. rewrite andb_true_r.
      apply negb_true_iff, Nat.eqb_neq. intros Q. apply N.
      destruct (index_of_in e ord (All e Le)) as [_ A]. rewrite Q in A. congruence. }
    rewrite Pair. simpl. destruct i as [|i]; auto. simpl. rewrite Nat.sub_0_r.
    destruct (Before i Li) as [G|(j & Lj & G)].
    + assert (Li' : i < length ord) by lia. rewrite <- Ed in G.
      replace (row (table_by ord) i) with (row (table_by ord) (index_of (nth i ord 0) ord))
        by (rewrite index_of_nth; auto; apply Nb).
      rewrite RowAt by (apply (nb_lt ord Nb), nth_In; auto). simpl. rewrite G, Ix, Nat.eqb_refl. auto.
    + rewrite <- Ed in G. rewrite G. simpl. rewrite index_of_nth by (try apply Nb; lia).
      rewrite (proj2 (Nat.ltb_lt j (S i))) by lia. apply orb_true_r.
  - split; simpl.
    + intros d Ld. rewrite Len. auto.
    + intros d e Ld Le E. destruct (index_of_in d ord (All d Ld)) as [_ <-].
      destruct (index_of_in e ord (All e Le)) as [_ <-]. congruence.
    + intros d Ld. rewrite RowAt; auto.
    + intros d e Ld E. rewrite RowAt, E; auto.
    + rewrite <- (nb_root ord Nb). apply index_of_nth; apply Nb.
  - unfold total, table_by. rewrite forallb_forall. split.
    + intros H d Ld. specialize (H _ (in_map _ _ d (All d Ld))). simpl in H.
      destruct (alpha M d); simpl in H; congruence.
    + intros H r I. apply in_map_iff in I as (d & <- & I). simpl.
      specialize (H d (nb_lt ord Nb d I)). destruct (alpha M d); simpl; congruence.
Qed.
End Numbered.

(** Moves that a map shows pass the check. *)
Lemma check_moves_shown M ms : forall a, percepts M a (map fst ms) = Some (map snd ms) ->
  check_moves M a ms = true.
Proof.
  induction ms as [|(k, p) ms IH]; simpl; auto. intros a H.
  destruct (move M a k) as [b|]; [|discriminate].
  destruct (percepts M b (map fst ms)) as [ps|] eqn:E; [|discriminate]. injection H as Hp Hs.
  rewrite <- Hp. destruct (percept_eqb_spec (percept M b) (percept M b)) as [_|N]; [|tauto].
  apply IH. congruence.
Qed.

(** Claim 9: every connected map that shows a log has a table that [check_map] accepts, with a row for
    each dart. *)
Theorem table_with_rows M L : is_map M -> connected M -> replays M L -> exists t, check_map t L = true /\
  (total t = true <-> forall d, d < darts M -> alpha M d <> None) /\ length t = darts M.
Proof.
  intros WM CM R. destruct (discovery_exists M WM CM) as (ord & Nb & All).
  destruct (table_by_right M WM ord Nb All) as (C & E & T). exists (table_by M ord). split; [|split].
  - unfold check_map. rewrite C. simpl. apply check_table_spec in C as [WT _].
    destruct (embedded_replays M _ _ L WM WT E R) as [R1 R2]. simpl root in R1, R2. rewrite R1.
    destruct (percept_eqb_spec (start L) (start L)) as [_|N]; [|tauto]. apply check_moves_shown, R2.
  - exact T.
  - unfold table_by. rewrite map_length. apply Nat.le_antisymm; rewrite <- (seq_length (darts M) 0);
      (apply NoDup_incl_length; [try apply Nb; apply seq_NoDup|]); intros d I.
    + apply in_seq. apply (nb_lt M ord Nb) in I. lia.
    + apply in_seq in I. apply All. lia.
Qed.

(** So it has a table. *)
Corollary table_exists M L : is_map M -> connected M -> replays M L -> exists t, check_map t L = true /\
  (total t = true <-> forall d, d < darts M -> alpha M d <> None).
Proof.
  intros WM CM R. destruct (table_with_rows M L WM CM R) as (t & A & B & _). eauto.
Qed.
