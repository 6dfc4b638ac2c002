"""What is wrong with the file of a ledger, in a sentence that says what to do."""

from __future__ import annotations

import sqlite3
from collections.abc import Generator
from contextlib import contextmanager

from topo_verify.errors import InputError
from topo_verify.text import shown


def no_ledger(path: str) -> InputError:
    """The database is something else."""
    return InputError(f"{path} is a database, but no ledger: name another file")


def changed(path: str, what: str) -> InputError:
    """A part of the ledger was changed after it was written."""
    return InputError(
        f"ledger {path}: {what} is not what topo-verify wrote: copy the file again, or remove it"
        " and search anew"
    )


@contextmanager
def explained(path: str) -> Generator[None]:
    """Turn an error of SQLite's into an InputError that says what to do."""
    try:
        yield
    except InputError:  # it is a ValueError, too
        raise
    # Of a changed file: text that is no text, numbers beyond all bounds.
    except (UnicodeError, ValueError, OverflowError, MemoryError) as error:
        raise changed(path, f"the database ({shown(str(error))})") from error
    except sqlite3.Error as error:
        message = shown(str(error))
        if "locked" in message:
            message = "another search has it open: wait for its end, or name another file"
        elif "not a database" in message:
            message = "it is no ledger: name another file"
        elif "readonly" in message or "read-only" in message:
            message = "it cannot be written: name a file that can"
        elif "unable to open" in message:
            message = "it cannot be opened: name a file in a folder that can be written"
        elif "full" in message or "I/O" in message:
            message += "; what was recorded before is kept: make room and start again"
        else:
            message += "; name another file, or remove this one to search anew"
        raise InputError(f"ledger {path}: {message}") from error
