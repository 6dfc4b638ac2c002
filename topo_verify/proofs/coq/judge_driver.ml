(* The main program of the extracted judge. It reads natural numbers from standard input, separated by
   white space: how many runs there are, and for each run

     asked    1 if claim 8 is asked, or 0; the same for claim 10
     world    the next dart clockwise of each dart, and the other dart of its edge, two lists; dart 0 is the
              root; without a dart it is the point
     trace    percept, steps, end
     percept  degree; 0, or 1 more than the direction of the marker
     steps    how many, and each: 0 door percept; 1 e h citation (reject); 2 e h (confirm); 3 e h d
              (loop); 4 e a d (new); 5 e H (pose)
     citation rule (0 motion, 1 prefix, history or records, 2 folding), step, expected, observed (each 0;
              or 1 and the percept), sequence, at (each 0, or 1 more than it), record (0; or 1, dart
              and doors), contradiction (0; or its number, in the order of Claims.v)
     end      0; or 1, the cost (0, or 1 more than it), and the map (0 if it is none; or 1, rotations, pairs
              and the marked dart)

   A list is its length and its elements. For each run it prints one line: of each claim status, judged
   and of. *)
open Judge

let number () = Scanf.scanf " %u" Fun.id
let many read = let n = number () in List.init n (fun _ -> read ())
let optional () = match number () with 0 -> None | n -> Some (n - 1)

let rec positive n = if n = 1 then XH else if n land 1 = 1 then XI (positive (n / 2)) else XO (positive (n / 2))
let label () = match number () with 0 -> N0 | n -> Npos (positive n)

let percept () = let degree = number () in (degree, optional ())

let stated read = if number () = 0 then None else Some (read ())

let citation () =
  let by_rule = [| InMotion; ByTracing; ByFolding |].(number ()) in
  let doors_behind = number () in
  let expected = stated percept in
  let observed = stated percept in
  let sequence_cited = optional () in
  let traced_at = optional () in
  let record_cited = stated (fun () -> let dart = number () in (dart, many number)) in
  let contradiction = Option.map (fun i -> [| Unlike; Turned; OwnEnd; TwoOfS; OtherWords |].(i)) (optional ()) in
  { by_rule; doors_behind; expected; observed; sequence_cited; traced_at; record_cited; contradiction }

(* A step, and what it cites if it is a rejection. *)
let step () =
  let kind = number () in
  let e = number () in
  match kind with
  | 0 -> (Act (Move (e, percept ())), None)
  | 1 -> let h = number () in (Act (Reject (e, h)), Some (citation ()))
  | 2 -> (Act (Confirm (e, number ())), None)
  | 3 -> let h = number () in (Act (Loop (e, h, number ())), None)
  | 4 -> let a = number () in (Act (New (e, a, number ())), None)
  | 5 -> (Pose (e, many number), None)
  | _ -> failwith "no step"

let delivery () =
  let rotations = many (fun () -> many label) in
  let pairs = many (fun () -> let one = label () in (one, label ())) in
  { rotations; pairs; marked_label = label () }

let ending () =
  let reported_cost = optional () in
  { reported_cost; reported_map = (if number () = 0 then None else Some (delivery ())) }

let world () =
  let next = Array.of_list (many number) in
  let other = Array.of_list (many number) in
  let alpha d = if d < Array.length other then Some other.(d) else None in
  let sigma d = if d < Array.length next then next.(d) else d in
  if next = [||] then Point else Edges { darts = Array.length next; sigma; alpha; root = 0 }

let trace () =
  let percept_at_start = percept () in
  let steps, citations = List.split (many step) in
  let citations = Array.of_list citations in
  let cited i = if i < Array.length citations then citations.(i) else None in
  { percept_at_start; steps; cited; finish = (if number () = 0 then None else Some (ending ())) }

let word = function Ok -> "ok" | Failed -> "failed" | Partial -> "partial" | NotDeclared -> "not-declared"

let run () =
  let justified = number () = 1 in
  let decisions = number () = 1 in
  let world = world () in
  let trace = trace () in
  let told ((status, judged), of_) = Printf.sprintf "%s %d %d" (word status) judged of_ in
  let asked is_asked judge = if is_asked then [judge world trace] else [] in
  print_endline (String.concat " " (List.map told (judge_trace world trace @ asked justified judge_justified
    @ asked true judge_entailed @ asked decisions judge_decisions)))

let () = for _ = 1 to number () do run () done
