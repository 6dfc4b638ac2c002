(** Walks around the loops of a breadth-first tree, into which the stalks are inserted
    (docs/semantics.md, section 11).

    W is a world; depth and up describe a breadth-first tree of it; b, c, d, x are darts, each
    standing for its vertex; q is a stalk; ds is a walk, the list of the darts by which the robot
    leaves.

    A walk goes around the loop of every chord: down the tree, over the chord, home. Then it goes
    down to the vertex of x. The stalks that it did not cross are inserted one by one, each there and
    back at the first visit of its upper end. The marker is seen between two chords, and in the end
    every edge is crossed. Tour.v counts the moves. *)
From Coq Require Import Arith Lia List Bool.
Import ListNotations.
From Topo Require Import World Rotation Vertices Distance Tree Pendant Walks.

(** The way from v0 down the tree to the vertex of b, whose depth is n. *)
Fixpoint way_down W up n b := match n with
  | 0 => [] | S n => way_down W up n (parent W up b) ++ [opposite W (up b)] end.

(** The way from the vertex of b, whose depth is n, home to v0. *)
Fixpoint way_home W up n b := match n with
  | 0 => [] | S n => up b :: way_home W up n (parent W up b) end.

(** The loop of a chord: down the tree, over the chord, and home. *)
Definition loop W (depth up : nat -> nat) c :=
  way_down W up (depth c) c ++ c :: way_home W up (depth (opposite W c)) (opposite W c).

(** The loops of all chords, and then the way down to x. *)
Definition loops W depth up x :=
  flat_map (loop W depth up) (chords W depth up) ++ way_down W up (depth x) x.

(** Does the walk from a by ds visit the upper end of q? *)
Fixpoint passes W q a ds := at_vertex W a (opposite W q) ||
  match ds with [] => false | d :: ds => passes W q (opposite W d) ds end.

(** The walk with q there and back, at the first visit of the upper end of q. *)
Fixpoint insert W q a ds := if at_vertex W a (opposite W q) then opposite W q :: q :: ds else
  match ds with [] => [] | d :: ds => d :: insert W q (opposite W d) ds end.

(** The stalks that the walk does not cross. *)
Definition uncrossed W depth up ds :=
  filter (fun q => negb (existsb (fun d => edge W d =? edge W q) ds)) (stalks W depth up).

(** The walk with at most n stalks inserted, each when its upper end is visited. *)
Fixpoint grow_walk W depth up n ds := match n with
  | 0 => ds
  | S n => match find (fun q => passes W q (root W) ds) (uncrossed W depth up ds) with
           | Some q => grow_walk W depth up n (insert W q (root W) ds) | None => ds end end.

(** If f holds where g does, and g for one more element, f has fewer elements. *)
Lemma filter_less {X} (f g : X -> bool) l q : (forall x, f x = true -> g x = true) ->
  In q l -> g q = true -> f q = false -> length (filter f l) < length (filter g l).
Proof.
  intros H I G F. assert (Le : forall l, length (filter f l) <= length (filter g l)).
  { clear l I. intros l. induction l as [|x l IH]; simpl; auto.
    destruct (f x) eqn:E; [rewrite (H x E)|destruct (g x)]; simpl; lia. }
  induction l as [|x l IH]; simpl in *; [destruct I|]. specialize (Le l). destruct I as [->|I].
  - rewrite G, F. simpl. lia.
  - specialize (IH I). destruct (f x) eqn:E; [rewrite (H x E)|destruct (g x)]; simpl; lia.
Qed.

Section Growing.
Variables (W : Map) (depth up : nat -> nat).
Hypotheses (HW : world W) (B : breadth_first W depth up).
Let WW := world_is_map W HW.
Let opposite_ok := opposite_ok W HW.
Let parent_ok := parent_ok W depth up HW B.
Notation path := (path W).
Notation homing := (homing W depth up).
Notation way_down := (way_down W up).
Notation way_home := (way_home W up).
Notation nearer := (nearer depth up).
Notation in_tree := (in_tree W depth up).
Notation climb := (climb W up).
Notation parent := (parent W up).
Notation beside := (beside W).
Notation insert := (insert W).
Notation passes := (passes W).
Notation height := (height W depth up).
Notation stalks := (stalks W depth up).
Notation uncrossed := (uncrossed W depth up).

