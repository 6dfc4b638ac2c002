(** The judge of claim 8: does what each rejection cites really disagree? (docs/semantics.md,
    section 9.)

    z is what the judge remembers, a memo; s the stage, said what rejections cite, M the map S, L a log,
    F its fold, f labels, R arcs; y is a history, r a tie, lab a label of each place; the other letters
    are those of Claims.v and Judge.v. JudgeRejections.v proves that it says [Failed] exactly where the
    claim is violated.

    Beside the stages of Judge.v the program keeps the walk behind the edge and what was seen behind
    unexplored darts of S. For a rejection by folding it folds the history with one edge more, and goes
    on behind a contradiction. *)
From Coq Require Import Arith List NArith Bool.
Import ListNotations.
From Topo Require Import World Rotation Log AnyWorld Augment Vertices Events LogFold Claims Judge.

(** What the judge remembers of rejections before a step: the hypotheses that were posed last; the walk
    since then; each dart of S behind which something was seen, with the doors from there on; and the
    history, while S is proved and where a contradiction is cited. *)
Record memo := { posed_hypotheses : list nat; walk_behind : outing;
  seen_behind : list (nat * list nat); proved_history : option history }.

(** What a sequence shows behind an unexplored dart, traced from dart a. *)
Definition shown_behind M a w := match traced M a w with (d, _ :: v) => [(d, v)] | _ => [] end.

(** The memo after a step at this stage. *)
Definition next_memo W said s z d := match d with
  | Pose e H => {| posed_hypotheses := H;
      walk_behind := let n := S (next_step (walk_behind z)) in
        match alpha W (at_image (images s) e) with
        | Some b => setting_out n (position s) b | None => setting_out n None 0 end;
      seen_behind := seen_behind z; proved_history := proved_history z |}
  | Act ev => {| posed_hypotheses := posed_hypotheses z;
      walk_behind := led_on W said (walk_behind z) d;
      seen_behind := match ev with
        | Loop e a _ | New e a _ => match asked s with
            | Some e' => if e' =? e then flat_map (shown_behind (drawn (chart s) ev) a)
                (sequences (walk_behind z)) ++ seen_behind z else seen_behind z
            | None => seen_behind z end
        | _ => seen_behind z end;
      proved_history := match proved_history z with
        | Some y => if negb (grows_b d) || follows_b y ev then Some (next_history y ev) else None
        | None => None end |} end.

(** Does a rejection of the trace cite a contradiction? *)
Definition cites_folding t := existsb (fun i => match cited t i with
  | Some g => match by_rule g with ByFolding => true | _ => false end | None => false end)
  (seq 0 (length (steps t))).

(** The memo at the start. *)
Definition first_memo t : memo := {| posed_hypotheses := [];
  walk_behind := setting_out 0 None 0; seen_behind := [];
  proved_history := if cites_folding t then Some (first_history (percept_at_start t)) else None |}.

(** Do the doors v begin the list? *)
Fixpoint doors_begin (v l : list nat) := match v, l with
  | [], _ => true
  | k :: v, j :: l => (k =? j) && doors_begin v l
  | _, [] => false end.

(** Is this percept cited? *)
Definition cites (o : option Percept) p := match o with Some q => percept_eqb q p | None => false end.

(** Is no other percept cited? *)
Definition may_cite (o : option Percept) p := match o with Some q => percept_eqb q p | None => true end.

(** Is nothing cited? *)
Definition is_none {X} (o : option X) := match o with Some _ => false | None => true end.

(** What is expected where the doors lead that are traced to d, with [rest] to go; None if the record
    that is cited does not tell. *)
