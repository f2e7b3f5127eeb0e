"""Help on one screen: options that most runs need; those that few need by name, and told of by ``--help-all``."""

from __future__ import annotations

from textwrap import wrap
from typing import Any

from typer.core import TyperCommand, TyperOption

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
        """Options as typed; ``--help-all`` is a help that leaves nothing out."""
        ctx.meta[_ALL] = "--help-all" in args
        return super().parse_args(ctx, ["--help"] if ctx.meta[_ALL] else args)

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
