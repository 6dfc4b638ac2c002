"""Suites hold the worlds that they say, the same for everybody, and others with a hidden seed."""

from __future__ import annotations

from pathlib import Path

import pytest

from topo_verify import InputError, families
from topo_verify.extra.arena.suites import SUITES, chosen_suites, drawn
from topo_verify.world.resolve import resolve_world


@pytest.mark.parametrize("name", SUITES)
def test_a_suite_names_each_of_its_worlds_once(name: str) -> None:
    suite = SUITES[name]
    texts = suite.worlds(0)
    assert len(texts) == len(set(texts)) == suite.size
    assert [len(family.listed(0)) for family in suite.families] == [f.size for f in suite.families]
    for family in suite.families:
        assert resolve_world(family.listed(3)[-1]).edges


def test_the_page_lists_every_suite_with_its_worlds() -> None:
    page = (Path(__file__).parents[3] / "docs" / "extra" / "arena.md").read_text()
    table = page.partition("| suite | worlds | families |")[2].partition("\n\n")[0]
    assert table.splitlines()[2:] == [
        f"| `{suite.name}` | {suite.size} |"
        f" {', '.join(f'`{family.name}` ({family.size})' for family in suite.families)} |"
        for suite in SUITES.values()
    ]


def test_the_public_worlds_have_the_seeds_from_0_on() -> None:
    first, second = drawn("lattice(4,4,holes=0.2)", 2).listed(0)
    assert first == "family:lattice(4,4,holes=0.2,seed=0)"
    assert second == "family:lattice(4,4,holes=0.2,seed=1)"


def test_another_seed_draws_other_worlds_each_time_the_same() -> None:
    family = drawn("lattice(4,4,holes=0.2)", 5)
    seen = {tuple(family.listed(seed)) for seed in (0, 1, 2)}
    assert len(seen) == 3
    assert family.listed(2) == family.listed(2)
    assert SUITES["tiny"].worlds(5) == SUITES["tiny"].worlds(0)


def test_a_family_without_a_seed_holds_every_world_of_its_class() -> None:
    torus = families.torus(6, 6)
    marked = {torus.with_marker(dart).code for dart in range(2 * len(torus.edges))}
    (family,) = (one for one in SUITES["default"].families if one.name == "torus(6,6)")
    assert {resolve_world(text).code for text in family.listed(0)} == marked


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("lattice", "--suite 'lattice': no such suite; did you mean 'lattices'? there are default"),
        ("", "--suite '': no such suite: there are default, tiny"),
        ("tiny,tiny", "a suite is named twice: name each once"),
    ],
)
def test_a_wrong_name_is_one_sentence(text: str, words: str) -> None:
    with pytest.raises(InputError) as error:
        chosen_suites(text)
    assert words in str(error.value)


def test_all_is_every_suite() -> None:
    assert [suite.name for suite in chosen_suites("all")] == list(SUITES)
