(* The extracted checkers as a program: a certificate on standard input, "accepted" or "refused" on
   standard output. Whole numbers, separated by white space:

     statement                      map, undetermined or impossible
     degree marker                  of the first percept; marker -1 where it is not seen
     n, then n times: door degree marker
     t, then t times: next previous other        the table of the map; other -1 where it is open
     e, then e times: forwards visit forwards visit      the evidence; forwards is 0 or 1
     conflict                       a and four numbers as in the evidence; m visit; e edge

   Anything else is refused: a negative number is never read as a natural one. *)
open Certifier

let natural x = if x < 0 then failwith "negative" else x
let option x = if x = -1 then None else Some (natural x)

let rec positive n =
  if n < 1 then failwith "not positive"
  else if n = 1 then XH
  else if n land 1 = 1 then XI (positive (n / 2))
  else XO (positive (n / 2))

let number () = Scanf.scanf " %d" natural
let optional () = Scanf.scanf " %d" option
let visit () = positive (number ())

let many read =
  let rec go n read_so_far = if n = 0 then List.rev read_so_far else go (n - 1) (read () :: read_so_far) in
  go (number ()) []

let percept () = let degree = number () in let marker = optional () in (degree, marker)
let move () = let door = number () in let seen = percept () in (door, seen)
let row () =
  let next = number () in let previous = number () in let other = optional () in
  ((next, previous), other)
let arc () = let forwards = number () = 1 in let visit = visit () in (forwards, visit)
let meeting () = let one = arc () in let other = arc () in (one, other)

let conflict () = Scanf.scanf " %c" (function
  | 'a' -> Arrive (meeting ())
  | 'm' -> Marked (visit ())
  | 'e' -> Alone (visit ())
  | _ -> failwith "no conflict")

let () =
  let statement = Scanf.scanf " %s" Fun.id in
  let start = percept () in
  let moves = many move in
  let log = { start; moves } in
  let table = many row in
  let evidence = many meeting in
  let conflict = conflict () in
  let accepted = match statement with
    | "map" -> certified log table evidence
    | "undetermined" -> refute log table
    | "impossible" -> impossible log evidence conflict
    | _ -> failwith "no statement" in
  print_endline (if accepted then "accepted" else "refused")
