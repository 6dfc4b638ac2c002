"""The operators of the mutation test: which small changes of a file are tried.

A comparison the other way or off by one, `and` for `or` or one side of it alone, sums and
remainders, numbers and truth values, `any` for `all`, a condition turned or left out, a statement
left out, `None` returned. Types and messages are left as they are.
"""

from __future__ import annotations

import ast
from collections import Counter
from collections.abc import Iterator
from copy import deepcopy
from dataclasses import dataclass
from pathlib import Path


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
    """The nodes that may replace this one."""
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
    """Every mutant of a file."""
    tree = ast.parse(path.read_text())
    seen: Counter[str] = Counter()
    for scope, parent, field, index, node in list(places(tree, "")):
        for other in changes(node):
            text = f"{scope}: {_short(node)} -> {_short(other)}"
            seen[text] += 1
            text += f" ({seen[text]})" if seen[text] > 1 else ""
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
