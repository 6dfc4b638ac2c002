(* The main program of the extracted checkers. It reads a certificate from standard input and prints
   "accepted" or "refused". The input is one word, then whole numbers and letters, separated by
   white space:

     statement                      map, undetermined, impossible or decisions
     degree marker                  the first percept; marker is -1 where it is not seen
     n, then n times: door degree marker

   For the first three statements then follow

     t, then t times: next previous other        the table of the map; other is -1 where it is open
     e, then e times: forwards visit forwards visit      the evidence; forwards is 0 or 1
     conflict                       a and four numbers as in the evidence; m visit; e edge

   For decisions then follow the merges, written as the evidence above, and

     d, then d times: leads visit place place reason        leads is 0 or 1; a place: visit offset
     reason                         j forwards visit; r, then evidence and conflict as above

   Any other input ends the program with an error, and so does a negative number: it is never read
   as a natural one. *)
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

let place () = let visit = visit () in let offset = number () in (visit, offset)

let decision () =
  let leads = number () = 1 in let at = visit () in
  let one = place () in let other = place () in
  if leads then Leads (at, one, other) else LeadsNot (at, one, other)

let reason () = Scanf.scanf " %c" (function
  | 'j' -> Joined (arc ())
  | 'r' -> let evidence = many meeting in Refuted (evidence, conflict ())
  | _ -> failwith "no reason")

let decided_of log =
  let merges = many meeting in
  let decisions, reasons =
    List.split (many (fun () -> let one = decision () in (one, reason ()))) in
  decided log merges decisions reasons

let stated_of log statement =
  let table = many row in
  let evidence = many meeting in
  let conflict = conflict () in
  match statement with
    | "map" -> certified log table evidence
    | "undetermined" -> refute log table
    | "impossible" -> impossible log evidence conflict
    | _ -> failwith "no statement"

let () =
  let statement = Scanf.scanf " %s" Fun.id in
  let start = percept () in
  let moves = many move in
  let log = { start; moves } in
  let accepted = if statement = "decisions" then decided_of log else stated_of log statement in
  print_endline (if accepted then "accepted" else "refused")
