"""The pages of docs/: what they tell a reader to do works, and prints what they show.

A page is done from its first command to its last, in a folder that has `examples/` and `.venv`, as
its reader does it. What is left out is named, with the reason.
"""

from __future__ import annotations

import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner

from tests.pages import ROOT, Step, agrees, links_on, steps
from topo_verify.cli import main

DOCS = ROOT / "docs"
ELSEWHERE = {
    "baselines.md": "tests/cli/test_compare.py does it",
    "property-tests.md": "tests/examples/test_property_test.py does it",
    "pytest.md": "tests/examples/test_pytest_plugin.py does it",
    "semantics.md": "the specification has formulas and pseudo-code, and no command",
}
"""Pages with steps that another test does, or that none can do."""

LEFT_OUT = {
    r"(make \w+|\.ci/run).*": "a target of the Makefile, which .ci/run calls",
    r".*(-m venv|pip install) .*": "installs; tests/test_packaging.py tries the wheel",
    r'eval "\$\(.*': "tests/cli/test_completion.py tries it in bash",
    r".*topo-verify verify( .*)?": "takes up to two minutes; tests/cli/test_verify.py",
    r"LB = .*": "a formula",
    r"\d+'? .*": "pseudo-code",
    r".* benchmarks/\S+\.py.*": "measures for minutes",
    r".* -m research\..*": "minutes to hours; tests/docs/test_price.py prints stored runs",
    r".*arena all|.*arena basic,folding --cmd .*": "a minute; tests/extra/arena/",
    r".*--engine compiled.*": "compiles for a minute; tests/extra/fast/",
    r".*--marker all": "146 runs; tests/cli/test_explore.py",
    r".*--policies every --edges 4.*": "minutes; tests/studies/search/",
    r".*certify .*(--kernel|--check).*": "needs Coq; tests/extra/certificates/",
    r"\{ echo .*|for f in .*|coqchk .*": "needs Coq; tests/proofs/mechanised/",
    r"(cp -r|cd|sed -i.bak) .*": "needs Coq; tests/proofs/mechanised/test_mutants.py",
    r".*prove --kind .*": "a minute and more; tests/proofs/",
    r".*topo-verify reproduce .*": "minutes; tests/extra/figures/",
    r".*(-m |bin/)pytest.*": "tests by themselves",
    r"dask .*": "a cluster; tests/extra/dask/test_cluster.py",
    r".*conform --cmd './mapper --fast'.*": "the reader's program",
    r".* LOG( .*)?": "the reader's log",
    r"topo-verify explore .* --svg docs/.*": "tests/extra/films/ compares the picture",
}
PROGRAM, PYTHON = ".venv/bin/topo-verify ", ".venv/bin/python "


def pages() -> list[str]:
    """The pages with something to do, by their paths from docs/."""
    paths = {path.relative_to(DOCS).as_posix(): path for path in DOCS.rglob("[!_]*.md")}
    paths |= {f"../{name}.md": ROOT / f"{name}.md" for name in ("README", "CONTRIBUTING")}
    kinds = {"command", "python", "file", "lines"}
    return [
        name
        for name, path in sorted(paths.items())
        if name not in ELSEWHERE
        and any(step.kind in kinds for step in steps(path.read_text(encoding="utf-8")))
    ]


DONE = pages()


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder in which a page is done."""
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", [str(tmp_path), *sys.path])
    for most in ("MOST", "ROW"):  # a search runs many worlds again; test_again.py tries that
        monkeypatch.setattr(f"topo_verify.studies.search.again.{most}", 2)
    for name in ("FORCE_COLOR", "COLUMNS"):
        monkeypatch.delenv(name, raising=False)
    return tmp_path


def printed(line: str) -> str:
    """What a command prints; it may end with a counterexample or incomplete, not with an error."""
    if line.startswith((PROGRAM, "topo-verify ")):
        done = CliRunner().invoke(main, shlex.split(line, comments=True)[1:])
        assert done.exit_code in {0, 1, 3}, done.stderr
        return done.stdout
    arguments = ["bash", "-c", line] if " > " in line else shlex.split(line)
    if line.startswith(PYTHON):
        arguments[0] = sys.executable
    elif arguments[0] in {"cc", "node", "rustc"} and shutil.which(arguments[0]) is None:
        pytest.skip(f"{arguments[0]} is not installed")
    run = subprocess.run(arguments, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr
    return run.stdout


def steady(text: str) -> str:
    """A text without what differs here: seconds, the solver's version, worlds run again."""
    text = re.sub(r"Run again: \d+ worlds? alone, \d+ in a row: \d+ same", "Run again: N", text)
    return re.sub(r"z3 [\d.…]+", "z3 VERSION", re.sub(r"\d+\.\d\d s\b", "0.00 s", text))


