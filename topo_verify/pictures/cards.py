"""Reports and findings as escaped HTML for notebooks; no statement rests on colour."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from html import escape

from topo_verify.checkers.findings import Finding, Judgement, Status
from topo_verify.errors import LINE, InputError, map_size, shown
from topo_verify.pictures import walk
from topo_verify.pictures.scenes import Playback
from topo_verify.world import io
from topo_verify.world.rooted_map import World

MOST_DRAWN = 80
"""Most edges of a world that a card draws: larger ones take seconds."""

_SIGNS: dict[Status, str] = {"ok": "✓", "failed": "✗", "undecided": "?"}


def report_card(
    head: str, judgements: Sequence[Judgement], playback: Playback | None, again: str
) -> str:
    """A run's claims with their coverage; with a finding also the world and the walk.

    Args:
        head: mapper, world, and how many claims hold.
        again: the replay command, or "".
    """
    failed = [judgement.findings for judgement in judgements if judgement.findings]
    parts = [f"<p><strong>{_text(head)}</strong></p>", _claims(judgements)]
    if failed:
        more = (f" … and {len(others)} more" if others else "" for _, *others in failed)
        items = (f"<li>{_sentence(of[0])}{n}</li>" for of, n in zip(failed, more, strict=True))
        parts += [f"<ul>{''.join(items)}</ul>"]
        if playback is not None:
            parts += [_picture(playback.world, "the world"), _walk(playback)]
        parts += _again(again)
    return _card(parts)


def finding_card(finding: Finding) -> str:
    """A finding: its sentence, what was expected and seen, its world and its witness."""
    rows = [
        (name, _value(value))
        for name, value in (("expected", finding.expected), ("seen", finding.seen))
        if value is not None
    ]
    parts = [f"<p>{_sentence(finding)}</p>"]
    if rows:
        cells = (f"<tr><th {_LEFT}>{name}</th><td {_LEFT}>{text}</td></tr>" for name, text in rows)
        parts.append(f"<table>{''.join(cells)}</table>")
    pictures = [
        _picture(world, label)
        for text, label in (
            (finding.world, "the world"),
            (finding.witness, "the witness, with the same history:"),
        )
        if (world := _named(text)) is not None and (label == "the world" or text != finding.world)
    ]
    return _card([*parts, *pictures, *_again(finding.replay)])


# ---------------------------------------------------------------- parts

_LEFT = 'style="text-align:left"'


def _card(parts: Sequence[str]) -> str:
    from topo_verify.pictures.drawing import IN_NOTEBOOKS

    return f'{IN_NOTEBOOKS}<div style="max-width:60em">{"".join(parts)}</div>'


def _text(text: str) -> str:
    return escape(shown(text, limit=LINE))


def _value(value: object) -> str:
    return f"<code>{_text(str(value))}</code>"


def _sentence(finding: Finding) -> str:
    place = "" if finding.event is None else f" (event {finding.event})"
    return f"<strong>{_text(finding.claim)}</strong>{place}: {_text(finding.message)}"


def _claims(judgements: Sequence[Judgement]) -> str:
    rows = (
        f"<tr><td {_LEFT}>{_text(judgement.claim)}</td>"
        f"<td {_LEFT}>{_SIGNS.get(judgement.status, '–')} {_text(judgement.status)}</td>"
        f"<td>{_coverage(judgement)}</td></tr>"
        for judgement in judgements
    )
    head = f"<tr><th {_LEFT}>claim</th><th {_LEFT}>status</th><th>judged</th></tr>"
    return f"<table><thead>{head}</thead><tbody>{''.join(rows)}</tbody></table>"


def _coverage(judgement: Judgement) -> str:
    if judgement.claim == "map-isomorphic" and not judgement.judged:
        return "no map"
    return f"{judgement.judged} of {judgement.of}"


def _picture(world: World, label: str) -> str:
    name = f" {world.name}" if world.name else ""
    size = f"{map_size(len(world.vertices), len(world.edges))}"
    caption = _text(f"{label}{name}: {size}")
    if len(world.edges) > MOST_DRAWN:
        return f"<p>{caption}</p>"
    from topo_verify.pictures.drawing import image

    picture = image(world.draw(), f"{label}{name}: {size}", "max-width:100%;max-height:16em")
    return (
        '<figure style="display:inline-block;margin:0 1em 1em 0;vertical-align:top">'
        f"{picture}<figcaption>{caption}</figcaption></figure>"
    )


def _walk(playback: Playback) -> str:
    lines = (escape(shown(line, limit=LINE)) for line in walk.lines(playback))
    font = "font-family:ui-monospace,Menlo,Consolas,monospace;white-space:pre;overflow-x:auto"
    return f'<pre style="{font}">{chr(10).join(lines)}</pre>'


def _again(command: str) -> Iterator[str]:
    if command:
        yield f"<p>again: <code>{_text(command)}</code></p>"


def _named(text: str | None) -> World | None:
    try:
        return io.from_text(text) if text else None
    except InputError:
        return None
