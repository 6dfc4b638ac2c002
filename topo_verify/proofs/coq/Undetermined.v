(** A log that a map with an open dart shows proves nothing (claim 9; docs/semantics.md, section
    11).

    M is a map, e an open dart of it, L a log, W a world.

    Hang a leaf on every open dart; or a path of two edges on e and leaves on the others. The two
    worlds differ in size, and both show the log. *)
From Coq Require Import Arith Lia List Bool.
Import ListNotations.
From Topo Require Import World Rotation Embedding Augment Log.

(** A map is embedded in itself with a new vertex added. *)
Lemma embedded_fresh M e d : is_map M -> e < darts M -> alpha M e = None ->
  embedded M (augment_new M e d) id.
Proof.
  intros WM He Oe. split; simpl; unfold id, grow, join; auto; [lia| |].
  - intros x Hx. cases.
  - intros x y Hx Hy. assert (y < darts M) by (apply (alpha_ok M WM) in Hy; auto; apply Hy).
    cases; congruence.
Qed.

(** Every connected map is embedded in a world that has a leaf on each of its open darts. *)
Lemma hang_leaves n : forall M, is_map M -> connected M -> darts M <= n + known M ->
  exists W, world W /\ embedded M W id /\ darts W + known M = 2 * darts M /\
  forall d, d < darts M -> alpha M d = None -> exists x, alpha W d = Some x /\ darts M <= x.
Proof.
  assert (Done : forall M, is_map M -> connected M -> (forall d, d < darts M -> alpha M d <> None) ->
    exists W, world W /\ embedded M W id /\ darts W + known M = 2 * darts M /\
    forall d, d < darts M -> alpha M d = None -> exists x, alpha W d = Some x /\ darts M <= x).
  { intros M WM CM T. exists M. split; [split; auto|]. split; [split; auto|].
    split; [rewrite (known_all M T); lia|]. intros d Hd Od. destruct (T d Hd Od). }
  induction n as [|n IH]; intros M WM CM Hn; destruct (open_or_closed M) as [(e & He & Oe)|T]; auto.
  - assert (known M < darts M); [|lia]. apply count_lt with e; auto. unfold explored. rewrite Oe. auto.
  - assert (K := new_two_more M e 1 He Oe ltac:(auto)).
    destruct (IH (augment_new M e 1)) as (W & HW & E & S & O).
    + apply is_map_new; auto.
    + apply connected_new; auto.
    + rewrite K. simpl. lia.
    + exists W. split; auto. assert (E' := E).
      destruct (embedded_fresh M e 1 WM He Oe) as [A1 A2 A3 A4 A5], E as [B1 B2 B3 B4 B5].
      unfold id in *. split; [|split; [simpl in S; lia|]].
      * split; auto; intros; rewrite <- ?B5, <- ?B3, <- ?A3; auto.
      * intros d Hd Od. simpl in O. destruct (Nat.eq_dec d e) as [->|N].
        -- exists (darts M). split; auto. apply (phi_alpha _ _ _ E' e (darts M)); simpl; [lia|].
           unfold join. rewrite Nat.eqb_refl. auto.
        -- destruct (O d) as (x & Hx & L); [lia| |exists x; split; [auto|lia]].
           unfold join. cases. auto.
Qed.

(** If a map shows a log, every world in which it is embedded shows it. *)
Lemma embedded_replays M W phi L : is_map M -> is_map W -> embedded M W phi -> replays M L ->
  replays W L.
Proof.
  intros WM WW E [A B]. assert (R := root_lt M WM). split; rewrite <- (phi_root M W phi E).
  - rewrite (percept_agree M W phi); auto.
  - apply (forward M W phi); auto.
Qed.

(** The log is undetermined: two worlds that differ in size, hence are not isomorphic, show it. *)
Definition undetermined L := exists W1 W2, world W1 /\ world W2 /\
  replays W1 L /\ replays W2 L /\ darts W1 <> darts W2.

(** Claim 9: a log that a map with an open dart shows is undetermined. *)
Theorem open_undetermined M L e : is_map M -> connected M -> replays M L ->
  e < darts M -> alpha M e = None -> undetermined L.
Proof.
  intros WM CM R He Oe. set (N := augment_new M e 2).
  assert (WN : is_map N) by (apply is_map_new; auto). assert (CN :
    connected N) by (apply connected_new; auto).
  assert (E := embedded_fresh M e 2 WM He Oe : embedded M N id).
  assert (K : known N = 2 + known M) by (apply new_two_more; auto).
  destruct (hang_leaves (darts M) M WM CM) as (W1 & H1 & E1 & S1 & _); [lia|].
  destruct (hang_leaves (darts N) N WN CN) as (W2 & H2 & E2 & S2 & _); [lia|].
  exists W1, W2. repeat (split; [assumption|]).
  split; [|split].
  - apply (embedded_replays M W1 id); auto. apply H1.
  - apply (embedded_replays N W2 id); auto. apply H2. apply (embedded_replays M N id); auto.
  - simpl in S2. lia.
Qed.
