"""TOML files checked against a schema: every mistake in one sentence that names the place and the remedy."""

from __future__ import annotations

import re
import tomllib
import typing
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, ClassVar, TypeVar

from pydantic import BaseModel, ConfigDict, ValidationError, WithJsonSchema

from ..errors import InputError, suggest
from ..text_tables import SETTINGS, printable, read_bytes

#: Most levels of tables and lists in a file, and the largest whole number [-].
DEEPEST, LARGEST = 20, 2**63


class Table(BaseModel):
    """A table of a file: keys are known, values have their type."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)

    #: What the path of a field calls it, where that is not its key; empty where the path goes without it.
    called: ClassVar[str | None] = None


def words(known: Iterable[str]) -> WithJsonSchema:
    """What a schema says of a key that takes one of a few words; they are checked where a value is made of it."""
    return WithJsonSchema({"enum": list(known)})


T = TypeVar("T", bound=Table)

_EXPECTED = {
    "float_type": "a number",
    "int_type": "a whole number",
    "int_from_float": "a whole number",
    "string_type": "a text in quotes",
    "bool_type": "true or false",
    "list_type": "a list",
    "tuple_type": "a list",
    "dict_type": "a table",
    "model_type": "a table",
}


def read_table(path: str | Path, schema: type[T]) -> T:
    """Read a TOML file that follows a schema.

    Raises
    ------
    InputError
        The file cannot be read, is not TOML, or does not follow the schema.
    """
    return checked(parse_toml(path), schema, printable(path))


def parse_toml(path: str | Path) -> dict[str, Any]:
    """Content of a TOML file, unchecked but for the size of its numbers and how deeply it is nested."""
    data, name = read_bytes(path, SETTINGS, "a TOML file of settings is smaller"), printable(path)
    if data[:2] == b"PK" or Path(path).suffix.lower() in _SPREADSHEETS:
        raise InputError(
            f"{name} is the table of a spreadsheet; of a survey `stylobate convert` makes a column file first."
        )
    try:
        content = tomllib.loads(data.decode("utf-8-sig"))
    except UnicodeDecodeError:
        raise InputError(f"{name} is not a text file in UTF-8; give a TOML file, saved in UTF-8.") from None
    except tomllib.TOMLDecodeError as error:
        text = data.decode("utf-8-sig")
        plain = "; a line is a key, =, and a number, a text in quotes, true, false or a list of such"
        expected = "; a TOML file of settings is expected here, not a record"
        other = plain if Path(path).suffix.lower() == ".toml" else expected
        other = _meant(text, str(error)) or other
        raise InputError(f"{name} is not valid TOML: {str(error)[:1].lower()}{str(error)[1:]}{other}.") from None
    except RecursionError:
        raise InputError(f"{name} is nested too deeply; {_NESTING}.") from None
    except ValueError:  # what Python refuses to turn into an integer
        raise InputError(f"{name} holds a whole number of thousands of digits; {_DIGITS}.") from None
    check_values(content, name)
    return content


#: Endings of files that spreadsheets save.
_SPREADSHEETS = (".csv", ".xls", ".xlsx", ".xlsm", ".ods", ".numbers")


#: What people write in a line and TOML does not take, what stands for it there, and why.
_MISTAKES: tuple[tuple[str, str | Callable[[re.Match[str]], str], str], ...] = (
    (r"[“”„‟«»″]([^“”„‟«»″\"]*)[“”„‟«»″\"]", r'"\1"', "quotation marks are straight"),
    (r"[‘’‚‛′]([^‘’‚‛′']*)[‘’‚‛′']", r"'\1'", "quotation marks are straight"),
    (r'"[^"]*"', lambda text: text[0].replace("\\", "/"), "folders are divided by /"),
    (r"[\u00a0\u2000-\u200b\u202f\u3000]", " ", "spaces are plain"),
    (r"(?<=[\s=\[,])[−–](?=\s*[\d.])", "-", "the minus sign is a hyphen"),
    (r"^(\s*[\w.\"-]+)\s*:(?!=)", r"\1 =", "a key and its value are divided by ="),
    (r"(?<=[=\[,])(\s*)(True|TRUE|yes|Yes|YES)\b", r"\1true", "it is true or false, in small letters"),
    (r"(?<=[=\[,])(\s*)(False|FALSE|no|No|NO)\b", r"\1false", "it is true or false, in small letters"),
    (r"(=\s*[+-]?\d+),(\d+)(?=\s*(?:#.*)?$)", r"\1.\2", "numbers have a decimal point"),
    (r"(?<![\w.\"'/])\.(?=\d)", "0.", "a digit stands before a decimal point"),
    (r"(?<=\d)\.(?![\w\"'./])", ".0", "a digit stands behind a decimal point"),
    (r"(?<=\d)\.(?=[eE][+-]?\d)", ".0", "a digit stands behind a decimal point"),
    (r"(?<=[=\[,])(\s*[+-]?)0+(?=\d)", r"\1", "numbers begin with no needless 0"),
    (r"(?<=\d)\s+(?=[eE][+-]?\d)", "", "a number has no space in it"),
    (r"(?<=\d)\s*(?:m|s|kg/m[³3]|N/m[³3]?|Pa|°|deg|degrees)(?=\s*(?:[\],#]|$))", "", "units are not written"),
    (r"\s*[;,]\s*(?=#|$)", "", "nothing stands behind a value"),
    (r"=\s*(?!None|null|NaN)([^\W\d][^\"'#=\[\]{}]*?)(?=\s*(?:#.*)?$)", r'= "\1"', "a text stands in quotes"),
)


def _meant(text: str, error: str) -> str:
    """What to write instead of the line that an error names, where that would be TOML; empty where nobody knows."""
    place = re.search(r"at line (\d+)", error)
    line = mended = text.splitlines()[int(place[1]) - 1] if place else ""
    if "declare" in error or "overwrite" in error or "mutate" in error:  # it has been there before
        table = re.match(r"\s*\[+\s*([\w.-]+)\s*\]", line)
        several = (
            f"write [[{table[1]}]] each time if there may be several, as of drums and blocks, or " if table else ""
        )
        return f"; it stands there a second time: {several}leave one out"
    for pattern, put, why in _MISTAKES:
        before, mended = mended, re.sub(pattern, put, mended)
        if mended != before and any(map(_is_toml, (mended, f"x = [{mended}]"))):
            key, _, value = mended.partition(" #")[0].partition("=")
            value = value if line.partition("=")[0] == key else mended
            return f"; {why}: write {value.strip().rstrip(',') or mended.strip()}"
    number = re.search(r"=\s*[+-]?[\d.]+(?:[eE][+-]?\d+)?\s*(?:[^\W\d]|[°%])", mended)
    return "; units are not written: give the number alone, in SI units, angles in degrees" if number else ""


def _is_toml(line: str) -> bool:
    try:
        return bool(tomllib.loads(line))
    except (tomllib.TOMLDecodeError, RecursionError, ValueError):
        return False


_NESTING = f"allowed are {DEEPEST} levels of tables and lists"
#: Half of a character, as JSON and UTF-16 may write it: no file can hold it.
_HALF = re.compile("[\ud800-\udfff]")
_DIGITS = f"allowed are whole numbers up to {LARGEST:g}"


def check_values(data: dict[str, Any], name: str) -> None:
    """Refuse numbers, texts and levels that nothing here can hold.

    Raises
    ------
    InputError
        Something in ``data``, which messages call ``name``, is none of that.
    """
    pending: list[tuple[Any, int]] = [(data, 0)]
    while pending:
        value, depth = pending.pop()
        if isinstance(value, int) and abs(value) > LARGEST:
            raise InputError(f"{name} holds a whole number beyond {LARGEST:g}; {_DIGITS}.")
        if isinstance(value, str) and (half := _HALF.search(value)):
            raise InputError(f"{name} holds half a character, {half[0]!a}; write the whole one.")
        if isinstance(value, (dict, list)):
            if depth > DEEPEST:
                raise InputError(f"{name} is nested too deeply; {_NESTING}.")
            pending += [
                (child, depth + 1) for child in ((*value, *value.values()) if isinstance(value, dict) else value)
            ]


def checked(data: dict[str, Any], schema: type[T], source: str) -> T:
    """``data`` as the schema's table; ``source`` is what messages call the file."""
    try:
        return schema.model_validate(data)
    except ValidationError as error:
        errors = error.errors()
    # A misspelt key is also a missing one: the spelling is what helps.
    first = next((item for item in errors if item["type"] == "extra_forbidden"), errors[0])
    sentence, place = _sentence(first, schema, errors)
    error = InputError(sentence, _path(data, schema, first["loc"]))
    error.places = (place,)
    error.place(source)
    raise error


