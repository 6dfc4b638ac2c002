"""WORLDS: which worlds a text names, in which order, under which names."""

from __future__ import annotations

import gzip
from pathlib import Path

import pytest

from topo_verify import World
from topo_verify.errors import InputError
from topo_verify.strategies.sample import WORLDS
from topo_verify.studies.corpus import DEFAULT, GENERATED, STRATEGIES, corpus_from
from topo_verify.world.enumeration import rank_order
from topo_verify.world.formats import planar_code

SHELF = Path(__file__).parents[1] / "data" / "worlds"


def test_the_default_corpus_has_every_small_world_generated_ones_and_a_street_network() -> None:
    corpus = corpus_from([])
    names = [at.name for at in corpus]
    assert corpus.digest == corpus_from(DEFAULT).digest
    assert corpus.total == len(names) == 792 + GENERATED + 1
    assert names[:2] == ["m1/0", "m1/1"]
    assert names[791] == "m4/705"
    assert names[-1] == "nyc"


def test_every_strategy_is_drawn_from() -> None:
    assert {text.split("(")[0] for text in STRATEGIES} == set(WORLDS)


def test_edges_means_one_to_so_many_in_the_order_of_ids() -> None:
    corpus = corpus_from(["edges<=3"])
    assert [at.name for at in corpus] == [
        f"m{m}/{rank}" for m in (1, 2, 3) for rank in range(rank_order.count(m))
    ]
    assert all(World.from_id(at.name).code == at.world.code for at in corpus)
    assert corpus.finite
    assert corpus.total == 86


def test_so_many_worlds_are_generated_as_are_asked_for() -> None:
    for text in ("generated:11", "generated:3:tree_worlds", "generated:1:lattices(max_edges=20)"):
        corpus = corpus_from([text])
        assert corpus.total == len(list(corpus)) == int(text.split(":")[1])
        assert not corpus.finite


def test_generated_worlds_are_called_by_ids_that_name_them() -> None:
    for at in corpus_from(["generated:24"]):
        assert World.from_id(at.name).code == at.world.code
        assert at.replay_arguments == ("--worlds", at.name)


def test_worlds_too_large_for_an_id_are_called_by_what_drew_them() -> None:
    (at,) = corpus_from(["generated:1:tree_worlds(min_edges=201, max_edges=210)"], seed=4)
    assert at.name == "generated:1:tree_worlds(min_edges=201, max_edges=210)#0"
    assert at.replay_arguments == ("--worlds", at.group, "--seed", "4")


def test_a_family_is_drawn_with_the_seeds_from_0_on_or_with_others() -> None:
    text = "drawn:3:king(4,4)"
    names = [at.name for at in corpus_from([text])]
    assert names == [f"family:king(4,4,seed={seed})" for seed in range(3)]
    assert [at.name for at in corpus_from(["drawn:3:family:king(4,4)"])] == names
    other = [at.name for at in corpus_from([text], seed=9)]
    assert len({*names, *other}) == 6
    assert other == [at.name for at in corpus_from([text], seed=9)]
    (part,) = corpus_from([text]).parts
    assert (part.total, part.sample, part.finite) == (3, True, False)


def test_a_folder_is_the_world_files_in_it_by_name(tmp_path: Path) -> None:
    for name, text in (("b.json", "m2/9"), ("a.json", "m1/0")):
        World.from_id(text).save(tmp_path / name)
    (tmp_path / "licence.txt").write_text("free")
    corpus = corpus_from([str(tmp_path)])
    assert [Path(at.name).name for at in corpus] == ["a.json", "b.json"]
    assert [at.world.id for at in corpus] == ["m1/0", "m2/9"]


