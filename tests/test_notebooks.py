"""What a notebook shows of results and errors. IPython's protocol is spoken without IPython."""

from __future__ import annotations

import re
import sys
from html import escape
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

import topo_verify as tv
from topo_verify.robot.events import MapData, Move, Start


def guess(_robot: tv.Robot) -> dict[str, Any]:
    """A mapper that says without a move that the world is one edge."""
    return {"vertices": [[0], [1]], "edges": [[0, 1]], "marker": 0}


def loop_after_a_look(robot: tv.Robot) -> dict[str, Any]:
    """A mapper that looks behind door 0, and says that the world is one loop."""
    robot.move(0)
    return {"vertices": [[0, 1]], "edges": [[0, 1]], "marker": 0}


def html_of(thing: Any) -> str:
    """What a notebook shows."""
    page: str = thing._repr_html_()
    return page


class Printer:
    """As much of IPython's printer as is needed here."""

    def __init__(self) -> None:
        self.printed = ""

    def text(self, text: str) -> None:
        self.printed += text


def test_an_input_error_is_its_message_and_the_line_of_the_cell() -> None:
    cell = compile('edges = 99\ntv.explore(f"m3/{edges}", "basic")', "/no/ipykernel_1/2.py", "exec")
    with pytest.raises(tv.InputError) as refused:
        exec(cell, {"tv": tv})  # noqa: S102  our own text
    error: Any = refused.value
    assert error._render_traceback_() == ["cell, line 2: ", f"InputError: {error}"]


def test_an_input_error_in_a_file_names_it() -> None:
    with pytest.raises(tv.InputError) as refused:
        tv.explore("m3/99", "basic")
    error: Any = refused.value
    (place, _) = error._render_traceback_()
    assert re.fullmatch(r".*test_notebooks\.py, line \d+: tv\.explore\(\"m3/99\", .*", place)


def test_an_input_error_under_the_standard_library_is_a_line_of_yours() -> None:
    for wrong in (lambda: tv.certify("no.csv"), lambda: tv.World.load("no.json")):
        with pytest.raises(tv.InputError) as refused:  # by a context manager of the package
            wrong()
        error: Any = refused.value
        assert "test_notebooks.py, line " in error._render_traceback_()[0]


def test_a_cell_is_named_by_its_number_where_ipython_runs(monkeypatch: pytest.MonkeyPatch) -> None:
    known = SimpleNamespace(format_code_name={"/no/ipykernel_1/2.py": ("Cell", "In[7]")}.get)
    shell = SimpleNamespace(get_ipython=lambda: SimpleNamespace(compile=known))
    monkeypatch.setitem(sys.modules, "IPython", shell)
    names: dict[str, Any] = {}
    cell = "def fails(robot):\n    raise ValueError"
    exec(compile(cell, "/no/ipykernel_1/2.py", "exec"), names)  # noqa: S102  our own text
    assert str(tv.explore("m1/0", names["fails"]).stopped).endswith(" (In[7], line 2)")


def test_a_line_of_a_cell_is_named_so() -> None:
    cell = """
def fails(robot):
    import json
    json.loads("")
def hangs(robot):
    while True: pass
"""
    names: dict[str, Any] = {}
    exec(compile(cell, "/tmp/ipykernel_1/2.py", "exec"), names)  # noqa: S102, S108  as IPython's
    assert str(tv.explore("m1/0", names["fails"]).stopped).endswith(" (cell, line 4)")
    hung = tv.explore("m1/0", names["hangs"], limits=tv.Limits(move_timeout=0.15))
    assert str(hung.stopped).endswith("; it was at cell, line 6")
    with pytest.raises(tv.InputError) as refused:
        tv.World((0,), (0,), 0)  # by an __init__ of a dataclass, which is in no file
    error: Any = refused.value
    assert "test_notebooks.py, line " in error._render_traceback_()[0]


def test_a_run_that_is_no_log_is_refused() -> None:
    run: Any = tv.explore("m3/5", "basic")
    wrong: Any
    for wrong in (run, None, 5):
        with pytest.raises(
            tv.InputError, match=r"expected a log: events, as run\.trace, or a file"
        ):
            tv.certify(wrong)


