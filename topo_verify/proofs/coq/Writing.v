(** Every certificate that is accepted can be written as numbers (claims 9 and 10): a writer for the
    format of Certificate.v, and that what it writes is read.

    r      a reader       w     what writes the things that r reads: a list of numbers of each
    x, l   a thing, the numbers behind it        P     which things are within the limits of the format

    The limits: numbers of the log and of tables are at most a million; all others may have any size. *)
From Coq Require Import Arith Lia List NArith Bool.
Import ListNotations.
From Topo Require Import World Log Table Checker Events Decisions Certificate.

(** What w writes of a thing within the limits is read by r, and it is something. *)
Definition read_back {X} (r : reader X) (w : X -> list N) (P : X -> Prop) := forall x l, P x ->
  w x <> [] /\ r (w x ++ l) = Some (x, l).

(** At most a million. *)
Definition in_limit n := (N.of_nat n <= 1000000)%N.

(** One number. *)
Definition write_natural n := [N.of_nat n].
(** A visit or a move. *)
Definition write_positive x := [Npos x].
(** 0 or 1. *)
Definition write_flag (b : bool) := [if b then 1%N else 0%N].
(** 0, or the number plus 1. *)
Definition write_optional (o : option nat) := [match o with None => 0%N | Some n => N.of_nat (S n) end].
(** The length, and the elements. *)
Definition write_many {X} (w : X -> list N) xs := N.of_nat (length xs) :: flat_map w xs.
(** One and the other. *)
Definition write_pair {X Y} (w : X -> list N) (v : Y -> list N) (p : X * Y) := w (fst p) ++ v (snd p).
(** 0, or 1 and the thing. *)
Definition write_perhaps {X} (w : X -> list N) (o : option X) := match o with
  | None => [0%N] | Some x => 1%N :: w x end.

(** An optional number within the limit. *)
Definition optional_limit (o : option nat) := match o with None => True | Some n => in_limit (S n) end.
(** Both are within their limits. *)
Definition both {X Y} (P : X -> Prop) (Q : Y -> Prop) (p : X * Y) := P (fst p) /\ Q (snd p).
(** What is there is within its limits. *)
Definition if_there {X} (P : X -> Prop) (o : option X) := match o with None => True | Some x => P x end.

(** Numbers are read back. *)
Lemma read_number : read_back number (fun n => [n]) (fun _ => True).
Proof. intros x l _. split; [discriminate|auto]. Qed.

(** Numbers within the limit are read back. *)
Lemma read_natural : read_back natural write_natural in_limit.
Proof.
  intros n l Hn. split; [discriminate|]. unfold natural, write_natural. simpl.
  unfold in_limit in Hn. rewrite (proj2 (N.leb_le _ _) Hn), Nat2N.id. auto.
Qed.

(** Positive numbers are read back. *)
Lemma read_positive : read_back positive_number write_positive (fun _ => True).
Proof. intros x l _. split; [discriminate|auto]. Qed.

(** Flags are read back. *)
Lemma read_flag : read_back flag write_flag (fun _ => True).
Proof. intros [|] l _; (split; [discriminate|auto]). Qed.

(** Optional numbers are read back. *)
Lemma read_optional : read_back optional write_optional optional_limit.
Proof.
  intros o l Ho. split; [discriminate|]. unfold optional, and_then, give.
  destruct o as [n|]; [|auto]. change (write_optional (Some n)) with (write_natural (S n)).
  rewrite (proj2 (read_natural (S n) l Ho)). auto.
Qed.

(** Lists are read back. *)
Lemma read_many {X} (r : reader X) w P : read_back r w P ->
  read_back (many r) (write_many w) (Forall P).
