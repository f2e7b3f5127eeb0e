"""Groups of options that several commands share: declared once, handed to a command as one value."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from contextlib import AbstractContextManager
from dataclasses import dataclass, fields
from functools import wraps
from typing import Annotated, Any, get_args, get_origin, get_type_hints

import typer


@dataclass(frozen=True)
class Option:
    """An option of a command, as the default of a parameter or of a field of a group; without a flag, an argument."""

    metavar: str | None
    help: str
    default: Any
    flag: str | None

    def parameter(self, name: str, kind: Any) -> inspect.Parameter:
        """The option of that name as typer takes it."""
        words = {"metavar": self.metavar, "help": self.help}
        flag = f"--{name.replace('_', '-')}" if self.flag is None else self.flag
        told = Annotated[kind, typer.Option(flag, **words) if flag else typer.Argument(**words)]
        default = inspect.Parameter.empty if self.default is ... else self.default
        return inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=default, annotation=told)


def option(metavar: str | None, help: str, default: Any = None, flag: str | None = None) -> Any:
    """An option called as its parameter, unless it has a ``flag`` of its own; ``...`` for one that must be given."""
    return Option(metavar, help, default, flag)


def argument(metavar: str, help: str, default: Any = ...) -> Any:
    """What stands without a flag."""
    return Option(metavar, help, default, "")


@dataclass(frozen=True)
class Group:
    """Options as fields of a value."""


class But:
    """Fields of a group that are no options of a command: ``Annotated[Motions, But("scale", "pga")]``."""

    def __init__(self, *names: str) -> None:
        self.names = names


def takes(command: Callable[..., None], within: Callable[[], AbstractContextManager[None]]) -> Callable[..., None]:
    """The command with its options, and those of its groups in their places; it is called with the groups as values.

    Parameters
    ----------
    command : callable
    within : callable
        Makes what the command is called in.
    """
    signature = inspect.signature(command, eval_str=True)
    options: list[inspect.Parameter] = []
    groups: dict[str, tuple[type[Group], list[str], dict[str, Any]]] = {}
    for parameter in signature.parameters.values():
        plain = get_origin(parameter.annotation) is not Annotated
        kind, *notes = (parameter.annotation,) if plain else get_args(parameter.annotation)
        if isinstance(parameter.default, Option):
            options.append(parameter.default.parameter(parameter.name, kind))
        elif not (isinstance(kind, type) and issubclass(kind, Group)):
            options.append(parameter.replace(kind=parameter.KEYWORD_ONLY))
        else:
            every: dict[str, Any] = {field.name: field.default for field in fields(kind)}
            left_out = {name: every.pop(name).default for note in notes if isinstance(note, But) for name in note.names}
            types = get_type_hints(kind)
            options += [one.parameter(name, types[name]) for name, one in every.items()]
            groups[parameter.name] = kind, list(every), left_out

    @wraps(command)
    def taking(**given: Any) -> None:
        with within():
            values = {
                name: kind(**{one: given.pop(one) for one in names}, **left_out)
                for name, (kind, names, left_out) in groups.items()
            }
            command(**given, **values)

    taking.__signature__ = inspect.Signature(options)  # type: ignore[attr-defined]
    taking.__annotations__ = {one.name: one.annotation for one in options}
    return taking
