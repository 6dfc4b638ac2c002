"""Theorems proved in Coq for worlds of any size, without axioms; `prove` checks them again.

One check of the library serves all: no source holds a word that assumes without proof; coqc
compiles them in a temporary folder; Coq and coqchk find no axiom. Else the verdict is UNKNOWN,
never REFUTED: a failed proof is no counterexample.

What this does not show: that the statements mean what they should (docs/proofs.md names the lines
to read), nor anything about the Python code.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter

from topo_verify.proofs.mechanised import toolchain
from topo_verify.proofs.theorem import Budget, Theorem, TheoremResult

LONGER = 10
"""A coqc call takes longer than a query: factor of the time limit."""


@dataclass(frozen=True, slots=True)
class MechanisedStatement:
    name: str
    file: str
    theorem: str
    claims: tuple[str, ...]
    words: str


def _one(name: str, where: str, claims: str, words: str) -> MechanisedStatement:
    file, theorem = where.split(".")
    return MechanisedStatement(name, file, theorem, tuple(claims.split()), words)


STATEMENTS: tuple[MechanisedStatement, ...] = (
    _one("coq-foretold", "Embedding.forward", "true-hypothesis-kept",
        "The world shows what the map predicts for the true hypothesis."),
    _one("coq-motion-kept", "Embedding.mismatch_refutes", "true-hypothesis-kept",
        "A percept that differs from the map's prediction refutes the hypothesis."),
    _one("coq-posed", "Embedding.posed", "true-hypothesis-posed",
        "The true end of an open dart, if it is known, is another open dart that looks alike."),
    _one("coq-confirmed", "Embedding.confirm", "no-false-confirm",
        "A full match that ends with the marker's direction confirms only the true hypothesis."),
    _one("coq-undirected", "Examples.undirected_fails", "no-false-confirm",
        "Without the marker's direction a false hypothesis can match."),
    _one("coq-twins", "Undirected.twins_undetermined", "map-isomorphic",
        "With an undirected marker, a mapper delivers the same maps in two worlds that are twins."),
    _one("coq-twins-exist", "Undirected.loops_look_alike", "map-isomorphic",
        "Of every number of edges from 2 on there are twins that are no one map."),
    _one("coq-undirected-mapper", "Undirected.undirected_not_enough", "map-isomorphic",
        "With an undirected marker no mapper is right in all worlds."),
    _one("coq-records-kept", "Records.agrees_true", "true-hypothesis-kept",
        "Rules prefix, history and records never reject the true hypothesis."),
    _one("coq-records-true", "Records.record_true", "true-hypothesis-kept rejection-justified",
        "What is recorded behind an open dart is true in the world, and stays true."),
    _one("coq-folding-kept", "Folding.folding_true", "true-hypothesis-kept",
        "Rule folding never contradicts the true hypothesis."),
    _one("coq-folding-confirms", "Folding.folding_confirms", "no-false-confirm",
        "What rule folding confirms is true."),
    _one("coq-folding-complete", "Entailed.consistent_possible",
        "decisions-entailed map-entailed",
        "A hypothesis that folding a log keeps has a world that shows the log."),
    _one("coq-map-true", "Run.run_true", "map-isomorphic",
        "All that a justified run builds is embedded in the world."),
    _one("coq-map-unique", "Embedding.embedded_unique", "map-isomorphic",
        "A connected map is embedded in a world in at most one way."),
    _one("coq-run-ends-right", "Run.run_isomorphic", "map-isomorphic",
        "A justified run that ends with nothing unexplored ends with the world."),
    _one("coq-run-exists", "RunExists.run_exists", "map-isomorphic rejection-justified",
        "Every world has a justified run to its end: what is false can be refuted."),
    _one("coq-explored", "MapperCorrect.explore_correct", "map-isomorphic cost-within-bound",
        "The mapper ends with the world, within the bound, if each part keeps its contract."),
    _one("coq-cost", "Algorithms.cost_within_bound", "cost-within-bound cost-honest",
        "With any sound rule the mapper makes m to m (n + (2m - 1) 2(n - 1)) moves."),
    _one("coq-bound-order", "Algorithms.bound_order", "cost-within-bound",
        "This bound is at most 4 m m n."),
    _one("coq-bound-reached", "BoundReached.bound_reached", "cost-within-bound",
        "In rows of n vertices basic makes at least m m n / 12 moves, with m = 2 n."),
    _one("coq-row-cost", "BoundReached.basic_row", "cost-within-bound",
        "In a row basic makes at least 2 n (n - 1) (n - 2) / 3 moves, whatever its ways."),
    _one("coq-rejected-far", "RejectionCost.rejected_far", "cost-within-bound",
        "Where places look alike, a false hypothesis costs a walk as far as the marker is."),
    _one("coq-ways", "Ways.way_to_good", "map-isomorphic cost-within-bound",
        "The ways of the breadth-first tree rooted at their end lead there, in less than n moves."),
    _one("coq-policies", "Algorithms.reference_policies_good", "map-isomorphic",
        "The policies of the reference costs are policies as the theorems about the mapper ask."),
    _one("coq-basic", "Algorithms.basic_correct", "map-isomorphic cost-within-bound",
        "Listing 1, the basic algorithm, ends with the world, within the bound."),
    _one("coq-enhancement-i", "Algorithms.enhancement_i_correct",
        "map-isomorphic cost-within-bound",
        "Listing 2, Enhancement I, ends with the world, within the bound."),
    _one("coq-enhancement-ii", "Algorithms.enhancement_ii_correct",
        "map-isomorphic cost-within-bound",
        "Enhancement II, with either motion, ends with the world, within the bound."),
    _one("coq-enhancement-iii-one", "Algorithms.enhancement_iii_one_correct",
        "map-isomorphic cost-within-bound",
        "Enhancement III, one-level, with either motion, ends with the world, within the bound."),
    _one("coq-enhancement-iii-all", "Algorithms.enhancement_iii_all_correct",
        "map-isomorphic cost-within-bound",
        "Listing 3, Enhancement III, all-level, with either motion, does so, too."),
    _one("coq-random", "RandomPolicies.random_mapped", "map-isomorphic cost-within-bound",
        "With random policies, whatever they choose, they do so, too."),
    _one("coq-prefix-kept", "Rules.rule_prefix_good", "true-hypothesis-kept",
        "Rule prefix, as the mapper runs it, rejects only false hypotheses."),
    _one("coq-prefix-weaker", "Rules.prefix_weaker", "true-hypothesis-kept",
        "Rule prefix rejects no more than rules history and records."),
    _one("coq-history-kept", "Rules.rule_history_good", "true-hypothesis-kept",
        "Rule history, as the mapper runs it, rejects only false hypotheses."),
    _one("coq-records-learned", "Rules.rule_records_good",
        "true-hypothesis-kept rejection-justified",
        "Rule records, as the mapper runs it, records the truth and rejects no true hypothesis."),
    _one("coq-overlap", "Rules.overlap_good", "no-false-confirm cost-honest",
        "Motion overlap takes a hypothesis that remains; the doors it does not walk are shared."),
    _one("coq-strategy-sound", "Strategies.strategy_sound", "map-isomorphic",
        "The mapper is one of all mappers, and right in every world."),
    _one("coq-strategy-ends", "Strategies.strategy_ends", "map-isomorphic cost-within-bound",
        "As one of all mappers it ends in every world, within the bound."),
    _one("coq-between", "Strategies.between_bounds", "map-entailed cost-within-bound",
        "Its log proves its map, and its cost lies between LB and the bound."),
    _one("coq-closed", "Entailed.closed_iff_determined", "map-entailed",
        "A log has no open dart exactly if all worlds that show it are isomorphic."),
    _one("coq-open", "Entailed.closed_or_undetermined", "map-entailed",
        "A log that some world shows proves its map, or two worlds that differ show it."),
    _one("coq-sound-closed", "Sound.sound_closed", "map-entailed",
        "Any mapper that is right in every world leaves no dart open in any."),
    _one("coq-closed-sound", "Sound.closed_sound", "map-entailed",
        "A mapper that leaves no dart open and delivers a world that shows its log is right."),
    _one("coq-sound-cost", "Sound.sound_cost", "cost-within-bound",
        "Any mapper that is right in every world makes at least m moves."),
    _one("coq-breadth-first", "Distance.breadth_first_exists", "cost-within-bound",
        "Every world has a breadth-first tree, by which the least cost is defined."),
    _one("coq-least-cost", "LeastCost.sound_least_cost", "cost-within-bound",
        "Any mapper that is right in every world makes at least as many moves as LB."),
    _one("coq-walk-closed", "Walks.walk_closed", "map-entailed",
        "A walk over every edge that sees the marker between two chords proves its map."),
    _one("coq-tour", "Tour.tour_exact", "cost-within-bound map-entailed",
        "In every world a walk of LB moves proves the map."),
    _one("coq-least-cost-exact", "Tour.least_cost_exact", "cost-within-bound",
        "LB is the least length of a log that proves the map, whatever the tree."),
    _one("coq-least-cost-attained", "Attained.least_cost_attained",
        "map-isomorphic cost-within-bound",
        "For every world some mapper makes LB moves in it and ends in every world with the map."),
    _one("coq-any-closed", "Edgeless.closed_any_iff", "map-entailed",
        "Of all worlds, with edges or not: a log has no open dart exactly if one world shows it."),
    _one("coq-any-sound", "Edgeless.sound_any_closed", "map-entailed",
        "Any mapper right in every world, with edges or not, leaves no dart open in any."),
    _one("coq-any-least-cost", "Edgeless.sound_any_cost", "cost-within-bound",
        "A mapper for all worlds makes at least LB moves in every world with edges."),
    _one("coq-any-mapped", "AnyMapper.all_eight_mapped", "map-isomorphic cost-within-bound",
        "The paper's algorithms map every world, with edges or not, within the bound."),
    _one("coq-any-strategy", "AnyMapper.strategy_in_sound", "map-isomorphic",
        "As mappers they are right in every world, with edges or not."),
    _one("coq-told", "Declared.trace_in_same", "map-isomorphic cost-honest",
        "The mapper that also declares makes the moves, and delivers the map, of the proved one."),
    _one("coq-certified", "CheckerCorrect.certified_correct", "map-entailed",
        "A map and evidence that the checker accepts: the log proves the map."),
    _one("coq-refuted", "TableCorrect.refute_correct", "map-entailed",
        "A map with an open dart that the checker accepts: two worlds that differ show the log."),
    _one("coq-impossible", "CheckerCorrect.impossible_correct", "map-entailed percepts-true",
        "A contradiction that the checker accepts: no world shows the log."),
    _one("coq-reject-entailed", "Entailed.rejection_entailed_iff", "decisions-entailed",
        "A rejection follows from a log exactly if folding with its edge contradicts."),
    _one("coq-confirm-entailed", "Entailed.confirmation_entailed_iff", "decisions-entailed",
        "A confirmation follows from a log exactly if folding makes the two partners."),
    _one("coq-reject-certified", "CheckerCorrect.rejected_correct", "decisions-entailed",
        "A contradiction that the checker accepts: the rejection follows from the log."),
    _one("coq-confirm-certified", "CheckerCorrect.confirmed_correct", "decisions-entailed",
        "Partners that the checker accepts: the confirmation follows from the log."),
    _one("coq-closed-accepted", "Accepted.proves_accepts", "map-entailed",
        "Evidence computed from a log with no open dart, which some world shows, is accepted."),
    _one("coq-proved-accepted", "Accepted.certified_accepts", "map-entailed",
        "With some table, so that the certificate that the log proves its map is accepted."),
    _one("coq-refuted-accepted", "Accepted.refute_accepts", "map-entailed",
        "Of a log that two worlds show that differ, a table with an open dart is accepted."),
    _one("coq-impossible-accepted", "Accepted.impossible_accepts", "map-entailed percepts-true",
        "A contradiction computed from a log that no world shows is accepted."),
    _one("coq-reject-accepted", "Accepted.rejected_accepts", "decisions-entailed",
        "A contradiction computed for a rejection that follows from a log is accepted."),
    _one("coq-confirm-accepted", "Accepted.confirmed_accepts", "decisions-entailed",
        "Partners computed for a confirmation that follows from a log are accepted."),
    _one("coq-folding-exact", "Accepted.folding_exact", "decisions-entailed",
        "Folding a log, as a program, rejects exactly the edges that no world with that log has."),
    _one("coq-fold-allows", "LogFoldExact.allows_exact", "decisions-entailed",
        "So does the fold that rule folding uses, for logs of any length."),
    _one("coq-fold-partners", "LogFoldExact.partners_exact", "decisions-entailed",
        "It joins exactly the places that every world with that log joins."),
    _one("coq-folding-rule", "FoldingRule.folding_rule_exact", "decisions-entailed",
        "Rule folding, as the mapper runs it, rejects exactly what no world with its log allows."),
    _one("coq-folding-good", "FoldingRule.rule_folding_good",
        "true-hypothesis-kept no-false-confirm",
        "As the mapper runs it, it rejects only false hypotheses and concludes only true ones."),
    _one("coq-folding-maps", "FoldingRule.folding_correct", "map-isomorphic cost-within-bound",
        "The algorithm folding ends with the world, within the bound."),
    _one("coq-folding-any", "FoldingRun.folding_mapped", "map-isomorphic cost-within-bound",
        "It maps every world, with edges or not, within the bound."),
    _one("coq-folding-between", "FoldingRun.folding_between",
        "map-isomorphic map-entailed cost-within-bound",
        "As one of all mappers it is right in every world, at a cost between LB and the bound."),
    _one("coq-built-entailed", "FoldingRun.rounds_entailed", "map-isomorphic decisions-entailed",
        "What a mapper has built after some edges is right in every world with the same log."),
    _one("coq-map-in-fold", "FoldingRun.map_in_fold", "decisions-entailed",
        "The map S of folding is a part of the fold of its log; the rest are ghosts."),
    _one("coq-concluded-last", "FoldingRun.concluded_iff", "no-false-confirm decisions-entailed",
        "Rule folding concludes just the last hypothesis, once vu is known to be in S."),
    _one("coq-decisions-certified", "DecisionsCorrect.decided_correct", "decisions-entailed",
        "Declared decisions that the checker accepts follow, each from the events before it."),
    _one("coq-decisions-accepted", "DecisionsAccepted.decided_accepts", "decisions-entailed",
        "Of a log that some world shows, every decision that follows is accepted with reasons."),
    _one("coq-delivered", "Delivered.check_delivery_right", "map-isomorphic map-entailed",
        "A delivered map that the checker accepts is every world that shows the log."),
    _one("coq-delivery-accepted", "Delivered.check_delivery_accepts",
        "map-isomorphic map-entailed",
        "A delivered map that is right is accepted with some numbering of its darts."),
    _one("coq-certificate", "Certificate.check_numbers_correct", "map-entailed decisions-entailed",
        "What a certificate says is true if the checker accepts its numbers."),
    _one("coq-written", "Writing.written_accepted", "map-entailed decisions-entailed",
        "A certificate that is accepted, within the limits, can be written as numbers."),
    _one("coq-proved-stated", "Stated.proved_stated", "map-entailed decisions-entailed",
        "If a log proves its map, some accepted numbers say so, with all decisions that follow."),
    _one("coq-undecided-stated", "Stated.undecided_stated", "map-entailed decisions-entailed",
        "If two worlds that differ show a log, some accepted numbers say so."),
    _one("coq-absurd-stated", "Stated.absurd_stated", "map-entailed percepts-true",
        "If no world shows a log, some accepted numbers say so."),
    _one("coq-point-stated", "Stated.point_stated", "map-entailed",
        "If a log is that of the world without an edge, some accepted numbers say so."),
    _one("coq-listed-worlds", "Listed.listed_world", "",
        "The list of worlds with m edges holds worlds with m edges only."),
    _one("coq-listed-number", "Listed.listed_length", "",
        "It is as long as the closed formula says."),
    _one("coq-listed-every", "ListedOnce.listed_every", "",
        "It holds every world with m edges, up to the numbering of its darts."),
    _one("coq-listed-once", "ListedOnce.listed_once", "",
        "No two worlds in it are isomorphic."),
    _one("coq-unrank", "Ranks.unrank_listed", "",
        "The world computed from a rank stands at that place of the list."),
    _one("coq-rank-unrank", "Ranks.rank_unrank", "",
        "The rank computed from the world of rank k is k."),
    _one("coq-unrank-rank", "Ranks.unrank_rank", "",
        "The world computed from the rank of a world is that world."),
    _one("coq-judge-percepts", "JudgeCorrect.judge_claim1", "percepts-true",
        "The judge says failed exactly if a percept or a door is not the world's."),
    _one("coq-judge-posed", "JudgeDecisions.judge_claim2", "true-hypothesis-posed",
        "The judge says failed exactly if a pose is wrong, or S grows without one."),
    _one("coq-judge-kept", "JudgeDecisions.judge_claim3", "true-hypothesis-kept",
        "The judge says failed exactly if a true hypothesis is rejected, or one is dropped."),
    _one("coq-judge-confirmed", "JudgeDecisions.judge_claim4", "no-false-confirm",
        "The judge says failed exactly if a confirmed hypothesis is not the true one."),
    _one("coq-judge-map", "JudgeDecisions.judge_claim5", "map-isomorphic",
        "The judge says failed exactly if S or the delivered map is not the world's."),
    _one("coq-judge-cost", "JudgeCorrect.judge_claim6", "cost-honest",
        "The judge says failed exactly if the reported cost is not the number of moves."),
    _one("coq-judge-bound", "JudgeCorrect.judge_claim7", "cost-within-bound",
        "The judge says failed exactly if the cost is outside its bounds."),
    _one("coq-judge-entailed", "JudgeCorrect.judge_claim9", "map-entailed",
        "The judge says failed exactly if the delivered map is not every world with this log."),
    _one("coq-judge-decisions", "JudgeEntailed.judge_claim10", "decisions-entailed",
        "The judge says failed exactly if a decision does not follow from what came before it."),
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class LibraryCheck:
    """The result of checking the library: why nothing is proved, or coqchk's summary."""

    why: str = ""
    summary: str = ""
    seconds: float = 0.0


