"""Single flipped bits in a ledger and in a baseline.

The file is refused with one sentence and exit code 2, or the results are those of the whole file:
the bit was padding, or in a field that nothing reads.

    trials      the whole command in a process: a tenth of a second each
    openings    a ledger is opened as a search opens it, and every row read: a millisecond each

A search reads only the rows of a ledger, so `openings` can try every bit.
"""

from __future__ import annotations

from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory

from formats import FORMATS
from mutations import flipped
from readers import Count, attempt

from topo_verify.campaign.campaign import Ranks
from topo_verify.campaign.identity import source_hash
from topo_verify.campaign.store import Store
from topo_verify.campaign.targets import targets
from topo_verify.errors import InputError
from topo_verify.programs.loaded import Loaded
from topo_verify.studies.search.search import search_campaign


def bits(name: str) -> int:
    """The number of bits in the file of this format."""
    (data,) = FORMATS[name].seeds()
    return 8 * len(data)


def chosen(name: str, number: int, seed: int) -> list[int]:
    """The bits to flip: all, or this many at random, in order."""
    total = bits(name)
    if number >= total:
        return list(range(total))
    return sorted(Random(f"{seed} {name}").sample(range(total), number))


def trials(name: str, places: list[int], keep: Path) -> Count:
    """Flip each of these bits separately."""
    (data,) = FORMATS[name].seeds()
    count = Count()
    for bit in places:
        outcome, wrong = attempt(name, flipped(data, bit))
        count.take(outcome)
        if wrong is not None:
            count.convict(
                f"flip-{name}-{bit}{FORMATS[name].suffix}", flipped(data, bit), wrong, keep
            )
    return count


def openings(places: list[int], keep: Path) -> Count:
    """Flip each of these bits of a ledger separately, open it, and read every row."""
    (data,) = FORMATS["ledger"].seeds()
    count = Count()
    with TemporaryDirectory() as folder:
        path = Path(folder) / "flipped.ledger"
        whole = _rows(path, data)
        for bit in places:
            count.trials += 1
            wrong = None
            try:
                if _rows(path, flipped(data, bit)) != whole:
                    wrong = "read as another ledger"
            except InputError as refused:
                count.refused += 1
                if not str(refused).isprintable():
                    wrong = f"no printable sentence: {str(refused)!r}"
            except Exception as error:  # noqa: BLE001  whatever it is, it is wrong
                wrong = repr(error)
            if wrong is not None:
                count.convict(f"opened-{bit}.ledger", flipped(data, bit), wrong, keep)
    return count


def _rows(path: Path, data: bytes) -> object:
    path.write_bytes(data)
    mappers = targets("basic")
    campaign = search_campaign(mappers, edges=3)
    with Store(path) as store:
        known = store.campaign(campaign.identity(source_hash(mappers)), Loaded())
        results = [known.get(shard) for shard in Ranks(3).shards()]
        assert all(result is not None for result in results), "the store is of a finished search"
        return results, known.known(), known.loaded, known.since
