(** The claims that a trace is judged by, over a world and a trace (docs/semantics.md, section 9).

    SCEPTICS READ THIS FILE. It contains definitions only, no theorem. It says what the ten claims
    say, with the names of docs/semantics.md.

    w     any world: the point, or a world with edges          t    a trace
    W     the world as a map: [ground w]                       S    the map that the mapper declares
    past  the steps before a moment                            x    a dart of the world
    e, h  darts of S, as the mapper numbers them               H    the hypotheses for e
    b     the dart of the world where the edge of e ends       g    what a rejection cites
    L     the log up to a moment                            p, q    places of L: darts that it saw

    Nothing that a mapper said is believed. Where the robot stood follows from the doors alone, and S
    is drawn from the declared augmentations; each step is judged only while all doors before it exist
    and all augmentations before it are true ([judged]). *)
From Coq Require Import Arith List NArith Bool.
Import ListNotations.
From Topo Require Import World Log AnyWorld Augment Vertices Events.

(** What happens in a run after its start: a pose of the edge of dart e with its hypotheses; or
    another event, as Events.v has it. *)
Inductive step := Pose (e : nat) (H : list nat) | Act (ev : event).

(** What is handed over at the end: the cost, if one is reported; and the map, None where it is no map
    at all, because an edge is not a pair, or no dart is marked though there are darts. *)
Record ending := { reported_cost : option nat; reported_map : option Delivery }.

(** The rule of a rejection: motion; prefix, history or records; folding. The rule planar is left out:
    planarity is not defined. *)
Inductive rule_cited := InMotion | ByTracing | ByFolding.

(** A contradiction that a rejection by folding cites, in the order of section 13; or other words. *)
Inductive trouble := Unlike | Turned | OwnEnd | TwoOfS | OtherWords.

(** What a rejection cites: its rule, and the evidence of section 13, field by field. A record is a dart
    of S and further doors. *)
Record citation := { by_rule : rule_cited; doors_behind : nat; expected : option Percept;
  observed : option Percept; sequence_cited : option nat; traced_at : option nat;
  record_cited : option (nat * list nat); contradiction : option trouble }.

(** A trace: the percept at the start, what happened then, what each rejection cites, by the number of
    its step, and the end, None where the run ended without delivering anything. *)
Record trace := { percept_at_start : Percept; steps : list step; cited : nat -> option citation;
  finish : option ending }.

(** The steps that are events. *)
Definition acts (past : list step) := flat_map (fun d => match d with Act ev => [ev] | Pose _ _ => []
  end)
  past.

(** The log of a trace: its percepts and doors. *)
Definition trace_log (t : trace) := log_after (percept_at_start t) (acts (steps t)).

(** The doors that were taken. *)
Definition doors_of past := map fst (moves (log_after (0, None) (acts past))).

(** The cost: the number of moves in the trace. *)
Definition trace_cost t := length (doors_of (steps t)).

(** The world as a map. That of the point has no dart. *)
Definition ground w := match w with
  | Point => {| darts := 0; sigma := id; alpha := fun _ => None; root := 0 |}
  | Edges W => W end.

(** The number of edges. *)
Definition edges_of w := Nat.div2 (darts (ground w)).

(** w is a world. *)
Definition a_world w := match w with Point => True | Edges W => world W end.

