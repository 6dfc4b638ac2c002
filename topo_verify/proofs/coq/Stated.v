(** Every true statement about a log, within the limits of the format, has numbers that the check
    accepts (claims 9 and 10).

    p     the percept at the start       es    the events         D     the delivered map, if any
    L     the log of the moves           W     a world that shows it
    t     a table                        psi   the numbering of the delivered map

    The limits: numbers of the events are at most a million; the degrees that the log shows add up to
    less than a million; fewer than 2^40 visits. Then tables are small enough: each dart of the map was
    seen. SCEPTICS READ [log_size], [short] and, in Writing.v, [event_limit] and what it uses. *)
From Coq Require Import Arith Lia List NArith Bool.
Import ListNotations.
From Topo Require Import World Rotation Embedding Log AnyWorld Determined Undetermined Classes Quotient
  Entailed Table TableCorrect Numbered Checker CheckerCorrect Saturated Conflicts Accepted Events
  Decisions DecisionsAccepted Delivered Certificate Writing.

(** How many doors the log shows: the degrees at its visits, added up. *)
Definition log_size L := list_sum (map fst (sights L)).

(** The log is within the limits. *)
Definition short p es := percept_limit p /\ Forall event_limit es /\
  few_visits (log_after p es) /\ (N.of_nat (log_size (log_after p es)) < 1000000)%N.

(** All places of a log, visit by visit. *)
Definition places_shown L : list place :=
  flat_map (fun i => map (pair i) (seq 0 (fst (nth i (sights L) (0, None)))))
    (seq 0 (length (sights L))).

(** There are as many as the log shows doors. *)
Lemma places_shown_length L : length (places_shown L) = log_size L.
Proof.
  unfold places_shown, log_size. generalize (sights L) as l. intros l.
  assert (G : forall (f : nat -> nat) n, length (flat_map (fun i => map (pair i) (seq 0 (f i))) n) =
    list_sum (map f n)).
  { intros f n. induction n as [|i n IH]; simpl; auto.
    rewrite app_length, map_length, seq_length, IH. auto. }
  rewrite G. f_equal. induction l as [|x l IH]; simpl; auto. f_equal. rewrite <- IH.
  rewrite <- seq_shift, map_map. auto.
Qed.

(** If every dart of a map is a place of the log, it has no more darts than the log shows doors. *)
Lemma few_darts M L v : is_map M -> visits M L v ->
  (forall d, d < darts M -> exists p, valid L p /\ dart M v p = d) -> darts M <= log_size L.
Proof.
  intros WM V Onto. rewrite <- places_shown_length, <- (seq_length (darts M) 0).
  rewrite <- (map_length (dart M v) (places_shown L)). apply NoDup_incl_length; [apply seq_NoDup|].
  intros d I. apply in_seq in I. destruct (Onto d) as ((i, k) & P & <-); [lia|].
  unfold valid in P. simpl in P. destruct (seen L i) as [(g, j)|] eqn:S; [|destruct P; auto].
  assert (Li : i < length (sights L)) by (apply nth_error_Some; unfold seen, sights in *; congruence).
  assert (Lv := v_lt M L v V i).
  assert (Dg : degree M (v i) = g).
  { assert (Q := v_seen M L v V i (g, j) S). injection Q as Q _. auto. }
  destruct (degree_spec M WM (v i) Lv) as (Pd & _).
  apply in_map_iff. exists (i, k mod g). unfold dart. simpl. split.
  - rewrite <- Dg. apply turn_mod; auto.
  - assert (E : fst (nth i (sights L) (0, None)) = g)
      by (unfold seen in S; rewrite (nth_error_nth (sights L) i (0, None) S); auto).
    apply in_flat_map. exists i. split; [apply in_seq; lia|]. rewrite E. apply in_map, in_seq.
    split; [lia|]. apply Nat.mod_upper_bound. lia.
Qed.

