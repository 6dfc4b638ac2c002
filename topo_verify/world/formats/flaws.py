"""The flaws of a drawing, collected, so that one refusal names the first ten."""

from __future__ import annotations

from types import TracebackType

from topo_verify.errors import InputError, shown

MOST = 10
"""Flaws that a refusal names."""


class Flaws:
    """A context manager that keeps the `InputError` raised inside, and goes on behind the block.

    Attributes:
        source: the input, for the refusal.
        touched: numbers of vertices with an edge that was left out as a flaw.
    """

    def __init__(self, source: str) -> None:
        self.touched: set[int] = set()
        self.source = source
        self._total = 0
        self._first: list[str] = []

    def __bool__(self) -> bool:
        return self._total > 0

    def __enter__(self) -> None:
        """Begin a part that may have a flaw."""

    def __exit__(
        self, _kind: object, error: BaseException | None, _traceback: TracebackType | None
    ) -> bool:
        """Keep the flaw; other exceptions pass."""
        if isinstance(error, InputError):
            self._total += 1
            if len(self._first) < MOST:
                self._first.append(str(error).removeprefix(f"{self.source}: "))
        return isinstance(error, InputError)

    def refuse(self) -> None:
        """Raise one `InputError` if there are flaws."""
        if self._total == 1:
            raise InputError(f"{self.source}: {self._first[0]}")
        if self._total:
            first = f", the first {MOST} of them" if self._total > MOST else ""
            listed = "; ".join(
                f"({n}) {shown(text, limit=300)}" for n, text in enumerate(self._first, 1)
            )
            raise InputError(f"{self.source} has {self._total:,} flaws{first}: {listed}")
