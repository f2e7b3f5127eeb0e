"""The entry point: commands, and what a person sees when something goes wrong."""

from __future__ import annotations

import errno
import io
import sys
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import cache
from typing import Annotated, Any

import typer

from ..added import added_commands, missing
from ..errors import DamagedFileWarning, InputError, LeftOutWarning, OutOfRangeWarning, PlaneOnlyWarning, StylobateError
from ..version import __version__
from . import (
    animate,
    cite,
    columns,
    compare,
    console,
    critical,
    domain,
    fragility,
    ida,
    limit,
    materials,
    modes,
    motion,
    pushover,
    records,
    risk,
    run,
    schema,
    sequence,
    signals,
    spectrum,
    states,
    study,
    suite,
)
from .options import WIDTH, Command, takes

BAD_INPUT, FAILURE, INTERRUPTED = 2, 1, signals.INTERRUPTED

# Base of typer's own complaints about a command line.
_UsageError: type[Exception] = next(base for base in typer.BadParameter.__mro__ if base.__name__ == "ClickException")

app = typer.Typer(
    name="stylobate",
    help="Will this freestanding ancient column stand the shaking?",
    rich_markup_mode=None,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": WIDTH},
)


class Interrupted(Exception):
    """A command was stopped; the message says what is kept of its work."""


@contextmanager
def _passing_on() -> Iterator[None]:
    """Around a command, whose end keeps its words: typer makes numbers of interrupts."""
    signals.KEPT.clear()
    try:
        yield
    except KeyboardInterrupt as interrupt:
        raise Interrupted(str(interrupt) or signals.sentence()) from None
    except EOFError as error:  # typer reports it as an interrupt, which it is not: no command asks for input
        raise RuntimeError(f"a file ended too soon: {error}") from error
    except Exception as error:
        ours = isinstance(error, StylobateError) and not isinstance(error, InputError)
        if signals.STOP_SIGNALLED.is_set() and not ours:  # compiled code of others makes something else of an interrupt
            raise Interrupted(signals.sentence()) from None
        raise


for _room in (
    run, sequence, critical, domain, pushover, limit, modes, compare, states, suite, ida, fragility, risk,
    motion, records, spectrum, columns, schema, materials, animate, cite
):  # fmt: skip
    _name = _room.__name__.rpartition(".")[2]
    app.command(_name, cls=Command)(takes(getattr(_room, _name), _passing_on))


_studies = typer.Typer(help="Many runs from one file: columns, records, levels, models, realisations.")
for _part in (study.run, study.status, study.export):
    _studies.command(_part.__name__, cls=Command)(takes(_part, _passing_on))
app.add_typer(_studies, name="study")


def main() -> None:
    """Run the command line and end the process."""
    for stream in (sys.stdout, sys.stderr):  # file names need not be text; terminals may lack characters
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")
    signals.listen()
    console.log_to_stderr()
    code = INTERRUPTED
    try:
        code = call(sys.argv[1:])
        signals.mark_ended()
    except KeyboardInterrupt:  # before the command had begun, or when it had ended
        signals.end_now(code)
    if signals.STOP_SIGNALLED.is_set():
        signals.end_now(code)  # at once: what others have under way is not waited for
    sys.exit(code)


def call(arguments: Sequence[str]) -> int:
    """Run one command line.

    Returns
    -------
    int
        0 when the command did its work (a collapse is a result), 2 for bad input, 1 for a failure of ours, 130 after
        an interrupt.
    """

    def do() -> Any:
        if arguments and arguments[0] not in commands().commands and missing("commands", arguments[0]):
            parameters(arguments[0])
        return commands().main(list(arguments), prog_name="stylobate", standalone_mode=False)

    return _done(list(map(str, arguments)), do)


def parameters(name: str) -> dict[str, Any]:
    """Arguments and options of a command by their names, as fields of errors and keys of requests call them.

    Raises
    ------
    InputError
        There is no such command, or its package is not installed.
    """
    if (command := commands().commands.get(name)) is None:
        place = missing("commands", name)
        raise InputError(f"{name} is a command of {place}" if place else f"there is no command {name!r}.")
    return {parameter.opts[0].strip("-").replace("-", "_"): parameter for parameter in command.params}


def run_request(request: Mapping[str, Any]) -> int:
    """Do what a request asks, with no command line between, and return what :func:`call` does.

    Parameters
    ----------
    request : mapping
        The ``command``, and values of its :func:`parameters`: a text, a list of texts, or true or false.
    """

    def do() -> None:
        known, command = parameters(request["command"]), commands().commands[request["command"]]
        for name in request.keys() - known.keys() - {"command"}:
            raise InputError(f"{request['command']} takes no {name!r}; leave it out.", name)
        values, context = {}, typer.Context(command)
        for name, parameter in known.items():
            value = parameter.get_default(context) if request.get(name) is None else request[name]
            if value is None and parameter.required:
                raise InputError(f"`{name}` is missing; give it.", name)
            values[parameter.name] = parameter.process_value(context, value)
        with context:
            command.callback(**values)

    return _done(words_of(request), do)


