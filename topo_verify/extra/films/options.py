"""`explore --svg FILE`: the run as an animated SVG."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from topo_verify.pictures.scenes import Playback


@dataclass(frozen=True)
class FilmFile:
    """The file that --svg names."""

    name: str

    def write(self, playback: Playback, mapper: str) -> None:
        """Write the film of a run; InputError: the run is too long."""
        from topo_verify.extra.films.film import animated_svg
        from topo_verify.world.formats import files

        files.write(self.name, animated_svg(playback, name=mapper))


def _film_file(
    _context: click.Context, _option: click.Parameter, value: str | None
) -> FilmFile | None:
    return None if value is None else FilmFile(value)


svg = click.option(
    "--svg",
    callback=_film_file,
    metavar="FILE",
    help="Write an animated SVG of the run (one short run only).",
)
