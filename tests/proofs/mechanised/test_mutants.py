"""Statements and rules with one thing wrong: coqc must refuse each.

A mutant is a patch of one source; the file and those that need it are compiled again, in their
order, until one is refused. All of them are false, or leave something out that the next proof
needs; a refusal shows that a proof rests on what was changed, not that its contrary is proved.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import pytest

from tests.proofs.mechanised.conftest import LIMIT
from topo_verify.proofs.mechanised import toolchain

CARELESS = ("Syntax error", "was not found", "Cannot find a physical path", "Cannot infer")
"""What Coq says of a patch that is no statement at all."""


@dataclass(frozen=True, slots=True)
class Mutant:
    """In this file `old` becomes `new`; `refused` is the file whose proof breaks."""

    name: str
    file: str
    old: str
    new: str
    refused: str


MUTANTS = (
    Mutant("undirected-comparison", "Embedding",
        "marker M r = Some j -> marker W c = Some j -> a = phi h",
        "marker M r = Some j -> marker W c <> None -> a = phi h", "Embedding"),
    Mutant("marker-seen-from-the-front", "Undirected",
        "match marker W a with Some _ => true | None => false end",
        "match marker W a with Some 0 => true | _ => false end", "Undirected"),
    Mutant("twins-after-one-move", "Undirected",
        "move V b k = Some d /\\ R c d.", "move V b k = Some d /\\ R a b.", "Undirected"),
    Mutant("twins-of-one-edge", "Undirected",
        "Theorem loops_look_alike m : 2 <= m ->", "Theorem loops_look_alike m : 1 <= m ->",
        "Undirected"),
    Mutant("one-map-is-both", "Undirected",
        "fun d => if d <? m then d + m else d - m).",
        "fun d => if d <? 2 then 1 - d else 2 * m + 1 - d).", "Undirected"),
    Mutant("forgotten-orientation", "World",
        "phi_sigma : forall d, d < darts M -> phi (sigma M d) = sigma W (phi d)",
        "phi_sigma : forall d, d < darts M -> phi (sigma M (sigma M d)) = sigma W (phi d)",
        "Embedding"),
    Mutant("absolute-doors", "World",
        "then alpha M (turn M k a) else None", "then alpha M (turn M k (root M)) else None",
        "Rotation"),
    Mutant("mirrored-vertex", "Augment",
        "if x <? n then phi x else turn W (x - n) a",
        "if x <? n then phi x else turn W (degree W a + n - x) a", "Augment"),
    Mutant("skipped-hypothesis", "Run",
        "(forall h, h < darts M -> h <> e ->", "(forall h, 0 < h < darts M -> h <> e ->", "Run"),
    Mutant("loop-without-marker", "Run",
        "marker M r = Some j -> marker W c = Some j ->\n    run W",
        "marker M r = Some j -> marker M r = Some j ->\n    run W", "Run"),
    Mutant("unexplored-refutes", "Records",
        "| None => deeper (T (turn M k h)) [] w ps", "| None => false", "Records"),
    Mutant("record-of-another-dart", "Records",
        "exists b, alpha W (phi (turn M k x)) = Some b", "exists b, alpha W (phi x) = Some b",
        "Records"),
    Mutant("records-moved-to-new-darts", "Records",
        "(forall x w, darts M <= x -> T x w = None) ->",
        "(forall x w, darts M < x -> T x w = None) ->", "Records"),
    Mutant("equal-degrees-contradict", "Folding",
        "seen_at q = Some (g', m') -> g <> g' -> contradictory A",
        "seen_at q = Some (g', m') -> g = g' -> contradictory A", "Folding"),
    Mutant("full-turn-contradicts", "Folding", "i < g -> j < g -> i <> j",
        "i <= g -> j <= g -> i <> j", "Folding"),
    Mutant("dart-zero-no-hypothesis", "Mapper",
        "filter (fun h => negb (h =? e)", "filter (fun h => (0 <? h) && negb (h =? e)",
        "MapperCorrect"),
    Mutant("believed-to-be-back", "Mapper",
        "let none := bind (with_trail (undo v (rev ds)) t) (fun vt => Return (None, log, vt)) in",
        "let none := Return (None, log, (v, t)) in", "Validation"),
    Mutant("a-door-for-free", "Program", "Some (x, c, (k, percept W b) :: ms)",
        "Some (x, c, ms)", "Program"),
    Mutant("bound-without-way-back", "MapperCorrect",
        "1 <= cost <= vertices M + (darts M - 1) * (2 * (vertices M - 1))",
        "1 <= cost <= vertices M + (darts M - 1) * (vertices M - 1)", "MapperCorrect"),
    Mutant("shared-doors-not-compared", "Mapper",
        "if percept_eqb (percept M h) pu && percepts_eqb (firstn s ps) (firstn s qs)",
        "if percept_eqb (percept M h) pu && percepts_eqb (firstn s ps) (firstn s ps)",
        "Validation"),
    Mutant("one-door-too-few-undone", "Mapper",
        "undo v (rev (skipn s ds))", "undo v (rev (skipn (S s) ds))", "Validation"),
    Mutant("turned-the-wrong-way", "Mapper",
        "Return (q, (fst q - k) mod fst q)", "Return (q, k mod fst q)", "Validation"),
    Mutant("overlap-counts-other-doors", "Rules",
        "if j =? k then S (common u v) else 0", "if j =? k then S (common u v) else common u v",
        "Rules"),
    Mutant("prefix-beyond-the-common-doors", "Rules",
        "         | None => true end\n    else true", "         | None => true end\n    else false",
        "Rules"),
    Mutant("records-of-the-map-before", "Rules",
        "fold_right add_record T (noted levels M h (fst s) (snd s))",
        "fold_right add_record T (noted levels M e (fst s) (snd s))", "Rules"),
    Mutant("records-one-door-late", "Rules",
        "(at_most levels (behind_doors [] w ps))", "(at_most levels (behind_doors [k] w ps))",
        "Rules"),
    Mutant("memory-that-outlives-its-truth", "Mapper",
        "true_of N W psi t (learn R N e (darts M) T log u) }.",
        "true_of M W phi t (learn R N e (darts M) T log u) }.", "MapperCorrect"),
    Mutant("move-not-on-the-trail", "Program",
        "with_trail (g q) ((k, q) :: t)", "with_trail (g q) t", "Program"),
    Mutant("concluded-without-truth", "Mapper",
        "T log t (h, w) = true -> phi h = a;", "T log t (h, w) = true -> h < darts M;",
        "Validation"),
    Mutant("turn-at-the-marker-forgotten", "Mapper",
        "turn M (snd v + (fst (fst v) - j)) (root M)", "turn M (fst (fst v) - j) (root M)",
        "Validation"),
    Mutant("concluded-far-from-vu", "Mapper",
        "(fun vt => Return (Some (h, h), log, vt)) end.",
        "(fun _ => Return (Some (h, h), log, (v, t))) end.", "Validation"),
    Mutant("ways-rooted-elsewhere", "Ways",
        "Definition way_to M e := let t := tree_from M e in",
        "Definition way_to M e := let t := tree_from M (root M) in", "Ways"),
    Mutant("distances-do-not-grow", "Ways",
        "sprout M (S (fst (snd x))) found o", "sprout M (fst (snd x)) found o", "Ways"),
    Mutant("shortest-forgets-one", "ReferencePolicies",
        "then x :: y :: l else", "then x :: l else", "ReferencePolicies"),
    Mutant("bound-of-a-lower-order", "Algorithms",
        "<= 4 * (m * m * n)", "<= 4 * (m * n)", "Algorithms"),
    Mutant("doors-of-the-log-ignored", "Strategies",
        "if j =? k then answer_after (g q) ms else Lost",
        "if j =? j then Lost else answer_after (g q) ms",
        "Strategies"),
    Mutant("fuel-for-fewer-rounds", "Strategies",
        "match answer_after (f (S (length (moves L))) (start L))",
        "match answer_after (f (length (moves L)) (start L))", "Strategies"),
    Mutant("right-where-it-is-small", "Sound",
        "Definition sound f := forall W L M, world W ->",
        "Definition sound f := forall W L M, world W -> darts W < length (moves L) ->", "Sound"),
    Mutant("two-edges-a-move", "Sound",
        "darts W <= 2 * length (moves L)", "darts W <= length (moves L)", "Sound"),
    Mutant("chords-one-longer", "Tree",
        ":= depth b + 1 + depth (opposite W b)", ":= depth b + 2 + depth (opposite W b)", "Loops"),
    Mutant("nothing-saved", "LeastCost",
        "2 * length (stalks W depth up) -\n  saved W depth up.",
        "2 * length (stalks W depth up) - 0.", "LeastCost"),
    Mutant("pendant-trees-thrice", "LeastCost",
        "+ 2 * length (stalks W depth up) -", "+ 3 * length (stalks W depth up) -", "LeastCost"),
    Mutant("two-chords-between-sights", "Walks",
        "else negb lost && homing W depth up", "else homing W depth up", "Walks"),
    Mutant("chord-left-out", "Growing",
        "way_down W up (depth c) c ++ c :: way_home", "way_down W up (depth c) c ++ way_home",
        "Growing"),
    Mutant("stalk-walked-one-way", "Growing",
        "then opposite W q :: q :: ds else", "then opposite W q :: ds else", "Growing"),
    Mutant("last-way-to-the-marker", "Tour",
        "with Some b => b | None => root W end.", "with Some b => root W | None => root W end.",
        "Tour"),
    Mutant("attained-with-one-more", "Tour",
        "ends f L W /\\ length (moves L) = least_cost W depth up.",
        "ends f L W /\\ length (moves L) = S (least_cost W depth up).", "Tour"),
    Mutant("point-seen-as-a-leaf", "AnyWorld",
        "nothing_there : Percept := (0, None)", "nothing_there : Percept := (1, None)", "AnyWorld"),
    Mutant("one-dart-is-the-point", "AnyMapper", "if darts M =? 0 then Point",
        "if darts M =? 1 then Point", "AnyMapper"),
    Mutant("drawn-beyond-the-last", "RandomPolicies",
        "nth_error (opens M) (c (edges_explored M) mod length (opens M))",
        "nth_error (opens M) (c (edges_explored M) mod S (length (opens M)))", "RandomPolicies"),
    Mutant("dealt-twice", "RandomPolicies", "x :: dealt ks (firstn i l ++ rest)",
        "x :: dealt ks l", "RandomPolicies"),
    Mutant("marker-not-turned", "Log",
        "seen L i = Some (d, Some j) -> same A L (i, j) (0, 0)",
        "seen L i = Some (d, Some j) -> same A L (i, 0) (0, 0)", "Determined"),
    Mutant("only-entries-need-be-crossed", "Log",
        "forall p, valid L p -> exists q r, link nothing L q r /\\ same nothing L p q",
        "forall p, valid L p -> exists q r, link nothing L q r /\\ same nothing L (fst p, 0) q",
        "Determined"),
    Mutant("same-leaf-twice", "Undetermined",
        "replays W1 L /\\ replays W2 L /\\ darts W1 <> darts W2",
        "replays W1 L /\\ replays W2 L /\\ darts W1 = darts W2 + 1", "Undetermined"),
    Mutant("taken-for-one-without-turning", "LogFold",
        "map (fun l : place => if fst l =? y then (x, c + snd l)",
        "map (fun l : place => if fst l =? y then (x, 0 * c + snd l)", "LogFold"),
    Mutant("unlike-places-taken-for-one", "LogFold",
        "if (x =? y) || negb (same_signature (nth x s (0, None)) (nth y s (0, None))) then None",
        "if x =? y then None", "LogFold"),
    Mutant("arcs-not-taken-again", "LogFold",
        "(filter again done ++ todo)", "todo", "LogFoldExact"),
    Mutant("own-end-overlooked", "LogFold",
        "if place_eqb k m then None else", "if place_eqb k m then absorb n f done todo else",
        "LogFoldExact"),
    Mutant("moves-crossed-one-way", "LogFold",
        "((i, k), (S i, 0)) :: ((S i, 0), (i, k)) :: ", "((i, k), (S i, 0)) :: ",
        "LogFoldExact"),
    Mutant("marker-mirrored", "LogFold",
        "(0, (d - j) mod d) :: ", "(0, j mod d) :: ", "LogFoldExact"),
    Mutant("assumed-one-way", "LogFold",
        "absorbed (percepts_of L) f R [(p, q); (q, p)] with",
        "absorbed (percepts_of L) f R [(p, q)] with", "LogFoldExact"),
    Mutant("steps-too-few", "LogFold", "absorb (S t * S t) f done todo", "absorb t f done todo",
        "LogFoldExact"),
    Mutant("rejected-if-not-forced", "FoldingRule",
        "keep := fun M e _ T _ t => by_fold allows M T e t;",
        "keep := fun M e _ T _ t => by_fold partners M T e t;", "FoldingRule"),
    Mutant("concluded-if-allowed", "FoldingRule",
        "concludes := fun M e _ T _ t => by_fold partners M T e t;",
        "concludes := fun M e _ T _ t => by_fold allows M T e t;", "FoldingRule"),
    Mutant("seen-one-visit-late", "FoldingRule",
        "(turn M k h, (length u, k))", "(turn M k h, (S (length u), k))", "FoldingRule"),
    Mutant("entailed-by-the-start", "FoldingRun",
        "replays W' {| start := percept W (root W); moves := ms |} ->",
        "replays W' {| start := percept W (root W); moves := [] |} ->", "FoldingRun"),
    Mutant("concluded-though-others-remain", "FoldingRun",
        "keep rule_folding M e pu T log u (g, w') = true -> g = h.\nProof.\n  intros Tu Lu Le Lh.",
        "keep rule_folding M e pu T log u (g, w') = true -> g <> h.\nProof.\n  intros Tu Lu Le Lh.",
        "FoldingRun"),
    Mutant("rotation-not-in-the-fold", "FoldingRun",
        "same nothing L (place_seen T (sigma M x)) (i, S k)",
        "same nothing L (place_seen T (sigma M x)) (i, k)", "FoldingRun"),
    Mutant("half-a-contradiction", "Log",
        "seen L j = Some (e, n) -> d = e;", "seen L j = Some (e, n) -> d <= e + 1;", "Classes"),
    Mutant("evidence-believed", "Checker",
        "(rep fuel U p') then Some (q, q') else None",
        "(rep fuel U p') then Some (q, q') else Some (q, q')",
        "CheckerCorrect"),
    Mutant("no-evidence-asked-for", "Checker",
        "check_map t L && (total t && proves L ev)",
        "check_map t L && (total t && (proves L ev || true))", "CheckerCorrect"),
    Mutant("closed-map-refuted", "Table",
        "check_map t L && negb (total t)", "check_map t L && total t", "TableCorrect"),
    Mutant("log-not-replayed", "Table",
        "(percept_eqb (percept (map_of t) 0) (start L) && check_moves (map_of t) 0 (moves L))",
        "percept_eqb (percept (map_of t) 0) (start L)", "TableCorrect"),
    Mutant("last-door-illegal", "Checker", "(k <? d) && legal_percept p",
        "(S k <? d) && legal_percept p", "CheckerCorrect"),
    Mutant("backward-arcs-not-noted", "Checker",
        "cover U (cover U C (true, fst m)) (false, fst m)", "cover U C (true, fst m)", "Accepted"),
    Mutant("higher-under-lower", "Saturated",
        "if rho y <=? rho x then s :: saturation", "if rho x <=? rho y then s :: saturation",
        "Saturated"),
    Mutant("backward-arcs-not-merged", "Saturated",
        "(fun x : positive => [(true, x); (false, x)])", "(fun x : positive => [(true, x)])",
        "Saturated"),
    Mutant("markers-not-compared", "Saturated",
        "  map Marked (all_visits L) ++ map Alone", "  map Alone", "Conflicts"),
    Mutant("visits-beyond-the-fuel", "Conflicts",
        "length (sights L) < 2 ^ fuel.", "length (sights L) < S (length (sights L)).", "Conflicts"),
    Mutant("edge-to-itself-kept", "Accepted",
        "  | None => true | Some _ => false end.",
        "  | None | Some (Alone _) => true | Some _ => false end.", "Accepted"),
    Mutant("decided-without-looking", "Events",
        "forall W, world W -> replays W (log_after p past) ->",
        "forall W, world W -> replays W (log_after p []) ->", "DecisionsCorrect"),
    Mutant("loop-not-drawn", "Events", "Loop e h _ => augment_loop M e h", "Loop e h _ => M",
        "DecisionsCorrect"),
    Mutant("new-vertex-half-stated", "Events", "h < darts M -> phi h <> b end", "phi h <> b end",
        "DecisionsCorrect"),
    Mutant("reason-of-the-other-kind", "Decisions",
        "ev (unified m)) c\n  | _, _ => false", "ev (unified m)) c\n  | _, _ => true",
        "DecisionsCorrect"),
    Mutant("loop-end-stays-open", "Decisions",
        "opened := but h (but e (opened s))", "opened := but e (opened s)", "DecisionsCorrect"),
    Mutant("new-though-not-refuted", "Decisions",
        "(a =? size s) && all_refuted m p (but e (opened s)) rs",
        "(a =? size s) && (all_refuted m p (but e (opened s)) rs || true)",
        "DecisionsCorrect"),
    Mutant("numbered-one-late", "Decisions", "fst p, snd p + i)", "fst p, snd p + S i)",
        "DecisionsCorrect"),
    Mutant("degree-not-compared", "Decisions",
        "has_degree (sighted m) d q && negb (h =? e)",
        "(has_degree (sighted m) d q || true) && negb (h =? e)", "DecisionsCorrect"),
    Mutant("after-an-unproved-vertex", "Decisions",
        "(negb (draws e) || match rss with [] => true | _ => false end) &&", "",
        "DecisionsCorrect"),
    Mutant("any-degree-behind", "Judged",
        "alpha W (dart W v p) = Some b /\\ degree W b = d) ->",
        "alpha W (dart W v p) = Some b /\\ degree W b <= d) ->", "Judged"),
    Mutant("drawn-without-following", "DecisionsAccepted",
        "    (forall b x c, before = b ++ x :: c -> draws x = true -> event_follows p b x) ->\n",
        "", "DecisionsAccepted"),
    Mutant("pairs-not-counted", "Delivered",
        "(2 * length (pairs D) =? length (labels D)) && ", "", "Delivered"),
    Mutant("last-dart-not-compared", "Delivered",
        "(check_dart M t psi) (seq 0 (darts M)).", "(check_dart M t psi) (seq 0 (darts M - 1)).",
        "Delivered"),
    Mutant("delivered-map-believed", "Certificate",
        "Some psi, Some D => delivered D t psi", "Some psi, Some D => true", "Certificate"),
    Mutant("point-impossible", "Certificate",
        "impossible (log_in c) ev x && negb (of_point (log_in c)) end",
        "impossible (log_in c) ev x end", "Certificate"),
    Mutant("pairs-of-the-point-ignored", "Certificate",
        "with [[]], [] => true | _, _", "with [[]], _ => true | _, _", "Certificate"),
    Mutant("decisions-believed", "Certificate",
        "decided (sensed c) (events c) (merges c) (reasons c).", "true.", "Certificate"),
    Mutant("dead-end-listed", "Listed",
        "list (list growth) := match n, u with\n  | 0, 0 => if r =? 0 then [[]] else []",
        "list (list growth) := match n, u with\n  | 0, 0 => [[]]", "Listed"),
    Mutant("joined-with-itself", "Listed", "| Meet j => augment_loop M e (nth j rest e)",
        "| Meet j => augment_loop M e (nth j (e :: rest) e)", "Listed"),
    Mutant("a-partner-more-counted", "Listed",
        "| S n, S u => u * completions n (u - 1) r +",
        "| S n, S u => S u * completions n (u - 1) r +", "Listed"),
    Mutant("largest-vertex-not-listed", "Listed",
        "++ map Hang (seq 1 r).", "++ map Hang (seq 1 (r - 1)).", "Listed"),
    Mutant("first-vertex-of-any-degree", "Listed",
        "growths m d (2 * m - d))) (seq 1 (2 * m)).", "growths m d (2 * m - d))) (seq 0 (2 * m)).",
        "Listed"),
    Mutant("least-partner-twice", "Listed",
        "map Meet (seq 0 u) ++ map Hang (seq 1 r).",
        "map Meet (map (fun j => j - 1) (seq 0 u)) ++ map Hang (seq 1 r).", "Listed"),
    Mutant("explored-from-the-next-dart", "ListedOnce",
        "| S n, e :: rest => match alpha W (phi e) with",
        "| S n, e :: rest => match alpha W (phi (S e)) with", "ListedOnce"),
    Mutant("one-world-at-two-places", "ListedOnce",
        "isomorphic V W -> i = j.", "isomorphic V W -> i < j.", "ListedOnce"),
    Mutant("formula-one-partner-short", "Ranks",
        "N.of_nat (2 * t + 1 - r) * nth r l 0", "N.of_nat (2 * t - r) * nth r l 0", "Ranks"),
    Mutant("rank-not-reduced", "Ranks",
        "let (i, k') := block l (k - x)%N in", "let (i, k') := block l k in", "Ranks"),
    Mutant("rank-of-the-steps-only", "Ranks",
        "N.add (sum_of (map (rooted m) (seq 1 (fst p - 1))))", "N.add 0", "Ranks"),
    Mutant("percepts-not-compared", "Judge",
        "percept_eqb (percept W (root W)) (start L) && check_moves W (root W) (moves L)",
        "percept_eqb (percept W (root W)) (start L)", "JudgeEnds"),
    Mutant("judged-after-a-false-vertex", "Judge",
        "images := images s; faithful := false;", "images := images s; faithful := true;",
        "JudgeRun"),
    Mutant("degree-of-a-loop-believed", "Judge",
        "ends_in l e h && (degree W (at_image l h) =? n)", "ends_in l e h", "JudgeRun"),
    Mutant("posed-before-it-is-crossed", "Judge",
        "mem (key_of s e) (walked_edges s) &&", "", "JudgeDecisions"),
    Mutant("one-pose-for-all", "Claims",
        "Pose _ _ => False | Act ev => ~ grows ev end.", "Pose _ _ => False | Act ev => True end.",
        "JudgeMemory"),
    Mutant("answered-for-every-edge", "Judge",
        "negb (place_eqb (key_of s e, h) q)", "negb (h =? snd q)", "JudgeMemory"),
    Mutant("explored-and-still-asked", "Judge",
        "(fst q =? x) && is_open (chart s) (snd q)", "fst q =? x", "JudgeDecisions"),
    Mutant("confirmed-if-not-refuted", "Claims",
        "(Act (Confirm e h)) -> is_so W past (Confirm e h).",
        "(Act (Confirm e h)) -> ~ is_so W past (Reject e h).", "JudgeDecisions"),
    Mutant("delivered-while-open", "Judge",
        "existsb grows_b (steps t) && existsb (is_open (chart z)) (seq 0 (darts (chart z)))",
        "false", "JudgeDecisions"),
    Mutant("pairs-too-many", "Judge",
        "(2 * length (pairs D) =? length (labels D)) && ", "", "JudgeEnds"),
    Mutant("reported-too-little", "Claims",
        "c = trace_cost t.", "c <= trace_cost t.", "JudgeCorrect"),
    Mutant("lower-bound-without-a-map", "Claims",
        "(finish t <> None -> m <= trace_cost t)", "m <= trace_cost t", "JudgeCorrect"),
    Mutant("lucky-map", "Judge",
        "Point => true | Edges _ => closed_b (trace_log t) end", "Point | Edges _ => true end",
        "JudgeCorrect"),
)  # fmt: skip

QUICK = {
    "undirected-comparison", "absolute-doors", "skipped-hypothesis", "unexplored-refutes",
    "equal-degrees-contradict", "marker-not-turned", "a-door-for-free", "evidence-believed",
    "decided-without-looking", "numbered-one-late", "shared-doors-not-compared",
    "records-one-door-late", "ways-rooted-elsewhere", "fuel-for-fewer-rounds",
    "arcs-not-taken-again", "concluded-if-allowed", "dead-end-listed", "lucky-map",
}  # fmt: skip
"""Those of the everyday suite: one for each way to be wrong."""


def patched(mutant: Mutant) -> str:
    """The mutant's source."""
    text = (toolchain.SOURCES / f"{mutant.file}.v").read_text()
    assert text.count(mutant.old) == 1, f"{mutant.name}: {mutant.old!r} is not there once"
    return text.replace(mutant.old, mutant.new)