def test_all_graphs_of_a_file_of_planar_code_are_worlds(tmp_path: Path) -> None:
    triangle, path = (planar_code.encode(World.from_id(text)) for text in ("m3/13", "m1/0"))
    both, one = tmp_path / "both.pc", tmp_path / "one.pc"
    both.write_bytes(triangle + path.removeprefix(b">>planar_code<<"))
    one.write_bytes(path)
    names = [at.name for at in corpus_from([str(tmp_path)])]
    assert names == [f"{both}:0", f"{both}:1", str(one)]
    corpus = corpus_from([str(both)])
    assert [at.world.name for at in corpus] == ["both-0", "both-1"]
    assert all(World.load(both, graph=k) == at.world for k, at in enumerate(corpus))
    assert all(at.replay_arguments == ("--worlds", at.name) for at in corpus)


def test_files_are_worlds_under_any_name_and_packed(tmp_path: Path) -> None:
    path = planar_code.encode(World.from_id("m1/0"))
    both = tmp_path / "both.pl"
    both.write_bytes(path + path)
    (tmp_path / "packed.pc.gz").write_bytes(gzip.compress(path))
    names = [at.name for at in corpus_from([str(both), str(tmp_path)])]
    assert names == [f"{both}:0", f"{both}:1", str(tmp_path / "packed.pc.gz")]


def test_any_world_may_stand_among_worlds() -> None:
    texts = ["m5/17", "family:path(3)", "nyc", str(SHELF)]
    corpus = corpus_from(texts)
    assert [at.name for at in corpus][:3] == texts[:3]
    assert corpus.description == f"m5/17 (1), family:path(3) (1), nyc (1), {SHELF} (2)"


def test_it_can_be_gone_through_again() -> None:
    corpus = corpus_from(["edges<=2", "generated:5"])
    assert [at.name for at in corpus] == [at.name for at in corpus]


def test_the_digest_names_the_worlds_and_nothing_else() -> None:
    digest = corpus_from(["edges<=3", "generated:40"]).digest
    assert digest == corpus_from(["edges<=3", "generated:40"]).digest
    assert digest != corpus_from(["edges<=4", "generated:40"]).digest
    assert digest != corpus_from(["edges<=3", "generated:40"], seed=1).digest
    assert digest != corpus_from(["generated:40", "edges<=3"]).digest
    assert corpus_from(["m1/0"]).digest == corpus_from(["family:path(2)"]).digest


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("edges<=0", "N from 1 to 9"),
        ("edges<=10", "N from 1 to 9"),
        ("edges=5", "'edges<=N'"),
        ("generated:0", "'generated:N'"),
        ("generated", "'generated:N'"),
        ("generated:5:no_worlds", "no such strategy"),
        ("drawn:0:king(4,4)", "'drawn:N:FAMILY'"),
        ("drawn:king(4,4)", "'drawn:N:FAMILY'"),
        ("drawn:2:king(4,4,seed=1)", "leave out seed="),
        ("drawn:2:queen(4,4)", "no such family of worlds"),
        ("drawn:2:torus(4,4)", "unexpected keyword argument 'seed'"),
        ("-", "read only once"),
        ("nowhere", "no such world"),
        ("m3/9999", "m3"),
    ],
)
def test_what_names_no_worlds_is_refused(text: str, words: str) -> None:
    with pytest.raises(InputError) as refused:
        corpus_from([text])
    assert words in str(refused.value)


@pytest.mark.parametrize("text", ["edges=5", "generated:0", "drawn:king(4,4)", "-", "nowhere"])
def test_a_refusal_names_every_form(text: str) -> None:
    with pytest.raises(InputError) as refused:
        corpus_from([text])
    for form in ("corpus", "edges<=N", "generated:N:STRATEGY", "drawn:N:FAMILY", "folder", "file"):
        assert form in str(refused.value)
    for world in ("m5/17", "family:", "nyc"):
        assert world in str(refused.value)


def test_a_folder_without_worlds_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="expected a folder with world files"):
        corpus_from([str(tmp_path)])


def test_a_file_in_a_folder_that_is_no_world_is_named(tmp_path: Path) -> None:
    (tmp_path / "golden.json").write_text("{}")
    with pytest.raises(InputError, match=r"golden\.json"):
        corpus_from([str(tmp_path)])
