"""What each command refuses, in one sentence: bad usage and bad input, exit code 2."""

from __future__ import annotations

import pytest

from tests.cli.conftest import Refused

REFUSED = [
    ("nothing", "no such command 'nothing'"),
    ("explore", "missing argument 'WORLD...'"),
    ("explore nowhere.json", "no such world: 'nowhere.json'"),
    ("explore - -", "expected '-' at most once"),
    ("explore m3/14 --algorithm best", "no algorithm 'best'"),
    ("explore m3/14 --algorithm mappers.py:nothing", "has no attribute 'nothing'"),
    ("explore m3/14 --algorithm gone.py:f", "there is no file 'gone.py'"),
    ("explore m3/14 --pick farthest", "no pick policy 'farthest'"),
    ("explore m3/14 --algorithm mappers.py:right --pick last", "has no policies"),
    ("explore m3/14 --marker 6", "--marker 6 in m3/14"),
    ("explore m3/14 --trace t", "expected one run, got 9"),
    ("explore m3/14 m3/15 --algorithm basic --trace t", "expected one run, got 2"),
    ("explore m3/14 --algorithm basic --trace -", "name a file"),
    ("explore m3/14 --algorithm basic --trace no/folder/t", "cannot write no/folder/t"),
    ("explore m3/14 --budget -1", "invalid value for '--budget'"),
    ("explore m3/14 --move-timeout 0", "expected seconds in (0, 1000000], got '0'"),
    ("explore m3/14 --move-timeout nan", "expected seconds in (0, 1000000], got 'nan'"),
    ("explore m3/14 --world-timeout soon", "expected seconds in (0, 1000000], got 'soon'"),
    ("explore m3/14 --format xml", "invalid value for '--format'"),
    ("verify all basic", "unexpected extra argument"),
    ("verify --seed -1", "invalid value for '--seed'"),
    ("world convert m3/14 --to svg", "'svg' is not one of 'json', 'planar_code'"),
    ("world convert m3/14 -o no/folder/w.json", "cannot write no/folder/w.json"),
    ("world count", "missing option '--edges'"),
    ("world count --edges six", "expected a number of edges as 6 or a range as 1..6, got 'six'"),
    ("world count --edges 3..1", "expected ascending numbers of edges"),
    ("world count --edges 3 --class tidy", "class 'tidy': expected any, planar"),
    ("world sample --edges 300", "write worlds to files with -o FOLDER"),
    ("world sample --edges 5 -o mappers.py", "-o mappers.py: cannot create this folder"),
    ("replay nothing.jsonl", "no such world: 'nothing.jsonl'"),
    ("replay m3/14 --world m3/15", "expected a trace, got m3/14"),
    ("replay m3/14 --target all", "names 9 mappers"),
    ("search", "expected either a TARGET or two mappers with --compare A,B"),
    ("search basic --compare basic,folding", "either a TARGET or two mappers with --compare"),
    ("search --compare basic", "expected two different algorithms of the catalogue, as A,B"),
    ("search --compare basic,basic", "expected two different algorithms of the catalogue, as A,B"),
    ("search basic --edges 0", "invalid value for '--edges'"),
    ("search basic --class tidy", "class 'tidy': expected any, planar"),
    ("search basic --class simple,planar --edges 9", "there is no formula"),
    ("search basic,folding --ledger L", "--ledger L: expected one TARGET, got 2"),
    ("search basic --ledger mappers.py", "it is no store of topo-verify: name"),
    ("search basic --policies every --edges 7", "for basic it goes to 6 edges"),
    ("search mappers.py:silent --policies all", "has no policies"),
    ("search basic --workers -1", "invalid value for '--workers'"),
    ("conform", "name a TARGET, a program"),
    ("conform basic --cmd ./mapper", "one of them, not two"),
    ("conform --cmd /no/such/program --worlds m1/0", "cannot start '/no/such/program'"),
    ('conform --cmd "\'" --worlds m1/0', "quote"),
    ("conform basic --worlds nowhere", "no such world"),
    ("conform basic --like best", "no algorithm 'best'"),
    ("conform basic --batch --worlds m1/0", "expected a program, got basic"),
    ("conform nothing --worlds m1/0", "no algorithm 'nothing'"),
    ("conform basic --seed 1:x", "expected N or N:ORDER, two numbers from 0, got '1:x'"),
    ("faults no-such", "got 'no-such'; the faults are leaves-out-the-"),
    (
        "faults restores-with-the-wrong-sign --by guess",
        "expected checks out of search, properties, proofs, got 'guess'",
    ),
    ("prove percept --smt2 mappers.py", "expected a folder, got a file"),
    ("explore m0/0 --marker all", "m0/0 has no edge that a marker could point at"),
    ("explore m3/14 --marker all --svg h.svg", "expected the name of a file, one WORLD and"),
    ("explore m3/14 --marker all --svg - --algorithm basic", "expected the name of a file"),
    ("explore m3/14 --marker all --gap", "--gap is for one marker: leave it out"),
    ("explore m3/14 --marker all --trace t", "--trace is for one marker: leave it out"),
    ("explore m3/14 --marker all --player p", "--player is for one marker: leave it out"),
    ("explore m3/14 --marker every", "expected a dart (a number) or all, got 'every'"),
    ("explore m2/8 --algorithm all --choices 0", "expected one run"),
    ("explore m2/8 --algorithm basic --choices 0,9", "give one of 0 … 2"),
    ("explore m2/8 --algorithm basic --choices x", "as 0,2,1"),
    ("explore m2/8 --algorithm basic --pick last --choices 0", "leave out --pick and --order"),
    ("prove percet", "do you mean percept"),
    ("prove nothing-like-it", "prove --list lists them"),
    ("prove percept --kind mutant", "no theorem of kind mutant among percept"),
    ("prove --kind bounded --edges 99", "1 to 6 edges"),
    ("prove percept --timeout 0", "--timeout"),
    ("prove percept --solver yices", "--solver"),
    ("record basic", "'--out'"),
    ("record --out b", "name a TARGET, a program"),
    ("record basic --cmd ./mapper --out b", "one of them, not two"),
    ("record all --out b", "names 9 mappers: name one"),
    ("record nix --out b", "no algorithm 'nix'"),
    ("record basic --worlds 'edges<=99' --out b", "'edges<=99'"),
    ("record basic --worlds m1/0 --out nowhere/b", "cannot write nowhere/b"),
    ("record --cmd ./mapper --pick last --out b", "policies"),
    ("reproduce --figure 4", "--figure '4': expected all, 6 or one of 3, 6a"),
    ("reproduce --out mappers.py", "--out mappers.py: cannot create this folder"),
    ("reproduce --graphs 0", "0 is not in the range"),
    ("arena --game 5", "--game 5: expected 1 to 4 edges"),
    ("arena --game 0", "--game 0: expected 1 to 4 edges"),
    ("arena --game 2 --suite king", "--suite means nothing to --game: leave out one of them"),
    ("arena --game 2 --report r.html", "--report means nothing to --game"),
    ("arena --game 2 basic,m.py:explore", "target 'm.py:explore': --game plays mappers of the"),
    ("world list --edges 9", "at most 250,000 worlds, got 576,037,442 of class any with 9 edges"),
    ("world list --edges 17 --class simple", "expected at most 16 edges, got 17"),
    ("world list --edges 8 --class simple,genus:1", "ask for 7 edges or fewer, or name the"),
    ("world list --edges 201", "201 is not in the range"),
    ("world list ", "'--edges'"),
    ("world sample --strategy worlds --edges 3", "--edges beside --strategy"),
    ("world sample --strategy worlds --class planar", "--class beside --strategy"),
    ("world sample -n 3", "expected --edges N or --strategy STRATEGY"),
    ("world sample --strategy nothing", "no such strategy: 'nothing'"),
    ("world sample --strategy 'worlds(min_edges=300,max_edges=300)'", "with 300 edges has no id"),
    ("world sample --strategy 'worlds(min_edges=2,max_edges=1)'", "min_edges=2 is above"),
]


@pytest.mark.parametrize(("line", "words"), REFUSED)
def test_bad_usage_and_bad_input_get_one_sentence(refused: Refused, line: str, words: str) -> None:
    refused(line, words)


ENGINES = [
    ("--dask local --workers 2", "--dask local with --workers 2: expected one of the two"),
    ("--dask nonsense:xx", "--dask nonsense:xx: expected the address of a Dask scheduler"),
    ("--engine fast", "invalid value for '--engine'"),
    ("--engine compiled --policies every", "it knows the reference policies only"),
    ("--engine compiled --budget 9", "leave out --budget, or --engine"),
    ("--engine compiled --world-timeout 9", "leave out --move-timeout and --world-timeout"),
]


@pytest.mark.parametrize(("options", "words"), ENGINES)
def test_what_does_not_go_together_is_refused(refused: Refused, options: str, words: str) -> None:
    pytest.importorskip("numba")
    pytest.importorskip("distributed")
    refused(f"search basic --edges 2 {options}", words)
