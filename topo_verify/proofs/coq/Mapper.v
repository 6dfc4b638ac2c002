(** An executable mapper: the loop of docs/semantics.md, section 4, for every motion and rule of
    sections 7 and 8 (listings 1, 2 and 3 of the paper; folding).

    The mapper is a program, so it cannot look at the world. The policies, the motion and the rule
    are parameters.

    M     the map S                      T     what the rule remembers of earlier edges
    e     the dart being explored        v     the robot: what it senses, and how far it has turned
    pu    the percept behind e           H     the hypotheses, each with its way home
    h     a hypothesis                   k, w  a door, doors
    ds    the doors from vu to where the robot stands, qs the percepts behind them
    log   the sequences of this edge, the last one first
    t     the trail: all moves since the start, the last one first *)
From Coq Require Import Arith Lia List Bool Permutation.
Import ListNotations.
From Topo Require Import World Rotation Embedding Vertices Augment Program.

(** The robot: what it senses, and how far it has turned away from its reference dart. *)
Definition robot : Type := Percept * nat.

(** A sequence: doors that were executed behind e, up to the one where a percept differed, and the
    percepts behind them. *)
Definition sequence : Type := list nat * list Percept.

(** A hypothesis: the dart, and the doors of its way home. *)
Definition hypothesis : Type := nat * list nat.

(** A rule: what it remembers, at the start and after each edge; which hypotheses it keeps; and which
    of those it concludes to be true. It sees the map, e, the percept behind e, all sequences of this
    edge, the trail and, by its memory, what it saw earlier. When it learns, the map has grown: e and
    the dart of entry are partners; and it is told the trail as it was when the robot came to vu. *)
Record Rule := { memory : Type; fresh : memory;
  keep : Map -> nat -> Percept -> memory -> list sequence -> robot_trail -> hypothesis -> bool;
  concludes : Map -> nat -> Percept -> memory -> list sequence -> robot_trail -> hypothesis -> bool;
  learn : Map -> nat -> nat -> memory -> list sequence -> robot_trail -> memory }.

(** A motion: which hypothesis is walked next, and how many of the doors ds it shares. *)
Definition Motion : Type := list nat -> list hypothesis -> option (hypothesis * nat).

(** Leave by door k, counted from the direction in which the robot faces. *)
Definition go_on (v : robot) k : program robot :=
  Leave ((snd v + k) mod fst (fst v)) (fun q => Return (q, 0)).

(** Undo the move by door k. *)
Definition go_back (v : robot) k : program robot :=
  Leave (snd v) (fun q => Return (q, (fst q - k) mod fst q)).

(** Take the doors w one after the other. *)
Fixpoint execute (v : robot) w : program robot :=
  match w with [] => Return v | k :: w => bind (go_on v k) (fun v => execute v w) end.

(** Undo the doors ks, which are listed from the last one to the first. *)
Fixpoint undo (v : robot) ks : program robot :=
  match ks with [] => Return v | k :: ks => bind (go_back v k) (fun v => undo v ks) end.

