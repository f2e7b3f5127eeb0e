"""Makes a WebAssembly module of one object file of the compiler, as a linker would: places its data and tells the code.

The object has all functions of the page in it, and calls nothing but what the browser gives (sines and the like). So a
linker has little to do: a memory, a stack, addresses of data in place of the object's own numbers, names of what is called
from outside. Sections and relocations: the WebAssembly specification, and "WebAssembly object file linking" of the
tool conventions.
"""

from __future__ import annotations

import struct
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

#: Where data begins, size of the stack, and of a page of memory [bytes].
DATA, STACK, PAGE = 1024, 1 << 16, 1 << 16

CUSTOM, TYPES, IMPORTS, FUNCTIONS, MEMORY, GLOBALS, EXPORTS, CODE, DATA_SECTION = 0, 1, 2, 3, 5, 6, 7, 10, 11
FUNCTION, TABLE, MEMORIES, GLOBAL = range(4)

#: Kinds of relocations: of an index, which stays as it is; of an address, by how it is written.
STAYS = {0: "function", 6: "type", 7: "global"}
ADDRESSES = {3: "unsigned", 4: "signed", 5: "plain"}


class Reader:
    """Reads numbers and names from bytes."""

    def __init__(self, data: bytes) -> None:
        self.data, self.at = data, 0

    def byte(self) -> int:
        """One byte."""
        self.at += 1
        return self.data[self.at - 1]

    def number(self, signed: bool = False) -> int:
        """A number in LEB128."""
        result = shift = 0
        while True:
            byte = self.byte()
            result |= (byte & 127) << shift
            shift += 7
            if byte < 128:
                return result - (1 << shift) if signed and byte & 64 else result

    def bytes(self) -> bytes:
        """Bytes behind their number."""
        size = self.number()
        self.at += size
        return self.data[self.at - size : self.at]

    def more(self) -> bool:
        """Whether something is left."""
        return self.at < len(self.data)


def leb(number: int, signed: bool = False, width: int = 0) -> bytes:
    """A number in LEB128, as short as can be or of a width."""
    result = bytearray()
    while True:
        byte, number = number & 127, number >> 7
        ends = number == (-1 if signed and byte & 64 else 0)
        if ends and len(result) + 1 >= width:
            result.append(byte)
            return bytes(result)
        result.append(byte | 128)


def behind_size(data: bytes) -> bytes:
    """Bytes behind their number."""
    return leb(len(data)) + data


@dataclass
class Object:
    """An object file, taken apart.

    Parameters
    ----------
    sections : dict of int to bytes
        Contents of the sections.
    imports : list of (bytes, bytes, int, bytes)
        Module, name, kind and type.
    symbols : list of tuple
        Kind, flags, name, index, and of data segment and offset in it.
    alignments : list of int
        Of the segments of data [bytes].
    relocations : dict of str to list
        Kind, place, symbol and addend, by the section.
    """

    sections: dict[int, bytes] = field(default_factory=dict)
    imports: list[tuple[bytes, bytes, int, bytes]] = field(default_factory=list)
    symbols: list[tuple[int, int, bytes, int, int]] = field(default_factory=list)
    alignments: list[int] = field(default_factory=list)
    relocations: dict[str, list[tuple[int, int, int, int]]] = field(default_factory=dict)


def parsed(data: bytes) -> Object:
    """An object file, taken apart."""
    result, reader = Object(), Reader(data)
    assert data[:8] == b"\0asm\1\0\0\0"
    reader.at = 8
    while reader.more():
        kind, content = reader.byte(), reader.bytes()
        if kind == CUSTOM:
            part = Reader(content)
            name = part.bytes().decode()
            if name == "linking":
                _read_linking(part, result)
            elif name.startswith("reloc."):
                result.relocations[name.removeprefix("reloc.")] = _read_relocations(part)
        else:
            result.sections[kind] = content
    part = Reader(result.sections.get(IMPORTS, b"\0"))
    for _ in range(part.number()):
        module, name, kind, start = part.bytes(), part.bytes(), part.byte(), part.at
        if kind == FUNCTION:
            part.number()
        elif kind == GLOBAL:
            part.at += 2
        else:  # a table has the type of its elements before its limits
            part.at += kind == TABLE
            flags = part.byte()
            for _ in range(1 + (flags & 1)):
                part.number()
        result.imports.append((module, name, kind, part.data[start : part.at]))
    return result


def _read_linking(part: Reader, result: Object) -> None:
    """Symbols, and how segments of data are aligned."""
    assert part.number() == 2, "version of the linking section"
    while part.more():
        kind, content = part.byte(), Reader(part.bytes())
        if kind == 5:
            for _ in range(content.number()):
                content.bytes()
                result.alignments.append(1 << content.number())
                content.number()
        elif kind == 8:
            for _ in range(content.number()):
                result.symbols.append(_read_symbol(content))


