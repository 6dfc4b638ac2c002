(** Certificates as data: what a list of numbers says, and the check that it is true (claims 9 and
    10; docs/proofs.md).

    A certificate is a list of natural numbers: a log with its decisions and the delivered map, a
    claim about the log, and evidence. It holds nothing else, so it can neither define nor prove
    anything. SCEPTICS READ [says], which is what is proved of a certificate that [accepts]
    accepts, and for the format [read_log] and what it uses.

    l is the rest of the list, n a number, c a certificate, L its log, t a table, ev evidence.

      log        percept, number of events, events; 0, or 1 and the delivered map
      percept    degree, optional direction of the marker
      event      0 door percept; 1 e h (reject); 2 e h (confirm); 3 e h d (loop); 4 e a d (new)
      map        rotations (a list of lists), pairs (a list), the marked dart (0 if there is none)
      claim      0 table, evidence, 0 or 1 and the numbering of the delivered map (the map is proved;
                 a table without a row is the world of one vertex without an edge)
                 1 table (two worlds show the log); 2 evidence, conflict (no world shows the log)
      decisions  merges of the log; for each decision the list of its reasons, none if it is not
                 proved

    A list is its length and its elements. An optional number is 0, or the number plus 1. *)
From Coq Require Import List NArith Bool.
Import ListNotations.
From Topo Require Import World Log AnyWorld Undetermined Table TableCorrect Checker CheckerCorrect
  Events Decisions DecisionsCorrect Delivered.

(** What a certificate claims of its log, with the evidence: this table is its map, and if it is
    numbered, the delivered map; two worlds show the log; no world shows it. *)
Inductive claim := Proved (t : map_table) (ev : evidence) (numbering : option (list (nat * nat)))
  | Undecided (t : map_table) | Absurd (ev : evidence) (c : conflict).

(** A certificate: the log, with decisions and the delivered map; the claim; the merges of the log and
    the reasons for its decisions. *)
Record certificate := { sensed : Percept; events : list event; handed : option Delivery;
  claimed : claim; merges : evidence; reasons : list (list reason) }.

