(* The main program of the extracted mappers. It reads from standard input how many runs there are,
   and for each run

     algorithm pick order           names of the catalogue. After a pick "random" stands the list of its
                                    choices, after an order "random" a list of lists; a list is its
                                    length and its elements
     n, then n times: next          the next dart clockwise, for each dart
     n, then n times: other         the other dart of its edge

   separated by white space; the root is dart 0, and without a dart it is the world without an edge. For
   each run it prints "doors" and the doors that the robot takes, or "stuck", on one line. *)
open Mappers

let algorithm = function
  | "basic" -> basic
  | "enhancement-i" -> enhancement_i
  | "enhancement-ii" -> enhancement_ii
  | "enhancement-ii+i" -> enhancement_ii_i
  | "enhancement-iii-one" -> enhancement_iii_one
  | "enhancement-iii-one+i" -> enhancement_iii_one_i
  | "enhancement-iii-all" -> enhancement_iii_all
  | "enhancement-iii-all+i" -> enhancement_iii_all_i
  | "folding" -> folding
  | name -> failwith ("no algorithm " ^ name)

let word () = Scanf.scanf " %s" Fun.id
let number () = Scanf.scanf " %d" Fun.id
let many read = let n = number () in Array.init n (fun _ -> read ())
let numbers () = many number

(* After the last choice there is nothing left to choose. *)
let choice_of choices none i = if i < Array.length choices then choices.(i) else none

let pick = function
  | "random" -> chosen_dart (choice_of (numbers ()) 0)
  | "nearest" -> nearest
  | "first" -> first_open
  | "last" -> last_open
  | name -> failwith ("no pick policy " ^ name)

let order = function
  | "random" -> shuffled (choice_of (many (fun () -> Array.to_list (numbers ()))) [])
  | "shortest" -> shortest
  | "oldest" -> oldest
  | "newest" -> newest
  | name -> failwith ("no order policy " ^ name)

let world () =
  let next = numbers () in
  let other = numbers () in
  let alpha d = Some other.(d) in
  if next = [||] then Point
  else Edges { darts = Array.length next; sigma = Array.get next; alpha; root = 0 }

let run () =
  let algorithm = algorithm (word ()) in
  let pick = pick (word ()) in
  let order = order (word ()) in
  match doors_taken algorithm pick way_to order (world ()) with
  | Some doors -> print_endline (String.concat " " ("doors" :: List.map string_of_int doors))
  | None -> print_endline "stuck"

let () = for _ = 1 to number () do run () done
