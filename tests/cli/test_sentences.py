"""No verdict is read out of a sentence: in another language, all but the texts is the same."""

from __future__ import annotations

import ast
import json
import os
import re
import shlex
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any, cast

import pytest

from tests.campaign.misdeeds import DEEDS
from tests.cli.sentences import is_sentence, reverse
from tests.test_layers import every_source

ROOT = Path(__file__).resolve().parents[2]
MISDEEDS = ROOT / "tests" / "campaign" / "misdeeds.py"

HOOK = """
import importlib.util, os
spec = importlib.util.spec_from_file_location("sentences", {path!r})
sentences = importlib.util.module_from_spec(spec)
spec.loader.exec_module(sentences)
if "TRANSLATED" in os.environ:
    sentences.install()
"""


def told(folder: Path, line: str, *, translated: bool) -> tuple[int, Any, str]:
    """Exit code, JSON and standard error of a command."""
    hook = folder / "hook"
    hook.mkdir(exist_ok=True)
    source = HOOK.format(path=str(ROOT / "tests" / "cli" / "sentences.py"))
    (hook / "sitecustomize.py").write_text(source, encoding="utf-8")
    more = {"PYTHONPATH": str(hook), **({"TRANSLATED": "1"} if translated else {})}
    done = subprocess.run(
        [sys.executable, "-m", "topo_verify", *shlex.split(line), "--format", "json"],
        cwd=folder,
        env={**os.environ, **more},
        capture_output=True,
        text=True,
        check=False,
        timeout=120,
    )
    return done.returncode, json.loads(done.stdout) if done.stdout else None, done.stderr


def leaves(value: Any, place: str = "$") -> Iterator[tuple[str, object]]:
    """Each number, text and null of a result, with its place; times and hashes are left out."""
    if isinstance(value, dict):
        for name, one in cast("dict[str, Any]", value).items():
            if name not in ("timing", "digest"):
                yield from leaves(one, f"{place}.{name}")
    elif isinstance(value, list):
        entries: list[Any] = [*value]
        for number, one in enumerate(entries):
            yield from leaves(one, f"{place}[{number}]")
    else:
        yield place, value


def differences(ours: Any, theirs: Any) -> list[str]:
    """Where two results differ, but for texts of several words."""
    first, second = dict(leaves(ours)), dict(leaves(theirs))
    return [
        f"{place}: {first.get(place)!r}, in the other language {second.get(place)!r}"
        for place in {**first, **second}
        if first.get(place) != second.get(place)
        and not (" " in str(first.get(place)) and " " in str(second.get(place)))
    ]


def searches() -> Iterator[Any]:
    ways = {
        "child": "search {mapper}:from_3_{deed} --workers 1",
        "shared": "search {mapper}:from_3_{deed} --workers 1 --in-process",
        "program": "search --cmd '{python} {mapper} from_3_{deed}' --workers 1",
    }
    for way, line in ways.items():
        for deed in (*DEEDS, "memory"):
            if (way, deed) in {("program", "memory"), ("shared", "skip"), ("shared", "error")}:
                continue
            marks = (
                ()
                if (way, deed) in {("child", "memory"), ("program", "kill")}
                else pytest.mark.long
            )
            text = line.format(mapper=MISDEEDS, python=sys.executable, deed=deed)
            yield pytest.param(
                f"{text} --edges 2 --move-timeout 0.5", marks=marks, id=f"{way} {deed}"
            )
    for deed in ("skip", "hang", "kill"):
        more = "--worlds 'edges<=2' --workers 1 --seed 0:1 --move-timeout 0.5"
        text = f"conform {MISDEEDS}:from_3_{deed} {more}"
        yield pytest.param(text, marks=pytest.mark.long, id=f"conform {deed}")
    for line in (
        "search basic --edges 3",
        "explore m3/14 --target all",
        "search no.such:mapper --edges 2",
    ):
        yield pytest.param(line, marks=pytest.mark.long)


@pytest.mark.parametrize("line", [*searches()])
def test_all_but_the_texts_is_the_same_in_another_language(tmp_path: Path, line: str) -> None:
    code, ours, _ = told(tmp_path, line, translated=False)
    other, theirs, _ = told(tmp_path, line, translated=True)
    assert (other, differences(ours, theirs)) == (code, [])
    assert ours != theirs or code in (0, 2)


