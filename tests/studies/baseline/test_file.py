"""The file of a baseline: written the same every time, and refused where it was changed."""

from __future__ import annotations

import gzip
import json
from collections.abc import Callable
from pathlib import Path

import jsonschema
import msgspec
import pytest

from tests.studies.baseline.recording import recording
from tests.versions import older
from topo_verify.campaign.targets import one_target
from topo_verify.errors import InputError
from topo_verify.robot.limits import Limits
from topo_verify.studies.baseline import file
from topo_verify.studies.baseline.file import Baseline, BaselineEntry
from topo_verify.studies.corpus import corpus_from
from topo_verify.world.rooted_map import World

WORLDS = ("edges<=2", "family:lattice(11,11)")


@pytest.fixture(scope="module")
def made() -> Baseline:
    """Thirteen worlds: the twelve of up to two edges, and one that is too large for an id."""
    limits = Limits(budget=20_000, move_timeout=4)
    return recording(one_target("basic"), *WORLDS, limits=limits)


def lines(baseline: Baseline) -> list[bytes]:
    return gzip.decompress(file.encode(baseline)).splitlines(keepends=True)


def refusal(data: bytes) -> str:
    with pytest.raises(InputError) as raised:
        file.decode(data, name="b.gz")
    assert "\n" not in str(raised.value)
    return str(raised.value)


# ---------------------------------------------------------------- what is in it


def test_what_is_written_is_read_again(made: Baseline) -> None:
    assert file.decode(file.encode(made)) == made


def test_the_same_recording_gives_the_same_bytes(made: Baseline) -> None:
    limits = Limits(budget=20_000, move_timeout=4)
    again = recording(one_target("basic"), *WORLDS, limits=limits)
    assert file.encode(again) == file.encode(made)
    assert file.encode(made)[4:8] == bytes(4)  # gzip's own time


def test_the_header_says_what_was_recorded(made: Baseline) -> None:
    header = json.loads(lines(made)[0])
    assert (header["format"], header["version"]) == ("topo-verify/baseline", 1)
    assert header["target"] == "basic"
    assert header["policies"] == {"pick": "nearest", "order": "shortest"}
    assert header["worlds"] == list(WORLDS)
    assert header["total"] == len(made.entries) == 13
    assert header["digest"] == corpus_from(WORLDS).digest
    assert header["limits"] == {"budget": 20_000, "move_timeout": 4.0, "world_timeout": 60.0}


def test_a_small_world_is_kept_by_its_id_and_a_large_one_whole(made: Baseline) -> None:
    assert [entry.world for entry in made.entries[:3]] == ["m1/0", "m1/1", "m2/0"]
    assert [entry.map for entry in made.entries[:3]] == ["m1/0", "m1/1", "m2/0"]
    large = made.entries[-1]
    assert large.name == "family:lattice(11,11)"
    assert (large.map or "").startswith("sha256:")
    world = file.world_of(large, name="b.gz", line=14)
    assert world.is_isomorphic(World.from_json(large.world))
    assert len(world.edges) == 220


def test_every_line_keeps_to_the_schema(made: Baseline) -> None:
    schema = file.schema()
    jsonschema.Draft202012Validator.check_schema(schema)
    for line in lines(made):
        jsonschema.validate(json.loads(line), schema)
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate({"world": "m1/0", "cost": 1}, schema)


@pytest.mark.skipif(
    older("msgspec", 0, 22),
    reason="msgspec before 0.22 names null first in anyOf: as good, but other bytes",
)
def test_the_schema_in_the_package_is_the_one_that_is_made() -> None:
    stored = Path(file.__file__).parent / "schemas" / "baseline.schema.json"
    assert stored.read_text() == json.dumps(file.schema(), indent=2) + "\n"


# ---------------------------------------------------------------- what is refused


def changed(made: Baseline, number: int, change: Callable[[bytes], bytes]) -> bytes:
    """The file with another line."""
    text = lines(made)
    text[number - 1] = change(text[number - 1])
    return gzip.compress(b"".join(text))


