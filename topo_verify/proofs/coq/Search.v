(** Breadth-first search on the map: a path policy that fulfils [good_path] and [short_path]
    (docs/semantics.md, sections 4 and 5).

    M is a map, p the dart where the search begins, e the dart that is looked for. A vertex that
    was found is a pair: its dart x, and the doors that lead from p to x. *)
From Coq Require Import Arith Lia List Bool.
Import ListNotations.
From Topo Require Import World Rotation Vertices Augment Mapper.

(** The neighbours of a vertex that was found, with the doors that lead there. *)
Definition steps M (x : nat * list nat) :=
  flat_map (fun k => match move M (fst x) k with Some y => [(y, snd x ++ [k])] | None => [] end)
           (seq 0 (degree M (fst x))).

(** The first neighbour, in order of discovery, whose vertex was not found before. *)
Definition next M seen :=
  find (fun y => negb (existsb (fun x => at_vertex M (fst x) (fst y)) seen)) (flat_map (steps M) seen).

(** Add such neighbours until there are none, at most fuel times. *)
Fixpoint bfs M fuel seen :=
  match fuel with
  | 0 => seen
  | S fuel => match next M seen with Some x => bfs M fuel (seen ++ [x]) | None => seen end
  end.

(** The darts of a vertex that was found, each with the doors to the vertex and the last turn. *)
Definition exits M (x : nat * list nat) :=
  map (fun k => (snd x, k, turn M k (fst x))) (seq 0 (degree M (fst x))).

(** The doors from p to the vertex of e, and the turn from where they end to e. *)
Definition bfs_path M p e :=
  match find (fun y => snd y =? e) (flat_map (exits M) (bfs M (darts M) [(p, [])])) with
  | Some y => fst y | None => ([], 0) end.

Section Search.
Variables (M : Map) (p : nat).
Hypotheses (WM : is_map M) (Hp : p < darts M).

(** The invariant of the search: the vertices found are pairwise different; p is one of them;
    their doors lead to them; and each has fewer doors than there are vertices found. *)
Record good_seen (seen : list (nat * list nat)) : Prop := {
  s_apart : NoDup (map (fun x => first_dart M (fst x)) seen);
  s_start : exists x, In x seen /\ fst x = p;
  s_walk : forall x, In x seen -> fst x < darts M /\ walk M p (snd x) = Some (fst x);
  s_short : forall x, In x seen -> length (snd x) < length seen }.

(** The invariant holds for p alone. *)
Lemma good_seen_start : good_seen [(p, [])].
Proof.
  split; simpl.
  - constructor; [intros []|constructor].
  - eauto.
  - intros x [<-|[]]. auto.
  - intros x [<-|[]]. auto.
Qed.

(** The search finds at most as many vertices as the map has. *)
Lemma seen_le seen : good_seen seen -> length seen <= vertices M.
Proof.
  intros G. rewrite <- (map_length fst). apply vertices_most.
  - intros a I. apply in_map_iff in I as (x & <- & I). apply (s_walk _ G x I).
  - rewrite map_map. apply G.
Qed.

(** Adding a neighbour keeps the invariant. *)
Lemma next_good seen y : good_seen seen -> next M seen = Some y -> good_seen (seen ++ [y]).
Proof.
  intros G F. apply find_some in F as [Hy F]. apply negb_true_iff in F.
  assert (Y : (fst y < darts M /\ walk M p (snd y) = Some (fst y)) /\ length (snd y) <= length seen).
  { apply in_flat_map in Hy as (x & Hx & Hy). apply in_flat_map in Hy as (k & _ & Hy).
    assert (Sx := s_short _ G x Hx). apply (s_walk _ G) in Hx as [Lx Wx].
    destruct (move M (fst x) k) as [b|] eqn:Em; [destruct Hy as [<-|[]]|destruct Hy].
    simpl. rewrite app_length, walk_app, Wx. simpl. rewrite Em.
    repeat split; [eapply move_lt; eauto|lia]. }
  destruct Y as [Y Sy]. split.
  - rewrite map_app. apply (NoDup_Add (a := first_dart M (fst y)) (l := map (fun x => first_dart M
      (fst x)) seen)).
    + rewrite <- (app_nil_r (map _ seen)) at 1. apply Add_app.
    + split; [apply G|]. rewrite in_map_iff. intros (x & Ex & Hx).
      apply (first_dart_eq M WM) in Ex; [|apply (s_walk _ G x Hx)|apply Y].
      assert (H : existsb (fun x => at_vertex M (fst x) (fst y)) seen = true); [|congruence].
      apply existsb_exists. eauto.
  - destruct (s_start _ G) as (x & Hx & E). exists x. split; auto. apply in_or_app. auto.
  - intros x H. apply in_app_or in H as [H|[<-|[]]]; auto. apply (s_walk _ G x H).
  - intros x H. rewrite app_length. simpl. apply in_app_or in H as [H|[<-|[]]]; [|lia].
    apply (s_short _ G) in H. lia.
