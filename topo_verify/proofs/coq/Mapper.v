(** A mapper that runs: the loop of docs/semantics.md, section 4, with retracing.

    It is a function of [see] and [go] alone, so it cannot look at the world. Policies are
    parameters: which dart next, which way, in which order, what the rule rejects. *)
From Coq Require Import Arith Lia List Bool Permutation.
Import ListNotations.
From Topo Require Import World Rotation Embedding Vertices Augment.

Section Mapper.
Variables (St : Type) (see : St -> Percept) (go : St -> nat -> option St).

(** Policies: which dart next, how to get there, in which order to test, what to reject. *)
Variables (pick : Map -> nat -> option nat) (path : Map -> nat -> nat -> list nat * nat)
          (order : Map -> list nat -> list nat)
          (keep : Map -> list (list nat * list Percept) -> nat -> bool).

(** The robot and how far it has turned away from its reference dart. *)
Definition robot : Type := St * nat.

(** Leave by door k, counted from where the robot is turned to. *)
Definition go_on (v : robot) k : option robot :=
  match go (fst v) ((snd v + k) mod fst (see (fst v))) with
  | Some s => Some (s, 0) | None => None end.

(** Undo the move by door k. *)
Definition go_back (v : robot) k : option robot :=
  match go (fst v) (snd v) with
  | Some s => Some (s, (fst (see s) - k) mod fst (see s)) | None => None end.

(** Take these doors. *)
Fixpoint execute (v : robot) w : option robot :=
  match w with
  | [] => Some v
  | k :: w => match go_on v k with Some v => execute v w | None => None end
  end.

(** Validation by motion: is this dart x? Execute w; at the first mismatch retrace. *)
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

(** Test hypotheses in their order until one is confirmed; the rule sees what was executed. *)
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

(** Equal degrees, and the marker at both or neither. *)
Definition same_signature (p q : Percept) :=
  (fst p =? fst q) &&
  match snd p, snd q with Some _, Some _ => true | None, None => true | _, _ => false end.

(** A percept has its own signature. *)
Lemma same_signature_refl p : same_signature p p = true.
Proof. unfold same_signature. rewrite Nat.eqb_refl. destruct (snd p); auto. Qed.

(** H: the open darts, except e, with the signature of what is seen. *)
Definition hypotheses M e pu := order M (filter (fun h => negb (h =? e) && negb (explored M h)
  && same_signature (percept M h) pu) (seq 0 (darts M))).

(** The map, the dart of it that the robot is at, the robot. *)
Definition state : Type := Map * nat * robot.

(** Explore dart e: walk to it, cross it, validate, augment. *)
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

(** Round after round, until nothing is open. *)
Fixpoint explore fuel (st : state) : option state :=
  let '(M, p, v) := st in
  match pick M p with
  | None => Some st
  | Some e => match fuel with
              | 0 => None
              | S fuel => match round st e with Some st => explore fuel st | None => None end
              end
  end.

(** At the start the robot knows v0. *)
Definition initial_state s : state := (initial (fst (see s)), 0, (s, 0)).
End Mapper.
Arguments round : simpl never.

(** What the policies must satisfy. *)
Definition good_pick (pick : Map -> nat -> option nat) := forall M p,
  match pick M p with
  | Some e => e < darts M /\ alpha M e = None
  | None => forall d, d < darts M -> alpha M d <> None
  end.

(** The ways lead where they should. *)
Definition good_path (path : Map -> nat -> nat -> list nat * nat) :=
  forall M p e, is_map M -> connected M -> p < darts M -> e < darts M ->
  exists q, walk M p (fst (path M p e)) = Some q /\
            snd (path M p e) < degree M q /\ turn M (snd (path M p e)) q = e.

(** Ways are shorter than there are vertices. *)
Definition short_path (path : Map -> nat -> nat -> list nat * nat) :=
  forall M p e, is_map M -> connected M -> p < darts M -> e < darts M ->
  length (fst (path M p e)) < vertices M.

(** The order is one of the hypotheses: none lost, none twice. *)
Definition good_order (order : Map -> list nat -> list nat) :=
  forall M l, Permutation (order M l) l.

(** Claim 3, for a rule: it keeps the true hypothesis. *)
Definition good_keep (keep : Map -> list (list nat * list Percept) -> nat -> bool) :=
  forall M W phi a log h, is_map M -> is_map W -> embedded M W phi -> h < darts M ->
  (forall w ps, In (w, ps) log -> percepts W a w = Some ps) -> phi h = a -> keep M log h = true.