def test_an_interrupted_examination_is_the_line_of_the_mapper() -> None:
    def endless(_robot: tv.Robot) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt) as ctrl_c:
        tv.examine(endless, "m1/0")
    interrupted: Any = ctrl_c.value
    (place, text) = interrupted._render_traceback_()
    assert place.endswith(": raise KeyboardInterrupt")
    assert text == "ExaminationInterrupted: the mapper is not judged"
    with pytest.raises(KeyboardInterrupt) as ctrl_c:
        tv.explore("m1/0", endless)
    interrupted = ctrl_c.value
    (place, text) = interrupted._render_traceback_()
    assert place.endswith(": raise KeyboardInterrupt")
    assert text == "ExaminationInterrupted: after 0 moves; the run is not kept"


def test_a_search_shows_its_verdict_its_table_and_its_counterexample(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    entry: Any = tv.search(guess, edges=2)
    printer = Printer()
    entry._repr_pretty_(printer, False)
    assert printer.printed == str(entry)
    page = entry._repr_html_()
    for text in (str(entry), page):
        assert "REFUTED" in text
        assert "worlds of 1 to 2 edges" in text
        assert "smallest counterexample: m1/0" in text
    assert len(str(entry).splitlines()) < 15
    monkeypatch.setenv("FORCE_COLOR", "1")  # as a kernel of Jupyter does
    assert "\x1b" not in str(entry)
    assert page.count("<img ") == 1
    assert page.count("<table") == 1


def test_a_search_without_a_counterexample_has_no_picture() -> None:
    entry: Any = tv.search("basic", edges=2)
    assert "EXHAUSTED: 12 of 12 worlds checked" in str(entry)
    assert "<img " not in entry._repr_html_()


def test_no_command_is_shown_for_what_no_command_finds() -> None:
    entry = tv.search(lambda _robot: None, edges=1)
    assert "again:" not in str(entry)
    assert 'look closer: tv.examine(your mapper, "m1/0")' in str(entry)
    assert "again:" in str(tv.search(guess)), "edges has the default of the command"
    assert "look closer:" not in str(tv.search(guess, edges=1))


def test_a_mapper_of_a_notebook_is_called_by_its_name() -> None:
    def lazy(_robot: tv.Robot) -> None: ...

    lazy.__module__, lazy.__qualname__ = "__main__", "lazy"
    assert 'look closer: tv.examine(lazy, "m1/0")' in str(tv.search(lazy, edges=1))


def test_a_name_that_may_be_another_mapper_is_not_advised(monkeypatch: pytest.MonkeyPatch) -> None:
    class Lazy:
        def __call__(self, _robot: tv.Robot) -> None: ...

        def explore(self, _robot: tv.Robot) -> None: ...

    Lazy.__module__ = Lazy.explore.__module__ = "__main__"
    mapper = Lazy()
    for unnamed in (mapper, mapper.explore):
        shown = str(tv.search(unnamed, edges=1))
        assert 'look closer: tv.examine(your mapper, "m1/0")' in shown
    monkeypatch.setattr(sys.modules["__main__"], "mine", mapper, raising=False)
    assert 'look closer: tv.examine(mine, "m1/0")' in str(tv.search(mapper, edges=1))


def test_a_report_names_a_large_world_by_its_name() -> None:
    report = tv.examine("basic", "nyc")
    assert len(report.world) > 100, "replay lines have the id"
    assert str(report) == "basic in nyc_osmnx, 1468 edge traversals: 10 of 10 claims hold"
    assert repr(report) == f"<Report: {report}>"
    assert tv.examine("basic", "m3/5").head.startswith("basic in m3/5, ")


def test_a_report_names_a_world_without_an_id_by_its_name() -> None:
    head = tv.examine("basic", tv.families.path(202)).head
    assert head.startswith("basic in path(202), ")


@pytest.mark.parametrize("edges", [2.5, "3", 0])
def test_a_search_refuses_what_is_no_number_of_edges(edges: Any) -> None:
    with pytest.raises(tv.InputError, match="expected an integer from 1 to 200"):
        tv.search("basic", edges=edges)


def test_an_id_that_is_no_text_is_refused() -> None:
    number: Any = 3
    with pytest.raises(tv.InputError, match="expected a world id"):
        tv.World.from_id(number)


def test_a_headline_counts_the_claims_with_nothing_to_judge() -> None:
    head = tv.examine("basic", "m1/0").head
    assert head.endswith(": 10 of 10 claims hold (3 with nothing to judge)")


def test_the_package_offers_its_public_names_alone() -> None:
    assert {*dir(tv)} == {*tv.__all__}
    assert dir(tv.families) == tv.families.__all__, "what Tab offers"
    assert all(getattr(tv, name) is not None for name in tv.__all__)


def test_two_runs_in_one_world_are_saved_side_by_side(tmp_path: Path) -> None:
    run = tv.explore("m3/5", "basic")
    run.save(tmp_path / "two.html", beside=tv.explore("m3/5", "folding"))
    assert "<title>basic beside folding in m3/5" in (tmp_path / "two.html").read_text()
    with pytest.raises(tv.InputError, match="a run in another world"):
        run.save(tmp_path / "other.html", beside=tv.explore("m3/6", "basic"))
    for name in ("run.pdf", "run.SVG"):
        with pytest.raises(tv.InputError, match="a run is shown by a page; name a file that ends"):
            run.save(tmp_path / name)
    assert not (tmp_path / "other.html").exists()


def test_a_run_without_its_trace_says_so(tmp_path: Path) -> None:
    pytest.importorskip("numba")
    run: Any = tv.explore("m3/5", "basic", trace=False, engine="compiled")
    assert run._repr_html_() == "<p>basic in m3/5: no trace was kept: cost 7.</p>"
    with pytest.raises(tv.InputError, match="trace=False keeps nothing to play"):
        run.save(tmp_path / "run.html")
    assert not (tmp_path / "run.html").exists()


def test_a_delivered_map_is_a_picture_and_what_is_no_map_is_its_text() -> None:
    run = tv.explore("m3/5", "basic")
    assert html_of(run.map) == html_of(tv.World.from_map(run.map))
    assert html_of(MapData(((0,),), (), 0)) is None, "so that IPython shows the repr"


def test_a_long_run_is_shown_as_a_sentence(monkeypatch: pytest.MonkeyPatch) -> None:
    run: Any = tv.explore("m3/5", "basic")
    monkeypatch.setattr("topo_verify.campaign.run.MOST_SHOWN", len(run.trace) - 1)
    assert "events take long to show; <code>run.save('run.html')</code>" in run._repr_html_()
    monkeypatch.setattr("topo_verify.campaign.run.MOST_SHOWN", len(run.trace))
    assert "<iframe " in run._repr_html_()


def test_a_log_that_proves_nothing_shows_no_size_of_its_map() -> None:
    log = tv.explore("m3/5", "basic").trace[:3]
    assert repr(tv.certify(log)).startswith(
        "Certificate(verdict='UNKNOWN', map=None, open_darts=3, e"
    )


def test_a_certificate_shows_what_the_log_proves_and_where_to_go_next() -> None:
    trace = tv.explore("m3/5", "basic").trace
    proved, open_log = tv.certify(trace), tv.certify(trace[:8])
    assert str(proved) == "PROVED: one world alone shows this log: 3 vertices, 3 edges"
    assert str(open_log).splitlines() == [
        "UNKNOWN: several worlds show this log, with 7 doors not known to have been crossed",
        "door 1 of place 3: from where the log ends, take 1",
        "door 2 of place 3: from where the log ends, take 2",
        "door 3 of place 3: from where the log ends, take 3",
        "door 3 of place 2: from where the log ends, take 0, 1",
        "door 1 of place 2: from where the log ends, take 0, 3",
        "Next: from where the log ends, take 1, and certify the longer log.",
    ]
    for certificate in (proved, open_log):
        page: str = html_of(certificate)
        assert escape(str(certificate).splitlines()[-1]) in page
        assert page.count("<img ") == 1


def test_a_refuted_certificate_shows_its_findings() -> None:
    impossible = tv.certify([Start(percept=tv.Percept(1, 0)), Move(0, tv.Percept(0, None))])
    assert str(impossible).startswith("REFUTED: no world shows this log\nmap-entailed, event 1: ")
    assert "<img " not in html_of(impossible)
    wrong = tv.certify(tv.explore("m1/0", loop_after_a_look).trace)
    assert "; a map or decision in it does not follow\nmap-" in str(wrong)
    assert "is not isomorphic to the true map (2 vertices, 1 edge)" in str(wrong), "not to a world"


def test_a_certificate_of_a_large_map_is_shown_as_text(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("topo_verify.studies.log_report.MOST_DRAWN", 2)
    page = html_of(tv.certify(tv.explore("m3/5", "basic").trace))
    assert "<code>certificate.draw('known.svg')</code>" in page
    assert "<img " not in page