def refusal(mutant: Mutant, place: Path) -> tuple[str, str]:
    """The first file that is refused, and why; ("", "") if none is."""
    needing = [name for name in toolchain.files() if mutant.file in toolchain.required(name)]
    (place / f"{mutant.file}.v").unlink()
    (place / f"{mutant.file}.v").write_text(patched(mutant))
    for name in needing:
        (place / f"{name}.vo").unlink()
    for name in needing:
        ran = toolchain.compile_one(place, name, timeout=LIMIT)
        if not ran.accepted:
            return name, ran.output
    return "", ""


@pytest.mark.parametrize(
    "mutant",
    [
        pytest.param(one, id=one.name, marks=() if one.name in QUICK else pytest.mark.slow)
        for one in MUTANTS
    ],
)
def test_a_mutant_is_refused(mutant: Mutant, place: Path) -> None:
    name, output = refusal(mutant, place)
    assert name == mutant.refused
    assert "Error" in output
    assert not any(word in output for word in CARELESS), output


def test_a_patch_that_changes_nothing_is_accepted(place: Path) -> None:
    same = Mutant(
        "swapped", "TableCorrect", "unfold refute. intros H.", "intros H. unfold refute in H.", ""
    )
    assert refusal(same, place) == ("", "")


def test_mutants_are_many_and_each_is_one_patch() -> None:
    assert len({mutant.name for mutant in MUTANTS}) == len(MUTANTS) >= 12
    assert all(patched(mutant) for mutant in MUTANTS)
    assert {mutant.name for mutant in MUTANTS} > QUICK