(** The moves of the certificate's log. *)
Definition log_in c := log_after (sensed c) (events c).

(** The world that the table describes; without a row it is the point. *)
Definition world_of (t : map_table) := match t with [] => Point | _ => Edges (map_of t) end.

(** The delivery is right in w. Of the point it is one vertex without a dart, and no pair. *)
Definition right_in D w := match w with
  | Point => rotations D = [[]] /\ pairs D = []
  | Edges W => right_delivery D W end.

(** What is proved of a certificate: its claim about the log of its moves, and that each decision
    with a reason follows from the events before it. In the point no decision is true. *)
Definition says c := match claimed c with
  | Proved t _ numbering => shows_log (world_of t) (log_in c) /\
      forall w, shows_log w (log_in c) -> alike (world_of t) w /\
        (numbering <> None -> exists D, handed c = Some D /\ right_in D w)
  | Undecided _ => undetermined (log_in c)
  | Absurd _ _ => forall w, ~ shows_log w (log_in c) end /\
  forall before e after, events c = before ++ e :: after -> is_decision e = true ->
    reasoned (reasons c) (decisions before) ->
    event_follows (sensed c) before e /\ ~ shows_log Point (log_after (sensed c) before).

(** The check of a delivery of the point. *)
Definition no_dart D := match rotations D, pairs D with [[]], [] => true | _, _ => false end.

(** The check of the claim that the table is the map of the log. *)
Definition shown L t ev := match t with [] => of_point L | _ => certified L t ev end.

(** The check that the delivered map is the table. *)
Definition delivered D t psi := match t with [] => no_dart D | _ => check_delivery D t psi end.

(** The check of a certificate. *)
Definition accepts c := match claimed c with
  | Proved t ev numbering => shown (log_in c) t ev && match numbering, handed c with
      | None, _ => true
      | Some psi, Some D => delivered D t psi
      | Some _, None => false end
  | Undecided t => refute (log_in c) t
  | Absurd ev x => impossible (log_in c) ev x && negb (of_point (log_in c)) end &&
  decided (sensed c) (events c) (merges c) (reasons c).

(** A table that [shown] accepts is the only world that shows the log. *)
Lemma shown_correct L t ev : shown L t ev = true ->
  shows_log (world_of t) L /\ forall w, shows_log w L -> alike (world_of t) w.
Proof.
  destruct t as [|r t]; unfold shown; intros H.
  - apply of_point_spec in H. split; auto. intros [|W] Sh; simpl; auto.
    destruct (edges_seen W L); [apply Sh..|apply H].
  - apply certified_correct in H as (A & B & C). split; [simpl; auto|]. intros [|W] Sh.
    + destruct (edges_seen (map_of (r :: t)) L A B). apply Sh.
    + apply C; apply Sh.
Qed.

(** A delivery that [delivered] accepts is right in every world that is the table. *)
Lemma delivered_correct L D t psi w : shows_log (world_of t) L -> delivered D t psi = true ->
  alike (world_of t) w -> right_in D w.
Proof.
  destruct t as [|r t], w as [|W]; simpl; try tauto.
  - intros _. unfold no_dart. destruct (rotations D) as [|[|x l] [|l' ls]], (pairs D); try discriminate.
    auto.
  - intros [HW _] C. apply (check_delivery_right D (r :: t) psi W HW C).
Qed.

(** At a vertex without a door no decision is proved: the map S has no open dart. *)
Lemma nothing_decided es ev rss q : fst q = 0 -> decided q es ev rss = true -> forall n,
  ~ reasoned rss n.
Proof.
  unfold decided, reasoned, first_sketch. intros ->. generalize (outset q) as m. revert rss ev.
  set (s := {| size := 0; opened := seen_from _ 0 0 _ |}).
  induction es as [|e es IH]; intros rss ev m H n.
  - destruct rss; [|discriminate]. destruct n; auto.
  - simpl in H. destruct (is_decision e) eqn:De; [|apply (IH rss ev _ H)].
    destruct rss as [|[|r rs] rss]; [destruct n; auto| |].
    + apply andb_true_iff in H as [_ H]. destruct n as [|n]; [auto|apply (IH rss ev m H n)].
    + destruct (settle m ev) as [m' ev'].
      assert (J : judge m' s e (r :: rs) = None) by (destruct e; simpl; destruct rs, r; auto).
      rewrite J in H. discriminate.
Qed.

(** What [accepts] accepts is true. *)
Theorem accepts_correct c : accepts c = true -> says c.
Proof.
  unfold accepts, says. rewrite andb_true_iff. intros [H D]. split.
  - destruct (claimed c) as [t ev numbering|t|ev x].
    + apply andb_true_iff in H as [H N]. apply shown_correct in H as [A B]. split; auto.
      intros w Sh. split; auto. intros S.
      destruct numbering as [psi|], (handed c) as [d|]; try discriminate; try (destruct S; auto; fail).
      exists d. split; auto. apply (delivered_correct (log_in c) d t psi w); auto.
    + apply (refute_correct _ t), H.
    + apply andb_true_iff in H as [H P]. intros [|W] Sh.
      * apply of_point_spec in Sh. rewrite Sh in P. discriminate.
      * apply (impossible_correct _ ev x H W); apply Sh.
  - intros before e after E De R. split; [apply (decided_correct _ _ _ _ D before e after); auto|].
    intros [Sq _]. simpl in Sq. apply (nothing_decided _ _ _ _ (f_equal fst Sq) D _ R).
Qed.

(** A reader takes what it reads from the front of the list; it may refuse. *)
Definition reader X := list N -> option (X * list N).

(** Read one thing, and then another that may depend on it. *)
Definition and_then {X Y} (r : reader X) (f : X -> reader Y) : reader Y := fun l =>
  match r l with Some (x, l) => f x l | None => None end.

(** Read nothing. *)
Definition give {X} (x : X) : reader X := fun l => Some (x, l).

(** Any number. *)
Definition number : reader N := fun l => match l with n :: l => Some (n, l) | [] => None end.

(** A number up to a million, as Coq counts: larger ones are refused before they are unfolded. *)
Definition natural : reader nat := fun l => match l with
  | n :: l => if (n <=? 1000000)%N then Some (N.to_nat n, l) else None
  | [] => None end.

(** A visit or a move, counted from 1. *)
Definition positive_number : reader positive := fun l => match l with
  | Npos x :: l => Some (x, l) | _ => None end.

(** 0 or 1. *)
Definition flag : reader bool := fun l => match l with
  | N0 :: l => Some (false, l) | Npos xH :: l => Some (true, l) | _ => None end.

(** An optional number. *)
Definition optional : reader (option nat) := and_then natural (fun n => give (match n with
  | 0 => None | S n => Some n end)).

(** So many elements; there are at most as many as numbers left, [fuel]. *)
Fixpoint elements {X} (r : reader X) (fuel : list N) (n : N) : reader (list X) := match n with
  | N0 => give []
  | _ => match fuel with [] => fun _ => None | _ :: fuel =>
      and_then r (fun x => and_then (elements r fuel (N.pred n)) (fun xs => give (x :: xs))) end end.

(** A list: its length and its elements. *)
Definition many {X} (r : reader X) : reader (list X) := and_then number (fun n l => elements r l n l).

(** Two things. *)
Definition pair_of {X Y} (r : reader X) (s : reader Y) : reader (X * Y) :=
  and_then r (fun x => and_then s (fun y => give (x, y))).

(** 0, or 1 and the thing. *)
Definition perhaps {X} (r : reader X) : reader (option X) := and_then flag (fun b =>
  if b : bool then and_then r (fun x => give (Some x)) else give None).

(** A percept. *)
Definition a_percept : reader Percept := pair_of natural optional.

(** An event. *)
Definition an_event : reader event := and_then number (fun n => match n with
  | 0 => and_then natural (fun k => and_then a_percept (fun q => give (Move k q)))
  | 1 => and_then natural (fun e => and_then natural (fun h => give (Reject e h)))
  | 2 => and_then natural (fun e => and_then natural (fun h => give (Confirm e h)))
  | 3 => and_then natural (fun e => and_then natural (fun h => and_then natural (fun d =>
      give (Loop e h d))))
  | 4 => and_then natural (fun e => and_then natural (fun a => and_then natural (fun d =>
      give (New e a d))))
  | _ => fun _ => None end%N).

(** A delivered map. *)
Definition a_delivery : reader Delivery := and_then (many (many number)) (fun r =>
  and_then (many (pair_of number number)) (fun p => and_then number (fun m =>
    give {| rotations := r; pairs := p; marked_label := m |}))).

(** A log: the percept at the start, the events, and the delivered map if there is one. *)
Definition read_log : reader (Percept * list event * option Delivery) :=
  pair_of (pair_of a_percept (many an_event)) (perhaps a_delivery).

(** A row of a table. *)
Definition a_row := pair_of (pair_of natural natural) optional.

(** A pair of arcs. *)
Definition a_meeting := pair_of (pair_of flag positive_number) (pair_of flag positive_number).

(** A conflict. *)
Definition a_conflict : reader conflict := and_then number (fun n => match n with
  | 0 => and_then a_meeting (fun s => give (Arrive s))
  | 1 => and_then positive_number (fun x => give (Marked x))
  | 2 => and_then positive_number (fun x => give (Alone x))
  | _ => fun _ => None end%N).

(** A reason. *)
Definition a_reason : reader reason := and_then flag (fun b => if b : bool
  then and_then (many a_meeting) (fun ev => and_then a_conflict (fun x => give (Refuted ev x)))
  else and_then (pair_of flag positive_number) (fun a => give (Joined a))).

(** A claim. *)
Definition a_claim : reader claim := and_then number (fun n => match n with
  | 0 => and_then (many a_row) (fun t => and_then (many a_meeting) (fun ev =>
           and_then (perhaps (many (pair_of natural natural))) (fun psi => give (Proved t ev psi))))
  | 1 => and_then (many a_row) (fun t => give (Undecided t))
  | 2 => and_then (many a_meeting) (fun ev => and_then a_conflict (fun x => give (Absurd ev x)))
  | _ => fun _ => None end%N).

(** A certificate. *)
Definition a_certificate : reader certificate := and_then read_log (fun s => and_then a_claim (fun x =>
  and_then (many a_meeting) (fun ev => and_then (many (many a_reason)) (fun rss => give
    {| sensed := fst (fst s); events := snd (fst s); handed := snd s; claimed := x; merges := ev;
       reasons := rss |})))).

(** The certificate that the numbers are, to the last. *)
Definition read l := match a_certificate l with Some (c, []) => Some c | _ => None end.

(** The numbers are a certificate, and what it says is true. *)
Definition proves_itself l := exists c, read l = Some c /\ says c.

(** The check of the numbers. *)
Definition check_numbers l := match read l with Some c => accepts c | None => false end.

(** In short: 0, 1 or 2 for the claim; 1 if the delivered map is right; how many decisions are proved,
    and how many there are. *)
Definition summary l : option (N * N * (N * N)) := match read l with
  | Some c => Some (match claimed c with
      | Proved _ _ None => (0, 0) | Proved _ _ (Some _) => (0, 1)
      | Undecided _ => (1, 0) | Absurd _ _ => (2, 0) end,
      (N.of_nat (length (filter (fun rs => match rs with [] => false | _ => true end) (reasons c))),
       N.of_nat (decisions (events c))))
  | None => None end%N.

(** The theorem about certificates: numbers that pass the check say what is true.
    Not in the paper. *)
Theorem check_numbers_correct l : check_numbers l = true -> proves_itself l.
Proof.
  unfold check_numbers, proves_itself. destruct (read l) as [c|]; [|discriminate].
  intros H. exists c. split; auto. apply accepts_correct, H.
Qed.
