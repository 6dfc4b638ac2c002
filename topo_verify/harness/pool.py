"""Shards examined by other processes: started afresh, never forked, and none survives this one.

A worker that dies takes its shard with it; the shard is tried again. If it kills its worker a
second time it is cut around the world where the worker was last seen, and the pieces are tried,
down to the one world that does it twice: a finding, for no map was delivered. So is a world in
which a worker gives no sign of life for longer than any limit allows: a mapper that cannot be
interrupted.

Life cycle of a `Crew`: `with` it, `examine` once; on leaving, whatever still works is killed.
"""

from __future__ import annotations

import json
import os
import selectors
import signal
import subprocess
import sys
from collections import deque
from collections.abc import Generator, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from itertools import pairwise
from tempfile import TemporaryFile
from time import monotonic
from types import TracebackType
from typing import IO, Self

import msgspec

from topo_verify.checkers import Finding
from topo_verify.errors import InputError, InternalError
from topo_verify.harness.progress import ProgressRate
from topo_verify.harness.run import replay_line
from topo_verify.harness.search.identity import source_hash
from topo_verify.harness.search.plan import Plan, Shard
from topo_verify.harness.tally import Failing, Failure, Tally
from topo_verify.harness.worker import Done, Failed, Message, Pulse, Ready
from topo_verify.programs.loading import Target
from topo_verify.robot.limits import Limits
from topo_verify.world.enumeration.pruned import ranked_tables

GRACE = 5.0
"""Seconds without a sign of life, beyond all limits, until a worker is given up."""

LOADING = 120.0
"""Seconds for a worker to load its mappers."""

TURN = 0.2
"""Seconds between two looks at who gave no sign of life."""

_START = (
    "import sys, json; sys.path[:] = json.loads(sys.argv[1]);"
    "from topo_verify.harness.worker import main; main(*map(int, sys.argv[2:]))"
)
"""What a worker runs. It imports from where this process imports, and nothing by accident."""


def processors() -> int:
    """How many processors this process may use: a good number of workers."""
    affinity = getattr(os, "sched_getaffinity", None)
    return len(affinity(0)) if affinity is not None else os.cpu_count() or 1


@dataclass
class _Whole:
    """A shard as it was asked for, and what is known of its pieces, by their first rank."""

    shard: Shard
    pieces: dict[int, Tally] = field(default_factory=dict[int, Tally])
    open: int = 1


@dataclass
class _Piece:
    """A shard or a part of it, to be examined in one go; `deaths`: of the workers that tried."""

    shard: Shard
    whole: _Whole
    deaths: int = 0


