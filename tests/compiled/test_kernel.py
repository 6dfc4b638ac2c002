"""From the sources of the kernels to machine code, and the cache of it."""

from __future__ import annotations

import ast
import fcntl
import subprocess
import sys
from collections.abc import Iterator
from itertools import islice
from pathlib import Path

import pytest

from topo_verify import worlds
from topo_verify.compiled import exploration, kernel
from topo_verify.compiled.events import digest
from topo_verify.compiled.explore import KERNELS, place_world, run_world, workspace
from topo_verify.compiled.kernel import compiled, module_source
from topo_verify.compiled.workspace import (
    BUDGET,
    FAULTY,
    FIELDS,
    LARGE,
    MOTION,
    NTR,
    ROOM,
    RULE,
    SMALL,
    TR,
    TRACING,
    WordLayout,
    layout,
)


def forget() -> None:
    """Forget what this process has loaded, as another process would know nothing of it."""
    kernel.cache_folder.cache_clear()
    kernel.machine_code.cache_clear()


@pytest.fixture
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """An empty cache for this test."""
    monkeypatch.setenv("TOPO_VERIFY_CACHE", str(tmp_path))
    forget()
    yield tmp_path / "compiled"
    forget()


def test_every_index_is_unsigned() -> None:
    functions = [n for n in ast.parse(module_source(SMALL)).body if isinstance(n, ast.FunctionDef)]
    slices = [n.slice for f in functions for n in ast.walk(f) if isinstance(n, ast.Subscript)]
    slices = [i for one in slices for i in (one.elts if isinstance(one, ast.Tuple) else [one])]
    assert slices
    assert {ast.unparse(one).partition("(")[0] for one in slices} == {"np.uint64"}


def test_every_layout_has_its_own_constants() -> None:
    sources = {one.name: module_source(one) for one in (SMALL, FAULTY, LARGE)}
    for one in (SMALL, FAULTY, LARGE):
        assert f"\nTR = {one.at('TR')}\n" in sources[one.name]
    assert "\nFAULTS = 0\n" in sources["small"]
    assert "\nFAULTS = 1\n" in sources["faulty"]


def test_the_constants_of_the_kernels_are_those_of_the_small_layout() -> None:
    assert SMALL.at("TR") == TR
    assert SMALL.at("NTR") == NTR


def test_no_two_fields_share_a_word() -> None:
    spread = layout("spread", {}, gap=2)
    offsets = [spread.at(field.name) for field in FIELDS]
    assert offsets == list(range(0, 3 * len(FIELDS), 3))


def test_machine_code_is_kept_and_found_again(
    cache: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    compiled(digest, SMALL)
    assert "compiling digest for this machine" in capsys.readouterr().err
    (folder,) = cache.iterdir()
    written = {path.name: path.stat().st_mtime_ns for path in (folder / "__pycache__").iterdir()}
    forget()
    compiled(digest, SMALL)
    assert capsys.readouterr().err == ""
    assert (
        written.items()
        <= {
            path.name: path.stat().st_mtime_ns for path in (folder / "__pycache__").iterdir()
        }.items()
    )


def test_processes_do_not_compile_the_same_kernels_at_the_same_time(cache: Path) -> None:
    code = (
        "from topo_verify.compiled.events import digest\n"
        "from topo_verify.compiled.kernel import compiled\n"
        "from topo_verify.compiled.workspace import SMALL\n"
        "compiled(digest, SMALL)"
    )
    path = Path(str(kernel.machine_code(SMALL, checked=False).__file__))  # written, not compiled
    assert path.parent.parent == cache
    with (path.parent / "lock").open("a") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        other = subprocess.Popen([sys.executable, "-c", code], stderr=subprocess.PIPE, text=True)
        assert other.stderr is not None
        assert "another process compiles kernels: waiting for it" in other.stderr.readline()
        assert not list(path.parent.glob("__pycache__/*.nbi"))
    with other:
        assert "compiling digest" in other.stderr.read()
    assert other.returncode == 0


def test_a_change_in_any_kernel_is_a_change_of_all_machine_code(
    cache: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    compiled(digest, SMALL)
    forget()
    changed = module_source(SMALL).replace("return h", "return h + 1")

    def source(_layout: WordLayout, *, checked: bool) -> str:
        assert not checked
        return changed

    monkeypatch.setattr(kernel, "module_source", source)
    compiled(digest, SMALL)
    assert len(list(cache.iterdir())) == 2


def test_a_folder_that_cannot_be_written_is_replaced_for_as_long_as_the_process_lasts(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").touch()
    monkeypatch.setenv("TOPO_VERIFY_CACHE", str(tmp_path / "file"))
    forget()
    folder = kernel.cache_folder()
    forget()
    assert folder.is_dir()
    assert tmp_path not in folder.parents


@pytest.mark.usefixtures("cache")
def test_a_checked_kernel_sees_an_index_out_of_range() -> None:
    words = kernel_words(3)
    words[NTR] = 1 << 40
    with pytest.raises(IndexError, match="out of bounds"):
        compiled(digest, SMALL, checked=True)(words)


def kernel_words(length: int) -> kernel.Words:
    """A workspace with so many words of trace."""
    return workspace(SMALL, length)


class Strict(list[int]):
    """A workspace that refuses a negative index, as kernels never use one."""

    def __getitem__(self, at: int) -> int:  # type: ignore[override]  # pyright: ignore[reportIncompatibleMethodOverride]
        assert at >= 0
        return super().__getitem__(at)


@pytest.mark.parametrize("name", KERNELS)
def test_kernels_run_as_plain_functions_and_use_no_negative_index(name: str) -> None:
    for world in islice(worlds(edges=4), 0, None, 25):
        space = workspace(SMALL, 4096)
        place_world(space, SMALL, world)
        plain = Strict(space.tolist())
        for place, word in (
            (RULE, KERNELS[name].rule),
            (MOTION, KERNELS[name].motion),
            (BUDGET, world.cost_bound),
            (TRACING, 1),
            (ROOM, 4096),
        ):
            plain[place] = word
        exploration.explore(plain)
        run = run_world(world, name, trace=True)
        assert tuple(plain[TR + i] for i in range(plain[NTR])) == run.trace
