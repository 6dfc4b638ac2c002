"""Damaged caches of machine code: the kernel gives its own result, or one sentence is printed.

A trial damages one to three files in a cache with the machine code of a kernel and of another
version, which has another result. Then a process runs the kernel:

- the result is that of this version's sources;
- or, where a folder replaces a file, the cache is refused with a sentence that names it;
- no partial file stays behind.

Without numba there is no trial.
"""

from __future__ import annotations

import os
import shutil
import sys
from collections.abc import Callable
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory
from unittest.mock import patch

from mutations import flipped
from readers import Count
from trial import objection, run

from topo_verify import extras
from topo_verify.errors import InputError
from topo_verify.extra.fast.kernels import kernel
from topo_verify.extra.fast.kernels.events import digest
from topo_verify.extra.fast.kernels.kernel import compiled, module_source
from topo_verify.extra.fast.kernels.workspace import SMALL


def result(folder: Path) -> int:
    """The kernel's result in a fresh process with the cache in this folder."""
    import numpy as np

    os.environ["TOPO_VERIFY_CACHE"] = str(folder)
    kernel.cache_folder.cache_clear()
    kernel.machine_code.cache_clear()
    trace = SMALL.at("trace.word")
    words = np.zeros(trace + 3, np.int64)
    words[SMALL.at("trace.size")], words[trace:] = 3, (3, 5, 7)
    return int(compiled(digest, SMALL)(words))


def fill_both(folder: Path) -> int:
    """Fill a cache with both versions; this one's result."""
    true = result(folder)
    other = module_source(SMALL).replace("return h", "return h + 1")
    with patch.object(kernel, "module_source", lambda *_layout, **_checked: other):
        assert result(folder) != true
    return true


def command(words: list[str]) -> None:
    """Run the kernel with the cache in a folder, and print its result."""
    try:
        print(result(Path(words[0])))
        sys.exit(0)
    except InputError as refused:
        # What was said before, of the damage, is no part of the refusal.
        sys.stderr.seek(0)
        sys.stderr.truncate()
        print(f"topo-verify: {refused}", file=sys.stderr)
        sys.exit(2)


# ---------------------------------------------------------------- damages


def flip(draw: Random, file: Path, _others: list[Path]) -> None:
    """Flip one bit."""
    data = file.read_bytes()
    file.write_bytes(flipped(data, draw.randrange(8 * len(data))) if data else b"\0")


def cut(draw: Random, file: Path, _others: list[Path]) -> None:
    """Cut off the end."""
    file.write_bytes(file.read_bytes()[: draw.randrange(file.stat().st_size or 1)])


def fill(draw: Random, file: Path, _others: list[Path]) -> None:
    """Random bytes."""
    file.write_bytes(draw.randbytes(draw.randrange(2000)))


def swap(draw: Random, file: Path, others: list[Path]) -> None:
    """Swap in a file of either version, if possible of the same name."""
    alike = [other for other in others if other.name == file.name] or others
    file.write_bytes(draw.choice(alike).read_bytes())


def remove(_draw: Random, file: Path, _others: list[Path]) -> None:
    """Remove the file."""
    file.unlink()


def make_folder(_draw: Random, file: Path, _others: list[Path]) -> None:
    """Put a folder in its place."""
    file.unlink()
    file.mkdir()


DAMAGES: tuple[Callable[[Random, Path, list[Path]], None], ...] = (
    *(flip, flip, cut, fill, swap, swap, remove, make_folder),
)


def trial(folder: Path, true: int, seed: str, count: Count) -> str | None:
    """Damage a cache and run the kernel; an objection, or None."""
    draw = Random(seed)
    done = list[str]()
    for _ in range(draw.randint(1, 3)):
        files = sorted(file for file in folder.rglob("*") if file.is_file())
        file, damage = draw.choice(files), draw.choice(DAMAGES)
        damage(draw, file, [other for other in files if other != file])
        done.append(f"{damage.__name__} {file.name}")
    outcome = run([str(folder)], program=command)
    count.take(outcome)
    wrong = objection(outcome, (0, 2))
    if wrong is None and outcome.code == 2:
        if "make_folder" not in " ".join(done) or str(folder) not in outcome.stderr:
            wrong = f"refused: {outcome.stderr}"
    elif wrong is None and outcome.stdout.strip() != str(true):
        wrong = f"the result {outcome.stdout.strip()}, expected {true}"
    if wrong is None and (partial := [*folder.rglob("*.new"), *folder.rglob("*.tmp.*")]):
        wrong = f"left {partial[0].name}"
    return None if wrong is None else f"{', '.join(done)}: {wrong}"


def trials(seeds: list[str]) -> Count:
    """Damage a cache by each of these seeds."""
    count = Count()
    if extras.missing_packages("fast"):
        return count
    with TemporaryDirectory() as place:
        os.chdir(place)
        true = fill_both(Path("whole").absolute())
        for seed in seeds:
            folder = Path("damaged").absolute()
            shutil.copytree("whole", folder)
            wrong = trial(folder, true, seed, count)
            shutil.rmtree(folder)
            if wrong is not None:
                count.wrong.append(f"cache, seed {seed!r}: {wrong}"[:400])
    return count
