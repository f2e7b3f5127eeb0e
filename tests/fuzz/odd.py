"""Values, texts and damage that files of strangers hold."""

from __future__ import annotations

import random
from collections.abc import Sequence
from pathlib import Path

#: Numbers as a TOML file may write them, at and beyond every edge.
NUMBERS = (
    "0", "-1", "0.0", "-0.0", "nan", "inf", "-inf", "1e-308", "5e-324", "1e308", "1e15", "1e-15", "1e9", "1e-9",
    "9223372036854775807", "9" * 400, "9" * 5000, "0x" + "f" * 60, "1_000", "1", "2", "3", "1e5", "1e-3", "199", "201",
    "45.0", "89.999999", "90.0",
)  # fmt: skip

#: What stands where a number belongs.
OTHERS = ("true", '"5 m"', '""', "[]", "[1.0]", "{}", "1979-05-27", "07:32:00", "[[1.0]]", "{a = 1}", "")

#: Names that file systems, drawings and terminals dislike, as TOML strings.
NAMES = (
    '"$"', '"$x$"', r'"$\\frac{1"', r'"a\u0000b"', r'"a\u001bb"', r'"a\u007f"', r'"line\nline"', '"../../etc"', '"/"', '"."',
    '""', '" "', '"%s%n{0}"', '"列柱 Ναός"', '"\U0001f3db"', r'"\u202eabc"', '"' + "x" * 3000 + '"',
    r'"a\tb"', '"<script>alert(1)</script>"', '"~"', '"con"', '"_^_{"', r'"\\"', '"#"', '"--out"',
)  # fmt: skip


def number(rng: random.Random, low: float, high: float, odd: float = 0.1) -> str:
    """A number in its range, or now and then one that is odd."""
    draw = rng.random()
    if draw < 0.7 * odd:
        return rng.choice(NUMBERS)
    if draw < odd:
        return rng.choice(OTHERS)
    if low > 0.0 and high / low > 20.0:
        return f"{low * (high / low) ** rng.random():.6g}"
    return f"{rng.uniform(low, high):.6g}"


def damaged(rng: random.Random, data: bytes) -> bytes:
    """Bytes with one to three kinds of damage: cut, changed, doubled, moved, filled."""
    for _ in range(rng.randint(1, 3)):
        if not data:
            return data
        at = rng.randrange(len(data))
        end = min(len(data), at + rng.randint(1, 1 + len(data) // 4))
        kind = rng.randrange(8)
        if kind == 0:
            data = data[:at]
        elif kind == 1:
            data = data[:at] + bytes([rng.randrange(256)]) + data[at + 1 :]
        elif kind == 2:
            data = data[:at] + data[end:]
        elif kind == 3:
            data = data[:end] + data[at:end] + data[end:]
        elif kind == 4:
            data = data[:at] + bytes(rng.randrange(256) for _ in range(rng.randint(1, 8))) + data[at:]
        elif kind == 5:
            data = data[:at] + b"\x00" * (end - at) + data[end:]
        elif kind == 6:
            lines = data.splitlines(keepends=True)
            rng.shuffle(lines)
            data = b"".join(lines)
        else:
            digit = rng.choice(b"0123456789.-+eE").to_bytes(1, "big")
            data = data[:at] + digit + data[at + 1 :]
    return data


def nested(rng: random.Random, text: str) -> str:
    """A text with a value that is nested deeply."""
    depth = rng.choice((10, 100, 1_000, 20_000))
    opened, closed = rng.choice((("[", "]"), ("{a=", "}")))
    return f"{rng.choice(('name', 'density', 'deep'))} = {opened * depth}1{closed * depth}\n{text}"


def write(rng: random.Random, folder: Path, text: str, *, hurt: float = 0.25) -> Path:
    """A file of that text, with the chance ``hurt`` of damage."""
    if rng.random() < 0.02:
        text = nested(rng, text)
    data = text.encode("utf-8", "surrogatepass")
    if rng.random() < hurt:
        data = damaged(rng, data)
    path = folder / "some.toml"
    path.write_bytes(data)
    return path


def choice(rng: random.Random, choices: Sequence[str], odd: float, odd_choices: Sequence[str]) -> str:
    """One of the usual texts, or now and then an odd one."""
    return rng.choice(odd_choices if rng.random() < odd else choices)
