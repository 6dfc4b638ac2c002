(** Decisions of a mapper: each must follow from the log as it was when it was made (claim 10;
    docs/mechanised.md).

    L is a log, d a decision, r the reason given for it; m is a moment of the walk along the log, ms
    the moves after it; ev is evidence; the other letters are those of Checker.v.

    The program walks the log once and folds it as it goes. For a rejection it assumes the edge,
    continues the fold to a conflict, and forgets that part again. The evidence is not trusted.
    The invariant of the walk is [true_moment]. SCEPTICS READ [decision] and [follows]. *)
From Coq Require Import Arith Lia List Bool PArith FMapPositive.
Import ListNotations.
From Topo Require Import World Log Determined Table Checker CheckerCorrect.

(** A decision at visit x: an edge leads from place p to place q, or none does. *)
Inductive decision := Leads (x : positive) (p q : pplace) | LeadsNot (x : positive) (p q : pplace).

(** Claim 10: the decision is true in every world that shows the log up to its visit. *)
Definition follows L d := match d with
  | Leads x p q => forall W v, world W -> visits W (cut L (num x)) v ->
      alpha W (dart W v (abs p)) = Some (dart W v (abs q))
  | LeadsNot x p q => forall W v, world W -> visits W (cut L (num x)) v ->
      alpha W (dart W v (abs p)) <> Some (dart W v (abs q)) end.

(** The visit at which the decision was made. *)
Definition visit d := match d with Leads x _ _ | LeadsNot x _ _ => x end.

(** The reason for a decision: this arc joins the two places; or the fold with an edge between
    them, continued by ev, has the conflict c. *)
Inductive reason := Joined (a : arc) | Refuted (ev : evidence) (c : conflict).

(** A moment of the walk: the visit, the percepts and edges up to it, and the union-find. *)
Record moment := { here : positive; sighted : PositiveMap.t Percept;
  crossed : PositiveMap.t (pplace * pplace); unified : unions }.

(** The moment at the start. *)
Definition outset L : moment := let T := table_of [start L] in
  {| here := 1; sighted := T; crossed := table_of []; unified := markers T [start L] |}.

(** The moment one move later: one more visit, one more edge, and a merge if the visit saw the
    marker. *)
Definition onward m (a : nat * Percept) := let y := Pos.succ (here m) in
  let T := PositiveMap.add y (snd a) (sighted m) in
  {| here := y; sighted := T;
     crossed := PositiveMap.add (here m) ((here m, fst a), (y, 0)) (crossed m);
     unified := match snd (snd a) with
       | Some j => unite T (unified m) (1%positive, 0) (y, j) | None => unified m end |}.

(** Walk on to visit x: the moment there, and the moves that are left. *)
Fixpoint advance x m ms := if Pos.eqb (here m) x then Some (m, ms) else
  match ms with [] => None | a :: ms => advance x (onward m a) ms end.

(** Do the merges whose arcs exist already at this moment: the moment after them, and the
    evidence that is left. *)
Fixpoint settle m (ev : evidence) := match ev with [] => (m, []) | s :: rest =>
  if Pos.ltb (snd (fst s)) (here m) && Pos.ltb (snd (snd s)) (here m) then
    settle {| here := here m; sighted := sighted m; crossed := crossed m;
              unified := glue (sighted m) (crossed m) (unified m) s |} rest
  else (m, ev) end.

(** The reason proves the decision at this moment. *)
Definition supported m d r := match d, r with
  | Leads _ p q, Joined a => check_partners (sighted m) (crossed m) (unified m) p q a
  | LeadsNot _ p q, Refuted ev c => let T := sighted m in
      let D := PositiveMap.add (here m) (p, q) (crossed m) in
      PositiveMap.mem (fst p) T && PositiveMap.mem (fst q) T &&
      check_conflict T D (fold_left (glue T D) ev (unified m)) c
  | _, _ => false end.

(** From this moment on, each reason proves its decision at its visit; the visits are in order. *)
Fixpoint decided_from m ms ev ds rs := match ds, rs with
  | [], [] => true
  | d :: ds, r :: rs => match advance (visit d) m ms with
      | Some (m, ms) => let (m, ev) := settle m ev in
          supported m d r && decided_from m ms ev ds rs
      | None => false end
  | _, _ => false end.

(** The check of the decisions ds of a log, with the merges ev of the log itself and a reason for
    each decision. *)
Definition decided L ev ds rs := decided_from (outset L) (moves L) ev ds rs.

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

(** The invariant of the walk: the tables at moment m are those of the log up to its visit, and
    the union-find is true of that log. *)
Definition true_moment L m ms := exists done, let P := {| start := start L; moves := done |} in
  moves L = done ++ ms /\ num (here m) = length done /\ sighted m = table_of (sights P) /\
  crossed m = table_of (edges P []) /\ true_uf P [] (unified m).

(** By the invariant the tables at m are those of [cut] at its visit. *)
Lemma true_moment_cut L m ms : true_moment L m ms -> let P := cut L (num (here m)) in
  num (here m) = length (moves P) /\ sighted m = table_of (sights P) /\
  crossed m = table_of (edges P []) /\ true_uf P [] (unified m).
Proof.
  intros (done & E & N & H). unfold cut. rewrite E, N, firstn_app, Nat.sub_diag, firstn_all.
  simpl. rewrite app_nil_r. auto.
Qed.

(** The invariant holds at the start. *)
Lemma outset_true L : true_moment L (outset L) (moves L).
Proof.
  exists []. do 4 (split; auto). apply (markers_sound {| start := start L; moves := [] |} []).
Qed.

