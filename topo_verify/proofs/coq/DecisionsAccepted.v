(** All decisions of a log that follow are accepted together (claim 10; docs/proofs.md).

    p is the percept at the start, past the events so far, es those to come, W0 a world that shows the
    whole log, rho gives each visit a rank, y0 is the visit of the last settled moment; the other
    letters are those of Decisions.v and Events.v.

    The evidence is made along the walk: at each decision the merges that are left, and the first of
    the [candidates] that [judge] accepts. If there is none, the decision does not follow. *)
From Coq Require Import Arith Lia List Bool PArith FMapPositive.
Import ListNotations.
From Topo Require Import World Rotation Embedding Augment Log Determined Undetermined Classes
  Quotient Entailed Table Checker CheckerCorrect Ranked Saturated Complete Conflicts Accepted
  Events Decisions DecisionsCorrect Judged Onward.

Local Opaque fuel.

(** The decision follows, and so does everything that was drawn before it. *)
Definition follows_after p past before e := event_follows p (past ++ before) e /\
  forall b x c, before = b ++ x :: c -> draws x = true -> event_follows p (past ++ b) x.

(** A world that shows a log with its visits shows every beginning of it. *)
Lemma visits_past W v p past es : visits W (log_after p (past ++ es)) v -> visits W (log_after p past) v.
Proof.
  apply visits_shorter; unfold seen, door, log_after; simpl; intros i x E;
    rewrite flat_map_app, map_app, ?app_comm_cons, nth_error_app1; auto; apply nth_error_Some;
      congruence.
Qed.

(** The beginning of a log has no more visits. *)
Lemma few_past p past es : few_visits (log_after p (past ++ es)) -> few_visits (log_after p past).
Proof.
  unfold few_visits. intros H. eapply Nat.le_lt_trans; [|exact H]. unfold sights, log_after. simpl.
  rewrite flat_map_app, map_app, app_length. apply le_n_S, Nat.le_add_r.
Qed.

(** No candidate is empty. *)
Lemma candidates_reasoned L m rho s ev rs : In rs (candidates L m rho s ev) ->
  exists r rs', rs = r :: rs'.
Proof.
  assert (G : forall (f : arc -> reason) (g : arc -> list reason) l,
    In rs (map (fun a => f a :: g a) l) ->
    exists r rs', rs = r :: rs').
  { intros f g l I. apply in_map_iff in I as (a & <- & _). eauto. }
  unfold candidates. destruct ev as [|e h|e h|e h d|e a d]; try (intros []).
  - destruct (place_of s e), (place_of s h); try (intros []; fail). intros [<-|[]]. eauto.
  - apply (G Joined (fun _ => [])).
  - apply (G Joined (fun _ => [])).
  - destruct (place_of s e); [|intros []]. apply (G Joined).
Qed.

(** From a moment on at which the invariants hold, all decisions that follow are accepted with some
    reasons. *)
Lemma decided_from_accepts p W0 v0 es : world W0 -> forall past m s rho y0,
  visits W0 (log_after p (past ++ es)) v0 -> few_visits (log_after p (past ++ es)) ->
  walking (log_after p past) m rho y0 -> true_sketch (log_after p past) (map_after p past) s ->
  connected (map_after p past) ->
  (forall d q, In (d, q) (opened s) -> on_record (log_after p past) q) ->
  exists ev rss, later_first y0 ev = true /\ decided_from m s ev es rss = true /\
  forall before e after, es = before ++ e :: after -> is_decision e = true ->
    follows_after p past before e -> reasoned rss (decisions before).
