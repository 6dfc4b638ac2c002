(** What the programs of Checker.v accept is true: certificates of maps and of decisions (claims 9
    and 10).

    The letters are those of Checker.v; extra is the list of assumed edges, assumed the same list
    with places of the log.

    The invariant of the union-find is [true_uf]: what it has merged is identified in the log,
    whatever the evidence says. [markers_sound] says that it holds at the beginning, [glue_sound]
    that each merge keeps it, and [folded_sound] that it holds at the end. *)
From Coq Require Import Arith Lia List Bool PArith FMapPositive.
Import ListNotations.
From Topo Require Import World Rotation Embedding Augment Log Determined Undetermined Classes
  Quotient Entailed Table TableCorrect Checker.

(** An entry (x, a) of a list numbered from y says that element x - y is a. *)
Lemma enum_in {X} (l : list X) : forall y x a, In (x, a) (enum y l) ->
  Pos.to_nat y <= Pos.to_nat x /\ nth_error l (Pos.to_nat x - Pos.to_nat y) = Some a.
Proof.
  induction l as [|b l IH]; simpl; intros y x a H; [destruct H|]. destruct H as [H|H].
  - injection H as <- <-. rewrite Nat.sub_diag. auto.
  - apply IH in H as [H1 H2]. rewrite Pos2Nat.inj_succ in H1, H2.
    split; [lia|]. replace (Pos.to_nat x - Pos.to_nat y) with (S (Pos.to_nat x - S (Pos.to_nat y)))
      by lia. auto.
Qed.

(** An entry (x, a) of a list numbered from 1 says that element [num x] is a. *)
Lemma enum_1 {X} (l : list X) x a : In (x, a) (enum 1 l) -> nth_error l (num x) = Some a.
Proof.
  intros H. apply enum_in in H as [_ H]. unfold num. rewrite Pos2Nat.inj_1 in H.
  rewrite <- Nat.sub_1_r. auto.
Qed.

(** Every element of a list has an entry in the numbered list. *)
Lemma in_enum {X} (l : list X) : forall y i a, nth_error l i = Some a ->
  exists x, In (x, a) (enum y l) /\ Pos.to_nat x = Pos.to_nat y + i.
Proof.
  induction l as [|b l IH]; simpl; intros y i a H; [destruct i; discriminate|].
  destruct i as [|i]; simpl in H.
  - injection H as ->. exists y. split; auto. 
  - destruct (IH (Pos.succ y) i a H) as (x & A1 & A2). rewrite Pos2Nat.inj_succ in A2.
    exists x. split; [auto|lia].
Qed.

(** The binary map of a list returns the elements of the list. *)
Lemma table_of_spec {X} (l : list X) x a :
  PositiveMap.find x (table_of l) = Some a -> nth_error l (num x) = Some a.
Proof.
  unfold table_of. intros H. apply enum_1.
  assert (G : forall e t, PositiveMap.find x (fold_left (fun t (xa : positive * X) =>
    PositiveMap.add (fst xa) (snd xa) t) e t) = Some a -> In (x, a) e \/ PositiveMap.find x t = Some a).
  { intros e. induction e as [|(y, b) e IH]; simpl; auto. intros t Hf. apply IH in Hf as [Hf|Hf]; auto.
    destruct (Pos.eq_dec x y) as [->|N].
    - rewrite PositiveMap.gss in Hf. injection Hf as ->. auto.
    - rewrite PositiveMap.gso in Hf; auto. }
  apply G in H as [H|H]; auto. rewrite PositiveMap.gempty in H. discriminate.
Qed.

(** The successor of a visit is the next visit of the log. *)
Lemma num_succ x : num (Pos.succ x) = S (num x).
Proof. unfold num. rewrite Pos2Nat.inj_succ. assert (H := Pos2Nat.is_pos x). lia. Qed.

Section Sound.
Variables (L : Log) (extra : list (pplace * pplace)).
Let assumed := map abs2 extra.
Let T := table_of (sights L).
Let D := table_of (edges L extra).
Hypothesis Known : forall p q, In (p, q) extra -> valid L (abs p) /\ valid L (abs q).
Notation same := (same assumed L).
Notation link := (link assumed L).
Notation arc_ends := (arc_ends D).
Notation rep := (rep T fuel).

