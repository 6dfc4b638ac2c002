"""Kernels: Python functions over one array of integers, which numba turns into machine code.

Imported, a kernel is an ordinary function, which tests may run with every index checked. `compiled`
makes machine code:

1. It takes the sources of all kernels, without annotations and docstrings.
2. It writes arrays and offsets in place of names (`names.py`), and above them every upper-case
   integer and offset as constants. So one source serves every layout.
3. It makes every index unsigned, or numba would test each one for being negative.
4. It writes one module into a cache folder named after a hash of that module, the versions of numba
   and Python, and the processor. Numba keeps machine code there, with checksums.

Why so: numba's own cache does not notice changes in called functions of other files. `_nrt=False`
switches off reference counting, which took more than half of the time. Functions as arguments miss
the cache in every process, so an integer in the workspace selects.

The cache: `$TOPO_VERIFY_CACHE`, or `topo-verify` in `$XDG_CACHE_HOME` or `~/.cache`; else a folder
for this process. It may be deleted at any time. Processes that need a folder wait for its lock.

What this does not show: that no file was changed together with its checksum.
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
from pathlib import Path
from pwd import getpwuid
from types import ModuleType
from typing import Any, Protocol, TypeVar, cast

from topo_verify import extras
from topo_verify.errors import InputError
from topo_verify.extra.fast.kernels.names import Fields, Flat
from topo_verify.extra.fast.kernels.workspace import WordLayout

F = TypeVar("F", bound=Callable[..., object])


class WordTable(Protocol):
    def __getitem__(self, at: tuple[int, int], /) -> int: ...

    def __setitem__(self, at: tuple[int, int], word: int, /) -> None: ...


class WordCube(Protocol):
    def __getitem__(self, at: tuple[int, int, int], /) -> int: ...

    def __setitem__(self, at: tuple[int, int, int], word: int, /) -> None: ...


SOURCES = [
    f"topo_verify.extra.fast.kernels.{name}"
    for name in (
        "workspace", "pruning", "enumeration", "events", "faults", "robot", "chart", "motion",
        "evidence", "folding", "exploration", "native", "judging.layout", "judging.justified",
        "judging.truth", "judging.fold", "judging.entailed", "judging.verdict", "tally",
    )
]  # fmt: skip


def kernel(function: F) -> F:
    """Mark a function that other kernels call."""
    return function


def inlined(function: F) -> F:
    """Mark a short hot function: a numba call unpacks each array into seven numbers."""
    return function


def entry(function: F) -> F:
    """Mark a function that Python calls: see `compiled`."""
    return function


def callback(function: F) -> F:
    """Mark a function that a native mapper calls: see `address_of`.

    Its first word is the address of the workspace.
    """
    return function


def compiled(
    function: Callable[..., object], layout: WordLayout, *, checked: bool = False
) -> Callable[..., Any]:
    """The machine code of an entry for a layout; `checked`: an index out of range is an IndexError.

    Raises:
        InputError: numba is missing; the cache folder cannot be used.
    """
    module = machine_code(layout, checked)
    dispatcher = getattr(module, function.__name__)
    if not dispatcher.signatures:
        _make(module, function.__name__, lambda: dispatcher.compile(_signature(function)))
        dispatcher.disable_compile()  # a call with a bool would add code without a checksum
    return cast("Callable[..., Any]", dispatcher)


@cache
def address_of(function: Callable[..., int], layout: WordLayout) -> int:
    from numba import cfunc, types

    module, name = machine_code(layout, False), CALLED + function.__name__  # noqa: FBT003  part of the key
    words = [types.int64] * function.__code__.co_argcount
    options: dict[str, Any] = {"cache": True, "_nrt": False, "error_model": "numpy"}
    mark = cfunc(types.int64(*words), **options)
    code = _make(module, name, lambda: mark(getattr(module, name)))
    _lasting.append(code)
    address: int = code.address
    return address


CALLED = "called_"

_lasting: list[object] = []
"""Keeps the callbacks' machine code alive."""


def _make(module: ModuleType, name: str, make: Callable[[], Any]) -> Any:
    path = Path(str(module.__file__))
    kept = _KeptCode(path, path.parent / "__pycache__")
    with _usable(path.parent):
        if kept.is_whole(name):
            return make()
        with _alone(path, name), kept.writing():
            if not kept.is_whole(name):
                _say(
                    f"compiling {name} for this machine: once, up to a minute"
                    f" (kept in {path.parent})"
                )
            return make()


@contextmanager
def _alone(path: Path, name: str) -> Generator[None]:
    with (path.parent / "lock").open("a") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            _say(f"another process compiles kernels: waiting for it before {name}, up to a minute")
            fcntl.flock(file, fcntl.LOCK_EX)
        yield


def _say(sentence: str) -> None:
    sys.stderr.write(f"topo-verify: {sentence}\n")
    sys.stderr.flush()