Definition expectation W s z g d (rest : list nat) := match rest, record_cited g with
  | [], None => Some (percept (chart s) d)
  | _ :: v, Some (d', v') =>
      if (d' =? d) && doors_begin v v' && doors_begin v' v &&
        existsb (fun r => (fst r =? d) && doors_begin v (snd r)) (seen_behind z)
      then match alpha W (at_image (images s) d) with
        | Some c => option_map (percept W) (walk W c v) | None => None end
      else None
  | _, _ => None end.

(** Do the cited percepts disagree? *)
Definition disagreeing W s z h b g := is_none (contradiction g) &&
  match word_cited (walk_behind z) g with
  | Some w => match walk W b w with
      | Some x => let (d, rest) := traced (chart s) h w in
          cites (observed g) (percept W x) &&
          match traced_at g with Some d' => d' =? d | None => true end &&
          match expectation W s z g d rest with
          | Some y => cites (expected g) y && negb (percept_eqb y (percept W x)) | None => false end
      | None => false end
  | None => false end.

(** A tie from one place to another, of a kind. If two places are one, so are those to which ties of one
    kind lead. *)
Definition tie : Type := place * option (nat * bool) * place.

(** Are two kinds equal? *)
Definition kind_eqb (k l : option (nat * bool)) := match k, l with
  | Some (d, m), Some (e, n) => (d =? e) && Bool.eqb m n
  | None, None => true
  | _, _ => false end.

(** Two ties of one kind from one place. *)
Definition alongside (r r' : tie) := place_eqb (fst (fst r)) (fst (fst r')) &&
  kind_eqb (snd (fst r)) (snd (fst r')).

(** Two places to which two such ties lead. *)
Fixpoint pulled_together (l : list tie) := match l with
  | [] => None
  | r :: l => match find (fun r' => alongside r r' && negb (place_eqb (snd r) (snd r'))) l with
      | Some r' => Some (snd r, snd r')
      | None => pulled_together l end end.

(** Places with one label are one; all that is tied is made one, in at most n steps. *)
Fixpoint tied_up n (lab : place -> place) (l : list tie) := match n with
  | 0 => lab
  | S n => match pulled_together (map (fun r => (lab (fst (fst r)), snd (fst r), lab (snd r))) l) with
      | Some (x, y) => tied_up n (fun p => let q := lab p in if place_eqb q x then y else q) l
      | None => lab end end.

(** The places of the fold. *)
Definition fold_places L f := let s := percepts_of L in
  flat_map (fun i => map (pair i) (seq 0 (degree_at s i)))
    (filter (fun i => fst (label_of f i) =? i) (seq 0 (length s))).

(** The ties of the fold by its edges, and by an edge from p to q. *)
Definition edge_ties L f R p q : list tie := let n := found (percepts_of L) f in
  map (fun r => (n (fst r), sign_at L (fst (snd r)), n (snd r))) (R ++ [(p, q); (q, p)]).

(** Its ties by turning. *)
Definition turn_ties L f : list tie :=
  map (fun x => (x, None, found (percepts_of L) f (fst x, S (snd x)))) (fold_places L f).

(** Is there the contradiction c in the fold with an edge from p to q, where no two places in a pair of
    [apart] are one? *)
Definition contradicts L F p q apart c := match F with
  | None => false
  | Some (f, R) => let edges := edge_ties L f R p q in let l := edges ++ turn_ties L f in
      let lab := tied_up (length l) (fun x => x) l in
      let one x y := place_eqb (lab x) (lab y) in match c with
      | Unlike => existsb (fun r => existsb (fun r' => one (fst (fst r)) (fst (fst r')) &&
          negb (kind_eqb (snd (fst r)) (snd (fst r')))) edges) edges
      | Turned => existsb (fun x => existsb (fun y => (fst x =? fst y) && (snd x <? snd y) && one x y)
          (fold_places L f)) (fold_places L f)
      | OwnEnd => existsb (fun r : tie => one (fst (fst r)) (snd r)) edges
      | TwoOfS => let n := found (percepts_of L) f in
          existsb (fun r : place * place => one (n (fst r)) (n (snd r))) apart
      | OtherWords => false end end.

(** The places of darts of S at different vertices, in pairs. *)
Definition spots_apart y := let M := sketched y in flat_map (fun d =>
  map (fun d' => (spot y d, spot y d')) (filter (fun d' => negb (at_vertex M d d')) (seq 0 (darts M))))
  (seq 0 (darts M)).

(** Is the cited contradiction met? [sure] tells whether all percepts of the trace are true. *)
Definition contradicted W sure s z e h b g := (doors_behind g =? 0) && is_none (sequence_cited g) &&
  is_none (traced_at g) && is_none (record_cited g) &&
  may_cite (expected g) (percept W (at_image (images s) h)) && may_cite (observed g) (percept W b) &&
  sure && match proved_history z, contradiction g with
  | Some y, Some c => let L := so_far y in
      contradicts L (fold_of L) (spot y e) (spot y h) (spots_apart y) c
  | _, _ => false end.

(** Is a rejection justified at this stage? *)
Definition justified W said sure s z e h := match said (next_step (walk_behind z)) with
  | Some g => is_open (chart s) e && is_open (chart s) h && mem h (posed_hypotheses z) &&
      match asked s with Some e' => e' =? e | None => false end &&
      match alpha W (at_image (images s) e) with
      | Some b => match by_rule g with
          | ByFolding => contradicted W sure s z e h b g
          | _ => disagreeing W s z h b g end
      | None => false end
  | None => false end.

(** Is some rejection among these steps not justified? *)
Fixpoint unjustified W said sure s z l := match l with
  | [] => false
  | d :: l => match d with
      | Act (Reject e h) => live s && negb (justified W said sure s z e h) | _ => false end ||
      unjustified W said sure (next_stage W s d) (next_memo W said s z d) l end.

(** Claim 8. *)
Definition judge_justified w t := let W := ground w in let z := last_stage W t in
  let n := how_many W t is_reject in
  judged_as (declares w t (fun d => is_pose d || is_reject d))
    (unjustified W (cited t) (shows_b W (trace_log t)) (first_stage W) (first_memo t) (steps t))
    n (n + add_up (fun q : nat * (bool * nat) => snd (snd q)) (settled z) + unsettled z).
