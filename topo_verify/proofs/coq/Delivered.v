(** A delivered map is compared with a proved one (claims 5 and 9).

    D is a delivery, M its map, t the table of the proved map, W a world; psi lists for each dart of
    M the dart of t that it is, and for each dart of t that of M.

    The check is [check_delivery]. What it accepts is the world ([check_delivery_right]), and it
    accepts every right delivery with some list ([check_delivery_accepts]). *)
From Coq Require Import Arith Lia List Bool NArith.
Import ListNotations.
From Topo Require Import World Rotation Determined Events Table TableCorrect.

(** The dart of the table that dart d is. *)
Definition ahead (psi : list (nat * nat)) d := fst (nth d psi (0, 0)).

(** The dart of the delivered map that dart b of the table is. *)
Definition backwards (psi : list (nat * nat)) b := snd (nth b psi (0, 0)).

(** Dart d of M has its next dart and its partner where they are in the table. *)
Definition check_dart M t (psi : list (nat * nat)) d := let T := map_of t in
  (ahead psi d <? darts T) && (backwards psi (ahead psi d) =? d) &&
  (backwards psi d <? darts M) && (ahead psi (backwards psi d) =? d) &&
  (sigma M d <? darts M) && (ahead psi (sigma M d) =? sigma T (ahead psi d)) &&
  match alpha M d, alpha T (ahead psi d) with
  | Some e, Some b => (e <? darts M) && (ahead psi e =? b)
  | _, _ => false end.

(** The delivery lists no empty vertex and no pair too many, and its map is the table. *)
Definition check_delivery D t psi := let M := delivered_map D in
  forallb (fun r => match r with [] => false | _ => true end) (rotations D) &&
  (2 * length (pairs D) =? length (labels D)) && (darts M =? darts (map_of t)) &&
  (root M <? darts M) && (ahead psi (root M) =? root (map_of t)) &&
  forallb (check_dart M t psi) (seq 0 (darts M)).

