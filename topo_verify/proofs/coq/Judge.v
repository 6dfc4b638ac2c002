(** The judge: a program that judges a trace in its world, claim by claim (docs/semantics.md, section
    9).

    l is a list of darts or of pairs, s a stage of the run, d a step, x a dart of the world, n a
    number; the other letters are those of Claims.v. JudgeCorrect.v and the files behind it
    prove that it says [Failed] exactly where a claim of Claims.v is violated.

    The program follows the trace once. At each step it knows where the robot stands, the map S and
    its images in the world, which edges were crossed, and which hypotheses are in question. *)
From Coq Require Import Arith List NArith Bool.
Import ListNotations.
From Topo Require Import World Rotation Log AnyWorld Augment Vertices Events Table LogFold Claims.

(** Is x in the list? *)
Definition mem (x : nat) l := existsb (Nat.eqb x) l.

(** Is d an unexplored dart of the map? *)
Definition is_open M d := (d <? darts M) && negb (explored M d).

Section Judge.
Variable W : Map.

(** The edge of a dart of the world, named by the lesser of its darts. *)
Definition edge_key x := match alpha W x with Some y => Nat.min x y | None => x end.

(** The dart of the world that dart e of S is, if l is the images of S. *)
Definition at_image (l : list nat) e := nth e l 0.

(** In the world the edge of dart e of S ends in dart h of S. *)
Definition ends_in l e h := match alpha W (at_image l e) with
  | Some b => b =? at_image l h | None => false end.

(** Is what the event declares true in the world? *)
Definition event_true M l ev := match ev with
  | Move _ _ => true
  | Reject e h => is_open M e && is_open M h && negb (ends_in l e h)
  | Confirm e h => is_open M e && is_open M h && ends_in l e h
  | Loop e h n => is_open M e && is_open M h && ends_in l e h && (degree W (at_image l h) =? n)
  | New e a n => is_open M e && (a =? darts M) && match alpha W (at_image l e) with
      | Some b => (degree W b =? n) && negb (mem b l) | None => false end
  end.

(** The images of S after an augmentation that is true. *)
Definition images_after (l : list nat) ev := match ev with
  | New e _ n => match alpha W (at_image l e) with
      | Some b => l ++ map (fun k => turn W k b) (seq 0 n) | None => l end
  | _ => l end.

(** What the judge knows before a step: where the robot stands, None after a door that does not exist;
    S and its images; whether all augmentations were true; the edges that were crossed; the edge that
    was posed last, unless S grew since; the hypotheses in question, each with its edge; the edges
    that were posed; and those along which S grew after a pose: by a new vertex or not, and how many
    hypotheses were still in question. *)
Record stage := { position : option nat; chart : Map; images : list nat; faithful : bool;
  walked_edges : list nat; asked : option nat; questions : list (nat * nat); poses : list nat;
  settled : list (nat * (bool * nat)) }.

(** The stage at the start. *)
Definition first_stage := {| position := Some (root W); chart := initial (degree W (root W));
  images := map (fun k => turn W k (root W)) (seq 0 (degree W (root W))); faithful := true;
  walked_edges := []; asked := None; questions := []; poses := []; settled := [] |}.

(** Deeds are judged at this stage. *)
Definition live s := match position s with Some _ => faithful s | None => false end.

(** The edge of the world on which dart e of S lies. *)
Definition key_of s e := edge_key (at_image (images s) e).

(** Add a number to a list that lacks it. *)
Definition add_once x l := if mem x l then l else x :: l.

(** Add a pair to a list that lacks it. *)
Definition add_pair_once (q : nat * nat) l := if existsb (place_eqb q) l then l else q :: l.

(** The hypotheses for an edge of the world that are unexplored and in question. *)
Definition left_over s x := filter (fun q : nat * nat => (fst q =? x) && is_open (chart s) (snd q))
  (questions s).

(** A move. *)
Definition after_move s k := match position s with None => s | Some a =>
  {| position := move W a k; chart := chart s; images := images s; faithful := faithful s;
     walked_edges := match move W a k with Some b => add_once (edge_key b) (walked_edges s) | None =>
       walked_edges s end;
     asked := asked s; questions := questions s; poses := poses s; settled := settled s |} end.

(** A pose. *)
Definition asked_about s e (H : list nat) := let x := key_of s e in
  {| position := position s; chart := chart s; images := images s; faithful := faithful s;
     walked_edges := walked_edges s; asked := Some e;
     questions := if is_open (chart s) e
       then fold_right (fun h l => add_pair_once (x, h) l) (questions s) H else questions s;
     poses := if is_open (chart s) e then add_once x (poses s) else poses s; settled := settled s |}.

