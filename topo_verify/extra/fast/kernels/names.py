"""Names for words: kernels read `chart.first[v]`, and the machine reads `W[W_CHART_FIRST + v]`.

A **view** is a class whose annotations name the words of an array in order:

    class ChartWords(WordView):
        vertices: int                                   # a single word
        alpha: Annotated[Words, "CHART_DARTS"]          # a row with this capacity

`Fields` lays views out in an array with a letter (`W`, the workspace). `Flat` turns a kernel into
what numba compiles: a view becomes the array, a name a constant offset. A **cursor** is a view that
stands somewhere in an array: `MoveWords(run, i).door` is `W[i + 1]`.
"""

from __future__ import annotations

import ast
import inspect
from collections.abc import Callable, Iterator, Mapping
from typing import (
    Annotated,
    Any,
    ClassVar,
    Protocol,
    Self,
    TypeVar,
    cast,
    get_args,
    get_origin,
    get_type_hints,
)

V = TypeVar("V", bound="WordView")


class Words(Protocol):
    """A row of 64-bit integers, such as a numpy array or a list."""

    def __getitem__(self, at: int, /) -> int: ...

    def __setitem__(self, at: int, word: int, /) -> None: ...

    def __len__(self) -> int: ...


class WordView:
    """The words of an array, from `origin` on, by their names."""

    letter: ClassVar[str]
    is_cursor: ClassVar[bool] = False
    extent: ClassVar[int]
    """The number of words of a cursor."""

    def __init__(self, words: Words, origin: int | WordView = 0) -> None:
        self.array: Words = words.array if isinstance(words, WordView) else words
        self.origin: int = origin.origin if isinstance(origin, WordView) else origin

    def __getitem__(self, at: int) -> int:
        return self.array[self.origin + at]

    def __setitem__(self, at: int, word: int) -> None:
        self.array[self.origin + at] = word

    def __len__(self) -> int:
        return len(self.array)

    def place_of(self, name: str) -> int:
        named: Field = inspect.getattr_static(type(self), name)
        return self.origin + named.offset


class Field:
    """A name of a view: a word, a row with a capacity, or a part (a view).

    Attributes:
        name: as in `chart.first`.
        constant: the name of the offset in compiled code.
    """

    def __init__(self, letter: str, name: str, capacity: str, part: type[WordView] | None) -> None:
        self.name, self.capacity, self.part = name, capacity, part
        self.constant = f"{letter}_{name.replace('.', '_').upper()}"
        self.offset = 0

    def __get__(self, view: WordView | None, owner: type[WordView]) -> WordView | int | Self:
        if view is None:
            return self
        part = self.part or WordView
        row = part(view.array, view.origin + self.offset if self.capacity else 0)
        vars(view)[self.name.rpartition(".")[2]] = row
        return row


class WordField(Field):
    def __get__(self, view: WordView | None, owner: type[WordView]) -> int | Self:
        return self if view is None else view.array[view.origin + self.offset]

    def __set__(self, view: WordView, word: int) -> None:
        view.array[view.origin + self.offset] = word


class Fields:
    """The fields of an array, in order.

    Args:
        letter: the array's name in compiled code.
        capacities: the sizes of rows.
    """

    def __init__(self, letter: str, whole: type[WordView], capacities: Mapping[str, int]) -> None:
        self.all = tuple(_named(letter, "", whole))
        self.capacities = capacities
        offsets = self.offsets()
        self.size = offsets["SIZE"]
        for field in self.all:
            field.offset = offsets[field.name]

    def offsets(
        self, capacities: Mapping[str, int] | None = None, *, gap: int = 0
    ) -> dict[str, int]:
        """The offset of each field, and `SIZE`; a test looks for stray writes in each `gap`."""
        sizes = self.capacities if capacities is None else capacities
        end, places = 0, dict[str, int]()
        for field in self.all:
            places[field.name] = end
            end += sizes.get(field.capacity, 1) + gap
        return {**places, "SIZE": end}

    def constants(self, offsets: Mapping[str, int] | None = None) -> dict[str, int]:
        places = self.offsets() if offsets is None else offsets
        return {field.constant: places[field.name] for field in self.all}


def _named(letter: str, part: str, view: type[WordView]) -> Iterator[Field]:
    """Set the names of a view; yield its fields, inherited ones first."""
    for owner in reversed(view.__mro__):
        if owner is WordView or not issubclass(owner, WordView) or "letter" in vars(owner):
            continue
        owner.letter = letter
        hints = get_type_hints(owner, include_extras=True)
        for name in inspect.get_annotations(owner):
            hint: Any = hints[name]
            if isinstance(hint, type) and issubclass(hint, WordView):
                setattr(owner, name, Field(letter, name, "", hint))
                yield from _named(letter, name, hint)
            else:
                capacity: str = get_args(hint)[1] if get_origin(hint) is Annotated else ""
                kind = Field if capacity else WordField
                field = kind(letter, f"{part}.{name}".lstrip("."), capacity, None)
                setattr(owner, name, field)
                yield field


def cursor(letter: str, capacities: Mapping[str, int] = {}) -> Callable[[type[V]], type[V]]:
    """The decorator of a cursor; a row without a capacity must be last."""

    def placed(view: type[V]) -> type[V]:
        above = [name for base in view.__mro__[1:] for name in vars(base).values()]
        view.extent = sum(isinstance(name, Field) for name in above)
        for field in _named(letter, "", view):
            field.offset = view.extent
            view.extent += capacities.get(field.capacity, 1)
        view.is_cursor = True
        return view

    return placed