@cache
def library(timeout: float) -> LibraryCheck:
    """Check the library once; `timeout`: seconds for each call."""
    if why := toolchain.missing():
        return LibraryCheck(why=why)
    begin = perf_counter()
    with TemporaryDirectory() as name:
        try:
            check = examine(Path(name), timeout=timeout)
        except toolchain.Unfinished as error:
            check = LibraryCheck(why=str(error))
    seconds = perf_counter() - begin
    return LibraryCheck(check.why, check.summary, seconds)


def examine(folder: Path, *, timeout: float) -> LibraryCheck:
    """Check the library in an empty folder.

    Raises:
        toolchain.Unfinished: a call timed out, was killed, or lacks memory.
    """
    names = toolchain.files()
    toolchain.copy_library(folder, names)
    for name in names:
        if words := toolchain.claims_unproved((folder / f"{name}.v").read_text(encoding="utf-8")):
            return LibraryCheck(why=f"{name}.v claims without proof: {', '.join(words)}")
    ran = toolchain.compile_all(folder, names, timeout=timeout)
    if not ran.accepted:
        return LibraryCheck(why=f"coqc refuses {ran.output[-300:]}")
    if (output := asked(folder, timeout=timeout)) != toolchain.NO_AXIOMS:
        return LibraryCheck(why=f"the theorems rest on more than their proofs: {output[-300:]}")
    ran = toolchain.recheck(folder, names, timeout=timeout)
    if not ran.accepted:
        return LibraryCheck(why=f"coqchk does not say that there is no axiom: {ran.output[-300:]}")
    return LibraryCheck(summary=summary(ran.output))


