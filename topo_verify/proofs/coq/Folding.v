(** Rule folding: what follows from the assumption that e leads to h (docs/semantics.md, section 8;
    claims 3 and 4).

    M is the map, T its records, W the world, phi their correspondence. A place is a known dart, or
    what was seen behind an open dart (a ghost). A corner is a place and an offset: one dart of the
    place's vertex. A is a set of assumed edges.

    Corners that are identified are one dart in every world with the assumed edges, so a
    contradiction refutes the assumption. Entailed.v proves that folding a log is complete as
    well. *)
From Coq Require Import Arith Lia List Bool.
Import ListNotations.
From Topo Require Import World Rotation Embedding Augment Records.

(** A place that the robot has seen: a known dart, or what lies behind the open dart d after the
    doors w. *)
Inductive map_place := Known (x : nat) | Ghost (d : nat) (w : list nat).

Section Fold.
Variables (M : Map) (T : table).

(** What was seen at a place. *)
Definition seen_at p := match p with
  | Known x => if x <? darts M then Some (percept M x) else None
  | Ghost d w => if d <? darts M then T d w else None end.

Arguments seen_at : simpl never.

(** Two corners that are the two darts of an edge that was crossed. *)
Inductive joined : map_place * nat -> map_place * nat -> Prop :=
| joined_known x y : x < darts M -> alpha M x = Some y -> joined (Known x, 0) (Known y, 0)
| joined_open d : d < darts M -> seen_at (Ghost d []) <> None -> joined (Known d, 0) (Ghost d [], 0)
| joined_ghost d w k g m : seen_at (Ghost d w) = Some (g, m) -> k < g ->
    seen_at (Ghost d (w ++ [k])) <> None -> joined (Ghost d w, k) (Ghost d (w ++ [k]), 0)
| joined_sym b c : joined b c -> joined c b.

(** Corners that are one dart if the assumed edges A are edges of the world: the closure, among
    the places seen, under symmetry, transitivity, turning, the marker, the map, and crossing an
    edge. *)
Inductive identified (A : nat -> nat -> Prop) : map_place * nat -> map_place * nat -> Prop :=
| identified_assumed e h : A e h -> seen_at (Ghost e []) <> None -> h < darts M ->
    identified A (Ghost e [], 0) (Known h, 0)
| identified_refl p i : seen_at p <> None -> identified A (p, i) (p, i)
| identified_sym b c : identified A b c -> identified A c b
| identified_trans b c d : identified A b c -> identified A c d -> identified A b d
| identified_turn p q i j : identified A (p, i) (q, j) -> identified A (p, S i) (q, S j)
| identified_full p i g m : seen_at p = Some (g, m) -> identified A (p, g + i) (p, i)
| identified_known x i : x < darts M -> identified A (Known x, i) (Known (turn M i x), 0)
| identified_cross b c b' c' : identified A b c -> joined b b' -> joined c c' -> identified A b' c'
| identified_mark p g j : seen_at p = Some (g, Some j) -> identified A (p, j) (Known (root M), 0).

(** The contradictions: one vertex with two degrees; the marker seen and not seen; two known
    darts that are one; a vertex turned against itself; a dart that is its own partner. *)
Inductive contradictory (A : nat -> nat -> Prop) : Prop :=
| contradictory_degree p q i j g g' m m' : identified A (p, i) (q, j) ->
    seen_at p = Some (g, m) -> seen_at q = Some (g', m') -> g <> g' -> contradictory A