class Flat(ast.NodeTransformer):
    """Turns a kernel with names into one over arrays and offsets.

    Raises:
        TypeError: a row is used as a word, or a part as an array.
    """

    def __init__(self, namespace: Mapping[str, object]) -> None:
        self._namespace = namespace
        self._views: dict[str, type[WordView]] = {}
        self._stands: dict[str, str] = {}  # cursor -> its place

    def visit_FunctionDef(self, node: ast.FunctionDef) -> ast.FunctionDef:
        self._views, self._stands = {}, {}
        for argument in node.args.args:
            view = self._namespace.get(getattr(argument.annotation, "id", ""))
            if isinstance(view, type) and issubclass(view, WordView):
                self._views[argument.arg] = view
        self.generic_visit(node)
        return node

    def visit_arg(self, node: ast.arg) -> ast.arg:
        view = self._views.get(node.arg)
        return node if view is None or view.is_cursor else ast.arg(view.letter)

    def visit_Assign(self, node: ast.Assign) -> ast.AST | None:
        """Drop it if it only names parts of a view, or a cursor."""
        if isinstance(node.value, ast.Call) and (cursor := self._view(node.value)) is not None:
            target, place = node.targets[0], node.value.args[1]
            if not isinstance(target, ast.Name) or not isinstance(place, ast.Name):
                raise TypeError(f"{ast.unparse(node)}: a cursor stands at a place with a name")
            self._views[target.id] = cursor
            self._stands[target.id] = self._stands.get(place.id, place.id)
            return None
        values = node.value.elts if isinstance(node.value, ast.Tuple) else [node.value]
        parts = [self._view(value) for value in values]
        if not all(parts):
            return self.generic_visit(node)
        (target,) = node.targets
        names = target.elts if isinstance(target, ast.Tuple) else [target]
        self._views |= {
            name.id: part
            for name, part in zip(names, parts, strict=True)
            if part and isinstance(name, ast.Name)
        }
        return None

    def visit_Name(self, node: ast.Name) -> ast.Name:
        view = self._views.get(node.id)
        if view is None:
            return node
        name = self._stands.get(node.id, node.id) if view.is_cursor else view.letter
        return ast.Name(name, node.ctx)

    def visit_Attribute(self, node: ast.Attribute) -> ast.expr:
        view = self._view(node.value)
        if view is None:
            return node
        if node.attr == "origin":
            place: ast.expr = self.visit(node.value)
            return place
        named = _named_in(view, node)
        if named.part is not None:
            return ast.Name(view.letter, ast.Load())
        if named.capacity:
            raise TypeError(f"{ast.unparse(node)} is a row of words: it needs an index")
        return self._word(node.value, view, named, None, node.ctx)

    def visit_Subscript(self, node: ast.Subscript) -> ast.expr:
        row = node.value
        view = self._view(row)
        if view is not None and view.is_cursor:
            node.slice = _sum(self.visit(row), self.visit(node.slice))
            node.value = ast.Name(view.letter, ast.Load())
            return node
        if isinstance(row, ast.Attribute) and (view := self._view(row.value)) is not None:
            named = _named_in(view, row)
            if named.part is None:
                if not named.capacity:
                    raise TypeError(f"{ast.unparse(row)} is one word: it has no index")
                return self._word(row.value, view, named, self.visit(node.slice), node.ctx)
        return cast("ast.expr", self.generic_visit(node))

    def visit_Call(self, node: ast.Call) -> ast.expr:
        """`chart.place_of("first")` is an offset; a cursor is its place."""
        cursor_view = self._view(node)
        if cursor_view is not None:
            place: ast.expr = self.visit(node.args[1])
            return place
        if isinstance(node.func, ast.Attribute) and node.func.attr == "place_of":
            view = self._view(node.func.value)
            (name,) = node.args
            if view is not None and isinstance(name, ast.Constant):
                named = _named_in(view, ast.Attribute(node.func.value, str(name.value), ast.Load()))
                return self._place(node.func.value, view, named)
        return cast("ast.expr", self.generic_visit(node))

    def _view(self, node: ast.expr) -> type[WordView] | None:
        if isinstance(node, ast.Name):
            return self._views.get(node.id)
        if isinstance(node, ast.Attribute) and node.attr != "origin":
            view = self._view(node.value)
            return None if view is None else _named_in(view, node).part
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
            called = self._namespace.get(node.func.id)
            if isinstance(called, type) and issubclass(called, WordView):
                return called
        return None

    def _word(
        self,
        owner: ast.expr,
        view: type[WordView],
        named: Field,
        index: ast.expr | None,
        ctx: ast.expr_context,
    ) -> ast.expr:
        place = self._place(owner, view, named)
        if index is not None and not (isinstance(index, ast.Constant) and index.value == 0):
            place = _sum(place, index)
        return ast.Subscript(ast.Name(view.letter, ast.Load()), place, ctx)

    def _place(self, owner: ast.expr, view: type[WordView], named: Field) -> ast.expr:
        if not view.is_cursor:
            return ast.Name(named.constant, ast.Load())
        place = self.visit(owner)
        return ast.BinOp(place, ast.Add(), ast.Constant(named.offset)) if named.offset else place


def _named_in(view: type[WordView], node: ast.Attribute) -> Field:
    named = inspect.getattr_static(view, node.attr, None)
    if not isinstance(named, Field):
        raise TypeError(f"{ast.unparse(node)}: {view.__name__} has no such name")
    return named


def _sum(place: ast.expr, index: ast.expr) -> ast.expr:
    at = index
    if not isinstance(at, ast.BinOp) or not isinstance(at.op, ast.Add | ast.Sub):
        return ast.BinOp(place, ast.Add(), index)
    while isinstance(at.left, ast.BinOp) and isinstance(at.left.op, ast.Add | ast.Sub):
        at = at.left
    at.left = ast.BinOp(place, ast.Add(), at.left)
    return index
