"""What it means that a run lost its process: one table, `MEANING`.

Something else may have ended a process (the out-of-memory killer with SIGKILL, an administrator
with SIGTERM), and a mapper may stand still, or its machine; so the world is tried again. No run is
taken back: both tries count.

An engine that calls native code in its worker has its own rows: a second try behind the pipe
decides by itself, but one that is right leaves the world open, since another world may have
damaged the worker.
"""

from __future__ import annotations

from typing import Literal

import msgspec

Who = Literal["process", "worker", "engine", "machine"]
"""What was lost: the mapper's own process, a worker, a worker in an engine's code, a machine."""

How = Literal["crashed", "killed", "silent", "memory", "differs"]
"""By itself; by a signal that others send; without a sign of life; short of memory; two runs that
end differently."""

SecondTry = Literal["right", "open", "wrong", "lost"]
"""What the second try shows: no claim fails, one is undecided, one fails, it is lost again."""

Meaning = Literal["fails", "undecided"]
"""A finding, since a right mapper does not crash; or the machine may be to blame."""

MEANING: dict[tuple[Who, How, SecondTry], Meaning] = {
    ("process", "crashed", "right"): "fails",
    ("process", "crashed", "open"): "fails",
    ("process", "crashed", "wrong"): "fails",
    ("process", "killed", "right"): "undecided",
    ("process", "killed", "open"): "undecided",
    ("process", "killed", "wrong"): "fails",
    ("process", "silent", "right"): "undecided",
    ("process", "silent", "open"): "undecided",
    ("process", "silent", "wrong"): "fails",
    ("worker", "crashed", "right"): "fails",
    ("worker", "crashed", "lost"): "fails",
    ("worker", "killed", "right"): "undecided",
    ("worker", "killed", "lost"): "undecided",
    ("worker", "silent", "right"): "undecided",
    ("worker", "silent", "lost"): "fails",
    ("worker", "memory", "right"): "undecided",
    ("engine", "crashed", "right"): "undecided",
    ("engine", "killed", "right"): "undecided",
    ("engine", "silent", "right"): "undecided",
    ("engine", "differs", "right"): "undecided",
    ("machine", "silent", "lost"): "undecided",
}


class Loss(msgspec.Struct, frozen=True):
    """A run that lost its process: what was lost, how, and what the second try shows."""

    who: Who
    how: How
    again: SecondTry

    @property
    def meaning(self) -> Meaning:
        """What follows; a KeyError says that the table lacks this case."""
        return MEANING[self.who, self.how, self.again]

    @property
    def is_by_chance(self) -> bool:
        """Whether another run in the same world may end differently."""
        return self.again == "right" or self.meaning == "undecided"
