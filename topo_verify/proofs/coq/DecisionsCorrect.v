(** What the program of Decisions.v accepts is true (claim 10).

    L is a log, M the map S, d a fact about places or a degree; the other letters are those of
    Decisions.v and Events.v.

    The invariant of the walk is [true_moment]: the tables are those of the log so far, and what the
    union-find has merged is identified. The invariant of the map is [true_sketch]: in every world
    that shows the log so far, S is embedded so that each open dart is the dart of its place. *)
From Coq Require Import Arith Lia List Bool PArith FMapPositive.
Import ListNotations.
From Topo Require Import World Rotation Embedding Augment Log Determined Checker CheckerCorrect Events
  Decisions.

(** The fact holds in every world that shows the log. *)
Definition holds L d := forall W v, world W -> visits W L v -> match d with
  | Leads p q => alpha W (dart W v (abs p)) = Some (dart W v (abs q))
  | LeadsNot p q => alpha W (dart W v (abs p)) <> Some (dart W v (abs q)) end.

(** Numbering a list with one more element adds one entry at the end. *)
Lemma enum_snoc {X} (l : list X) : forall y x a, Pos.to_nat x = Pos.to_nat y + length l ->
  enum y (l ++ [a]) = enum y l ++ [(x, a)].
Proof.
  induction l as [|b l IH]; simpl; intros y x a H.
  - rewrite Nat.add_0_r in H. apply Pos2Nat.inj in H as ->. auto.
  - rewrite (IH (Pos.succ y) x a); auto. rewrite Pos2Nat.inj_succ. lia.
Qed.

(** The binary map of a list with one more element has one more entry. *)
Lemma table_of_snoc {X} (l : list X) x a : num x = length l ->
  table_of (l ++ [a]) = PositiveMap.add x a (table_of l).
Proof.
  unfold num, table_of. intros H. rewrite (enum_snoc l 1 x a), fold_left_app; auto.
  rewrite Pos2Nat.inj_1. assert (P := Pos2Nat.is_pos x). lia.
Qed.

(** The numbered list is as long as the list. *)
Lemma enum_length {X} (l : list X) : forall y, length (enum y l) = length l.
Proof. induction l; simpl; auto. Qed.

