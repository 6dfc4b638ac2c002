"""How Sphinx builds the site of docs/: make docs.

Every page reads well on GitHub, too. So the pages use links and lists of plain Markdown, and what
makes a site of them is done by the extensions in docs/site/, one file each:

    contents.py    the table of contents, read from the lists of index.md
    glossary.py    links from the words on every page to glossary.md
    players.py     commands whose page is made by the build and shown below them
    notebook.py   a notebook, with what its cells show
    codelines.py   links to the code, tests and Coq that pages of explanation/ name
    breaks.py      where long names in tables may be broken
    finding.py     the site's search, beside the page of docs/search.md
    checked.py     every link and anchor of the finished pages
"""

import sys
from pathlib import Path

import topo_verify

sys.path[:0] = [str(Path(__file__).parent / "site"), str(Path(__file__).parent)]

import reference  # noqa: E402  docs/reference.py

reference.PAGE.write_text(reference.page(), encoding="utf-8")  # not in git: --help says the same

project = "topo-verify"
author = "the maintainers of topo-verify"
version = release = topo_verify.__version__

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.doctest",
    "sphinx.ext.napoleon",
    "contents",
    "glossary",
    "players",
    "notebook",
    "codelines",
    "breaks",
    "finding",
    "checked",
]
exclude_patterns = ["site", "reference/_commands.md"]

# --- strictness: with -W a warning ends the build ----------------------------------------------

nitpicky = True
smartquotes = False  # two hyphens begin an option
# What other projects define is not on this site; intersphinx would need a network. Names of
# topo_verify itself must be found.
nitpick_ignore_regex = [(r"py:.*", r"(?!topo_verify\.).*")]
# Types inside the rooms that stand in public signatures, where nobody needs to make one.
nitpick_ignore = [
    ("py:class", f"topo_verify.{name}")
    for name in (
        "algorithms.exploration.Rule",
        "algorithms.motion.Choice",
        "algorithms.motion.Executed",
        "algorithms.motion.Hypothesis",
        "checkers.folding.Fold",
        "campaign.judge.JudgedRun",
        "campaign.campaign.Backend",
        "campaign.campaign.Campaign",
        "campaign.campaign.Shard",
        "campaign.campaign.ShardMemory",
        "campaign.campaign.ShardResult",
        "campaign.row.PolicyCosts",
        "campaign.row.Row",
        "campaign.tally.Pairs",
        "campaign.tally.Tally",
        "campaign.worker.Beat",
        "pictures.scenes.Playback",
        "programs.loader.Target",
        "programs.misbehaviour.Misbehaved",
        "strategies.notes.ObservedRun",
    )
]

# --- Markdown ----------------------------------------------------------------------------------

myst_heading_anchors = 4  # GitHub's anchors of headings
myst_enable_extensions = []
highlight_language = "none"  # a block that names no language is what a command prints
suppress_warnings = ["myst.header"]  # a page that another one includes may begin anywhere

# --- Python ------------------------------------------------------------------------------------

autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_typehints_format = "short"
napoleon_google_docstring = True
napoleon_numpy_docstring = False
napoleon_use_ivar = True
doctest_test_doctest_blocks = "default"
# Examples use the names of their modules, as pytest runs them.
doctest_global_setup = "from topo_verify import *; from topo_verify.strategies import *"

# --- looks -------------------------------------------------------------------------------------

html_theme = "furo"
html_title = f"topo-verify {release}"
html_show_sphinx = False
html_show_copyright = False
html_copy_source = False
html_static_path = ["site/static"]
html_css_files = ["site.css"]
