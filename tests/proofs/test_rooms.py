"""Three engines, a room each: nothing crosses between them, and the solvers know none of them."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import topo_verify.proofs

ROOT = Path(topo_verify.proofs.__file__).parent
HOME = "topo_verify.proofs"

ENGINES = ("first_order", "bounded", "mechanised")
SEES = {
    "theorem": set[str](),
    "solvers": {"theorem"},
    "catalogue": {*ENGINES, "theorem"},
    **{engine: {"theorem", "solvers"} for engine in ENGINES},
}
"""What each part of proofs/ may import of the others."""


def crossings(part: str, source: str) -> Iterator[str]:
    """The imports with which a file of one part reaches a part that it must not see."""
    for node in ast.walk(ast.parse(source)):
        names: list[str] = []
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            names = [f"{node.module}.{alias.name}" for alias in node.names]
        for name in names:
            if name.startswith(f"{HOME}."):
                other = name.removeprefix(f"{HOME}.").split(".")[0]
                if other not in {part, *SEES[part]}:
                    yield f"{part} imports {name}"


def test_nothing_crosses_between_the_engines() -> None:
    seen: set[str] = set()
    for path in sorted(ROOT.rglob("*.py")):
        part = path.relative_to(ROOT).with_suffix("").parts[0]
        if part != "__init__":
            seen.add(part)
            assert not list(crossings(part, path.read_text(encoding="utf-8"))), path
    assert seen == set(SEES)


def test_a_name_taken_from_another_engine_is_seen() -> None:
    taken = "def late():\n    from topo_verify.proofs.first_order.terms import Term"
    assert list(crossings("bounded", taken))
    assert list(crossings("solvers", "import topo_verify.proofs.bounded.cnf"))
    assert not list(crossings("first_order", taken))