(** A right table that is small enough is within the limits. *)
Lemma small_table t : check_table t = true -> (N.of_nat (length t) < 1000000)%N -> table_limit t.
Proof.
  intros C L. destruct (check_table_spec t C) as [WT _]. unfold check_table in C.
  apply andb_true_iff in C as [_ C]. rewrite forallb_forall in C.
  assert (Rows : forall d, d < length t -> check_row t (length t) d = true)
    by (intros d Hd; apply C, in_seq; lia).
  apply Forall_forall. intros r I. destruct (In_nth t r (0, 0, None) I) as (d & Hd & E).
  assert (Prev : snd (fst r) < length t).
  { destruct (degree_spec (map_of t) WT d Hd) as (P & Full & _).
    set (c := turn (map_of t) (degree (map_of t) d - 1) d).
    assert (Lc : c < length t) by (apply (turn_lt (map_of t) WT _ d Hd)).
    assert (Sc : sigma (map_of t) c = d).
    { unfold c. change (turn (map_of t) (S (degree (map_of t) d - 1)) d = d).
      replace (S (degree (map_of t) d - 1)) with (degree (map_of t) d) by lia. auto. }
    specialize (Rows c Lc). unfold check_row in Rows. simpl in Sc.
    destruct (row t c) as ((s, q), x). simpl in Sc. subst s. rewrite !andb_true_iff in Rows.
    destruct Rows as (((_ & Q) & _) & _). apply Nat.eqb_eq in Q. unfold row in Q. rewrite E in Q. lia. }
  specialize (Rows d Hd). unfold check_row, row in Rows. rewrite E in Rows. destruct r as ((s, q), x).
  rewrite !andb_true_iff in Rows. destruct Rows as (((A & _) & B) & _). apply Nat.ltb_lt in A.
  simpl in Prev. unfold both, in_limit, optional_limit, in_limit. simpl. split; [lia|].
  destruct x as [e|]; auto. rewrite !andb_true_iff in B. destruct B as ((B & _) & _).
  apply Nat.ltb_lt in B. lia.
Qed.

(** Without reasons the check of the decisions accepts. *)
Lemma nothing_reasoned p es : decided p es [] [] = true.
Proof.
  unfold decided. generalize (outset p) as m. induction es as [|e es IH]; intros m; simpl; auto.
  destruct (is_decision e); auto.
Qed.

(** The certificate of a log with a claim, the merges and reasons for its decisions. *)
Definition stating p es D x ev rss :=
  {| sensed := p; events := es; handed := D; claimed := x; merges := ev; reasons := rss |}.

(** If no world shows the log, with edges or not, numbers say so.
    Not in the paper. *)
Theorem absurd_stated p es D : short p es -> (forall w, ~ shows_log w (log_after p es)) -> exists c ev x,
  c = stating p es D (Absurd ev x) [] [] /\ check_numbers (write_certificate c) = true.
Proof.
  intros (A & B & Few & _) N. set (L := log_after p es) in *.
  exists (stating p es D (Absurd (saturating L []) (first_conflict L [])) [] []). do 2 eexists.
  split; [reflexivity|]. apply written_accepted.
  - split; [auto|split; [auto|simpl; auto]].
  - unfold accepts. simpl. unfold log_in. simpl. fold L. rewrite nothing_reasoned, andb_true_r.
    rewrite impossible_accepts by (auto; intros W HW R; apply (N (Edges W)); split; auto). simpl.
    apply negb_true_iff, not_true_iff_false. intros P. apply of_point_spec in P. apply (N Point P).
Qed.

(** Every decision among the events that follows, together with what is drawn before it, has reasons. *)
Definition with_reasons p es rss := forall before e after, es = before ++ e :: after ->
  is_decision e = true -> event_follows p before e ->
  (forall b x c, before = b ++ x :: c -> draws x = true -> event_follows p b x) ->
  reasoned rss (decisions before).

(** If two different worlds show the log, numbers say so, and give reasons for the decisions.
    Not in the paper. *)
Theorem undecided_stated p es D : short p es -> undetermined (log_after p es) -> exists c t mg rss,
  c = stating p es D (Undecided t) mg rss /\ check_numbers (write_certificate c) = true /\
  with_reasons p es rss.
