"""Single bits turned round in a ledger and in a baseline.

A flipped file is refused with one sentence and exit code 2, or the results are those of the file
before the flip: the bit stood in padding, or in a field that nothing reads.
"""

from __future__ import annotations

from pathlib import Path
from random import Random

from formats import FORMATS
from mutations import flipped
from readers import Count, attempt


def bits(name: str) -> int:
    """How many bits the file of this format has."""
    (data,) = FORMATS[name].seeds()
    return 8 * len(data)


def chosen(name: str, number: int, seed: int) -> list[int]:
    """The bits to flip: all, or this many, drawn and in order."""
    total = bits(name)
    if number >= total:
        return list(range(total))
    return sorted(Random(f"{seed} {name}").sample(range(total), number))


def trials(name: str, places: list[int], keep: Path) -> Count:
    """Flip each of these bits by itself."""
    (data,) = FORMATS[name].seeds()
    count = Count()
    for bit in places:
        outcome, wrong = attempt(name, flipped(data, bit))
        count.take(outcome)
        if wrong is not None:
            count.convict(
                f"flip-{name}-{bit}{FORMATS[name].suffix}", flipped(data, bit), wrong, keep
            )
    return count
