"""What the mutation tests share: the small changes of a file, their runs in forks, the report.

The changes: a comparison the other way or off by one, `and` for `or` or one side of it alone, sums
and remainders, numbers and truth values, `any` for `all`, a condition turned or left out, a
statement left out, `None` returned.
"""

from __future__ import annotations

import ast
import multiprocessing
import sys
from argparse import Namespace
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from copy import deepcopy
from dataclasses import dataclass
from importlib.abc import MetaPathFinder, SourceLoader
from importlib.machinery import ModuleSpec
from importlib.util import spec_from_file_location
from multiprocessing.connection import Connection, wait
from multiprocessing.context import ForkProcess
from pathlib import Path
from typing import Any, TypeVar

M = TypeVar("M")


@dataclass(frozen=True, slots=True)
class Mutant:
    """A file with one change.

    Attributes:
        text: function, the old code, the new code, and (2) for the second such change there.
        source: the whole changed file.
    """

    file: str
    line: int
    text: str
    source: str

    def __str__(self) -> str:
        return f"{self.file} {self.text}"


SWAPS: dict[type[ast.AST], type[ast.AST]] = {
    ast.Eq: ast.NotEq,
    ast.NotEq: ast.Eq,
    ast.Lt: ast.LtE,
    ast.LtE: ast.Lt,
    ast.Gt: ast.GtE,
    ast.GtE: ast.Gt,
    ast.In: ast.NotIn,
    ast.NotIn: ast.In,
    ast.Is: ast.IsNot,
    ast.IsNot: ast.Is,
    ast.And: ast.Or,
    ast.Or: ast.And,
    ast.Add: ast.Sub,
    ast.Sub: ast.Add,
    ast.Mult: ast.Add,
}
QUANTIFIERS = {"any": "all", "all": "any"}


def changes(  # noqa: C901, PLR0912  one case a kind of node
    node: ast.AST,
) -> Iterator[ast.AST]:
    match node:
        case ast.Compare():
            for place, op in enumerate(node.ops):
                if type(op) in SWAPS:
                    other = deepcopy(node)
                    other.ops[place] = SWAPS[type(op)]()  # type: ignore[call-overload]
                    yield other
        case ast.BoolOp():
            yield ast.BoolOp(SWAPS[type(node.op)](), node.values)  # type: ignore[arg-type]
            for place in range(len(node.values)):
                rest = [deepcopy(v) for i, v in enumerate(node.values) if i != place]
                yield rest[0] if len(rest) == 1 else ast.BoolOp(node.op, rest)
        case ast.BinOp(left, ast.Mod(), _):
            yield left
        case ast.BinOp(left, op, right) if type(op) in SWAPS:
            yield ast.BinOp(left, SWAPS[type(op)](), right)  # type: ignore[arg-type]
        case ast.UnaryOp(ast.Not() | ast.USub(), operand):
            yield operand
        case ast.Name(name) if name in QUANTIFIERS:
            yield ast.Name(QUANTIFIERS[name])
        case ast.comprehension(target, source, [_, *_]):
            yield ast.comprehension(target, source, [], node.is_async)
        case ast.IfExp(test, body, orelse) if not _has_its_opposite(test):
            yield ast.IfExp(test, orelse, body)
        case ast.Constant(value) if isinstance(value, bool):
            yield ast.Constant(not value)
        case ast.Constant(value) if isinstance(value, int):
            yield ast.Constant(value + 1)
        case ast.If(test, body, orelse) if not _has_its_opposite(test):
            yield ast.If(ast.UnaryOp(ast.Not(), test), body, orelse)
        case ast.Return(value) if value is not None and ast.unparse(value) not in ("''", "None"):
            yield ast.Return(ast.Constant(None))
        case ast.Continue():
            yield ast.Break()
        case ast.Break():
            yield ast.Continue()
        case ast.Raise() | ast.AugAssign() | ast.Expr(ast.Call() | ast.Yield() | ast.YieldFrom()):
            yield ast.Pass()
        case ast.Assign([ast.Subscript() | ast.Attribute()], _):
            yield ast.Pass()
        case _:
            pass


def _has_its_opposite(test: ast.AST) -> bool:
    match test:
        case ast.Compare(
            _, [ast.Eq() | ast.NotEq() | ast.In() | ast.NotIn() | ast.Is() | ast.IsNot()]
        ):
            return True
        case ast.UnaryOp(ast.Not()):
            return True
        case _:
            return False


def mutants(path: Path) -> Iterator[Mutant]:
    tree = ast.parse(path.read_text())
    times: Counter[str] = Counter()
    for scope, parent, field, index, node in list(places(tree, "")):
        for other in changes(node):
            text = f"{scope}: {_short(node)} -> {_short(other)}"
            times[text] += 1
            text += f" ({times[text]})" if times[text] > 1 else ""
            _put(parent, field, index, other)
            source = ast.unparse(ast.fix_missing_locations(tree))
            _put(parent, field, index, node)
            yield Mutant(path.name, getattr(node, "lineno", 0), text, source)


