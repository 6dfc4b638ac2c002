(** Every decision that follows is accepted, with reasons that are computed (claim 10;
    docs/proofs.md).

    L is a log that the world W0 shows, m a moment after it, M the map S, rho gives each visit a rank;
    the other letters are those of Decisions.v.

    A moment is [ready] if all is merged that follows from the log. Then a rejection is supported by
    merging on with its edge ([refutation]), a confirmation by an arc. A new vertex is behind e in
    every world, with one degree: so e was crossed ([crossed_behind]), since two worlds with a leaf
    and with a path behind e would differ in that degree. *)
From Coq Require Import Arith Lia List Bool PArith FMapPositive.
Import ListNotations.
From Topo Require Import World Rotation Embedding Augment Log Determined Undetermined Classes
  Quotient Entailed Table Checker CheckerCorrect Ranked Saturated Complete Conflicts Accepted
  Events Decisions DecisionsCorrect.

Local Opaque fuel.

(** The invariant of a moment at which all is merged that follows from the log. *)
Record ready L m rho : Prop := {
  rd_true : true_moment L m;
  rd_ranked : ranked L (unified m) rho;
  rd_marks : marks_merged L (unified m);
  rd_all : all_merged L [] (unified m) }.

(** The reason why no edge leads from p to q. *)
Definition refutation L m rho p q := Refuted (saturating_from L [(p, q)] (unified m) rho)
  match conflict_from L [(p, q)] (unified m) rho with Some c => c | None => Alone 1 end.

(** All reasons that are tried for a decision. *)
Definition candidates L m rho s ev : list (list reason) := match ev with
  | Move _ _ => []
  | Reject e h => match place_of s e, place_of s h with
      | Some p, Some q => [[refutation L m rho p q]] | _, _ => [] end
  | Confirm _ _ | Loop _ _ _ => map (fun a => [Joined a]) (all_arcs L [])
  | New e _ _ => match place_of s e with
      | Some p => map (fun a => Joined a :: map (fun o => refutation L m rho p (snd o))
          (but e (opened s))) (all_arcs L [])
      | None => [] end end.

(** If all worlds have a vertex of one degree behind a place, the log crossed its dart. *)
Lemma crossed_behind L p d : possible nothing L -> valid L p ->
  (forall W v, world W -> visits W L v -> exists b, alpha W (dart W v p) = Some b /\ degree W b = d) ->
  exists q r, link nothing L q r /\ same nothing L p q.
