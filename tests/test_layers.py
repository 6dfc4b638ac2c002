"""The rooms of the house: who may import whom, what loads when, and how long a file may get.

The table of floors is the design: a room imports rooms on lower floors and itself, nothing else.
Imports are read from the source, so a late import inside a function counts like any other. The
main house never imports an extra, and an extra imports the main house alone. How small the trusted
rooms stay is for test_trusted_size.py to say. What this does not show: names that
travel at run time (an object handed over, an import by a computed name); where that would undo a
promise, the means of doing it are forbidden below.
"""

from __future__ import annotations

import ast
import re
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest

from tests.python import python
from topo_verify import extras

ROOT = Path(__file__).resolve().parent.parent
PACKAGE = ROOT / "topo_verify"

FLOORS = {
    "errors": -1,
    "world": 0,
    "robot": 1,
    "checkers": 2,
    "extras": 2,  # the door to topo_verify/extra/: for floor 3 and above, never for what is trusted
    "algorithms": 3,
    "programs": 3,
    "strategies": 4,
    "proofs": 4,
    "faults": 4,
    "pictures": 5,
    "campaign": 6,
    "studies": 7,
    "report": 8,
    "cli": 9,
    "pytest_plugin": 9,
    "search_entry": 10,  # the search for use from Python; nothing inside imports it
    "": 11,  # topo_verify/__init__.py
    "__main__": 11,
}
"""Each room's floor. The package's own name ("") stands above all: it shows everybody's things."""

ONLY = {"algorithms": ("topo_verify.robot.percept", "topo_verify.robot.events")}
"""Rooms that may see less than their floor would let them: an algorithm cannot peek."""

NEVER = {
    "algorithms": {"importlib", "inspect", "gc", "ctypes"},  # the ways around ONLY
    "checkers": {"hypothesis", "z3"},
}
"""What a room may not import even late."""

STANDARD_LIBRARY_ALONE = {"algorithms"}

PEEPHOLES = {"__import__", "eval", "exec", "globals", "__globals__", "__closure__"}
"""Names with which an algorithm could reach the world behind its robot, imports or not."""

LATE = {
    ("world", "World.draw"): "pictures",
    ("world", "World._repr_html_"): "pictures",
    ("campaign", "Exploration._played"): "pictures",
    ("campaign", "Exploration._repr_html_"): "pictures",
    ("campaign", "Exploration.save"): "pictures",
    ("campaign", "Report.playback"): "pictures",
    ("campaign", "Report.walk"): "pictures",
    ("campaign", "Report._repr_html_"): "pictures",
    ("campaign", "_card"): "pictures",
    ("campaign", "_picture"): "pictures",
}
"""The exceptions: an object is asked for its picture or its text, and pictures/ makes them."""

CONVENIENCES = {
    *("World.load", "World.from_json", "World.to_json", "World.save", "World.draw"),
    *("World.least_cost", "World.proof_tour", "World.twin", "World._repr_html_"),
}
"""Methods of `World` for people who type, each a late import of the function that does it."""

MADE_OF = {
    "strategies": {"hypothesis"},
    "proofs": {"z3"},
    "cli": {"click", "rich"},
    "pytest_plugin": {"pytest"},
}
"""Other people's packages that a room may load when it is imported; msgspec may be anywhere."""

LOADED_LATE = {
    "topo_verify.pictures.drawing": {"numpy", "networkx", "scipy"},
}
"""Parts of a room that the rest of the house imports late: what they may load in their turn.

They may load one another.
"""

CAREFUL = ("robot", "checkers", "algorithms", "world.rooted_map", "world.enumeration")
"""What is read line by line: the trusted rooms and the algorithms. Files are shorter there."""

HEAVY = ("z3", "networkx", "hypothesis", "numpy", "matplotlib", "numba", "click", "rich", "pytest")


@dataclass(frozen=True)
class Import:
    """One imported name, where it stands and when it runs."""

    target: str  # the full dotted name, e.g. topo_verify.robot.percept.Percept
    line: int
    scope: str  # the enclosing classes and functions, e.g. Report.walk; "" at the top
    at_load: bool  # runs as soon as the file is imported

    @property
    def room(self) -> str | None:
        """The room of topo_verify that the name belongs to; None for anything else."""
        return room_of(self.target) if self.top == "topo_verify" else None

    @property
    def top(self) -> str:
        """The top-level package."""
        return self.target.split(".")[0]


