(* The main program of the extracted check. It reads the numbers of a certificate from standard input,
   separated by white space, and prints "refused", or "accepted" and the summary of Certificate.v:
   the claim, 1 if the delivered map is right, how many decisions are proved, how many there are.
   Anything that is no natural number below 2^61 ends the program with an error. *)
open Certifier

let rec positive n = if n = 1 then XH else if n land 1 = 1 then XI (positive (n / 2)) else XO (positive (n / 2))
let natural n =
  if n < 0 || n >= 1 lsl 61 then failwith "no natural number below 2^61"
  else if n = 0 then N0 else Npos (positive n)

let rec whole = function XH -> 1 | XO p -> 2 * whole p | XI p -> 2 * whole p + 1
let printed = function N0 -> 0 | Npos p -> whole p

let rec numbers read =
  match Scanf.scanf " %s" Fun.id with
  | "" -> List.rev read
  | word when String.for_all (fun c -> '0' <= c && c <= '9') word ->
      numbers (natural (int_of_string word) :: read)
  | _ -> failwith "no number"

let () =
  let given = numbers [] in
  match check_numbers given, summary given with
  | true, Some ((claim, delivered), (proved, decisions)) ->
      Printf.printf "accepted %d %d %d %d\n"
        (printed claim) (printed delivered) (printed proved) (printed decisions)
  | _ -> print_endline "refused"
