"""What a process has loaded: files by their hashes, distributions by their versions, values."""

from __future__ import annotations

import functools
import hashlib
import subprocess
import sys
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import msgspec
import pytest

from topo_verify.programs import loaded
from topo_verify.programs.loaded import Loaded


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


PROBE = """
import sys
import msgspec
from topo_verify.programs import loaded
loaded.watch()
exec(open("deed.py").read())
sys.stdout.buffer.write(msgspec.json.encode(loaded.loaded()))
"""


def after(folder: Path, deed: str) -> Loaded:
    """What a process has loaded in which this was done."""
    (folder / "deed.py").write_text(deed)
    done = subprocess.run([sys.executable, "-c", PROBE], capture_output=True, check=True)
    return msgspec.json.decode(done.stdout, type=Loaded)


def test_files_that_are_imported_or_read_count_and_others_do_not(folder: Path) -> None:
    for name in ("read", "rewritten", "written", "untouched", "opened", "by_bytes", "library"):
        (folder / name).write_text(name)
    (folder / "__pycache__").mkdir()
    (folder / "__pycache__" / "near.pyc").write_text("")
    (folder / "base").write_text("")
    (folder / "near.py").write_text("import json, networkx")
    found = after(
        folder,
        "import os, near\n"
        "open('read').read()\n"
        "open('rewritten', 'w+').read()\n"
        "open('written', 'a').write('x')\n"
        "os.read(os.open('opened', os.O_RDONLY), 9)\n"
        "open(b'by_bytes').close()\n"
        "open(0).close()\n"
        "open(os.devnull).close()\n"
        "import ctypes\n"
        "try: ctypes.CDLL('./library')\n"
        "except OSError: pass\n"
        "import sqlite3\n"
        "sqlite3.connect('base').close()\n"
        "open('__pycache__/near.pyc').close()\n",
    )
    names = {Path(path).name for path in found.files}
    assert names == {"deed.py", "near.py", "read", "opened", "by_bytes", "library", "base"}
    (hashed,) = (made for path, made in found.files.items() if path == str(folder / "read"))
    assert hashed == hashlib.sha256(b"read").hexdigest()
    assert found.distributions.keys() >= {"msgspec", "networkx"}


HAS_SETUPTOOLS = find_spec("setuptools") is not None


@pytest.mark.skipif(not HAS_SETUPTOOLS, reason="setuptools is not installed")
def test_what_every_python_imports_at_its_start_does_not_count(folder: Path) -> None:
    assert "setuptools" not in after(folder, "import _distutils_hack").distributions
    assert "setuptools" in after(folder, "import setuptools").distributions


def test_files_of_distributions_are_not_the_users_wherever_they_are_installed() -> None:
    assert loaded.is_users("/home/me/mapper.py")
    assert not loaded.is_users("/home/me/.local/lib/site-packages/networkx/graph.py")
    assert not loaded.is_users("/usr/lib/python3/dist-packages/networkx/graph.py")


def test_to_watch_again_begins_anew(folder: Path) -> None:
    (folder / "read").write_text("")
    loaded.watch()
    (folder / "read").read_text()
    assert str(folder / "read") in loaded.loaded().files
    loaded.watch()
    assert str(folder / "read") not in loaded.loaded().files


def test_a_hash_is_that_of_the_file_as_it_is_now(folder: Path) -> None:
    (folder / "data").write_text("one")
    one = loaded.file_hash(str(folder / "data"))
    assert one == loaded.file_hash(str(folder / "data"))
    (folder / "data").write_text("two")
    assert loaded.file_hash(str(folder / "data")) != one
    assert loaded.file_hash(str(folder)) is None
    assert loaded.hashes(["data", "none"]) == {
        str(folder / "data"): hashlib.sha256(b"two").hexdigest()
    }


# ---------------------------------------------------------------- values


class Made:
    def __init__(self, **what: object) -> None:
        self.__dict__.update(what)

    def method(self, _robot: object) -> None: ...


def closing_over(value: object) -> Callable[[object], object]:
    return lambda _robot: value


def defaulting_to(value: object) -> Callable[..., object]:
    def mapper(_robot: object, was: object = value) -> object:
        return was

    return mapper


def by_keyword(value: object) -> Callable[..., object]:
    def mapper(_robot: object, *, was: object = value) -> object:
        return was

    return mapper


def partly(value: object) -> Callable[..., object]:
    return functools.partial(closing_over, value=value)


def bound(value: object) -> object:
    return Made(value=value).method


def made_of(value: object) -> object:
    return Made(x=[value])


WAYS = (closing_over, defaulting_to, by_keyword, partly, bound, made_of)


@pytest.mark.parametrize("way", WAYS)
def test_what_a_mapper_is_made_with_counts(way: Callable[[object], Any]) -> None:
    made = [True, False, 1, 1.0, "1", b"1", None, (1,), [1], {1}, {1: 2}, {"a", "b"}, int, len, sys]
    hashes = [loaded.values_hash(way(value)) for value in made]
    assert len(set(hashes)) == len(made)
    assert hashes == [loaded.values_hash(way(value)) for value in made]


def test_code_counts() -> None:
    made: list[Callable[[str], object]] = [
        lambda _text: 1,
        lambda _text: 2,
        lambda text: text.upper(),
        lambda text: text.lower(),
    ]
    assert len({loaded.values_hash(one) for one in made}) == len(made)


def test_the_order_in_which_a_set_was_filled_does_not_count() -> None:
    one, other = {0, 8}, {8, 0}
    assert list(one) != list(other)  # for both have the same place in its table
    assert loaded.values_hash(one) == loaded.values_hash(other)


def test_values_in_a_circle_and_too_many_of_them_have_an_end(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    circle: list[object] = []
    circle.append(circle)
    assert loaded.values_hash(circle) == loaded.values_hash(circle)
    monkeypatch.setattr(loaded, "MOST_VALUES", 10)
    assert loaded.values_hash([[n] for n in range(100)]) == loaded.values_hash(
        [[n] for n in range(50)] + [[-n] for n in range(50)]
    )


def test_an_empty_cell_is_no_obstacle() -> None:
    def inner() -> object:
        return later

    before = loaded.values_hash(inner)
    later = 1
    assert before != loaded.values_hash(inner)
