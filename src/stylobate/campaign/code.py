"""Behaviour of a model of somebody's own, as plain values, the same in every process: its loaded code and its files."""

from __future__ import annotations

import dataclasses
import dis
import hashlib
import re
import sys
from collections.abc import Iterator, Mapping
from contextlib import suppress
from functools import cached_property, partial
from pathlib import Path
from types import CodeType, FunctionType, MethodType, ModuleType
from typing import Any

import numpy as np

from ..own_files import digest as digest_of_file

#: This package, whose sources are digested room by room.
PACKAGE = Path(__file__).parents[1]

#: First words of the names of modules that are this package's or Python's own.
_KNOWN = {"stylobate", *sys.stdlib_module_names}

#: Types of values that stand for functions.
_HELD = {
    property: ("fget", "fset"),
    staticmethod: ("__func__",),
    classmethod: ("__func__",),
    MethodType: ("__func__", "__self__"),
    partial: ("func", "args", "keywords"),
}


class Code:
    """Behaviour of a class: the code of its functions, and the functions and values beside it that they name.

    Files are told as well, with all that they hold: but a file may have been edited since it was loaded.
    """

    def __init__(self) -> None:
        self._met: dict[int, tuple[int, Any]] = {}  # by identity, and kept: no other value takes that meanwhile
        self._files: dict[Path, str] = {}

    def of_model(self, model: Any) -> list[Any]:
        """The class of a model, and what the model holds besides its parameters."""
        kind, told = type(model), {field.name for field in dataclasses.fields(model)}
        held = {name: value for name, value in vars(model).items() if name not in told}
        kept = {name for name in held if isinstance(getattr(kind, name, None), cached_property)}
        return [self.of_class(kind), self.of({name: held[name] for name in held if name not in kept})]

    def of_class(self, kind: type) -> list[Any]:
        """Functions and values of a class and its bases, but those of this package."""
        found = []
        for one in kind.__mro__:
            if one.__module__.partition(".")[0] not in _KNOWN:
                said = {name: value for name, value in vars(one).items() if name[:2] != "__" or callable(value)}
                found.append([one.__qualname__, self.of(said)])
        return found

    def of(self, value: Any) -> Any:
        """A value in plain ones; a second time it is only named."""
        if isinstance(value, (str, bytes, int, float, complex, type(None), type(...))):
            return repr(value)
        if id(value) in self._met:
            return ["as", self._met[id(value)][0]]
        self._met[id(value)] = len(self._met), value
        if isinstance(value, FunctionType):
            return self._of_function(value)
        if isinstance(value, CodeType):
            said = value.co_code, value.co_exceptiontable, value.co_names, value.co_varnames, value.co_freevars
            return [repr(said), [self.of(const) for const in value.co_consts]]
        if isinstance(value, type):
            return [value.__qualname__, [] if _is_installed(value.__module__) else self.of_class(value)]
        if isinstance(value, ModuleType):
            return [value.__name__, None if _is_installed(value.__name__) else self._of_module(value)]
        if isinstance(value, np.ndarray):
            objects = [self.of(one) for one in value.ravel().tolist()] if value.dtype.hasobject else None
            return [str(value.dtype), value.shape, objects or hashlib.sha256(value.tobytes()).hexdigest()]
        if isinstance(value, Mapping):
            return [[repr(key), self.of(value[key])] for key in sorted(value, key=repr)]
        if isinstance(value, (set, frozenset)):
            return sorted(map(repr, value))
        if isinstance(value, (list, tuple)):
            return [self.of(one) for one in value]
        if hasattr(value, "py_func"):  # compiled by numba
            return [self.of(value.py_func), self.of(value.targetoptions)]
        for kind, names in _HELD.items():
            if isinstance(value, kind):
                return [self.of(getattr(value, name)) for name in names]
        held = getattr(value, "__dict__", None)
        with suppress(Exception):  # what cannot be copied is told as it shows itself
            held = value.__reduce_ex__(2)
        return [re.sub("0x[0-9a-fA-F]+", "", repr(value)), self.of(type(value)), self.of(held)]

    def _of_module(self, module: ModuleType) -> Any:
        """Its file, and what it is made of, which may be older."""
        loaded = {
            name: value
            for name, value in vars(module).items()
            if isinstance(value, (FunctionType, type, str, int, float)) and name[:2] != "__"
        }
        return [self._file(getattr(module, "__file__", None) or ""), self.of(loaded)]

    def _of_function(self, function: FunctionType) -> Any:
        code, known = function.__code__, function.__globals__
        given: list[Any] = [self._file(code.co_filename)]
        if not _is_installed(function.__module__ or "", code.co_filename):
            beside = {name: known[name] for name in _globals(code) if name in known}
            given += [code, function.__defaults__, function.__kwdefaults__, beside]
        for cell in function.__closure__ or ():
            with suppress(ValueError):  # one that is empty
                given.append(cell.cell_contents)
        return [self.of(one) for one in given]

    def _file(self, path: str) -> str | None:
        """Digest of a file, without words if it is this package's; None where there is none."""
        place = Path(path)
        if place not in self._files and place.is_file():
            self._files[place] = "" if place.is_relative_to(PACKAGE) else digest_of_file(place)
        return self._files.get(place)


def _globals(code: CodeType) -> Iterator[str]:
    """Names that code takes from beside its function."""
    yield from (
        instruction.argval
        for instruction in dis.get_instructions(code)
        if instruction.opname in ("LOAD_GLOBAL", "LOAD_NAME")
    )
    for inner in code.co_consts:
        if isinstance(inner, CodeType):
            yield from _globals(inner)


def _is_installed(module: str, file: str | None = None) -> bool:
    """Whether a module is Python's own, or of an installed package."""
    if module.partition(".")[0] in _KNOWN:
        return True
    place = getattr(sys.modules.get(module), "__file__", None) if file is None else file
    return "site-packages" in (place or "")