(** The binary map of percepts returns the percepts of the log. *)
Lemma find_seen x p : PositiveMap.find x T = Some p -> seen L (num x) = Some p.
Proof. apply (table_of_spec (sights L)). Qed.

(** The listed edges are links of the log. *)
Lemma edges_sound p q : In (p, q) (edges L extra) -> link (abs p) (abs q).
Proof.
  unfold edges. rewrite in_app_iff, in_map_iff. intros [((x, k) & E & I)|I].
  - injection E as <- <-. unfold abs. simpl. rewrite num_succ. constructor. apply enum_1, I.
  - destruct (Known p q I). apply link_assumed; auto.
    apply in_map_iff. exists (p, q). auto.
Qed.

(** The two ends of an arc are linked. *)
Lemma arc_ends_sound a p q : arc_ends a = Some (p, q) -> link (abs p) (abs q).
Proof.
  unfold Checker.arc_ends. destruct (PositiveMap.find (snd a) D) as [(r, s)|] eqn:E; [|discriminate].
  apply table_of_spec, nth_error_In, edges_sound in E.
  destruct (fst a); intros Eq; injection Eq as <- <-; auto using link_sym.
Qed.

(** The invariant of the union-find: a visit's reference dart is identified with the given offset
    at its parent. *)
Definition true_uf (U : unions) := forall x y o,
  PositiveMap.find x U = Some (y, o) -> same (num x, 0) (num y, o).

(** A place is identified with its reduced form. *)
Lemma reduced_sound p : same (abs p) (abs (reduced T p)).
Proof.
  unfold reduced. destruct (PositiveMap.find (fst p) T) as [(d, m)|] eqn:E; [|constructor].
  apply (same_mod assumed L _ _ d m), find_seen; auto.
Qed.

(** A place is identified with its representative. *)
Lemma rep_sound U n : true_uf U -> forall p, same (abs p) (abs (Checker.rep T n U p)).
Proof.
  intros HU. induction n as [|n IH]; simpl; intros (x, i); [constructor|]. simpl.
  destruct (PositiveMap.find x U) as [(y, o)|] eqn:E; [|constructor].
  eapply same_trans; [|apply IH]. eapply same_trans; [|apply reduced_sound].
  unfold abs; simpl. rewrite <- (Nat.add_0_r i) at 1. apply same_turn, HU; auto.
Qed.

(** Merging identified places keeps the invariant. *)
Lemma unite_sound U p q : true_uf U -> same (abs p) (abs q) -> true_uf (unite T U p q).
Proof.
  intros HU H. unfold unite. assert (A := rep_sound U fuel HU p). assert (B := rep_sound U fuel HU q).
  destruct (rep U p) as (x, i), (rep U q) as (y, j).
  destruct (Pos.eqb x y); auto. destruct (PositiveMap.find y T) as [(d, m)|] eqn:E; auto.
  destruct (Nat.leb_spec j d); auto. intros z w o. destruct (Pos.eq_dec z y) as [->|N].
  - rewrite PositiveMap.gss. intros Eq. injection Eq as Eq.
    change (num w, o) with (abs (w, o)). rewrite <- Eq.
    eapply same_trans; [|apply reduced_sound]. unfold abs; simpl.
    apply same_trans with (num y, d); [apply same_sym, (same_full assumed L _ d m), find_seen; auto|].
    replace d with (d - j + j) at 1 by lia. apply same_turn.
    apply same_trans with (abs q); [apply same_sym; auto|].
    apply same_trans with (abs p); [apply same_sym; auto|auto].
  - rewrite PositiveMap.gso by auto. apply HU.
Qed.

(** What [pplace_eqb] accepts is equal. *)
Lemma pplace_eqb_eq p q : pplace_eqb p q = true -> p = q.
Proof.
  destruct p as (x, i), q as (y, j). unfold pplace_eqb. simpl. intros H.
  apply andb_true_iff in H as [A B]. apply Pos.eqb_eq in A. apply Nat.eqb_eq in B. congruence.