Proof.
  intros R xs l F. split; [discriminate|]. unfold many, and_then, number, write_many. simpl.
  assert (E : forall xs fuel, Forall P xs -> length xs <= length fuel ->
    elements r fuel (N.of_nat (length xs)) (flat_map w xs ++ l) = Some (xs, l)).
  { clear xs F. intros xs. induction xs as [|x xs IH]; intros fuel F L; [destruct fuel; auto|].
    inversion F as [|y ys Px Pxs E]. destruct fuel as [|n fuel]; simpl in L; [lia|].
    simpl flat_map. rewrite <- app_assoc. cbn [length]. rewrite Nat2N.inj_succ.
    destruct (N.succ (N.of_nat (length xs))) as [|p] eqn:Q; [lia|]. cbn [elements].
    unfold and_then, give. rewrite (proj2 (R x _ Px)).
    replace (N.pred (N.pos p)) with (N.of_nat (length xs)) by lia. rewrite IH by (auto; lia). auto. }
  apply E; auto. rewrite app_length. apply Nat.le_trans with (length (flat_map w xs)); [|lia].
  clear E. induction F as [|x xs Px F IH]; simpl; auto. rewrite app_length.
  destruct (R x [] Px) as [N _]. destruct (w x); [destruct N; auto|simpl; lia].
Qed.

(** Pairs are read back. *)
Lemma read_pair {X Y} (r : reader X) (s : reader Y) w v P Q : read_back r w P -> read_back s v Q ->
  read_back (pair_of r s) (write_pair w v) (both P Q).
Proof.
  intros R S (x, y) l [Px Qy]. simpl in Px, Qy. unfold write_pair, pair_of, and_then, give. simpl.
  destruct (R x (v y ++ l) Px) as [N E]. rewrite <- app_assoc, E, (proj2 (S y l Qy)). split; auto.
  destruct (w x); [destruct N; auto|discriminate].
Qed.

(** What may be missing is read back. *)
Lemma read_perhaps {X} (r : reader X) w P : read_back r w P ->
  read_back (perhaps r) (write_perhaps w) (if_there P).
Proof.
  intros R [x|] l Px; (split; [discriminate|]); [|auto]. unfold perhaps, and_then, give. simpl.
  rewrite (proj2 (R x l Px)). auto.
Qed.

(** A percept. *)
Definition write_percept := write_pair write_natural write_optional.
(** An event. *)
Definition write_event ev := match ev with
  | Move k q => 0%N :: write_natural k ++ write_percept q
  | Reject e h => 1%N :: write_natural e ++ write_natural h
  | Confirm e h => 2%N :: write_natural e ++ write_natural h
  | Loop e h d => 3%N :: write_natural e ++ write_natural h ++ write_natural d
  | New e a d => 4%N :: write_natural e ++ write_natural a ++ write_natural d end.
(** A delivered map. *)
Definition write_delivery D := write_many (write_many (fun n => [n])) (rotations D) ++
  write_many (write_pair (fun n => [n]) (fun n => [n])) (pairs D) ++ [marked_label D].
(** A row of a table. *)
Definition write_row := write_pair (write_pair write_natural write_natural) write_optional.
(** A pair of arcs. *)
Definition write_meeting :=
  write_pair (write_pair write_flag write_positive) (write_pair write_flag write_positive).
(** A conflict. *)
Definition write_conflict x := match x with
  | Arrive s => 0%N :: write_meeting s
  | Marked x => 1%N :: write_positive x
  | Alone x => 2%N :: write_positive x end.
(** A reason. *)
Definition write_reason x := match x with
  | Refuted ev x => 1%N :: write_many write_meeting ev ++ write_conflict x
  | Joined a => 0%N :: write_pair write_flag write_positive a end.
(** A claim. *)
Definition write_claim x := match x with
  | Proved t ev psi => 0%N :: write_many write_row t ++ write_many write_meeting ev ++
      write_perhaps (write_many (write_pair write_natural write_natural)) psi
  | Undecided t => 1%N :: write_many write_row t
  | Absurd ev x => 2%N :: write_many write_meeting ev ++ write_conflict x end.