(* ---------------------------------------------------------------- walks *)

(** Where the walk from a by ds arrives: the last reference dart. *)
Fixpoint arrival a ds := match ds with [] => a | d :: ds => arrival (opposite W d) ds end.

(** A walk by l ++ m is a walk by l, then one by m. *)
Lemma path_app l m : forall a, path a (l ++ m) <-> path a l /\ path (arrival a l) m.
Proof. induction l as [|d l IH]; simpl; intros a; [tauto|]. rewrite IH. tauto. Qed.

(** Whether a walk can be made depends on the vertex only. *)
Lemma path_beside a b ds : a < darts W -> beside a b -> path b ds -> path a ds.
Proof.
  intros Ha N. destruct ds as [|d ds]; simpl; auto. intros (A & X). split; auto.
  apply beside_trans with b; auto.
Qed.

(** The arrival is a dart of the world. *)
Lemma arrival_lt ds : forall a, a < darts W -> path a ds -> arrival a ds < darts W.
Proof. induction ds as [|d ds IH]; simpl; auto. intros a _ (_ & Hd & P). apply IH; auto.
  apply opposite_ok; auto. Qed.

(** The dart up of b is a dart of its vertex, and leads towards v0. *)
Lemma up_ok b : b < darts W -> 0 < depth b -> up b < darts W /\ beside b (up b) /\
  nearer (up b) = true.
Proof.
  intros Hb P. destruct (parent_ok b Hb P) as (Hu & _ & _ & D & U). split; auto. split.
  - destruct (bf_up W depth up B b Hb P) as [(k & E) _]. exists k. auto.
  - unfold Tree.nearer. rewrite D, U, Nat.eqb_refl. apply andb_true_iff. split; auto.
    apply Nat.ltb_lt; auto.
Qed.

(** The way down leads to the vertex of b. *)
Lemma path_down n : forall b, b < darts W -> depth b = n ->
  path (root W) (way_down n b) /\ beside (arrival (root W) (way_down n b)) b /\
  Forall (fun d => in_tree d = true) (way_down n b).
Proof.
  assert (R := root_lt W WW). induction n as [|n IH]; intros b Hb D; simpl.
  { split; auto. split; auto. destruct (bf_home W depth up B b Hb D) as (k & E). exists k; auto. }
  destruct (up_ok b Hb) as (Hu & Bu & N); [lia|]. destruct (parent_ok b Hb) as (_ & Hp & Dp & _); [lia|].
  destruct (opposite_ok _ Hu) as (Ho & _ & Oo).
  destruct (IH (parent b) Hp) as (P & A & F); [lia|]. split; [|split].
  - apply path_app. split; auto. simpl. auto.
  - assert (X : forall l a d, arrival a (l ++ [d]) = opposite W d)
      by (clear; intros l; induction l; simpl; auto).
    rewrite X, Oo. apply (beside_sym W HW); auto.
  - apply Forall_app. split; auto. constructor; auto. unfold Tree.in_tree. rewrite Oo, N.
    apply orb_true_r.
Qed.

(** The way home can be walked, and finds the marker if it was lost. *)
Lemma path_home n : forall b, b < darts W -> depth b = n -> path b (way_home n b) /\
  depth (arrival b (way_home n b)) = 0 /\ forall m, homing false m = true ->
  homing (negb (n =? 0)) (way_home n b ++ m) = true.
Proof.
  induction n as [|n IH]; intros b Hb D; simpl; [auto|].
  destruct (up_ok b Hb) as (Hu & Bu & N); [lia|]. destruct (parent_ok b Hb) as (_ & Hp & Dp & _); [lia|].
  destruct (IH (parent b) Hp) as (P & Z & H); [lia|].
  split; [|split]; auto. intros m Hm. unfold Tree.in_tree. rewrite N. simpl.
  change (opposite W (up b)) with (parent b). replace (depth (parent b)) with n by lia. auto.
Qed.

(** Tree edges do not lose the marker. *)
Lemma homing_tree l m : Forall (fun d => in_tree d = true) l -> homing false m = true ->
  homing false (l ++ m) = true.