Qed.

(** Places with the same representative are identified. *)
Lemma rep_same U p q : true_uf U -> rep U p = rep U q -> same (abs p) (abs q).
Proof.
  intros HU E. eapply same_trans; [apply (rep_sound U fuel HU)|]. rewrite E.
  apply same_sym, (rep_sound U fuel HU).
Qed.

(** The places where two arcs from one dart arrive are identified. *)
Lemma meet_sound U s p q : true_uf U -> meet T D U s = Some (p, q) -> same (abs p) (abs q).
Proof.
  intros HU. unfold meet. destruct (arc_ends (fst s)) as [(p1, q1)|] eqn:E1; [|discriminate].
  destruct (arc_ends (snd s)) as [(p2, q2)|] eqn:E2; [|discriminate].
  destruct (pplace_eqb (rep U p1) (rep U p2)) eqn:E; [|discriminate].
  intros Eq. injection Eq as <- <-. apply pplace_eqb_eq in E.
  apply (same_link assumed L (abs p1) _ (abs p2) _); eauto using arc_ends_sound.
  apply (rep_same U); auto.
Qed.

(** A step of evidence keeps the invariant, whatever it says. *)
Lemma glue_sound U s : true_uf U -> true_uf (glue T D U s).
Proof.
  intros HU. unfold glue. destruct (meet T D U s) as [(p, q)|] eqn:E; auto.
  apply unite_sound; auto. apply (meet_sound U s); auto.
Qed.

(** Where visit x saw the marker in direction j, the place (x, j) is identified with the start. *)
Lemma marked_sound x d j : seen L (num x) = Some (d, Some j) ->
  same (abs (1%positive, 0)) (abs (x, j)).
Proof.
  intros E. apply same_sym. unfold abs. simpl. change (num 1) with 0. apply (same_mark assumed L _ d
    j E).
Qed.

(** The invariant holds at the beginning, when only visits that saw the marker are merged. *)
Lemma markers_sound : true_uf (markers T (sights L)).
Proof.
  unfold markers. assert (H := fun x a => @enum_1 Percept (sights L) x a). revert H.
  generalize (enum 1 (sights L)). intros l.
  assert (E : true_uf (PositiveMap.empty _)) by (intros x y o; rewrite PositiveMap.gempty; discriminate).
  revert E. generalize (PositiveMap.empty pplace).
  induction l as [|(x, (d, m)) l IH]; simpl; intros U HU Hl; auto. apply IH; auto.
  destruct m as [j|]; auto. apply unite_sound; auto. apply marked_sound with d. apply Hl; auto.
Qed.

(** A list of steps keeps the invariant. *)
Lemma glues_sound ev : forall U, true_uf U -> true_uf (fold_left (glue T D) ev U).
Proof. induction ev as [|s ev IH]; simpl; auto using glue_sound. Qed.

(** The invariant holds after all merges. *)
Theorem folded_sound ev : true_uf (folded L extra ev).
Proof. apply glues_sound, markers_sound. Qed.

(** The invariant of [cover]: every dart noted as crossed is identified with an end of a link. *)
Definition true_cover U (C : PositiveMap.t (list nat)) := true_uf U -> forall x k,
  In k (offsets C x) -> exists p q, link p q /\ same (num x, k) p.

(** Adding the dart of an arc keeps the invariant of [cover]. *)
Lemma cover_sound U C a : true_cover U C -> true_cover U (cover T D U C a).
Proof.
  intros HC. unfold cover. destruct (arc_ends a) as [(p, q)|] eqn:E; auto.
  destruct (rep U p) as (x, k) eqn:R. destruct (existsb _ _); auto.
  intros HU y l. unfold offsets at 1. destruct (Pos.eq_dec y x) as [->|N].
  - rewrite PositiveMap.gss. intros [<-|H]; [|apply HC; auto].
    exists (abs p), (abs q). split; [apply arc_ends_sound with a; auto|].
    apply same_sym. change (num x, k) with (abs (x, k)). rewrite <- R. apply rep_sound; auto.
  - rewrite PositiveMap.gso by auto. apply HC; auto.
Qed.

