(* The main program of the extracted judge. It reads natural numbers from standard input, separated by
   white space: how many runs there are, and for each run

     asked    1 if claim 10 is asked, or 0
     world    the next dart clockwise of each dart, and the other dart of its edge, two lists; dart 0 is the
              root; without a dart it is the point
     trace    percept, steps, end
     percept  degree; 0, or 1 more than the direction of the marker
     steps    how many, and each: 0 door percept; 1 e h (reject); 2 e h (confirm); 3 e h d (loop);
              4 e a d (new); 5 e H (pose)
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

let step () =
  let kind = number () in
  let e = number () in
  match kind with
  | 0 -> Act (Move (e, percept ()))
  | 1 -> Act (Reject (e, number ()))
  | 2 -> Act (Confirm (e, number ()))
  | 3 -> let h = number () in Act (Loop (e, h, number ()))
  | 4 -> let a = number () in Act (New (e, a, number ()))
  | 5 -> Pose (e, many number)
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
  let steps = many step in
  { percept_at_start; steps; finish = (if number () = 0 then None else Some (ending ())) }

let word = function Ok -> "ok" | Failed -> "failed" | Partial -> "partial" | NotDeclared -> "not-declared"

let run () =
  let asked = number () = 1 in
  let world = world () in
  let trace = trace () in
  let told ((status, judged), of_) = Printf.sprintf "%s %d %d" (word status) judged of_ in
  print_endline (String.concat " " (List.map told (judge_trace world trace @ if asked then [judge_decisions world trace] else [])))

let () = for _ = 1 to number () do run () done
