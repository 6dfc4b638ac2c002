"""Kernels: Python functions over one array of integers, which numba turns into machine code.

A **kernel** is a function with the decorator `kernel` or `inlined` (other kernels call it) or
`entry` (Python calls it). The decorators change nothing: imported, a kernel is an ordinary function
that type checkers read and that tests may run with every index checked. `compiled` makes machine
code of it:

1. It takes the sources of all kernels and leaves out annotations and docstrings: of this package's
   kernels (`SOURCES`), or of the modules that a layout names.
2. It writes the constants above them: every upper-case integer of the kernels' modules, the offsets
   of the workspace among them. So one source serves every layout, and an offset costs nothing.
3. It makes every index unsigned, or numba would test each one for being negative.
4. It writes the result as one module into a cache folder, and numba keeps its machine code beside
   it. The folder is named after a hash of that module and of the versions of numba and Python.

Why so: numba's own cache notices a change of the file that a function stands in, and none of the
functions that it calls elsewhere; here any change of any kernel gives another folder. `_nrt=False`
switches off the counting of references, which took more than half of the time; an allocation in a
kernel is then an error of compilation. Functions never travel as arguments (those miss the cache in
every process): an integer in the workspace selects.

The cache: `$TOPO_VERIFY_CACHE`, or `topo-verify` in `$XDG_CACHE_HOME` or `~/.cache`; without a home
that can be written, a folder that lasts as long as the process. It may be deleted at any time.
While one process compiles the kernels of a folder, others that need them wait for its lock.
"""

from __future__ import annotations

import ast
import fcntl
import os
import platform
import sys
import tempfile
from collections.abc import Callable, Generator, Iterator, Mapping
from contextlib import contextmanager
from functools import cache
from hashlib import sha256
from importlib import import_module
from importlib.metadata import version
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from types import ModuleType
from typing import Any, Protocol, TypeVar, cast

from topo_verify.compiled import require
from topo_verify.compiled.workspace import WordLayout

F = TypeVar("F", bound=Callable[..., object])


class Words(Protocol):
    """A row of 64-bit integers: the workspace, a numpy array or, in tests, a list."""

    def __getitem__(self, at: int, /) -> int:
        """The word at this place."""
        ...

    def __setitem__(self, at: int, word: int, /) -> None:
        """Write the word at this place."""
        ...

    def __len__(self) -> int:
        """The number of words."""
        ...


class WordTable(Protocol):
    """A table of 64-bit integers, by row and column: in use a numpy array."""

    def __getitem__(self, at: tuple[int, int], /) -> int:
        """The word in this row and column."""
        ...

    def __setitem__(self, at: tuple[int, int], word: int, /) -> None:
        """Write the word in this row and column."""
        ...


class WordCube(Protocol):
    """Tables of 64-bit integers, by number, row and column: in use a numpy array."""

    def __getitem__(self, at: tuple[int, int, int], /) -> int:
        """The word in this table, row and column."""
        ...

    def __setitem__(self, at: tuple[int, int, int], word: int, /) -> None:
        """Write the word in this table, row and column."""
        ...


SOURCES = [
    f"topo_verify.compiled.{name}"
    for name in (
        "workspace",
        "growth",
        "pruning",
        "all_worlds",
        "enumeration",
        "events",
        "faults",
        "robot",
        "chart",
        "policies",
        "motion",
        "prefix",
        "records",
        "history",
        "partial_fold",
        "folding",
        "planar",
        "rules",
        "exploration",
        "judging.layout",
        "judging.words",
        "judging.justified",
        "judging.truth",
        "judging.fold",
        "judging.consequences",
        "judging.entailed",
        "judging.verdict",
        "tally",
    )
]
"""The modules of the twin's kernels, and of constants that they use."""


def kernel(function: F) -> F:
    """The function itself. The mark says that other kernels call it."""
    return function


def inlined(function: F) -> F:
    """The function itself. The mark says that it becomes a part of each kernel that calls it.

    For what is short and called all the time: a call passes each array as seven numbers.
    """
    return function


def entry(function: F) -> F:
    """The function itself. The mark says that Python calls its machine code: see `compiled`.

    Its parameters are annotated with `Words`, `WordTable`, `WordCube` and `int`.
    """
    return function


def compiled(function: F, layout: WordLayout, *, checked: bool = False) -> F:
    """The machine code of an entry, for workspaces of a layout; compiled when first asked for.

    Args:
        checked: with every index checked; an index out of range is then an IndexError.
    Raises:
        InputError: numba is not installed.
    """
    module = machine_code(layout, checked)
    dispatcher = getattr(module, function.__name__)
    if not dispatcher.signatures:
        path = Path(str(module.__file__))
        if _is_kept(path, function.__name__):
            dispatcher.compile(_signature(function))
        else:
            with _alone(path, function.__name__):
                if not _is_kept(path, function.__name__):
                    _say(
                        f"compiling {function.__name__} for this machine: once, up to a minute"
                        f" (kept in {path.parent})"
                    )
                dispatcher.compile(_signature(function))
    return cast("F", dispatcher)


def _is_kept(path: Path, name: str) -> bool:
    """Whether the cache has the machine code of an entry of the module in this file."""
    return any((path.parent / "__pycache__").glob(f"{path.stem}.{name}-*.nbi"))


@contextmanager
def _alone(path: Path, name: str) -> Generator[None]:
    """No other process compiles kernels of this folder meanwhile; one that ends lets go of it."""
    with (path.parent / "lock").open("a") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            _say(f"another process compiles kernels: waiting for it before {name}, up to a minute")
            fcntl.flock(file, fcntl.LOCK_EX)
        yield


