"""Files: read with a limit, written whole or not at all."""

from __future__ import annotations

import bz2
import gzip
import io
import lzma
import os
import stat
from contextlib import suppress
from io import BytesIO
from pathlib import Path
from typing import Any
from unittest.mock import Mock

import pytest
from hypothesis import given
from hypothesis import strategies as st

from topo_verify.errors import InputError, shown
from topo_verify.world.formats import files

ROOT = hasattr(os, "geteuid") and os.geteuid() == 0


# ---------------------------------------------------------------- reading


def test_what_was_written_is_read(tmp_path: Path) -> None:
    file = tmp_path / "text"
    files.write(file, "grün\n")
    assert files.read(file) == "grün\n".encode()
    assert files.read(str(file)) == "grün\n".encode()


@pytest.mark.parametrize(
    ("path", "reason"),
    [
        ("missing.json", "cannot read missing.json: No such file or directory; name a file"),
        ("missing/world.json", "No such file or directory"),
        (".", "Is a directory"),
        ("a\0b", r"cannot read a\\x00b: embedded null"),
        ("x" * 5000, "File name too long"),
    ],
)
def test_what_cannot_be_read_is_refused_with_the_systems_reason(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, path: str, reason: str
) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(InputError, match=reason) as refusal:
        files.read(path)
    assert str(refusal.value).isprintable()


@pytest.mark.skipif(ROOT, reason="the superuser may read everything")
def test_a_file_that_may_not_be_read_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "secret"
    file.touch(mode=0)
    with pytest.raises(InputError, match="Permission denied"):
        files.read(file)


def test_a_file_up_to_the_limit_is_read_and_a_larger_one_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(files, "LIMIT", 2**20)
    file = tmp_path / "large"
    file.write_bytes(bytes(2**20))
    assert len(files.read(file)) == 2**20
    file.write_bytes(bytes(2**20 + 1))
    with pytest.raises(InputError, match="large is larger than 1 MiB, the most that is read"):
        files.read(file)


class Endless(io.BytesIO):
    """A stream without an end, such as a device may be; it gives no more than it is asked for."""

    def read(self, size: int | None = -1, /) -> bytes:
        assert size is not None
        assert 0 <= size <= 2**20 + 1
        return bytes(size)


