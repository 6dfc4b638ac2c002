"""TARGET: a mapper by its name in the catalogue, in a module, or in a file."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Callable, Generator
from functools import partial
from pathlib import Path
from typing import Any

import pytest

from tests.helpers import SURE
from topo_verify import CATALOGUE, Algorithm, InputError, Robot, World
from topo_verify.algorithms import Policies
from topo_verify.algorithms.motion import retrace
from topo_verify.algorithms.rules import NoRule, PrefixRule
from topo_verify.campaign.targets import one_target, targets
from topo_verify.programs.loader import Mapper, Target
from topo_verify.robot.simulator import SimulatedRobot


def mine(_robot: Robot) -> object:
    """A mapper of one's own."""
    return None


class Mappers:
    """Mappers inside a class, and what is none."""

    deep = CATALOGUE["basic"].with_policies(pick="last")
    number = 7

    @staticmethod
    def inner(_robot: Robot) -> object:
        return None

    def __call__(self, _robot: Robot) -> object:
        return None


MADE = Mappers()
LAMBDAS: list[Mapper] = [lambda _: None]
PARTIAL = partial(mine)
PARTIAL.__module__ = __name__


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Generator[Path]:
    """An empty folder to stand in, in a Python that forgets what it imported there."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", [p for p in sys.path if p])
    before = set(sys.modules)
    yield tmp_path
    for name in set(sys.modules) - before:
        del sys.modules[name]


def test_a_catalogue_name_is_a_target() -> None:
    assert targets("enhancement-ii+i") == (
        Target("enhancement-ii+i", CATALOGUE["enhancement-ii+i"]),
    )


def test_several_names_stand_with_commas_in_their_order() -> None:
    assert [t.text for t in targets("enhancement-ii, basic")] == ["enhancement-ii", "basic"]


def test_all_means_whatever_is_right_in_every_world_in_the_order_of_the_catalogue() -> None:
    assert [t.text for t in targets("all")] == SURE


def test_a_list_takes_files_and_all(folder: Path) -> None:
    (folder / "mine.py").write_text("def f(robot): ...\n")
    assert [t.text for t in targets("mine.py:f, basic")] == ["mine.py:f", "basic"]
    assert [t.text for t in targets("all,mine.py:f")] == [*SURE, "mine.py:f"]
    assert [t.text for t in targets(",".join(["mine.py:f"] * 99))] == ["mine.py:f"] * 99


def test_a_command_is_not_divided_at_its_commas() -> None:
    (target,) = targets("--cmd ./mapper --only a,b")
    assert target.text == "--cmd ./mapper --only a,b"


@pytest.mark.parametrize("text", ["", "Basic", "basic,", "basic,nobody", "all,nobody"])
def test_an_unknown_name_is_refused_with_the_list_and_the_other_forms(text: str) -> None:
    with pytest.raises(InputError, match=r"there are basic, .* and all; .* path/file.py:attribute"):
        targets(text)


def test_an_attribute_of_a_module_is_a_target() -> None:
    assert targets("tests.campaign.test_targets:mine") == (
        Target("tests.campaign.test_targets:mine", mine),
    )
    (found,) = targets("tests.campaign.test_targets:Mappers.inner")
    assert found.mapper is Mappers.inner


def test_a_function_in_a_file_is_a_target_and_finds_its_neighbours(folder: Path) -> None:
    (folder / "sub").mkdir()
    (folder / "sub" / "neighbour.py").write_text("ANSWER = 42\n")
    (folder / "sub" / "mapper.py").write_text(
        "from neighbour import ANSWER\ndef explore(robot):\n    return ANSWER\n"
    )
    found = one_target("sub/mapper.py:explore")
    assert found.text == "sub/mapper.py:explore"
    assert found.mapper(robot()) == 42


def robot() -> SimulatedRobot:
    """A robot, for mappers that do not look at it."""
    return SimulatedRobot(World.from_id("m1/0"), 0)


def test_a_file_may_hold_dataclasses_and_is_read_anew_each_time(folder: Path) -> None:
    file = folder / "mapper.py"
    for answer in (1, 2):
        file.write_text(
            "from __future__ import annotations\nfrom dataclasses import dataclass\n"
            "@dataclass\nclass Answer:\n    value: int\n"
            f"def explore(robot): return Answer({answer}).value + {answer * 100}\n"
        )
        assert one_target("mapper.py:explore").mapper(robot()) == answer * 101


def test_a_module_in_the_folder_where_the_user_stands_is_found(folder: Path) -> None:
    (folder / "lonely_mapper_module.py").write_text("def explore(robot): return 5\n")
    assert one_target("lonely_mapper_module:explore").mapper(robot()) == 5


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("no.such.module:mapper", "cannot import 'no.such.module': ModuleNotFoundError"),
        (":mapper", "cannot import ''"),
        ("no/such/file.py:mapper", "there is no file 'no/such/file.py'"),
        (".py:mapper", "there is no file '.py'"),
        ("tests.campaign.test_targets:nobody", "has no attribute 'nobody'"),
        ("tests.campaign.test_targets:Mappers.nobody", "has no attribute 'Mappers.nobody'"),
        ("tests.campaign.test_targets:", "has no attribute ''"),
        ("tests.campaign.test_targets:Mappers.number", "expected a callable .*, got int"),
    ],
)
def test_what_is_not_there_is_refused_by_name(text: str, why: str) -> None:
    with pytest.raises(InputError, match=f"^target '{text}': .*{why}"):
        targets(text)


@pytest.mark.parametrize(
    ("source", "why"),
    [
        ("def explore(robot:\n", "SyntaxError"),
        ("raise ValueError('one\\ntwo')\n", r"ValueError: one\\ntwo \(mapper.py, line 1\)$"),
        ("\nimport sys; sys.exit(4)\n", r"SystemExit: 4 \(mapper.py, line 2\)$"),
        ("import no_such_module\n", r"ModuleNotFoundError: .* \(mapper.py, line 1\)$"),
        (
            "class E(Exception):\n    def __str__(self): raise ValueError\nraise E\n",
            r"mapper.py' fails: E \(mapper.py, line 3\)$",
        ),
        ("\x00", "SyntaxError|ValueError"),
    ],
)
def test_a_file_that_fails_is_refused_in_one_line(folder: Path, source: str, why: str) -> None:
    (folder / "mapper.py").write_text(source)
    with pytest.raises(InputError, match=why) as refused:
        targets("mapper.py:explore")
    assert "\n" not in str(refused.value)


def test_a_module_that_fails_is_refused_in_one_line(folder: Path) -> None:
    (folder / "broken_mapper_module.py").write_text("import sys; sys.exit('no')\n")
    with pytest.raises(
        InputError,
        match=r"'broken_mapper_module': SystemExit: no \(broken_mapper_module.py, line 1\)$",
    ):
        targets("broken_mapper_module:explore")


def test_policies_are_for_algorithms_of_the_catalogue() -> None:
    (found,) = targets("basic", pick="last", order="random(4)")
    assert getattr(found.mapper, "policies", None) == Policies("last", "random(4)")
    (kept,) = targets("tests.campaign.test_targets:Mappers.deep", order="newest")
    assert getattr(kept.mapper, "policies", None) == Policies("last", "newest")
    for mapper in (mine, "tests.campaign.test_targets:mine", Target("x", mine)):
        with pytest.raises(InputError, match="has no policies: leave out --pick and --order"):
            one_target(mapper, pick="last")


def test_of_several_mappers_those_with_policies_get_them() -> None:
    own, basic = targets("tests.campaign.test_targets:mine,basic", pick="last")
    assert own.mapper is mine
    assert getattr(basic.mapper, "policies", None) == Policies("last", "shortest")


@pytest.mark.parametrize("choice", [{"pick": "far"}, {"order": "far"}])
def test_an_unknown_policy_is_refused_as_input(choice: dict[str, Any]) -> None:
    with pytest.raises(InputError, match="policy 'far': there are"):
        targets("all", **choice)


def test_one_target_is_one() -> None:
    with pytest.raises(InputError, match=f"'all' names {len(SURE)} mappers: name one"):
        one_target("all")
    target = Target("mine", mine)
    assert one_target(target) is target


@pytest.mark.parametrize("mapper", [7, None, ["basic"]])
def test_what_cannot_be_called_is_no_mapper(mapper: Any) -> None:
    with pytest.raises(InputError, match="expected a callable that takes a robot"):
        one_target(mapper)


@pytest.mark.parametrize(
    ("mapper", "text"),
    [
        (mine, "tests.campaign.test_targets:mine"),
        (Mappers.inner, "tests.campaign.test_targets:Mappers.inner"),
        (Mappers(), "tests.campaign.test_targets:<Mappers()>"),
        (MADE, "tests.campaign.test_targets:MADE"),
        (PARTIAL, "tests.campaign.test_targets:PARTIAL"),
        (partial(mine), "functools:<partial()>"),
        (Mappers().__call__, "tests.campaign.test_targets:<Mappers.__call__>"),
        (LAMBDAS[0], "tests.campaign.test_targets:<lambda>"),
        (CATALOGUE["basic"].with_policies(pick="last"), "basic"),
        (Algorithm("basic", PrefixRule, retrace), "<basic>"),
        (Algorithm("other", NoRule, retrace), "<other>"),
        (CATALOGUE["basic"], "basic"),
        (Mappers.deep, "basic"),
        (NoRule, "topo_verify.algorithms.rules:NoRule"),
    ],
)
def test_a_callable_is_called_by_the_text_that_finds_it(
    mapper: Callable[[Robot], object], text: str
) -> None:
    assert one_target(mapper).text == text


def test_a_module_that_other_programs_do_not_find_is_called_by_its_file(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As pytest finds test files: their folder is on its path and on no other program's."""
    (folder / "tests").mkdir()
    (folder / "tests" / "test_mine.py").write_text("def mine(robot): ...")
    monkeypatch.setattr(sys, "path", [str(folder / "tests"), *sys.path])
    mapper = importlib.import_module("test_mine").mine
    assert one_target(mapper).text == "tests/test_mine.py:mine"
    monkeypatch.setenv("PYTHONPATH", str(folder / "tests"))
    assert one_target(mapper).text == "test_mine:mine"
    monkeypatch.delenv("PYTHONPATH")
    monkeypatch.chdir(folder / "tests")
    assert one_target(mapper).text == "test_mine:mine"