Proof.
  intros P V H. apply possible_consistent in P; [|intros a b []].
  destruct (quotient_exists L nothing P) as (M & u & Q).
  assert (WM := q_map _ _ _ _ Q). assert (CM := q_connected _ _ _ _ Q).
  destruct (alpha M (dart M u p)) as [x|] eqn:Ex.
  { destruct (q_link _ _ _ _ Q p V) as (q & r & K & S & _); [congruence|eauto]. }
  exfalso. set (e := dart M u p) in *.
  assert (Le : e < darts M) by (apply turn_lt; auto; apply (v_lt M L u (q_visits _ _ _ _ Q))).
  assert (G : forall k, 0 < k < 3 -> d = k).
  { intros k Hk. set (N := augment_new M e k).
    assert (WN : is_map N) by (apply is_map_new; auto; lia).
    assert (CN : connected N) by (apply connected_new; auto).
    assert (E := embedded_fresh M e k WM Le Ex : embedded M N id).
    destruct (hang_leaves (darts N) N WN CN) as (W & HW & E' & _); [lia|].
    destruct (embedded_visits M N L u WM WN E (q_visits _ _ _ _ Q)) as [V1 D1].
    destruct (embedded_visits N W L u WN (world_is_map W HW) E' V1) as [V2 D2].
    destruct (H W u HW V2) as (b & Hb & Db). rewrite D2, D1 in Hb. fold e in Hb.
    assert (An : alpha N e = Some (darts M)) by (simpl; unfold join; rewrite Nat.eqb_refl; auto).
    assert (Ln : e < darts N) by (simpl; lia).
    assert (Aw := phi_alpha _ _ _ E' e _ Ln An). unfold id in Aw.
    assert (b = darts M) as -> by congruence. rewrite <- Db.
    assert (Lm : darts M < darts N) by (simpl; lia).
    assert (Lw := phi_lt _ _ _ E' _ Lm). unfold id in Lw.
    assert (Sg : forall x, x < darts N -> sigma W x = sigma N x).
    { intros x Lx. symmetry. apply (phi_sigma _ _ _ E' x Lx). }
    assert (S0 : sigma W (darts M) = if k =? 1 then darts M else S (darts M)).
    { rewrite Sg by auto. simpl. unfold grow. cases; auto. }
    apply (degree_unique W (world_is_map W HW)); auto; [lia| |].
    - destruct (Nat.eqb_spec k 1) as [->|Nk]; [simpl; auto|].
      assert (k = 2) as -> by lia. simpl. rewrite S0, Sg by (simpl; lia). simpl. unfold grow. cases.
    - intros j Hj. assert (k = 2) as -> by lia. assert (j = 1) as -> by lia. simpl. rewrite S0.
      simpl. lia. }
  assert (d = 1) by (apply G; lia). assert (d = 2) by (apply G; lia). lia.
Qed.

Section Judged.
Variables (L : Log) (W0 : Map) (v0 : nat -> nat) (m : moment) (rho : positive -> nat).
Hypotheses (HW0 : world W0) (V0 : visits W0 L v0) (Few : few_visits L) (Ready : ready L m rho).
Notation T := (table_of (sights L)).

(** The log is legal and possible. *)
Lemma judged_possible : legal L = true /\ possible nothing L.
Proof. apply (shown_possible W0 L HW0), (visits_replays W0 L v0 V0). Qed.

(** Where no world has an edge from p to q, its refutation is accepted. *)
Lemma refutation_supported p q : on_record L p -> on_record L q -> holds L (LeadsNot p q) ->
  supported m (LeadsNot p q) (refutation L m rho p q) = true.
Proof.
  intros P Q H. destruct judged_possible as [Legal Pos]. destruct Ready as [(_ & HT & HD & _) R Mk _].
  assert (Mem : forall a, on_record L a -> PositiveMap.mem (fst a) T = true).
  { intros a (d & (n & F) & _). rewrite PositiveMap.mem_find, F. auto. }
  assert (Rec : forall a b, In (a, b) [(p, q)] -> on_record L a /\ on_record L b).
  { intros a b [I|[]]. injection I as <- <-. auto. }
  assert (E : PositiveMap.add (here m) (p, q) (crossed m) = table_of (edges L [(p, q)])).
  { rewrite HD. unfold edges. rewrite app_nil_r. symmetry. apply table_of_snoc.
    rewrite map_length, enum_length, map_length. destruct Ready as [(N & _) _ _ _]. exact N. }
  unfold supported, refutation. rewrite HT, E, !Mem by auto. simpl andb.
  fold (fold_from L [(p, q)] (unified m) rho).
  destruct (conflict_from L [(p, q)] (unified m) rho) as [c|] eqn:F; [apply (find_some _ _ F)|].
  exfalso. apply (no_conflict_consistent L [(p, q)] Few Legal Rec _ rho R Mk) in F.
  apply consistent_possible in F as (W & v & HW & V & Fit). apply (H W v HW V).
  apply (Fit (abs p) (abs q)). simpl. auto.
Qed.

(** Identified places have the same representative. *)
Lemma ready_merged p q : on_record L p -> on_record L q -> same nothing L (abs p) (abs q) ->
  rep T fuel (unified m) p = rep T fuel (unified m) q.
Proof.
  intros (d & Tp) (e & Tq) S. destruct judged_possible as [Legal _]. destruct Ready as [_ R Mk Sat].
  assert (Mk' : forall x d j, PositiveMap.find x T = Some (d, Some j) ->
    j < d /\ rep T fuel (unified m) (x, j) = rep T fuel (unified m) (1%positive, 0)).
  { intros x f j E. split; [|eauto]. apply table_of_spec in E.
    apply (proj2 (proj1 (proj2 (legal_spec L Legal)) _ _ _ E)). auto. }
  destruct (same_merged L [] Legal (nothing_recorded L) Few _ rho R Sat Mk' _ _ S) as [Eq|(_ & _ & Eq)].
  - rewrite <- (norm_abs L d p Tp), <- (norm_abs L e q Tq), Eq. auto.
  - rewrite (norm_abs L d p Tp), (norm_abs L e q Tq) in Eq. exact Eq.
Qed.

(** Where a link joins what is identified with p and q, an arc is accepted that joins them. *)
Lemma arc_supported p q p' q' : on_record L p -> on_record L q -> link nothing L p' q' ->
  same nothing L (abs p) p' -> same nothing L (abs q) q' ->
  exists a, In a (all_arcs L []) /\ supported m (Leads p q) (Joined a) = true.
Proof.
  intros P Q K S S'. destruct judged_possible as [Legal _].
  assert (HT := proj1 (proj2 (rd_true _ _ _ Ready))).
  assert (HD := proj1 (proj2 (proj2 (rd_true _ _ _ Ready)))).
  destruct (link_arc L [] p' q' K) as (a & r & s & E & <- & <-).
  destruct (legal_ends L [] Legal (nothing_recorded L) a r s E) as [Tr Ts].
  exists a. split; [apply (arc_listed L [] a r s E)|].
  unfold supported, check_partners. rewrite HT, HD, E.
  rewrite (ready_merged p r), (ready_merged q s), !pplace_eqb_refl; auto.
Qed.

(** Where every world has an edge from p to q, an arc is accepted that joins them. *)
Lemma joined_supported p q : on_record L p -> on_record L q -> holds L (Leads p q) ->
  exists a, In a (all_arcs L []) /\ supported m (Leads p q) (Joined a) = true.
Proof.
  intros P Q H. destruct judged_possible as [_ Pos].
  assert (V : forall a, on_record L a -> valid L (abs a)).
  { intros a (d & (n & F) & _). apply table_of_spec in F. unfold valid, abs, seen, sights in *.
    cbn [fst]. congruence. }
  assert (C : consistent nothing L) by (apply possible_consistent; [intros a b []|auto]).
  assert (H' := proj1 (confirmation_entailed_iff L (abs p) (abs q) C (V p P) (V q Q)) H).
  destruct H' as (p' & q' & K & S & S'). apply (arc_supported p q p' q'); auto.
Qed.

(** A place that is recorded has the degree that its vertex has in the world. *)
Lemma on_record_degree q d : on_record L q -> degree W0 (dart W0 v0 (abs q)) = d ->
  has_degree T d q = true.
Proof.
  intros (e & (n & F) & _) E. unfold has_degree. rewrite F. apply Nat.eqb_eq.
  rewrite <- E. symmetry. apply (has_degree_true L W0 v0 e q HW0 V0). unfold has_degree.
  rewrite F. apply Nat.eqb_refl.
Qed.

Variables (M : Map) (s : sketch).
Hypotheses (Sketch : true_sketch L M s) (Connected : connected M)
  (Places : forall d p, In (d, p) (opened s) -> on_record L p).

(** Every open dart has a place. *)
Lemma place_of_open e : open_dart M e -> exists p, place_of s e = Some p /\ In (e, p) (opened s).
Proof.
  intros O. destruct Sketch as (_ & _ & C & _). destruct (C e O) as (p & I). unfold place_of.
  destruct (find (fun o : nat * pplace => fst o =? e) (opened s)) as [(x, q)|] eqn:F.
  - apply find_some in F as [I' F]. apply Nat.eqb_eq in F. simpl in F. subst x. exists q. auto.
  - apply (find_none _ _ F) in I. simpl in I. rewrite Nat.eqb_refl in I. discriminate.
Qed.

(** What is true wherever the log is shown, said of the places of open darts. *)
Lemma true_of_places ev : true_wherever L M ev -> forall W v, world W -> visits W L v ->
  exists phi, embedded M W phi /\ true_event W M phi ev /\
  forall d p, In (d, p) (opened s) -> phi d = dart W v (abs p).
Proof.
  intros H W v HW V. destruct (H W v HW V) as (phi & E & Tr). exists phi. split; auto. split; auto.
  intros d p I. destruct Sketch as (_ & B & _ & D). destruct (D W v HW V) as (WM & psi & E' & F).
  rewrite <- (F d p I). apply (embedded_unique M W phi psi Connected WM E E' d). apply (B d p I).
Qed.

(** The rejection of all these places is accepted. *)
Lemma all_refuted_supported p l : on_record L p ->
  (forall d q, In (d, q) l -> on_record L q /\ holds L (LeadsNot p q)) ->
  all_refuted m p l (map (fun o => refutation L m rho p (snd o)) l) = true.
Proof.
  intros P. induction l as [|(d, q) l IH]; auto. intros H.
  destruct (H d q (or_introl eq_refl)) as [Q N]. cbn [map all_refuted snd].
  rewrite refutation_supported by auto. simpl andb.
  apply IH. intros e r I. apply (H e r). simpl. auto.
Qed.

(** Claim 10: at a moment at which all is merged, every decision that follows is accepted with some
    of the reasons that are tried. *)
Theorem judge_accepts ev : is_decision ev = true -> true_wherever L M ev ->
  exists rs s', In rs (candidates L m rho s ev) /\ judge m s ev rs = Some s'.
Proof.
  intros De H. assert (H' := true_of_places ev H).
  assert (HT := proj1 (proj2 (rd_true _ _ _ Ready))).
  assert (HD := proj1 (proj2 (proj2 (rd_true _ _ _ Ready)))).
  destruct (H' W0 v0 HW0 V0) as (phi & Em & Tr & F). assert (Sk := Sketch).
  destruct Sk as (A & _ & _ & D).
  destruct ev as [|e h|e h|e h d|e a d]; try discriminate; simpl in Tr.
  - destruct Tr as (Oe & Oh & _). destruct (place_of_open e Oe) as (p & Pe & Ie).
    destruct (place_of_open h Oh) as (q & Ph & Ih).
    exists [refutation L m rho p q], s. unfold candidates, judge. rewrite Pe, Ph.
    split; [simpl; auto|].
    rewrite refutation_supported; eauto. intros W v HW V.
    destruct (H' W v HW V) as (psi & _ & (_ & _ & N) & G). rewrite <- (G _ _ Ie), <- (G _ _ Ih). auto.
  - destruct Tr as (Oe & Oh & _). destruct (place_of_open e Oe) as (p & Pe & Ie).
    destruct (place_of_open h Oh) as (q & Ph & Ih).
    destruct (joined_supported p q) as (c & Ic & C); eauto.
    { intros W v HW V. destruct (H' W v HW V) as (psi & _ & (_ & _ & N) & G).
      rewrite <- (G _ _ Ie), <- (G _ _ Ih). auto. }
    exists [Joined c], s. split; [apply (in_map (fun a => [Joined a])), Ic|]. unfold judge.
    rewrite Pe, Ph, C. auto.
  - destruct Tr as (Oe & Oh & Eh & Dh). destruct (place_of_open e Oe) as (p & Pe & Ie).
    destruct (place_of_open h Oh) as (q & Ph & Ih).
    destruct (joined_supported p q) as (c & Ic & C); eauto.
    { intros W v HW V. destruct (H' W v HW V) as (psi & _ & (_ & _ & N & _) & G).
      rewrite <- (G _ _ Ie), <- (G _ _ Ih). auto. }
    eexists [Joined c], _. split; [apply (in_map (fun a => [Joined a])), Ic|]. unfold judge.
    rewrite Pe, Ph, C, HT.
    rewrite (on_record_degree q d); [|eauto|rewrite <- (F _ _ Ih); auto].
    destruct (Nat.eqb_spec h e) as [->|N]; [|reflexivity].
    apply (alpha_ok W0 (world_is_map W0 HW0)) in Eh as (_ & Ne & _); [tauto|].
    apply (phi_lt _ _ _ Em), Oe.
  - destruct Tr as (Oe & Ea & b & Eb & Db & New). destruct (place_of_open e Oe) as (p & Pe & Ie).
    assert (P := Places _ _ Ie).
    assert (Vp : valid L (abs p)).
    { destruct P as (f & (n & Fp) & _). apply table_of_spec in Fp.
      unfold valid, abs, seen, sights in *. cbn [fst]. congruence. }
    destruct judged_possible as [Legal Pos].
    destruct (crossed_behind L (abs p) d Pos Vp) as (p' & q' & K & S).
    { intros W v HW V. destruct (H' W v HW V) as (psi & _ & (_ & _ & c & Ec & Dc & _) & G).
      exists c. rewrite <- (G _ _ Ie). auto. }
    destruct (link_arc L [] p' q' K) as (c & r & q & E & <- & <-).
    destruct (legal_ends L [] Legal (nothing_recorded L) c r q E) as [Tr' Tq].
    assert (Lead : forall W v, world W -> visits W L v ->
      alpha W (dart W v (abs p)) = Some (dart W v (abs q))).
    { intros W v HW V. assert (Nf := fits_nothing W v).
      rewrite (same_sound W L v nothing HW V Nf _ _ S). apply (link_sound W L v nothing HW V Nf), K. }
    assert (Sup : supported m (Leads p q) (Joined c) = true).
    { unfold supported, check_partners. rewrite HT, HD, E.
      rewrite (ready_merged p r), !pplace_eqb_refl; auto. }
    exists (Joined c :: map (fun o => refutation L m rho p (snd o)) (but e (opened s))).
    eexists. split.
    { unfold candidates. rewrite Pe. apply (in_map (fun a => Joined a ::
        map (fun o => refutation L m rho p (snd o)) (but e (opened s)))), (arc_listed L [] c r q E). }
    unfold judge. rewrite Pe, HD, E, Sup, HT.
    rewrite (on_record_degree q d Tq); [|rewrite <- Db; f_equal; assert (Q := Lead W0 v0 HW0 V0);
      rewrite <- (F _ _ Ie) in Q; congruence].
    rewrite A, Ea, Nat.eqb_refl, all_refuted_supported; [reflexivity|exact P|]. intros h o I.
    apply in_but in I as [I _]. split; [eauto|]. intros W v HW V Bad.
    destruct (H' W v HW V) as (psi & _ & (_ & _ & c' & Ec & _ & Nw) & G).
    rewrite <- (G _ _ Ie), <- (G _ _ I) in Bad. apply (Nw h); [|congruence].
    destruct Sketch as (_ & B & _). apply (B h o I).
Qed.

(** The darts of a vertex are at recorded places. *)
Lemma seen_from_recorded n d q x r : has_degree T d q = true -> In (x, r) (seen_from T n d q) ->
  on_record L r.
Proof.
  intros Hd I. unfold has_degree in Hd.
  destruct (PositiveMap.find (fst q) T) as [(e, k)|] eqn:F; [|discriminate].
  apply in_seen_from in I as (i & Li & _ & ->). apply Nat.eqb_eq in Hd as ->.
  exists d. rewrite (reduced_tidy L _ _ _ _ F). split; [exists k; auto|].
  simpl. apply Nat.mod_upper_bound. lia.
Qed.

(** After a decision the places are recorded, and the map is connected. *)
Lemma judge_keeps ev rs s' : judge m s ev rs = Some s' ->
  connected (drawn M ev) /\ forall d p, In (d, p) (opened s') -> on_record L p.
Proof.
  assert (HT := proj1 (proj2 (rd_true _ _ _ Ready))).
  destruct Sketch as (_ & B & _ & D). destruct (D W0 v0 HW0 V0) as (WM & _).
  unfold judge. rewrite HT. destruct ev as [|e h|e h|e h d|e a d]; try discriminate.
  1-3: destruct rs as [|r [|]]; try discriminate;
    destruct (place_of s e) as [p|] eqn:Pe; [|discriminate]; apply place_of_in in Pe;
    destruct (place_of s h) as [q|] eqn:Ph; [|discriminate]; apply place_of_in in Ph;
    destruct (supported _ _ _); [|discriminate].
  1, 2: intros E; injection E as <-; split; [exact Connected|exact Places].
  - simpl. destruct (has_degree _ d q && negb (h =? e)); [|discriminate].
    intros E. injection E as <-. split.
    + apply connected_loop; auto; [apply (B _ _ Pe)|apply (B _ _ Ph)].
    + intros x o I. simpl in I. rewrite !in_but in I. apply (Places x o), I.
  - destruct rs as [|[c|] rs]; try discriminate.
    destruct (place_of s e) as [p|] eqn:Pe; [|discriminate]. apply place_of_in in Pe.
    destruct (arc_ends _ c) as [(r, q)|]; [|discriminate].
    destruct (supported _ _ _); [|discriminate]. destruct (has_degree _ d q) eqn:G; [|discriminate].
    destruct (_ && _); [|discriminate]. intros E. injection E as <-. split.
    + destruct (B _ _ Pe) as [Le Oe]. apply connected_new; auto.
    + intros x o I. simpl in I. apply in_app_iff in I as [I|I].
      * apply in_but in I as [I _]. apply (Places x o I).
      * apply (seen_from_recorded (size s) d q x o G).
        destruct (seen_from T (size s) d q); [destruct I|].
        simpl in *. auto.
Qed.
End Judged.