@pytest.mark.parametrize("number", [1, 2, 9, 14])
def test_a_changed_line_is_named(made: Baseline, number: int) -> None:
    tampered = changed(made, number, lambda line: line.replace(b"2", b"3", 1))
    assert refusal(tampered).startswith(f"b.gz, line {number}: not as it was written")


def test_a_lost_a_doubled_and_a_moved_line_are_named(made: Baseline) -> None:
    for text, number in (
        ([*lines(made)[:4], *lines(made)[5:]], 5),
        ([*lines(made)[:4], *lines(made)[3:]], 5),
        ([*lines(made)[:2], lines(made)[3], lines(made)[2], *lines(made)[4:]], 3),
    ):
        assert refusal(gzip.compress(b"".join(text))).startswith(f"b.gz, line {number}: not as")


def test_lines_that_are_missing_at_the_end_are_missed(made: Baseline) -> None:
    said = refusal(gzip.compress(b"".join(lines(made)[:9])))
    assert "line 10: the file has 8 worlds, its header promises 13" in said
    assert said.endswith("copy it whole, or record a new one")


def test_half_a_line_is_named(made: Baseline) -> None:
    said = refusal(gzip.compress(b"".join(lines(made))[:-20]))
    assert said.startswith("b.gz, line 14: not as it was written")


def test_half_a_file_is_refused_with_the_line_where_it_breaks(made: Baseline) -> None:
    whole = file.encode(made)
    assert "the file ends or breaks here; copy it whole" in refusal(whole[: len(whole) // 2])
    assert "line 1" in refusal(whole[:5])
    assert "copy it again" in refusal(whole[:-8] + bytes(8))  # gzip's own check


def test_damage_inside_of_the_compressed_part_is_refused(made: Baseline) -> None:
    data = bytearray(file.encode(made))
    for place in range(100, len(data) - 20, 97):
        data[place] ^= 0x55
        assert refusal(bytes(data)).startswith("b.gz, line ")
        data[place] ^= 0x55


def test_a_newer_version_is_refused_with_a_sentence(made: Baseline) -> None:
    newer = changed(made, 1, lambda line: line.replace(b'"version":1', b'"version":2'))
    assert refusal(newer) == (
        "b.gz, line 1: baseline version 2 is newer than 1, the newest that this topo-verify reads:"
        " update it"
    )


def packed(data: bytes) -> bytes:
    """The same bytes whatever the time: they are part of a test's name."""
    return gzip.compress(data, mtime=0)


@pytest.mark.parametrize(
    ("data", "told"),
    [
        (b"", "is empty"),
        (b"{}", "expected gzip data"),
        (packed(b""), "is empty"),
        (packed(b"{}"), "expected a line of a baseline"),
        (packed(b"\xff"), "expected a line of a baseline"),
        (packed(b"[" * 100_000), "expected a line of a baseline"),
        (packed(b'{"format":"topo-verify/world","version":1}'), "'topo-verify/world'"),
    ],
)
def test_what_is_no_baseline_is_refused(data: bytes, told: str) -> None:
    assert told in refusal(data)


def test_a_file_that_unpacks_to_more_than_is_read_is_refused(
    made: Baseline, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(file, "MOST_BYTES", 500)
    assert "MiB unpacked" in refusal(file.encode(made))


def test_an_entry_whose_world_is_none_names_its_line(made: Baseline) -> None:
    entry = msgspec.structs.replace(made.entries[0], world="m1/7")
    with pytest.raises(InputError, match=r"b\.gz, line 2: .*m1/7"):
        file.world_of(entry, name="b.gz", line=2)


def test_a_baseline_that_lacks_worlds_is_not_written(made: Baseline) -> None:
    with pytest.raises(InputError, match="8 of 13 worlds"):
        file.encode(Baseline(made.header, made.entries[:8]))


def test_an_entry_is_right_only_if_all_was_judged_and_nothing_failed() -> None:
    entry = BaselineEntry(world="m1/0", cost=1, moves="", decisions=None, map="m1/0")
    assert entry.right
    assert not msgspec.structs.replace(entry, failed=("map-isomorphic",)).right
    assert not msgspec.structs.replace(entry, undecided=True).right
