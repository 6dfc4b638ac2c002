"""Accounts for the tests of their forms."""

from __future__ import annotations

from dataclasses import replace
from datetime import UTC, datetime

from tests.pictures.played import played
from topo_verify.report import account as acc
from topo_verify.report.blocks import Bullets, Command, Raw, Text, TextTable, View
from topo_verify.world import World

HOSTILE = (
    "</script><script>alert(1)</script><img src=x onerror=alert(1)>\"'\x1b[31m{style}&lt;\ud800"
)
"""Text that would end a script, an attribute or a colour, or stand in for a part of the page."""

LONG_ID = f"m30/{'1234567890' * 4}321"

RUN = acc.Ending(
    command="verify",
    again="topo-verify verify",
    code=1,
    finished=True,
    date=datetime(2026, 1, 2, 3, 4, 5, tzinfo=UTC),
    seconds=1,
    versions={"topo-verify": "1.2.3"},
)


def account(text: str = "a text", *, exhibit: bool = True) -> acc.Account:
    """An account with one case of each outcome, in which this text stands everywhere."""
    cases = (
        acc.JudgedCase("first", "ok", "passed", "3 of 3"),
        acc.JudgedCase(text, "failed", "failed", "3 of 3", text, f"topo-verify replay {text}"),
        acc.JudgedCase("third", "UNKNOWN", "undecided", message=text),
        acc.JudgedCase("fourth", "not-declared", "not-judged", "0 of 3", text),
    )
    world = replace(World.from_id("m3/14"), name=text, vertex_names=(text,) * 3)
    run = played(world, "basic", name=text)
    shown = acc.Exhibit(text, world, text, (text,), (run,), f"topo-verify replay {text}")
    blocks = (
        Text(text),
        Text(f"REFUTED: {text}"),
        Command(f"topo-verify replay {text}", "again: "),
        Bullets((text,)),
        Raw(text),
        View(lambda width: (f"{width}",)),
        TextTable((text, ">n"), [(text, "5"), ("REFUTED", "6")], title=text),
    )
    return acc.Account(
        about=text,
        extent=acc.JudgedExtent("REFUTED", "1 of 3 worlds fail"),
        suites=(acc.JudgedSuite(text, cases),),
        blocks=blocks,
        exhibits=(shown,) if exhibit else (),
    )