def words_of(request: Mapping[str, Any]) -> list[str]:
    """The command line that asks the same as a request, without the program's name: what has no flag comes first."""
    named, words, known = [request["command"]], [], parameters(request["command"])
    for name, value in request.items():
        parameter, values = known.get(name), value if isinstance(value, list) else [value]
        flag = f"--{name.replace('_', '-')}"
        if isinstance(value, bool):
            words += [flag] if value else getattr(parameter, "secondary_opts", [])[:1]
        elif getattr(parameter, "param_type_name", "") == "argument":
            named += values
        elif name != "command" and value is not None:
            words += [f"{flag}={text}" for text in values]
    return named + words


def _done(words: list[str], do: Callable[[], Any]) -> int:
    """Do a command, whose command line is that; what goes wrong is said, and its kind returned as a number."""
    console.COMMAND[:], console.WARNED[:], console.FIELD = words, [], None
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        warnings.simplefilter("always", OutOfRangeWarning)
        warnings.simplefilter("always", DamagedFileWarning)
        warnings.simplefilter("ignore", LeftOutWarning)  # commands say it with the motion, under "left out"
        warnings.simplefilter("always", PlaneOnlyWarning)
        warnings.showwarning = lambda message, *_, **__: console.warn(str(message))
        try:
            code = do()
        except InputError as error:
            console.FIELD = error.field
            return _complain(error, BAD_INPUT)
        except StylobateError as error:
            return _complain(error, FAILURE)
        except Interrupted as error:
            return _complain(error, INTERRUPTED)
        except (KeyboardInterrupt, typer.Abort):
            code = INTERRUPTED
        except OSError as error:
            named = f": {str(error.filename)[:200]}" if error.filename else ""
            bad_name = error.errno in (errno.ENAMETOOLONG, errno.ELOOP)  # of what was typed, wherever it is looked for
            return _complain(f"{error.strerror or error}{named}.", BAD_INPUT if bad_name else FAILURE)
        except MemoryError:
            return _complain(
                "the memory is not enough for this; ask for less at once, such as a shorter motion.", FAILURE
            )
        except Exception as error:
            if isinstance(error, _UsageError):
                console.FIELD = getattr(getattr(error, "param", None), "name", None)
                return _complain(_usage(error), BAD_INPUT)
            import traceback

            traceback.print_exc()
            return _complain(f"this is a fault of stylobate {__version__}, not of the input: {error!r}.", FAILURE)
    if code == INTERRUPTED:
        return _complain("interrupted; nothing is kept.", INTERRUPTED)
    return code if isinstance(code, int) else 0


@cache
def commands() -> Any:
    """All commands with their options, made once: the page's jobs are many command lines in one process."""
    program: Any = typer.main.get_command(app)
    for name, function in sorted(added_commands(program.commands).items()):
        room = typer.Typer(add_completion=False, rich_markup_mode=None)
        room.command(name, cls=Command)(takes(function, _passing_on))
        program.add_command(typer.main.get_command(room), name)
    return program


@app.callback(invoke_without_command=True)
def _version(
    context: typer.Context,
    version: Annotated[bool, typer.Option("--version", help="Print the version and leave.", is_eager=True)] = False,
) -> None:
    if version:
        typer.echo(f"stylobate {__version__}")
        raise typer.Exit
    if context.invoked_subcommand is None:
        typer.echo(context.get_help())
        raise typer.Exit


def _usage(error: Any) -> str:
    """What the library says of an option; of one that is no number, what was typed and what is allowed."""
    context, message = getattr(error, "ctx", None), " ".join(error.format_message().split()).rstrip(".")
    where = context.command_path if context is not None else "stylobate"
    kinds = {"valid integer": "a whole number", "valid number": "a number"}
    for kind in (kinds[phrase] for phrase in kinds if phrase in message):
        for place, word in enumerate(console.COMMAND):
            name, sign, value = word.partition("=")
            if name in error.param.opts and (sign or place + 1 < len(console.COMMAND)):
                value = value if sign else console.COMMAND[place + 1]
                message = f"`{name.strip('-').replace('-', '_')}` is {value!r}; allowed is {kind}"
    return f"{message}; see '{where} --help'." if where else f"{message}."


def _complain(what: object, code: int) -> int:
    print(f"stylobate: {console.WORDING(what)}", file=sys.stderr)
    return code


if __name__ == "__main__":
    main()
