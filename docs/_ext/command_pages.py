"""The reference of the command line, from the commands themselves; and the list of references, from the bibliography."""

import inspect
import re

from stylobate.bibliography import bibliography
from stylobate.cli.main import commands

#: An option in a sentence.
OPTION = re.compile(r"(?<!\S)--[a-z-]+")


def texts(out):
    """The command line and the references."""
    described = [command(click_command, name) for name, click_command in commands().commands.items()]
    references = "".join(
        f"{reference.text}\n\n" for reference in sorted(bibliography().values(), key=lambda reference: reference.text)
    )
    return [(out / "commands.md", "\n".join(described)), (out / "references.md", references)]


def command(click_command, name):
    """Help, usage and options of a command."""
    arguments = [parameter for parameter in click_command.params if parameter.param_type_name == "argument"]
    options = [parameter for parameter in click_command.params if parameter.param_type_name == "option"]
    usage = " ".join(["stylobate", name, *(metavar(parameter) for parameter in arguments), "[OPTIONS]"])
    rows = "".join(f"| {spelling(parameter)} | {words(parameter)} |\n" for parameter in [*arguments, *options])
    text = OPTION.sub(lambda match: f"`{match[0]}`", inspect.cleandoc(click_command.help))
    head = f"| option | |\n| --- | --- |\n{rows}" if rows else ""
    return f"## {name}\n\n{text}\n\n```text\n{usage}\n```\n\n{head}"


def metavar(parameter):
    """What stands for the value of an argument or option."""
    return parameter.metavar or parameter.name.upper()


def spelling(parameter):
    """The option as it is typed."""
    if parameter.param_type_name == "argument":
        return code(metavar(parameter))
    return code(", ".join(parameter.opts) + ("" if parameter.is_flag else f" {metavar(parameter)}"))


def code(text):
    """Text in the type of code, in a cell of a table."""
    return f"`{text}`".replace("|", "\\|")


def words(parameter):
    """Help, whether it must be given, and the default."""
    text = OPTION.sub(lambda match: f"`{match[0]}`", (parameter.help or "").replace("|", "\\|"))
    if parameter.required:
        return f"{text} *Required.*"
    shown = parameter.default not in (None, "", False) and not callable(parameter.default)
    return f"{text} Default: {code(parameter.default)}." if shown else text
