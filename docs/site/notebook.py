"""A notebook as a page: the block `{notebook} examples/NAME.ipynb` becomes its cells and results.

The cells run in this process, in the notebook's folder, one after the other. No kernel is needed,
and on GitHub the page shows the name alone.
"""

from __future__ import annotations

import ast
import json
import os
import re
import sys
from contextlib import chdir, redirect_stdout
from html import escape
from io import StringIO
from pathlib import Path
from typing import Any

from sphinx.application import Sphinx

ROOT = Path(__file__).resolve().parents[2]
BLOCK = re.compile(r"^```\{notebook\} (\S+)\n```$", re.MULTILINE)


def shown(code: str, names: dict[str, Any]) -> str:
    """What a cell shows, as HTML: printed text, and the value of its last expression."""
    tree = ast.parse(code)
    last = tree.body.pop() if tree.body and isinstance(tree.body[-1], ast.Expr) else None
    printed = StringIO()
    with redirect_stdout(printed):
        exec(compile(tree, "<cell>", "exec"), names)  # noqa: S102  our own notebook
        value: Any = eval(ast.unparse(last), names) if last else None  # noqa: S307
    html = f"<pre>{escape(printed.getvalue())}</pre>" if printed.getvalue() else ""
    if plt := names.get("plt"):
        for number in plt.get_fignums():
            plt.figure(number).savefig(picture := StringIO(), format="svg")
            inside = picture.getvalue().partition("<svg")[2].replace("#ffffff", "none")
            inside = inside.replace("#000000", "currentColor")  # the theme's, light or dark
            html += f"<svg style='max-width:100%;height:auto;fill:currentColor'{inside}"
        plt.close("all")
    if hasattr(value, "_repr_html_"):
        return html + value._repr_html_()
    return html if value is None else f"{html}<pre>{escape(repr(value))}</pre>"


def page(path: Path) -> str:
    """The notebook as Markdown of MyST."""
    names: dict[str, Any] = {"__name__": path.stem}
    parts: list[str] = []
    sys.path.insert(0, str(path.parent))
    with chdir(path.parent):
        for cell in json.loads(path.read_text(encoding="utf-8"))["cells"]:
            text = "".join(cell["source"])
            if cell["cell_type"] == "code":
                parts.append(f"```python\n{text}\n```")
                parts.append(f"``````{{raw}} html\n{shown(text, names)}\n``````")
            else:
                text = re.sub(r"\A# .*\n", "", text)  # the page has a title
                text = re.sub(r"\]\(\.\./docs/", "](../", text)
                parts.append(re.sub(r"\[([^]]*\.py)\]\([^)/]*\.py\)", r"`\1`", text))
    sys.path.remove(str(path.parent))
    return "\n\n".join(parts)


def _read(_app: Sphinx, _page: str, source: list[str]) -> None:
    source[0] = BLOCK.sub(lambda found: page(ROOT / found[1]), source[0])


def setup(app: Sphinx) -> dict[str, bool]:
    """Called by Sphinx."""
    os.environ.setdefault("MPLBACKEND", "svg")  # a plot opens no window
    app.connect("source-read", _read)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
