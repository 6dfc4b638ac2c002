"""From the sources of the kernels to machine code, and the cache of it."""

from __future__ import annotations

import ast
import fcntl
import os
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from functools import partial
from itertools import islice
from pathlib import Path
from types import SimpleNamespace

import pytest

from topo_verify import worlds
from topo_verify.errors import InputError
from topo_verify.extra.fast.kernels import exploration, kernel
from topo_verify.extra.fast.kernels import workspace as ws
from topo_verify.extra.fast.kernels.events import digest
from topo_verify.extra.fast.kernels.explore import KERNELS, place_world, run_world, workspace
from topo_verify.extra.fast.kernels.kernel import compiled, module_source
from topo_verify.extra.fast.kernels.names import Words


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


def plant_another_version(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let `digest` return 1 more."""
    changed = module_source(ws.SMALL).replace("return h", "return h + 1")

    def source(_layout: ws.WordLayout, *, checked: bool) -> str:
        assert not checked
        return changed

    monkeypatch.setattr(kernel, "module_source", source)


@pytest.mark.long
def test_every_index_is_unsigned() -> None:
    functions = [
        n for n in ast.parse(module_source(ws.SMALL)).body if isinstance(n, ast.FunctionDef)
    ]
    slices = [n.slice for f in functions for n in ast.walk(f) if isinstance(n, ast.Subscript)]
    slices = [i for one in slices for i in (one.elts if isinstance(one, ast.Tuple) else [one])]
    assert slices
    assert {ast.unparse(one).partition("(")[0] for one in slices} == {"np.uint64"}


@pytest.mark.long
def test_every_layout_has_its_own_constants() -> None:
    sources = {one.name: module_source(one) for one in (ws.SMALL, ws.FAULTY, ws.LARGE)}
    for one in (ws.SMALL, ws.FAULTY, ws.LARGE):
        assert f"\nW_TRACE_WORD = {one.at('trace.word')}\n" in sources[one.name]
    assert "\nFAULTS = 0\n" in sources["small"]
    assert "\nFAULTS = 1\n" in sources["faulty"]


def test_a_view_has_the_places_of_the_small_layout() -> None:
    trace = ws.RunWords(kernel_words(1)).trace
    assert ws.SMALL.at("trace.word") == trace.place_of("word")
    assert ws.SMALL.at("trace.size") == trace.place_of("size")


def test_no_two_fields_share_a_word() -> None:
    spread = ws.layout("spread", {}, gap=2)
    offsets = [spread.at(field.name) for field in ws.RUN.all]
    assert offsets == list(range(0, 3 * len(ws.RUN.all), 3))


@pytest.mark.long
def test_machine_code_is_kept_and_found_again(
    cache: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    compiled(digest, ws.SMALL)
    assert "compiling digest for this machine" in capsys.readouterr().err
    (folder,) = cache.iterdir()
    written = {path.name: path.stat().st_mtime_ns for path in (folder / "__pycache__").iterdir()}
    forget()
    compiled(digest, ws.SMALL)
    assert capsys.readouterr().err == ""
    assert (
        written.items()
        <= {
            path.name: path.stat().st_mtime_ns for path in (folder / "__pycache__").iterdir()
        }.items()
    )


@pytest.mark.long
def test_processes_do_not_compile_the_same_kernels_at_the_same_time(cache: Path) -> None:
    code = (
        "from topo_verify.extra.fast.kernels.events import digest\n"
        "from topo_verify.extra.fast.kernels.kernel import compiled\n"
        "from topo_verify.extra.fast.kernels.workspace import SMALL\n"
        "compiled(digest, SMALL)"
    )
    path = Path(str(kernel.machine_code(ws.SMALL, checked=False).__file__))  # written, not compiled
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


@pytest.mark.long
def test_a_change_in_any_kernel_is_a_change_of_all_machine_code(
    cache: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    compiled(digest, ws.SMALL)
    forget()
    plant_another_version(monkeypatch)
    compiled(digest, ws.SMALL)
    assert len(list(cache.iterdir())) == 2


# ---------------------------------------------------------------- damaged caches


TRACE = [3, 5, 7]


def digest_of_trace() -> int:
    """What the machine code of `digest` makes of a trace, as a fresh process would load it."""
    forget()
    words = kernel_words(len(TRACE))
    trace = ws.RunWords(words).trace
    trace.size = len(TRACE)
    for place, word in enumerate(TRACE):
        trace.word[place] = word
    return int(compiled(digest, ws.SMALL)(words))


@pytest.fixture(scope="module")
def filled(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A cache with the machine code of `digest`, and of a version that returns 1 more."""
    folder = tmp_path_factory.mktemp("filled")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("TOPO_VERIFY_CACHE", str(folder))
        true = digest_of_trace()
        plant_another_version(patch)
        assert digest_of_trace() == true + 1
    forget()
    return folder / "compiled"


@pytest.fixture
def kept(cache: Path, filled: Path) -> Path:
    """The folder with the machine code of `digest` in a cache for this test."""
    shutil.copytree(filled, cache)
    return Path(str(kernel.machine_code(ws.SMALL, checked=False).__file__)).parent


def another_version(kept: Path) -> Path:
    (folder,) = (one for one in kept.parent.iterdir() if one != kept)
    return folder


def flipped(kept: Path, suffix: str) -> None:
    (file,) = (kept / "__pycache__").glob(f"*.{suffix}")
    data = bytearray(file.read_bytes())
    data[len(data) // 2] ^= 1
    file.write_bytes(data)


def copy_code(kept: Path) -> None:
    (file,) = (another_version(kept) / "__pycache__").glob("*.nbc")
    shutil.copy(file, kept / "__pycache__")


def copy_all(kept: Path) -> None:
    shutil.copytree(another_version(kept), kept, dirs_exist_ok=True)


def remove_sums(kept: Path) -> None:
    (file,) = (kept / "__pycache__").glob("*.sums")
    file.unlink()


FLIPS = [partial(flipped, suffix=suffix) for suffix in ("nbc", "nbi", "sums")]


@pytest.mark.nightly
@pytest.mark.parametrize("damage", [*FLIPS, copy_code, copy_all, remove_sums])
def test_damaged_machine_code_is_compiled_again_with_a_warning(
    damage: Callable[[Path], None], kept: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    true = digest_of_trace()
    assert capsys.readouterr().err == ""
    damage(kept)
    assert digest_of_trace() == true
    warning = capsys.readouterr().err
    assert f"in {kept}/__pycache__ are damaged or of another version: compiling it again" in warning
    assert digest_of_trace() == true
    assert capsys.readouterr().err == ""


@pytest.mark.long
def test_the_source_in_the_cache_is_not_believed(
    kept: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    true = digest_of_trace()
    source = kept / "kernels_small.py"
    text = source.read_text()
    source.write_text(text.replace("return h", "return h + 1"))
    assert digest_of_trace() == true
    assert f"{source} is damaged: writing it again" in capsys.readouterr().err
    assert source.read_text() == text


@pytest.mark.long
def test_what_an_interrupted_process_left_is_removed(kept: Path) -> None:
    code = kept / "__pycache__"
    left = [kept / "kernels_small.py.x.new", code / "kernels_small.sums.y.new"]
    left.append(code / "kernels_small.digest-9.py311.nbi.tmp.0123456789abcdef")
    for file in left:
        file.touch()
    remove_sums(kept)
    digest_of_trace()
    assert not [file for file in left if file.exists()]


LIMITED = (
    "import resource\n"
    "from topo_verify.extra.fast.kernels.events import digest\n"
    "from topo_verify.extra.fast.kernels.kernel import compiled\n"
    "from topo_verify.extra.fast.kernels.workspace import SMALL\n"
    "from topo_verify.errors import InputError\n"
    "import numba\n"
    "resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))\n"
    "try:\n"
    "    compiled(digest, SMALL)\n"
    "except InputError as error:\n"
    "    print(error)\n"
)
"""A process that compiles a kernel, and whose files may have 1,000 bytes, as on a full disk."""


@pytest.mark.nightly
@pytest.mark.parametrize("written", ["nothing", "the source"])
def test_a_full_disk_is_an_error_that_names_the_folder_and_leaves_nothing(
    written: str, cache: Path
) -> None:
    if written == "the source":
        kernel.machine_code(ws.SMALL, checked=False)
    done = subprocess.run(
        [sys.executable, "-c", LIMITED], capture_output=True, text=True, check=False
    )
    assert f"the compiled engine keeps its machine code in {cache}" in done.stdout, done.stderr
    assert "(File too large): free some space there" in done.stdout
    files = {file.name for file in cache.rglob("*") if file.is_file()}
    assert files <= {"lock", "kernels_small.py"}


@pytest.mark.long
def test_a_damaged_folder_is_an_error_that_names_it(kept: Path) -> None:
    shutil.rmtree(kept / "__pycache__")
    (kept / "__pycache__").touch()
    with pytest.raises(InputError, match=rf"machine code in {kept}, .*remove the folder"):
        digest_of_trace()


# ---------------------------------------------------------------- where the cache is


@pytest.fixture
def homes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """No variable names a cache; the user's home is here."""
    for name in ("TOPO_VERIFY_CACHE", "XDG_CACHE_HOME"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("HOME", str(tmp_path))

    def user(_number: int) -> SimpleNamespace:
        return SimpleNamespace(pw_dir=tmp_path / "pw")

    monkeypatch.setattr(kernel, "getpwuid", user)
    monkeypatch.chdir(tmp_path)
    forget()
    yield tmp_path
    forget()


@pytest.mark.parametrize(
    ("variables", "folder"),
    [
        ({}, ".cache/topo-verify"),
        ({"HOME": ""}, "pw/.cache/topo-verify"),
        ({"HOME": "relative"}, "pw/.cache/topo-verify"),
        ({"XDG_CACHE_HOME": ""}, ".cache/topo-verify"),
        ({"XDG_CACHE_HOME": "relative"}, ".cache/topo-verify"),
        ({"TOPO_VERIFY_CACHE": "relative"}, "relative"),
    ],
)
def test_an_empty_or_relative_home_is_ignored(
    variables: dict[str, str], folder: str, homes: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name, value in variables.items():
        monkeypatch.setenv(name, value)
    assert kernel.cache_folder() == homes / folder / "compiled"


def test_without_any_home_the_cache_lasts_as_long_as_the_process(
    homes: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def unknown(user: int) -> object:
        raise KeyError(user)

    monkeypatch.setenv("HOME", "")
    monkeypatch.setattr(kernel, "getpwuid", unknown)
    assert homes not in kernel.cache_folder().parents
    assert "for no home folder is known; set TOPO_VERIFY_CACHE" in capsys.readouterr().err


def is_read_only(_path: Path, mode: int) -> bool:
    return mode != os.W_OK


def test_a_folder_that_cannot_be_written_is_replaced_for_as_long_as_the_process_lasts(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "file").touch()
    for name, why in (("file", "(Not a directory)"), ("read-only", "(it is read-only)")):
        monkeypatch.setenv("TOPO_VERIFY_CACHE", str(tmp_path / name))
        monkeypatch.setattr("os.access", is_read_only)
        forget()
        folder = kernel.cache_folder()
        forget()
        assert folder.is_dir()
        assert tmp_path not in folder.parents
        assert f"{tmp_path / name}/compiled cannot be used {why}; set" in capsys.readouterr().err


@pytest.mark.usefixtures("cache")
def test_a_checked_kernel_sees_an_index_out_of_range() -> None:
    words = kernel_words(3)
    ws.RunWords(words).trace.size = 1 << 40
    with pytest.raises(IndexError, match="out of bounds"):
        compiled(digest, ws.SMALL, checked=True)(words)


def kernel_words(length: int) -> Words:
    """A workspace with so many words of trace."""
    return workspace(ws.SMALL, length)


class Strict(list[int]):
    """A workspace that refuses a negative index, as kernels never use one."""

    def __getitem__(self, at: int) -> int:  # type: ignore[override]  # pyright: ignore[reportIncompatibleMethodOverride]
        assert at >= 0
        return super().__getitem__(at)


@pytest.mark.parametrize("name", KERNELS)
def test_kernels_run_as_plain_functions_and_use_no_negative_index(name: str) -> None:
    for world in islice(worlds(edges=4), 0, None, 25):
        space = workspace(ws.SMALL, 4096)
        place_world(space, ws.SMALL, world)
        run = ws.RunWords(Strict(space.tolist()))
        run.task.rule, run.task.motion = KERNELS[name]
        run.task.budget, run.task.tracing, run.task.room = world.cost_bound, 1, 4096
        exploration.explore(run)
        trace = tuple(run.trace.word[i] for i in range(run.trace.size))
        assert trace == run_world(world, name, trace=True).trace