def _say(sentence: str) -> None:
    sys.stderr.write(f"topo-verify: {sentence}\n")
    sys.stderr.flush()


_TYPES = {
    "Words": "int64[::1]",
    "WordTable": "int64[:, ::1]",
    "WordCube": "int64[:, :, ::1]",
    "int": "int64",
}


def _signature(function: Callable[..., object]) -> str:
    """The types of the parameters of an entry, as numba writes them."""
    notes = function.__annotations__
    return f"({', '.join(_TYPES[note] for name, note in notes.items() if name != 'return')},)"


# ---------------------------------------------------------------- from sources to one module


@cache
def machine_code(layout: WordLayout, checked: bool) -> ModuleType:  # noqa: FBT001  the key of the cache
    """The module of all kernels for a layout; each is compiled when it is asked for."""
    require("the compiled engine")
    name = f"kernels_{layout.name}{'_checked' if checked else ''}"
    path = _stored(name, module_source(layout, checked=checked))
    spec = spec_from_file_location(name, path)
    assert spec is not None
    assert spec.loader is not None
    module = module_from_spec(spec)
    sys.modules[name] = module
    spec.loader.exec_module(module)
    return module


def module_source(layout: WordLayout, *, checked: bool = False) -> str:
    """The text of one module that has the constants of a layout and every kernel."""
    numbers: dict[str, int] = {}
    functions: list[ast.FunctionDef] = []
    for name in layout.sources or SOURCES:
        module = import_module(name)
        numbers.update(_constants(module))
        functions += _kernels(Path(str(module.__file__)))
    numbers.update(layout.constants)
    names = [function.name for function in functions]
    assert len(set(names)) == len(names), f"two kernels of one name: {sorted(names)}"
    used = {node.id for f in functions for node in ast.walk(f) if isinstance(node, ast.Name)}
    options = f"boundscheck={checked}, _nrt={checked}, error_model='numpy'"
    lines = ["import numpy as np", "from numba import njit", ""]
    inner = f"{options}, no_cpython_wrapper=True, no_cfunc_wrapper=True"  # compiles in less time
    lines += [f"kernel = njit({inner})", f"inlined = njit(forceinline=True, {inner})"]
    lines += [f"entry = njit(cache=True, {options})", ""]
    lines += [f"{name} = {number}" for name, number in numbers.items() if name in used]
    lines += [f"\n{ast.unparse(ast.fix_missing_locations(function))}" for function in functions]
    return "\n".join(lines) + "\n"


def _constants(module: ModuleType) -> Mapping[str, int]:
    """The upper-case integers of a module."""
    return {k: v for k, v in vars(module).items() if k.isupper() and type(v) is int}


def _kernels(path: Path) -> Iterator[ast.FunctionDef]:
    """The kernels of a file, ready for numba."""
    for node in ast.parse(path.read_text()).body:
        if isinstance(node, ast.FunctionDef) and any(
            isinstance(mark, ast.Name) and mark.id in ("kernel", "inlined", "entry")
            for mark in node.decorator_list
        ):
            node.returns = None
            for argument in node.args.args:
                argument.annotation = None
            if ast.get_docstring(node) is not None:
                del node.body[0]
            yield _Unsigned().visit(node)


class _Unsigned(ast.NodeTransformer):
    """Makes `W[CA + d]` into `W[np.uint64(CA + d)]`."""

    def visit_Subscript(self, node: ast.Subscript) -> ast.Subscript:
        self.generic_visit(node)
        if isinstance(node.slice, ast.Tuple):
            node.slice.elts = [_unsigned(index) for index in node.slice.elts]
        else:
            node.slice = _unsigned(node.slice)
        return node


def _unsigned(index: ast.expr) -> ast.expr:
    return ast.Call(ast.parse("np.uint64", mode="eval").body, [index], [])


# ---------------------------------------------------------------- the cache


def _stored(name: str, source: str) -> Path:
    """The file with this source in the cache; written unless it is there."""
    made_by = f"{version('numba')} {version('llvmlite')} {platform.python_version()}"
    key = f"{source}\n{made_by} {platform.machine()}"
    folder = cache_folder() / sha256(key.encode()).hexdigest()[:24]
    path = folder / f"{name}.py"
    if not path.exists():
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile("w", dir=folder, suffix=".new", delete=False) as file:
            file.write(source)
        # numba takes machine code for stale if the file is younger: whoever writes it, it is as old
        os.utime(file.name, (0, 0))
        Path(file.name).replace(path)
    return path


@cache
def cache_folder() -> Path:
    """The folder of the cache; it can be written, and belongs to the user."""
    asked = os.environ.get("TOPO_VERIFY_CACHE")
    home = os.environ.get("XDG_CACHE_HOME") or Path("~/.cache").expanduser()
    folder = (Path(asked) if asked else Path(home) / "topo-verify") / "compiled"
    try:
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    except OSError:
        pass
    else:
        # Machine code is run: what somebody else may have put there is not.
        if os.access(folder, os.W_OK) and folder.stat().st_uid == os.getuid():
            return folder
    return Path(_lasting_folder().name)


@cache
def _lasting_folder() -> Any:
    """A folder that is deleted when the process ends."""
    return tempfile.TemporaryDirectory(prefix="topo-verify-", ignore_cleanup_errors=True)
