(** What a mapper declares: the mapper of Mapper.v, told with its decisions and the map that it delivers
    (docs/semantics.md, sections 4 and 13).

    M     the map S                      T     what the rule remembers of earlier edges
    e     the dart being explored        v     the robot         t    the trail
    pu    the percept behind e           H     the hypotheses, each with its way home
    h     a hypothesis                   ds    the doors from vu to where the robot stands
    p, q  a program, and the same program with declarations

    A telling is a program that also declares. [told_round] is [round] with a declaration wherever a
    decision is made. But for the declarations the two are one: the same result, the same last place and
    the same moves ([told_same]). So what is proved of the mapper holds for the moves and the map here,
    and the tests compare moves, declarations and map, in their order, with the Python code. *)
From Coq Require Import Arith Lia List Bool.
Import ListNotations.
From Topo Require Import World Rotation Embedding Augment Program Mapper MapperCorrect Algorithms Log
  AnyWorld AnyMapper.

(** What is told: a move, and what was sensed behind it; the hypotheses of e; that h is rejected, by the
    rule or by motion, which found a difference after so many doors; that h is confirmed, by the rule or
    by motion; that the map grows by a loop, or by a vertex of degree d whose first dart is a. *)
Inductive telling_event := Moved (k : nat) (p : Percept) | Posed (e : nat) (H : list nat)
  | Ruled_out (e h : nat) | Walked_out (e h steps : nat) | Ruled_in (e h : nat) | Walked_in (e h : nat)
  | Looped (e h d : nat) | Hung (e a d : nat).

(** A program that declares. *)
Inductive telling (A : Type) : Type :=
| Done (x : A)
| Go (k : nat) (go_on_with : Percept -> telling A)
| Tell (ev : telling_event) (rest : telling A)
| Halt.
Arguments Done {A}.
Arguments Go {A}.
Arguments Tell {A}.
Arguments Halt {A}.

(** Do p, and then what f says of its result. *)
Fixpoint then_tell {A B} (p : telling A) (f : A -> telling B) : telling B := match p with
  | Done x => f x
  | Go k g => Go k (fun q => then_tell (g q) f)
  | Tell ev p => Tell ev (then_tell p f)
  | Halt => Halt end.

(** A program that declares nothing. *)
Fixpoint silent {A} (p : program A) : telling A := match p with
  | Return x => Done x | Leave k g => Go k (fun q => silent (g q)) | Stuck => Halt end.

(** Declare one thing after the other. *)
Definition tell_all {A} evs (p : telling A) := fold_right Tell p evs.

(** The robot performs p in W from dart a: the result, its last reference dart, and all that is told. *)
Fixpoint perform_told {A} W a (p : telling A) : option (A * nat * list telling_event) := match p with
  | Done x => Some (x, a, [])
  | Go k g => match move W a k with
      | Some b => match perform_told W b (g (percept W b)) with
                  | Some (x, c, evs) => Some (x, c, Moved k (percept W b) :: evs) | None => None end
      | None => None end
  | Tell ev p => match perform_told W a p with
      | Some (x, c, evs) => Some (x, c, ev :: evs) | None => None end
  | Halt => None end.

(** The moves among what is told. *)
Definition told_moves (evs : list telling_event) :=
  flat_map (fun ev => match ev with Moved k p => [(k, p)] | _ => [] end) evs.

Section Declared.
Variables (pick : Map -> nat -> option nat) (path : Map -> nat -> nat -> list nat * nat)
          (order : Map -> list nat -> list nat) (motion : Motion) (rule : Rule).

(** Rule by rule: the hypotheses that are not kept. *)
Definition ruled_out e (kept : hypothesis -> bool) (H : list hypothesis) :=
  map (fun c : hypothesis => Ruled_out e (fst c)) (filter (fun c => negb (kept c)) H).

(** The place of the first difference of two lists of percepts. *)
Fixpoint first_difference (ps qs : list Percept) := match ps, qs with
  | p :: ps, q :: qs => if percept_eqb p q then S (first_difference ps qs) else 0 | _, _ => 0 end.

