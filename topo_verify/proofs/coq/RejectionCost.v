(** What false hypotheses cost at least, where places look alike: each is refuted at the marker only.

    W     a world, M the map             phi     their correspondence
    e     the dart being explored        a       the dart of the world behind it
    h     a hypothesis                   H       hypotheses, each with its way home
    f     a number for each dart of W, 0 at the marker's vertex only, that one move changes by at
          most 1: a lower bound of the distance from the marker

    All percepts away from the marker are the same. So a walk along the way home of a false h meets a
    difference only where the robot is at the marker, or would be if h were true. The walk costs at least
    the lesser of f (phi h) and f a, and as much back: [rejected_far]. [new_round] adds this up for all
    hypotheses of an edge that leads to a new vertex. *)
From Coq Require Import Arith Lia List Bool Permutation.
Import ListNotations.
From Topo Require Import World Rotation Embedding Vertices Augment Program Mapper Validation Rules.

(** What is true of a performance in two ways is true in both: programs are deterministic. *)
Lemma does_both {A} W a (p : program A) (Q R : A -> nat -> nat -> Prop) : does W a p Q ->
  does W a p R -> does W a p (fun x b n => Q x b n /\ R x b n).
Proof.
  intros (x & b & ms & P & H) (y & c & ns & P' & H'). rewrite P in P'. injection P' as <- <- <-.
  exists x, b, ms. auto.
Qed.

(** Keeping the trail costs nothing. *)
Lemma does_trailed {A} W a (p : program A) t Q : does W a p Q ->
  does W a (with_trail p t) (fun r b n => Q (fst r) b n).
Proof.
  intros (x & b & ms & P & H). exists (x, rev ms ++ t), b, ms. rewrite perform_with_trail, P. auto.
Qed.

(** If p ends in W, it makes at least c moves. *)
Definition pays {A} W a (p : program A) c := forall x b ms, perform W a p = Some (x, b, ms) ->
  c <= length ms.

(** One program after the other pays for both. *)
Lemma pays_bind {A B} W a (p : program A) (f : A -> program B) (Q : A -> nat -> nat -> Prop) c d :
  does W a p Q -> (forall x b n, Q x b n -> c <= n /\ pays W b (f x) d) -> pays W a (bind p f) (c + d).
Proof.
  intros (x & b & ms & P & H) F. destruct (F x b _ H) as [C D]. intros y b' ns P'.
  rewrite perform_bind, P in P'. destruct (perform W b (f x)) as [((z, e), os)|] eqn:P2; [|discriminate].
  injection P' as <- <- <-. rewrite app_length. apply D in P2. lia.
Qed.

Section Alike.
Variables (W M : Map) (f phi : nat -> nat).
Hypotheses (HW : world W) (WM : is_map M) (E : embedded M W phi)
  (F1 : forall x k y, x < darts W -> move W x k = Some y -> f x <= S (f y) /\ f y <= S (f x))
  (F0 : forall x y, x < darts W -> y < darts W -> f x <> 0 -> f y <> 0 -> percept W x = percept W y).
Let WW : is_map W := world_is_map W HW.

