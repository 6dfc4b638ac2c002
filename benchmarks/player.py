"""The player's figures: the size of a page, how soon it opens, and how fast it plays.

    OPENBLAS_NUM_THREADS=1 .venv/bin/python benchmarks/player.py

`drawn s`, `made s`: processor time of the world's picture, and of the whole page. In headless
Chromium: `opens`, to the first step; `steps/s`, at the highest speed; `seeks`, the median of jumps.
"""

from __future__ import annotations

import shutil
import tempfile
import time
from pathlib import Path
from typing import Any

from topo_verify import World, families
from topo_verify.campaign.run import explore
from topo_verify.checkers import check
from topo_verify.pictures.drawing import lay_out
from topo_verify.pictures.page import player_page
from topo_verify.pictures.recording import PlayedRun
from topo_verify.world.resolve import resolve_world

ROADS = Path(__file__).resolve().parent.parent / "tests" / "data" / "worlds" / "sumo_A10KW.json"

SEEK = """
() => {
  const slider = document.getElementById('slider');
  const times = [];
  for (let k = 0; k < 60; k += 1) {
    slider.value = Math.floor(((k * 37) % 60) / 60 * slider.max);
    const begin = performance.now();
    slider.dispatchEvent(new Event('input'));
    document.body.offsetHeight;
    times.push(performance.now() - begin);
  }
  return times.sort((a, b) => a - b)[30];
}
"""


def measured(page: Any, file: Path) -> tuple[float, float, float]:
    """Seconds to open the page, steps a second, and milliseconds of a jump."""
    page.goto(file.as_uri())
    opened: float = page.evaluate("performance.getEntriesByType('navigation')[0].loadEventEnd")
    seek: float = page.evaluate(SEEK)
    page.keyboard.press("Home")
    page.select_option("#speed", "max")
    page.click("#play")
    first, begin = int(page.input_value("#slider")), time.perf_counter()
    page.wait_for_timeout(3000)
    steps = int(page.input_value("#slider")) - first
    return opened / 1000, steps / (time.perf_counter() - begin), seek


def main() -> None:
    from playwright.sync_api import sync_playwright

    program = shutil.which("chromium") or shutil.which("chromium-browser")
    runs = [
        ("nyc", resolve_world("nyc"), "basic"),
        ("roads around junctions", World.load(ROADS), "folding"),
        ("lattice 20x20", families.lattice(20, 20), "folding"),
        ("lattice 20x20", families.lattice(20, 20), "enhancement-ii"),
    ]
    head = "world                   edges  algorithm        moves     kB"
    print(f"{head}  drawn s  made s  opens s  steps/s  seeks ms")
    lay_out(World.from_id("m5/17"))  # what is imported late
    with sync_playwright() as playwright, tempfile.TemporaryDirectory() as folder:
        browser = playwright.chromium.launch(executable_path=program)
        for number, (name, world, algorithm) in enumerate(runs):
            run = explore(world, algorithm)
            played = PlayedRun(algorithm, run.trace, check(world, run.trace), run.stopped)
            begin = time.process_time()
            lay_out(world)
            drawn = time.process_time() - begin
            text = player_page(world, [played], name=name)
            made = time.process_time() - begin - drawn
            file = Path(folder) / f"{number}.html"
            file.write_text(text, encoding="utf-8")
            page = browser.new_page(viewport={"width": 1400, "height": 900})
            opened, steps, seek = measured(page, file)
            size = len(text.encode()) / 1000
            print(
                f"{name:<23} {len(world.edges):>5}  {algorithm:<15} {run.cost:>6} {size:>6.0f}"
                f" {drawn:>8.2f} {made:>7.2f} {opened:>8.2f} {steps:>8.0f} {seek:>9.1f}"
            )
            page.close()
        browser.close()


if __name__ == "__main__":
    main()