(** One isomorphism after another is one. *)
Lemma isomorphic_trans A B C : isomorphic A B -> isomorphic B C -> isomorphic A C.
Proof.
  intros [E (f & [F1 F2 F3 F4 F5] & Fo & Fa)] [E' (g & [G1 G2 G3 G4 G5] & Go & Ga)].
  split; [congruence|]. exists (fun d => g (f d)). split; [split|split].
  - auto.
  - auto.
  - intros d Hd. rewrite F3, G3; auto.
  - intros d e Hd Hx. apply F4 in Hx; auto.
  - congruence.
  - intros b Hb. destruct (Go b Hb) as (c & Hc & <-). destruct (Fo c Hc) as (d & Hd & <-). eauto.
  - intros d Hd. rewrite Ga, Fa by auto. destruct (alpha A d); auto.
Qed.

Section Check.
Variables (M : Map) (t : map_table) (psi : list (nat * nat)).
Let T := map_of t.
Hypotheses (HT : world T) (Size : darts M = darts T) (Rlt : root M < darts M)
  (Rt : ahead psi (root M) = root T)
  (All : forall d, d < darts M -> check_dart M t psi d = true).

(** What [check_dart] says of dart d. *)
Lemma check_dart_spec d : d < darts M -> ahead psi d < darts T /\ backwards psi (ahead psi d) = d /\
  (backwards psi d < darts M /\ ahead psi (backwards psi d) = d) /\
  (sigma M d < darts M /\ ahead psi (sigma M d) = sigma T (ahead psi d)) /\
  exists e, alpha M d = Some e /\ e < darts M /\ alpha T (ahead psi d) = Some (ahead psi e).
Proof.
  intros Hd. assert (H := All d Hd). unfold check_dart in H. fold T in H.
  destruct (alpha M d) as [e|], (alpha T (ahead psi d)) as [b|];
    rewrite !andb_true_iff, ?Nat.ltb_lt, ?Nat.eqb_eq in H; try (destruct H; discriminate).
  destruct H as ((((((H1 & H2) & H3) & H4) & H5) & H6) & H7 & H8). repeat split; auto.
  exists e. repeat split; auto; congruence.
Qed.

(** [ahead] maps different darts to different darts. *)
Lemma ahead_inj d e : d < darts M -> e < darts M -> ahead psi d = ahead psi e -> d = e.
Proof.
  intros Hd He E. apply check_dart_spec in Hd as (_ & <- & _), He as (_ & <- & _). congruence.
Qed.

(** The map is isomorphic to the table. *)
Lemma checked_isomorphic : isomorphic M T.
Proof.
  split; auto. exists (ahead psi). split; [split|split]; auto.
  - intros d Hd. apply (check_dart_spec d Hd).
  - apply ahead_inj.
  - intros d Hd. apply (check_dart_spec d Hd).
  - intros d e Hd E. destruct (check_dart_spec d Hd) as (_ & _ & _ & _ & x & H & _ & ->). congruence.
  - intros b Hb. rewrite <- Size in Hb. destruct (check_dart_spec b Hb) as (_ & _ & H & _). eauto.
  - intros d Hd. destruct (check_dart_spec d Hd) as (_ & _ & _ & _ & x & -> & _ & ->). auto.
Qed.

(** What can be reached in the table can be reached in the map. *)
Lemma checked_reach b : reach T (root T) b -> exists d, d < darts M /\ ahead psi d = b /\
  reach M (root M) d.
Proof.
  intros H. induction H as [|b _ (d & Hd & <- & R)|b c _ (d & Hd & <- & R) Hc].
  - exists (root M). split; auto. split; auto. constructor.
  - destruct (check_dart_spec d Hd) as (_ & _ & _ & (H1 & H2) & _). exists (sigma M d).
    split; auto. split; auto. constructor; auto.
  - destruct (check_dart_spec d Hd) as (_ & _ & _ & _ & x & Hx & Lx & E). exists x.
    split; auto. split; [congruence|]. apply reach_alpha with d; auto.
Qed.

(** The map is a world. *)
Lemma checked_world : world M.
Proof.
  assert (WT := world_is_map T HT). split; [split| |]; auto.
  - intros d Hd. apply (check_dart_spec d Hd).
  - intros d e Hd He E. apply ahead_inj; auto.
    destruct (check_dart_spec d Hd) as (Ld & _ & _ & (_ & Sd) & _).
    destruct (check_dart_spec e He) as (Le & _ & _ & (_ & Se) & _).
    apply (sigma_inj T WT); auto. congruence.
  - intros d e Hd E. destruct (check_dart_spec d Hd) as (Ld & _ & _ & _ & x & Hx & Lx & A).
    assert (x = e) as -> by congruence. split; auto.
    destruct (alpha_ok T WT _ _ Ld A) as (_ & N & A'). split; [congruence|].
    destruct (check_dart_spec e Lx) as (_ & _ & _ & _ & y & -> & Ly & B). f_equal.
    apply ahead_inj; auto. congruence.
  - intros d Hd. destruct (check_dart_spec d Hd) as (_ & _ & _ & _ & x & -> & _). discriminate.
  - intros d Hd. destruct (check_dart_spec d Hd) as (Ld & _).
    apply (world_connected T HT) in Ld. apply checked_reach in Ld as (e & He & E & R).
    apply ahead_inj in E; auto. subst. auto.
Qed.
End Check.

(** Claim 9: a delivery that the check accepts is right in every world that is the proved map.
    Not in the paper. *)
Theorem check_delivery_right D t psi W : world (map_of t) -> check_delivery D t psi = true ->
  isomorphic (map_of t) W -> right_delivery D W.
Proof.
  unfold check_delivery. rewrite !andb_true_iff, !Nat.eqb_eq, Nat.ltb_lt, !forallb_forall.
  intros HT (((((A & B) & C) & E) & F) & G) I.
  assert (G' : forall d, d < darts (delivered_map D) -> check_dart (delivered_map D) t psi d = true).
  { intros d Hd. apply G, in_seq. lia. }
  split; [|split; [|split]]; auto.
  - apply Forall_forall. intros r Hr ->. discriminate (A _ Hr).
  - apply (checked_world _ t psi); auto.
  - apply isomorphic_trans with (map_of t); auto. apply (checked_isomorphic _ t psi); auto.
Qed.

(** Claim 9: every delivery that is right in the world of the table is accepted with some list.
    Not in the paper. *)
Theorem check_delivery_accepts D t W : world (map_of t) -> isomorphic (map_of t) W ->
  right_delivery D W -> exists psi, check_delivery D t psi = true.
Proof.
  intros HT [SizeT (f & [F1 F2 F3 F4 F5] & Fo & Fa)]
    (Rows & Pairs & HM & SizeM & phi & [P1 P2 P3 P4 P5] & Po & Pa).
  set (M := delivered_map D) in *. set (T := map_of t) in *.
  assert (WM := world_is_map M HM). assert (WT := world_is_map T HT).
  destruct (choice 0 (fun d b => b < darts T /\ f b = phi d) (darts M)) as [g Hg].
  { intros d Hd. apply (Fo (phi d)); auto. }
  destruct (choice 0 (fun b d => d < darts M /\ phi d = f b) (darts M)) as [h Hh].
  { intros b Hb. apply (Po (f b)), F1. congruence. }
  exists (map (fun i => (g i, h i)) (seq 0 (darts M))).
  assert (At : forall i, i < darts M ->
    nth i (map (fun i => (g i, h i)) (seq 0 (darts M))) (0, 0) = (g i, h i)).
  { intros i Hi. rewrite (nth_indep _ (0, 0) ((fun i => (g i, h i)) 0))
      by (rewrite map_length, seq_length; auto).
    rewrite (map_nth (fun i => (g i, h i))), seq_nth; auto. }
  assert (Ga : forall i, i < darts M -> ahead (map (fun i => (g i, h i)) (seq 0 (darts M))) i = g i)
    by (intros i Hi; unfold ahead; rewrite At; auto).
  assert (Ha : forall i, i < darts M -> backwards (map (fun i => (g i, h i)) (seq 0 (darts M))) i = h i)
    by (intros i Hi; unfold backwards; rewrite At; auto).
  assert (Size : darts M = darts T) by congruence. assert (Rt := root_lt M WM).
  unfold check_delivery. fold M. fold T. rewrite !andb_true_iff, !Nat.eqb_eq, Nat.ltb_lt.
  repeat split; auto.
  - apply forallb_forall. intros r I. rewrite Forall_forall in Rows. specialize (Rows r I).
    destruct r; auto.
  - rewrite Ga by auto. apply F2; [apply Hg; auto|apply WT|]. destruct (Hg _ Rt) as [_ ->]. congruence.
  - apply forallb_forall. intros d I. apply in_seq in I. assert (Hd : d < darts M) by lia. clear I.
    destruct (Hg d Hd) as [G1 G2], (Hh d Hd) as [H1 H2]. assert (Gm : g d < darts M) by congruence.
    assert (Sd := sigma_lt M WM d Hd). destruct (Hg _ Sd) as [S1 S2].
    unfold check_dart. fold T. rewrite (Ga d), (Ha (g d)), (Ha d), (Ga (h d)), (Ga (sigma M d)) by auto.
    assert (B1 : h (g d) = d) by (destruct (Hh (g d) Gm); apply P2; auto; congruence).
    assert (B2 : g (h d) = d) by (destruct (Hg (h d) H1); apply F2; auto; congruence).
    assert (B3 : g (sigma M d) = sigma T (g d)).
    { apply F2; auto; [apply sigma_lt; auto|]. rewrite S2, P3, F3, G2 by auto. auto. }
    rewrite B1, B2, B3, !Nat.eqb_refl, !(proj2 (Nat.ltb_lt _ _)) by auto. cbn [andb].
    destruct (alpha M d) as [e|] eqn:E; [|destruct (world_total M HM d Hd E)].
    destruct (alpha_ok M WM d e Hd E) as (Le & _). assert (A := P4 d e Hd E).
    rewrite <- G2, Fa in A by auto. destruct (alpha T (g d)) as [b|] eqn:Eb; [|discriminate].
    injection A as A. rewrite (proj2 (Nat.ltb_lt _ _) Le), (Ga e Le). cbn [andb]. apply Nat.eqb_eq.
    destruct (Hg e Le) as [E1 E2]. apply F2; auto; [|congruence]. apply (alpha_ok T WT (g d) b G1 Eb).
Qed.
