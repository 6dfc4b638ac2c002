(** The list of all worlds with m edges (docs/semantics.md, section 12): every rooted map exactly once.

    M, W   the map so far, a world          e, h    darts: the least open dart, its partner
    u      how many darts are open          r       how many darts are still to be created
    n      how many edges are still to come s, ss   a growth step, growth steps
    j      the place of a partner among the other open darts     d    the degree of a new vertex

    A map grows from its first vertex as in Augment.v. The least open dart gets a partner: another open
    dart, or the first dart of a new vertex. What can follow depends on u and r only, so [growths] lists
    the sequences of steps by n, u and r alone; a map with darts to create but no open dart is a dead
    end, and has no sequence. SCEPTICS READ the definitions up to [listed]. *)
From Coq Require Import Arith Lia List Bool.
Import ListNotations.
From Topo Require Import World Rotation Embedding Augment Log AnyWorld.

(** A growth step at the least open dart: it meets the j-th of the other open darts, or a new vertex of
    degree d hangs on it. *)
Inductive growth := Meet (j : nat) | Hang (d : nat).

(** The open darts, in ascending order. *)
Definition open_darts M := filter (fun d => negb (explored M d)) (seq 0 (darts M)).

(** The map after a growth step. *)
Definition grown M s := match open_darts M with
  | [] => M
  | e :: rest => match s with
                 | Meet j => augment_loop M e (nth j rest e) | Hang d => augment_new M e d end end.

(** The steps from a map with u + 1 open darts and r darts to create, in their order: first partners, by
    place; then new vertices, by degree. *)
Definition growths_next u r := map Meet (seq 0 u) ++ map Hang (seq 1 r).

(** All sequences of n steps from a map with u open darts that create r darts and leave none open. *)
Fixpoint growths n u r : list (list growth) := match n, u with
  | 0, 0 => if r =? 0 then [[]] else []
  | S n, S u => flat_map (fun s => map (cons s) match s with
      | Meet _ => growths n (u - 1) r | Hang d => growths n (u + d - 1) (r - d) end) (growths_next u r)
  | _, _ => [] end.

(** The plans of all maps with m edges: the degree of the first vertex, ascending, and the steps. *)
Definition plans m := flat_map (fun d => map (pair d) (growths m d (2 * m - d))) (seq 1 (2 * m)).

(** The map of a plan. *)
Definition planned (plan : nat * list growth) := fold_left grown (snd plan) (initial (fst plan)).

(** The list of all worlds with m edges. The only one without an edge is the point. *)
Definition listed m := match m with 0 => [Point] | _ => map (fun p => Edges (planned p)) (plans m) end.

(** The number of edges of any world. *)
Definition edge_count w := match w with Point => 0 | Edges W => darts W / 2 end.

(** How many sequences there are: the recurrence of the closed formula, n being (u + r) / 2. *)
Fixpoint completions n u r := match n, u with
  | 0, 0 => if r =? 0 then 1 else 0
  | S n, S u => u * completions n (u - 1) r +
      list_sum (map (fun d => completions n (u + d - 1) (r - d)) (seq 1 r))
  | _, _ => 0 end.

(** The length of a list of lists, one after the other. *)
Lemma flat_map_sum {A B} (f : A -> list B) l : 
  length (flat_map f l) = list_sum (map (fun x => length (f x)) l).
Proof. induction l as [|x l IH]; simpl; auto. rewrite app_length, IH. auto. Qed.

(** The formula counts the sequences. *)
Lemma growths_length n : forall u r, length (growths n u r) = completions n u r.
Proof.
  induction n as [|n IH]; intros [|u] r; simpl; auto; [destruct (r =? 0); auto|].
  rewrite flat_map_sum. unfold growths_next. rewrite map_app, list_sum_app, !map_map. f_equal.
  - rewrite (map_ext _ (fun _ => completions n (u - 1) r)) by (intros j; rewrite map_length; auto).
    rewrite <- (seq_length u 0) at 2. induction (seq 0 u) as [|j l IHl]; simpl; auto.
  - f_equal. apply map_ext. intros d. rewrite map_length. auto.
Qed.

(** There are F(1, 2m - 1) + ... + F(2m, 0) worlds with m > 0 edges, where
    F(u, r) = (u - 1) F(u - 2, r) + the sum of F(u + d - 2, r - d) over 1 <= d <= r; F(0, 0) = 1, and
    F(0, r) = 0 for r > 0.
    Not in the paper. *)
Theorem listed_length m : length (listed m) = match m with
  | 0 => 1 | _ => list_sum (map (fun d => completions m d (2 * m - d)) (seq 1 (2 * m))) end.
Proof.
  destruct m as [|m]; auto. unfold listed, plans. rewrite map_length, flat_map_sum. f_equal.
  apply map_ext. intros d. rewrite map_length. apply growths_length.
Qed.

(** A step in its order. *)
Lemma in_growths_next s u r : In s (growths_next u r) <->
  match s with Meet j => j < u | Hang d => 1 <= d <= r end.