Qed.

(** With fuel for all darts the search ends: no neighbour is left, and the invariant holds. *)
Lemma search_good fuel : forall seen, good_seen seen -> darts M <= fuel + length seen ->
  good_seen (bfs M fuel seen) /\ next M (bfs M fuel seen) = None.
Proof.
  assert (V := vertices_le M WM).
  induction fuel as [|fuel IH]; simpl; intros seen G L; destruct (next M seen) as [y|] eqn:F; auto.
  - apply next_good, seen_le in F; auto. rewrite app_length in F. simpl in F. lia.
  - apply IH; [apply next_good; auto|]. rewrite app_length. simpl. lia.
Qed.

(** If no neighbour is left, every dart that can be reached is at a vertex that was found. *)
Lemma search_covers seen d : good_seen seen -> next M seen = None -> reach M p d ->
  exists x k, In x seen /\ k < degree M (fst x) /\ turn M k (fst x) = d.
Proof.
  intros G F.
  assert (Key : forall x q, In x seen -> at_vertex M (fst x) q = true ->
    exists x k, In x seen /\ k < degree M (fst x) /\ turn M k (fst x) = q).
  { intros x q Hx A. unfold at_vertex in A. apply existsb_exists in A as (k & Hk & E).
    apply in_seq in Hk. apply Nat.eqb_eq in E. exists x, k. repeat split; auto. lia. }
  induction 1 as [|d Hd (x & k & Hx & Hk & <-)|d e Hd (x & k & Hx & Hk & <-) He].
  - destruct (s_start _ G) as (x & Hx & <-). exists x, 0. repeat split; auto.
    apply degree_spec; auto.
  - assert (Lx := proj1 (s_walk _ G x Hx)). apply (Key x); auto.
    apply (at_vertex_iff M WM); auto. exists (S k). auto.
  - assert (Lx := proj1 (s_walk _ G x Hx)).
    assert (Q := find_none _ _ F (e, snd x ++ [k])). simpl in Q.
    rewrite negb_false_iff, existsb_exists in Q. destruct Q as (y & Hy & Ey); eauto.
    apply in_flat_map. exists x. split; auto. apply in_flat_map. exists k.
    split; [apply in_seq; lia|]. unfold move.
    rewrite (proj2 (Nat.ltb_lt _ _) Hk), He. simpl; auto.
Qed.
End Search.

(** The ways of breadth-first search lead to their dart and are shorter than the number of
    vertices. *)
Theorem bfs_path_good : good_path bfs_path /\ short_path bfs_path.
Proof.
  enough (H : forall M p e, is_map M -> connected M -> p < darts M -> e < darts M ->
    (exists q, walk M p (fst (bfs_path M p e)) = Some q /\ snd (bfs_path M p e) < degree M q /\
     turn M (snd (bfs_path M p e)) q = e) /\ length (fst (bfs_path M p e)) < vertices M).
  { split; intros M p e WM CM Hp He; apply H; auto. }
  intros M p e WM CM Hp He. unfold bfs_path.
  destruct (search_good M p WM Hp (darts M) [(p, [])]) as [G F]; [|simpl; lia|].
  { apply good_seen_start; auto. }
  assert (R : reach M p e).
  { apply reach_trans with (root M).
    - apply (reach_sym M (root M) p); auto. apply root_lt; auto.
    - apply CM; auto. }
  destruct (find _ _) as [y|] eqn:Y.
  - apply find_some in Y as [Hy Ey]. apply Nat.eqb_eq in Ey.
    apply in_flat_map in Hy as (x & Hx & Hy). apply in_map_iff in Hy as (k & <- & Hk).
    apply in_seq in Hk. simpl in *. split.
    + exists (fst x). repeat split; auto; [apply (s_walk _ _ _ G); auto|lia].
    + apply (s_short _ _ _ G) in Hx. apply (seen_le M) in G. lia.
  - exfalso. destruct (search_covers M p WM Hp _ e G F R) as (x & k & Hx & Hk & Ex).
    assert (Q := find_none _ _ Y (snd x, k, e)). simpl in Q. rewrite Nat.eqb_refl in Q.
    discriminate Q. apply in_flat_map. exists x. split; auto.
    apply in_map_iff. exists k. rewrite Ex. split; auto. apply in_seq. lia.
Qed.