def asked(folder: Path, *, timeout: float) -> str:
    """Coq's answer about the axioms of all theorems together."""
    imports = " ".join(dict.fromkeys(one.file for one in STATEMENTS))
    theorems = ", ".join(f"@{one.file}.{one.theorem}" for one in STATEMENTS)
    text = f"From Topo Require {imports}.\nDefinition every := ({theorems}).\n"
    (folder / "asked.v").write_text(f"{text}Print Assumptions every.\n", encoding="utf-8")
    return toolchain.compile_one(folder, "asked", timeout=timeout).output


def summary(output: str) -> str:
    """coqchk's theory, axioms, and what is not <none>, in one line."""
    lines = output.partition("CONTEXT SUMMARY")[2].splitlines()
    points = [line.removeprefix("* ").strip() for line in lines if line.startswith("* ")]
    worth_saying = (p for p in points if p.startswith("Axioms") or not p.endswith("<none>"))
    return "; ".join(worth_saying)


def theorem(statement: MechanisedStatement) -> Theorem:
    return Theorem(
        name=statement.name,
        kind="mechanised",
        claims=statement.claims,
        words=statement.words,
        symbols=f"Topo.{statement.file}.{statement.theorem}, in proofs/coq/{statement.file}.v",
        solver_part="all of it, for worlds of any size; coqchk checks the compiled proof again",
        assumed=(),
        expected="PROVED",
        prove=_prover(statement),
        queries=lambda: iter(()),
        deep=True,
    )


def _prover(statement: MechanisedStatement) -> Callable[[Budget], TheoremResult]:
    def prove(budget: Budget) -> TheoremResult:
        budget.progress(f"{statement.name}: coqc and coqchk on the whole library", 0, 1)
        check = library(budget.timeout * LONGER)
        return TheoremResult(
            verdict="UNKNOWN" if check.why else "PROVED",
            solver="coqc" if toolchain.missing() else toolchain.version(),
            seconds=check.seconds,
            # Not vacuous: worlds and runs exist (torus_world, run_exists).
            premises_satisfiable=None if check.why else True,
            note=check.why or f"coqchk: {check.summary}",
        )

    return prove


MECHANISED: tuple[Theorem, ...] = tuple(map(theorem, STATEMENTS))