Proof.
  unfold growths_next. rewrite in_app_iff, !in_map_iff. split.
  - intros [(x & <- & I)|(x & <- & I)]; apply in_seq in I; lia.
  - destruct s as [j|d]; intros L; [left; exists j|right; exists d]; (split; [auto|apply in_seq; lia]).
Qed.

(** The sequences by their first step. *)
Lemma in_growths n u r ss : In ss (growths (S n) u r) <-> exists s rest v, ss = s :: rest /\ u = S v /\
  In s (growths_next v r) /\
  In rest match s with Meet _ => growths n (v - 1) r | Hang d => growths n (v + d - 1) (r - d) end.
Proof.
  split.
  - destruct u as [|v]; [intros []|]. intros I. apply in_flat_map in I as (s & I & J).
    apply in_map_iff in J as (rest & <- & J). exists s, rest, v. auto.
  - intros (s & rest & v & -> & -> & I & J). apply in_flat_map. exists s.
    split; [auto|]. apply in_map, J.
Qed.

(** The open darts are those that are not explored. *)
Lemma in_open_darts M d : In d (open_darts M) <-> d < darts M /\ alpha M d = None.
Proof.
  unfold open_darts, explored. rewrite filter_In, in_seq.
  destruct (alpha M d); simpl; intuition; discriminate.
Qed.

(** No dart is listed twice. *)
Lemma open_darts_once M : NoDup (open_darts M).
Proof. apply NoDup_filter, seq_NoDup. Qed.

(** Each dart is open or known. *)
Lemma open_darts_length M : length (open_darts M) + known M = darts M.
Proof.
  unfold open_darts, known. generalize (explored M) as p. intros p. induction (darts M) as [|n IH]; auto.
  rewrite seq_S, filter_app, app_length. simpl. destruct (p n); simpl; lia.
Qed.

(** The map M has u open darts. *)
Definition has_open M u := is_map M /\ connected M /\ length (open_darts M) = u.

(** The parts of a map with an open dart. *)
Lemma has_open_first M v : has_open M (S v) -> exists e rest, open_darts M = e :: rest /\
  length rest = v /\ e < darts M /\ alpha M e = None /\
  forall j, j < v -> let h := nth j rest e in h < darts M /\ alpha M h = None /\ h <> e.
Proof.
  intros (_ & _ & L). destruct (open_darts M) as [|e rest] eqn:E; [discriminate|]. exists e, rest.
  assert (O := open_darts_once M). rewrite E in O. apply NoDup_cons_iff in O as [N _].
  simpl in L. injection L as L. assert (He : In e (open_darts M)) by (rewrite E; simpl; auto).
  apply in_open_darts in He as [He Oe]. split; [auto|split; [auto|split; [auto|split; [auto|]]]].
  intros j Lj h. assert (I : In h rest) by (apply nth_In; lia).
  assert (J : In h (open_darts M)) by (rewrite E; simpl; auto). apply in_open_darts in J as [Lh Oh].
  split; [auto|split; [auto|]]. intros Q. rewrite Q in I. auto.
Qed.

(** After a partner two darts less are open. *)
Lemma has_open_meet M v j : has_open M (S v) -> j < v -> has_open (grown M (Meet j)) (v - 1) /\
  darts (grown M (Meet j)) = darts M.
Proof.
  intros H L. destruct (has_open_first M v H) as (e & others & Eo & Lo & He & Oe & R).
  destruct H as (WM & CM & Len). assert (A := open_darts_length M). unfold grown. rewrite Eo.
  destruct (R j L) as (Hh & Oh & N). assert (K := loop_two_more M e _ He Hh N Oe Oh).
  assert (B := open_darts_length (augment_loop M e (nth j others e))). simpl darts in *.
  split; [split; [apply is_map_loop; auto|split; [apply connected_loop; auto|lia]]|auto].
Qed.

(** After a new vertex of degree d one dart is closed, and d - 1 are open. *)
Lemma has_open_hang M v d : has_open M (S v) -> 0 < d -> has_open (grown M (Hang d)) (v + d - 1) /\
  darts (grown M (Hang d)) = darts M + d.
Proof.
  intros H L. destruct (has_open_first M v H) as (e & others & Eo & Lo & He & Oe & R).
  destruct H as (WM & CM & Len). assert (A := open_darts_length M). unfold grown. rewrite Eo.
  assert (K := new_two_more M e d He Oe L).
  assert (B := open_darts_length (augment_new M e d)). simpl darts in *.
  split; [split; [apply is_map_new; auto|split; [apply connected_new; auto|lia]]|auto].
Qed.

(** The map after a listed step: what is open there, and what follows. *)
Lemma has_open_grown n M v r s rest : has_open M (S v) -> In (s :: rest) (growths (S n) (S v) r) ->
  exists u q, has_open (grown M s) u /\ In rest (growths n u q) /\ darts (grown M s) + q = darts M + r /\
  match s with
  | Meet j => j < v /\ u = v - 1 /\ q = r
  | Hang d => 1 <= d <= r /\ u = v + d - 1 /\ q = r - d end.