def room_of(module: str) -> str:
    """The room of a module or a name: what follows `topo_verify`; "" for the package itself."""
    name = [*module.split("."), ""][1]
    return name if name in FLOORS else ""


def module_name(path: Path) -> str:
    """The dotted name of a file of the package."""
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def imports(source: str, module: str) -> Iterator[Import]:
    """Every import of a file, wherever it stands."""
    todo: list[tuple[ast.AST, str, bool]] = [(ast.parse(source, module), "", True)]
    while todo:
        node, scope, at_load = todo.pop()
        if isinstance(node, ast.Import):
            for alias in node.names:
                yield Import(alias.name, node.lineno, scope, at_load)
        elif isinstance(node, ast.ImportFrom):
            module = "." * node.level + (node.module or "")
            for alias in node.names:
                yield Import(f"{module}.{alias.name}", node.lineno, scope, at_load)
        elif isinstance(node, ast.If) and ast.unparse(node.test).endswith("TYPE_CHECKING"):
            todo += [(child, scope, False) for child in node.body]
            todo += [(child, scope, at_load) for child in node.orelse]
        else:
            if isinstance(node, ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
                scope = f"{scope}.{node.name}".lstrip(".")
                at_load = at_load and isinstance(node, ast.ClassDef)
            todo += [(child, scope, at_load) for child in ast.iter_child_nodes(node)]


def extra_of(module: str) -> str | None:
    """The extra of a module or a name, "" for their folder; None for anything else."""
    if f"{module}.".startswith("topo_verify.native."):  # the name that its users import
        return "fast"
    parts = [*module.split("."), ""]
    return parts[2] if parts[:2] == ["topo_verify", "extra"] else None


def objections(module: str, source: str) -> Iterator[str]:
    """What is wrong with the imports of one file, a sentence each."""
    if extra_of(module) is not None:
        yield from objections_to_extra(module, source)
        return
    if module != "topo_verify.extras":
        yield from objections_to_names(module, source)
    room = room_of(module)
    for found in imports(source, module):
        where = f"{module}:{found.line} imports {found.target}"
        if found.target.startswith("."):
            yield f"{where}: write the full name"
        elif extra_of(found.target) is not None:
            yield f"{where}: the main house imports no extra; ask topo_verify/extras.py for it"
        elif found.room is not None:
            if found.at_load and (part := late_part(found.target)) and not late_part(module):
                yield f"{where} when it is loaded: {part} is imported where it is used"
            if LATE.get((room, found.scope)) != found.room:
                yield from objections_inside(room, found, where)
        elif found.top in NEVER.get(room, ()):
            yield f"{where}: never in {room}/"
        elif found.top not in sys.stdlib_module_names:
            if room in STANDARD_LIBRARY_ALONE:
                yield f"{where}: {room}/ is made with the standard library alone"
            elif found.at_load and found.top not in may_load(module):
                yield f"{where} when it is loaded: import it where it is used"


def objections_to_extra(module: str, source: str) -> Iterator[str]:
    """What is wrong with the imports of a file of an extra."""
    for found in imports(source, module):
        where = f"{module}:{found.line} imports {found.target}"
        other = extra_of(found.target)
        if found.target.startswith("."):
            yield f"{where}: write the full name"
        elif other not in (None, extra_of(module)):
            yield f"{where}: an extra imports the main house, and no other extra"
        elif module.endswith(".options") and found.at_load and not is_light(found):
            yield f"{where} when it is loaded: options.py needs click alone"
    for line, text in texts(source):
        named = re.search(r"\btopo_verify[./]extra[./](\w+)", text)
        if named is not None and named[1] != extra_of(module):
            yield f"{module}:{line} names a module of the extra {named[1]}: import no other extra"


def texts(source: str) -> Iterator[tuple[int, str]]:
    """The strings of a file, docstrings and parts of f-strings included, with their lines."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            yield node.lineno, node.value


def is_light(found: Import) -> bool:
    """Whether the options of a command may load it: click, the standard library, our errors."""
    light = {"click", *sys.stdlib_module_names}
    return found.top in light or found.target.startswith("topo_verify.errors.")


def objections_to_names(module: str, source: str) -> Iterator[str]:
    """Where a file of the main house names an extra's module, or a package that an extra needs."""
    for line, text in texts(source):
        if re.search(r"\btopo_verify[./]extra\b", text):
            yield f"{module}:{line} names a module of an extra: ask topo_verify/extras.py"
        if text in extras.ENGINES:
            yield f"{module}:{line} asks for the engine {text!r}: an engine answers for itself"
    for package in sorted({name for names in extras.PACKAGES.values() for name in names}):
        if re.search(rf"\b{package}\b", source):
            yield f"{module} names {package}, which an extra needs: only topo_verify/extras.py does"


def late_part(module: str) -> str | None:
    """The part of a room that is imported late and that the module or name belongs to."""
    return next((part for part in LOADED_LATE if f"{module}.".startswith(f"{part}.")), None)


def may_load(module: str) -> set[str]:
    """Other people's packages that the module may load when it is imported."""
    part = late_part(module)
    more = LOADED_LATE[part] if part else MADE_OF.get(room_of(module), set())
    return {"msgspec", *more}


def objections_inside(room: str, found: Import, where: str) -> Iterator[str]:
    """What is wrong with an import of one room of topo_verify by another (or by itself)."""
    other = found.room
    assert other is not None
    if other == room:
        return
    if room in ONLY and not f"{found.target}.".startswith(tuple(f"{n}." for n in ONLY[room])):
        yield f"{where}: {room}/ may see only {' and '.join(ONLY[room])}"
    elif FLOORS[other] >= FLOORS[room]:
        yield f"{where}: floor {FLOORS[room]} knows only lower floors, not floor {FLOORS[other]}"


def peepholes(source: str) -> set[str]:
    """Which ways to peek a file uses."""
    nodes = list(ast.walk(ast.parse(source)))
    names = {node.id for node in nodes if isinstance(node, ast.Name)}
    return PEEPHOLES & (names | {node.attr for node in nodes if isinstance(node, ast.Attribute)})


def every_source() -> dict[str, str]:
    """The text of every module of the package, extras included, by its dotted name."""
    return {module_name(path): path.read_text() for path in sorted(PACKAGE.rglob("*.py"))}


def sources() -> dict[str, str]:
    """The text of every module of the main house."""
    return {name: text for name, text in every_source().items() if extra_of(name) is None}


def long_functions(source: str, limit: int) -> list[str]:
    """The functions of a file that have more than `limit` lines."""
    functions = [
        node
        for node in ast.walk(ast.parse(source))
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef)
    ]
    return [f.name for f in functions if (f.end_lineno or f.lineno) - f.lineno + 1 > limit]