(** The invariant holds for all darts noted by [covered]. *)
Lemma covered_sound U l : true_cover U (covered T D U l).
Proof.
  unfold covered. assert (E : true_cover U (PositiveMap.empty _))
    by (intros _ x k; unfold offsets; rewrite PositiveMap.gempty; intros []).
  revert E. generalize (PositiveMap.empty (list nat)).
  induction (enum 1 l) as [|m e IH]; simpl; auto using cover_sound.
Qed.

(** If [check_closed] accepts, every place is identified with an end of a link. *)
Lemma check_closed_sound U l : true_uf U -> check_closed T D U (sights L) l = true ->
  forall p, valid L p -> exists q r, link q r /\ same p q.
Proof.
  unfold check_closed. intros HU H (i, k) V. unfold valid in V; simpl in V.
  destruct (seen L i) as [(d, m)|] eqn:E; [clear V|destruct V; auto].
  destruct (in_enum (sights L) 1 i (d, m) E) as (x & I & X). rewrite Pos2Nat.inj_1 in X.
  rewrite forallb_forall in H. apply H in I. cbn [fst snd] in I.
  apply andb_true_iff in I as [Pd I]. apply Nat.ltb_lt in Pd. rewrite forallb_forall in I.
  assert (B : k mod d < d) by (apply Nat.mod_upper_bound; lia).
  specialize (I (k mod d) ltac:(apply in_seq; lia)).
  assert (R := rep_sound U fuel HU (x, k mod d)).
  destruct (rep U (x, k mod d)) as (y, o). apply existsb_exists in I as (o' & I & El).
  apply Nat.eqb_eq in El as <-. destruct (covered_sound U l HU y o I) as (p & q & Lp & S).
  exists p, q. split; auto. apply same_trans with (i, k mod d); [apply (same_mod assumed L i k d m E)|].
  apply same_trans with (num y, o); auto. unfold abs in R; simpl in R.
  replace (num x) with i in R by (unfold num; lia). auto.
Qed.

(** If two identified places are apart, no world shows the log with the assumed edges. *)
Lemma apart_sound U p q : true_uf U -> same (abs p) (abs q) -> apart T U p q = true ->
  ~ possible assumed L.
Proof.
  intros HU S H P. apply possible_consistent in P.
  2: { intros a b I. apply in_map_iff in I as ((x, y) & E & I). injection E as <- <-. auto. }
  destruct p as (v, a), q as (w, b). unfold apart in H. simpl fst in H.
  apply orb_true_iff in H as [H|H].
  - destruct (PositiveMap.find v T) as [(d, m)|] eqn:Ev; [|discriminate].
    destruct (PositiveMap.find w T) as [(e, n)|] eqn:Ew; [|discriminate].
    apply find_seen in Ev, Ew. apply orb_true_iff in H as [H|H].
    + apply negb_true_iff, Nat.eqb_neq in H. apply H.
      apply (c_degree assumed L P _ _ _ _ _ _ _ _ S Ev Ew).
    + destruct m as [m|], n as [n|]; try discriminate.
      * apply (c_marker assumed L P _ _ _ _ _ _ _ _ S Ev Ew). auto.
      * apply (c_marker assumed L P _ _ _ _ _ _ _ _ (same_sym _ _ _ _ S) Ew Ev). auto.
  - assert (A := rep_sound U fuel HU (v, a)). assert (B := rep_sound U fuel HU (w, b)).
    destruct (rep U (v, a)) as (x, i), (rep U (w, b)) as (y, j).
    apply andb_true_iff in H as [H Lt]. apply andb_true_iff in H as [Eq N].
    apply Pos.eqb_eq in Eq as <-. apply negb_true_iff, Nat.eqb_neq in N. apply N.
    destruct (PositiveMap.find x T) as [(d, m)|] eqn:Ex; [|discriminate]. apply find_seen in Ex.
    apply andb_true_iff in Lt as [Li Lj]. apply Nat.ltb_lt in Li, Lj.
    apply (c_turn assumed L P (num x) i j d m); auto.
    eapply same_trans; [apply same_sym; exact A|]. eapply same_trans; [exact S|exact B].
Qed.

(** If [check_conflict] accepts, no world shows the log with the assumed edges. *)
Theorem check_conflict_sound U c : true_uf U -> check_conflict T D U c = true ->
  ~ possible assumed L.
Proof.
  intros HU. destruct c as [s|x|x]; simpl.
  - destruct (meet T D U s) as [(p, q)|] eqn:E; [|discriminate].
    apply apart_sound; auto. apply (meet_sound U s); auto.
  - destruct (PositiveMap.find x T) as [(d, [j|])|] eqn:E; try discriminate.
    apply apart_sound; auto. apply marked_sound with d, find_seen, E.
  - destruct (PositiveMap.find x D) as [(p, q)|] eqn:E; [|discriminate].
    intros H P. apply possible_consistent in P.
    2: { intros a b I. apply in_map_iff in I as ((y, z) & Eq & I). injection Eq as <- <-. auto. }
    apply table_of_spec, nth_error_In, edges_sound in E.
    apply (c_edge assumed L P _ _ E), (rep_same U); auto. apply pplace_eqb_eq, H.
Qed.

(** If [check_partners] accepts, the fold makes p and q partners. *)
Theorem check_partners_sound U p q a : true_uf U -> check_partners T D U p q a = true ->
  exists p' q', link p' q' /\ same (abs p) p' /\ same (abs q) q'.
Proof.
  intros HU. unfold check_partners. destruct (arc_ends a) as [(r, s)|] eqn:E; [|discriminate].
  intros H. apply andb_true_iff in H as [A B]. apply pplace_eqb_eq in A, B.
  exists (abs r), (abs s). split; [apply arc_ends_sound with a; auto|].
  split; apply (rep_same U); auto.
Qed.
End Sound.

(** If [proves] accepts, the log is closed. *)
Lemma proves_closed L ev : proves L ev = true -> closed L.
Proof.
  intros H p V. apply (check_closed_sound L [] (fun _ _ I => match I with end)
    (folded L [] ev) (edges L [])); auto.
  apply (folded_sound L []). intros x y [].
Qed.

(** Claim 9, the verdict PROVED: if [certified] accepts, the table is a world that shows the log,
    and every world that shows the log is isomorphic to it.
    Not in the paper. *)
Theorem certified_correct L t ev : certified L t ev = true ->
  world (map_of t) /\ replays (map_of t) L /\
  forall W, world W -> replays W L -> isomorphic (map_of t) W.
Proof.
  unfold certified. intros H. apply andb_true_iff in H as [E H]. apply andb_true_iff in H as [Ht P].
  apply check_map_spec in E as (A & B & C). assert (HM : world (map_of t)).
  { split; auto. intros d Hd. unfold total in Ht. rewrite forallb_forall in Ht.
    specialize (Ht (row t d) (nth_In t _ Hd)). simpl. destruct (snd (row t d)); congruence. }
  split; auto. split; auto. intros W HW R.
  apply (closed_determines L); auto. apply (proves_closed L ev P).
Qed.

(** Every percept that a world shows is legal. *)
Lemma legal_percept_shown W a : is_map W -> a < darts W -> legal_percept (percept W a) = true.
Proof.
  intros WW La. unfold legal_percept, percept. simpl.
  destruct (degree_spec W WW a La) as (D & _). rewrite (proj2 (Nat.ltb_lt _ _) D). simpl.
  destruct (marker W a) as [j|] eqn:E; auto. apply find_seq in E as (J & _). apply Nat.ltb_lt. lia.
Qed.

(** Every list of moves that a world shows is legal. *)
Lemma legal_moves_shown W : is_map W -> forall ms a, a < darts W ->
  percepts W a (map fst ms) = Some (map snd ms) -> legal_moves (degree W a) ms = true.
Proof.
  intros WW ms. induction ms as [|(k, p) ms IH]; simpl; auto. intros a La H.
  destruct (move W a k) as [b|] eqn:M; [|discriminate].
  destruct (percepts W b (map fst ms)) as [ps|] eqn:P; [|discriminate]. injection H as <- ->.
  assert (Lb := move_lt W WW a k b La M).
  rewrite (proj2 (Nat.ltb_lt _ _) (move_door W a k b M)), legal_percept_shown; auto.
  apply IH; auto.
Qed.

(** Every log that a world shows is legal. *)
Lemma legal_shown W L : world W -> replays W L -> legal L = true.
Proof.
  intros HW [S M]. assert (WW := world_is_map W HW). assert (R := root_lt W WW).
  unfold legal. rewrite <- S, legal_percept_shown by auto. simpl.
  rewrite legal_moves_shown by auto. unfold marker.
  destruct (degree_spec W WW (root W) R) as (D & _).
  destruct (degree W (root W)) as [|d]; [lia|]. simpl. rewrite Nat.eqb_refl. auto.
Qed.

(** Claim 9, the verdict REFUTED where no world exists: if [impossible] accepts, no world shows
    the log.
    Not in the paper. *)
Theorem impossible_correct L ev c : impossible L ev c = true ->
  forall W, world W -> ~ replays W L.
Proof.
  unfold impossible. intros H W HW R. rewrite (legal_shown W L HW R) in H. simpl in H.
  assert (WW := world_is_map W HW). apply replays_visits in R as [v V]; auto.
  apply (check_conflict_sound L [] (fun _ _ I => match I with end) (folded L [] ev) c); auto.
  - apply (folded_sound L []). intros x y [].
  - exists W, v. split; auto. split; auto. intros x y [].
Qed.

(** If the fold with an assumed edge from p to q has a conflict, no world that shows the log has
    that edge. *)
Lemma assumed_edge_refuted L p q U ev c : let T := table_of (sights L) in
  let D := table_of (edges L [(p, q)]) in
  PositiveMap.mem (fst p) T = true -> PositiveMap.mem (fst q) T = true -> true_uf L [(p, q)] U ->
  check_conflict T D (fold_left (glue T D) ev U) c = true ->
  forall W v, world W -> visits W L v -> alpha W (dart W v (abs p)) <> Some (dart W v (abs q)).
Proof.
  intros T D P Q HU C.
  assert (K : forall x, PositiveMap.mem (fst x) T = true -> valid L (abs x)).
  { intros (x, i). rewrite PositiveMap.mem_find. unfold valid. simpl.
    destruct (PositiveMap.find x T) as [s|] eqn:E; [|discriminate].
    apply table_of_spec in E. unfold seen, sights in *. congruence. }
  assert (Known : forall a b, In (a, b) [(p, q)] -> valid L (abs a) /\ valid L (abs b)).
  { intros a b [I|[]]. injection I as <- <-. auto. }
  intros W v HW V E. apply check_conflict_sound in C; auto; [|apply glues_sound; auto].
  apply C. exists W, v. split; auto. split; auto. intros a b [I|[]]. injection I as <- <-. auto.
Qed.

(** Claim 10, reject: if [rejected] accepts, no world that shows the log has an edge from p to q.
    Not in the paper. *)
Theorem rejected_correct L p q ev c : rejected L p q ev c = true ->
  forall W v, world W -> visits W L v -> alpha W (dart W v (abs p)) <> Some (dart W v (abs q)).
Proof.
  unfold rejected. intros H. apply andb_true_iff in H as [H C]. apply andb_true_iff in H as [P Q].
  apply (assumed_edge_refuted L p q (markers (table_of (sights L)) (sights L)) ev c); auto.
  apply markers_sound.
Qed.

(** Claim 10, confirm: if [confirmed] accepts, every world that shows the log has an edge from p
    to q.
    Not in the paper. *)
Theorem confirmed_correct L p q ev a : confirmed L p q ev a = true ->
  forall W v, world W -> visits W L v -> alpha W (dart W v (abs p)) = Some (dart W v (abs q)).
Proof.
  intros H W v HW V.
  destruct (check_partners_sound L [] (fun _ _ I => match I with end) (folded L [] ev) p q a)
    as (r & s & K & A & B); auto.
  - apply (folded_sound L []). intros x y [].
  - assert (F := fits_nothing W v). apply (same_sound W L v nothing HW V F) in A, B.
    rewrite A, B. apply (link_sound W L v nothing HW V F). auto.
Qed.