(** After these steps the robot's reference dart is a. *)
Definition stands W past a := walk W (root W) (doors_of past) = Some a.

(** The map S after these steps; v0 has the degree that the world shows. *)
Definition S_after W past := map_after (percept W (root W)) (acts past).

(** phi says which dart of the world each dart of S is. There is no second one ([embedded_unique]). *)
Definition drawn_by W past phi := embedded (S_after W past) W phi.

(** The event declares what is so in the world. *)
Definition is_so W past ev := exists phi, drawn_by W past phi /\ true_event W (S_after W past) phi ev.

(** The event lets S grow. *)
Definition grows ev := match ev with Loop _ _ _ | New _ _ _ => True | _ => False end.

(** Every door of these steps exists, and every augmentation among them is true. *)
Definition sane W past := (exists a, stands W past a) /\
  forall before ev after, past = before ++ Act ev :: after -> grows ev -> is_so W before ev.

(** The step d of the trace is judged, and past is what came before it. *)
Definition judged W t past d := sane W past /\ exists after, steps t = past ++ d :: after.

(** x and y are darts of one edge of the world. *)
Definition one_edge W x y := x = y \/ alpha W x = Some y.

(** The robot crossed the edge of dart x, in either direction. *)
Definition crossed_edge W past x := exists before k p after a,
  past = before ++ Act (Move k p) :: after /\
  stands W before a /\ one_edge W (turn W k a) x.

(** Dart e is an unexplored dart of S at that moment, and lies at the edge of dart x of the world. *)
Definition means W past e x := exists phi, drawn_by W past phi /\ open_dart (S_after W past) e /\
  one_edge W (phi e) x.

(** Edge e was posed last, and S did not grow since. *)
Definition posed_last past e := exists before H after, past = before ++ Pose e H :: after /\
  forall d, In d after -> match d with Pose _ _ => False | Act ev => ~ grows ev end.

(** Dart h is a hypothesis that was posed for the edge of x and was neither rejected nor confirmed for
    this edge since. *)
Definition in_question W past x h := exists before e H after, past = before ++ Pose e H :: after /\
  means W before e x /\ In h H /\
  forall some e' rest, after = some ++ Act (Reject e' h) :: rest \/
    after = some ++ Act (Confirm e' h) :: rest -> ~ means W (before ++ Pose e H :: some) e' x.

(** Is the step a pose? *)
Definition is_pose d := match d with Pose _ _ => true | _ => false end.

(** Is it a rejection? *)
Definition is_reject d := match d with Act (Reject _ _) => true | _ => false end.

(** Is it a confirmation? *)
Definition is_confirm d := match d with Act (Confirm _ _) => true | _ => false end.

(** The trace declares something that a claim speaks of. In a world without an edge nothing has to be
    declared. *)
Definition declares w t (kind : step -> bool) := (darts (ground w) =? 0) || existsb kind (steps t).

(** Something is delivered, a map or another value. *)
Definition has_finish t := match finish t with Some _ => true | None => false end.

(** Claim 1. Every percept in the trace is what the world shows after these doors, and every door
    exists. *)
Definition percepts_true w t := shows_log w (trace_log t).

(** Claim 2. At a pose the robot has crossed the edge; e and all hypotheses are unexplored darts of S;
    and if e leads to a known vertex, its dart there is in H. Every augmentation is for the edge of
    the last pose, one for each pose. *)
Definition true_hypothesis_posed w t := let W := ground w in
  (forall past e H, judged W t past (Pose e H) ->
    (exists x, means W past e x /\ crossed_edge W past x) /\
    (forall h, In h H -> open_dart (S_after W past) h) /\
    forall h, is_so W past (Confirm e h) -> In h H) /\
  forall past ev, judged W t past (Act ev) -> match ev with
    | Loop e _ _ | New e _ _ => posed_last past e
    | _ => True end.

(** Claim 3. No true hypothesis is rejected. S does not grow by a new vertex where e leads to a known
    vertex, nor where a hypothesis for e is still unexplored and in question. *)
Definition true_hypothesis_kept w t := let W := ground w in
  (forall past e h, judged W t past (Act (Reject e h)) -> ~ is_so W past (Confirm e h)) /\
  forall past e a d, judged W t past (Act (New e a d)) ->
    (forall h, ~ is_so W past (Confirm e h)) /\
    (posed_last past e -> is_so W past (New e a d) -> forall x h, means W past e x ->
      open_dart (S_after W past) h -> ~ in_question W past x h).

(** Claim 4. A confirmed hypothesis is the true one. *)
Definition no_false_confirm w t := let W := ground w in
  forall past e h, judged W t past (Act (Confirm e h)) -> is_so W past (Confirm e h).

(** Dart labels may be any numbers; a delivery is right in the point if it is one vertex without a
    dart. Of a world with edges Events.v says when it is right. *)
Definition right_map D w := match w with
  | Point => rotations D = [[]] /\ pairs D = []
  | Edges W => right_delivery D W end.

(** The map that was delivered, if there is one. *)
Definition delivered_in t D := exists r, finish t = Some r /\ reported_map r = Some D.

(** Claim 5. Every augmentation is true, so that every declared S is a part of the world; a map is
    delivered, and it is the world; and if S grew at all, nothing in it is left unexplored. *)
Definition map_isomorphic w t := let W := ground w in
  (forall past ev, judged W t past (Act ev) -> grows ev -> is_so W past ev) /\
  (exists D, delivered_in t D /\ right_map D w) /\
  ((exists a, stands W (steps t) a) -> (exists ev, In (Act ev) (steps t) /\ grows ev) ->
    forall d, ~ open_dart (S_after W (steps t)) d).

(** Claim 6. The reported cost, if one is reported, is the number of moves. *)
Definition cost_honest t := forall r c, finish t = Some r -> reported_cost r = Some c ->
  c = trace_cost t.

(** Claim 7. m <= cost <= m (n + (2m - 1) 2 (n - 1)); the lower half only where something was
    delivered. *)
Definition cost_in_bound w t := let m := edges_of w in let n := vertices (ground w) in
  (finish t <> None -> m <= trace_cost t) /\ trace_cost t <= m * (n + (2 * m - 1) * (2 * (n - 1))).

(** Claim 9. The percepts are true, a map is delivered, and it is every world that shows the log. *)
Definition map_entailed w t := percepts_true w t /\
  exists D, delivered_in t D /\ forall w', shows_log w' (trace_log t) -> right_map D w'.

(** What an event declares follows from the steps before it: it is so in all worlds that show the log
    up to that moment. No event declares what is so in the point. *)
Definition follows_from t past ev := let p := percept_at_start t in
  event_follows p (acts past) ev /\ ~ shows_log Point (log_after p (acts past)).

(** Claim 10. The percepts are true, and every declared rejection, confirmation and augmentation
    follows from the steps before it. (The planar prior is not declared: planarity is not defined.) *)
Definition decisions_entailed w t := percepts_true w t /\
  forall past ev after, steps t = past ++ Act ev :: after -> is_decision ev = true ->
  follows_from t past ev.

(** A walk behind an edge: the number of the next step; the reference dart of a robot that is behind the
    edge; the doors from the place behind the edge to the robot, the last one first, and by how much the
    reference dart is turned; and the sequences. *)
Record outing := { next_step : nat; reference : option nat; way_out : list nat * nat;
  sequences : list (list nat) }.

(** One more door j: it cancels the last one if it is the dart by which the robot came in. After that
    the reference dart is turned by the cancelled door. *)
Definition shortened j w : list nat * nat := match j, w with
  | 0, i :: v => (v, i)
  | _, _ => (j :: w, 0) end.

(** One step more. A rejection in motion makes the doors a sequence, if there are any. *)
Definition led_on W (said : nat -> option citation) o d := {| next_step := S (next_step o);
  reference := match d, reference o with Act (Move k _), Some a => move W a k | _, r => r end;
  way_out := match d, reference o with
    | Act (Move k _), Some a => shortened ((k + snd (way_out o)) mod degree W a) (fst (way_out o))
    | _, _ => way_out o end;
  sequences := match d, said (next_step o), fst (way_out o) with
    | Act (Reject _ _), Some g, _ :: _ => match by_rule g with
        | InMotion => sequences o ++ [rev (fst (way_out o))] | _ => sequences o end
    | _, _, _ => sequences o end |}.

(** The walk begins at step number n. After a late pose the robot is not behind the edge. *)
Definition setting_out n (position : option nat) b := {| next_step := n;
  reference := match position with Some a => if a =? b then Some b else None | None => None end;
  way_out := ([], 0); sequences := [] |}.

(** Edge e, which ends in dart b of the world, was posed last, with hypotheses H, and S did not grow
    since; o is the walk behind it. *)
Definition posed_with W said past e H b o := exists before after, past = before ++ Pose e H :: after /\
  (forall d, In d after -> match d with Pose _ _ => False | Act ev => ~ grows ev end) /\
  o = fold_left (led_on W said) after
    (setting_out (S (length before)) (walk W (root W) (doors_of before)) b).

(** The edge of the unexplored dart e of S ends in dart b of the world. *)
Definition ends_at W past e b := exists phi, drawn_by W past phi /\ open_dart (S_after W past) e /\
  alpha W (phi e) = Some b.

(** Where doors lead on the map, from dart h over explored edges: the dart of arrival, and no door; or
    the first unexplored dart by which they leave, with its door and those behind it. *)
Fixpoint traced M h (w : list nat) := match w with
  | [] => (h, [])
  | k :: v => match alpha M (turn M k h) with
      | Some x => traced M x v
      | None => (turn M k h, w) end end.

(** The place behind the unexplored dart d and the doors v was seen: a sequence of an earlier edge,
    traced from the dart where that edge ends, leads there. *)
Definition was_seen W said past d v := exists earlier ev rest e a H b o s k u,
  past = earlier ++ Act ev :: rest /\
  match ev with Loop e' a' _ | New e' a' _ => e' = e /\ a' = a | _ => False end /\
  ends_at W earlier e b /\ posed_with W said earlier e H b o /\ In s (sequences o) /\
  traced (S_after W (earlier ++ [Act ev])) a s = (d, k :: v ++ u).

(** The doors that a rejection cites: the first ones of a sequence; or, in motion, of the word at that
    moment. *)
Definition word_cited o g := let i := doors_behind g in
  let word := match sequence_cited g with
    | Some n => nth_error (sequences o) n
    | None => match by_rule g with InMotion => Some (rev (fst (way_out o))) | _ => None end end in
  match word with Some w => if i <=? length w then Some (firstn i w) else None | None => None end.

(** What the rejection cites as expected and as observed disagrees. Observed is what the world shows
    behind b and the cited doors; expected, what S shows where these doors lead from h, or what was seen
    behind an unexplored dart. *)
Definition percepts_disagree W said past phi h b o g := contradiction g = None /\
  exists w x y, word_cited o g = Some w /\ walk W b w = Some x /\ observed g = Some (percept W x) /\
  expected g = Some y /\ y <> percept W x /\
  let (d, rest) := traced (S_after W past) h w in
  (traced_at g = None \/ traced_at g = Some d) /\ match rest with
  | [] => record_cited g = None /\ y = percept (S_after W past) d
  | _ :: v => record_cited g = Some (d, v) /\ was_seen W said past d v /\
      exists c z, alpha W (phi d) = Some c /\ walk W c v = Some z /\ y = percept W z end.

(** Two places of the log look alike: in their degree, and in the marker. *)
Definition looks_like L (p q : place) := match seen L (fst p), seen L (fst q) with
  | Some (d, m), Some (e, n) => d = e /\ (m = None <-> n = None)
  | _, _ => False end.

(** Places that are one dart, if the edges A are edges as well. Folding goes on behind a contradiction,
    except that places that do not look alike are never identified. *)
Inductive one_dart (A : assumed_edges) L : place -> place -> Prop :=
| one_same p q : valid L p -> same nothing L p q -> one_dart A L p q
| one_sym p q : one_dart A L p q -> one_dart A L q p
| one_trans p q r : one_dart A L p q -> one_dart A L q r -> one_dart A L p r
| one_next i a j b : one_dart A L (i, a) (j, b) -> one_dart A L (i, S a) (j, S b)
| one_end p q p' q' : link A L p q -> link A L p' q' -> one_dart A L p p' -> looks_like L q q' ->
    one_dart A L q q'.

(** The contradictions that follow: other ends of one dart that do not look alike; a dart that is one
    with another of its vertex; with its own other end; with a dart of another vertex of S. *)
Inductive follows_from_edges (A : assumed_edges) L (distinct : place -> place -> Prop) :
  trouble -> Prop :=
| unlike_follows p q p' q' : link A L p q -> link A L p' q' -> one_dart A L p p' ->
    ~ looks_like L q q' -> follows_from_edges A L distinct Unlike
| turned_follows i a b d m : seen L i = Some (d, m) -> a < b -> b < d ->
    one_dart A L (i, a) (i, b) -> follows_from_edges A L distinct Turned
| own_end_follows p q : link A L p q -> one_dart A L p q -> follows_from_edges A L distinct OwnEnd
| two_of_S_follow p q : distinct p q -> one_dart A L p q -> follows_from_edges A L distinct TwoOfS.

(** Dart d of S is place p, in every world that shows the log. *)
Definition seen_as t past d p := let L := log_after (percept_at_start t) (acts past) in
  valid L p /\ forall V v phi, world V -> visits V L v ->
  embedded (map_after (percept_at_start t) (acts past)) V phi -> dart V v p = phi d.

(** p and q are darts of different vertices of S. *)
Definition two_vertices t past p q := let M := map_after (percept_at_start t) (acts past) in
  exists d d', d < darts M /\ d' < darts M /\ (forall k, turn M k d <> d') /\
  seen_as t past d p /\ seen_as t past d' q.

(** The contradiction that the rejection cites follows from the history with an edge from e to h. The
    percepts are true, and S was proved so far. Percepts beside it must be those at the two ends. *)
Definition contradiction_met w t past phi e h b g := let W := ground w in
  (doors_behind g = 0 /\ sequence_cited g = None /\ traced_at g = None /\ record_cited g = None) /\
  (expected g = None \/ expected g = Some (percept W (phi h))) /\
  (observed g = None \/ observed g = Some (percept W b)) /\
  percepts_true w t /\
  (forall before ev after, past = before ++ Act ev :: after -> grows ev -> follows_from t before ev) /\
  exists c p q, contradiction g = Some c /\ seen_as t past e p /\ seen_as t past h q /\
    follows_from_edges [(p, q)] (log_after (percept_at_start t) (acts past)) (two_vertices t past) c.

(** Claim 8. The edge of a rejection was posed last, the hypothesis with it, both are unexplored darts of
    S, and what the rejection cites disagrees. *)
Definition rejection_justified w t := let W := ground w in
  forall past e h, judged W t past (Act (Reject e h)) -> exists g phi H b o,
    cited t (length past) = Some g /\ drawn_by W past phi /\ open_dart (S_after W past) e /\
    open_dart (S_after W past) h /\ alpha W (phi e) = Some b /\ posed_with W (cited t) past e H b o /\
    In h H /\ match by_rule g with
      | ByFolding => contradiction_met w t past phi e h b g
      | _ => percepts_disagree W (cited t) past phi h b o g end.
