(** Folding a log, as a program (docs/semantics.md, sections 8 and 11; claim 10).

    L      a log                       s         the percepts of its visits
    p, q   places; a, b offsets        f, g      labels: where each visit is found
    r      an arc: two linked places   done, R   the arcs by which a fold goes on from its places

    Each visit is labelled with the first one that is known to be at its vertex. A place is normal if
    its visit is such a first one and its offset is below the degree. The program takes the arcs one by
    one. If an arc leaves by the same dart as one before, the two arrive at one dart, and visits are
    relabelled; the arcs that leave from there are taken again. It ends with a contradiction, or with one
    arc for each dart that was crossed. It is Stallings folding.

    [united_spec] says that it takes for one only what is one; LogFoldExact.v, that it is exact. *)
From Coq Require Import Arith Lia List Bool.
Import ListNotations.
From Topo Require Import World Rotation Mapper Log Determined Entailed.

(** The percepts of all visits. *)
Definition percepts_of L := start L :: map snd (moves L).
Arguments percepts_of : simpl never.

(** Are two places equal? *)
Definition place_eqb (p q : place) := (fst p =? fst q) && (snd p =? snd q).

Section Program.
Variable s : list Percept.

(** The degree of a visit. *)
Definition degree_at i := match nth_error s i with Some p => fst p | None => 0 end.

(** Where a visit is found: the place that is its reference dart. *)
Definition label_of (f : list place) i : place := nth i f (i, 0).

(** The place at the first visit of the vertex. *)
Definition found f (p : place) : place :=
  let (j, o) := label_of f (fst p) in (j, (o + snd p) mod degree_at j).

(** What was found at visit y is found at visit x, where dart 0 of y is dart c. *)
Definition relabelled (f : list place) y x c : list place :=
  map (fun l : place => if fst l =? y then (x, c + snd l) else l) f.

(** Take two normal places that differ for one dart: the later visit is relabelled. None if they cannot
    be one, being turns of each other or unlike. *)
Definition united f (p q : place) : option (list place) :=
  let (x, a) := p in let (y, b) := q in
  if (x =? y) || negb (same_signature (nth x s (0, None)) (nth y s (0, None))) then None
  else Some (if x <? y then relabelled f y x (a + (degree_at y - b))
             else relabelled f x y (b + (degree_at x - a))).

(** Take the arcs of [todo] one by one: each goes on from another place than where it arrives, and from
    one place they all go on to one. None if they cannot. n bounds the number of steps. *)
