"""Blocks on a terminal and as Markdown; the palette, and that no statement rests on colour."""

from __future__ import annotations

import re
from collections.abc import Callable
from io import StringIO

import pytest

from topo_verify.pictures.page import part
from topo_verify.report import blocks as bl
from topo_verify.report.html import blocks_as_html
from topo_verify.report.markdown import markdown
from topo_verify.report.terminal import pretty


class Terminal(StringIO):
    def isatty(self) -> bool:
        return True


def printed(*blocks: bl.Block, out: StringIO | None = None) -> str:
    return pretty(blocks, StringIO() if out is None else out)


def test_long_texts_are_wrapped_and_command_lines_are_not() -> None:
    text, line = "word " * 40, "topo-verify replay " + "x" * 200
    assert max(map(len, printed(bl.Text(text)).splitlines())) <= 80
    assert printed(bl.Command(line, "again: ")) == f"  again: {line}\n"


def test_a_table_puts_numbers_flush_right_and_leaves_no_trailing_space() -> None:
    table = bl.TextTable(("name", ">cost"), [("a", "5"), ("long one", "1234")], title="costs")
    assert printed(table) == "costs\nname      cost\na            5\nlong one  1234\n"


def test_a_cell_that_is_too_long_is_folded_whole() -> None:
    text = printed(bl.TextTable(("name", ">cost"), [("n" * 120, "5")]))
    assert text.count("n" * 10) >= 10
    assert max(map(len, text.splitlines())) <= 80