(** A hypothesis is rejected or confirmed. *)
Definition answered s e h := if is_open (chart s) e then
  {| position := position s; chart := chart s; images := images s; faithful := faithful s;
     walked_edges := walked_edges s; asked := asked s;
     questions := filter (fun q => negb (place_eqb (key_of s e, h) q)) (questions s);
     poses := poses s; settled := settled s |} else s.

(** An augmentation by dart e; [new] tells whether by a new vertex. A false one draws nothing. *)
Definition extended s ev e new := let x := key_of s e in if event_true (chart s) (images s) ev then
  {| position := position s; chart := drawn (chart s) ev; images := images_after (images s) ev;
     faithful := true; walked_edges := walked_edges s; asked := None; questions := questions s;
     poses := poses s;
     settled := match asked s with
       | Some e' => if e' =? e
           then (x, (new : bool, if new then length (left_over s x) else 0)) :: settled s else settled s
       | None => settled s end |}
  else {| position := position s; chart := chart s; images := images s; faithful := false;
     walked_edges := walked_edges s; asked := None; questions := questions s; poses := poses s;
     settled := settled s |}.

(** The stage after a step. Once an augmentation was false, only moves count. *)
Definition next_stage s d := match d with
  | Act (Move k _) => after_move s k
  | _ => if live s then match d with
      | Pose e H => asked_about s e H
      | Act ev => match ev with
          | Reject e h | Confirm e h => answered s e h
          | Loop e _ _ => extended s ev e false
          | New e _ _ => extended s ev e true
          | Move _ _ => s end end
    else s end.

(** The steps, each with the stage before it. *)
Fixpoint stages s (l : list step) := match l with
  | [] => []
  | d :: l => (s, d) :: stages (next_stage s d) l end.

(** The step is wrong by claim 2 at this stage. *)
Definition wrongly_posed s d := match d with
  | Pose e H => negb (is_open (chart s) e && mem (key_of s e) (walked_edges s) &&
      forallb (is_open (chart s)) H &&
      forallb (fun h => negb (event_true (chart s) (images s) (Confirm e h)) || mem h H)
        (seq 0 (darts (chart s))))
  | Act (Loop e _ _) | Act (New e _ _) =>
      negb match asked s with Some e' => e' =? e | None => false end
  | _ => false end.

(** It is wrong by claim 3. *)
Definition wrongly_dropped s d := match d with
  | Act (Reject e h) => event_true (chart s) (images s) (Confirm e h)
  | Act (New e a n) =>
      existsb (fun h => event_true (chart s) (images s) (Confirm e h)) (seq 0 (darts (chart s))) ||
      match asked s with Some e' => e' =? e | None => false end &&
      event_true (chart s) (images s) (New e a n) &&
      match left_over s (key_of s e) with [] => false | _ => true end
  | _ => false end.

(** It is wrong by claim 4. *)
Definition wrongly_confirmed s d := match d with
  | Act (Confirm e h) => negb (event_true (chart s) (images s) (Confirm e h))
  | _ => false end.

(** It is wrong by claim 5. *)
Definition wrongly_grown s d := match d with
  | Act (Loop _ _ _ as ev) | Act (New _ _ _ as ev) => negb (event_true (chart s) (images s) ev)
  | _ => false end.
End Judge.

(** The test is true of some step that is judged. *)
Definition somewhere W t (test : stage -> step -> bool) :=
  existsb (fun x => live (fst x) && test (fst x) (snd x)) (stages W (first_stage W) (steps t)).

(** The stage at the end. *)
Definition last_stage W t := fold_left (next_stage W) (steps t) (first_stage W).

(** Is some augmentation declared? *)
Definition grows_b d := match d with Act (Loop _ _ _) | Act (New _ _ _) => true | _ => false end.

(** Does the world show the log? *)
Definition shows_b W L := percept_eqb (percept W (root W)) (start L) && check_moves W (root W) (moves L).

(** Is every dart of every place of the log crossed? Then the log is closed. *)
Definition closed_b L := match fold_of L with
  | Some (f, R) => let s := percepts_of L in forallb (fun i => forallb (fun k =>
      existsb (fun r => place_eqb (fst r) (found s f (i, k))) R) (seq 0 (degree_at s i)))
      (seq 0 (length s))
  | None => false end.

Section Same.
Variables M W : Map.

(** Add a pair of darts unless its second one is in a pair. *)
Definition pair_up (l : list (nat * nat)) q := if existsb (fun p => snd p =? snd q) l then l else q :: l.

(** If dart d of M is dart b of W, so are the next ones, and the other darts of their edges. *)
Definition following_pairs (p : nat * nat) := (sigma M (fst p), sigma W (snd p)) ::
  match alpha M (fst p), alpha W (snd p) with Some e, Some b => [(e, b)] | _, _ => [] end.

(** Pair up what follows, n times. *)
Fixpoint paired n l := match n with
  | 0 => l
  | S n => paired n (fold_left pair_up (flat_map following_pairs l) l) end.

