"""The report of a run as one self-contained page that makes no request.

Only the section `timing`, and a run that a time limit ended, differs when the same run is repeated.
A content security policy allows by hash the styles and scripts of this page and of the player,
which runs in sandboxed frames. Texts of a mapper, a world or a file name are escaped.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cache
from itertools import count, repeat
from typing import Any, cast

from topo_verify.errors import map_size
from topo_verify.pictures.page import (
    PageShell,
    json_in_page,
    mark_up,
    page_shell,
    part,
    source_hash,
)
from topo_verify.pictures.recording import recording
from topo_verify.report.account import Account, Ending, Exhibit, JudgedCase, JudgedSuite
from topo_verify.report.blocks import PALETTE, TONES, clean
from topo_verify.report.html import blocks_as_html, code, picture, toned, xml_text
from topo_verify.world.rooted_map import World

MOST_DRAWN = 200
"""Most edges of a world that is drawn and played; larger ones take seconds."""

EXITS = {
    0: "nothing found in what was checked",
    1: "a claim fails, or something is not as expected",
    2: "not everything could be written",
    3: "incomplete; what was not decided is no pass",
}


def report_page(account: Account, run: Ending) -> str:
    """The page of a run."""
    exhibits = account.exhibits + account.others
    shell = page_shell() if any(map(_is_played, exhibits)) else None
    style, script = _style(), part("report.js", "report") if shell is not None else ""
    values = {
        "policy": _policy(style, script, shell),
        "title": xml_text(f"topo-verify {run.command}: {clean(account.about)}"),
        "style": style,
        "header": _header(account, run),
        "main": "\n".join(_sections(account, run)),
        "data": "\n".join(_data(exhibits, shell)),
        "script": script,
    }
    return mark_up(part("head.html") + part("report.html", "report"), values)


def _policy(style: str, script: str, shell: PageShell | None) -> str:
    styles = [source_hash(style), *([shell.style] if shell else [])]
    scripts = [source_hash(script), *([shell.script] if shell else [])]
    return (
        f"default-src 'none'; style-src {' '.join(styles)}; script-src {' '.join(scripts)};"
        " img-src data:; base-uri 'none'; form-action 'none'"
    )


@cache
def _style() -> str:
    colours = "".join(
        f"--{name}:light-dark({colour.light},{colour.dark});" for name, colour in PALETTE.items()
    )
    return f":root{{color-scheme:light dark;{colours}}}\n{part('report.css', 'report')}"


# ---------------------------------------------------------------- the parts


def _header(account: Account, run: Ending) -> str:
    extent = account.extent
    words, letter = xml_text(clean(extent.words)), extent.verdict[0]
    headline = f'<p class="verdict">{words}</p>'
    if not (account.results_first and extent.verdict == "REFUTED"):
        headline = (
            f'<p class="verdict {TONES[extent.verdict]}"><span class="letter"><span>{letter}</span>'
            f"</span> {extent.verdict}: {words}</p>"
        )
    missing = "".join(f"<p>Not complete: {xml_text(case.message)}.</p>\n" for case in run.missing)
    found = {"counterexamples": "Counterexamples"} if account.exhibits else {}
    results, judged = {"results": "Results"}, {"judged": "What was judged"}
    worlds = {"worlds": "Worlds"} if account.others else {}
    if account.results_first:
        links = results | found | worlds | judged
    else:
        links = found | judged | results | worlds
    links |= {"versions": "Versions", "timing": "Timing"}
    menu = " ".join(f'<a href="#{name}">{title}</a>' for name, title in links.items())
    return (
        f"<h1>topo-verify {xml_text(run.command)}: {xml_text(clean(account.about))}</h1>\n"
        f"{headline}\n{missing}"
        f"<p>Exit code {run.code}: {EXITS[run.code]}.</p>\n"
        f"{_again(run.again)}\n<nav>{menu}</nav>"
    )


def _again(line: str) -> str:
    return f'<p class="again">again: {code(line)}</p>' if line else ""


def _sections(account: Account, run: Ending) -> Iterator[str]:
    every = account.exhibits + account.others
    drawn = {e.world: number for number, e in reversed([*enumerate(every, 1)]) if _is_drawn(e)}
    exhibits = [*map(_exhibit, count(1), account.exhibits, repeat(drawn))]
    if account.left_out:
        exhibits.append(f"<p>{account.left_out} more are not shown here.</p>")
    refuted = account.extent.verdict == "REFUTED"
    results = _section("results", "Results", blocks_as_html(account.blocks, _places(account)))
    if account.results_first:
        yield results
    if exhibits and refuted:
        yield _section("counterexamples", "Counterexamples", exhibits)
    start = 1 + len(account.exhibits)
    numbered = map(_exhibit, count(start), account.others, repeat(drawn))
    worlds = [_section("worlds", "Worlds to look at", numbered)] if account.others else []
    if account.results_first:
        yield from worlds
    yield _section("judged", "What was judged", map(_suite, account.suites))
    if not account.results_first:
        yield results
    if exhibits and not refuted:
        yield _section("counterexamples", "Counterexamples, as expected", exhibits)
    if not account.results_first:
        yield from worlds
    yield _section("versions", "Versions", [_facts(run.versions.items())])
    times = (("written", f"{run.date:%Y-%m-%d %H:%M:%S} UTC"), ("took", f"{run.seconds:.1f} s"))
    yield _section("timing", "Timing", [_facts([*times, *_flat(run.timing)])])


def _flat(timing: Mapping[str, Any], before: str = "") -> Iterator[tuple[str, str]]:
    for name, value in timing.items():
        path = f"{before}, {name}" if before else name
        if isinstance(value, dict):
            yield from _flat(cast("dict[str, Any]", value), path)
        else:
            yield path, str(value)


def _section(name: str, title: str, parts: Iterator[str] | Sequence[str]) -> str:
    return "\n".join([f'<section id="{name}">', f"<h2>{title}</h2>", *parts, "</section>"])


def _facts(facts: Iterable[tuple[str, str]]) -> str:
    rows = (
        f"<tr><th>{xml_text(name)}</th><td>{xml_text(value)}</td></tr>" for name, value in facts
    )
    return f'<div class="wide"><table>{"".join(rows)}</table></div>'


def _suite(suite: JudgedSuite) -> str:
    head = "<tr><th>what</th><th>verdict</th><th>judged</th><th></th></tr>"
    rows = "\n".join(map(_case, suite.cases))
    return (
        f"<h3>{xml_text(clean(suite.name))}</h3>\n"
        f'<div class="wide" tabindex="0"><table class="cases"><thead>{head}</thead>\n'
        f"<tbody>{rows}</tbody></table></div>"
    )


def _case(case: JudgedCase) -> str:
    say = xml_text(clean(case.message))
    say += _again(case.again)
    return (
        f"<tr><td>{xml_text(clean(case.name))}</td>{toned(case.verdict, case.tone)}"
        f'<td class="number">{xml_text(case.judged)}</td><td class="say">{say}</td></tr>'
    )


# ---------------------------------------------------------------- counterexamples


def _places(account: Account) -> dict[str, str]:
    """Where the page shows the first run of each mapper."""
    numbered = enumerate(account.exhibits + account.others, 1)
    shown = [(e.runs[-1].name, _place(number)) for number, e in numbered if e.runs]
    return dict(reversed(shown))


def _place(number: int) -> str:
    return f"world-{number}"


def _is_drawn(exhibit: Exhibit) -> bool:
    return exhibit.whole or len(exhibit.world.edges) <= MOST_DRAWN


def _is_played(exhibit: Exhibit) -> bool:
    return bool(exhibit.runs) and _is_drawn(exhibit)


def _exhibit(number: int, exhibit: Exhibit, drawn: Mapping[World, int]) -> str:
    title = xml_text(clean(exhibit.title))
    notes = "".join(f"<li>{xml_text(clean(note))}</li>" for note in exhibit.notes)
    parts = [f'<article id="{_place(number)}">\n<h3>{title}</h3>']
    parts += [f"<ul>{notes}</ul>"] if notes else []
    first = drawn.get(exhibit.world, number)
    parts.append(_picture(exhibit, first if first != number else None))
    if _is_played(exhibit):
        parts.append(
            f'<details class="play" data-recording="run-{number}" data-title="{title}">'
            "<summary>Play the run, step by step</summary></details>"
        )
    return "\n".join([*parts, _again(exhibit.again), "</article>"])


def _picture(exhibit: Exhibit, elsewhere: int | None) -> str:
    world = exhibit.world
    size = f"{map_size(len(world.vertices), len(world.edges))}, genus {world.genus}"
    caption = xml_text(f"{clean(exhibit.name)}: {size}")
    if not _is_drawn(exhibit):
        return f'<p class="soft">{caption}; too large to be drawn here.</p>'
    if elsewhere is not None:
        link = f'<a href="#{_place(elsewhere)}">drawn in another run</a>'
        return f'<p class="soft">{caption}; {link}.</p>'
    image = picture(world.draw(), f"The world {clean(exhibit.name)}: {size}")
    return f"<figure>{image}<figcaption>{caption}</figcaption></figure>"


def _data(exhibits: Sequence[Exhibit], shell: PageShell | None) -> Iterator[str]:
    if shell is None:
        return
    yield _script("player", [shell.before, shell.after])
    for number, exhibit in enumerate(exhibits, 1):
        if _is_played(exhibit):
            data = recording(exhibit.world, exhibit.runs, name=exhibit.name)
            yield _script(f"run-{number}", data)


def _script(name: str, data: object) -> str:
    return f'<script type="application/json" id="{name}">{json_in_page(data)}</script>'