(** A certificate. *)
Definition write_certificate c := write_percept (sensed c) ++ write_many write_event (events c) ++
  write_perhaps write_delivery (handed c) ++ write_claim (claimed c) ++
  write_many write_meeting (merges c) ++ write_many (write_many write_reason) (reasons c).

(** The percept is within the limits. *)
Definition percept_limit : Percept -> Prop := both in_limit optional_limit.
(** So is the event. *)
Definition event_limit ev := match ev with
  | Move k q => in_limit k /\ percept_limit q
  | Reject e h | Confirm e h => in_limit e /\ in_limit h
  | Loop e h d | New e h d => in_limit e /\ in_limit h /\ in_limit d end.
(** So is the table. *)
Definition table_limit : map_table -> Prop := Forall (both (both in_limit in_limit) optional_limit).
(** So is the claim. *)
Definition claim_limit x := match x with
  | Proved t _ psi => table_limit t /\ if_there (Forall (both in_limit in_limit)) psi
  | Undecided t => table_limit t
  | Absurd _ _ => True end.
(** So is the certificate: its log and its tables. *)
Definition within_limits c := percept_limit (sensed c) /\ Forall event_limit (events c) /\
  claim_limit (claimed c).

(** A tactic: what has been written is read, one part after the other. *)
Ltac reading R := rewrite <- ?app_assoc; unfold and_then at 1;
  rewrite (fun x l P => proj2 (R x l P)) by auto.

(** Percepts are read back. *)
Lemma read_percept : read_back a_percept write_percept percept_limit.
Proof. apply read_pair; [apply read_natural|apply read_optional]. Qed.

(** Events are read back. *)
Lemma read_event : read_back an_event write_event event_limit.
Proof.
  intros [k q|e h|e h|e h d|e h d] l L; (split; [discriminate|]); unfold an_event, write_event, number;
    cbn [app]; unfold and_then at 1; simpl in L.
  - destruct L as [A B]. reading read_natural. reading read_percept. auto.
  - destruct L as [A B]. reading read_natural. reading read_natural. auto.
  - destruct L as [A B]. reading read_natural. reading read_natural. auto.
  - destruct L as (A & B & C). reading read_natural. reading read_natural. reading read_natural. auto.
  - destruct L as (A & B & C). reading read_natural. reading read_natural. reading read_natural. auto.
Qed.

(** Numbers alone are within the limits. *)
Lemma all_free {X} (l : list X) : Forall (fun _ => True) l.
Proof. apply Forall_forall. auto. Qed.

(** Lists of lists, too. *)
Lemma all_lists_free {X} (l : list (list X)) : Forall (Forall (fun _ => True)) l.
Proof. apply Forall_forall. intros x _. apply all_free. Qed.

(** Deliveries are read back. *)
Lemma read_delivery : read_back a_delivery write_delivery (fun _ => True).
Proof.
  intros D l _. assert (Rows := read_many _ _ _ (read_many _ _ _ read_number)).
  assert (Pairs := read_many _ _ _ (read_pair _ _ _ _ _ _ read_number read_number)).
  split; [discriminate|]. unfold a_delivery, write_delivery.
  assert (A := all_lists_free (rotations D)).
  assert (B : Forall (both (fun _ : N => True) (fun _ : N => True)) (pairs D))
    by (apply Forall_forall; split; auto).
  reading Rows. reading Pairs. unfold and_then, number, give. simpl. destruct D; auto.
Qed.

(** Rows are read back. *)
Lemma read_row : read_back a_row write_row (both (both in_limit in_limit) optional_limit).
Proof. apply read_pair; [apply read_pair; apply read_natural|apply read_optional]. Qed.

(** Pairs of arcs are read back. *)
Lemma read_meeting : read_back a_meeting write_meeting (fun _ => True).
Proof.
  intros s l _. apply (read_pair _ _ _ _ _ _ (read_pair _ _ _ _ _ _ read_flag read_positive)
    (read_pair _ _ _ _ _ _ read_flag read_positive)). repeat split.