def longest(module: str) -> tuple[int, int]:
    """The most lines that a module and a function in it may have."""
    parts = (f"topo_verify.{part}." for part in CAREFUL)
    return (400, 60) if f"{module}.".startswith(tuple(parts)) else (600, 80)


def test_every_module_has_a_room_in_the_table() -> None:
    rooms = {[*name.split("."), ""][1] for name in sources()}
    assert rooms <= FLOORS.keys(), "a new room needs a floor in this test's table"


def test_every_room_imports_only_what_it_may() -> None:
    found = [line for module, text in every_source().items() for line in objections(module, text)]
    assert not found, "\n".join(found)


@pytest.mark.parametrize(
    ("module", "source", "objection"),
    [
        ("topo_verify.world.families", "from topo_verify.robot import percept", "lower floors"),
        ("topo_verify.world.families", "import topo_verify", "lower floors"),
        ("topo_verify.world.families", "from topo_verify import explore", "lower floors"),
        ("topo_verify.world.families", "from .formats import load", "full name"),
        ("topo_verify.world.families", "import networkx as nx", "where it is used"),
        ("topo_verify.world.families", "class A:\n    import numpy", "where it is used"),
        ("topo_verify.pictures.drawing.svg", "import shapely", "where it is used"),
        (
            "topo_verify.report.page",
            "from topo_verify.pictures.drawing.svg import to_svg",
            "topo_verify.pictures.drawing is imported where it is used",
        ),
        (
            "topo_verify.campaign.run",
            "try:\n    import z3\nexcept ImportError: ...",
            "where it is used",
        ),
        ("topo_verify.robot", "def f():\n    import topo_verify.pictures", "lower floors"),
        ("topo_verify.errors", "from topo_verify.world import World", "lower floors"),
        ("topo_verify.algorithms.rules", "from topo_verify.world import World", "may see only"),
        ("topo_verify.algorithms.rules", "from topo_verify.robot import simulator", "see only"),
        ("topo_verify.algorithms.rules", "import topo_verify.robot.events_log", "see only"),
        ("topo_verify.algorithms.rules", "def f():\n    import msgspec", "standard library alone"),
        ("topo_verify.algorithms.rules", "import gc", "never in algorithms"),
        ("topo_verify.checkers.costs", "from topo_verify.algorithms import basic", "lower floors"),
        ("topo_verify.checkers.costs", "def f():\n    from z3 import Int", "never in checkers"),
        ("topo_verify.checkers.costs", "import hypothesis.strategies", "never in checkers"),
        (
            "topo_verify.world",
            "class World:\n def _repr_png_(self):\n  import topo_verify.pictures",
            "lower floors",
        ),
        (
            "topo_verify.algorithms",
            "if TYPE_CHECKING:\n    from topo_verify.robot.simulator import Simulator",
            "may see only",
        ),
        ("topo_verify.cli.world", "from topo_verify.extra.arena import league", "no extra"),
        ("topo_verify.cli.world", "def f():\n    import topo_verify.extra.arena", "no extra"),
        ("topo_verify", "from topo_verify import extra", "no extra"),
        ("topo_verify.cli.world", "import_module('topo_verify.extra.arena')", "names a module"),
        ("topo_verify.cli.world", "import_module(f'topo_verify.extra.{n}')", "names a module"),
        ("topo_verify.cli.world", "def f():\n    import matplotlib", "which an extra needs"),
        ("topo_verify.cli.world", "find_spec('matplotlib')", "which an extra needs"),
        ("topo_verify.checkers.costs", "from topo_verify import extras", "lower floors"),
        ("topo_verify.extra.arena.a", "from topo_verify.extra.figures import b", "no other extra"),
        ("topo_verify.extra.arena.a", "def f():\n    import topo_verify.extra.films", "no other"),
        ("topo_verify.extra.arena.a", "from topo_verify.extra import films", "no other extra"),
        ("topo_verify.extra.arena.a", "import_module('topo_verify.extra.films')", "no other extra"),
        ("topo_verify.extra.arena.a", "from .league import League", "full name"),
        ("topo_verify.extra.films.options", "import msgspec", "click alone"),
        ("topo_verify.extra.films.options", "from topo_verify.world import io", "click alone"),
    ],
)
def test_the_layer_check_sees_a_planted_breach(module: str, source: str, objection: str) -> None:
    (seen,) = objections(module, source)
    assert objection in seen