(** A longer log and more assumed edges identify at least as much. *)
Lemma same_grows A B L L' p q : (forall i s, seen L i = Some s -> seen L' i = Some s) ->
  (forall i k, door L i = Some k -> door L' i = Some k) -> (forall e, In e A -> In e B) ->
  same A L p q -> same B L' p q.
Proof.
  intros HS HD HA.
  assert (HV : forall r, valid L r -> valid L' r).
  { intros r. unfold valid. destruct (seen L (fst r)) as [s|] eqn:E; [|intros N; destruct N; auto].
    rewrite (HS _ _ E). discriminate. }
  assert (HL : forall r s, link A L r s -> link B L' r s).
  { intros r s []; auto using link_out, link_back, link_assumed, link_assumed_back. }
  intros H. induction H; eauto using same_refl, same_sym, same_trans, same_turn, same_full,
    same_mark, same_link.
Qed.

(** The invariant of the union-find stays true for a longer log and for assumed edges. *)
Lemma true_uf_grows L L' extra U : (forall i s, seen L i = Some s -> seen L' i = Some s) ->
  (forall i k, door L i = Some k -> door L' i = Some k) -> true_uf L [] U -> true_uf L' extra U.
Proof.
  intros HS HD HU x y o E. apply (same_grows (map abs2 []) _ L L'); auto. intros e [].
Qed.

(** The invariant of the walk: the tables at moment m are those of the log L so far, and the
    union-find is true of that log. *)
Definition true_moment L m := num (here m) = length (moves L) /\ sighted m = table_of (sights L) /\
  crossed m = table_of (edges L []) /\ true_uf L [] (unified m).

(** The invariant holds at the start. *)
Lemma outset_true p : true_moment {| start := p; moves := [] |} (outset p).
Proof. do 3 (split; auto). apply (markers_sound {| start := p; moves := [] |} []). Qed.

(** One move keeps the invariant. *)
Lemma onward_true L m a : true_moment L m ->
  true_moment {| start := start L; moves := moves L ++ [a] |} (onward m a).
Proof.
  intros (N & HT & HD & HU). set (P' := {| start := start L; moves := moves L ++ [a] |}).
  assert (Y : num (Pos.succ (here m)) = S (length (moves L))) by (rewrite num_succ; auto).
  assert (T' : PositiveMap.add (Pos.succ (here m)) (snd a) (sighted m) = table_of (sights P')).
  { unfold sights, P'. simpl. rewrite HT, map_app, app_comm_cons.
    symmetry. apply table_of_snoc. simpl. rewrite map_length. auto. }
  assert (G : true_uf P' [] (unified m)).
  { eapply true_uf_grows; [| |exact HU]; unfold seen, door, P'; simpl; intros i s H;
      rewrite map_app, ?app_comm_cons, nth_error_app1; auto; apply nth_error_Some; congruence. }
  split; [unfold P'; simpl; rewrite app_length, Y; simpl; lia|]. split; auto. split.
  - simpl. rewrite HD. unfold edges, P'. simpl. rewrite !app_nil_r, map_app.
    change (map fst [a]) with [fst a]. rewrite (enum_snoc _ 1 (here m)).
    + rewrite map_app. symmetry. apply table_of_snoc. rewrite map_length, enum_length, map_length. auto.
    + rewrite map_length, <- N. unfold num. rewrite Pos2Nat.inj_1.
      assert (Q := Pos2Nat.is_pos (here m)). lia.
  - destruct a as (k, (d, [j|])); simpl; auto. simpl in T'. rewrite T'. apply unite_sound; auto.
    apply marked_sound with d. rewrite Y. unfold seen, P'. simpl.
    rewrite map_app, nth_error_app2; rewrite map_length; [|lia]. rewrite Nat.sub_diag. auto.
Qed.

(** Merging keeps the invariant. *)
Lemma settle_true L ev : forall m, true_moment L m -> true_moment L (fst (settle m ev)).
Proof.
  induction ev as [|s ev IH]; simpl; auto. intros m H. destruct (_ && _); auto.
  apply IH. destruct H as (N & HT & HD & HU). do 3 (split; auto).
  simpl. rewrite HT, HD. apply glue_sound; auto. intros p q [].
Qed.

(** Under the invariant, a fact with a reason that proves it holds. *)
Lemma supported_holds L m d r : true_moment L m -> supported m d r = true -> holds L d.
Proof.
  intros (N & HT & HD & HU). assert (Nil : forall a b, In (a, b) [] ->
    valid L (abs a) /\ valid L (abs b)) by (intros a b []).
  unfold supported. rewrite HT, HD.
  destruct d as [p q|p q], r as [a|ev c]; try discriminate; intros C W v HW Vi.
  - apply check_partners_sound in C as (r & s & K & A & B); auto.
    assert (F := fits_nothing W v). apply (same_sound W L v nothing HW Vi F) in A, B.
    rewrite A, B. apply (link_sound W L v nothing HW Vi F). auto.
  - apply andb_true_iff in C as [Kn C]. apply andb_true_iff in Kn as [P Q].
    assert (E : PositiveMap.add (here m) (p, q) (table_of (edges L [])) =
      table_of (edges L [(p, q)])).
    { unfold edges. rewrite app_nil_r. symmetry. apply table_of_snoc.
      rewrite map_length, enum_length, map_length. auto. }
    rewrite E in C. revert W v HW Vi. apply (assumed_edge_refuted L p q (unified m) ev c); auto.
    apply (true_uf_grows L L); auto.
Qed.

(** What is true of v in a world that shows the longer log is true for the shorter. *)
Lemma visits_shorter W L L' v : (forall i s, seen L i = Some s -> seen L' i = Some s) ->
  (forall i k, door L i = Some k -> door L' i = Some k) -> visits W L' v -> visits W L v.
Proof. intros HS HD V. split; try apply V; intros i x E; apply V; auto. Qed.

(** The invariant of the sketch: M is the map, [opened] its open darts, and in every world that
    shows the log L the map is embedded so that each open dart is the dart of its place. *)
Definition true_sketch L M s := size s = darts M /\
  (forall d p, In (d, p) (opened s) -> open_dart M d) /\
  (forall d, open_dart M d -> exists p, In (d, p) (opened s)) /\
  forall W v, world W -> visits W L v -> is_map M /\ exists phi, embedded M W phi /\
    forall d p, In (d, p) (opened s) -> phi d = dart W v (abs p).

(** The invariant stays true for a longer log. *)
Lemma true_sketch_grows L L' M s : (forall i x, seen L i = Some x -> seen L' i = Some x) ->
  (forall i k, door L i = Some k -> door L' i = Some k) -> true_sketch L M s -> true_sketch L' M s.
Proof.
  intros HS HD (A & B & C & D). do 3 (split; auto). intros W v HW V. apply D; auto.
  apply (visits_shorter W L L'); auto.
Qed.

(** A place that was found for a dart is listed with it. *)
Lemma place_of_in s e p : place_of s e = Some p -> In (e, p) (opened s).
Proof.
  unfold place_of. destruct (find _ _) as [(d, q)|] eqn:E; [|discriminate].
  apply find_some in E as [I E].
  apply Nat.eqb_eq in E. simpl in *. intros H. injection H as <-. subst. auto.
Qed.

(** What is listed without e. *)
Lemma in_but e l d p : In (d, p) (but e l) <-> In (d, p) l /\ d <> e.
Proof. unfold but. rewrite filter_In, negb_true_iff, Nat.eqb_neq. simpl. tauto. Qed.

(** The darts of a vertex are listed, each at a place that is its dart. *)
Lemma in_seen_from L n d p x q : In (x, q) (seen_from (table_of (sights L)) n d p) <->
  exists i, i < d /\ x = n + i /\ q = reduced (table_of (sights L)) (fst p, snd p + i).
Proof.
  unfold seen_from. rewrite in_map_iff. split.
  - intros (i & E & I). injection E as <- <-. apply in_seq in I. exists i. repeat split; auto. lia.
  - intros (i & I & -> & ->). exists i. split; auto. apply in_seq. lia.
Qed.

(** The reduced place of an offset is the dart that many turns on. *)
Lemma reduced_dart W L v p i : world W -> visits W L v ->
  dart W v (abs (reduced (table_of (sights L)) (fst p, snd p + i))) = turn W i (dart W v (abs p)).
Proof.
  intros HW V. assert (F := fits_nothing W v).
  assert (S := reduced_sound L [] (fst p, snd p + i)).
  apply (same_sound W L v nothing HW V F) in S. unfold nothing in *. rewrite <- S.
  unfold dart, abs. simpl. rewrite Nat.add_comm. apply turn_add.
Qed.

(** The event is true in every world that shows the log, in which the map is embedded. *)
Definition true_wherever L M ev := forall W v, world W -> visits W L v ->
  exists phi, embedded M W phi /\ true_event W M phi ev.

(** The invariant of the sketch holds after a loop that is in every world. *)
Lemma loop_decided L M s e h p q : true_sketch L M s -> In (e, p) (opened s) -> In (h, q) (opened s) ->
  h <> e -> holds L (Leads p q) ->
  true_sketch L (augment_loop M e h) {| size := size s; opened := but h (but e (opened s)) |}.
Proof.
  intros (A & B & C & D) Ie Ih N H. destruct (B _ _ Ie) as [Le Oe], (B _ _ Ih) as [Lh Oh].
  split; [exact A|]. split; [|split].
  - intros d x I. simpl in I. apply in_but in I as [I Nh]. apply in_but in I as [I Ne].
    destruct (B _ _ I) as [Ld Od]. split; auto. simpl. unfold join. cases; auto.
  - intros d [Ld Od]. simpl in *. unfold join in Od. cases.
    destruct (C d (conj Ld Od)) as [x I]. exists x. rewrite !in_but. auto.
  - intros W v HW V. destruct (D W v HW V) as (WM & phi & E & Hphi).
    split; [apply is_map_loop; auto|]. exists phi. split.
    + apply embedded_loop; auto; [apply HW|]. rewrite (Hphi _ _ Ie), (Hphi _ _ Ih). apply H; auto.
    + intros d x I. simpl in I. rewrite !in_but in I. apply Hphi, I.
Qed.

(** All the other open darts are refuted. *)
Lemma all_refuted_true L m p l : true_moment L m -> forall rs, all_refuted m p l rs = true ->
  forall d q, In (d, q) l -> holds L (LeadsNot p q).
Proof.
  intros HM. induction l as [|o l IH]; simpl; intros rs H d q; [intros []|].
  destruct rs as [|r rs]; [discriminate|]. apply andb_true_iff in H as [H1 H2].
  intros [->|I]; [|apply (IH rs H2 d q I)]. apply (supported_holds L m (LeadsNot p q) r HM H1).
Qed.

(** If a place has degree d in the log, its vertex has in every world that shows the log. *)
Lemma has_degree_true L W v d p : world W -> visits W L v ->
  has_degree (table_of (sights L)) d p = true -> degree W (dart W v (abs p)) = d.
Proof.
  intros HW V. unfold has_degree.
  destruct (PositiveMap.find (fst p) _) as [(d', j)|] eqn:E; [|discriminate].
  intros H. apply Nat.eqb_eq in H as <-. apply find_seen in E.
  apply (v_seen W L v V) in E. injection E as E _. unfold dart, abs. simpl.
  rewrite degree_turn; [auto|apply HW|apply V].
Qed.

(** If every open dart but e is refuted, no dart of the map is behind e. *)
Lemma refuted_is_new L M s W v phi e p b : world W -> visits W L v -> true_sketch L M s ->
  is_map M -> embedded M W phi -> (forall d q, In (d, q) (opened s) -> phi d = dart W v (abs q)) ->
  In (e, p) (opened s) -> alpha W (phi e) = Some b ->
  (forall d q, In (d, q) (but e (opened s)) -> holds L (LeadsNot p q)) -> is_new M phi b.
Proof.
  intros HW V (A & B & C & _) WM E Hphi Ie Hb R h Lh Eh. destruct (B _ _ Ie) as [Le Oe].
  destruct (posed M W phi WM (world_is_map W HW) E e b h Le Oe Hb Lh Eh) as (N & Oh & _).
  destruct (C h (conj Lh Oh)) as [q Ih]. apply (R h q) with (W := W) (v := v); auto.
  - apply in_but. auto.
  - rewrite <- (Hphi _ _ Ie), <- (Hphi _ _ Ih). congruence.
Qed.

(** The invariant of the sketch holds after a new vertex that is new in every world. *)
Lemma new_decided L M s e p q d : true_sketch L M s -> In (e, p) (opened s) -> holds L (Leads p q) ->
  (forall h r, In (h, r) (but e (opened s)) -> holds L (LeadsNot p r)) ->
  has_degree (table_of (sights L)) d q = true ->
  true_sketch L (augment_new M e d) {| size := size s + d;
    opened := but e (opened s) ++ tl (seen_from (table_of (sights L)) (size s) d q) |}.
Proof.
  intros HS Ie H R Hd. assert (HS' := HS). destruct HS' as (A & B & C & D).
  destruct (B _ _ Ie) as [Le Oe].
  assert (T : forall x r, In (x, r) (tl (seen_from (table_of (sights L)) (size s) d q)) <->
    exists i, 0 < i < d /\ x = darts M + i /\ r = reduced (table_of (sights L)) (fst q, snd q + i)).
  { intros x r. rewrite <- A. unfold seen_from. destruct d as [|d]; simpl.
    - split; [intros []|]. intros (i & I & _). lia.
    - rewrite in_map_iff. split.
      + intros (i & Eq & I). injection Eq as <- <-. apply in_seq in I. exists i.
        repeat split; auto; lia.
      + intros (i & I & -> & ->). exists i. split; auto. apply in_seq. lia. }
  split; [simpl; congruence|]. split; [|split].
  - intros x r I. simpl in I. apply in_app_iff in I as [I|I].
    + apply in_but in I as [I N]. destruct (B _ _ I) as [Lx Ox]. split; simpl; [lia|].
      unfold join. cases; auto.
    + apply T in I as (i & I & -> & _). split; simpl; [lia|]. unfold join. cases; auto.
  - intros x [Lx Ox]. simpl in *. unfold join in Ox. cases.
    + destruct (C x) as [r I]; [split; auto|]. exists r. apply in_app_iff. left. apply in_but. auto.
    + exists (reduced (table_of (sights L)) (fst q, snd q + (x - darts M))). apply in_app_iff. right.
      apply T. exists (x - darts M). repeat split; lia.
  - intros W v HW V. destruct (D W v HW V) as (WM & phi & E & Hphi).
    assert (Hb : alpha W (phi e) = Some (dart W v (abs q))) by (rewrite (Hphi _ _ Ie); apply H; auto).
    assert (N := refuted_is_new L M s W v phi e p _ HW V HS WM E Hphi Ie Hb R).
    assert (Eq := has_degree_true L W v d q HW V Hd).
    assert (Pos : 0 < d).
    { rewrite <- Eq. apply degree_spec; [apply HW|]. apply dart_lt with L; auto. }
    split; [apply is_map_new; auto|]. exists (extend phi (darts M) W (dart W v (abs q))). split.
    + rewrite <- Eq. apply embedded_new; auto. apply HW.
    + intros x r I. simpl in I. unfold extend. apply in_app_iff in I as [I|I].
      * apply in_but in I as [I _]. destruct (B _ _ I) as [Lx _].
        rewrite (proj2 (Nat.ltb_lt _ _) Lx). auto.
      * apply T in I as (i & I & -> & ->). destruct (Nat.ltb_spec (darts M + i) (darts M)); [lia|].
        replace (darts M + i - darts M) with i by lia. symmetry. apply reduced_dart; auto.
Qed.

(** The invariant holds at the start. *)
Lemma first_sketch_true p :
  true_sketch {| start := p; moves := [] |} (initial (fst p)) (first_sketch p).
Proof.
  assert (T := in_seen_from {| start := p; moves := [] |} 0 (fst p) (1%positive, 0)).
  change (table_of (sights {| start := p; moves := [] |})) with (table_of [p]) in T.
  split; auto. split; [|split].
  - intros d q I. apply T in I as (i & I & -> & _). split; simpl; auto.
  - intros d [Ld _]. simpl in *. eexists. apply T. exists d. eauto.
  - intros W v HW V. assert (WW := world_is_map W HW).
    assert (S := v_seen W _ v V 0 p eq_refl). rewrite (v_0 W _ v V) in S. apply (f_equal fst) in S.
    simpl in S. rewrite <- S. split; [apply is_map_initial, degree_spec; auto; apply root_lt; auto|].
    eexists. split; [apply embedded_initial; auto|]. intros d q I.
    apply T in I as (i & _ & -> & ->).
    change (table_of [p]) with (table_of (sights {| start := p; moves := [] |})).
    rewrite (reduced_dart W _ v (1%positive, 0) i HW V). simpl. f_equal. symmetry. apply V.
Qed.

(** A decision that [judge] accepts is true in every world, and the invariant holds after it. *)
Lemma judge_true L M m s ev rs s' : true_moment L m -> true_sketch L M s -> judge m s ev rs = Some s' ->
  true_sketch L (drawn M ev) s' /\ true_wherever L M ev.
Proof.
  intros HM HS. assert (HT := proj1 (proj2 HM)). assert (HS' := HS).
  destruct HS' as (A & B & _ & D). unfold judge. rewrite HT.
  destruct ev as [|e h|e h|e h d|e a d]; try discriminate.
  1-3: destruct rs as [|r [|]]; try discriminate;
    destruct (place_of s e) as [p|] eqn:Pe; [|discriminate]; apply place_of_in in Pe;
    destruct (place_of s h) as [q|] eqn:Ph; [|discriminate]; apply place_of_in in Ph;
    destruct (supported _ _ _) eqn:K; [|discriminate]; apply (supported_holds L m _ r HM) in K.
  - intros E. injection E as <-. split; auto. intros W v HW V.
    destruct (D W v HW V) as (_ & phi & E & F).
    exists phi. split; auto. split; [eauto|]. split; [eauto|]. rewrite (F _ _ Pe), (F _ _ Ph).
    apply K; auto.
  - intros E. injection E as <-. split; auto. intros W v HW V.
    destruct (D W v HW V) as (_ & phi & E & F).
    exists phi. split; auto. split; [eauto|]. split; [eauto|]. rewrite (F _ _ Pe), (F _ _ Ph).
    apply K; auto.
  - simpl. destruct (has_degree _ d q) eqn:G; [|discriminate].
    destruct (Nat.eqb_spec h e); [discriminate|].
    intros E. injection E as <-. split; [apply loop_decided with p q; auto|].
    intros W v HW V. destruct (D W v HW V) as (_ & phi & E & F). exists phi. split; auto.
    split; [eauto|]. split; [eauto|]. rewrite (F _ _ Pe), (F _ _ Ph). split; [apply K; auto|].
    apply (has_degree_true L); auto.
  - destruct rs as [|[c|] rs]; try discriminate.
    destruct (place_of s e) as [p|] eqn:Pe; [|discriminate]. apply place_of_in in Pe.
    destruct (arc_ends _ c) as [(r, q)|]; [|discriminate].
    destruct (supported _ _ _) eqn:K; [|discriminate]. apply (supported_holds L m _ _ HM) in K.
    destruct (has_degree _ d q) eqn:G; [|discriminate].
    destruct (Nat.eqb_spec a (size s)); [|discriminate].
    destruct (all_refuted _ _ _ _) eqn:R; [|discriminate].
    assert (R' := all_refuted_true L m p _ HM rs R). intros E. injection E as <-.
    split; [apply new_decided with p; auto|].
    intros W v HW V. destruct (D W v HW V) as (WM & phi & E & F). exists phi. split; auto.
    split; [eauto|]. split; [congruence|]. exists (dart W v (abs q)).
    assert (Hb : alpha W (phi e) = Some (dart W v (abs q))) by (rewrite (F _ _ Pe); apply K; auto).
    split; auto. split; [apply (has_degree_true L); auto|].
    apply (refuted_is_new L M s W v phi e p); auto.
Qed.

(** One more move is one more move of the log, and other events are none. *)
Lemma log_after_snoc p es ev : log_after p (es ++ [ev]) = {| start := p;
  moves := moves (log_after p es) ++ match ev with Move k q => [(k, q)] | _ => [] end |}.
Proof. unfold log_after. rewrite flat_map_app. simpl. rewrite app_nil_r. auto. Qed.

(** One more event draws the map on. *)
Lemma map_after_snoc p es ev : map_after p (es ++ [ev]) = drawn (map_after p es) ev.
Proof. unfold map_after. apply fold_left_app. Qed.

(** The number of decisions before one more event. *)
Lemma decisions_cons ev es : decisions (ev :: es) = (if is_decision ev then 1 else 0) + decisions es.
Proof. unfold decisions. simpl. destruct (is_decision ev); auto. Qed.

(** From a moment on at which the invariants hold, each decision with reasons follows. *)
Lemma decided_from_correct p es : forall past m s ev rss, true_moment (log_after p past) m ->
  true_sketch (log_after p past) (map_after p past) s -> decided_from m s ev es rss = true ->
  forall before e after, es = before ++ e :: after -> is_decision e = true ->
  reasoned rss (decisions before) -> event_follows p (past ++ before) e.
Proof.
  assert (No : forall n, ~ reasoned [] n) by (unfold reasoned; intros [|n] N; apply N; auto).
  induction es as [|x es IH]; intros past m s ev rss HM HS H before e after Eq De Re.
  { destruct before; discriminate. }
  simpl in H. destruct (is_decision x) eqn:Dx.
  - assert (Log' : log_after p (past ++ [x]) = log_after p past).
    { rewrite log_after_snoc. destruct x; try discriminate; rewrite app_nil_r; auto. }
    (* The rest follows by induction from any moment and sketch at which the invariants hold. *)
    assert (Next : forall b m' s' ev' rss', before = x :: b -> reasoned rss' (decisions b) ->
      true_moment (log_after p past) m' ->
      true_sketch (log_after p past) (drawn (map_after p past) x) s' ->
      decided_from m' s' ev' es rss' = true -> event_follows p (past ++ before) e).
    { intros b m' s' ev' rss' -> Rb HM' HS' H'. injection Eq as Eq.
      replace (past ++ x :: b) with ((past ++ [x]) ++ b) by (rewrite <- app_assoc; auto).
      apply (IH (past ++ [x]) m' s' ev' rss') with after; auto; rewrite Log', ?map_after_snoc; auto. }
    destruct rss as [|[|r rs] rss]; [destruct (No _ Re)|..].
    + apply andb_true_iff in H as [G H]. destruct before as [|y b]; injection Eq as -> Eq;
        [destruct Re; auto|]. rewrite decisions_cons, Dx in Re. apply (Next b m s ev rss); auto.
      destruct (draws y) eqn:Dr; [|destruct y; try discriminate; auto].
      destruct rss; [|discriminate]. destruct (No _ Re).
    + assert (HM' := settle_true (log_after p past) ev m HM). destruct (settle m ev) as (m', ev').
      simpl in HM'. destruct (judge m' s x (r :: rs)) as [s'|] eqn:J; [|discriminate].
      destruct (judge_true _ _ m' s x _ s' HM' HS J) as [G F].
      destruct before as [|y b]; injection Eq as -> Eq.
      * rewrite app_nil_r. intros W HW R. apply replays_visits in R as [v V]; [|apply HW].
        apply (F W v); auto.
      * rewrite decisions_cons, Dx in Re. apply (Next b m' s' ev' rss); auto.
  - destruct x as [k q| | | |]; try discriminate.
    destruct before as [|y b]; injection Eq as <- Eq; [discriminate|].
    replace (past ++ Move k q :: b) with ((past ++ [Move k q]) ++ b) by (rewrite <- app_assoc; auto).
    apply (IH (past ++ [Move k q]) (onward m (k, q)) s ev rss) with after; auto;
      rewrite log_after_snoc, ?map_after_snoc.
    + apply (onward_true (log_after p past)), HM.
    + simpl. apply (true_sketch_grows (log_after p past)); auto; unfold seen, door; simpl; intros i y E;
        rewrite map_app, ?app_comm_cons, nth_error_app1; auto; apply nth_error_Some; congruence.
Qed.

(** Claim 10: if [decided] accepts, each decision with reasons follows from the events before it.
    Not in the paper. *)
Theorem decided_correct p es ev rss : decided p es ev rss = true ->
  forall before e after, es = before ++ e :: after -> is_decision e = true ->
  reasoned rss (decisions before) -> event_follows p before e.
Proof.
  intros H. apply (decided_from_correct p es [] (outset p) (first_sketch p) ev rss); auto.
  - apply outset_true.
  - apply first_sketch_true.
Qed.