class _Worker:
    """One process, and what it is at."""

    def __init__(self, plan: Plan) -> None:
        path = json.dumps(sys.path)
        self._file = TemporaryFile()  # noqa: SIM115  closed by `end`
        self.pulse = Pulse(self._file.fileno())
        self.process = subprocess.Popen(  # noqa: S603  this very Python
            [sys.executable, "-P", "-c", _START, path, str(os.getpid()), str(self.pulse.file)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            pass_fds=[self.pulse.file],
            process_group=0,  # Ctrl-C is for the parent; and what a mapper starts is ended with it
        )
        self.piece: _Piece | None = None
        self.ready = False
        self.worlds = self._beats = 0
        self._heard = monotonic()
        self._rest = b""
        self.send(plan)

    @property
    def out(self) -> IO[bytes]:
        """Where its messages come from."""
        assert self.process.stdout is not None
        return self.process.stdout

    def send(self, what: Plan | Shard) -> None:
        """Hand it something to do. That it is dead is noticed where it is listened to."""
        assert self.process.stdin is not None
        with suppress(BrokenPipeError):
            self.process.stdin.write(msgspec.json.encode(what) + b"\n")
            self.process.stdin.flush()

    def start(self, piece: _Piece) -> None:
        """Let it examine a piece."""
        self.piece, self.worlds, self._heard = piece, 0, monotonic()
        self.send(piece.shard)

    def hear(self) -> list[Message] | None:
        """What it says; None if it has ended."""
        text = os.read(self.out.fileno(), 1 << 16)
        if not text:
            return None
        *lines, self._rest = (self._rest + text).split(b"\n")
        return [msgspec.json.decode(line, type=Message) for line in lines]

    def silence(self) -> float:
        """For how many seconds there has been no beat."""
        worlds, beats = self.pulse.read()
        if beats != self._beats:
            self.worlds, self._beats, self._heard = worlds, beats, monotonic()
        return monotonic() - self._heard

    def end(self) -> str:
        """Kill it, with whatever it started; how it ended, in words."""
        with suppress(ProcessLookupError, PermissionError):
            os.killpg(self.process.pid, signal.SIGKILL)
        code = self.process.wait()
        self.silence()
        for pipe in (self.process.stdin, self.process.stdout, self._file):
            if pipe is not None:
                with suppress(BrokenPipeError):
                    pipe.close()
        return f"signal {-code}" if code < 0 else f"exit code {code}"


class Crew:
    """Some workers.

    Args:
        mappers: the targets of the plan, as this process found them.
        size: how many workers at most.
        rate: told how many worlds are done in shards that are not.
    """

    def __init__(
        self, plan: Plan, mappers: Sequence[Target], size: int, rate: ProgressRate
    ) -> None:
        self._plan, self._size, self._rate = plan, size, rate
        self._sources = source_hash(mappers)
        # A failing mapper is run in a witness world, too, under the usual limits.
        self._patience = GRACE + max(plan.limits.world_timeout, Limits().world_timeout)
        self._workers: list[_Worker] = []
        self._queue: deque[_Piece] = deque()  # pieces that come before everything else
        self._landed: deque[tuple[Shard, Tally]] = deque()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        for worker in self._workers:
            worker.end()

    def examine(self, todo: Iterator[Shard]) -> Generator[tuple[Shard, Tally]]:
        """The shards and what was found there, in the order in which they are done."""
        self._hand_out(todo)
        while any(worker.piece for worker in self._workers):
            self._listen()
            self._hand_out(todo)
            while self._landed:
                yield self._landed.popleft()

    def _hand_out(self, todo: Iterator[Shard]) -> None:
        """Give everybody something to do, as long as there is something."""
        for place in range(self._size):
            if place < len(self._workers) and self._workers[place].piece is not None:
                continue
            if self._queue:
                piece = self._queue.popleft()
            elif (shard := next(todo, None)) is not None:
                piece = _Piece(shard, _Whole(shard))
            else:
                return
            if place == len(self._workers):
                self._workers.append(_Worker(self._plan))
            self._workers[place].start(piece)

    def _listen(self) -> None:
        """Wait for what the workers say, but not for long; give up those that are silent."""
        with selectors.DefaultSelector() as selector:
            for worker in self._workers:
                selector.register(worker.out, selectors.EVENT_READ, worker)
            for key, _ in selector.select(TURN):
                self._hear(key.data)
        for worker in tuple(self._workers):
            silent = worker.silence()
            if worker.piece is not None and silent > (self._patience if worker.ready else LOADING):
                self._lost(worker, f"it gave no sign of life for {silent:.0f} s")
        self._rate.in_flight(sum(worker.worlds for worker in self._workers if worker.piece))

    def _hear(self, worker: _Worker) -> None:
        """One worker has said something, or has ended."""
        messages = worker.hear()
        if messages is None:
            self._lost(worker, "")
            return
        for message in messages:
            match message:
                case Ready(sources):
                    worker.ready = True
                    if sources != self._sources:
                        raise InputError(
                            f"target {self._plan.targets[0]!r}: its source, or topo-verify's, has"
                            " changed since the search began: start it again"
                        )
                case Done(tally):
                    piece = worker.piece
                    assert piece is not None, "it was given one"
                    worker.piece = None
                    self._land(piece, tally)
                case Failed(text, bug):
                    raise InternalError(f"in a worker: {text}") if bug else InputError(text)

    # ------------------------------------------------------------ pieces

    def _land(self, piece: _Piece, tally: Tally) -> None:
        """A piece is done, and perhaps its shard."""
        whole = piece.whole
        whole.pieces[piece.shard.start] = tally
        whole.open -= 1
        if tally.failing and not self._plan.keep_going:  # nothing behind it matters
            behind = [
                p for p in self._queue if p.whole is whole and p.shard.start > piece.shard.start
            ]
            self._queue = deque(p for p in self._queue if p not in behind)
            whole.open -= len(behind)
        if not whole.open:
            total = Tally()
            for _, part in sorted(whole.pieces.items()):
                total += part
                if part.failing and not self._plan.keep_going:
                    break
            self._landed.append((whole.shard, total))

    def _lost(self, worker: _Worker, why: str) -> None:
        """A worker is dead, or as good as dead: another one tries what it was at."""
        self._workers.remove(worker)
        how = worker.end()
        piece = worker.piece
        if not worker.ready:
            raise InputError(
                f"target {self._plan.targets[0]!r}: a process that loads it ends ({why or how})"
            )
        if piece is None:
            return
        piece.deaths += 1
        if piece.deaths < 2:
            self._queue.appendleft(piece)
            return
        shard = piece.shard
        listed = ranked_tables(shard.edges, self._plan.world_class, shard.start, shard.stop)
        ranks = [rank for rank, _ in listed]
        if len(ranks) > 1:
            self._cut(piece, ranks, worker.worlds)
        elif ranks:
            told = f"its process was ended, for {why}" if why else f"it ended its process ({how})"
            self._land(piece, self._convicted(shard.edges, ranks[0], told))
        else:
            self._land(piece, Tally())

    def _cut(self, piece: _Piece, ranks: list[int], seen: int) -> None:
        """Cut a piece around the world where its worker was last seen."""
        at = min(seen, len(ranks) - 1)
        shard = piece.shard
        cuts = [shard.start, *ranks[max(at, 1) : at + 2], shard.stop]
        parts = [Shard(shard.edges, a, b) for a, b in pairwise(cuts)]
        piece.whole.open += len(parts) - 1
        self._queue.extendleft(_Piece(part, piece.whole) for part in reversed(parts))

    def _convicted(self, edges: int, rank: int, told: str) -> Tally:
        """One world, in which the mapper took its process with it."""
        target, world, claim = self._plan.targets[0], f"m{edges}/{rank}", "map-isomorphic"
        again = replay_line(world, target, None, self._plan.limits.options)
        message = f"no map was delivered: {told}"
        finding = Finding(claim, None, "a map", None, message, None, world, again)
        failure = Failure(edges, rank, target, (finding,))
        return Tally(
            worlds=1,
            failing=1,
            statuses={claim: {"failed": 1}},
            claims={claim: Failing(1, failure)},
            failures=(failure,),
        )
