"""`topo-verify header`: the C interface of native mappers."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import click
import msgspec

from topo_verify.cli import options
from topo_verify.cli.output import Output, Result, written
from topo_verify.programs.library import VERSION, header_text
from topo_verify.report.blocks import Block
from topo_verify.world.formats import files


class HeaderEntry(msgspec.Struct, frozen=True):
    """The interface of native mappers.

    Attributes:
        interface: its version, `TV_VERSION`.
        file: the header's file; null without -o.
        text: the header; null with -o.
    """

    interface: int
    file: str | None
    text: str | None


@options.command("header", "header -o topo_verify.h")
@click.option("-o", "file", metavar="FILE", help="Write the header to FILE.")
def header(output: Output, *, file: str | None) -> int:
    """Print topo_verify.h, the C interface of native mappers.

    A native mapper is a function in a shared library, in C or any language callable from C.
    """

    def headers() -> Iterator[Result[HeaderEntry]]:
        text = header_text()
        if file is None or file == "-":
            yield Result(HeaderEntry(VERSION, None, text.rstrip("\n")))
        else:
            files.write(file, text)
            yield Result(HeaderEntry(VERSION, file, None))

    return output.run("header", headers, _show)


def _show(entries: Sequence[HeaderEntry]) -> Iterator[Block]:
    for entry in entries:
        yield written(entry.text, interface=str(entry.interface), file=entry.file)