Fixpoint absorb n f (done todo : list (place * place)) := match n, todo with
  | _, [] => Some (f, done)
  | 0, _ => None
  | S n, (p, q) :: todo => let k := found f p in let m := found f q in
    if place_eqb k m then None else match find (fun r => place_eqb (fst r) k) done with
    | None => absorb n f ((k, m) :: done) todo
    | Some (_, q') => let m' := found f q' in
      if place_eqb m m' then absorb n f done todo else match united f m m' with
      | None => None
      | Some g => let y := Nat.max (fst m) (fst m') in
          let again (r : place * place) := fst (fst r) =? y in
          absorb n g (filter (fun r => negb (again r)) done) (filter again done ++ todo)
      end end
  end.

(** Steps enough for so many arcs. *)
Definition absorbed f done todo :=
  let t := length done + length todo in absorb (S t * S t) f done todo.

(** The labels before the first arc: visits that saw the marker are found at the start. *)
Fixpoint first_labels i (l : list Percept) : list place := match l with
  | [] => []
  | (d, Some j) :: l => (0, (d - j) mod d) :: first_labels (S i) l
  | (d, None) :: l => (i, 0) :: first_labels (S i) l end.
End Program.

(** The arcs of the moves, in both directions. *)
Fixpoint arcs_of_moves i (ms : list (nat * Percept)) : list (place * place) := match ms with
  | [] => []
  | (k, _) :: ms => ((i, k), (S i, 0)) :: ((S i, 0), (i, k)) :: arcs_of_moves (S i) ms end.

(** The fold of a log: its labels and arcs; None if it contradicts. *)
Definition fold_of L :=
  absorbed (percepts_of L) (first_labels 0 (percepts_of L)) [] (arcs_of_moves 0 (moves L)).

(** The fold of L allows that an edge leads from p to q. *)
Definition allows L F p q := match F with
  | Some (f, R) => match absorbed (percepts_of L) f R [(p, q); (q, p)] with
    | Some _ => true | None => false end
  | None => false end.

(** In the fold of L an edge leads from p to q. *)
Definition partners L F p q := match F with
  | Some (f, R) => let n := found (percepts_of L) f in
      existsb (fun r => place_eqb (fst r) (n p) && place_eqb (n (snd r)) (n q)) R
  | None => false end.

(** [place_eqb] decides equality. *)
Lemma place_eqb_eq p q : place_eqb p q = true <-> p = q.
Proof.
  destruct p, q. unfold place_eqb. simpl. rewrite andb_true_iff, !Nat.eqb_eq.
  split; [intros [-> ->]; auto|intros E; injection E; auto].
Qed.

(** A remainder may be taken earlier, also where nothing is divided. *)
Lemma mod_early c r d : (c + r mod d) mod d = (c + r) mod d.
Proof. destruct d as [|d]; [auto|]. apply Nat.add_mod_idemp_r. lia. Qed.

Section Labels.
Variables (L : Log) (A : assumed_edges).
Notation s := (percepts_of L).
Notation found := (found s).
Notation degree_at := (degree_at s).

(** Some world shows the log. *)
Hypothesis Shown : possible nothing L.

(** The degree of a visit, and whether the marker was seen. *)
Definition sign_at i := match seen L i with
  | Some (d, m) => Some (d, match m with Some _ => true | None => false end) | None => None end.

(** The fold of the log alone is consistent. *)
Lemma plain : consistent nothing L.
Proof. apply possible_consistent; auto. intros p q []. Qed.

(** The degree of a visit is the one that was seen. *)
Lemma degree_seen i d m : seen L i = Some (d, m) -> degree_at i = d.
Proof. unfold degree_at, seen, percepts_of. intros ->. auto. Qed.

(** Visits with one sign have one degree. *)
Lemma sign_degree i j : sign_at i = sign_at j -> degree_at i = degree_at j.
Proof.
  unfold sign_at. destruct (seen L i) as [(d, m)|] eqn:E, (seen L j) as [(e, n)|] eqn:F;
    try discriminate.
  - intros H. injection H as -> _. rewrite (degree_seen _ _ _ E), (degree_seen _ _ _ F). auto.
  - unfold degree_at, seen, percepts_of in *. rewrite E, F. auto.
Qed.

(** The labels are right in form: each visit is found at a first one, which has the same sign. *)
Record good_labels (f : list place) : Prop := {
  l_length : length f = length s;
  l_sign : forall i, sign_at (fst (label_of f i)) = sign_at i;
  l_first : forall i, label_of f (fst (label_of f i)) = (fst (label_of f i), 0) }.

(** What is taken for one is one in the fold with the assumed edges. *)
Definition forced f := forall p, valid L p -> same A L p (found f p).

(** A place and its normal form have the same sign. *)
Lemma normal_sign f p : good_labels f -> sign_at (fst (found f p)) = sign_at (fst p).
Proof.
  intros G. assert (H := l_sign f G (fst p)). unfold found. destruct (label_of f (fst p)). auto.
Qed.

(** A place is one of the log exactly if its visit has a sign. *)
Lemma valid_sign p : valid L p <-> sign_at (fst p) <> None.
Proof. unfold valid, sign_at. destruct (seen L (fst p)) as [(d, m)|]; split; congruence. Qed.

(** So the normal form is a place of the log, too. *)
Lemma normal_valid f p : good_labels f -> valid L p -> valid L (found f p).
Proof. rewrite !valid_sign. intros G. rewrite normal_sign; auto. Qed.

(** A normal form is normal. *)
Lemma normal_normal f p : good_labels f -> found f (found f p) = found f p.
Proof.
  intros G. assert (H := l_first f G (fst p)). unfold found. destruct (label_of f (fst p)) as (j, o).
  simpl in *. rewrite H, mod_early. auto.
Qed.

(** Turning a place turns its normal form. *)
Lemma normal_turn f i k a : found f (i, k + a) =
  (fst (found f (i, a)), (k + snd (found f (i, a))) mod degree_at (fst (found f (i, a)))).
Proof.
  unfold found. simpl. destruct (label_of f i) as (j, o). simpl. rewrite mod_early. do 2 f_equal. lia.
Qed.

(** The visit of a place of the log has a degree above 0, and a normal form an offset below it. *)
Lemma normal_below f p : good_labels f -> valid L p -> snd (found f p) < degree_at (fst (found f p)).
Proof.
  intros G V. assert (N := normal_valid f p G V). unfold valid in N.
  destruct (seen L (fst (found f p))) as [(d, m)|] eqn:E; [|congruence].
  assert (D := proj1 (c_percept _ _ plain _ _ _ E)). rewrite (degree_seen _ _ _ E).
  assert (snd (found f p) = snd (found f p) mod d) as ->; [|apply Nat.mod_upper_bound; lia].
  rewrite <- (degree_seen _ _ _ E). unfold found. destruct (label_of f (fst p)) as (j, o). simpl.
  destruct (degree_at j) as [|n]; auto. rewrite Nat.mod_mod; auto.
Qed.

(** What relabelling does to labels and normal forms. *)
Lemma relabelled_spec f y x c : y < length f -> degree_at x = degree_at y ->
  (forall i, label_of (relabelled f y x c) i =
    let l := label_of f i in if fst l =? y then (x, c + snd l) else l) /\
  forall p, found (relabelled f y x c) p =
    let n := found f p in if fst n =? y then (x, (c + snd n) mod degree_at x) else n.
Proof.
  intros Y D. assert (G : forall i, label_of (relabelled f y x c) i =
    let l := label_of f i in if fst l =? y then (x, c + snd l) else l).
  { intros i. unfold label_of, relabelled. destruct (Nat.lt_ge_cases i (length f)) as [H|H].
    - set (h := fun l : place => _).
      rewrite (nth_indep _ (i, 0) (h (i, 0))) by (rewrite map_length; auto).
      apply (map_nth h).
    - rewrite !nth_overflow by (rewrite ?map_length; auto). simpl.
      destruct (Nat.eqb_spec i y); auto. lia. }
  split; auto. intros p. unfold found. rewrite G. destruct (label_of f (fst p)) as (j, o). simpl.
  destruct (Nat.eqb_spec j y) as [->|]; auto. rewrite D, mod_early. do 2 f_equal. lia.
Qed.

(** What is known after two places were taken for one. *)
Record joins f g p q : Prop := {
  j_good : good_labels g;
  j_one : found g p = found g q;
  j_keeps : forall r r', found f r = found f r' -> found g r = found g r';
  j_other : forall r, fst (found f r) <> Nat.max (fst (found f p)) (fst (found f q)) ->
    found g r = found f r;
  j_forced : forced f -> same A L p q -> forced g }.

(** The order of the two does not matter. *)
Lemma joins_sym f g p q : joins f g p q -> joins f g q p.
Proof.
  intros J. split.
  - apply (j_good _ _ _ _ J).
  - symmetry. apply (j_one _ _ _ _ J).
  - apply (j_keeps _ _ _ _ J).
  - intros r N. apply (j_other _ _ _ _ J). rewrite Nat.max_comm. auto.
  - intros F S. apply (j_forced _ _ _ _ J); auto using same_sym.
Qed.

(** Relabelling the later of two visits takes two places for one. *)
Lemma relabelled_joins f p q x a y b : good_labels f -> valid L p -> valid L q ->
  found f p = (x, a) -> found f q = (y, b) -> x < y -> sign_at x = sign_at y ->
  joins f (relabelled f y x (a + (degree_at y - b))) p q.
Proof.
  intros G P Q Ep Eq Lt S. assert (D := sign_degree x y S).
  assert (Bp := normal_below f p G P). assert (Bq := normal_below f q G Q).
  assert (Vq := normal_valid f q G Q). rewrite Ep in Bp. rewrite Eq in Bq, Vq. simpl in Bp, Bq.
  assert (Y : y < length f).
  { rewrite (l_length f G). apply nth_error_Some. exact Vq. }
  destruct (relabelled_spec f y x (a + (degree_at y - b)) Y D) as [Lab Nor].
  assert (First : label_of f x = (x, 0)).
  { assert (H := l_first f G (fst p)). unfold found in Ep.
    destruct (label_of f (fst p)) as (j, o). injection Ep as -> _. exact H. }
  split.
  - split.
    + unfold relabelled. rewrite map_length. apply G.
    + intros i. rewrite Lab. cbv zeta. rewrite <- (l_sign f G i).
      destruct (Nat.eqb_spec (fst (label_of f i)) y) as [E|]; auto. simpl. congruence.
    + intros i. rewrite !Lab. cbv zeta. destruct (Nat.eqb_spec (fst (label_of f i)) y) as [E|N]; simpl.
      * rewrite First. simpl. destruct (Nat.eqb_spec x y); [lia|auto].
      * rewrite (l_first f G). simpl. destruct (Nat.eqb_spec (fst (label_of f i)) y); [tauto|auto].
  - rewrite !Nor, Ep, Eq. simpl. rewrite Nat.eqb_refl. destruct (Nat.eqb_spec x y); [lia|].
    f_equal. replace (a + (degree_at y - b) + b) with (a + 1 * degree_at x) by lia.
    rewrite Nat.mod_add by lia. symmetry. apply Nat.mod_small. auto.
  - intros r r' E. rewrite !Nor, E. auto.
  - intros r N. rewrite Nor. cbv zeta. rewrite Ep, Eq in N. simpl in N.
    destruct (Nat.eqb_spec (fst (found f r)) y); [lia|auto].
  - intros F S' r V. rewrite Nor. cbv zeta.
    destruct (Nat.eqb_spec (fst (found f r)) y) as [E|_]; [|auto].
    apply same_trans with (found f r); auto. destruct (found f r) as (z, o). simpl in E |- *. subst z.
    assert (J : same A L (y, b) (x, a)).
    { rewrite <- Ep, <- Eq. apply same_trans with q; [apply same_sym; auto|].
      apply same_trans with p; [apply same_sym|]; auto. }
    unfold valid in Vq. simpl in Vq. destruct (seen L y) as [(d, m)|] eqn:Sy; [|tauto].
    assert (Dy := degree_seen _ _ _ Sy). rewrite Dy in *.
    destruct (seen L x) as [(d', m')|] eqn:Sx;
      [|unfold sign_at in S; rewrite Sx, Sy in S; discriminate].
    assert (Dx := degree_seen _ _ _ Sx). assert (d' = d) as -> by congruence. rewrite Dx.
    apply same_trans with (x, a + (d - b) + o); [|apply (same_mod A L _ _ _ _ Sx)].
    apply same_trans with (y, o + (d - b) + b).
    + replace (o + (d - b) + b) with (o + d) by lia. apply same_sym.
      rewrite <- (Nat.add_0_r o) at 2. apply same_turn, (same_full A L _ _ _ Sy).
    + replace (a + (d - b) + o) with (o + (d - b) + a) by lia. apply same_turn. auto.
Qed.

(** Two places are taken for one, or no world has both as one dart. *)
Lemma united_spec f p q : good_labels f -> valid L p -> valid L q -> found f p <> found f q ->
  match united s f (found f p) (found f q) with
  | Some g => joins f g p q
  | None => forced f -> same A L p q -> ~ consistent A L end.
Proof.
  intros G P Q Ne. assert (Vp := normal_valid f p G P). assert (Vq := normal_valid f q G Q).
  assert (Bp := normal_below f p G P). assert (Bq := normal_below f q G Q).
  assert (Rp := normal_sign f p G). assert (Rq := normal_sign f q G).
  unfold united. destruct (found f p) as (x, a) eqn:Ep, (found f q) as (y, b) eqn:Eq. cbn [fst snd] in *.
  assert (J : forced f -> same A L p q -> same A L (x, a) (y, b)).
  { intros F S. rewrite <- Ep, <- Eq. apply same_trans with p; [apply same_sym; auto|].
    apply same_trans with q; auto. }
  unfold valid in Vp, Vq. cbn [fst snd] in Vp, Vq. destruct (Nat.eqb_spec x y) as [<-|N].
  - intros F S C. destruct (seen L x) as [(d, m)|] eqn:E; [|tauto].
    rewrite (degree_seen _ _ _ E) in *. apply Ne. f_equal. apply (c_turn A L C x a b d m); auto.
  - assert (Nth : forall z, seen L z <> None -> seen L z = Some (nth z s (0, None))).
    { intros z H. unfold seen in *. fold s in *. destruct (nth_error s z) as [o|] eqn:E; [|tauto].
      f_equal. symmetry. apply nth_error_nth. auto. }
    assert (Sx := Nth x Vp). assert (Sy := Nth y Vq).
    destruct (nth x s (0, None)) as (d, m), (nth y s (0, None)) as (e, n).
    unfold same_signature. cbn [fst snd]. destruct (Nat.eqb_spec d e) as [->|Nd]; cbn [andb orb negb].
    + destruct m as [i|], n as [j|].
      * assert (S : sign_at x = sign_at y) by (unfold sign_at; rewrite Sx, Sy; auto).
        destruct (Nat.ltb_spec x y); [|apply joins_sym]; apply relabelled_joins; auto. lia.
      * intros F S C. apply (c_marker A L C x a y b e i e None); auto.
      * intros F S C. apply (c_marker A L C y b x a e j e None); auto using same_sym.
      * assert (S : sign_at x = sign_at y) by (unfold sign_at; rewrite Sx, Sy; auto).
        destruct (Nat.ltb_spec x y); [|apply joins_sym]; apply relabelled_joins; auto. lia.
    + intros F S C. apply Nd, (c_degree A L C x a y b d m e n); auto.
Qed.
End Labels.