@pytest.mark.parametrize(
    ("module", "source"),
    [
        ("topo_verify.world", "from topo_verify.errors import InputError"),
        ("topo_verify.world", "def f():\n    import networkx"),
        ("topo_verify.pictures.drawing.svg", "import numpy as np"),
        ("topo_verify.pictures.drawing", "from topo_verify.pictures.drawing.svg import to_svg"),
        ("topo_verify.cli.world", "def f():\n    from topo_verify.pictures.drawing import to_svg"),
        ("topo_verify.world", "if TYPE_CHECKING:\n    import numpy"),
        (
            "topo_verify.campaign",
            "class Report:\n def walk(self):\n  from topo_verify.pictures import walk",
        ),
        ("topo_verify.algorithms.rules", "from topo_verify.robot.percept import Percept"),
        ("topo_verify.algorithms.rules", "from topo_verify.robot import events"),
        ("topo_verify.algorithms.rules", "from topo_verify.algorithms.chart import Chart"),
        ("topo_verify.strategies.worlds", "from hypothesis import strategies"),
        ("topo_verify.cli.verify", "import click\nfrom topo_verify.studies.verify import verify"),
        ("topo_verify.__main__", "from topo_verify.cli import main"),
        ("topo_verify.campaign.run", "from topo_verify import extras"),
        ("topo_verify.extra.arena.a", "from topo_verify.extra.arena.league import League"),
        ("topo_verify.extra.arena.a", "from topo_verify.cli.output import Output"),
        ("topo_verify.extra.arena.a", "'topo_verify.extra.arena.league:League'"),
        ("topo_verify.extra.films.options", "import click\nfrom topo_verify.errors import plural"),
        ("topo_verify.extra.films.options", "def f():\n    import topo_verify.extra.films.film"),
    ],
)
def test_the_layer_check_lets_pass_what_is_allowed(module: str, source: str) -> None:
    assert not list(objections(module, source))


def test_the_tests_of_the_main_house_import_no_extra() -> None:
    """So that they can be run where no package of an extra is installed."""
    tests = ROOT / "tests"
    files = [path for path in tests.rglob("*.py") if tests / "extra" not in path.parents]
    found = [
        (path.name, target)
        for path in files
        for target in (each.target for each in imports(path.read_text("utf-8"), str(path)))
        if extra_of(target) is not None or f"{target}.".startswith("tests.extra.")
    ]
    assert len(files) > 200
    assert found == []


