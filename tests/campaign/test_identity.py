"""What a mapper rests on: a store is refused if any of it changes."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import pytest

from topo_verify import CATALOGUE, InputError
from topo_verify.campaign import identity
from topo_verify.campaign.backend import here as in_this_process
from topo_verify.campaign.backend import pooled
from topo_verify.campaign.identity import Identity, merged, named_files, require_equal, source_hash
from topo_verify.campaign.store import Store
from topo_verify.campaign.targets import targets
from topo_verify.programs.loaded import Loaded, hashes, watch
from topo_verify.studies.search.search import Search, search_campaign

MAPPER = """
import os, sys
sys.path.append(os.path.abspath("elsewhere"))
from functools import partial
from topo_verify import CATALOGUE
import aside

def explore(robot, right=True):
    with open("data.txt") as data:
        data.read()
    return CATALOGUE["basic"](robot)

def partly(robot, right):
    return explore(robot)

mine = partial(partly, right=aside.right)
"""


@pytest.fixture
def here(folder: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A mapper that imports a module of another folder and reads a file when it runs."""
    monkeypatch.setattr(sys, "path", [*sys.path])
    (folder / "elsewhere").mkdir()
    (folder / "elsewhere" / "aside.py").write_text("right = True\n")
    (folder / "data.txt").write_text("some data")
    (folder / "stranger.txt").write_text("")
    (folder / "mine.py").write_text(MAPPER)
    return folder


def searched(text: str = "mine.py:explore", *, workers: int = 0, depends: Any = ()) -> int:
    """A search with a store, as the command line does it; how many worlds the store had."""
    sys.modules.pop("aside", None)
    watch()
    mappers = targets(text)
    campaign = search_campaign(mappers, edges=1)
    now = Identity(mappers, depends).loaded()
    backend = pooled(workers, depends) if workers else in_this_process(mappers, depends=depends)
    with Store("search.db") as store:
        memory = store.campaign(campaign.identity(source_hash(mappers)), now)
        study = Search(campaign, mappers, backend, memory)
        study.work()
        return study.entry().from_ledger


@pytest.mark.parametrize(
    ("file", "words"),
    [
        ("mine.py", "the source of the mapper has changed since"),
        ("elsewhere/aside.py", r"elsewhere/aside\.py, which the mapper read, has changed; name an"),
        (
            "data.txt",
            r"data\.txt, which the mapper read, has changed; name another file or folder, or remov",
        ),
    ],
)
def test_a_store_is_refused_once_a_file_has_changed(here: Path, file: str, words: str) -> None:
    assert [searched(), searched()] == [0, 2]
    (here / "stranger.txt").write_text("changed")
    assert searched() == 2
    with (here / file).open("a") as opened:
        opened.write("# changed\n")
    with pytest.raises(InputError, match=words):
        searched()


def test_a_worker_says_what_it_read(here: Path) -> None:
    searched(workers=1)
    (here / "data.txt").unlink()
    with pytest.raises(InputError, match=r"data\.txt, which the mapper read, is gone"):
        searched()


def test_the_arguments_of_a_partial_count(here: Path) -> None:
    searched("mine.py:mine")
    file = here / "elsewhere" / "aside.py"
    file.write_text("import os\nright = not os.environ.get('WRONG')\n")
    (here / "search.db").unlink()
    searched("mine.py:mine")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("WRONG", "1")
        with pytest.raises(InputError, match="the mapper was made with other values"):
            searched("mine.py:mine")


def test_the_version_of_a_distribution_counts(here: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with (here / "mine.py").open("a") as opened:
        opened.write("import networkx\n")
    searched()

    def none(_name: str) -> None: ...

    monkeypatch.setattr(identity, "_version", none)
    with pytest.raises(InputError, match=r"the mapper used \w+ [\d.]+, installed is none; name an"):
        searched()


def test_a_file_that_a_mapper_depends_on_counts(here: Path) -> None:
    searched("basic", depends=["stranger.txt"])
    (here / "stranger.txt").write_text("changed")
    with pytest.raises(InputError, match=r"stranger\.txt, which the mapper read, has changed"):
        searched("basic", depends=["stranger.txt"])


# ---------------------------------------------------------------- what a TARGET names


def test_a_mapper_is_named_by_its_file_wherever_it_is(here: Path) -> None:
    (here / "far").mkdir()
    (here / "far" / "__init__.py").write_text("raise ZeroDivisionError")
    (here / "far" / "away.py").write_text("")
    assert named_files("mine.py:explore") == ["mine.py"]
    assert named_files("far.away:explore") == [str(here / "far" / "away.py")]
    assert named_files("far:explore") == [str(here / "far" / "__init__.py")]
    assert named_files("nowhere:explore") == named_files("nowhere.at:all") == []


def test_the_hash_of_a_program_is_that_of_the_files_that_its_command_names(here: Path) -> None:
    text = "--cmd sh mine.py --fast"
    assert named_files(text)[1:] == ["mine.py", "--fast"]
    before = source_hash(targets(text))
    assert before == source_hash(targets(text)) != source_hash(targets("--cmd sh"))
    assert Identity(targets(text)).loaded().files.keys() == hashes(named_files(text)).keys()
    (here / "mine.py").write_text("")
    assert before != source_hash(targets(text))


def test_algorithms_of_the_catalogue_share_the_hash_of_topo_verify() -> None:
    assert source_hash(targets("basic")) == source_hash(targets("folding"))
    assert Identity(targets("basic,folding")).loaded() == Loaded()
    assert CATALOGUE


# ---------------------------------------------------------------- several processes


def test_what_several_processes_loaded_is_put_together() -> None:
    one, other = Loaded({"a": "1"}, {"d": "1"}, "v"), Loaded({"b": "2"}, {"e": "2"})
    both = Loaded({"a": "1", "b": "2"}, {"d": "1", "e": "2"}, "v")
    assert merged(one, other, "here") == merged(other, one, "here") == both


@pytest.mark.parametrize(
    ("other", "words"),
    [
        (Loaded({"a": "2"}), "here: the mapper read a, which changed while the search ran: start"),
        (Loaded(values="w"), "here: the mapper is made with other values each time"),
    ],
)
def test_processes_that_loaded_other_things_are_refused(other: Loaded, words: str) -> None:
    with pytest.raises(InputError, match=words):
        merged(Loaded({"a": "1"}, {}, "v"), other, "here")


@pytest.mark.parametrize(
    ("there", "words"),
    [
        (Loaded(values="w"), "there: the mapper is made with other values there"),
        (Loaded({"nowhere.py": "1"}), "the mapper read nowhere.py, which is not a file here"),
        (Loaded({"mapper.py": "1"}), "the mapper read mapper.py, which is another file here"),
        (Loaded({}, {"msgspec": "0.1"}), "msgspec 0.1, installed here is [0-9.]*: install the"),
        (Loaded({}, {"no-such": "2"}), "used no-such 2, installed here is none"),
        (Loaded(modules={"m": "/b.py"}), "module m is /a.py in one process and /b.py in another"),
    ],
)
def test_what_another_machine_has_loaded_must_be_the_same_here(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, there: Loaded, words: str
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("mapper.py").write_text("x = 1\n")
    here = Loaded(hashes(["mapper.py"]), {}, "v", {"m": "/a.py"})
    require_equal(here, here, "there")
    require_equal(here, Loaded(hashes(["mapper.py"])), "there")
    with pytest.raises(InputError, match=words):
        require_equal(here, there, "there")