def do(step: Step, folder: Path, names: dict[str, object]) -> None:
    """Do what a page says; AssertionError if something else comes out."""
    match step.kind:
        case "file":
            (folder / step.name).write_text(step.text, encoding="utf-8")
        case "python":
            exec(step.text, names)  # noqa: S102  the page's own example
        case "lines":
            (file,) = (folder / "examples").resolve().rglob(step.name)
            has = {line.strip() for line in file.read_text(encoding="utf-8").splitlines()}
            says = {line.partition("  # ")[0].strip() for line in step.text.splitlines()}
            assert says <= has, f"{step.name} has no such lines: {says - has}"
        case "command" if not any(re.fullmatch(pattern, step.text) for pattern in LEFT_OUT):
            out = printed(step.text)
            assert step.shown is None or agrees(steady(step.shown), steady(out)), step.text
        case _:
            pass


@pytest.mark.long
@pytest.mark.parametrize("page", DONE)
def test_what_a_page_says_can_be_done_and_prints_what_it_shows(page: str, folder: Path) -> None:
    if "node " in (text := (DOCS / page).read_text(encoding="utf-8")) and not shutil.which("node"):
        pytest.skip("node is not installed")
    names: dict[str, object] = {}
    for step in steps(text):
        do(step, folder, names)
    sys.modules.pop("ring", None)


@pytest.mark.parametrize(
    "false",
    [
        "    .venv/bin/topo-verify world count --edges 2\n\n```\nedges  class  worlds\n```\n",
        "    .venv/bin/topo-verify world count --edges 2\n\n```\n…\n    2  any        11\n```\n",
        "    .venv/bin/topo-verify world count --edge 2\n",
        "```python\nassert 1 + 1 == 3\n```\n",
        "```python\n# lines of declared.py\nself.say('nothing of the kind')\n```\n",
        "    .venv/bin/python -c 'raise SystemExit(1)'\n",
    ],
)
def test_a_page_that_says_what_is_not_so_is_seen(false: str, folder: Path) -> None:
    (step,) = steps(false)
    with pytest.raises(AssertionError):
        do(step, folder, {})


def test_a_line_of_dots_stands_for_lines_that_are_left_out() -> None:
    printed = "edges  class  worlds\n1\n2\n3\n"
    assert agrees("…\n3\n", printed)
    assert agrees("edges  class  worlds\n…\n", printed)
    assert not agrees("…\n4\n", printed)
    assert not agrees("edges  class  worlds\n…\n1\n2\n3\n", printed)


def test_a_page_that_is_left_out_is_there() -> None:
    assert len(DONE) >= 30
    assert all((DOCS / name).is_file() for name in ELSEWHERE)


def test_nothing_is_left_out_for_a_page_that_does_not_say_it() -> None:
    said = [step.text for page in DONE for step in steps((DOCS / page).read_text())]
    for pattern in LEFT_OUT:
        assert any(re.fullmatch(pattern, line) for line in said), pattern


def test_every_link_of_a_page_leads_somewhere_on_github_too() -> None:
    lost = [
        (page.name, target)
        for page in [*DOCS.rglob("[!_]*.md"), ROOT / "README.md", ROOT / "CONTRIBUTING.md"]
        for target in links_on(page.read_text(encoding="utf-8"))
        if "://" not in target and not (page.parent / target.partition("#")[0]).exists()
    ]
    assert not lost


def test_links_are_found_in_running_text_alone() -> None:
    text = "[a](b.md) and `[c](d.md)`\n```\n[e](f.md)\n```\n![g](h.svg#i)\n"
    assert list(links_on(text)) == ["b.md", "h.svg#i"]


def test_the_help_names_pages_that_are_there() -> None:
    sources = "".join(path.read_text() for path in (ROOT / "topo_verify").rglob("*.py"))
    named = set(re.findall(r"docs/([\w/-]+\.md)", sources))
    assert "semantics.md" in named
    assert not {name for name in named if not (DOCS / name).exists()}