@pytest.mark.long
def test_no_algorithm_reaches_for_the_world_behind_its_robot() -> None:
    used = {name: peepholes(text) for name, text in sources().items()}
    assert not [name for name, ways in used.items() if ways and room_of(name) == "algorithms"]


def test_a_peeping_algorithm_is_seen() -> None:
    assert peepholes("def explore(robot):\n    return robot.move.__globals__") == {"__globals__"}
    assert peepholes("world = eval('robot')") == {"eval"}


def test_importing_topo_verify_loads_nothing_heavy() -> None:
    code = f"import sys, topo_verify; print([n for n in {HEAVY!r} if n in sys.modules])"
    done = python("-c", code, cwd=ROOT)
    assert done.stdout.strip() == "[]", done.stderr


def test_no_file_is_too_long_to_read() -> None:
    lengths = {name: len(text.splitlines()) for name, text in every_source().items()}
    long = {name: n for name, n in lengths.items() if n > longest(name)[0]}
    assert not long, "over 600 lines (400 in CAREFUL): would two ideas part company?"


@pytest.mark.long
def test_no_function_is_too_long_to_read() -> None:
    functions = {
        name: long_functions(text, longest(name)[1]) for name, text in every_source().items()
    }
    long = {name: over for name, over in functions.items() if over}
    assert not long, "over 80 lines (60 in CAREFUL): let a part of it have a name"


def test_the_trusted_files_are_shorter_than_the_rest() -> None:
    modules = ("robot", "checkers.claims", "world.rooted_map", "world.enumeration.pruned")
    assert {longest(f"topo_verify.{name}") for name in modules} == {(400, 60)}
    assert longest("topo_verify.world.rooted_maps") == longest("topo_verify.cli") == (600, 80)


def test_a_function_of_61_lines_is_seen_to_be_too_long() -> None:
    assert long_functions("def f():\n" + "    x = 1\n" * 60, 60) == ["f"]
    assert not long_functions("def f():\n" + "    x = 1\n" * 59, 60)


def test_the_campaign_loads_no_picture_no_report_and_no_command_line() -> None:
    modules = sorted(name for name in sources() if room_of(name) == "campaign")
    assert "topo_verify.campaign.campaign" in modules
    code = f"import sys, {', '.join(modules)}; print(*sys.modules)"
    run = python("-c", code, check=True)
    loaded = {room_of(name) for name in run.stdout.split() if name.startswith("topo_verify.")}
    assert loaded.isdisjoint({"pictures", "report", "cli", "studies"})


def test_the_campaign_imports_pictures_late_and_only_where_it_is_named() -> None:
    for module, text in sources().items():
        if room_of(module) == "campaign":
            for found in imports(text, module):
                if found.room in {"pictures", "report", "cli"} and found.scope:
                    assert ("campaign", found.scope) in LATE


def test_contributing_names_every_room_on_its_floor() -> None:
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    named: dict[str, int] = {}
    floor = 0
    for number, rooms in re.findall(
        r"^\| (\d*) ?\| ((?:`\w+/?(?:\.py)?`(?:, )?)+) \|", text, re.MULTILINE
    ):
        floor = int(number) if number else floor
        named |= {
            room.removesuffix(".py"): floor for room in re.findall(r"`(\w+(?:\.py)?)/?`", rooms)
        }
    outside = {"errors", "extras", "native", "search_entry", "", "__main__"}
    assert named == {room: number for room, number in FLOORS.items() if room not in outside}


def read_first(contributing: str) -> list[str]:
    """The files that CONTRIBUTING.md tells a newcomer to read."""
    section = contributing.partition("## Five files to read first\n")[2].partition("\n## ")[0]
    return re.findall(r"^\d+\. `(\S+)`: ", section, re.MULTILINE)


def test_the_five_files_to_read_first_are_there() -> None:
    files = read_first((ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8"))
    assert len(files) == 5
    assert [file for file in files if not (PACKAGE / file).is_file()] == []


@pytest.mark.parametrize("name", ["campaign", "studies", "studies/search", "studies/verify"])
def test_a_package_describes_its_files(name: str) -> None:
    folder = PACKAGE / name
    source = (folder / "__init__.py").read_text(encoding="utf-8")
    described = ast.get_docstring(ast.parse(source)) or ""
    files = {path.name for path in folder.glob("*.py")} - {"__init__.py"}
    assert {file for file in files if file not in described} == set()
    assert set(re.findall(r"\b\w+\.py\b", described)) <= files