(** The robot is believed to be at dart x: execute w, up to the first percept that differs from the
    map's. Returns whether all agreed, the percepts, and the robot, which stays. *)
Fixpoint follow M x w (v : robot) : program (bool * list Percept * robot) :=
  match w with
  | [] => Return (true, [], v)
  | k :: w =>
    match move M x k with
    | Some y => bind (go_on v k) (fun u =>
        if percept_eqb (percept M y) (fst u)
        then bind (follow M y w u) (fun r => Return (fst (fst r), fst u :: snd (fst r), snd r))
        else Return (false, [fst u], u))
    | None => Stuck
    end
  end.

(** Do two lists of percepts agree? *)
Fixpoint percepts_eqb (ps qs : list Percept) := match ps, qs with
  | [], [] => true | p :: ps, q :: qs => percept_eqb p q && percepts_eqb ps qs | _, _ => false end.

(** [percepts_eqb] decides equality of lists of percepts. *)
Lemma percepts_eqb_spec ps : forall qs, reflect (ps = qs) (percepts_eqb ps qs).
Proof.
  induction ps as [|p ps IH]; intros [|q qs]; simpl; try (constructor; congruence).
  destruct (percept_eqb_spec p q), (IH qs); simpl; constructor; congruence.
Qed.

(** Do two percepts have the same signature: equal degrees, and the marker at both or at neither? *)
Definition same_signature (p q : Percept) :=
  (fst p =? fst q) &&
  match snd p, snd q with Some _, Some _ => true | None, None => true | _, _ => false end.

(** Every percept has the same signature as itself. *)
Lemma same_signature_refl p : same_signature p p = true.
Proof. unfold same_signature. rewrite Nat.eqb_refl. destruct (snd p); auto. Qed.

Section Mapper.
Variables (pick : Map -> nat -> option nat) (path : Map -> nat -> nat -> list nat * nat)
          (order : Map -> list nat -> list nat) (motion : Motion) (rule : Rule).

(** h was concluded, so the robot would come in by h at vu. Where it sees the marker it knows which dart
    it faces, and stays; elsewhere it goes back to vu by the doors ds. Returns h and the dart of the map
    that it faces then, the sequences, the robot and the trail. *)
Definition concluded M h (log : list sequence) ds (v : robot) t := match snd (fst v) with
  | Some j => Return (Some (h, turn M (snd v + (fst (fst v) - j)) (root M)), log, (v, t))
  | None => bind (with_trail (undo v (rev ds)) t) (fun vt => Return (Some (h, h), log, vt)) end.

(** Test hypotheses until one is confirmed or none is left. The rule is put to all that remain, and
    may conclude one; else the motion chooses one; the robot goes back to where its way parts from the
    doors ds; what the shared doors showed is compared, and the other doors are executed. Returns the
    dart confirmed with the dart of the map that the robot faces, the sequences, the robot, which goes
    back to vu if none was, and the trail. n bounds the number of tests. *)
Fixpoint test_all n M e pu T (log : list sequence) ds qs v t (H : list hypothesis)
  : program (option (nat * nat) * list sequence * (robot * robot_trail)) :=
  let none := bind (with_trail (undo v (rev ds)) t) (fun vt => Return (None, log, vt)) in
  match n with
  | 0 => none
  | S n =>
    let K := filter (keep rule M e pu T log t) H in
    match find (concludes rule M e pu T log t) K, motion ds K with
    | Some (h, _), _ => concluded M h log ds v t
    | None, None => none
    | None, Some ((h, w), s) =>
      let K := filter (fun c => negb (fst c =? h)) K in
      bind (with_trail (undo v (rev (skipn s ds))) t) (fun '(v, t) =>
        match percepts M h w, walk M h (firstn s w), walk M h w with
        | Some ps, Some x, Some y =>
          if percept_eqb (percept M h) pu && percepts_eqb (firstn s ps) (firstn s qs)
          then bind (with_trail (follow M x (skipn s w) v) t) (fun r =>
            let '(matched, more, v, t) := r in
            let ds := firstn s ds ++ firstn (length more) (skipn s w) in
            let qs := firstn s qs ++ more in
            if matched : bool then Return (Some (h, y), log, (v, t))
            else test_all n M e pu T ((ds, qs) :: log) ds qs v t K)
          else test_all n M e pu T log (firstn s ds) (firstn s qs) v t K
        | _, _, _ => Stuck
        end)
    end
  end.

(** H: the open darts other than e whose vertices have the signature of the percept pu. *)
Definition hypotheses M e pu := order M (filter (fun h => negb (h =? e) && negb (explored M h)
  && same_signature (percept M h) pu) (seq 0 (darts M))).

(** The state of an exploration: the map, the dart of it where the robot is, the robot, what the rule
    remembers, and the trail. *)
Definition state : Type := Map * nat * robot * memory rule * robot_trail.

(** The map of a state. *)
Definition map_in (st : state) := let '(M, _, _, _, _) := st in M.

(** The dart of the map where the robot is. *)
Definition dart_in (st : state) := let '(_, p, _, _, _) := st in p.

(** Explore dart e: walk to it, cross it, validate, augment, learn. *)
Definition round (st : state) e : program state :=
  let '(M, p, v, T, t) := st in
  let (w, k) := path M e p in
  bind (with_trail (execute v (w ++ [k])) t) (fun '(v, u) =>
    let home := path M (root M) in
    let H := map (fun h => (h, fst (home h))) (hypotheses M e (fst v)) in
    bind (test_all (length H) M e (fst v) T [] [] [] v u H) (fun r =>
      match r with
      | (Some (h, x), log, (v', t)) =>
          let N := augment_loop M e h in Return (N, x, v', learn rule N e h T log u, t)
      | (None, log, (v', t)) => let N := augment_new M e (fst (fst v)) in
          Return (N, darts M, v', learn rule N e (darts M) T log u, t)
      end)).

(** Explore one dart after the other until none is open, and deliver the map. The fuel bounds the
    number of rounds. *)
Fixpoint explore fuel (st : state) : program Map :=
  match pick (map_in st) (dart_in st) with
  | None => Return (map_in st)
  | Some e => match fuel with
              | 0 => Stuck
              | S fuel => bind (round st e) (explore fuel)
              end
  end.

(** The state at the start, where q is sensed: the map is v0, and the robot is at its first dart. *)
Definition initial_state (q : Percept) : state := (initial (fst q), 0, (q, 0), fresh rule, []).
End Mapper.
Arguments round : simpl never.

(** The contract of a pick policy: it returns an open dart, or None if no dart is open. *)
Definition good_pick (pick : Map -> nat -> option nat) := forall M p,
  match pick M p with
  | Some e => e < darts M /\ alpha M e = None
  | None => forall d, d < darts M -> alpha M d <> None
  end.

(** The contract of a path policy: its doors and its last turn lead to e from p, and it has fewer
    doors than the map has vertices. *)
Definition good_path (path : Map -> nat -> nat -> list nat * nat) :=
  forall M p e, is_map M -> connected M -> p < darts M -> e < darts M ->
  length (fst (path M e p)) < vertices M /\
  exists q, walk M p (fst (path M e p)) = Some q /\
            snd (path M e p) < degree M q /\ turn M (snd (path M e p)) q = e.

(** The contract of an order policy: it permutes the hypotheses. *)
Definition good_order (order : Map -> list nat -> list nat) :=
  forall M l, Permutation (order M l) l.

(** The contract of a motion: it chooses one of the hypotheses if there is one, and the doors that
    it takes for shared are. *)
Definition good_motion (motion : Motion) := forall ds K,
  match motion ds K with
  | None => K = []
  | Some (c, s) => In c K /\ s <= length ds /\ s <= length (snd c) /\ firstn s (snd c) = firstn s ds
  end.

(** The contract of a rule: what it remembers is true in the sense of some invariant, which the
    rule's learning keeps; and then it keeps the true hypothesis (claim 3), and concludes no false one
    (claim 4). Here phi embeds the map M in the world W, e leads to the dart a of the world, which is
    the dart h of the map if h is the true hypothesis; the trail was s when the rule learned last, u at
    vu, and is t now. *)
Record good_rule (R : Rule)
  (true_of : Map -> Map -> (nat -> nat) -> robot_trail -> memory R -> Prop) : Prop := {
  fresh_true : forall W phi d, world W -> is_map (initial d) -> embedded (initial d) W phi ->
    true_of (initial d) W phi [] (fresh R);
  keep_true : forall M W phi T e log s t b h w r, world W -> is_map M -> embedded M W phi ->
    true_of M W phi s T -> later s t -> led W t b -> e < darts M -> alpha M e = None ->
    h < darts M -> alpha W (phi e) = Some (phi h) -> walk M h w = Some r ->
    (forall s, In s log -> percepts W (phi h) (fst s) = Some (snd s)) ->
    keep R M e (percept M h) T log t (h, w) = true;
  conclude_true : forall M W phi T e log s t a b h w, world W -> is_map M -> embedded M W phi ->
    true_of M W phi s T -> later s t -> led W t b -> e < darts M -> alpha M e = None ->
    h < darts M -> alpha W (phi e) = Some a ->
    concludes R M e (percept W a) T log t (h, w) = true -> phi h = a;
  loop_true : forall M W phi T e h log s u t, world W -> is_map M -> embedded M W phi ->
    true_of M W phi s T -> later s u -> led W u (phi h) -> later u t ->
    e < darts M -> h < darts M -> alpha M e = None -> alpha M h = None ->
    embedded (augment_loop M e h) W phi -> is_map (augment_loop M e h) ->
    (forall s, In s log -> percepts W (phi h) (fst s) = Some (snd s)) ->
    true_of (augment_loop M e h) W phi t (learn R (augment_loop M e h) e h T log u);
  new_true : forall M W phi T e a log s u t, world W -> is_map M -> embedded M W phi ->
    true_of M W phi s T -> later s u -> led W u a -> later u t ->
    e < darts M -> alpha M e = None -> alpha W (phi e) = Some a ->
    let N := augment_new M e (degree W a) in let psi := extend phi (darts M) W a in
    embedded N W psi -> is_map N ->
    (forall s, In s log -> percepts W a (fst s) = Some (snd s)) ->
    true_of N W psi t (learn R N e (darts M) T log u) }.