Proof.
  intros H I. apply in_growths in I as (s' & rest' & v' & Q & V & L & I). injection Q as <- <-.
  injection V as <-. apply in_growths_next in L. destruct s as [j|d].
  - destruct (has_open_meet M v j H L) as [K D]. exists (v - 1), r. rewrite D. auto 7.
  - destruct (has_open_hang M v d H) as [K D]; [lia|]. exists (v + d - 1), (r - d).
    split; [auto|split; [auto|split; [lia|auto]]].
Qed.

(** A first vertex has all its darts open. *)
Lemma has_open_initial d : 0 < d -> has_open (initial d) d.
Proof.
  intros L. split; [apply is_map_initial; auto|split; [apply connected_initial; auto|]].
  assert (A := open_darts_length (initial d)). unfold known in A. simpl darts in A.
  replace (count (explored (initial d)) d) with 0 in A; [lia|]. clear. induction d as [|d IH]; auto.
Qed.

(** The map is embedded in what it becomes by a step, dart by dart. *)
Lemma embedded_grown M s : is_map M -> embedded M (grown M s) (fun x => x).
Proof.
  intros WM. unfold grown. assert (R := root_lt M WM). assert (L := sigma_lt M WM).
  destruct (open_darts M) as [|e rest] eqn:E; [split; auto|].
  assert (O : forall x, In x (e :: rest) -> alpha M x = None)
    by (intros x I; rewrite <- E in I; apply in_open_darts in I; apply I).
  destruct s as [j|d]; (split; simpl; auto; unfold grow, join).
  - intros x y Hx Hy. assert (A := O e (or_introl eq_refl)). assert (B : alpha M (nth j rest e) = None).
    { apply O. destruct (nth_in_or_default j rest e) as [I| ->]; simpl; auto. }
    cases; congruence.
  - intros x Hx. lia.
  - intros x Hx. specialize (L x Hx). cases.
  - intros x y Hx Hy. assert (A := O e (or_introl eq_refl)). cases; try congruence.
Qed.

(** One embedding after the other. *)
Lemma embedded_after A B C phi psi : embedded A B phi -> embedded B C psi ->
  embedded A C (fun x => psi (phi x)).
Proof.
  intros [E1 E2 E3 E4 E5] [F1 F2 F3 F4 F5]. split; auto; try congruence.
  intros d Hd. rewrite E3, F3; auto.
Qed.

(** All steps of a sequence keep the map well formed and connected, and embed it; at the end nothing is
    open, and r darts are created. *)
Lemma growths_right n : forall M u r ss, has_open M u -> In ss (growths n u r) ->
  let W := fold_left grown ss M in world W /\ darts W = darts M + r /\ embedded M W (fun x => x).
Proof.
  induction n as [|n IH]; intros M u r ss H I.
  - destruct u; [|destruct I]. simpl in I. destruct (Nat.eqb_spec r 0) as [->|]; [|destruct I].
    destruct I as [<-|[]]. destruct H as (WM & CM & L). simpl.
    split; [split; auto|split; [lia|split; auto]]. intros d Hd Od.
    apply length_zero_iff_nil in L. assert (J : In d (open_darts M)) by (apply in_open_darts; auto).
    rewrite L in J. destruct J.
  - assert (J := I). apply in_growths in J as (s & rest & v & -> & -> & _ & _).
    destruct (has_open_grown n M v r s rest H I) as (u & q & K & J & D & _).
    destruct (IH _ _ _ _ K J) as (A & B & C). simpl. split; [exact A|split; [lia|]].
    apply (embedded_after _ _ _ _ _ (embedded_grown M s (proj1 H)) C).
Qed.

(** The plans are the degrees of the first vertex, each with a sequence. *)
Lemma in_plans m d ss : In (d, ss) (plans m) <-> 1 <= d <= 2 * m /\ In ss (growths m d (2 * m - d)).
Proof.
  unfold plans. rewrite in_flat_map. split.
  - intros (x & I & J). apply in_map_iff in J as (y & Q & J). injection Q as <- <-. apply in_seq in I.
    split; [lia|auto].
  - intros [L I]. exists d. split; [apply in_seq; lia|apply in_map; auto].
Qed.

(** Every listed world is a world with m edges.
    Not in the paper. *)
Theorem listed_world m w : In w (listed m) -> edge_count w = m /\
  match w with Point => True | Edges W => world W end.
Proof.
  destruct m as [|m]; [intros [<-|[]]; auto|]. intros I. apply in_map_iff in I as ((d, ss) & <- & I).
  apply in_plans in I as [L I].
  destruct (growths_right _ _ _ _ _ (has_open_initial d ltac:(lia)) I) as (A & B & _).
  split; [|exact A]. unfold edge_count, planned. simpl fst. simpl snd. rewrite B. simpl darts.
  replace (d + (2 * S m - d)) with (S m * 2) by lia. apply Nat.div_mul. lia.
Qed.
