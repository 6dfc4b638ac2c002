(* The main program of the extracted list of worlds. Each line that it reads is a request:

     list m      every world with m edges, in their order
     at m k      the world of rank k, and the rank of that world; ranks are written in base 2

   A world is printed as the next dart of each dart, then the partner of each dart. *)
open Worlds

let rec positive = function
  | [] -> failwith "no positive number" | ['1'] -> XH
  | '1' :: bits -> XI (positive bits) | _ :: bits -> XO (positive bits)

let rank_of text =
  if text = "0" then N0 else Npos (positive (List.rev (List.of_seq (String.to_seq text))))

let rec bits = function XH -> "1" | XI p -> bits p ^ "1" | XO p -> bits p ^ "0"
let printed = function N0 -> "0" | Npos p -> bits p

let shown w =
  let row f = String.concat " " (List.init w.darts (fun d -> string_of_int (f d))) in
  row w.sigma ^ " " ^ row (fun d -> match w.alpha d with Some e -> e | None -> failwith "open")

(* unrank and world_rank of Ranks.v, with one table for all ranks of m. *)
let table = Hashtbl.create 50
let formula m =
  if not (Hashtbl.mem table m) then Hashtbl.add table m (formula_rows (m + 1));
  by_rows (Hashtbl.find table m)

let answer line = match String.split_on_char ' ' line with
  | ["list"; m] -> List.iter (fun p -> print_endline (shown (planned p))) (plans (int_of_string m))
  | ["at"; m; k] ->
      let m = int_of_string m in
      let w = planned (plan_at (formula m) m (rank_of k)) in
      print_endline (shown w ^ " " ^ printed (plan_rank (formula m) m (plan_of m w)))
  | _ -> failwith "no request"

let () = try while true do answer (read_line ()) done with End_of_file -> ()