Place = tuple[str, ast.AST, str, int | None, ast.AST]
"""Function, parent, field and index of a node, and the node."""


def places(parent: ast.AST, scope: str) -> Iterator[Place]:
    """Every node that may be changed; no types, no messages."""
    for field, value in ast.iter_fields(parent):
        if field in ("annotation", "returns", "decorator_list", "bases") or _is_type(parent):
            continue
        many = isinstance(value, list)
        for index, node in enumerate(value if many else [value]):
            if not isinstance(node, ast.AST) or isinstance(node, ast.JoinedStr):
                continue
            inside = scope
            if isinstance(node, ast.FunctionDef | ast.ClassDef):
                inside = f"{scope}.{node.name}".lstrip(".")
            else:
                yield scope, parent, field, index if many else None, node
            yield from places(node, inside)


def _is_type(node: ast.AST) -> bool:
    return (
        isinstance(node, ast.Assign)
        and isinstance(node.value, ast.Subscript)
        and not any(isinstance(target, ast.Subscript | ast.Attribute) for target in node.targets)
        and isinstance(node.value.value, ast.Name)
        and node.value.value.id in ("tuple", "Callable")
    )


def _put(parent: ast.AST, field: str, index: int | None, node: ast.AST) -> None:
    if index is None:
        setattr(parent, field, node)
    else:
        getattr(parent, field)[index] = node


def _short(node: ast.AST) -> str:
    text = ast.unparse(ast.fix_missing_locations(node))
    return text.splitlines()[0]


class Planted(MetaPathFinder, SourceLoader):  # type: ignore[misc]  # typeshed's own
    """Imports one module of a package, in a folder, from a changed source."""

    def __init__(self, mutant: Mutant, package: str, folder: Path) -> None:
        self.name = f"{package}.{Path(mutant.file).stem}"
        self.path, self.source = str(folder / mutant.file), mutant.source
        sys.meta_path.insert(0, self)

    def find_spec(self, fullname: str, *_: object) -> ModuleSpec | None:
        if fullname != self.name:
            return None
        return spec_from_file_location(fullname, self.path, loader=self)

    def get_filename(self, fullname: str) -> str:  # noqa: ARG002  as importlib asks
        return self.path

    def get_data(self, path: str) -> bytes:  # noqa: ARG002  as importlib asks
        return self.source.encode()


def in_forks(
    wanted: Sequence[M], run: Callable[[M, Connection], None], workers: int
) -> Iterator[tuple[M, Any, int]]:
    """Run each in a fork, `workers` at a time; yield its message (None: it died) and exit code."""
    fork = multiprocessing.get_context("fork")
    waiting, running = list(reversed(wanted)), dict[Connection, tuple[M, ForkProcess]]()
    while waiting or running:
        while waiting and len(running) < workers:
            job = waiting.pop()
            here, there = fork.Pipe(duplex=False)
            process = fork.Process(target=run, args=(job, there), daemon=True)
            process.start()
            there.close()
            running[here] = job, process
        for pipe in wait(list(running)):
            assert isinstance(pipe, Connection)
            job, process = running.pop(pipe)
            try:
                sent = pipe.recv()
            except EOFError:
                sent = None
            process.join()
            yield job, sent, process.exitcode or 0


def chosen(everyone: Sequence[Mutant], options: Namespace, same: Mapping[str, str]) -> list[Mutant]:
    """The mutants with `--only` in their text; with `--list` they are printed, and none is run."""
    if unknown := same.keys() - {str(mutant) for mutant in everyone}:
        raise SystemExit(f"in SAME, but there are no such mutants: {unknown}")
    wanted = [mutant for mutant in everyone if options.only in str(mutant)]
    if options.list:
        for mutant in wanted:
            print(f"{mutant} (line {mutant.line})")
        print(f"{len(wanted)} mutants")
        raise SystemExit(0)
    return wanted


def report(verdicts: Iterable[tuple[Mutant, str]], same: Mapping[str, str]) -> int:
    """Print which mutants survive ("": nothing killed it); return the exit code."""
    count: Counter[str] = Counter()
    wrong: list[str] = []
    for mutant, killer in verdicts:
        reason = same.get(str(mutant))
        count["killed" if killer else "same" if reason else "holes"] += 1
        if killer and reason:
            wrong.append(f"{mutant}\n    is said to change nothing, but was killed by {killer}")
        if not killer:
            print(f"{mutant} (line {mutant.line})\n    {reason or 'SURVIVES'}", flush=True)
    for text in wrong:
        print(text)
    print(f"{count['killed']} of {count.total()} mutants killed,")
    print(f"{count['same']} change nothing, {count['holes']} survive")
    return 1 if count["holes"] or wrong else 0