(** All pairs that follow from the roots. *)
Definition pairing := paired (darts W) [(root M, root W)].

(** The partner of d in these pairs. *)
Definition forth (l : list (nat * nat)) d := match find (fun p => fst p =? d) l with
  | Some p => snd p | None => 0 end.

(** The partner of b in them. *)
Definition back (l : list (nat * nat)) b := match find (fun p => snd p =? b) l with
  | Some p => fst p | None => 0 end.

(** Is M well formed, and the world W? The pairing is a correspondence if it is one at all. *)
Definition same_world := let f := forth pairing in let g := back pairing in
  (root M <? darts M) && (f (root M) =? root W) && forallb (fun d =>
    (f d <? darts W) && (g (f d) =? d) && (sigma M d <? darts M) && (f (sigma M d) =? sigma W (f d)) &&
    match alpha M d, alpha W (f d) with
    | Some e, Some b => (e <? darts M) && (f e =? b) | _, _ => false end) (seq 0 (darts M)).
End Same.

(** Is the delivered map the world? *)
Definition is_right D w := match w with
  | Point => match rotations D, pairs D with [[]], [] => true | _, _ => false end
  | Edges W => forallb (fun r => match r with [] => false | _ => true end) (rotations D) &&
      (2 * length (pairs D) =? length (labels D)) && same_world (delivered_map D) W end.

(** Is the right map delivered? *)
Definition right_end w t := match finish t with
  | Some r => match reported_map r with Some D => is_right D w | None => false end
  | None => false end.

(** The status of a claim. *)
Inductive status := Ok | Failed | Partial | NotDeclared.

(** The judgement of a claim: its status, and how many things were judged, of how many. *)
Definition judgement : Type := status * nat * nat.

(** The judgement of a claim: whether anything that it speaks of is declared; whether it is violated;
    how much is judged, and of how much. *)
Definition judged_as (spoken wrong : bool) n m : judgement := if negb spoken then (NotDeclared, 0,
  m) else
  if wrong then (Failed, n, m) else
  (if n =? m then Ok else if n =? 0 then NotDeclared else Partial, n, m).

(** How many steps that are judged are of this kind. *)
Definition how_many W t (kind : step -> bool) := length (filter (fun x => live (fst x) && kind (snd x))
  (stages W (first_stage W) (steps t))).

(** The sum of f over a list. *)
Definition add_up {X} (f : X -> nat) l := fold_right (fun x n => f x + n) 0 l.

(** How many moves were made through doors that exist. *)
Definition moves_followed W t := length (filter (fun x => match snd x with
  | Act (Move k _) => match position (after_move W (fst x) k) with Some _ => true | None => false end
  | _ => false end) (stages W (first_stage W) (steps t))).

(** S grew along the edge of this name after a pose. *)
Definition is_settled z x := mem x (map fst (settled z)).

(** How many edges were crossed and are not settled. *)
Definition unsettled z := length (filter (fun x => negb (is_settled z x)) (walked_edges z)).

(** How many hypotheses were posed. *)
Definition hypotheses_posed W t := add_up (fun x => match snd x with
  | Pose _ H => if live (fst x) then length H else 0
  | _ => 0 end) (stages W (first_stage W) (steps t)).

(** How many of them have no answer. *)
Definition unanswered z := add_up (fun q : nat * (bool * nat) => snd (snd q)) (settled z) +
  length (filter (fun q => negb (is_settled z (fst q))) (questions z)).

(** How many edges were settled by a loop. *)
Definition loops_settled z := length (filter (fun q : nat * (bool * nat) => negb (fst (snd q)))
  (settled z)).

(** Claim 1. *)
Definition judge_percepts w t := judged_as true (negb (shows_b (ground w) (trace_log t)))
  (S (moves_followed (ground w) t)) (S (trace_cost t)).

(** Claim 2. *)
Definition judge_posed w t := let W := ground w in let z := last_stage W t in
  judged_as (declares w t is_pose) (somewhere W t (wrongly_posed W))
    (length (filter (fun x => mem x (poses z)) (walked_edges z))) (length (walked_edges z)).

(** Claim 3. *)
Definition judge_kept w t := let W := ground w in let z := last_stage W t in
  judged_as (declares w t (fun d => is_pose d || is_reject d)) (somewhere W t (wrongly_dropped W))
    (hypotheses_posed W t - unanswered z) (hypotheses_posed W t + unsettled z).

(** Claim 4. *)
Definition judge_confirmed w t := let W := ground w in let z := last_stage W t in
  let n := how_many W t is_confirm in
  judged_as (declares w t (fun d => is_pose d || is_confirm d)) (somewhere W t (wrongly_confirmed W))
    n (Nat.max n (loops_settled z) + unsettled z).

