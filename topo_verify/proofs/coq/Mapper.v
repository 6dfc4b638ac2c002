(** An executable mapper: the loop of docs/semantics.md, section 4, with retracing (sections
    5 to 7).

    The mapper is a function of [see] and [go] alone, so it cannot look at the world. The policies
    are parameters: which dart is explored next, by which way, in which order hypotheses are tested,
    and which of them the rule rejects.

    M     the map S                      St    the type of the robot's states
    e     the dart being explored        v     the robot: a state, and how far it has turned
    pu    the percept behind e           H     the hypotheses
    h     a hypothesis                   k, w  a door, doors *)
From Coq Require Import Arith Lia List Bool Permutation.
Import ListNotations.
From Topo Require Import World Rotation Embedding Vertices Augment.

Section Mapper.
Variables (St : Type) (see : St -> Percept) (go : St -> nat -> option St).

(** The policies: the dart explored next, the way to a dart, the order of the tests, what to keep. *)
Variables (pick : Map -> nat -> option nat) (path : Map -> nat -> nat -> list nat * nat)
          (order : Map -> list nat -> list nat)
          (keep : Map -> list (list nat * list Percept) -> nat -> bool).

(** The robot: its state, and how far it has turned away from its reference dart. *)
Definition robot : Type := St * nat.

(** Leave by door k, counted from the direction in which the robot faces. *)
Definition go_on (v : robot) k : option robot :=
  match go (fst v) ((snd v + k) mod fst (see (fst v))) with
  | Some s => Some (s, 0) | None => None end.

(** Undo the move by door k. *)
Definition go_back (v : robot) k : option robot :=
  match go (fst v) (snd v) with
  | Some s => Some (s, (fst (see s) - k) mod fst (see s)) | None => None end.

(** Take the doors w one after the other. *)
Fixpoint execute (v : robot) w : option robot :=
  match w with
  | [] => Some v
  | k :: w => match go_on v k with Some v => execute v w | None => None end
  end.

(** Validation by motion of the hypothesis that the robot is at dart x: execute w; at the first
    percept that differs from the map's, retrace. Returns whether all percepts agreed, the
    percepts, and the robot. *)
Fixpoint follow M x w (v : robot) : option (bool * list Percept * robot) :=
  match w with
  | [] => Some (true, [], v)
  | k :: w =>
    match move M x k, go_on v k with
    | Some x, Some v =>
      let q := see (fst v) in
      if percept_eqb (percept M x) q then
        match follow M x w v with
        | Some (true, qs, v) => Some (true, q :: qs, v)
        | Some (false, qs, v) => option_map (fun v => (false, q :: qs, v)) (go_back v k)
        | None => None
        end
      else option_map (fun v => (false, [q], v)) (go_back v k)
    | _, _ => None
    end
  end.

(** Test the hypotheses H in their order until one is confirmed. The rule is told the doors
    executed so far behind this edge, with their percepts (log). *)
Fixpoint test_all M pu log v H : option (option nat * robot) :=
  match H with
  | [] => Some (None, v)
  | h :: H =>
    if keep M log h then
      if percept_eqb (percept M h) pu then
        let w := fst (path M h (root M)) in
        match follow M h w v with
        | Some (true, _, v) => Some (Some h, v)
        | Some (false, qs, v) => test_all M pu ((firstn (length qs) w, qs) :: log) v H
        | None => None
        end
      else test_all M pu log v H
    else test_all M pu log v H
  end.

(** Do two percepts have the same signature: equal degrees, and the marker at both or at neither? *)
Definition same_signature (p q : Percept) :=
  (fst p =? fst q) &&
  match snd p, snd q with Some _, Some _ => true | None, None => true | _, _ => false end.

(** Every percept has the same signature as itself. *)
Lemma same_signature_refl p : same_signature p p = true.
Proof. unfold same_signature. rewrite Nat.eqb_refl. destruct (snd p); auto. Qed.

(** H: the open darts other than e whose vertices have the signature of the percept pu. *)
Definition hypotheses M e pu := order M (filter (fun h => negb (h =? e) && negb (explored M h)
  && same_signature (percept M h) pu) (seq 0 (darts M))).

(** The state of an exploration: the map, the dart of it where the robot is, the robot. *)
Definition state : Type := Map * nat * robot.

(** Explore dart e: walk to it, cross it, validate, augment. None means that the robot could not
    make a move that the map predicts. *)
Definition round (st : state) e : option state :=
  let '(M, p, v) := st in
  let '(w, k) := path M p e in
  match execute v (w ++ [k]) with
  | None => None
  | Some v => let pu := see (fst v) in
    match test_all M pu [] v (hypotheses M e pu) with
    | None => None
    | Some (Some h, v) => match walk M h (fst (path M h (root M))) with
                          | Some r => Some (augment_loop M e h, r, v) | None => None end
    | Some (None, v) => Some (augment_new M e (fst pu), darts M, v)
    end
  end.

(** Explore one dart after the other until none is open. None means that the fuel, a bound on the
    number of rounds, was used up, or that a round failed. *)
Fixpoint explore fuel (st : state) : option state :=
  let '(M, p, v) := st in
  match pick M p with
  | None => Some st
  | Some e => match fuel with
              | 0 => None
              | S fuel => match round st e with Some st => explore fuel st | None => None end
              end
  end.

(** The state at the start: the map is v0, and the robot is at its first dart. *)
Definition initial_state s : state := (initial (fst (see s)), 0, (s, 0)).
End Mapper.
Arguments round : simpl never.

(** The contract of a pick policy: it returns an open dart, or None if no dart is open. *)
Definition good_pick (pick : Map -> nat -> option nat) := forall M p,
  match pick M p with
  | Some e => e < darts M /\ alpha M e = None
  | None => forall d, d < darts M -> alpha M d <> None
  end.

(** The contract of a path policy: its doors and its last turn lead from p to e. *)
Definition good_path (path : Map -> nat -> nat -> list nat * nat) :=
  forall M p e, is_map M -> connected M -> p < darts M -> e < darts M ->
  exists q, walk M p (fst (path M p e)) = Some q /\
            snd (path M p e) < degree M q /\ turn M (snd (path M p e)) q = e.

(** The second contract of a path policy: its ways have fewer doors than the map has vertices. *)
Definition short_path (path : Map -> nat -> nat -> list nat * nat) :=
  forall M p e, is_map M -> connected M -> p < darts M -> e < darts M ->
  length (fst (path M p e)) < vertices M.

(** The contract of an order policy: it permutes the hypotheses. *)
Definition good_order (order : Map -> list nat -> list nat) :=
  forall M l, Permutation (order M l) l.

(** The contract of a rule (claim 3): it keeps the true hypothesis. *)
Definition good_keep (keep : Map -> list (list nat * list Percept) -> nat -> bool) :=
  forall M W phi a log h, is_map M -> is_map W -> embedded M W phi -> h < darts M ->
  (forall w ps, In (w, ps) log -> percepts W a w = Some ps) -> phi h = a -> keep M log h = true.
