(** Justified runs: claim 5 for every mapper, motion, order and rule (docs/semantics.md, sections 4
    and 9).

    M is the map so far, T the table of records, W the world; e is the open dart that is explored, a
    the dart of the world behind it, h a hypothesis; u, v, w are doors.

    A run is a sequence of augmentations, each justified by observations. The world W is read
    only through [walk] and [percept], as a robot reads it. SCEPTICS READ the definition of
    [run]. *)
From Coq Require Import Arith Lia List Bool.
Import ListNotations.
From Topo Require Import World Rotation Embedding Augment Records Folding.

(** The table T with one more record: q was seen behind dart d after the doors v. *)
Definition record (T : table) d v q : table := fun x w =>
  if (x =? d) && (if list_eq_dec Nat.eq_dec w v then true else false) then Some q else T x w.

(** The table T without the records of darts e and h, which are dropped when the two are
    explored. *)
Definition drop (T : table) e h : table := fun x w => if (x =? e) || (x =? h) then None else T x w.

(** Dart e is open, the map has a way to it, and that way and then e lead to dart a of the world. *)
Definition behind M W e a := alpha M e = None /\ exists u k q,
  walk M (root M) u = Some q /\ k < degree M q /\ turn M k q = e /\
  walk W (root W) (u ++ [k]) = Some a.

(** The pairs of a map and records that a justified run can build in W. Its steps:

    - the start: the map is v0, and nothing is recorded;
    - a record: the doors u, k, v were taken; on the map the door k is open; what was seen at the
      end is a record of that dart;
    - a loop by motion: behind e, the doors w led to the marker, in the direction predicted for h;
    - a loop by folding: the place behind e is identified with dart h without an assumed edge;
    - a new vertex: each hypothesis h that shows the same percept was refuted, by doors w whose
      percepts ps do not agree with the map and the records, or by folding. *)
Inductive run W : Map -> table -> Prop :=
| run_start : run W (initial (degree W (root W))) (fun _ _ => None)
| run_record M T u k x v c : run W M T ->
    walk M (root M) u = Some x -> alpha M (turn M k x) = None ->
    walk W (root W) (u ++ k :: v) = Some c ->
    run W M (record T (turn M k x) v (percept W c))
| run_loop M T e a h w r c j : run W M T -> behind M W e a ->
    h < darts M -> h <> e -> alpha M h = None ->
    walk M h w = Some r -> walk W a w = Some c ->
    marker M r = Some j -> marker W c = Some j ->
    run W (augment_loop M e h) (drop T e h)
| run_fold M T e h : run W M T -> e < darts M -> h <> e -> alpha M e = None -> alpha M h = None ->
    identified M T (fun _ _ => False) (Ghost e [], 0) (Known h, 0) ->
    run W (augment_loop M e h) (drop T e h)
| run_new M T e a : run W M T -> behind M W e a ->
    (forall h, h < darts M -> h <> e -> alpha M h = None -> percept M h = percept W a ->
     (exists w ps, percepts W a w = Some ps /\ agrees M T h w ps = false) \/
     contradictory M T (fun x y => x = e /\ y = h)) ->
    run W (augment_new M e (degree W a)) (drop T e (darts M)).

(** Everything built and recorded in a justified run is true: M is well formed, connected and
    embedded in the world, and its records are true.
    Paper, II-C: A known map S grows; U holds the unexplored edges; at first S is v0 with its
    edges. *)
Theorem run_true W M T : world W -> run W M T -> is_map M /\ connected M /\
  (forall x w, darts M <= x -> T x w = None) /\
  exists phi, embedded M W phi /\ true_table M W phi T.