_TYPES = {
    "WordTable": "int64[:, ::1]",
    "WordCube": "int64[:, :, ::1]",
    "int": "int64",
}


def _signature(function: Callable[..., object]) -> str:
    notes = [note for name, note in function.__annotations__.items() if name != "return"]
    return f"({', '.join(_TYPES.get(note, 'int64[::1]') for note in notes)},)"


@cache
def machine_code(layout: WordLayout, checked: bool) -> ModuleType:  # noqa: FBT001  the key of the cache
    extras.require("fast")
    name = f"kernels_{layout.name}{'_checked' if checked else ''}"
    source = module_source(layout, checked=checked)
    module = sys.modules[name] = ModuleType(name)
    module.__file__ = str(_stored(name, source))
    # The file tells numba where its machine code lies.
    exec(compile(source, module.__file__, "exec"), module.__dict__)  # noqa: S102  our own kernels
    return module


def module_source(layout: WordLayout, *, checked: bool = False) -> str:
    numbers: dict[str, int] = {}
    functions: list[ast.FunctionDef] = []
    for name in layout.sources or SOURCES:
        module = import_module(name)
        numbers.update(_constants(module))
        functions += _kernels(module)
    numbers.update(layout.constants)
    names = [function.name for function in functions]
    assert len(set(names)) == len(names), f"two kernels of one name: {sorted(names)}"
    used = {node.id for f in functions for node in ast.walk(f) if isinstance(node, ast.Name)}
    options = f"boundscheck={checked}, _nrt={checked}, error_model='numpy'"
    lines = ["import numpy as np", "from numba import njit", ""]
    lines += [f"from {__package__}.native_call import call_address, row_at", ""]
    inner = f"{options}, no_cpython_wrapper=True, no_cfunc_wrapper=True"
    lines += [f"kernel = njit({inner})", f"inlined = njit(forceinline=True, {inner})"]
    lines += [f"entry = njit(cache=True, {options})", ""]
    lines += [f"{name} = {number}" for name, number in numbers.items() if name in used]
    lines += [f"\n{ast.unparse(ast.fix_missing_locations(function))}" for function in functions]
    return "\n".join(lines) + "\n"


def _constants(module: ModuleType) -> Mapping[str, int]:
    numbers = {k: v for k, v in vars(module).items() if k.isupper() and type(v) is int}
    for laid_out in vars(module).values():
        if isinstance(laid_out, Fields):
            numbers.update(laid_out.constants())
    return numbers


def _kernels(module: ModuleType) -> Iterator[ast.FunctionDef]:
    for node in ast.parse(Path(str(module.__file__)).read_text()).body:
        if isinstance(node, ast.FunctionDef) and any(
            isinstance(mark, ast.Name) and mark.id in ("kernel", "inlined", "entry", "callback")
            for mark in node.decorator_list
        ):
            is_callback = ast.unparse(node.decorator_list[0]) == "callback"
            if is_callback:
                node.decorator_list = [ast.Name("kernel", ast.Load())]
            node = Flat(vars(module)).visit_FunctionDef(node)
            node.returns = None
            for argument in node.args.args:
                argument.annotation = None
            if ast.get_docstring(node) is not None:
                del node.body[0]
            yield _Unsigned().visit(node)
            if is_callback:
                yield _called(node)


def _called(kernel: ast.FunctionDef) -> ast.FunctionDef:
    given = ", ".join(argument.arg for argument in kernel.args.args[1:])
    called = f"{kernel.name}(row_at(place, SIZE), {given})"
    (node,) = ast.parse(f"def {CALLED}{kernel.name}(place, {given}): return {called}").body
    assert isinstance(node, ast.FunctionDef)
    return node


class _Unsigned(ast.NodeTransformer):
    """Makes `W[at]` into `W[np.uint64(at)]`."""

    def visit_Subscript(self, node: ast.Subscript) -> ast.Subscript:
        self.generic_visit(node)
        if isinstance(node.slice, ast.Tuple):
            node.slice.elts = [_unsigned(index) for index in node.slice.elts]
        else:
            node.slice = _unsigned(node.slice)
        return node


def _unsigned(index: ast.expr) -> ast.expr:
    return ast.Call(ast.parse("np.uint64", mode="eval").body, [index], [])


def _stored(name: str, source: str) -> Path:
    llvm = import_module("llvmlite.binding")
    made_by = f"{version('numba')} {version('llvmlite')} {platform.python_version()}"
    made_by += f" {platform.machine()} {llvm.get_host_cpu_name()}"
    made_by += f" {llvm.get_host_cpu_features().flatten()}"
    key = sha256(f"{source}\n{made_by}".encode()).hexdigest()[:24]
    folder = cache_folder() / key
    path = folder / f"{name}.py"
    with _usable(folder):
        (folder / "__pycache__").mkdir(parents=True, exist_ok=True)
        if not _holds(path, source):
            with _alone(path, name):
                if path.exists() and not _holds(path, source):
                    _say(f"{path} is damaged: writing it again")
                _write(path, source)
                # numba discards code when its source is newer, so every copy gets the same mtime.
                os.utime(path, (0, 0))
    return path