def _read_symbol(content: Reader) -> tuple[int, int, bytes, int, int]:
    kind, flags = content.byte(), content.number()
    undefined, named = flags & 0x10, flags & 0x40
    if kind == 1:  # data
        name = content.bytes()
        assert not undefined, f"{name.decode()} is nowhere"
        place = content.number(), content.number()
        content.number()
        return kind, flags, name, *place
    index = content.number()
    name = content.bytes() if kind in (0, 2, 5) and (not undefined or named) else b""
    return kind, flags, name, index, 0


def _read_relocations(part: Reader) -> list[tuple[int, int, int, int]]:
    part.number()  # the section, which its name tells
    result = []
    for _ in range(part.number()):
        kind, place, symbol = part.byte(), part.number(), part.number()
        result.append((kind, place, symbol, part.number(signed=True) if kind in ADDRESSES else 0))
    return result


def linked(data: bytes, names: Sequence[str]) -> bytes:
    """A module that exports functions by name, its ``memory``, and where the ``heap`` begins."""
    parts = parsed(data)
    segments, end = _placed(parts)
    code = bytearray(parts.sections[CODE])
    _relocate(code, parts.relocations.get("CODE", []), parts, [place for place, _ in segments])
    contents = [bytearray(content) for _, content in segments]
    assert "DATA" not in parts.relocations, "data that holds addresses"
    stack = -(-end // 16) * 16 + STACK
    functions = [item for item in parts.imports if item[2] == FUNCTION]
    others = [item[1] for item in parts.imports if item[2] not in (FUNCTION, MEMORIES)]
    assert others in ([], [b"__stack_pointer"]), others
    index = {name.decode(): number for kind, _, name, number, _ in parts.symbols if kind == 0}
    exports = [(name, FUNCTION, index[name]) for name in names]
    exports += [("memory", MEMORIES, 0), ("heap", GLOBAL, 1)]
    made = {
        TYPES: parts.sections[TYPES],
        IMPORTS: _vector(behind_size(m) + behind_size(n) + bytes([kind]) + what for m, n, kind, what in functions),
        FUNCTIONS: parts.sections[FUNCTIONS],
        MEMORY: _vector([b"\0" + leb(-(-stack // PAGE))]),
        GLOBALS: _vector(b"\x7f" + bytes([changes]) + b"\x41" + leb(stack, True) + b"\x0b" for changes in (1, 0)),
        EXPORTS: _vector(behind_size(name.encode()) + bytes([kind]) + leb(number) for name, kind, number in exports),
        CODE: bytes(code),
        DATA_SECTION: _vector(
            b"\0\x41" + leb(place, True) + b"\x0b" + behind_size(bytes(content))
            for (place, _), content in zip(segments, contents)
            if any(content)
        ),
    }
    return b"\0asm\1\0\0\0" + b"".join(bytes([kind]) + behind_size(content) for kind, content in made.items())


def _vector(items: Iterable[bytes]) -> bytes:
    result = list(items)
    return leb(len(result)) + b"".join(result)


def _placed(parts: Object) -> tuple[list[tuple[int, bytes]], int]:
    """Segments of data with their addresses, and where they end."""
    reader, place = Reader(parts.sections.get(DATA_SECTION, b"\0")), DATA
    result = []
    for number in range(reader.number()):
        flags = reader.number()
        assert flags == 0, "a segment that is not placed when the module is loaded"
        assert reader.byte() == 0x41
        reader.number(signed=True)
        assert reader.byte() == 0x0B
        content = reader.bytes()
        place = -(-place // parts.alignments[number]) * parts.alignments[number]
        result.append((place, content))
        place += len(content)
    return result, place


def _relocate(
    code: bytearray, relocations: Sequence[tuple[int, int, int, int]], parts: Object, places: list[int]
) -> None:
    """Write addresses of data into the code; numbers of functions, types and globals are those of the object."""
    for kind, at, number, addend in relocations:
        if kind in STAYS:
            continue
        assert kind in ADDRESSES, f"relocation {kind}"
        _, _, _, segment, offset = parts.symbols[number]
        address = places[segment] + offset + addend
        if ADDRESSES[kind] == "plain":
            code[at : at + 4] = struct.pack("<I", address)
        else:
            code[at : at + 5] = leb(address, ADDRESSES[kind] == "signed", 5)


def heap_of(module: bytes) -> int:
    """Where the memory of a module that was made here is free [bytes]: its global of that name."""
    reader = Reader(module)
    reader.at = 8
    while reader.more():
        kind, content = reader.byte(), Reader(reader.bytes())
        if kind == GLOBALS:
            assert content.number() == 2
            content.at += 3
            content.number(signed=True)
            content.at += 4
            return content.number(signed=True)
    raise ValueError("no global")
