"""XML: what a document may not do, and that nothing but one sentence comes of it."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from topo_verify.errors import InputError
from topo_verify.world.formats import markup

LAUGHS = b"""<?xml version="1.0"?>
<!DOCTYPE lolz [<!ENTITY a "lol"><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;&a;&a;">
<!ENTITY c "&b;&b;&b;&b;&b;&b;&b;&b;&b;&b;">]><net>&c;</net>"""


def events(data: bytes) -> list[object]:
    """What a reader is told of the document."""
    told: list[object] = []
    markup.read(
        data,
        name="the file",
        start=lambda path, attributes: told.append((path, attributes)),
        end=lambda path, text: told.append((path, text)),
    )
    return told


def test_a_reader_is_told_of_elements_attributes_and_texts() -> None:
    assert events(b'<a x="1" xmlns:n="u" n:y="2">one<b/><c>t<!-- no -->wo</c> end</a>') == [
        (("a",), {"x": "1", "y": "2"}),
        (("a", "b"), {}),
        (("a", "b"), ""),
        (("a", "c"), {}),
        (("a", "c"), "two"),
        (("a",), " end"),
    ]


def test_names_come_without_their_namespaces() -> None:
    assert events(b'<g:a xmlns:g="http://x/ y"/>')[0] == (("a",), {})


@pytest.mark.parametrize(
    "data",
    [
        LAUGHS,
        b'<!DOCTYPE net SYSTEM "file:///etc/passwd"><net/>',
        b'<!DOCTYPE net [<!ENTITY x SYSTEM "file:///etc/passwd">]><net>&x;</net>',
        b'<!DOCTYPE net [<!ENTITY % x SYSTEM "http://example.org/x.dtd"> %x;]><net/>',
        b'<!DOCTYPE net PUBLIC "x" "http://example.org/x.dtd"><net/>',
        LAUGHS.decode().encode("utf-16"),
    ],
)
def test_a_document_type_is_refused_before_anything_expands(data: bytes) -> None:
    with pytest.raises(InputError, match=r"the file has a document type .*: take it out"):
        events(data)


@pytest.mark.parametrize(
    ("data", "sentence"),
    [
        (b"", "the file is not valid XML: no element found: line 1, column 0"),
        (b"{}", "not well-formed"),
        (b"<a>", "no element found"),
        (b"<a></b>", "mismatched tag"),
        (b"<a/><a/>", "junk after document element"),
        (b"<a>&x;</a>", "undefined entity"),
        (b"<a>\xff</a>", "not well-formed"),
        (b"<n:a/>", "unbound prefix"),
        (b'<a x="1" x="2"/>', "duplicate attribute"),
        (b'<?xml version="1.0" encoding="nonsense"?><a/>', "unknown encoding"),
        (b'<?xml version="1.0" encoding="utf-7"?><a/>', "save it as UTF-8"),
        (b"<a>" * 65, "nested too deeply, over 64 deep"),
        (b"<a>" * 10**6, "nested too deeply"),
    ],
)
def test_what_is_no_harmless_xml_is_refused(data: bytes, sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        events(data)


def test_what_the_reader_refuses_goes_through_as_it_is() -> None:
    def refuse(*_told: object) -> None:
        raise InputError("the reader's own sentence")

    with pytest.raises(InputError, match=r"^the reader's own sentence$"):
        markup.read(b"<a/>", name="", start=refuse, end=refuse)


@given(data=st.binary(max_size=60) | st.text("<>a/&;! [\"'=?-", max_size=40).map(str.encode))
def test_any_bytes_are_told_or_refused(data: bytes) -> None:
    try:
        events(data)
    except InputError as refusal:
        assert str(refusal).startswith("the file")  # noqa: PT017  XML is as good an outcome