def test_a_stream_without_an_end_is_not_read_to_the_end(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(files, "LIMIT", 2**20)
    with pytest.raises(InputError, match="the pipe is larger than 1 MiB"):
        files.read_stream(Endless(), name="the pipe")


# ---------------------------------------------------------------- packed files


@pytest.mark.parametrize("name", ["text", "text.gz", "text.json"])
def test_what_gzip_packed_is_unpacked_whatever_its_name(tmp_path: Path, name: str) -> None:
    file = tmp_path / name
    file.write_bytes(gzip.compress(b"one\n") + gzip.compress(b"two\n"))  # joined files are one
    assert files.unpacked(files.read(file), "it") == b"one\ntwo\n"
    with files.opened(file) as stream:
        assert list(files.lines(stream, name="it")) == [b"one\n", b"two\n"]
    assert files.stem(file) == "text"


def test_a_file_may_be_named_gz_and_not_be_packed(tmp_path: Path) -> None:
    (tmp_path / "text.gz").write_bytes(b"one\n")
    assert files.unpacked(files.read(tmp_path / "text.gz"), "it") == b"one\n"


PACKED = gzip.compress(bytes(range(256)) * 40, mtime=0)


@pytest.mark.parametrize(
    ("data", "sentence"),
    [
        (PACKED[:-1], "packed by gzip, and damaged: .*; pack it again"),
        (PACKED[:2], "packed by gzip, and damaged"),
        (PACKED[:100] + b"\0" + PACKED[101:], "packed by gzip, and damaged"),
        (PACKED + b"tail", "packed by gzip, and damaged"),
        (gzip.compress(PACKED, mtime=0), "packed by gzip, once more: unpack it"),
        (gzip.compress(bytes(2**20 + 1), mtime=0), "it, unpacked, is larger than 1 MiB"),
        (gzip.compress(bytes(2**26), mtime=0), "it, unpacked, is larger than 1 MiB"),
        (bz2.compress(b"text"), "packed by bzip2: unpack it; .gz is read as well"),
        (lzma.compress(b"text"), "packed by xz"),
        (b"PK\3\4", "packed as zip"),
    ],
)
def test_what_cannot_be_unpacked_is_refused(
    data: bytes, sentence: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(files, "LIMIT", 2**20)
    with pytest.raises(InputError, match=sentence):
        files.unpacked(data, "it")
    with pytest.raises(InputError, match=sentence):
        list(files.lines(BytesIO(data), name="it"))


def test_a_packed_file_up_to_the_limit_is_read(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(files, "LIMIT", 2**20)
    packed = gzip.compress(bytes(2**20))
    assert files.unpacked(packed, "it") == bytes(2**20)


@given(st.binary(max_size=200))
def test_any_bytes_of_gzip_are_unpacked_or_refused(data: bytes) -> None:
    with suppress(InputError):
        files.unpacked(PACKED[:10] + data, "it")


def test_no_text_is_written_packed(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"no text is written packed: leave \.gz out"):
        files.write(tmp_path / "world.json.gz", "text")
    assert list(tmp_path.iterdir()) == []


# ---------------------------------------------------------------- writing


def test_a_file_is_replaced_and_nothing_else_is_left(tmp_path: Path) -> None:
    file = tmp_path / "world.json"
    for text in ("first", "second"):
        files.write(file, text)
        assert file.read_text() == text
    assert list(tmp_path.iterdir()) == [file]


def test_a_new_file_has_the_permissions_that_any_new_file_has(tmp_path: Path) -> None:
    files.write(tmp_path / "ours", "")
    (tmp_path / "theirs").touch()
    modes = {stat.S_IMODE((tmp_path / name).stat().st_mode) for name in ("ours", "theirs")}
    assert len(modes) == 1


def test_a_replaced_file_keeps_its_permissions(tmp_path: Path) -> None:
    file = tmp_path / "private"
    file.touch(mode=0o600)
    files.write(file, "text")
    assert stat.S_IMODE(file.stat().st_mode) == 0o600


def test_a_link_is_followed_not_replaced(tmp_path: Path) -> None:
    file, link = tmp_path / "file", tmp_path / "link"
    file.write_text("old")
    link.symlink_to(file)
    files.write(link, "new")
    assert link.is_symlink()
    assert file.read_text() == "new"


def test_a_pipe_is_written_to_not_replaced(tmp_path: Path) -> None:
    """So is a terminal or the null device; a test on those would break the machine if it failed."""
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    reader = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    try:
        files.write(pipe, "text")
        assert os.read(reader, 99) == b"text"
    finally:
        os.close(reader)
    assert pipe.is_fifo()


@pytest.mark.parametrize(
    ("error", "raised", "words"),
    [
        (OSError(28, "No space left on device"), InputError, r"cannot write .*: No space left on "),
        (KeyboardInterrupt("stopped"), KeyboardInterrupt, "stopped"),
    ],
)
def test_what_fails_or_is_interrupted_leaves_the_old_file_and_no_other(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, error: BaseException, raised: Any, words: str
) -> None:
    file = tmp_path / "world.json"
    file.write_text("old")
    monkeypatch.setattr(os, "fsync", Mock(side_effect=error))
    with pytest.raises(raised, match=words):
        files.write(file, "new")
    assert [path.read_text() for path in tmp_path.iterdir()] == ["old"]


@pytest.mark.parametrize(
    ("path", "reason"),
    [(".", "Is a directory"), ("missing/world.json", "No such file"), ("a\0b", "embedded null")],
)
def test_what_cannot_be_written_is_refused_with_the_systems_reason(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, path: str, reason: str
) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(InputError, match=f"cannot write .*{reason}.*; name a file that can be"):
        files.write(path, "text")
    assert list(tmp_path.iterdir()) == []


# ---------------------------------------------------------------- texts in messages


def test_a_text_in_a_message_is_one_line_of_bounded_length() -> None:
    assert shown("grün 空") == "grün 空"
    assert shown("a\nb\0\x1b[31m\ud800") == r"a\nb\x00\x1b[31m\ud800"
    assert shown("x" * 500) == "x" * 199 + "…"
    assert shown(Path("a/b")) == "a/b"


def test_a_stream_of_any_length_is_read_line_by_line_and_no_line_may_be_too_long(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(files, "LIMIT", 4)
    assert list(files.lines(BytesIO(b"one\ntwo\n\nlast"), name="a log")) == [
        b"one\n",
        b"two\n",
        b"\n",
        b"last",
    ]
    found = files.lines(BytesIO(b"one\nthree\n"), name="a log")
    assert next(found) == b"one\n"
    with pytest.raises(InputError, match=r"a line of a log is larger than"):
        next(found)


def test_standard_input_that_was_closed_is_one_sentence(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.stdin", None)
    with pytest.raises(InputError, match="standard input is closed: name a file"):
        files.standard_input()
