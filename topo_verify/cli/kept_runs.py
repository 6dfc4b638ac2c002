"""The stores of runs that commands keep, and what they print about them."""

from __future__ import annotations

from collections.abc import Generator, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext
from pathlib import Path

from topo_verify.campaign.backend import MapperCampaign
from topo_verify.campaign.row import Row
from topo_verify.campaign.store import Store
from topo_verify.cli.output import Output
from topo_verify.errors import plural
from topo_verify.programs.loaded import watch

STORE, OLD_STORE = "runs.db", "runs.jsonl"
"""The file in the folder that keeps the runs; the one in which version 0.2 kept them."""


@contextmanager
def open_store(output: Output, folder: Path | None) -> Generator[Store | None]:
    """The store in a folder; None without a folder.

    Raises:
        InputError: the file cannot be used.
    """
    if folder is None:
        yield None
        return
    if (folder / OLD_STORE).exists() and not (folder / STORE).exists():
        output.note(
            f"topo-verify 0.2 or before wrote {folder / OLD_STORE}: its runs are made again, in"
            f" {STORE}; remove the old file"
        )
    with Store(folder / STORE) as store:
        yield store


def opened(path: str | None) -> AbstractContextManager[Store | None]:
    """The store in a file; None without a file."""
    if path is None:
        return nullcontext()
    watch()  # before a mapper is loaded
    return Store(path)


def stored_rows(
    output: Output, campaigns: Sequence[MapperCampaign], workers: int, store: Store | None
) -> Iterator[Row]:
    """The rows of all campaigns; missing ones are made, and kept in the store."""
    total = sum(campaign.total for campaign in campaigns)
    if store is not None:
        output.timing["from_store"] = stored = sum(campaign.stored for campaign in campaigns)
        if stored:
            output.note(f"{stored} of {plural(total, 'run')} are in {store.path}")
    try:
        for campaign in campaigns:
            yield from campaign.rows(workers, output.progress)
    except KeyboardInterrupt:
        if store is not None:
            stored = sum(campaign.stored for campaign in campaigns)
            output.note(
                f"{stored} of {plural(total, 'run')} are kept in {store.path}; the same command"
                " goes on"
            )
        raise