def _path(data: Any, schema: type[Table], where: Sequence[str | int]) -> str:
    """The path of a field as errors carry it: rows of a list by the index that they state, or else by their number."""
    path: list[str | None] = []
    for part in where:
        if isinstance(part, str) and isinstance(data, dict):
            inner = _tables(schema.model_fields[part].annotation) if part in schema.model_fields else []
            path.append(part if not inner or inner[0].called is None else inner[0].called)
            data, schema = data.get(part), inner[0] if inner else schema
        elif isinstance(part, int) and isinstance(data, list):
            data = data[part]
            path.append(str(data.get("index", part + 1)) if isinstance(data, dict) else None)
    return ".".join(filter(None, path))


def _sentence(item: Any, schema: type[Table], others: list[Any]) -> tuple[str, str]:
    """What is wrong with a key, and the words in it that say where."""
    *where, key = item["loc"] or ("",)
    kind, value, alternatives = item["type"], item["input"], [_EXPECTED.get(item["type"])]
    if isinstance(key, str) and key not in _keys(schema, where) and where and kind != "extra_forbidden":
        # One of several types that the key may have: told of the key, with all of them.
        alternatives += [_EXPECTED.get(other["type"]) for other in others if other["loc"][:-1] == item["loc"][:-1]]
        *where, key = where
    position = ""
    while isinstance(key, int):  # an element of a list: name it by the list
        where, key, position = where[:-1], where[-1], f"{position}number {key + 1} of "
    place = _place(where)
    if kind == "extra_forbidden":
        keys = _keys(schema, where)
        near = suggest(key, keys).strip()
        return f"unknown key {key!r}{place}; " + (near or f"allowed are {', '.join(keys)}."), place
    if kind == "missing":
        return f"key {key!r} is missing{place}; add it.", place
    if kind == "literal_error":
        expected = item["ctx"]["expected"]
    else:
        expected = " or ".join(dict.fromkeys(alternative for alternative in alternatives if alternative)) or None
    if expected is None:
        return f"{position}{key!r}{place} is {value!r}: {item['msg'].lower()}.", place
    if isinstance(value, dict) and expected == "a list":
        expected = f"a list: write [[{key}]], with two brackets"
    if expected == "a number" and isinstance(value, str):
        point = f", with a point: {value.replace(',', '.')}"
        expected += point if value.replace(",", "", 1).lstrip("+-").isdecimal() else " in SI units, without quotes"
    return f"{position}{key!r}{place} is {_short(value)}; it must be {expected}.", place