Proof. induction 1 as [|d l T _ IH]; simpl; auto. intros H. rewrite T. simpl. auto. Qed.

(** A walk that finds the marker again would be as good if the marker were not lost. *)
Lemma homing_found ds : homing true ds = true -> forall lost, homing lost ds = true.
Proof.
  intros H [|]; auto. revert H. induction ds as [|d ds IH]; simpl; [discriminate|].
  destruct (in_tree d); simpl; [|discriminate]. destruct (depth (opposite W d) =? 0); simpl; auto.
Qed.

(** The darts of the loops: a chord, or one of the ways to its ends. *)
Lemma chord_ok c : In c (chords W depth up) ->
  c < darts W /\ in_tree c = false /\ c < opposite W c.
Proof.
  intros I. apply filter_In in I as [I E]. apply in_seq in I. apply andb_true_iff in E as [T L].
  apply negb_true_iff in T. apply Nat.ltb_lt in L. repeat split; auto. lia.
Qed.

(** The loops of some chords, and a walk from v0, make a walk from v0. *)
Lemma path_loops m l : (forall c, In c l -> c < darts W /\ in_tree c = false) ->
  path (root W) m -> homing false m = true ->
  path (root W) (flat_map (loop W depth up) l ++ m) /\
  homing false (flat_map (loop W depth up) l ++ m) = true.
Proof.
  assert (R := root_lt W WW). intros L P H. induction l as [|c l IH]; simpl; auto.
  destruct IH as [Pl Hl]; [intros; apply L; simpl; auto|]. rewrite <- app_assoc.
  set (rest := flat_map _ l ++ m) in *. destruct (L c) as [Hc T]; [simpl; auto|].
  destruct (opposite_ok c Hc) as (Ho & _). destruct (path_down _ c Hc eq_refl) as (P1 & A1 & F1).
  destruct (path_home _ (opposite W c) Ho eq_refl) as (P2 & Z2 & H2). unfold loop.
  rewrite <- app_assoc. simpl. split.
  - apply path_app. split; auto. simpl. split; auto. split; auto. apply path_app. split; auto.
    set (e := arrival (opposite W c) _) in *. assert (He : e < darts W) by (apply arrival_lt; auto).
    apply path_beside with (root W); auto. apply (beside_sym W HW); auto.
    destruct (bf_home W depth up B e He Z2) as (k & E). exists k; auto.
  - apply homing_tree; auto. simpl. rewrite T. simpl. auto.
Qed.

(** The walk of all loops and of a way down is a walk from v0 that homes. *)
Lemma loops_ok x : x < darts W ->
  path (root W) (loops W depth up x) /\ homing false (loops W depth up x) = true.
Proof.
  intros Hx. destruct (path_down _ x Hx eq_refl) as (P & _ & F). unfold loops. apply path_loops; auto.
  - intros c I. apply chord_ok in I. tauto.
  - rewrite <- (app_nil_r (way_down _ _)). apply homing_tree; auto.
Qed.

(* ---------------------------------------------------------------- inserting stalks *)

(** The upper end of a stalk is one step nearer to v0, and the walk there and back is one of tree
    edges. *)
Lemma stalk_up q : In q stalks -> q < darts W /\ opposite W q < darts W /\
  opposite W (opposite W q) = q /\ in_tree q = true /\ in_tree (opposite W q) = true /\
  depth q <> 0.
Proof.
  intros I. destruct (stalk_ok W depth up q I) as (Hq & _ & _ & N).
  destruct (opposite_ok q Hq) as (Ho & _ & O). assert (D := nearer_ok W depth up HW B q Hq N).
  repeat split; auto; [| |lia]; unfold Tree.in_tree; rewrite ?O, N; auto. apply orb_true_r.
Qed.

(** Inserting keeps a walk a walk that homes; it adds two moves, of the stalk. *)
Lemma insert_ok q ds : In q stalks -> forall a lost, a < darts W -> path a ds ->
  homing lost ds = true -> passes q a ds = true ->
  path a (insert q a ds) /\ homing lost (insert q a ds) = true /\
  length (insert q a ds) = 2 + length ds /\
  forall d, In d (insert q a ds) <-> d = q \/ d = opposite W q \/ In d ds.