(** One map is owed, and judged if something is delivered. *)
Definition maps t := if has_finish t then 1 else 0.

(** Claim 5. *)
Definition judge_map w t := let W := ground w in let z := last_stage W t in
  judged_as true (somewhere W t (wrongly_grown W) || negb (right_end w t) ||
    match position z with
    | Some _ => existsb grows_b (steps t) && existsb (is_open (chart z)) (seq 0 (darts (chart z)))
    | None => false end) (maps t) 1.

(** Claim 6. *)
Definition judge_cost t := match finish t with
  | Some {| reported_cost := Some c |} => judged_as true (negb (c =? trace_cost t)) 1 1
  | _ => judged_as true false 0 0 end.

(** Claim 7. *)
Definition judge_bound w t := let m := edges_of w in let n := vertices (ground w) in
  judged_as true (negb ((negb (has_finish t) || (m <=? trace_cost t)) &&
    (trace_cost t <=? m * (n + (2 * m - 1) * (2 * (n - 1)))))) 1 1.

(** Claim 9. *)
Definition judge_entailed w t := judged_as (declares w t (fun _ => false) || has_finish t)
  (negb (shows_b (ground w) (trace_log t) && right_end w t &&
    match w with Point => true | Edges _ => closed_b (trace_log t) end)) (maps t) 1.

(** What the history tells of S without a world: the log so far, S, and of each dart of S a place of
    the log where it was seen. *)
Record history := { so_far : Log; sketched : Map; spots : list place }.

(** The place of dart e. *)
Definition spot z e := nth e (spots z) (0, 0).

(** The history at the start. *)
Definition first_history (p : Percept) := {| so_far := {| start := p; moves := [] |};
  sketched := initial (fst p); spots := map (fun k => (0, k)) (seq 0 (fst p)) |}.

(** The place behind a place, if its edge was crossed. *)
Definition place_behind L p := match fold_of L with
  | Some (f, R) => option_map snd
      (find (fun r => place_eqb (fst r) (found (percepts_of L) f p)) R)
  | None => None end.

(** The degree of the vertex of a place. *)
Definition degree_there L (p : place) := degree_at (percepts_of L) (fst p).

(** The event follows from this history. *)
Definition follows_b z ev := let L := so_far z in let F := fold_of L in let M := sketched z in
  match ev with
  | Move _ _ => true
  | Reject e h => is_open M e && is_open M h && negb (allows L F (spot z e) (spot z h))
  | Confirm e h => is_open M e && is_open M h && partners L F (spot z e) (spot z h)
  | Loop e h n => is_open M e && is_open M h && partners L F (spot z e) (spot z h) &&
      (degree_there L (spot z h) =? n)
  | New e a n => is_open M e && (a =? darts M) && match place_behind L (spot z e) with
      | Some q => (degree_there L q =? n) && forallb (fun h => (h =? e) || negb (is_open M h) ||
          negb (allows L F (spot z e) (spot z h))) (seq 0 (darts M))
      | None => false end
  end.

(** The history after an event that follows. *)
Definition next_history z ev := let L := so_far z in match ev with
  | Move k p => {| so_far := {| start := start L; moves := moves L ++ [(k, p)] |};
      sketched := sketched z; spots := spots z |}
  | New e _ n => {| so_far := L; sketched := drawn (sketched z) ev; spots := spots z ++
      match place_behind L (spot z e) with
      | Some q => map (fun k => (fst q, k + snd q)) (seq 0 n)
      | None => [] end |}
  | _ => {| so_far := L; sketched := drawn (sketched z) ev; spots := spots z |} end.

(** All these events follow, each from the history before it. *)
Fixpoint all_follow z es := match es with
  | [] => true
  | ev :: es => follows_b z ev && all_follow (next_history z ev) es end.

(** How many crossed edges have no explored dart of S. *)
Definition not_grown W z := length (filter (fun x => negb (existsb (fun d =>
  explored (chart z) d && (key_of W z d =? x)) (seq 0 (darts (chart z))))) (walked_edges z)).

(** The step is a decision. *)
Definition decides d := match d with Act ev => is_decision ev | Pose _ _ => false end.

(** Claim 10. *)
Definition judge_decisions w t := let W := ground w in let n := how_many W t decides in
  judged_as (declares w t decides) (negb (shows_b W (trace_log t) && match w with
    | Point => negb (existsb decides (steps t))
    | Edges _ => all_follow (first_history (percept_at_start t)) (acts (steps t)) end))
    n (n + not_grown W (last_stage W t)).

(** The judge: claims 1 to 7, in this order. The others stand apart: 8 (JudgeCitations.v) and 10 may take
    longer. *)
Definition judge_trace w t : list judgement := [judge_percepts w t; judge_posed w t; judge_kept w t;
  judge_confirmed w t; judge_map w t; judge_cost t; judge_bound w t].