def _place(where: Sequence[str | int]) -> str:
    """Table of a key, counted from 1: “ in [[as_found.drum]] number 2”, “ in 'drum' of [[block]] number 1”."""
    if not where:
        return ""
    rows = [k for k, part in enumerate(where[:-1]) if isinstance(part, int)]
    of = _place(where[: rows[-1] + 1]).replace(" in ", " of ", 1) if rows else ""
    path = ".".join(part for part in (where[rows[-1] + 1 :] if rows else where) if isinstance(part, str))
    if isinstance(where[-1], int):
        return f" in [[{path}]] number {where[-1] + 1}{of}"
    return f" in {path!r}{of}" if rows else f" in [{path}]"


def _keys(schema: type[Table], where: list[str | int]) -> list[str]:
    for part in where:
        if isinstance(part, str):
            inner = _tables(schema.model_fields[part].annotation)
            if not inner:
                return []
            schema = inner[0]
    return list(schema.model_fields)


def _tables(annotation: Any) -> list[type[Table]]:
    if isinstance(annotation, type) and issubclass(annotation, Table):
        return [annotation]
    return [table for part in typing.get_args(annotation) for table in _tables(part)]


def _short(value: Any) -> str:
    if isinstance(value, dict):
        return "a table"
    if isinstance(value, list):
        return "a list"
    if isinstance(value, bool):
        return "true" if value else "false"
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "…"