Proof.
  intros (A & B & Few & Size) U. set (L := log_after p es) in *.
  destruct U as (W & W' & HW & HW' & R & R' & N).
  destruct (decided_accepts p es W HW R Few) as (mg & rss & Dec & Reasons).
  destruct (shown_possible W L HW R) as [_ P].
  apply possible_consistent in P; [|intros x y []].
  destruct (quotient_exists L nothing P) as (M & u & Q). assert (V := q_visits _ _ _ _ Q).
  destruct (table_with_rows M L) as (t & C & T & Len); try apply Q; [apply (visits_replays M L u), V|].
  assert (CT : check_table t = true) by (unfold check_map in C; apply andb_true_iff in C; apply C).
  exists (stating p es D (Undecided t) mg rss), t, mg, rss.
  split; [reflexivity|split; [|exact Reasons]]. apply written_accepted.
  - split; [auto|split; [auto|]]. apply small_table; auto. rewrite Len.
    assert (F := few_darts M L u (q_map _ _ _ _ Q) V (q_onto _ _ _ _ Q)). lia.
  - unfold accepts. simpl. unfold log_in. simpl. fold L. rewrite Dec, andb_true_r.
    unfold refute. rewrite C. simpl. apply negb_true_iff, not_true_iff_false. intros To.
    apply N. apply (closed_determines L); auto. intros x X.
    destruct (q_link _ _ _ _ Q x X) as (q & r & K & S & _); [|eauto].
    apply (proj1 T To), turn_lt; [apply Q|]. apply (v_lt M L u V).
Qed.

(** The numbering of the delivered map can be cut to one pair a dart, each within the limits. *)
Lemma short_numbering D t psi : check_delivery D t psi = true -> (N.of_nat (length t) < 1000000)%N ->
  exists chi, check_delivery D t chi = true /\ Forall (both in_limit in_limit) chi.
Proof.
  intros C L. set (n := darts (delivered_map D)).
  exists (map (fun d => nth d psi (0, 0)) (seq 0 n)).
  assert (Nth : forall d, d < n ->
    nth d (map (fun d => nth d psi (0, 0)) (seq 0 n)) (0, 0) = nth d psi (0, 0)).
  { intros d Hd. rewrite (nth_indep _ _ ((fun d => nth d psi (0, 0)) 0))
      by (rewrite map_length, seq_length; auto).
    rewrite (map_nth (fun d => nth d psi (0, 0))), seq_nth by auto. auto. }
  unfold check_delivery in *. fold n in C |- *. rewrite !andb_true_iff in C.
  destruct C as (((((A & B) & S) & R) & Z) & F). rewrite forallb_forall in F. apply Nat.ltb_lt in R.
  split.
  - rewrite A, B, S, (proj2 (Nat.ltb_lt _ _) R). unfold ahead. rewrite Nth by exact R.
    fold (ahead psi (root (delivered_map D))). rewrite Z. simpl. apply forallb_forall. intros d I.
    specialize (F d I). apply in_seq in I. unfold check_dart in *. unfold ahead, backwards in *.
    rewrite !andb_true_iff in F. destruct F as ((((((F1 & F2) & F3) & F4) & F5) & F6) & F7).
    apply Nat.eqb_eq in S. simpl in S. fold n in F3, F5, F7 |- *.
    assert (L1 : fst (nth d psi (0, 0)) < n)
      by (apply Nat.ltb_lt in F1; simpl in F1; lia).
    assert (L3 := F3). apply Nat.ltb_lt in L3. assert (L5 := F5). apply Nat.ltb_lt in L5.
    rewrite (Nth d) by lia. rewrite (Nth (fst _)), (Nth (snd _)), (Nth (sigma _ _)) by auto.
    rewrite F1, F2, F3, F4, F5, F6. cbn [andb].
    destruct (alpha (delivered_map D) d) as [e|]; [|discriminate].
    destruct (alpha (map_of t) _) as [b|]; [|discriminate]. apply andb_true_iff in F7 as [G1 G2].
    rewrite Nth by (apply Nat.ltb_lt; exact G1). rewrite G1, G2. auto.
  - apply Nat.eqb_eq in S. apply Forall_forall. intros x I. apply in_map_iff in I as (d & <- & I).
    specialize (F d I). unfold check_dart, ahead, backwards in F. rewrite !andb_true_iff in F.
    destruct F as ((((((F1 & _) & F3) & _) & _) & _) & _). apply Nat.ltb_lt in F1, F3.
    fold n in F3. simpl in S, F1. unfold both, in_limit. lia.
Qed.

(** If the log proves its map W, numbers say so, and give reasons for the decisions; if the delivered map
    is right, and that is to be told, they tell it.
    Not in the paper. *)
Theorem proved_stated p es D W (told : bool) : short p es -> world W -> replays W (log_after p es) ->
  closed (log_after p es) -> (told = true -> exists d, D = Some d /\ right_delivery d W) ->
  exists c t ev psi mg rss,
  c = stating p es D (Proved t ev psi) mg rss /\ check_numbers (write_certificate c) = true /\
  (told = true -> psi <> None) /\ with_reasons p es rss.
Proof.
  intros (A & B & Few & Size) HW R C Told. set (L := log_after p es) in *.
  destruct (decided_accepts p es W HW R Few) as (mg & rss & Dec & Reasons).
  destruct (table_with_rows W L (world_is_map W HW) (world_connected W HW) R) as (t & CM & T & Len).
  assert (CT : check_table t = true) by (unfold check_map in CM; apply andb_true_iff in CM; apply CM).
  assert (Cert : certified L t (saturating L []) = true).
  { unfold certified. rewrite CM, (proves_accepts W L HW R Few C), (proj2 T (world_total W HW)). auto. }
  destruct (replays_visits W L (world_is_map W HW) R) as [v V].
  assert (Sz := few_darts W L v (world_is_map W HW) V (met W L v HW V C)).
  assert (St : (N.of_nat (length t) < 1000000)%N) by (rewrite Len; lia).
  assert (Row : exists r t', t = r :: t').
  { assert (Q := root_lt W (world_is_map W HW)). destruct t; [simpl in Len; lia|eauto]. }
  assert (Iso : world (map_of t) /\ isomorphic (map_of t) W).
  { apply certified_correct in Cert as (HT & _ & U). split; auto. }
  assert (Psi : exists psi, match psi, D with
      | None, _ => True | Some x, Some d => check_delivery d t x = true | Some _, None => False end /\
    if_there (Forall (both in_limit in_limit)) psi /\ (told = true -> psi <> None)).
  { destruct told; [|exists None; simpl; repeat split; auto; discriminate].
    destruct (Told eq_refl) as (d & -> & Rd).
    destruct (check_delivery_accepts d t W (proj1 Iso) (proj2 Iso) Rd) as (x & X).
    destruct (short_numbering d t x X St) as (y & Y & Ly). exists (Some y).
    split; [auto|split; [auto|discriminate]]. }
  destruct Psi as (psi & P1 & P2 & P3).
  exists (stating p es D (Proved t (saturating L []) psi) mg rss). do 5 eexists.
  split; [reflexivity|]. split; [|split; [exact P3|exact Reasons]]. apply written_accepted.
  - split; [auto|split; [auto|split; [apply small_table; auto|auto]]].
  - unfold accepts. simpl. unfold log_in. simpl. fold L. rewrite Dec, andb_true_r. unfold shown.
    destruct Row as (r & t' & Et). rewrite Et. rewrite <- Et, Cert. simpl.
    destruct psi as [x|]; auto. destruct D as [d|]; [|destruct P1]. unfold delivered. rewrite Et.
    rewrite <- Et. exact P1.
Qed.

(** If the log is that of the point, numbers say so.
    Not in the paper. *)
Theorem point_stated p es D (told : bool) : short p es -> shows_log Point (log_after p es) ->
  (told = true -> exists d, D = Some d /\ right_in d Point) -> exists c psi,
  c = stating p es D (Proved [] [] psi) [] [] /\ check_numbers (write_certificate c) = true /\
  (told = true -> psi <> None).
Proof.
  intros (A & B & _ & _) Sh Told.
  exists (stating p es D (Proved [] [] (if told then Some [] else None)) [] []).
  eexists. split; [reflexivity|split; [|destruct told; [discriminate|intros Q; discriminate Q]]].
  apply written_accepted.
  - split; [auto|split; [auto|]]. split; [constructor|]. destruct told; simpl; auto.
  - unfold accepts. simpl. unfold log_in. simpl. rewrite nothing_reasoned, andb_true_r.
    rewrite (proj2 (of_point_spec _) Sh). destruct told; auto.
    destruct (Told eq_refl) as (d & -> & E & Q). simpl. unfold no_dart. rewrite E, Q. auto.
Qed.