Proof.
  intros HW0. induction es as [|x es IH]; intros past m s rho y0 V Few Walk Sk CM Places.
  { exists [], []. split; auto. split; auto. intros before e after E. destruct before; discriminate. }
  assert (V1 := visits_past W0 v0 p past (x :: es) V). assert (Few1 := few_past p past (x :: es) Few).
  replace (past ++ x :: es) with ((past ++ [x]) ++ es) in V, Few by (rewrite <- app_assoc; auto).
  (* What follows after [past ++ [x]] follows after [past]. *)
  assert (Shift : forall b e, follows_after p past (x :: b) e -> follows_after p (past ++ [x]) b e).
  { intros b e [A B]. split; [rewrite <- app_assoc; exact A|]. intros b' z c E Dz.
    rewrite <- app_assoc. apply (B (x :: b') z c); [rewrite E; auto|exact Dz]. }
  cbn [decided_from]. destruct (is_decision x) eqn:Dx.
  - assert (Log' : log_after p (past ++ [x]) = log_after p past).
    { rewrite log_after_snoc. destruct x; try discriminate; rewrite app_nil_r; auto. }
    destruct (settled_ready _ W0 v0 m rho y0 HW0 V1 Few1 Walk) as (rho' & Rd).
    set (m' := merged_on (log_after p past) m rho) in *.
    destruct (List.find (fun rs => match judge m' s x rs with Some _ => true | None => false end)
      (candidates (log_after p past) m' rho' s x)) as [rs|] eqn:F.
    + apply find_some in F as [I F]. destruct (judge m' s x rs) as [s'|] eqn:J; [clear F|discriminate].
      destruct (candidates_reasoned _ _ _ _ _ _ I) as (r & rs' & ->).
      destruct (judge_true _ _ m' s x _ s' (rd_true _ _ _ Rd) Sk J) as [Sk' _].
      destruct (judge_keeps _ W0 v0 m' rho' HW0 V1 Rd _ s Sk CM Places x _ s' J) as [CM' Places'].
      destruct (IH (past ++ [x]) m' s' rho' (here m')) as (ev & rss & Lf & Dec & All);
        rewrite ?Log', ?map_after_snoc; auto.
      { destruct Rd as [R1 R2 R3 R4]. split; auto; [|apply Pos.le_refl].
        intros st q q' M _. apply (R4 st q q' M). }
      exists (saturating_from (log_after p past) [] (unified m) rho ++ ev), ((r :: rs') :: rss).
      split; [|split].
      * assert (L1 := saturating_later _ m rho y0 Walk).
        destruct (saturating_from _ _ _ _) as [|st l]; [|exact L1]. simpl app.
        destruct ev as [|st ev]; auto. simpl in *. apply negb_true_iff in Lf. apply negb_true_iff.
        apply not_true_iff_false. intros B. apply not_true_iff_false in Lf. apply Lf.
        assert (Ly := wk_y _ _ _ _ Walk). unfold both_before in *.
        apply andb_true_iff in B as [B1 B2]. apply Pos.ltb_lt in B1, B2.
        apply andb_true_iff. split; apply Pos.ltb_lt; lia.
      * rewrite (settle_merges _ m rho y0 Walk ev Lf). fold m'. rewrite J. exact Dec.
      * intros before e after E De Fo. destruct before as [|z b]; injection E as -> E.
        -- unfold reasoned, decisions. simpl. discriminate.
        -- unfold reasoned. rewrite decisions_cons, Dx. apply (All b e after E De (Shift b e Fo)).
    + assert (Not : ~ event_follows p past x).
      { intros H. destruct (judge_accepts _ W0 v0 m' rho' HW0 V1 Few1 Rd
          (map_after p past) s Sk CM Places x Dx)
          as (rs & s' & I & J).
        - intros W v HW Vv. apply (H W HW (visits_replays W _ v Vv)).
        - apply (find_none _ _ F) in I. rewrite J in I. discriminate. }
      destruct (draws x) eqn:Dr.
      * exists [], []. split; auto. split; auto. intros before e after E De [A B]. exfalso. apply Not.
        destruct before as [|z b]; injection E as -> E; [rewrite app_nil_r in A; exact A|].
        assert (G := B [] z b eq_refl Dr). rewrite app_nil_r in G. exact G.
      * assert (Map' : map_after p (past ++ [x]) = map_after p past).
        { rewrite map_after_snoc. destruct x; try discriminate; auto. }
        destruct (IH (past ++ [x]) m s rho y0) as (ev & rss & Lf & Dec & All);
          rewrite ?Log', ?Map'; auto.
        exists ev, ([] :: rss). split; auto. split; [exact Dec|].
        intros before e after E De Fo. destruct before as [|z b]; injection E as -> E.
        -- destruct Not. destruct Fo as [A _]. rewrite app_nil_r in A. exact A.
        -- unfold reasoned. rewrite decisions_cons, Dx. apply (All b e after E De (Shift b e Fo)).
  - destruct x as [k q| | | |]; try discriminate.
    assert (V2 := visits_past W0 v0 p (past ++ [Move k q]) es V).
    assert (Few2 := few_past p (past ++ [Move k q]) es Few).
    rewrite log_after_snoc in V2, Few2. 
    destruct (onward_walking _ W0 v0 m rho y0 (k, q) HW0 V1 V2 Few2 Walk) as (rho' & Walk').
    assert (Seen : forall i z, seen (log_after p past) i = Some z ->
      seen (log_after p (past ++ [Move k q])) i = Some z).
    { intros i z. rewrite log_after_snoc. unfold seen. simpl. intros E.
      rewrite map_app, app_comm_cons, nth_error_app1; auto. apply nth_error_Some. congruence. }
    destruct (IH (past ++ [Move k q]) (onward m (k, q)) s rho' y0) as (ev & rss & Lf & Dec & All); auto.
    + rewrite log_after_snoc. exact Walk'.
    + rewrite map_after_snoc. apply (true_sketch_grows (log_after p past)); auto.
      intros i z. rewrite log_after_snoc. unfold door. simpl. intros E.
      rewrite map_app, nth_error_app1; auto. apply nth_error_Some. congruence.
    + rewrite map_after_snoc. exact CM.
    + intros d o I. destruct (Places d o I) as (f & (n & F) & Lo). exists f. split; auto. exists n.
      apply table_of_find. apply table_of_spec in F. exact (Seen _ _ F).
    + exists ev, rss. split; auto. split; [exact Dec|]. intros before e after E De Fo.
      destruct before as [|z b]; injection E as <- E; [discriminate|].
      unfold reasoned. rewrite decisions_cons. apply (All b e after E De (Shift b e Fo)).
Qed.

(** Claim 10: wherever some world shows a log, the checker accepts evidence in which every decision has
    reasons that follows from the events before it, if what was drawn before it follows, too.
    Not in the paper. *)
Theorem decided_accepts p es W : world W -> replays W (log_after p es) -> few_visits (log_after p es) ->
  exists ev rss, decided p es ev rss = true /\
  forall before e after, es = before ++ e :: after -> is_decision e = true -> event_follows p before e ->
    (forall b x c, before = b ++ x :: c -> draws x = true -> event_follows p b x) ->
    reasoned rss (decisions before).
Proof.
  intros HW R Few. apply replays_visits in R as [v V]; [|apply HW].
  assert (V1 := visits_past W v p [] es V). assert (Few1 := few_past p [] es Few).
  change (log_after p []) with {| start := p; moves := [] |} in V1, Few1.
  destruct (shown_possible W _ HW (visits_replays W _ v V1)) as [Legal Pos].
  destruct (proj1 (legal_spec _ Legal)) as (d0 & S0). unfold seen in S0. simpl in S0. injection S0 as S0.
  destruct (proj1 (proj2 (legal_spec _ Legal)) 0 d0 (Some 0)) as [Pd _];
    [unfold seen; simpl; rewrite S0; reflexivity|].
  assert (NoC := proj2 (conflict_found_iff _ [] Few1 Legal (nothing_recorded _)) Pos).
  destruct (markers_right _ [] Few1 Legal NoC) as [Rk Mk].
  destruct (decided_from_accepts p W v es HW [] (outset p) (first_sketch p) rank_0 1%positive)
    as (ev & rss & _ & Dec & All); auto.
  - split; auto; [apply outset_true| |apply Pos.le_refl].
    intros s q q' _ B. unfold both_before in B. apply andb_true_iff in B as [B _].
    apply Pos.ltb_lt in B. lia.
  - apply first_sketch_true.
  - apply connected_initial. rewrite S0. auto.
  - intros d q I. apply (seen_from_recorded {| start := p; moves := [] |} 0
      (fst p) (1%positive, 0) d); auto.
    unfold has_degree, sights, table_of. simpl. destruct p as (d', n). simpl. apply Nat.eqb_refl.
  - exists ev, rss. split; [exact Dec|]. intros before e after E De Fo Drawn.
    apply (All before e after E De). split; auto.
Qed.