def json_schema(tables: Sequence[type[Table]], title: str) -> dict[str, Any]:
    """JSON schema of files that follow one of some tables, for editors: keys, types, what is needed, what a table is for.

    TOML has no null: a key that may be left out is not listed as needed, and that is all.
    """
    from pydantic import TypeAdapter

    several: Any = typing.Union
    schema = TypeAdapter(several[tuple(tables)]).json_schema()
    for part in (schema, *schema.get("$defs", {}).values()):
        _for_editors(part)
    return {"$schema": "https://json-schema.org/draft/2020-12/schema"} | schema | {"title": title}


def _for_editors(schema: dict[str, Any]) -> None:
    """Leave out what a TOML file cannot say, and titles that repeat the key."""
    schema.pop("title", None)
    if "description" in schema:
        schema["description"] = schema["description"].replace("``", "`")
    if schema.get("default", ...) is None:
        del schema["default"]
    kinds = [kind for kind in schema.get("anyOf", ()) if kind != {"type": "null"}]
    if kinds:
        schema["anyOf"] = kinds
    if len(kinds) == 1:
        schema |= kinds[0]
        del schema["anyOf"]
    inner = [*schema.get("properties", {}).values(), *schema.get("anyOf", ()), schema.get("items")]
    for part in inner:
        if isinstance(part, dict):
            _for_editors(part)


def toml_text(tables: Mapping[str, Any], comments: Iterable[str] = ()) -> str:
    """Tables as the text of a TOML file, each table of a list under a heading of its own, as files are written by hand.

    Parameters
    ----------
    tables : mapping
        Of keys that need no quotes in TOML.
    comments : iterable of str
        Lines above them.
    """
    import tomli_w

    parts = [f"# {line}\n" for line in comments]
    parts.append(tomli_w.dumps({key: value for key, value in tables.items() if not _headed(value)}))
    for key, value in tables.items():
        if isinstance(value, Mapping) and _headed(value):
            inner = {name: entry for name, entry in value.items() if not _listed(entry)}
            parts.append(f"\n[{key}]\n{tomli_w.dumps(inner)}" if inner or not value else "")
            parts += [_list_of_tables(f"{key}.{name}", entry) for name, entry in value.items() if _listed(entry)]
        elif isinstance(value, list) and _listed(value):
            parts.append(_list_of_tables(key, value))
    return re.sub(r"(?<== )\[[\[\]\d\s.,e+-]*\](?=\n)", lambda array: _in_a_line(array[0]), "".join(parts))


def _in_a_line(array: str) -> str:
    """An array of numbers, which is written with one in a line, in one line."""
    return re.sub(r",\s*]", "]", re.sub(r"\[\s+", "[", re.sub(r",\s+(?=[\[\d-])", ", ", array)))


def _headed(value: Any) -> bool:
    """Whether a value is a table, or a list of tables, that stands under headings of its own; deeper ones do not."""
    if isinstance(value, Mapping):
        return all(_listed(item) or not (isinstance(item, Mapping) or _deep(item)) for item in value.values())
    return _listed(value)


def _listed(value: Any) -> bool:
    return (
        isinstance(value, list) and bool(value) and all(isinstance(item, Mapping) and not _deep(item) for item in value)
    )


def _deep(value: Any) -> bool:
    """Whether a table, or a list, holds tables."""
    inner = value.values() if isinstance(value, Mapping) else value if isinstance(value, list) else ()
    return any(isinstance(item, Mapping) or _deep(item) for item in inner)


def _list_of_tables(key: str, tables: Sequence[Mapping[str, Any]]) -> str:
    import tomli_w

    return "".join(f"\n[[{key}]]\n{tomli_w.dumps(table)}" for table in tables)
