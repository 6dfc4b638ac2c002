"""Mutations of files: of their bytes, their lines, and of the JSON, XML or numbers in them.

They respect the syntax, because a parser refuses most random bytes at once and never gets to the
code behind.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from random import Random
from typing import Any

ODD: tuple[Any, ...] = (
    *(None, True, False, 0, 1, -1, 2, 7, 255, 256, 65535, 10**6, 2**31, 2**53 + 1, 2**62, 2**63),
    *(2**64, -(2**63), 10**40, 10**400, 0.5, -0.0, 1e308, 1e-320, float("nan"), float("inf")),
    *("", "0", "x", "\x00", "\x1b[31m", "\u202e", "\ud800", "é" * 99, "y" * 5000, "m5/17", "nyc"),
    *([], {}, [[]], [0], [None], {"a": 0}, [0] * 2000, "-", "../../etc/passwd", "m9/1e9"),
)

WORDS = (
    *(b"\x00", b"\xff\xfe", b"\xef\xbb\xbf", b"\n", b"\r\n", b"\r", b"\x1b[31m", b"[" * 200_000),
    *(b'{"a":' * 2000, b"9" * 5000, b"1e999", b"NaN", b"\\ud800", b'"', b"\\", b"/*", b"\xf4\x90"),
    *(b"&lt;", b"&#0;", b"&x;", b"]]>", b"<!--", b"<![CDATA[", b" " * 100_000, b"\x80", b"-"),
)

Mutation = Callable[[Random, bytes], bytes]

# ---------------------------------------------------------------- bytes and lines


def of_bytes(draw: Random, data: bytes) -> bytes:  # noqa: PLR0911  a case a mutation
    """One change of the bytes."""
    a, b = sorted((draw.randrange(len(data) + 1), draw.randrange(len(data) + 1)))
    near = min(b, a + draw.randint(1, 40))
    match draw.randrange(8):
        case 0:
            return data[:a]
        case 1:
            return data[:a] + data[near:]
        case 2:
            return data[:near] + data[a:]
        case 3:
            return data[:a] + draw.choice(WORDS) + data[a:]
        case 4:
            return data[:a] + draw.randbytes(draw.randint(1, 8)) + data[near:]
        case 5:
            return data + data
        case 6:
            return data.decode("latin-1").encode(draw.choice(("utf-8", "utf-16", "utf-7")))
        case _:
            return flipped(data, draw.randrange(8 * len(data))) if data else b"\0"


def flipped(data: bytes, bit: int) -> bytes:
    """The data with one bit flipped."""
    changed = bytearray(data)
    changed[bit // 8] ^= 1 << bit % 8
    return bytes(changed)


def of_lines(draw: Random, data: bytes) -> bytes:
    """One change of the lines: one is lost, doubled, moved, or changed within."""
    lines = data.splitlines(keepends=True) or [b""]
    a, b = draw.randrange(len(lines)), draw.randrange(len(lines))
    match draw.randrange(6):
        case 0:
            del lines[a]
        case 1:
            lines.insert(b, lines[a])
        case 2:
            lines[a], lines[b] = lines[b], lines[a]
        case 3:
            lines = lines * draw.choice((2, 20))
        case 4:
            lines[a] = of_bytes(draw, lines[a])
        case _:
            lines[a] = of_json(draw, lines[a].rstrip(b"\n")) + b"\n"
    return b"".join(lines)


# ---------------------------------------------------------------- JSON


def of_json(draw: Random, data: bytes) -> bytes:
    """One to three changes of a JSON text; of the bytes, if it is not JSON."""
    try:
        document = json.loads(data)
    except (ValueError, RecursionError):
        return of_bytes(draw, data)
    box = [document]
    for _ in range(draw.choice((1, 1, 1, 2, 3))):
        holder, key = draw.choice(_places(box))
        _change(draw, holder, key)
    text = json.dumps(box[0] if box else None)
    if draw.random() < 0.15:  # a doubled key, which no dictionary can hold
        text = re.sub(r'("\w+"): ([^,{\[]+)', r"\1: \2, \1: \2", text, count=draw.randint(1, 9))
    return text.encode(errors="surrogatepass")


def _places(root: Any) -> list[tuple[Any, Any]]:
    found: list[tuple[Any, Any]] = []
    todo = [root]
    for holder in todo:  # grows as it goes
        keys = list(holder) if isinstance(holder, dict) else range(len(holder))
        found += [(holder, key) for key in keys]
        todo += [holder[key] for key in keys if isinstance(holder[key], dict | list)]
    return found or [(root, 0)]


def _change(draw: Random, holder: Any, key: Any) -> None:
    if isinstance(holder, list) and not holder:
        holder.append(draw.choice(ODD))
        return
    old = holder[key]
    match draw.randrange(7):
        case 0:
            del holder[key]
        case 1 if isinstance(holder, list):
            holder.insert(key, old)
        case 1:
            holder[draw.choice(("x", "a\x1b", str(key) + "s", str(key).upper()))] = old
        case 2 if isinstance(holder, list):
            other = draw.randrange(len(holder))
            holder[key], holder[other] = holder[other], old
        case 3 if isinstance(old, int):
            holder[key] = old + draw.choice((-1, 1, 2, 100, 2**32))
        case 4 if isinstance(old, str):
            holder[key] = old + str(draw.choice(ODD))
        case 5:
            holder[key] = [old]
        case _:
            holder[key] = draw.choice(ODD)


# ---------------------------------------------------------------- XML


def of_xml(draw: Random, data: bytes) -> bytes:
    """One change of an XML text: a value, a name, an element, a declaration."""
    text = data.decode(errors="surrogateescape")
    values = list(re.finditer(r'"([^"]*)"|(?<=>)([^<>]+)(?=</)', text))
    tags = list(re.finditer(r"<[^<>]+>", text))
    if not values or not tags:
        return of_bytes(draw, data)
    value, tag = draw.choice(values), draw.choice(tags)
    odd = str(draw.choice(ODD)).replace("\x00", "").replace("\ud800", "")
    match draw.randrange(8):
        case 0:
            text = text[: tag.start()] + text[tag.end() :]
        case 1:
            text = text[: tag.end()] + tag[0] + text[tag.end() :]
        case 2:
            text = '<!DOCTYPE a [<!ENTITY b "cc"><!ENTITY d "&b;&b;">]>' + text
        case 3:
            text = text[: tag.start()] + "<a>" * 5000 + text[tag.end() :]
        case 4:
            other = draw.choice(values)
            text = text[: value.start()] + other[0] + text[value.end() :]
        case 5:
            text = (
                text[: tag.start()]
                + re.sub(r'\w+="[^"]*"', "", tag[0], count=1)
                + text[tag.end() :]
            )
        case _:
            quoted = f'"{odd}"' if value[0].startswith('"') else odd
            text = text[: value.start()] + quoted + text[value.end() :]
    return text.encode(errors="surrogateescape")


# ---------------------------------------------------------------- planar_code


def of_numbers(draw: Random, data: bytes) -> bytes:
    """One change of a planar_code file: of its head, or of one of its bytes."""
    if draw.random() < 0.2:
        heads = (b"", b">>planar_code<<", b">>planar_code le<<", b">>planar_code be <<", b">>x<<")
        return draw.choice(heads) + data.partition(b"<<")[2]
    changed = bytearray(data)
    for _ in range(draw.randint(1, 3)):
        place = draw.randrange(len(changed))
        changed[place] = draw.choice((0, 0, 1, 2, 3, 255, draw.randrange(256)))
    return bytes(changed)