def _holds(path: Path, text: str) -> bool:
    return path.exists() and path.read_bytes() == text.encode()


def _write(path: Path, text: str) -> None:
    with tempfile.NamedTemporaryFile(
        "w", dir=path.parent, prefix=f"{path.name}.", suffix=".new", delete=False, encoding="utf-8"
    ) as file:
        try:
            file.write(text)
            file.close()
            Path(file.name).replace(path)
        except BaseException:
            Path(file.name).unlink(missing_ok=True)
            raise


@contextmanager
def _usable(folder: Path) -> Generator[None]:
    """Turn an OSError into an InputError that names the cache folder."""
    try:
        yield
    except OSError as error:
        raise InputError(
            f"the compiled engine keeps its machine code in {folder}, and that failed"
            f" ({error.strerror or error}): free some space there, remove the folder, or set"
            " TOPO_VERIFY_CACHE to another one"
        ) from error


class _KeptCode:
    """The machine code of one module, in numba's files, with checksums."""

    def __init__(self, path: Path, folder: Path) -> None:
        self._path, self._folder, self._module = path, folder, path.stem
        self._sums = folder / f"{path.stem}.sums"

    def is_whole(self, name: str) -> bool:
        """Is an entry's machine code there with its checksums?"""
        files, sums = self._files(name), self._known()
        index = any(file.suffix == ".nbi" for file in files)
        try:
            return index and all(sums.get(file.name) == self._sum(file) for file in files)
        except FileNotFoundError:
            return False

    @contextmanager
    def writing(self) -> Generator[None]:
        """Write files, after removing those without a checksum.

        One entry's code may contain another's, so this covers the whole module.
        """
        damaged = self._clear()
        if damaged:
            _say(
                f"{damaged} of the files with machine code in {self._folder} are damaged or of"
                " another version: compiling it again"
            )
        try:
            yield
        except BaseException:
            self._clear()
            raise
        lines = [f"{self._sum(file)}  {file.name}\n" for file in self._files()]
        _write(self._sums, "".join(lines))

    def _clear(self) -> int:
        sums = self._known()
        damaged = [file for file in self._files() if sums.get(file.name) != self._sum(file)]
        partial = [
            *self._folder.glob(f"{self._module}.*.tmp.*"),
            *self._folder.glob(f"{self._module}.*.new"),
            *self._path.parent.glob(f"{self._module}.*.new"),
        ]
        for file in (*damaged, *partial):
            file.unlink()
        return len(damaged)

    def _files(self, name: str = "*") -> list[Path]:
        return sorted(self._folder.glob(f"{self._module}.{name}-*.nb[ic]"))

    def _sum(self, file: Path) -> str:
        return sha256(
            f"{self._path.parent.name} {file.name}\n".encode() + file.read_bytes()
        ).hexdigest()

    def _known(self) -> dict[str, str]:
        if not self._sums.exists():
            return {}
        lines = self._sums.read_text(encoding="utf-8", errors="replace").split("\n")
        return {name: known for known, _, name in (line.partition("  ") for line in lines)}


@cache
def cache_folder() -> Path:
    folder = _wanted_folder()
    if folder is None:
        why = "no home folder is known"
    else:
        why = f"{folder} cannot be used"
        try:
            folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        except OSError as error:
            why += f" ({error.strerror})"
        else:
            # Another user may have filled the folder with machine code.
            if folder.stat().st_uid != os.getuid():
                why += " (it belongs to another user)"
            elif os.access(folder, os.W_OK):
                return folder
            else:
                why += " (it is read-only)"
    _say(
        f"compiled kernels are kept for this process alone, for {why}; set TOPO_VERIFY_CACHE to a"
        " folder that can be written"
    )
    return Path(_lasting_folder().name)


def _wanted_folder() -> Path | None:
    asked = os.environ.get("TOPO_VERIFY_CACHE")
    if asked:
        return Path(asked).absolute() / "compiled"
    base = Path(os.environ.get("XDG_CACHE_HOME", ""))
    if not base.is_absolute():
        home = Path(os.environ.get("HOME", ""))
        try:
            home = home if home.is_absolute() else Path(getpwuid(os.getuid()).pw_dir)
        except KeyError:
            return None
        base = home / ".cache"
    return base / "topo-verify" / "compiled"


@cache
def _lasting_folder() -> Any:
    return tempfile.TemporaryDirectory(prefix="topo-verify-", ignore_cleanup_errors=True)
