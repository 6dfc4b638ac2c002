"""`topo-verify arena --game M`: the best robot in all worlds with up to M edges."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from topo_verify.cli import options
from topo_verify.cli.output import Output, Result, Rows
from topo_verify.errors import InputError
from topo_verify.report.blocks import Block, Text, TextTable
from topo_verify.studies.game import values as game

GameEntry = game.GameValue | game.MapperCosts


ALLOWED = {"--game", "texts", "--target", "--format", "--quiet"}
"""The parameters of `arena` that `--game` uses."""


def game_of_catalogue(output: Output, edges: int, names: Sequence[str]) -> int:
    """Do `arena --game M [TARGET]...`; without names, or with `all`, for the whole catalogue."""
    if others := [name for name in options.given() if name not in ALLOWED]:
        raise InputError(f"{others[0]} means nothing to --game: leave out one of them")
    asked = [name for text in names for name in text.split(",") if name != "all"]
    for name in asked:
        if name not in game.PLAYERS:
            known = ", ".join(game.PLAYERS)
            raise InputError(f"target {name!r}: --game plays mappers of the catalogue: {known}")
    if not 1 <= edges <= game.MOST_EDGES:
        raise InputError(
            f"--game {edges}: expected 1 to {game.MOST_EDGES} edges; larger searches have no end"
        )
    mappers = asked or game.PLAYERS
    return output.run("arena", lambda: _results(output, edges, mappers), _show, game=edges)


def _results(output: Output, edges: int, mappers: Sequence[str]) -> Iterator[Result[GameEntry]]:
    for m in range(1, edges + 1):
        values: list[game.GameValue] = []
        for value in game.game_values(m):
            output.progress(f"{m} edges, knowing {value.knows}", m - 1, edges)
            values.append(value)
            exact = value.value.worst_is_value and value.value.mean_is_value
            yield Result(value, incomplete=not exact)
        for name in mappers:
            costs = game.mapper_costs(name, m, values)
            yield Result(costs, failed=costs.failing is not None)


# ---------------------------------------------------------------- for people


def _show(entries: Sequence[GameEntry]) -> Iterator[Block]:
    values = [entry for entry in entries if isinstance(entry, game.GameValue)]
    yield _mapper_table([entry for entry in entries if isinstance(entry, game.MapperCosts)])
    yield Text("")
    yield _map_table([entry for entry in values if entry.knows == "nothing"])
    yield Text("")
    yield _knowledge_table(values)
    if not all(entry.value.worst_is_value and entry.value.mean_is_value for entry in values):
        yield Text("")
        yield Text("≥: the search was cut short; no robot pays less, perhaps none so little.")


def _mapper_table(entries: Sequence[game.MapperCosts]) -> TextTable:
    return Rows(entries).table(
        (">m", lambda e: e.game),
        ("mapper", lambda e: e.mapper),
        ("worlds", lambda e: e.drawn),
        (">worst", lambda e: e.worst if e.failing is None else f"fails in {e.failing}"),
        (">best", lambda e: e.value and _worst(e.value)),
        (">mean", lambda e: None if e.mean is None else f"{e.mean:.2f}"),
        (">best", lambda e: e.value and _mean(e.value)),
        (">costs more by", lambda e: _more(e.mean, e.value)),
        title="Mappers and the best robot that knows as much",
    )


def _map_table(entries: Sequence[game.GameValue]) -> TextTable:
    return Rows(entries).table(
        (">m", lambda e: e.game),
        ("worlds", lambda e: f"{e.worlds} {e.drawn}"),
        (">worst, map in hand", lambda e: e.least.worst),
        (">best", lambda e: _worst(e.value)),
        (">mean, map in hand", lambda e: f"{e.least.mean:.2f}"),
        (">best", lambda e: _mean(e.value)),
        (
            ">costs more by",
            lambda e: _more(e.value.mean, e.least, least=not e.value.mean_is_value),
        ),
        title="What not knowing the map costs at best",
    )


def _knowledge_table(entries: Sequence[game.GameValue]) -> TextTable:
    base = {(entry.game, entry.drawn): entry for entry in entries if entry.knows == "nothing"}
    return Rows(entries).table(
        (">m", lambda e: e.game),
        ("worlds", lambda e: e.drawn),
        ("knows", lambda e: e.knows),
        (">worst", lambda e: _worst(e.value)),
        (">mean", lambda e: _mean(e.value)),
        (">saves", lambda e: _saved(e.value, base[e.game, e.drawn].value)),
        title="What the best robot pays, and what it saves to know more",
    )


def _worst(costs: game.CostsOfRobot) -> str:
    return f"{'' if costs.worst_is_value else '≥ '}{costs.worst}"


def _mean(costs: game.CostsOfRobot) -> str:
    return f"{'' if costs.mean_is_value else '≥ '}{costs.mean:.2f}"


def _more(mean: float | None, than: game.CostsOfRobot | None, *, least: bool = False) -> str:
    """Excess of one mean over another in percent, with ≥ or ≤ if one is only a bound."""
    if mean is None or than is None:
        return "-"
    sign = "≥ " if least else "" if than.mean_is_value else "≤ "
    return f"{sign}{100 * (mean / than.mean - 1):.1f} %"


def _saved(costs: game.CostsOfRobot, nothing: game.CostsOfRobot) -> str:
    """How far a mean is below that of the robot that knows nothing, in percent, or `-`."""
    if costs is nothing or not costs.mean_is_value:
        return "-"
    sign = "" if nothing.mean_is_value else "≥ "
    return f"{sign}{100 * (1 - costs.mean / nothing.mean):.1f} %"