Qed.

(** Conflicts are read back. *)
Lemma read_conflict : read_back a_conflict write_conflict (fun _ => True).
Proof.
  intros [s|x|x] l _; (split; [discriminate|]); unfold a_conflict, write_conflict, number; cbn [app];
    unfold and_then at 1; [reading read_meeting|reading read_positive|reading read_positive]; auto.
Qed.

(** Reasons are read back. *)
Lemma read_reason : read_back a_reason write_reason (fun _ => True).
Proof.
  intros [a|ev x] l _; (split; [discriminate|]); unfold a_reason, write_reason, flag; cbn [app];
    unfold and_then at 1.
  - assert (R := read_pair _ _ _ _ _ _ read_flag read_positive).
    assert (A : both (fun _ : bool => True) (fun _ : positive => True) a) by (split; auto).
    reading R. auto.
  - assert (R := read_many _ _ _ read_meeting). assert (A := all_free ev). reading R.
    reading read_conflict. auto.
Qed.

(** Claims are read back. *)
Lemma read_claim : read_back a_claim write_claim claim_limit.
Proof.
  assert (Rows := read_many _ _ _ read_row). assert (Ev := read_many _ _ _ read_meeting).
  assert (Psi := read_perhaps _ _ _ (read_many _ _ _ (read_pair _ _ _ _ _ _ read_natural read_natural))).
  intros [t ev psi|t|ev x] l L; (split; [discriminate|]); unfold a_claim, write_claim, number; cbn [app];
    unfold and_then at 1; simpl in L.
  - destruct L as [A B]. assert (C := all_free ev). reading Rows. reading Ev. reading Psi. auto.
  - reading Rows. auto.
  - assert (C := all_free ev). reading Ev. reading read_conflict. auto.
Qed.

(** A certificate within the limits is read from what is written. *)
Lemma read_certificate c : within_limits c -> read (write_certificate c) = Some c.
Proof.
  intros (A & B & C). assert (Es := read_many _ _ _ read_event).
  assert (Ds := read_perhaps _ _ _ read_delivery). assert (Ev := read_many _ _ _ read_meeting).
  assert (Rs := read_many _ _ _ (read_many _ _ _ read_reason)).
  assert (D : if_there (fun _ : Delivery => True) (handed c)) by (destruct (handed c); simpl; auto).
  assert (E := all_free (merges c)). assert (F := all_lists_free (reasons c)).
  unfold read, a_certificate, write_certificate.
  assert (Log : forall l, read_log (write_percept (sensed c) ++ write_many write_event (events c) ++
    write_perhaps write_delivery (handed c) ++ l) = Some ((sensed c, events c, handed c), l)).
  { intros l. assert (R := read_pair _ _ _ _ _ _ (read_pair _ _ _ _ _ _ read_percept Es) Ds).
    assert (Q : both (both percept_limit (Forall event_limit)) (if_there (fun _ : Delivery => True))
      (sensed c, events c, handed c)) by (split; [split; auto|auto]).
    apply (fun H => proj2 (R _ l H)) in Q. unfold write_pair in Q. simpl in Q.
    rewrite <- !app_assoc in Q. exact Q. }
  unfold and_then at 1. rewrite Log. reading read_claim. reading Ev.
  unfold and_then. rewrite <- (app_nil_r (write_many _ (reasons c))), (proj2 (Rs (reasons c) [] F)).
  destruct c; auto.
Qed.

(** Every certificate that is accepted, and is within the limits of the format, is a list of numbers
    that the check accepts.
    Not in the paper. *)
Theorem written_accepted c : within_limits c -> accepts c = true ->
  read (write_certificate c) = Some c /\ check_numbers (write_certificate c) = true.
Proof.
  intros L A. assert (R := read_certificate c L). split; auto. unfold check_numbers. rewrite R. auto.
Qed.
