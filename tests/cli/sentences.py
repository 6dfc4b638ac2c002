"""A translation of topo-verify: the words of each sentence in its source stand in reverse order.

`sitecustomize` in a folder on PYTHONPATH calls `install`, so every process of a command speaks the
other language. Names, formats and SQL are no sentences.
"""

from __future__ import annotations

import ast
import re
import sys
from importlib.machinery import PathFinder, SourceFileLoader
from types import CodeType
from typing import Any

ROOMS = ("robot", "checkers", "programs", "campaign", "studies", "cli", "extra", "errors", "world")

_WORDS = re.compile(r"\b[a-z]+ [a-z]+ [a-z]+\b")
_NOT = re.compile(r"\bimport \b|\b[A-Z]{2,} |[<>{}=\\]|^--|\n")


def is_sentence(text: str) -> bool:
    """Whether this is English, as far as three words in a row tell."""
    return _WORDS.search(text) is not None and _NOT.search(text) is None


def reverse(text: str) -> str:
    """The sentence with its words in reverse order, between the same blanks."""
    body = text.strip()
    head, tail = text.split(body) if body else (text, "")
    return head + " ".join(reversed(body.split(" "))) + tail


class _Translate(ast.NodeTransformer):
    def visit_Expr(self, node: ast.Expr) -> ast.AST:
        return node if isinstance(node.value, ast.Constant) else self.generic_visit(node)

    def visit_JoinedStr(self, node: ast.JoinedStr) -> ast.AST:
        pieces = [one.value for one in node.values if isinstance(one, ast.Constant)]
        is_sql = any(re.match(r"\s*(SELECT|INSERT|UPDATE|DELETE) ", str(one)) for one in pieces)
        return node if is_sql else self.generic_visit(node)

    def visit_Constant(self, node: ast.Constant) -> ast.AST:
        if isinstance(node.value, str) and is_sentence(node.value):
            return ast.copy_location(ast.Constant(reverse(node.value)), node)
        return node


class _Loader(SourceFileLoader):
    def get_code(self, fullname: str) -> CodeType:  # noqa: ARG002  of the base class
        tree = ast.parse(self.get_data(self.path), self.path)
        tree = ast.fix_missing_locations(_Translate().visit(tree))
        return compile(tree, self.path, "exec", dont_inherit=True)


class _Finder:
    @staticmethod
    def find_spec(name: str, path: Any = None, target: Any = None) -> Any:
        if not name.startswith(tuple(f"topo_verify.{room}" for room in ROOMS)):
            return None
        spec = PathFinder.find_spec(name, path, target)
        if spec is not None and isinstance(spec.loader, SourceFileLoader):
            spec.loader = _Loader(name, spec.loader.path)
        return spec


def install() -> None:
    """Translate every module of these rooms that is imported from now on."""
    sys.meta_path.insert(0, _Finder())