@pytest.mark.long
@pytest.mark.parametrize("plan", ["from_9_map", "from_99_map"])
def test_a_ledger_is_resumed_in_another_language(tmp_path: Path, plan: str) -> None:
    line = f"search {MISDEEDS}:{plan} --edges 2 --workers 1 --ledger "
    told(tmp_path, line + "a.ledger", translated=False)
    shutil.copy(tmp_path / "a.ledger", tmp_path / "b.ledger")
    code, ours, _ = told(tmp_path, line + "a.ledger", translated=False)
    other, theirs, _ = told(tmp_path, line + "b.ledger", translated=True)
    assert (other, differences(ours, theirs)) == (code, [])


def test_the_translation_speaks_another_language_and_leaves_names() -> None:
    assert is_sentence("the mapper raised ")
    assert reverse(" the mapper raised ") == " raised mapper the "
    for text in ("SELECT a FROM b", "map-isomorphic", "--cmd ", "m3/14", "a b", "import sys, os"):
        assert not is_sentence(text)


# ---------------------------------------------------------------- what asks a sentence

ASKING = {
    *("startswith", "endswith", "removeprefix", "removesuffix", "replace", "partition"),
    *("rpartition", "split", "find", "index", "count", "search", "match", "fullmatch", "compile"),
}


OTHERS = {
    "topo_verify.proofs.mechanised.toolchain": "Coq tells no lack of memory otherwise",
    "topo_verify.world.formats.world_json": "msgspec names a field in its message alone",
    "topo_verify.extra.arena.league": "cuts the line of code from a text that is shown",
    "topo_verify.cli.certify": "chooses an advice, and no verdict",
    "topo_verify.checkers.entailment": "a trace cites a contradiction by such a name",
}
"""Files that look into a text, and why."""


def sentences_by_name(source: str) -> Iterator[str]:
    """The names of the sentences at the top of a file, whole or with gaps."""
    for node in ast.parse(source).body:
        if isinstance(node, ast.Assign):
            texts = [one for one in ast.walk(node.value) if isinstance(one, ast.Constant)]
            whole = isinstance(node.value, ast.Constant | ast.JoinedStr)
            if whole and any(is_text(one, set()) for one in texts):
                yield from (one.id for one in node.targets if isinstance(one, ast.Name))


def questions(source: str, named: set[str]) -> Iterator[int]:
    """The lines at which a file looks into a text for a sentence, or one of these names."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute):
            asked = node.args if node.func.attr in ASKING else []
        elif isinstance(node, ast.Compare):
            sides = (one for side in (node.left, *node.comparators) for one in parts(side))
            is_asked = any(isinstance(op, ast.In) for op in node.ops)  # else a name is a code
            asked = [one for one in sides if is_asked or not isinstance(one, ast.Name)]
        else:
            continue
        if any(is_text(one, named) for one in asked):
            yield node.lineno


def parts(node: ast.expr) -> list[ast.expr]:
    """The elements of a display, or the expression alone."""
    return node.elts if isinstance(node, ast.Tuple | ast.List | ast.Set) else [node]


def is_text(node: ast.expr, named: set[str]) -> bool:
    if isinstance(node, ast.Name):
        return node.id in named
    text = node.value if isinstance(node, ast.Constant) else None
    return isinstance(text, str) and re.search(r"\b[a-z]+ [a-z]+ [a-z]+\b", text) is not None


def test_no_file_looks_for_a_sentence_in_a_text() -> None:
    sources = every_source()
    named = {name for source in sources.values() for name in sentences_by_name(source)}
    found = {
        f"{name}:{line}"
        for name, source in sources.items()
        if name not in OTHERS
        for line in questions(source, named)
    }
    assert found == set()


@pytest.mark.parametrize(
    "source",
    [
        "text.startswith('the mapper raised it')",
        "re.search(r'the mapper raised \\\\w*MemoryError', text)",
        "'at the second try' in text",
        "text not in (None, 'ended with exit code 0')",
        "END = '; at the second try it delivered one'\ntext.endswith(END)",
        "text.replace('the program it ran', 'x')",
    ],
)
def test_a_file_that_looks_for_a_sentence_is_seen(source: str) -> None:
    assert [*questions(source, {*sentences_by_name(source)})]