(** A walk meets no difference before one of the two darts is at the marker. *)
Lemma follow_far w : forall x v b c r, facing W v b c -> x < darts M -> percept M x = percept W c ->
  walk M x w = Some r -> does W b (follow M x w v) (fun res b' n => let '(matched, qs, v') := res in
    matched = false -> Nat.min (f (phi x)) (f c) <= length qs).
Proof.
  induction w as [|k w IH]; simpl; intros x v b c r Hv Hx Hp Hw.
  - apply does_return. discriminate.
  - destruct (move M x k) as [y|] eqn:Ey; [|discriminate].
    assert (Hk : k < degree W c) by (injection Hp as <- _; eapply move_door; eauto).
    assert (Hy : y < darts M) by (eapply move_lt; eauto).
    assert (Lc : c < darts W) by (destruct Hv as (Lb & _ & _ & <-); apply turn_lt; auto).
    assert (Ey' := embedded_move M W phi WM WW E x k y Hx Ey).
    apply F1 in Ey'; [|apply (phi_lt _ _ _ E); auto].
    eapply does_bind; [apply (go_on_spec W HW v b c k Hv Hk)|].
    intros u s n (Em & Hu & ->). assert (Eu : fst u = percept W s) by apply Hu.
    assert (Ls : s < darts W) by (eapply move_lt; eauto).
    apply F1 in Em; auto. rewrite Eu. destruct (percept_eqb_spec (percept M y) (percept W s)) as [Eq|Ne].
    + eapply does_bind; [apply (IH y u s s r); auto|]. intros ((m, qs), u') b' n H.
      apply does_return. simpl. intros Em'. specialize (H Em'). lia.
    + apply does_return. simpl. intros _.
      destruct (Nat.eq_dec (f (phi y)) 0) as [Z|Z]; [lia|].
      destruct (Nat.eq_dec (f s) 0) as [Z'|Z']; [lia|]. destruct Ne.
      rewrite <- (percept_agree M W phi) by auto. apply F0; auto. apply (phi_lt _ _ _ E); auto.
Qed.

Variables (e a : nat).
Hypotheses (La : a < darts W) (Na : is_new M phi a).

(** A false hypothesis that looks right, with its way home. *)
Definition false_home (g : hypothesis) := fst g < darts M /\ percept M (fst g) = percept W a /\
  exists r k, walk M (fst g) (snd g) = Some r /\ k < degree M r /\ turn M k r = root M.

(** The cost of refuting some hypotheses. *)
Definition walks_to (H : list hypothesis) :=
  list_sum (map (fun g => 2 * Nat.min (f (phi (fst g))) (f a)) H).

(** A false hypothesis is rejected, and the walk costs at least the lesser of the distances.
    Not in the paper. *)
Lemma rejected_far h w v b : facing W v b a -> false_home (h, w) ->
  does W b (follow M h w v) (fun res b' n => let '(matched, qs, v') := res in
    matched = false /\ n = length qs /\ length qs <= length w /\
    Nat.min (f (phi h)) (f a) <= length qs /\
    exists d, walk W a (firstn (length qs) w) = Some d /\ facing W v' b' d).
Proof.
  intros Hv (Lh & Hp & r & k & Hr & Hk & Er). simpl in Lh, Hp, Hr.
  eapply does_weaken; [apply does_both; [apply (follow_spec W HW M WM w h v b a r); auto|
    apply (follow_far w h v b a r); auto]|].
  intros ((matched, qs), v') b' n ((-> & Lq & Hq & (d & Hd & Hv' & Ht) & Hf) & Far).
  destruct matched.
  - destruct (Ht eq_refl) as [Eq Ep]. rewrite Eq, firstn_all in Hd. exfalso.
    destruct (marker_of M r k Hk Er) as [j Hj]. apply (Na h Lh). symmetry.
    apply (confirm M W phi WM WW E a h w d r j); auto. injection Ep as _ Ep. congruence.
  - repeat split; auto. eauto.
Qed.

(** Testing false hypotheses ends at vu with none, and costs as many walks, each there and back. *)
Lemma tests_far n : forall log ds qs v t b c H, facing W v b c -> walk W a ds = Some c ->
  length H <= n -> NoDup (map fst H) -> (forall g, In g H -> false_home g) ->
  does W b (test_all retrace rule_none n M e (percept W a) tt log ds qs v t H) (fun r b' cost =>
    fst (fst r) = None /\ facing W (fst (snd r)) b' a /\ length ds + walks_to H <= cost).
Proof.
  induction n as [|n IH]; intros log ds qs v t b c H Hv Hw Hn ND HH; cbn [test_all].
  all: assert (Back : does W b (with_trail (undo v (rev ds)) t) (fun vt b' k =>
      facing W (fst vt) b' a /\ k = length ds)) by (rewrite <- (rev_length ds); apply
      (does_trailed _ _ _ _ (fun v b k => facing W v b a /\ k = length (rev ds)));
      apply (undo_spec W HW (rev ds) v b c a Hv La); rewrite rev_involutive; auto).
  all: assert (None_spec : H = [] -> does W b (bind (with_trail (undo v (rev ds)) t)
      (fun vt => Return (@None (nat * nat), log, vt))) (fun r b' cost =>
      fst (fst r) = None /\ facing W (fst (snd r)) b' a /\ length ds + walks_to H <= cost))
    by (intros ->; eapply does_bind; [apply Back|]; intros vt b' k (Hb & ->); apply does_return;
        unfold walks_to; simpl; split; [auto|split; [exact Hb|lia]]).
  - apply None_spec. destruct H; [auto|simpl in Hn; lia].
  - assert (All : forall l, filter (keep rule_none M e (percept W a) tt log t) l = l).
    { intros l. induction l as [|g l IHl]; simpl in *; [auto|]. rewrite IHl. destruct log; auto. }
    assert (No : forall l, find (concludes rule_none M e (percept W a) tt log t) l = None)
      by (intros l; induction l as [|g l IHl]; simpl; auto).
    rewrite All, No. destruct H as [|(h, w) H]; simpl retrace; [apply None_spec; auto|].
    inversion ND as [|x l N ND' Ex]. subst x l. simpl fst in *.
    replace (filter (fun c => negb (fst c =? h)) ((h, w) :: H)) with H.
    2: { simpl. rewrite Nat.eqb_refl. simpl. clear - N. induction H as [|(g, u) H IHl]; simpl; auto.
         destruct (Nat.eqb_spec g h) as [->|]; [destruct N; left; auto|].
         simpl. rewrite <- IHl; auto. intros I. apply N. right. auto. }
    assert (Fh := HH (h, w) (or_introl eq_refl)). assert (Fh' := Fh).
    destruct Fh' as (Lh & Hp & r & k & Hr & _). simpl in Lh, Hp, Hr.
    eapply does_bind; [apply Back|]. intros (v1, t1) b1 m1 (Hv1 & ->). simpl in Hv1.
    assert (P := percepts_walk M w h). rewrite Hr in P.
    destruct (percepts M h w) as [ps|] eqn:Hps; [|destruct P]. rewrite Hr. simpl walk.
    rewrite Hp. destruct (percept_eqb_spec (percept W a) (percept W a)) as [_|Ne]; [|destruct Ne; auto].
    simpl andb. eapply does_bind.
    { apply does_trailed, (rejected_far h w v1 b1 Hv1 Fh). }
    intros (((matched, more), v2), t2) b2 m2 (-> & -> & Lm & Far & d & Hd & Hv2). simpl fst in *.
    eapply does_weaken; [apply (IH _ (firstn (length more) w) _ v2 t2 b2 d H); auto|].
    { simpl in Hn. lia. }
    { intros g I. apply HH. right. auto. }
    intros r' b' cost (A & B & C). split; [auto|]. split; [exact B|]. unfold walks_to in *. simpl in *.
    rewrite firstn_length_le in C by auto. lia.
Qed.
End Alike.

(** A round that finds a new vertex: what it leaves, and what it pays for all hypotheses. *)
Lemma new_round path order W M f phi p v t b e a : good_path path -> good_order order -> world W ->
  (forall x k y, x < darts W -> move W x k = Some y -> f x <= S (f y) /\ f y <= S (f x)) ->
  (forall x y, x < darts W -> y < darts W -> f x <> 0 -> f y <> 0 -> percept W x = percept W y) ->
  is_map M -> connected M -> embedded M W phi -> p < darts M -> facing W v b (phi p) ->
  e < darts M -> alpha M e = None -> alpha W (phi e) = Some a -> is_new M phi a ->
  snd (percept W a) = None ->
  does W b (round path order retrace rule_none (M, p, v, tt, t) e) (fun st b' cost =>
    (exists v' t', st = (augment_new M e (degree W a), darts M, v', tt, t') /\ facing W v' b' a) /\
    list_sum (map (fun h => 2 * Nat.min (f (phi h)) (f a)) (filter (fun h => negb (h =? e) &&
      negb (explored M h) && same_signature (percept M h) (percept W a)) (seq 0 (darts M)))) <= cost).
Proof.
  intros Gpath Gorder HW F1 F0 WM CM E Hp Hv He Oe Ha Na Sa. unfold round.
  assert (WW := world_is_map W HW).
  assert (La : a < darts W) by (eapply alpha_ok; eauto; apply (phi_lt _ _ _ E); auto).
  destruct (Gpath M p e WM CM Hp He) as (Sp & q & Hw & Hk & Eq). destruct (path M e p) as (w, k).
  simpl in Hw, Hk, Eq. assert (Lq := walk_lt M WM w p q Hp Hw).
  assert (Hwk : walk W (phi p) (w ++ [k]) = Some a).
  { rewrite walk_app, (forward_walk M W phi WM WW E w p q) by auto. simpl.
    unfold move. rewrite (embedded_degree M W phi) by auto.
    rewrite (proj2 (Nat.ltb_lt _ _) Hk), <- (embedded_turn M W phi), Eq, Ha by auto. auto. }
  eapply does_bind; [apply does_trailed, (execute_spec W HW w k v b (phi p) a Hv Hwk)|].
  intros (r, u) b1 n1 (-> & Hr & ->). simpl fst in *.
  assert (Eu : fst r = percept W a) by apply Hr. rewrite Eu.
  set (home := path M (root M)). set (l := filter _ _).
  set (H := hypotheses order M e (percept W a)).
  assert (P : Permutation H l) by apply Gorder.
  assert (Hl : forall h, In h H -> h < darts M /\ percept M h = percept W a).
  { intros h I. apply (Permutation_in h P), filter_In in I as [I B]. apply in_seq in I.
    apply andb_true_iff in B as [_ B]. split; [lia|]. unfold same_signature in B.
    destruct (percept W a) as (d, o), (percept M h) as (d', o'). simpl in Sa, B. subst o.
    apply andb_true_iff in B as [B1 B2]. apply Nat.eqb_eq in B1. simpl in B1. subst d'.
    destruct o'; [discriminate|auto]. }
  assert (Fst : map fst (map (fun h => (h, fst (home h))) H) = H)
    by (rewrite map_map; apply map_id).
  eapply does_bind.
  { apply (tests_far W M f phi HW WM E F1 F0 e a La Na _ [] [] [] r u a a); auto.
    - rewrite Fst. apply (Permutation_NoDup (Permutation_sym P)), NoDup_filter, seq_NoDup.
    - intros g I. apply in_map_iff in I as (h & <- & I). apply Hl in I as [Lh Eh].
      destruct (Gpath M h (root M) WM CM Lh (root_lt M WM)) as (_ & x & Hx & Hj & Ex).
      split; [auto|]. split; [auto|]. exists x. eauto. }
  intros ((o, log), (v', t')) b2 n2 (Ho & Hv' & C). cbn [fst snd length] in Ho, Hv', C. subst o.
  apply does_return. split; [eauto|]. unfold walks_to in C. rewrite map_map in C. cbn [fst] in C.
  rewrite (Permutation_list_sum (Permutation_map _ P)) in C. lia.
Qed.