(** One move keeps the invariant. *)
Lemma onward_true L m a ms : true_moment L m (a :: ms) -> true_moment L (onward m a) ms.
Proof.
  intros (done & E & N & HT & HD & HU). exists (done ++ [a]). intros P'.
  assert (Y : num (Pos.succ (here m)) = S (length done)) by (rewrite num_succ; auto).
  assert (T' : PositiveMap.add (Pos.succ (here m)) (snd a) (sighted m) = table_of (sights P')).
  { unfold sights, P'. simpl. rewrite HT, map_app, app_comm_cons.
    symmetry. apply table_of_snoc. simpl. rewrite map_length. auto. }
  assert (G : true_uf P' [] (unified m)).
  { eapply true_uf_grows; [| |exact HU]; unfold seen, door, P'; simpl; intros i s H;
      rewrite map_app, ?app_comm_cons, nth_error_app1; auto; apply nth_error_Some; congruence. }
  simpl. split; [rewrite E, <- app_assoc; auto|]. split; [rewrite app_length, Y; simpl; lia|].
  split; auto. split.
  - rewrite HD. unfold edges, P'. simpl. rewrite !app_nil_r, map_app.
    change (map fst [a]) with [fst a]. rewrite (enum_snoc _ 1 (here m)).
    + rewrite map_app. symmetry. apply table_of_snoc. rewrite map_length, enum_length, map_length. auto.
    + rewrite map_length, <- N. unfold num. rewrite Pos2Nat.inj_1.
      assert (Q := Pos2Nat.is_pos (here m)). lia.
  - destruct a as (k, (d, [j|])); simpl; auto. simpl in T'. rewrite T'. apply unite_sound; auto.
    apply marked_sound with d. rewrite Y. unfold seen, P'. simpl.
    rewrite map_app, nth_error_app2; rewrite map_length; [|lia]. rewrite Nat.sub_diag. auto.
Qed.

(** Walking on to visit x keeps the invariant and ends at x. *)
Lemma advance_true L x : forall ms m m' ms', true_moment L m ms -> advance x m ms = Some (m', ms') ->
  true_moment L m' ms' /\ here m' = x.
Proof.
  intros ms. induction ms as [|a ms IH]; simpl; intros m m' ms' H E;
    match type of E with (if ?b then _ else _) = _ => destruct b eqn:B end.
  1, 3: apply Pos.eqb_eq in B; injection E as <- <-; auto.
  - discriminate.
  - apply (IH (onward m a)); auto. apply onward_true, H.
Qed.

(** Merging keeps the invariant. *)
Lemma settle_true L ms ev : forall m, true_moment L m ms -> true_moment L (fst (settle m ev)) ms.
Proof.
  induction ev as [|s ev IH]; simpl; auto. intros m H. destruct (_ && _); auto.
  apply IH. destruct H as (done & E & N & HT & HD & HU). exists done. do 4 (split; auto).
  simpl. rewrite HT, HD. apply glue_sound; auto. intros p q [].
Qed.

(** Merging does not change the visit. *)
Lemma settle_here ev : forall m, here (fst (settle m ev)) = here m.
Proof.
  induction ev as [|s ev IH]; simpl; auto. intros m. destruct (_ && _); auto. rewrite IH. auto.
Qed.

(** Under the invariant, a decision with a reason that proves it follows from the log. *)
Lemma supported_follows L m ms d r : true_moment L m ms -> here m = visit d -> supported m d r = true ->
  follows L d.
Proof.
  intros H V. apply true_moment_cut in H as (N & HT & HD & HU). rewrite V in *.
  assert (Nil : forall a b, In (a, b) [] -> valid (cut L (num (visit d))) (abs a) /\
    valid (cut L (num (visit d))) (abs b)) by (intros a b []).
  unfold supported. rewrite V, HT, HD.
  destruct d as [x p q|x p q], r as [a|ev c]; try discriminate; simpl visit in *; intros C.
  - intros W v HW Vi. apply check_partners_sound in C as (r & s & K & A & B); auto.
    assert (F := fits_nothing W v). apply (same_sound W (cut L (num x)) v nothing HW Vi F) in A, B.
    rewrite A, B. apply (link_sound W (cut L (num x)) v nothing HW Vi F). auto.
  - apply andb_true_iff in C as [Kn C]. apply andb_true_iff in Kn as [P Q].
    assert (E : PositiveMap.add x (p, q) (table_of (edges (cut L (num x)) [])) =
      table_of (edges (cut L (num x)) [(p, q)])).
    { unfold edges. rewrite app_nil_r. symmetry. apply table_of_snoc.
      rewrite map_length, enum_length, map_length. auto. }
    rewrite E in C. intros W v. apply (assumed_edge_refuted (cut L (num x)) p q (unified m) ev c); auto.
    apply (true_uf_grows (cut L (num x))); auto.
Qed.

(** Claim 10: if [decided] accepts, each decision follows from the log up to its visit. *)
Theorem decided_correct L ev ds rs : decided L ev ds rs = true -> forall d, In d ds -> follows L d.
Proof.
  unfold decided. assert (H := outset_true L). revert H. generalize (outset L) (moves L).
  intros m ms. revert m ms ev rs. induction ds as [|d ds IH]; simpl; intros m ms ev rs H C e I;
    [destruct I|]. destruct rs as [|r rs]; [discriminate|].
  destruct (advance (visit d) m ms) as [(m1, ms1)|] eqn:R; [|discriminate].
  apply (advance_true L) in R as [H1 Eh]; auto.
  apply (settle_true L ms1 ev) in H1. assert (Sh := settle_here ev m1).
  destruct (settle m1 ev) as (m2, ev2). simpl in *. apply andb_true_iff in C as [S C].
  destruct I as [<-|I]; [|apply (IH m2 ms1 ev2 rs); auto].
  apply (supported_follows L m2 ms1 d r); auto. congruence.
Qed.
