"""A native mapper behind the pipe: the same runs as the reference, and what becomes of misdeeds."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

from tests.marks import with_marks
from tests.programs.natives import ROOT, built, hostile
from tests.python import python
from topo_verify import InputError, World, examine, explore
from topo_verify.campaign.targets import one_target, target_arguments, target_text
from topo_verify.programs.library import header_text, library_file
from topo_verify.programs.loader import Target
from topo_verify.programs.misbehaviour import last_words
from topo_verify.robot.limits import Limits
from topo_verify.studies.search.search import search

MISDEEDS = {
    "crash": "SIGSEGV",
    "leave": "exit code 0",
    "walk": "more than 2 moves",
    "overflow": "SIGSEGV",
    "write_world": "SIGSEGV",
    "write_robot": "SIGSEGV",
    "double_itself": "SIGABRT",
    "close_all": "exit code 1",
}
"""Each misdeed of hostile.c, and what is said of it behind the pipe."""


def test_the_example_makes_the_events_of_basic(tmp_path: Path) -> None:
    target = one_target(built(tmp_path))
    for name in ("m1/0", "m2/5", "m3/14", "m4/700", "m8/1000000"):
        world = World.from_id(name)
        assert explore(world, target).trace[1:] == explore(world, "basic").trace[1:]


@pytest.mark.long
def test_the_wrong_example_is_found_out(tmp_path: Path) -> None:
    found = search(built(tmp_path, "-DWRONG"), edges=3, engine="reference").counterexample
    assert found is not None
    assert found.world == "m3/5"
    assert "--library" in found.replay


def test_a_silent_mapper_is_judged_on_its_map(tmp_path: Path) -> None:
    report = examine(one_target(built(tmp_path, "-DSILENT")), World.from_id("m3/14"))
    assert report.ok
    assert report.claims["true-hypothesis-kept"] == "not-declared"


@pytest.mark.parametrize("deed", with_marks(MISDEEDS, long=["walk"]))
def test_a_misdeed_is_a_finding_in_its_world(deed: str, tmp_path: Path) -> None:
    target = one_target(hostile(tmp_path, deed))
    assert examine(target, World.from_id("m1/1")).ok
    assert MISDEEDS[deed] in str(explore(World.from_id("m2/9"), target).stopped)
    assert examine(target, World.from_id("m1/1")).ok


def test_a_crash_is_one_line_that_names_the_function(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    target = one_target(hostile(tmp_path, "crash"))
    place = target.text.removeprefix("--library ")
    assert explore(World.from_id("m2/9"), target).stopped == (
        f"map_world of {place} was ended by SIGSEGV after 0 moves, before it delivered a map;"
        " -fsanitize=address names the line: docs/tutorials/native.md"
    )
    assert capfd.readouterr().err == ""  # none of our own lines


def test_an_endless_loop_has_a_next_step(tmp_path: Path) -> None:
    target = one_target(hostile(tmp_path, "loop"))
    run = explore(World.from_id("m2/9"), target, limits=Limits(move_timeout=0.5))
    assert run.limit == "move-timeout"
    assert "gdb" in str(run.stopped)
    assert "docs/tutorials/native.md" in str(run.stopped)


def test_a_world_that_is_skipped_is_neither_right_nor_wrong(tmp_path: Path) -> None:
    run = explore(World.from_id("m1/0"), one_target(hostile(tmp_path, "nothing")))
    assert run.declined
    assert run.stopped == "the mapper skips this world: several vertices"


def test_the_texts_of_a_library(tmp_path: Path) -> None:
    (tmp_path / "a:b.so").write_text("")
    assert library_file("--library ./m.so") == ("./m.so", "map_world")
    assert library_file("--library ./m.so:go") == ("./m.so", "go")
    assert library_file(f"--library {tmp_path}/a:b.so") == (f"{tmp_path}/a:b.so", "map_world")
    assert target_text(None, "--library ./m.so") == "--library ./m.so"
    assert target_arguments("--library ./m.so:go") == ("--library", "./m.so:go")


def test_what_is_no_library_is_refused(tmp_path: Path) -> None:
    path = built(tmp_path).removeprefix("--library ")
    text = tmp_path / "text.so"
    text.write_text("no library")
    for place, words in (
        (tmp_path / "none.so", "there is no file"),
        (text, "cannot open it"),
        (f"{path}:explore", "no function 'explore'"),
    ):
        with pytest.raises(InputError, match=words):
            explore("m1/0", f"--library {place}")


def test_the_header_is_read_by_c_and_by_c_plus_plus(tmp_path: Path) -> None:
    (tmp_path / "topo_verify.h").write_text(header_text(), encoding="utf-8")
    for compiler, name in (("cc", "a.c"), ("c++", "a.cpp")):
        if shutil.which(compiler) is None:
            continue
        (tmp_path / name).write_text('#include "topo_verify.h"\n#include "topo_verify.h"\n')
        line = [compiler, "-Wall", "-Wextra", "-Werror", "-pedantic", "-fsyntax-only", name]
        subprocess.run(line, cwd=tmp_path, check=True)


def built_by_rust(tmp_path: Path, *options: str) -> Target:
    """The sketch in Rust."""
    if shutil.which("rustc") is None:
        pytest.skip("rustc is not installed")
    source, library = ROOT / "examples" / "native_rust" / "mapper.rs", tmp_path / "mapper.so"
    line = ["rustc", "-O", *options, "--crate-type", "cdylib", "-o", str(library), str(source)]
    if subprocess.run(line, capture_output=True, check=False).returncode:
        pytest.skip("rustc makes no library here")
    return one_target(f"--library {library}")


def test_the_sketch_in_rust_maps_what_it_does_not_skip(tmp_path: Path) -> None:
    target = built_by_rust(tmp_path)
    assert examine(target, World.from_id("m2/9")).ok
    assert explore(World.from_id("m1/0"), target).declined


def test_the_wrong_sketch_in_rust_is_caught(tmp_path: Path) -> None:
    report = examine(built_by_rust(tmp_path, "--cfg", "wrong"), World.from_id("m2/9"))
    assert report.claims["map-isomorphic"] == "failed"


def test_the_example_for_a_debugger_runs_a_library_in_one_world(tmp_path: Path) -> None:
    library = built(tmp_path).removeprefix("--library ")
    script = ROOT / "examples" / "native_c" / "in_gdb.py"
    assert "m2/5" in python(script, library, "m2/5", check=True).stdout


def test_a_sanitizer_is_quoted_by_its_summary() -> None:
    summary = "SUMMARY: AddressSanitizer: SEGV m.c:9 in map_world"
    frames = "".join(f"    #{n} 0x77 in _Py_call\n" for n in range(20))
    words = f"; its last line on standard error: {summary}"
    assert last_words(f"==7==ERROR\n{summary}\n{frames}==7==ABORTING\n") == words
