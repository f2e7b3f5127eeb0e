"""``stylobate pushover``: the equilibrium path of a column under growing horizontal forces."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Annotated, Any

from ..errors import InputError
from . import options as o

#: A number in SI units as typed.
NUMBER = partial(o.number, example="in SI units, such as 0.5")


@dataclass(frozen=True)
class Loads(o.Group):
    """How a column is pushed."""

    pattern: list[float] | None = o.option(
        "P,P,…",
        "Relative force on each drum, bottom to top; by mass by default.",
        read=lambda text, name: [NUMBER(part, name) for part in text.split(",")],
    )
    tilt: float = o.option(
        "DEGREES",
        "Tilt of the base, downhill to the right, where the forces push; base_tilt of columns as found is opposite.",
        "0",
        read=NUMBER,
    )
    compressive_strength: float | None = o.option(
        "P", "Strength of the joints, such as 2MPa; unlimited by default.", read=o.pressure
    )

    @property
    def arguments(self) -> dict[str, Any]:
        """Arguments of the analyses."""
        return {"pattern": self.pattern, "base_tilt": self.tilt, "compressive_strength": self.compressive_strength}

    @property
    def typed(self) -> bool:
        """Whether they are others than usual."""
        return [*self.arguments.values()] != [None, 0.0, None]


def pushover(
    column: str = o.COLUMN,
    to: float | None = o.option("M", "Displacement of the top at which to stop, in metres.", read=NUMBER),
    at: int | None = o.option(
        "DRUM",
        "Drum, from 1, that is led and told of instead of the top, as where a tie holds it.",
        read=o.whole_number,
    ),
    control: str = o.option("WAY", "displacement or arc-length.", "displacement"),
    linear: bool = o.option(None, "Equilibrium in the undisplaced state.", False),
    direction: float | None = o.option(
        "0|180", "Forces to the right or to the left; the weaker one by default.", read=NUMBER
    ),
    check: str | None = o.option(
        "CODE,…", "By a code: ec8,ag=0.25g,soil=B,type=1,knowledge=KL2, or ntc2018,ag=0.25g,F0=2.4,Tc*=0.35s,soil=B,…."
    ),
    *,
    pushing: Loads,
    modelling: Annotated[o.Modelling, o.Without("settings", "losses")],
    execution: o.Plain,
) -> None:
    """Pushover curve of a column of rigid blocks.

    Its weight, then horizontal forces, over the peak and down to zero. To the right; of a column as found in the direction
    in which the limit analysis finds it weaker.
    """
    from ..codes.checks import CodeSite, code_check
    from ..statics.limit import limit_analysis, limit_directions, towards
    from ..statics.pushover import pushover as follow
    from . import console

    stone = modelling.column(column)
    loads = pushing.arguments
    site = None if check is None else CodeSite.typed(check)
    if site is not None and at is not None:
        raise InputError("a check by a code is of the top, and `at` names a drum; leave one of them out.", "at")
    if direction is not None:
        loads["direction"] = direction
    elif stone.as_found and stone.as_found.in_plane:
        loads["direction"] = limit_directions(stone, **loads).weakest.azimuth
    with execution.files("pushover", "pushover.csv", "pushover.json", "pushover") as files:
        path = follow(stone, control=control, geometric=not linear, to=to, at=at, **loads)
        summary = path.summary() | {"direction_deg": loads.get("direction", 0.0)}
        checked = None if site is None else code_check(towards(stone, summary["direction_deg"]), path, site)
        if checked is not None:
            summary["check"] = checked.summary()
        if files.wanted:
            from .. import plots

            limit = limit_analysis(stone, **loads).multiplier
            stack = towards(stone, loads.get("direction", 0.0))
            figure = plots.draw_pushover(stack, path, limit, stone.name)
            files.append(path.save(files / "pushover.csv"))
            files.json(summary, "pushover.json")
            files.picture(figure, "pushover")
            files.write_request(structures=[stone], control=control, linear=linear, limit_analysis_g=limit, **loads)
            summary["files"] = files.names
    if execution.emits(summary):
        return
    facts = {"column": stone.name}
    if stone.as_found:
        facts["pushed"] = "to the left, seen from behind" if summary["direction_deg"] else "to the right"
    if path.peaked:
        sentence = f"The column gives way at {path.collapse_multiplier:.4g} g."
        facts |= {
            "collapse multiplier": f"{path.collapse_multiplier:.4g} g",
            "displacement at the peak": console.length(path.peak_displacement),
            "ultimate displacement": console.length(path.ultimate_displacement),
            "governing joint": str(path.governing_joint),
        }
    else:
        remedy = "leave out --to, or give a larger one" if path.complete else "--control takes another way"
        sentence = (
            f"The column bears {path.largest_multiplier:.4g} g, and more: the path ends before it gives way; {remedy}."
        )
    facts["end of the path"] = path.stop
    if checked is not None:
        sentence += f" {checked.sentence}"
        facts |= {
            coefficient.name: f"{coefficient.value:.4g} ({coefficient.source})" for coefficient in checked.coefficients
        }
        facts["left out"] = "; ".join(checked.left_out)
    console.say(sentence, facts, files)