(** [test_all], told. A loop is declared before the robot goes back to vu. *)
Fixpoint told_tests n M e pu T (log : list sequence) ds qs v t (H : list hypothesis)
  : telling (option (nat * nat) * list sequence * (robot * robot_trail)) :=
  let none := silent (bind (with_trail (undo v (rev ds)) t) (fun vt => Return (None, log, vt))) in
  match n with
  | 0 => none
  | S n =>
    let kept := keep rule M e pu T log t in
    let K := filter kept H in
    tell_all (ruled_out e kept H)
    match find (concludes rule M e pu T log t) K, motion ds K with
    | Some (h, _), _ =>
        Tell (Ruled_in e h) (Tell (Looped e h (fst pu)) (silent (concluded M h log ds v t)))
    | None, None => none
    | None, Some ((h, w), s) =>
      let K := filter (fun c => negb (fst c =? h)) K in
      then_tell (silent (with_trail (undo v (rev (skipn s ds))) t)) (fun '(v, t) =>
        match percepts M h w, walk M h (firstn s w), walk M h w with
        | Some ps, Some x, Some y =>
          if percept_eqb (percept M h) pu && percepts_eqb (firstn s ps) (firstn s qs)
          then then_tell (silent (with_trail (follow M x (skipn s w) v) t)) (fun r =>
            let '(matched, more, v, t) := r in
            let ds := firstn s ds ++ firstn (length more) (skipn s w) in
            let qs := firstn s qs ++ more in
            if matched : bool
            then Tell (Walked_in e h) (Tell (Looped e h (fst pu)) (Done (Some (h, y), log, (v, t))))
            else Tell (Walked_out e h (s + length more))
              (told_tests n M e pu T ((ds, qs) :: log) ds qs v t K))
          else Tell (Walked_out e h (first_difference (percept M h :: ps) (pu :: qs)))
            (told_tests n M e pu T log (firstn s ds) (firstn s qs) v t K)
        | _, _, _ => Halt
        end)
    end
  end.