Proof.
  intros Q. destruct (stalk_up q Q) as (Hq & Ho & Oo & T & T' & D).
  assert (Here : forall a lost ds, a < darts W -> path a ds -> homing lost ds = true ->
    at_vertex W a (opposite W q) = true ->
    path a (opposite W q :: q :: ds) /\ homing lost (opposite W q :: q :: ds) = true).
  { clear ds. intros a lost ds Ha P H A. apply (at_vertex_iff W WW) in A as (k & E); auto.
    assert (N : beside a (opposite W q)) by (exists k; auto). split.
    - simpl. rewrite Oo. repeat split; auto; [apply beside_refl|].
      apply path_beside with a; auto. apply (beside_sym W HW); auto.
    - simpl. rewrite T, T', Oo. rewrite (proj2 (Nat.eqb_neq _ _) D). simpl. rewrite andb_true_r.
      destruct lost; auto. destruct (depth (opposite W q) =? 0); simpl; auto.
      apply homing_found; auto. }
  induction ds as [|d ds IH]; intros a lost Ha P H V.
  - simpl in *. rewrite orb_false_r in V. rewrite V. destruct (Here a lost [] Ha P H V) as [X Y].
    split; auto. split; auto. split; auto. simpl. intuition auto.
  - simpl in V. simpl Growing.insert. destruct (at_vertex W a (opposite W q)) eqn:A.
    + destruct (Here a lost (d :: ds) Ha P H A) as [X Y]. split; auto. split; auto. split; auto.
      simpl. intuition auto.
    + simpl in P, H. destruct P as (N & Hd & P). destruct (opposite_ok d Hd) as (Hod & _).
      simpl length. simpl In.
      destruct (in_tree d) eqn:Td.
      * destruct (IH _ _ Hod P H V) as (X & Y & Z & In').
        split; [simpl; auto|]. split; [simpl; rewrite Td; auto|]. split; [lia|].
        intros x. rewrite In'. intuition auto.
      * apply andb_true_iff in H as [K H]. destruct (IH _ _ Hod P H V) as (X & Y & Z & In').
        split; [simpl; auto|]. split; [simpl; rewrite Td, K; auto|]. split; [lia|].
        intros x. rewrite In'. intuition auto.
Qed.

(** Does the walk cross the edge of q? *)
Definition crosses ds q := existsb (fun d => edge W d =? edge W q) ds.

(** With enough rounds the walk grows until no stalk that it does not cross starts at a visited
    vertex; each stalk that it did not cross costs at most two moves. *)
Lemma grow_ok n : forall ds, path (root W) ds -> homing false ds = true ->
  length (uncrossed ds) <= n -> forall t, t = grow_walk W depth up n ds ->
  path (root W) t /\ homing false t = true /\
  length t <= length ds + 2 * length (uncrossed ds) /\ (forall d, In d ds -> In d t) /\
  forall q, In q (uncrossed t) -> passes q (root W) t = false.
Proof.
  assert (R := root_lt W WW). induction n as [|n IH]; intros ds P H Le t ->; simpl.
  - destruct (uncrossed ds) eqn:U; [|simpl in Le; lia]. repeat split; auto; [simpl; lia|intros q []].
  - destruct (find _ _) as [q|] eqn:F.
    + apply find_some in F as [I V]. assert (Q := I). apply filter_In in Q as [Q Nc].
      destruct (insert_ok q ds Q (root W) false R P H V) as (P' & H' & Len & In').
      assert (Less : length (uncrossed (insert q (root W) ds)) < length (uncrossed ds)).
      { apply filter_less with q; auto.
        - intros x N. apply negb_true_iff in N. apply negb_true_iff.
          destruct (existsb (fun d => edge W d =? edge W x) ds) eqn:E; auto.
          rewrite <- N. symmetry. apply existsb_exists in E as (d & Id & Ed). apply existsb_exists.
          exists d. split; auto. apply In'. auto.
        - apply negb_false_iff, existsb_exists. exists q. split; [apply In'; auto|].
          apply Nat.eqb_refl. }
      destruct (IH _ P' H' ltac:(lia) _ eq_refl) as (P2 & H2 & Le2 & Sub & Stop).
      split; auto. split; auto. split; [lia|]. split; auto. intros d Id. apply Sub, In'. auto.
    + repeat split; auto; [lia|]. intros q I. apply (find_none _ _ F q I).
Qed.

(** If the walk starts at the upper end of q, it visits it. *)
Lemma passes_here q a ds : a < darts W -> beside a (opposite W q) -> passes q a ds = true.
Proof.
  intros Ha (k & E). assert (A : at_vertex W a (opposite W q) = true).
  { apply (at_vertex_iff W WW); auto. exists k; auto. }
  destruct ds; simpl; rewrite A; auto.
Qed.

(** A walk visits both ends of every dart by which it leaves. *)
Lemma passes_in q d ds : forall a, a < darts W -> path a ds -> In d ds ->
  beside d (opposite W q) \/ beside (opposite W d) (opposite W q) -> passes q a ds = true.
Proof.
  induction ds as [|e ds IH]; simpl; intros a Ha P I N; [destruct I|].
  destruct P as (A & He & P). destruct (opposite_ok e He) as (Ho & _).
  destruct I as [->|I]; [destruct N as [N|N]|].
  - rewrite (proj2 (at_vertex_iff W WW a _ Ha)); auto.
    destruct (beside_trans W a d _ A N) as (k & E). exists k. auto.
  - rewrite passes_here, orb_true_r; auto.
  - rewrite IH, orb_true_r; auto.
Qed.

(** Darts of one edge are equal or opposite. *)
Lemma edge_same d b : d < darts W -> edge W d = edge W b -> b < darts W -> d = b \/ d = opposite W b.
Proof.
  intros Hd E Hb. destruct (opposite_ok d Hd) as (_ & _ & Od), (opposite_ok b Hb) as (_ & _ & Ob).
  destruct (edge_or W d) as [F|F], (edge_or W b) as [G|G]; rewrite F, G in E; auto.
  - right. rewrite <- E. auto.
  - left. congruence.
Qed.

(** The ways between v0 and b consist of the edges from the ancestors of b to their parents. *)
Lemma on_ways n : forall b j, j < n ->
  In (opposite W (up (climb j b))) (way_down n b) /\ In (up (climb j b)) (way_home n b).
Proof.
  induction n as [|n IH]; intros b j Hj; [lia|]. simpl. destruct j as [|j]; simpl.
  - split; auto. apply in_or_app. simpl. auto.
  - destruct (IH (parent b) j) as [X Y]; [lia|]. split; auto. apply in_or_app. auto.
Qed.

(** The darts of a walk are darts of the world. *)
Lemma path_lt ds : forall a d, path a ds -> In d ds -> d < darts W.
Proof.
  induction ds as [|e ds IH]; simpl; intros a d P I; [destruct I|]. destruct P as (_ & He & P).
  destruct I as [->|I]; eauto.
Qed.

(** A walk with all loops, that visits the upper end of no stalk that it does not cross, crosses
    every edge. *)
Lemma all_crossed x t : path (root W) t -> (forall d, In d (loops W depth up x) -> In d t) ->
  (forall q, In q (uncrossed t) -> passes q (root W) t = false) ->
  forall b, b < darts W -> exists d, In d t /\ edge W d = edge W b.
Proof.
  assert (R := root_lt W WW). intros P Sub Stop.
  assert (Eo := edge_opposite W HW).
  assert (Way : forall c b, In c (chords W depth up) -> b = c \/ b = opposite W c ->
    (forall d, In d (way_down (depth b) b) -> In d t) \/
    (forall d, In d (way_home (depth b) b) -> In d t)).
  { intros c b I E. assert (L : forall d, In d (loop W depth up c) -> In d t).
    { intros d Id. apply Sub. apply in_or_app. left. apply in_flat_map. eauto. }
    destruct E as [-> | ->]; [left|right]; intros d Id; apply L; apply in_or_app; simpl; auto. }
  assert (Chord : forall b, b < darts W -> in_tree b = false ->
    exists c, In c (chords W depth up) /\ (b = c \/ b = opposite W c)).
  { intros b Hb T. destruct (opposite_ok b Hb) as (Ho & Ne & Oo).
    assert (T' : in_tree (opposite W b) = false) by (rewrite (in_tree_opposite W depth up HW); auto).
    destruct (le_lt_dec (opposite W b) b) as [L|L]; [exists (opposite W b)|exists b].
    all: split; auto; apply filter_In; split; [apply in_seq; lia|]; rewrite ?T, ?T', ?Oo; simpl.
    all: apply Nat.ltb_lt; lia. }
  assert (Near : forall n c, c < darts W -> nearer c = true -> depth c = n ->
    exists d, In d t /\ edge W d = edge W c).
  { intros n. induction n as [|n IH]; intros c Hc N D;
      destruct (nearer_ok W depth up HW B c Hc N) as (Pc & Uc & Oc & Dc); [lia|].
    destruct (opposite_ok c Hc) as (Ho & _ & Oo).
    destruct (pendant W depth up c) eqn:Pd.
    - destruct (crosses t c) eqn:X.
      { apply existsb_exists in X as (d & I & E). apply Nat.eqb_eq in E. eauto. }
      assert (I : In c (uncrossed t)).
      { apply filter_In. split; [apply filter_In; split; [apply in_seq; lia|]|].
        - rewrite Pd, Uc. apply Nat.eqb_refl.
        - unfold crosses in X. rewrite X. auto. }
      apply Stop in I. exfalso. enough (passes c (root W) t = true) by congruence.
      rewrite Oc in *. destruct (depth (parent c)) as [|m] eqn:Dp.
      + apply passes_here; auto. rewrite Oc. destruct (bf_home W depth up B _ Ho Dp) as (k & E).
        exists k. auto.
      + destruct (up_ok (parent c) Ho) as (Hu & Bu & Nu); [lia|].
        destruct (parent_ok (parent c) Ho) as (_ & _ & _ & Du & _); [lia|].
        destruct (IH (up (parent c)) Hu Nu) as (d & I' & E); [lia|].
        destruct (opposite_ok _ Hu) as (_ & _ & Ou).
        apply (passes_in c d); auto. rewrite Oc. apply (beside_sym W HW) in Bu; auto.
        destruct (edge_same d _ (path_lt _ _ _ P I') E Hu) as [-> | ->]; [left|right]; auto.
        rewrite Ou. auto.
    - unfold pendant in Pd. rewrite (proj2 (Nat.ltb_lt _ _) Pc) in Pd. simpl in Pd.
      apply negb_false_iff, existsb_exists in Pd as (x' & Ix & E). apply in_seq in Ix.
      apply andb_true_iff in E as [T Bl]. apply negb_true_iff in T.
      assert (Hx : x' < darts W) by lia. destruct (Chord x' Hx T) as (e & Ie & Ee).
      unfold below in Bl. apply andb_true_iff in Bl as [Le A]. apply Nat.leb_le in Le.
      destruct (on_ways (depth x') x' (depth x' - depth c)) as [Dn Hm]; [lia|].
      apply (at_vertex_iff W WW) in A as (k & A); auto.
      assert (U : up (climb (depth x' - depth c) x') = c).
      { rewrite <- A. destruct (depth_turn W depth up HW B k c Hc) as [_ ->]. auto. }
      rewrite U in Dn, Hm. destruct (Way e x' Ie Ee) as [Y|Y]; [exists (opposite W c)|exists c]; auto. }
  intros b Hb. destruct (opposite_ok b Hb) as (Ho & _ & Oo). destruct (in_tree b) eqn:T.
  - apply orb_true_iff in T as [T|T]; [apply (Near (depth b)); auto|].
    destruct (Near _ _ Ho T eq_refl) as (d & I & E). exists d. rewrite E. auto.
  - destruct (Chord b Hb T) as (c & I & E). exists c. split.
    + apply Sub. apply in_or_app. left. apply in_flat_map. exists c. split; auto.
      apply in_or_app. simpl. auto.
    + destruct E as [-> | ->]; auto. apply chord_ok in I. symmetry. apply Eo. apply I.
Qed.
End Growing.
