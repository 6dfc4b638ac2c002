(** Counting the vertices of a map, each represented by its least dart (docs/semantics.md, section
    1).

    M is a map; a, b are darts; n is the number of vertices. *)
From Coq Require Import Arith Lia List Bool.
Import ListNotations.
From Topo Require Import World Rotation Embedding.

(** Is b a dart of the vertex of a? *)
Definition at_vertex M a b := existsb (fun k => turn M k a =? b) (seq 0 (degree M a)).

(** The least dart of the vertex of a. *)
Definition first_dart M a :=
  match find (at_vertex M a) (seq 0 (darts M)) with Some x => x | None => a end.

(** The number of vertices n: how many least darts there are. *)
Definition vertices M := length (nodup Nat.eq_dec (map (first_dart M) (seq 0 (darts M)))).

Section Vertices.
Variable M : Map.
Hypothesis WM : is_map M.

(** [at_vertex] decides whether b is a turn of a. *)
Lemma at_vertex_iff a b : a < darts M -> at_vertex M a b = true <-> exists k, turn M k a = b.
Proof.
  intros Ha. unfold at_vertex. rewrite existsb_exists. destruct (degree_spec M WM a Ha) as (D & _).
  split; [intros (k & _ & E)|intros (k & E)].
  - exists k. apply Nat.eqb_eq, E.
  - exists (k mod degree M a). split.
    + apply in_seq. assert (H := Nat.mod_upper_bound k (degree M a)). lia.
    + rewrite turn_mod by auto. apply Nat.eqb_eq, E.
Qed.

(** Every turn can be undone by another turn. *)
Lemma turn_back k a : a < darts M -> exists j, turn M j (turn M k a) = a.
Proof.
  intros Ha. destruct (degree_spec M WM a Ha) as (D & _).
  exists (degree M a * k - k). rewrite <- turn_add.
  replace (degree M a * k - k + k) with (k * degree M a) by nia.
  rewrite <- turn_mod, Nat.mod_mul by (auto || lia). auto.
Qed.

(** Darts of the same vertex have the same darts at their vertex. *)
Lemma at_vertex_eq a b x : a < darts M -> at_vertex M a b = true ->
  at_vertex M a x = at_vertex M b x.
Proof.
  intros Ha E. apply at_vertex_iff in E as (k & <-); auto. destruct (turn_back k a Ha) as (j & B).
  apply eq_true_iff_eq. rewrite !at_vertex_iff by auto using turn_lt. split; intros (i & <-).
  - exists (i + j). rewrite turn_add, B. auto.
  - exists (i + k). apply turn_add.
Qed.

(** The first dart of a's vertex is a dart of that vertex. *)
Lemma first_dart_at a : a < darts M -> first_dart M a < darts M /\ at_vertex M a (first_dart M a) = true.
Proof.
  intros Ha. unfold first_dart. destruct (find _ _) as [x|] eqn:F.
  - apply find_some in F as [I E]. apply in_seq in I. split; [lia|auto].
  - split; auto. apply at_vertex_iff; auto. exists 0. auto.
Qed.

(** Two darts have the same first dart exactly if they are at the same vertex. *)
Lemma first_dart_eq a b : a < darts M -> b < darts M ->
  first_dart M a = first_dart M b <-> at_vertex M a b = true.
Proof.
  intros Ha Hb. destruct (first_dart_at a Ha) as [La Ea], (first_dart_at b Hb) as [Lb Eb]. split.
  - intros E. rewrite <- E in Eb. apply at_vertex_iff in Ea as (i & Ea), Eb as (j & Eb); auto.
    apply at_vertex_iff; auto. destruct (turn_back j b Hb) as (k & B).
    exists (k + i). rewrite turn_add, Ea, <- Eb. auto.
  - intros E. unfold first_dart.
    rewrite (find_ext (at_vertex M a) (at_vertex M b)) by (intros; apply at_vertex_eq; auto).
    destruct (find _ _) as [x|] eqn:F; auto. exfalso.
    assert (N := find_none _ _ F b). rewrite (proj2 (at_vertex_iff b b Hb)) in N; [|exists 0; auto].
    discriminate N. apply in_seq. lia.
Qed.

(** A list of darts at pairwise different vertices has at most n elements. *)
Theorem vertices_most l : (forall a, In a l -> a < darts M) -> NoDup (map (first_dart M) l) ->
  length l <= vertices M.
Proof.
  intros Lt N. rewrite <- (map_length (first_dart M)). apply NoDup_incl_length; auto.
  intros x I. apply in_map_iff in I as (a & <- & I). apply nodup_In, in_map, in_seq.
  apply Lt in I. lia.
Qed.

(** The first darts of all vertices. *)
Definition firsts := nodup Nat.eq_dec (map (first_dart M) (seq 0 (darts M))).

(** A dart in that list is its own first dart. *)
Lemma firsts_own a : In a firsts -> a < darts M /\ first_dart M a = a.
Proof.
  intros I. apply nodup_In, in_map_iff in I as (d & <- & I). apply in_seq in I.
  assert (Hd : d < darts M) by lia. destruct (first_dart_at d Hd) as [L A]. split; auto.
  symmetry. apply first_dart_eq; auto.
Qed.

(** A map has at most as many vertices as darts. *)
Lemma vertices_le : vertices M <= darts M.
Proof.
  rewrite <- (seq_length (darts M) 0). apply (NoDup_incl_length (NoDup_nodup _ _)).
  intros a I. apply firsts_own in I as [L _]. apply in_seq. lia.
Qed.
End Vertices.

(** An embedded map has at most as many vertices as the world. *)
Theorem embedded_vertices M W phi : is_map M -> is_map W -> embedded M W phi ->
  vertices M <= vertices W.
Proof.
  intros WM WW E. change (vertices M) with (length (firsts M)).
  assert (Own := firsts_own M WM). assert (Lt := phi_lt _ _ _ E).
  rewrite <- (map_length phi). apply (vertices_most W).
  - intros a I. apply in_map_iff in I as (d & <- & I). apply Lt. apply (Own d I).
  - rewrite map_map. apply nodup_map; [apply NoDup_nodup|]. intros a b Ia Ib Eq.
    apply Own in Ia as [La Fa]. apply Own in Ib as [Lb Fb].
    apply (first_dart_eq W WW) in Eq; auto. apply (at_vertex_iff W WW) in Eq as (k & Eq); auto.
    rewrite <- (embedded_turn M W phi WM E) in Eq by auto.
    apply (phi_inj _ _ _ E) in Eq; auto using turn_lt.
    rewrite <- Fa, <- Fb. apply (first_dart_eq M WM); auto. apply (at_vertex_iff M WM); eauto.
Qed.