def test_colour_is_for_terminals_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("NO_COLOR", "FORCE_COLOR"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("TERM", "xterm")
    table = bl.TextTable(("verdict",), [("REFUTED",)])
    assert "\x1b" not in printed(table)
    assert "\x1b[1;31m! REFUTED" in printed(table, out=Terminal())


def test_without_colours_a_verdict_that_is_no_pass_has_a_mark(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("NO_COLOR", "1")
    monkeypatch.setenv("TERM", "xterm")
    words = ("PROVED", "EXHAUSTED", "SAMPLED", "UNKNOWN", "REFUTED")
    table = bl.TextTable(("verdict",), [(word,) for word in words], headed=False)
    text = printed(table, out=Terminal())
    assert not re.search(r"\x1b\[[0-9;]*3[0-9]m", text)  # bold may be, no colour
    plain = re.sub(r"\x1b\[[0-9;]*m", "", text).split("\n")[:-1]
    assert [line.rstrip() for line in plain] == [
        *("PROVED", "EXHAUSTED", "SAMPLED"),
        *("? UNKNOWN", "! REFUTED"),
    ]


def test_a_refutation_that_was_expected_has_no_mark() -> None:
    table = bl.TextTable(("",), [(bl.Cell("REFUTED", "held"),), ("REFUTED",)], headed=False)
    assert printed(table) == "REFUTED\n! REFUTED\n"
    assert markdown([table]).splitlines()[2:] == ["| REFUTED |", "| ! REFUTED |"]


def test_the_verdict_that_opens_a_sentence_has_its_colour(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("NO_COLOR", raising=False)
    monkeypatch.setenv("TERM", "xterm")
    text = printed(bl.Text("REFUTED: 3 of 86"), bl.Text("REFUTED, they say"), out=Terminal())
    assert text == "\x1b[1;31mREFUTED\x1b[0m: 3 of 86\nREFUTED, they say\n"
    assert markdown([bl.Text("REFUTED: *3*")]) == "**REFUTED**: \\*3\\*\n"


LONG = f"m30/{'1234567890' * 4}321"


def test_a_long_id_is_shortened_for_reading_and_whole_in_commands() -> None:
    line, cell = f"topo-verify replay {LONG}", bl.Cell(LONG, whole=True)
    forms: tuple[Callable[[bl.Block], str], ...] = (printed, lambda block: markdown([block]))
    for form in forms:
        for block in (bl.Text(LONG), bl.Bullets((LONG,)), bl.TextTable(("w",), [(LONG,)])):
            assert "m30/12345…90321" in form(block)
            assert LONG not in form(block)
        assert line in form(bl.Command(line))
        assert LONG in form(bl.TextTable(("w",), [(cell,)]))
    assert printed(bl.Text("m11/123456789012")) == "m11/123456789012\n"


@pytest.mark.parametrize("width", [40, 50, 60, 80])
def test_no_number_and_no_verdict_is_broken_at_any_width(
    width: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", str(width))
    columns = ("part", "verdict", ">checked", ">total", "summary")
    row = ("sampled-worlds", "REFUTED", "119364119364", "119364119364", "word " * 30)
    live = bl.TextTable(columns[:2] + columns[4:], [(*row[:2], row[4])], widths=(16, 9, 0))
    text = printed(bl.TextTable(columns, [row]), live)
    assert max(map(len, text.splitlines())) <= width
    assert text.count("119364119364") == 2
    assert text.count("! REFUTED") == 2
    assert text.count("word") == 60


def test_a_row_with_fixed_widths_becomes_a_list_where_the_rest_is_too_narrow(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    live = bl.TextTable(
        ("part", "verdict", "summary"), [("p", "PROVED", "s " * 9)], widths=(16, 9, 0)
    )
    for width, lines in ((49, 1), (48, 3)):
        monkeypatch.setenv("COLUMNS", str(width))
        bare = bl.TextTable(live.columns, live.rows, widths=live.widths, headed=False)
        assert len(printed(bare).splitlines()) == lines


def test_a_row_without_room_becomes_a_list(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "30")
    table = bl.TextTable((">edges", "verdict", ">worlds"), [("7", "REFUTED", "1234567890")])
    assert printed(table) == "edges  verdict        worlds\n    7  ! REFUTED  1234567890\n"
    monkeypatch.setenv("COLUMNS", "24")
    assert printed(table) == "edges 7\n  verdict  ! REFUTED\n  worlds   1234567890\n"
    table = bl.TextTable(("family", ">mean", f">{'team' * 9}"), [("edges<=3", "3", "1.07 ±0.12")])
    assert "1.07" in printed(table), "a long title leaves room for the figure"


@pytest.mark.parametrize(
    "block",
    [
        bl.Text("\x1b[31m"), bl.Command("\x1b[31m"), bl.Bullets(("\x1b[31m",)),
        bl.TextTable(("\x1b[31m",), [("\x1b[31m",)], title="\x1b[31m"),
    ],
)  # fmt: skip
def test_control_characters_never_reach_the_terminal(block: bl.Block) -> None:
    assert "\x1b" not in printed(block) + markdown([block])


def test_square_brackets_are_no_markup() -> None:
    assert printed(bl.Text("[bold]a[/bold] :smile:")) == "[bold]a[/bold] :smile:\n"


def test_markdown_keeps_special_characters_from_doing_anything() -> None:
    table = markdown([bl.TextTable(("a|b", ">n"), [("x|y*z<b>", "1")])])
    assert table == "| a\\|b | n |\n| --- | ---: |\n| x\\|y\\*z\\<b> | 1 |\n"
    assert markdown([bl.Command("a `b` c", "again: ")]) == "again: `` a `b` c ``\n"


@pytest.mark.parametrize(
    ("text", "written"),
    [
        ("by @someone, see", "by `@someone,` see"),
        ("a@b.c", "`a@b.c`"),
        ("at https://evil.example/x_y", "at `https://evil.example/x_y`"),
        ("www.evil.example", "`www.evil.example`"),
        ("fixes #12", "fixes `#12`"),
        ("GH-12", "`GH-12`"),
        ("`@x", "`` `@x ``"),
        ("[a](b) ![c](d)", "\\[a\\](b) !\\[c\\](d)"),
        ("*a* _b_ __c__ ~~d~~ e_f", "\\*a\\* \\_b\\_ \\_\\_c\\_\\_ \\~\\~d\\~\\~ e_f"),
        ("<img src=x> &#64;x $x$", "\\<img src=x> `&#64;x` \\$x\\$"),
        ("&lt;", "\\&lt;"),
        ("# a", "\\# a"),
        ("- a", "\\- a"),
        ("    a", "a"),
        ("1. a", "1\\. a"),
        ("> a", "\\> a"),
        ("---", "\\---"),
        ("a\n# b", "a\\\\n# b"),
    ],
)
def test_markdown_of_unknown_origin_is_plain_text(text: str, written: str) -> None:
    assert markdown([bl.Text(text)]) == written + "\n"
    assert markdown([bl.Bullets((text,))]) == f"- {written}\n"


def test_markdown_keeps_each_row_of_a_table_in_its_cells() -> None:
    table = markdown([bl.TextTable(("@a|b",), [("- @c|`d` e|f",)])])
    assert table == "| `@a\\|b` |\n| --- |\n| - `` @c\\|`d` `` e\\|f |\n"


def test_a_block_for_another_program_cannot_end_itself() -> None:
    assert markdown([bl.Raw("a\n```\n@x")]) == "````\na\n```\n@x\n````\n"


def test_markdown_joins_blocks_with_blank_lines() -> None:
    blocks: list[bl.Block] = [
        bl.Text("one"),
        bl.Text(""),
        bl.Bullets(("a", "b")),
        bl.Raw("{}"),
        bl.TextTable(("t",), [], title="T"),
    ]
    assert markdown(blocks) == "one\n\n- a\n- b\n\n```\n{}\n```\n\n**T**\n\n| t |\n| --- |\n"


def test_the_palette_is_that_of_the_player() -> None:
    colour = r"--([a-z]+): ?light-dark\((#[0-9a-f]{6}),(#[0-9a-f]{6})\)"
    assert {name: pair for name, *pair in re.findall(colour, part("page.css"))} == {
        name: [*pair] for name, pair in bl.PALETTE.items()
    }


def test_the_verdicts_begin_with_different_letters() -> None:
    assert len({verdict[0] for verdict in bl.VERDICTS}) == len(bl.VERDICTS)


def test_every_tone_has_a_colour_everywhere() -> None:
    assert set(bl.TONES.values()) == bl.OF_TONE.keys() == bl.ON_TERMINAL.keys()
    assert set(bl.OF_TONE.values()) <= bl.PALETTE.keys()


def _luminance(colour: str) -> float:
    channels = (int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5))
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in channels]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def test_every_tone_can_be_read_on_a_card() -> None:
    for name in (*bl.OF_TONE.values(), "ink", "soft"):
        for ours, card in zip(bl.PALETTE[name], bl.PALETTE["card"], strict=True):
            low, high = sorted((_luminance(ours), _luminance(card)))
            assert (high + 0.05) / (low + 0.05) >= 4.5, name


def test_rows_of_many_columns_are_stacked_on_a_phone() -> None:
    many = bl.TextTable(("a", ">b", ">c", ">d", ">e"), [("1", "2", "3", "4", "5")])
    few = bl.TextTable(("a", ">b"), [("1", "2")])
    page = "".join(blocks_as_html([many]))
    assert '<table class="many">' in page
    assert page.count("<td") == page.count('data-title="')  # shown before each cell on a phone
    assert "<table><thead>" in "".join(blocks_as_html([few]))