Proof.
  intros HW. assert (WW := world_is_map W HW).
  assert (B : forall M phi e a, is_map M -> embedded M W phi -> behind M W e a ->
    e < darts M /\ alpha M e = None /\ alpha W (phi e) = Some a).
  { intros M0 phi e a WM E (Oe & u & k & q & Hu & Hk & <- & Hw).
    assert (Lr := root_lt M0 WM). assert (Lq := walk_lt M0 WM u _ q Lr Hu).
    repeat split; auto using turn_lt.
    rewrite walk_app, <- (phi_root _ _ _ E), (forward_walk M0 W phi WM WW E u _ q) in Hw by auto.
    simpl in Hw. unfold move in Hw. rewrite (embedded_degree M0 W phi) in Hw by auto.
    rewrite (proj2 (Nat.ltb_lt _ _) Hk) in Hw.
    rewrite (embedded_turn M0 W phi) by auto. destruct (alpha W _); congruence. }
  assert (Loop : forall M T phi e h, is_map M -> connected M ->
    (forall x w, darts M <= x -> T x w = None) -> embedded M W phi -> true_table M W phi T ->
    e < darts M -> h < darts M -> h <> e -> alpha M e = None -> alpha M h = None ->
    alpha W (phi e) = Some (phi h) -> is_map (augment_loop M e h) /\ connected (augment_loop M e h) /\
    (forall x w, darts M <= x -> drop T e h x w = None) /\
    exists phi, embedded (augment_loop M e h) W phi /\ true_table (augment_loop M e h) W phi (drop T
      e h)).
  { intros M0 T0 phi e h WM CM Out E HT Le Lh N Oe Oh Ha.
    refine (conj (is_map_loop M0 e h WM Le Lh N Oe Oh) (conj (connected_loop M0 e h Oe Oh CM)
      (conj _ (ex_intro _ phi (conj (embedded_loop M0 W phi e h WW E Le Lh Ha) _))))); unfold drop.
    - intros x w Hx. rewrite (Out x w Hx). destruct (_ || _); auto.
    - intros d w q Hd. destruct (_ || _); [discriminate|]. apply HT; auto. }
  induction 1 as [|M T u k x v c _ IH Hu Ox Hc|M T e a h w r c j _ IH Hbe Lh Nh Oh Hr Hc Mr Mc
                  |M T e h _ IH Le Nh Oe Oh Hs|M T e a _ IH Hbe Hrej];
    [|destruct IH as (WM & CM & Out & phi & E & HT)..].
  - destruct (degree_spec W WW _ (root_lt W WW)) as (A & _).
    refine (conj (is_map_initial _ A) (conj (connected_initial _ A) (conj (fun _ _ _ => eq_refl) _))).
    eexists. split; [apply embedded_initial; auto|red; discriminate].
  - assert (Lr := root_lt M WM). assert (Lx := turn_lt M WM k x (walk_lt M WM u _ x Lr Hu)).
    refine (conj WM (conj CM (conj _ (ex_intro _ phi (conj E _))))); unfold record.
    + intros y w Hy. cases. apply Out; auto.
    + intros d w q Hd. destruct (Nat.eqb_spec d (turn M k x)) as [->|]; simpl; [|apply HT; auto].
      destruct (list_eq_dec _ w v) as [->|]; [|apply HT; auto]. intros Eq. injection Eq as <-.
      rewrite <- (phi_root _ _ _ E) in Hc.
      destruct (record_true M W phi WM WW E (root M) u k v x c Lr Hu Hc) as (b & H1 & H2). eauto.
  - destruct (B M phi e a WM E Hbe) as (Le & Oe & Ha). apply (Loop M T phi); auto.
    rewrite Ha. f_equal. apply (confirm M W phi WM WW E a h w c r j); auto.
    apply (alpha_ok W WW) in Ha; [apply Ha|apply (phi_lt _ _ _ E); auto].
  - apply (folding_confirms M T W phi WM HW E HT) in Hs as [Lh Ha]. apply (Loop M T phi); auto.
  - destruct (B M phi e a WM E Hbe) as (Le & Oe & Ha).
    assert (La : a < darts W) by (apply (alpha_ok W WW) in Ha; [apply Ha|apply (phi_lt _ _ _ E); auto]).
    destruct (degree_spec W WW a La) as (D & _).
    assert (N : is_new M phi a).
    { intros h Lh Eh. destruct (posed M W phi WM WW E e a h Le Oe Ha Lh Eh) as (A & O & P).
      destruct (Hrej h Lh A O P) as [(w & ps & Hw & Hn)|Hf]; subst a.
      - rewrite (agrees_true M W phi T WM WW E HT w h ps Lh Hw) in Hn. discriminate.
      - revert Hf. apply (folding_true M T W phi WM HW E HT). intros ? ? [-> ->]. auto. }
    refine (conj (is_map_new M e _ WM Le Oe D) (conj (connected_new M e _ WM Le Oe CM)
      (conj _ (ex_intro _ _ (conj (embedded_new M W phi e a WM WW E Le Ha N) _))))); unfold drop.
    + intros x w Hx. simpl in Hx. rewrite Out by lia. destruct (_ || _); auto.
    + intros d w q Hd. destruct (_ || _); [discriminate|].
      apply (records_new M W phi T e (degree W a) a HT Out); auto.
Qed.

(** Claim 5: a justified run that ends without open darts ends with the world.
    Paper, II-C: When U is empty, S is isomorphic to the world. *)
Theorem run_isomorphic W M T : world W -> run W M T ->
  (forall d, d < darts M -> alpha M d <> None) -> isomorphic M W.
Proof.
  intros HW R Hc. destruct (run_true W M T HW R) as (WM & _ & _ & phi & E & _).
  apply (closed_isomorphic M W phi); auto; apply HW.
Qed.
