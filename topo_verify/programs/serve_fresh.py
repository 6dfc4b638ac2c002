"""A Python mapper for `Foreign` that plays each world in a process of its own.

This process loads all that a mapper needs but the mapper, and forks for each world: that takes some
milliseconds, to start Python anew takes a few hundred. What such a fork does to itself it does to
nobody else; if a signal ends it, this process ends itself by the same.

What this does not show: that nothing is left of an earlier world on the disk or in the environment.
All forks have the same hash seed.
"""

from __future__ import annotations

import os
import signal
from typing import BinaryIO

import msgspec

from topo_verify.errors import InputError
from topo_verify.programs import isolation
from topo_verify.programs import protocol as ms
from topo_verify.programs.loader import load
from topo_verify.programs.serve import LATE, play_once

_to_child: msgspec.json.Decoder[ms.ToChild] = msgspec.json.Decoder(ms.ToChild)


def fresh(text: str) -> None:
    """Serve the mapper of a TARGET; this is what the process runs."""
    reader, writer = isolation.private_pipes()
    writer.write(msgspec.json.encode(ms.ReadyMessage()) + b"\n")
    writer.flush()
    for line in reader:
        message = _to_child.decode(line)
        if isinstance(message, LATE):
            continue
        if not isinstance(message, ms.StartMessage):
            return
        played = os.fork()
        if played == 0:
            _play(text, message, reader, writer)
        _, status = os.waitpid(played, 0)
        _end_likewise(os.waitstatus_to_exitcode(status))


def _play(text: str, start: ms.StartMessage, reader: BinaryIO, writer: BinaryIO) -> None:
    """Play one world and end this process."""
    code = 1
    try:
        try:
            mapper = load(text)
        except InputError as error:
            answer: object = ms.UndeliveredMessage("no-map", str(error))
            writer.write(msgspec.json.encode(answer) + b"\n")
        else:
            play_once(mapper, start, reader, writer)
        writer.flush()
        code = 0
    finally:
        os._exit(code)


def _end_likewise(code: int) -> None:
    """End this process as the one that played ended, unless that was done with its world."""
    if code < 0:
        signal.signal(-code, signal.SIG_DFL) if -code != signal.SIGKILL else None
        os.kill(os.getpid(), -code)
    elif code > 0:
        os._exit(code)
