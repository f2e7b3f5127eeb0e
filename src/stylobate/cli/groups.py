"""Options: groups that several commands share, handed to a command as one value; help on one screen, the rare by name."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from contextlib import AbstractContextManager
from dataclasses import dataclass, fields
from functools import wraps
from textwrap import wrap
from typing import Annotated, Any, get_args, get_origin, get_type_hints

import typer
from typer.core import TyperCommand, TyperOption


@dataclass(frozen=True)
class Option:
    """An option of a command, as the default of a parameter or of a field of a group; without a flag, an argument."""

    metavar: str | None
    help: str
    default: Any
    flag: str | None
    complete: Callable[[str], list[str]] | None = None
    read: Callable[[str, str], Any] | None = None

    def parameter(self, name: str, kind: Any) -> inspect.Parameter:
        """The option of that name as typer takes it."""
        default = inspect.Parameter.empty if self.default is ... else self.default
        if self.read is not None:
            kind = str | None if default is None else str
        words: Any = {"metavar": self.metavar, "help": self.help, "autocompletion": self.complete}
        flag = f"--{name.replace('_', '-')}" if self.flag is None else self.flag
        told = Annotated[kind, typer.Option(flag, **words) if flag else typer.Argument(**words)]
        return inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=default, annotation=told)

    def value(self, name: str, typed: Any) -> Any:
        """What is meant by what was typed for the option of that name, which errors are about."""
        key = (self.flag or name).strip("-").replace("-", "_")
        return typed if self.read is None or typed is None else self.read(typed, key)


def option(metavar: str | None, help: str, default: Any = None, flag: str | None = None, **more: Any) -> Any:
    """An option called as its parameter, unless it has a ``flag`` of its own; ``...`` for one that must be given.

    ``read`` makes a value of what is typed, as is the default, and of the name for messages; ``complete`` gives what a shell
    completes it to.
    """
    return Option(metavar, help, default, flag, **more)


def argument(metavar: str, help: str, default: Any = ..., complete: Any = None) -> Any:
    """What stands without a flag."""
    return Option(metavar, help, default, "", complete)


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
    own: dict[str, Option] = {}
    groups: dict[str, tuple[type[Group], dict[str, Option], dict[str, Option]]] = {}
    for parameter in signature.parameters.values():
        plain = get_origin(parameter.annotation) is not Annotated
        kind, *notes = (parameter.annotation,) if plain else get_args(parameter.annotation)
        if isinstance(parameter.default, Option):
            own[parameter.name] = parameter.default
            options.append(parameter.default.parameter(parameter.name, kind))
        elif not (isinstance(kind, type) and issubclass(kind, Group)):
            options.append(parameter.replace(kind=parameter.KEYWORD_ONLY))
        else:
            every: dict[str, Any] = {field.name: field.default for field in fields(kind)}
            left_out = {name: every.pop(name) for note in notes if isinstance(note, But) for name in note.names}
            types = get_type_hints(kind)
            options += [one.parameter(name, types[name]) for name, one in every.items()]
            groups[parameter.name] = kind, every, left_out

    @wraps(command)
    def taking(**given: Any) -> None:
        with within():
            values = {}
            for name, (kind, every, left_out) in groups.items():
                stated = {key: one.value(key, given.pop(key)) for key, one in every.items()}
                values[name] = kind(**stated, **{key: one.value(key, one.default) for key, one in left_out.items()})
            command(**given | {key: one.value(key, given[key]) for key, one in own.items()}, **values)

    taking.__signature__ = inspect.Signature(options)  # type: ignore[attr-defined]
    taking.__annotations__ = {one.name: one.annotation for one in options}
    return taking


#: Options that few runs need, of commands that have many.
RARE = frozenset({
    "across", "synthetic", "unit", "dt", "columns", "component", "azimuth", "azimuths", "signs", "condition",
    "vertical", "whole", "until_end", "output_interval", "settings", "losses", "project", "scatter", "motion_scatter",
    "seed", "pictures", "half_step", "threads", "dask", "device", "mix_devices",
})  # fmt: skip

#: Options that fit on a screen with their help.
FEW = 22

#: Columns of a line of help.
WIDTH = 100


class Command(TyperCommand):
    """A command whose help is one screen."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Options as typed, each once unless it may be repeated; ``--help-all`` is a help that leaves nothing out."""
        ctx.meta[_ALL] = "--help-all" in args
        args = ["--help"] if ctx.meta[_ALL] else args
        _, _, given = self.make_parser(ctx).parse_args(list(args))
        for option in given:
            if isinstance(option, TyperOption) and not (option.multiple or option.is_flag) and given.count(option) > 1:
                ctx.fail(f"{option.opts[0]} is given {given.count(option)} times; give it once.")
        return super().parse_args(ctx, args)

    def format_options(self, ctx: Any, formatter: Any) -> None:
        """Write the options: all where they were asked for, else the rare ones by their names."""
        options = [param for param in self.params if isinstance(param, TyperOption)]
        few = ctx.meta.get(_ALL) or len(options) <= FEW
        rare = [] if few else [option for option in options if option.name in RARE]
        for one in rare:
            one.hidden = True
        super().format_options(ctx, formatter)
        for one in rare:
            one.hidden = False
        if rare:
            with formatter.section("More options, which --help-all explains"):
                names = " ".join(one.opts[0] for one in rare)
                for line in wrap(names, formatter.width - formatter.current_indent, break_on_hyphens=False):
                    formatter.write_text(line)


_ALL = "stylobate.help_all"
