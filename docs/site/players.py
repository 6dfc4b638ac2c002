"""The directive `player`: a command whose page is made by the build, and shown below it.

    ```{player}
    topo-verify replay m2/5 --target basic --player name.html
    ```

On GitHub the command alone is seen. The build runs it at the root of the repository; a `replay`
must end with a counterexample (exit code 1), every other command without (exit code 0).
"""

from __future__ import annotations

import shlex
import subprocess
import sys
from pathlib import Path, PurePosixPath

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.errors import ExtensionError
from sphinx.util.docutils import SphinxDirective

ROOT = Path(__file__).resolve().parents[2]
FOLDER = "players"


def make(command: str, folder: Path) -> str:
    """Run the command, and return the name of the page that it wrote into the folder.

    Raises:
        ExtensionError: it writes no page, or its exit code is not as it should be.
    """
    program, *line = shlex.split(command)
    name = line[-1]
    if program != "topo-verify" or line[-2] not in {"-o", "--player"}:
        raise ExtensionError(f"expected topo-verify … --player FILE, got {command!r}")
    folder.mkdir(parents=True, exist_ok=True)
    page = folder / name
    done = subprocess.run(  # noqa: S603  what stands on the project's own pages
        [sys.executable, "-m", "topo_verify", *line[:-1], str(page), "--quiet"],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    expected = 1 if line[0] == "replay" else 0
    if done.returncode != expected or not page.exists():
        raise ExtensionError(
            f"{command}: exit code {done.returncode}, expected {expected}\n{done.stderr}"
        )
    return name


class Player(SphinxDirective):
    """See the file's text."""

    has_content = True

    def run(self) -> list[nodes.Node]:
        """The command as code; on the site the page that it makes follows."""
        command = " ".join(self.content)
        code = nodes.literal_block(command, command, language="none")
        if self.env.app.builder.format != "html":
            return [code]
        name = make(command, Path(self.env.app.outdir) / FOLDER)
        up = "../" * (len(PurePosixPath(self.env.docname).parts) - 1)
        frame = (
            f'<p class="player"><a href="{up}{FOLDER}/{name}">The whole page</a></p>\n'
            f'<iframe class="player" src="{up}{FOLDER}/{name}" loading="lazy" '
            f'title="The player: {nodes.unescape(command)}"></iframe>'
        )
        return [code, nodes.raw("", frame, format="html")]


def setup(app: Sphinx) -> dict[str, bool]:
    """Called by Sphinx."""
    app.add_directive("player", Player)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