| contradictory_marker p q i j g g' m : identified A (p, i) (q, j) ->
    seen_at p = Some (g, Some m) -> seen_at q = Some (g', None) -> contradictory A
| contradictory_known x y i j : identified A (Known x, i) (Known y, j) ->
    turn M i x <> turn M j y -> contradictory A
| contradictory_turn p i j g m : identified A (p, i) (p, j) -> seen_at p = Some (g, m) ->
    i < g -> j < g -> i <> j -> contradictory A
| contradictory_edge b c : identified A b c -> joined b c -> contradictory A.

Variables (W : Map) (phi : nat -> nat).
Hypotheses (WM : is_map M) (HW : world W) (E : embedded M W phi) (HT : true_table M W phi T).

(** The place p is the vertex of dart a of the world, with a as its reference dart. *)
Definition at_ p a := match p with
  | Known x => x < darts M /\ a = phi x
  | Ghost d w => d < darts M /\ exists b, alpha W (phi d) = Some b /\ walk W b w = Some a end.

(** The corner c is dart b of the world. *)
Definition is (c : map_place * nat) b := exists a, at_ (fst c) a /\ turn W (snd c) a = b.

(** A place has at most one reference dart. *)
Lemma at_fun p a b : at_ p a -> at_ p b -> a = b.
Proof.
  destruct p; simpl; [intros [_ ->] [_ ->]; auto|].
  intros (_ & x & Hx & Ha) (_ & y & Hy & Hb). congruence.
Qed.

(** The reference dart of a place is a dart of the world. *)
Lemma at_lt p a : at_ p a -> a < darts W.
Proof.
  assert (WW := world_is_map W HW). destruct p; simpl.
  - intros [Hx ->]. apply (phi_lt _ _ _ E); auto.
  - intros (Hd & b & Hb & Hw). apply (alpha_ok W WW) in Hb; [|apply (phi_lt _ _ _ E); auto].
    eapply walk_lt; [auto|apply Hb|eauto].
Qed.

(** The world shows at a place what was seen there. *)
Lemma at_seen p q : seen_at p = Some q -> exists a, at_ p a /\ percept W a = q.
Proof.
  assert (WW := world_is_map W HW).
  destruct p as [x|d w]; unfold seen_at; simpl; [destruct (Nat.ltb_spec x (darts M))|destruct
    (Nat.ltb_spec d (darts M))];
    try discriminate; intros Q.
  - exists (phi x). repeat split; auto. rewrite (percept_agree M W phi) by auto. congruence.
  - destruct (HT d w q) as (b & c & Hb & Hc & Hq); eauto 8.
Qed.

(** A corner is at most one dart. *)
Lemma is_fun c a b : is c a -> is c b -> a = b.
Proof. intros (x & Hx & <-) (y & Hy & <-). f_equal. eapply at_fun; eauto. Qed.

(** Joined corners are the two darts of an edge of the world. *)
Lemma joined_true b c : joined b c -> exists x y, is b x /\ is c y /\ alpha W x = Some y.
Proof.
  assert (WW := world_is_map W HW). unfold is.
  induction 1 as [x y Hx Hy|d Hd Hs|d w k g m Hs Hk Hs'|b c _ (x & y & (a & Ha & <-) & (a' & Ha' &
    <-) & Hxy)].
  - exists (phi x), (phi y). repeat split; [exists (phi x)|exists (phi y)|apply E]; simpl; auto.
    repeat split. apply (alpha_ok M WM x y); auto.
  - destruct (seen_at (Ghost d [])) as [q|] eqn:Q; [|congruence].
    destruct (at_seen _ _ Q) as (a & (Ha & b & Hb & Hw) & _). injection Hw as <-.
    exists (phi d), b. repeat split; [exists (phi d)|exists b|]; simpl; eauto 6.
  - destruct (seen_at (Ghost d (w ++ [k]))) as [q|] eqn:Q; [|congruence].
    destruct (at_seen _ _ Q) as (a & (Ha & b & Hb & Hw) & _).
    assert (Hw' := Hw). rewrite walk_app in Hw. destruct (walk W b w) as [c|] eqn:Wc; [|discriminate].
    simpl in Hw. destruct (move W c k) as [z|] eqn:Em; [|discriminate]. injection Hw as ->.
    exists (turn W k c), a. split; [exists c; simpl; eauto 6|]. split; [exists a; simpl; eauto 6|].
    unfold move in Em. destruct (k <? degree W c); [auto|discriminate].
  - exists (turn W (snd c) a'), (turn W (snd b) a). repeat split; eauto.
    apply (alpha_ok W WW) in Hxy; [apply Hxy|]. apply turn_lt; auto. eapply at_lt; eauto.
Qed.

(** If the assumed edges are edges of the world, identified corners are one dart. *)
Lemma identified_true (A : nat -> nat -> Prop) : (forall e h, A e h -> alpha W (phi e) = Some (phi h)) ->
  forall b c, identified A b c -> exists x, is b x /\ is c x.
Proof.
  intros HA. assert (WW := world_is_map W HW). unfold is.
  assert (S : forall p, seen_at p <> None -> exists a, at_ p a).
  { intros p Hp. destruct (seen_at p) as [q|] eqn:Q; [|congruence].
    destruct (at_seen _ _ Q) as (a & Ha & _). eauto. }
  induction 1 as [e h He Hs Hh|p i Hs|b c _ (x & B & C)|b c d _ (x & B & C) _ (y & C' & D)
    |p q i j _ (x & (a & Ha & <-) & (a' & Ha' & Eq))|p i g m Hs|x i Hx
    |b c b' c' _ (x & B & C) Jb Jc|p g j Hs]; simpl in *.
  - destruct (S _ Hs) as (a & Hd & b & Hb & Hw). injection Hw as ->.
    exists a. rewrite (HA e h He) in Hb. split; exists a; repeat split; eauto; congruence.
  - destruct (S _ Hs) as (a & Ha). exists (turn W i a). eauto 6.
  - eauto.
  - exists x. split; auto. assert (x = y) as -> by (eapply (is_fun c); eauto). auto.
  - exists (turn W (Datatypes.S i) a). split; eauto. exists a'. simpl. rewrite Eq. auto.
  - destruct (at_seen _ _ Hs) as (a & Ha & P). injection P as <- _. exists (turn W i a).
    split; [|eauto]. exists a. split; auto. rewrite Nat.add_comm, turn_add.
    f_equal. apply degree_spec; eauto using at_lt.
  - exists (turn W i (phi x)). split; [exists (phi x); auto|]. exists (phi (turn M i x)).
    rewrite (embedded_turn M W phi) by auto. repeat split; auto using turn_lt.
  - destruct (joined_true _ _ Jb) as (y & z & Y & Z & Hyz), (joined_true _ _ Jc) as (u & t & U & V &
      Hut).
    assert (x = y) as -> by (eapply (is_fun b); eauto).
    assert (y = u) as -> by (eapply (is_fun c); eauto). exists z.
    replace z with t in * by congruence. auto.
  - destruct (at_seen _ _ Hs) as (a & Ha & P). injection P as _ P.
    apply marker_some in P. exists (root W). split; [eauto|].
    exists (phi (root M)). repeat split; [apply root_lt; auto|apply (phi_root _ _ _ E)].
Qed.

(** Claim 3 for rule folding: true assumptions are never contradictory.
    Not in the paper. *)
Theorem folding_true (A : nat -> nat -> Prop) : (forall e h, A e h ->
  alpha W (phi e) = Some (phi h)) -> ~ contradictory A.
Proof.
  intros HA. assert (WW := world_is_map W HW).
  assert (G : forall p q i j g m g' m', identified A (p, i) (q, j) -> seen_at p = Some (g, m) ->
    seen_at q = Some (g', m') -> exists a b, at_ p a /\ at_ q b /\ percept W a = (g, m) /\
      percept W b = (g', m') /\ turn W i a = turn W j b).
  { intros p q i j g m g' m' Hs P Q.
    destruct (identified_true A HA _ _ Hs) as (x & (a & Ha & Ea) & (b & Hb & Eb)).
    destruct (at_seen _ _ P) as (a' & Ha' & Pa), (at_seen _ _ Q) as (b' & Hb' & Pb).
    rewrite (at_fun p a' a), (at_fun q b' b) in * by auto. exists a, b. simpl in *.
    repeat split; auto. congruence. }
  intros [p q i j g g' m m' Hs P Q N|p q i j g g' m Hs P Q|x y i j Hs N|p i j g m Hs P Li Lj N|b c Hs J].
  - destruct (G _ _ _ _ _ _ _ _ Hs P Q) as (a & b & Ha & Hb & Pa & Pb & Eq).
    apply N. injection Pa as <- _. injection Pb as <- _.
    rewrite <- (degree_turn W WW i), <- (degree_turn W WW j b), Eq; eauto using at_lt.
  - destruct (G _ _ _ _ _ _ _ _ Hs P Q) as (a & b & Ha & Hb & Pa & Pb & Eq).
    injection Pa as _ Pa. injection Pb as _ Pb.
    apply marker_some in Pa.
    destruct (same_vertex_mark W WW i j a b m) as [n Hn]; eauto using at_lt. congruence.
  - destruct (identified_true A HA _ _ Hs) as (z & (a & [Lx ->] & Ea) & (b & [Ly ->] & Eb)). simpl in *.
    apply N, (phi_inj _ _ _ E); auto using turn_lt. rewrite !(embedded_turn M W phi) by auto. congruence.
  - destruct (G _ _ _ _ _ _ _ _ Hs P P) as (a & b & Ha & Hb & Pa & _ & Eq).
    rewrite (at_fun p b a) in Eq by auto. injection Pa as <- _.
    apply N, (turn_eq W WW a); eauto using at_lt.
  - destruct (identified_true A HA _ _ Hs) as (x & B & C), (joined_true _ _ J) as (y & z & B' & C' & H).
    rewrite (is_fun b y x), (is_fun c z x) in H by auto.
    destruct B as (a & Ha & <-). apply (alpha_ok W WW) in H; [apply H; auto|].
    apply turn_lt; auto. eapply at_lt; eauto.
Qed.

(** Claim 4 for rule folding: if the place behind e is identified with a known dart h without an
    assumed edge, e leads to h.
    Not in the paper. *)
Theorem folding_confirms e h : identified (fun _ _ => False) (Ghost e [], 0) (Known h, 0) ->
  h < darts M /\ alpha W (phi e) = Some (phi h).
Proof.
  intros Hs. destruct (identified_true (fun _ _ => False) ltac:(intros ? ? []) _ _ Hs)
    as (x & (a & (_ & b & Hb & Hw) & Ea) & (c & [Lh ->] & Ec)). simpl in *. split; congruence.
Qed.
End Fold.
