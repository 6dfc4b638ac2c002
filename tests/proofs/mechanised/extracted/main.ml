(* The main program of the extracted mappers. It reads from standard input how many runs there are,
   and for each run

     algorithm pick order           names of the catalogue. After a pick "random" stands the list of its
                                    choices, after an order "random" a list of lists; a list is its
                                    length and its elements
     n, then n times: next          the next dart clockwise, for each dart
     n, then n times: other         the other dart of its edge

   separated by white space; the root is dart 0, and without a dart it is the world without an edge. For
   each run it prints on one line all that is told, then the delivered map, or "stuck":

     move k degree marker    the marker is -1 where it is not
     pose e h h ...          reject e h, or reject e h step        confirm e h, or confirm e h motion
     loop e h degree         new e dart degree
     map n next ... edges ... root cost    each edge by its two darts, the lower one first; the root is
                                           -1 where there is no dart; the cost is the number of moves *)
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

let line name numbers = String.concat " " (name :: List.map string_of_int numbers)

let told = function
  | Moved (k, (degree, marker)) -> line "move" [k; degree; Option.value marker ~default:(-1)]
  | Posed (e, hypotheses) -> line "pose" (e :: hypotheses)
  | Ruled_out (e, h) -> line "reject" [e; h]
  | Walked_out (e, h, steps) -> line "reject" [e; h; steps]
  | Ruled_in (e, h) -> line "confirm" [e; h]
  | Walked_in (e, h) -> line "confirm" [e; h] ^ " motion"
  | Looped (e, h, degree) -> line "loop" [e; h; degree]
  | Hung (e, dart, degree) -> line "new" [e; dart; degree]

let delivered m events =
  let darts = List.init m.darts Fun.id in
  let other d = Option.get (m.alpha d) in
  let edges = List.concat_map (fun d -> if d < other d then [d; other d] else []) darts in
  let cost = List.length (List.filter (function Moved _ -> true | _ -> false) events) in
  let root = if darts = [] then -1 else m.root in
  line "map" ((m.darts :: List.map m.sigma darts) @ edges @ [root; cost])

let run () =
  let algorithm = algorithm (word ()) in
  let pick = pick (word ()) in
  let order = order (word ()) in
  match trace_in algorithm pick way_to order (world ()) with
  | Some (map, events) -> print_endline (String.concat ";" (List.map told events @ [delivered map events]))
  | None -> print_endline "stuck"

let () = for _ = 1 to number () do run () done
