"""`explore --svg FILE`: one short run as an animated SVG."""

from __future__ import annotations

from pathlib import Path

from tests.cli.conftest import Call, Refused

RUN_SVG = "'family:lattice(2,4,holes=0.1,seed=2)' --target enhancement-ii --svg"
DOCS = Path(__file__).parents[3] / "docs"


def test_the_animation_in_the_docs_is_remade_byte_for_byte(call: Call) -> None:
    assert call(f"explore {RUN_SVG} run.svg").exit_code == 0
    made = Path("run.svg").read_bytes()
    assert made == (DOCS / "run.svg").read_bytes()
    assert len(made) < 60_000
    assert (
        f"topo-verify explore {RUN_SVG} docs/run.svg" in (DOCS / "extra" / "films.md").read_text()
    )


def test_an_animation_is_of_one_short_run(refused: Refused) -> None:
    refused(
        "explore m3/14 --target basic,folding --svg run.svg",
        "--svg run.svg: expected one run, got 2",
    )
    refused(
        "explore nyc --target basic --svg run.svg",
        "1468 moves; an animated SVG shows at most 500 events",
    )
    assert not Path("run.svg").exists()
