"""The cost of the best possible robot in worlds of 1 to M edges, as three tables (M = 4: 90 s).

    python -m research.game 3

The tables are docs/data/tables/game-mappers.csv, game-price.csv and game-knowledge.csv. `≥` and `≤`
mark bounds where a search was cut short; the exit code is then 3. A mapper in which a claim fails
has no costs, and the exit code is 1.
"""

from __future__ import annotations

import argparse
import csv
import sys
from collections.abc import Sequence

from research.game import values as game

Table = tuple[tuple[str, ...], ...]


def mapper_table(costs: Sequence[game.MapperCosts]) -> Table:
    """Mappers and the best robot that knows as much."""
    head = ("m", "mapper", "worlds", "worst", "best", "mean", "best", "costs more by")
    rows = (
        (
            *(str(entry.edges), entry.mapper, entry.drawn),
            str(entry.worst) if entry.failing is None else f"fails in {entry.failing}",
            worst(entry.value) if entry.value else "-",
            "-" if entry.mean is None else f"{entry.mean:.2f}",
            mean(entry.value) if entry.value else "-",
            excess(entry.mean, entry.value),
        )
        for entry in costs
    )
    return (head, *rows)


def price_table(values: Sequence[game.GameValue]) -> Table:
    """What not knowing the map costs at best."""
    head = ("m", "worlds", "worst, map in hand", "best", "mean, map in hand", "best")
    rows = (
        (
            *(str(entry.edges), f"{entry.worlds} {entry.drawn}"),
            *(str(entry.least.worst), worst(entry.value)),
            *(f"{entry.least.mean:.2f}", mean(entry.value)),
            excess(entry.value.mean, entry.least, at_least=not entry.value.mean_is_value),
        )
        for entry in values
        if entry.knows == "nothing"
    )
    return ((*head, "costs more by"), *rows)


def knowledge_table(values: Sequence[game.GameValue]) -> Table:
    """The cost of the best robot, and how much knowledge saves it."""
    nothing = {(entry.edges, entry.drawn): entry for entry in values if entry.knows == "nothing"}
    rows = (
        (
            *(str(entry.edges), entry.drawn, entry.knows),
            *(worst(entry.value), mean(entry.value)),
            saving(entry.value, nothing[entry.edges, entry.drawn].value),
        )
        for entry in values
    )
    return (("m", "worlds", "knows", "worst", "mean", "saves"), *rows)


def worst(costs: game.CostsOfRobot) -> str:
    return f"{'' if costs.worst_is_value else '≥ '}{costs.worst}"


def mean(costs: game.CostsOfRobot) -> str:
    return f"{'' if costs.mean_is_value else '≥ '}{costs.mean:.2f}"


def excess(mean: float | None, than: game.CostsOfRobot | None, *, at_least: bool = False) -> str:
    """Excess of one mean over another in percent, with ≥ or ≤ if one is only a bound."""
    if mean is None or than is None:
        return "-"
    sign = "≥ " if at_least else "" if than.mean_is_value else "≤ "
    return f"{sign}{100 * (mean / than.mean - 1):.1f} %"


def saving(costs: game.CostsOfRobot, nothing: game.CostsOfRobot) -> str:
    """How far a mean is below that of the robot that knows nothing, in percent, or `-`."""
    if costs is nothing or not costs.mean_is_value:
        return "-"
    sign = "" if nothing.mean_is_value else "≥ "
    return f"{sign}{100 * (1 - costs.mean / nothing.mean):.1f} %"


def main() -> int:
    ask = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    ask.add_argument("edges", type=int, choices=range(1, game.MOST_EDGES + 1))
    values: list[game.GameValue] = []
    costs: list[game.MapperCosts] = []
    for edges in range(1, ask.parse_args().edges + 1):
        values += (these := list(game.game_values(edges)))
        costs += (game.mapper_costs(mapper, edges, these) for mapper in game.PLAYERS)
    write = csv.writer(sys.stdout, lineterminator="\n")
    for number, table in enumerate(
        (mapper_table(costs), price_table(values), knowledge_table(values))
    ):
        if number:
            print()
        write.writerows(table)
    if any(entry.failing for entry in costs):
        return 1
    exact = (entry.value.worst_is_value and entry.value.mean_is_value for entry in values)
    return 0 if all(exact) else 3


if __name__ == "__main__":
    sys.exit(main())