(** [round], told. *)
Definition told_round (st : state rule) e : telling (state rule) :=
  let '(M, p, v, T, t) := st in
  let (w, k) := path M e p in
  then_tell (silent (with_trail (execute v (w ++ [k])) t)) (fun '(v, u) =>
    let home := path M (root M) in
    let hs := hypotheses order M e (fst v) in
    let H := map (fun h => (h, fst (home h))) hs in
    Tell (Posed e hs) (then_tell (told_tests (length H) M e (fst v) T [] [] [] v u H) (fun r =>
      match r with
      | (Some (h, x), log, (v', t)) =>
          let N := augment_loop M e h in Done (N, x, v', learn rule N e h T log u, t)
      | (None, log, (v', t)) => let N := augment_new M e (fst (fst v)) in
          Tell (Hung e (darts M) (fst (fst v)))
            (Done (N, darts M, v', learn rule N e (darts M) T log u, t))
      end))).

(** [explore], told. *)
Fixpoint told_explore fuel (st : state rule) : telling Map :=
  match pick (map_in rule st) (dart_in rule st) with
  | None => Done (map_in rule st)
  | Some e => match fuel with
              | 0 => Halt
              | S fuel => then_tell (told_round st e) (told_explore fuel)
              end
  end.

(** The program p and the telling q do the same: performed anywhere, they have the same result, the same
    last place and the same moves. *)
Definition same_performance {A} (p : program A) (q : telling A) := forall W a, perform W a p =
  match perform_told W a q with
  | Some (x, b, evs) => Some (x, b, told_moves evs) | None => None end.

(** What is told between changes nothing. *)
Lemma same_tell {A} (p : program A) q ev : match ev with Moved _ _ => False | _ => True end ->
  same_performance p q -> same_performance p (Tell ev q).
Proof.
  intros Q E W a. rewrite (E W a). simpl. destruct (perform_told W a q) as [((x, b), evs)|]; auto.
  destruct ev; [destruct Q|..]; auto.
Qed.

(** A program that declares nothing does the same. *)
Lemma same_silent {A} (p : program A) : same_performance p (silent p).
Proof.
  induction p as [x|k g IH|]; intros W a; simpl; auto. destruct (move W a k) as [b|]; auto.
  rewrite (IH _ W b). destruct (perform_told W b _) as [((x, c), evs)|]; auto.
Qed.

(** One after the other. *)
Lemma perform_then_tell {A B} W (p : telling A) (f : A -> telling B) : forall a,
  perform_told W a (then_tell p f) =
  match perform_told W a p with
  | Some (x, b, evs) => match perform_told W b (f x) with
      | Some (y, c, more) => Some (y, c, evs ++ more) | None => None end
  | None => None end.
Proof.
  induction p as [x|k g IH|ev p IH|]; simpl; intros a; auto.
  - destruct (perform_told W a (f x)) as [((y, c), evs)|]; auto.
  - destruct (move W a k) as [b|]; auto. rewrite IH.
    destruct (perform_told W b (g _)) as [((x, c), evs)|]; auto.
    destruct (perform_told W c (f x)) as [((y, d), more)|]; auto.
  - rewrite IH. destruct (perform_told W a p) as [((x, c), evs)|]; auto.
    destruct (perform_told W c (f x)) as [((y, d), more)|]; auto.
Qed.

(** One after the other, each does the same. *)
Lemma same_then {A B} (p : program A) q (f : A -> program B) g : same_performance p q ->
  (forall x, same_performance (f x) (g x)) -> same_performance (bind p f) (then_tell q g).
Proof.
  intros E F W a. rewrite perform_bind, perform_then_tell, (E W a).
  destruct (perform_told W a q) as [((x, b), evs)|]; auto. rewrite (F x W b).
  destruct (perform_told W b (g x)) as [((y, c), more)|]; auto.
  unfold told_moves. rewrite flat_map_app. auto.
Qed.

(** Rejections by rule change nothing. *)
Lemma same_ruled_out {A} (p : program A) q e kept H : same_performance p q ->
  same_performance p (tell_all (ruled_out e kept H) q).
Proof.
  intros E. unfold ruled_out, tell_all. induction (filter _ H) as [|c l IH]; simpl; auto.
  apply same_tell; simpl; auto.
Qed.

(** The tests do the same. *)
Lemma same_tests n : forall M e pu T log ds qs v t H,
  same_performance (test_all motion rule n M e pu T log ds qs v t H)
    (told_tests n M e pu T log ds qs v t H).
Proof.
  induction n as [|n IH]; intros M e pu T log ds qs v t H; [apply same_silent|].
  cbn [test_all told_tests]. cbv zeta. apply same_ruled_out.
  destruct (find _ _) as [(h, w)|].
  - apply same_tell; simpl; auto. apply same_tell; simpl; auto. apply same_silent.
  - destruct (motion ds _) as [((h, w), s)|]; [|apply same_silent].
    apply same_then; [apply same_silent|]. intros (v', t').
    destruct (percepts M h w) as [ps|]; [|apply (same_silent Stuck)].
    destruct (walk M h (firstn s w)) as [x|]; [|apply (same_silent Stuck)].
    destruct (walk M h w) as [y|]; [|apply (same_silent Stuck)].
    destruct (percept_eqb _ _ && _); [|apply same_tell; simpl; auto].
    apply same_then; [apply same_silent|]. intros (((matched, more), v''), t'').
    destruct matched; [|apply same_tell; simpl; auto].
    apply same_tell; simpl; auto. apply same_tell; simpl; auto. apply (same_silent (Return _)).
Qed.

(** A round does the same. *)
Lemma same_round st e : same_performance (round path order motion rule st e) (told_round st e).
Proof.
  destruct st as ((((M, p), v), T), t). unfold round, told_round. destruct (path M e p) as (w, k).
  apply same_then; [apply same_silent|]. intros (v', u). cbv zeta. apply same_tell; simpl; auto.
  apply same_then; [apply same_tests|]. intros (([(h, x)|], log), (v'', t')).
  - apply (same_silent (Return _)).
  - apply same_tell; simpl; auto. apply (same_silent (Return _)).
Qed.

(** The exploration does the same: it delivers the same map, and makes the same moves. *)
Lemma told_same fuel : forall st,
  same_performance (explore pick path order motion rule fuel st) (told_explore fuel st).
Proof.
  induction fuel as [|fuel IH]; intros st; simpl; destruct (pick _ _) as [e|];
    try apply (same_silent (Return _)); [apply (same_silent Stuck)|].
  apply same_then; [apply same_round|auto].
Qed.
End Declared.

(** All that is told in w, and the delivered map. In the point it is one without a dart, at once. *)
Definition trace_in (A : algorithm) pick path order w :=
  let p q := told_explore pick path order (snd A) (fst A) (darts_in w) (initial_state (fst A) q) in
  match w with
  | Point => match p nothing_there with Done M => Some (M, []) | _ => None end
  | Edges W => match perform_told W (root W) (p (percept W (root W))) with
      | Some (M, _, evs) => Some (M, evs) | None => None end end.

(** The trace of an algorithm has the moves and the map of [perform_in], of which all is proved.
    Not in the paper. *)
Theorem trace_in_same A pick path order w :
  perform_in w (run_of A pick path order (darts_in w)) =
  match trace_in A pick path order w with
  | Some (M, evs) => Some (M, told_moves evs) | None => None end.
Proof.
  destruct w as [|W]; unfold perform_in, trace_in, run_of, mapper.
  - simpl. destruct (pick _ _); auto.
  - rewrite (told_same pick path order (snd A) (fst A) _ _ W (root W)).
    destruct (perform_told _ _ _) as [((M, b), evs)|]; auto.
Qed.
