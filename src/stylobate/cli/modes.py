"""``stylobate modes``: natural frequencies of what stands, and the stiffness of joints from measured ones."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

from ..errors import InputError
from ..messages import joined
from . import options as o

if TYPE_CHECKING:
    from ..vibrations.measured_frequencies import MeasuredJoints
    from ..vibrations.modes import Modes


def modes(
    column: str = o.STRUCTURE,
    model: str | None = o.model(None),
    number: int = o.option("N", "How many modes of each kind are listed.", "3", read=o.whole_number),
    measured: str | None = o.option(
        "F±S,…",
        "Measured frequencies ± one standard deviation, such as 1.27Hz±3%,6.5Hz±6%,torsion 9.0Hz±6%: the joints' stiffness.",
    ),
    ground: str | None = o.option(
        "GROUND", "Under what was measured: rigid, or vs=200:400m/s,half_width=4m of the footing."
    ),
    draws: int | None = o.option(
        "N", "Draws of what is not known of that ground; 100 by default.", read=o.whole_number
    ),
    left: float = o.option(
        "SHARE", "Of a joint's stiffness, in the table of what its loss takes off each frequency.", "0.5", read=o.number
    ),
    *,
    modelling: Annotated[o.Modelling, o.Without("losses")],
    execution: o.Plain,
) -> None:
    """Natural frequencies and shapes on closed joints, about rest.

    Of a column or an assembly, by dem3d or, of what is plane, dem2d: bending, torsion and axial motion, which joint
    each bends, up to which motion of the top it holds, and by how much the loss of stiffness of each joint lowers it. With
    --measured, the stiffness of the joints that measured frequencies tell of.
    """
    from ..vibrations.measured_frequencies import DRAWS, joints_from_frequencies, parse_ground, parse_measured
    from ..vibrations.modes import frequency_drops
    from ..vibrations.modes import modes as modes_of
    from . import console

    stone: Any = modelling.structure(column)
    plane = stone.stack is None and stone.space_joints is None
    how = modelling.model(model or ("dem2d" if plane else "dem3d"))
    if number < 1:
        raise InputError("`number` is 0; allowed is a whole number from 1.", "number")
    for name, value in (("ground", ground), ("draws", draws)):
        if value is not None and measured is None:
            raise InputError(
                f"`{name}` is for what was measured; give `measured` too, such as `measured=1.27Hz±3%`.", name
            )
    if measured is not None and ground is None:
        raise InputError(
            "`measured` needs the ground on which it was measured; give `ground=rigid`, or `ground` "
            "vs=200:400m/s,half_width=4m of the footing.",
            "ground",
        )
    frequencies = None if measured is None else parse_measured(measured)
    under = None if ground is None else parse_ground(ground)
    if frequencies is not None and stone.stack is None:
        raise InputError(
            f"`measured` is of columns, and {stone.name!r} is {stone.described}; leave it out.", "measured"
        )
    with execution.files("modes", "modes.json", "drops.csv", "modes", "column.toml", "scatter.toml") as files:
        natural_modes = modes_of(stone, how)
        drops = frequency_drops(natural_modes, left, number) if stone.stack is not None else []
        summary = natural_modes.summary(number) | {"left": left, "drops": drops}
        joints = None
        if frequencies is not None:
            joints = joints_from_frequencies(stone, frequencies, how, under, draws=DRAWS if draws is None else draws)
            summary["inferred"] = joints.summary()
            summary["sentence"] = joined(" ", [natural_modes.sentence, joints.sentence])
        if files.wanted:
            from .. import plots

            if drops:
                files.table(_table(drops), "drops.csv")
            files.picture(plots.draw_modes(natural_modes, stone.name), "modes")
            if joints is not None:
                _write_joints(files, joints)
            files.write_request(structures=[stone], models=[how], measured=measured, ground=ground)
            files.summary(summary, "modes.json")
    if execution.emits(summary):
        return
    facts = _facts(natural_modes, number, drops, left) | ({} if joints is None else _inferred(joints))
    console.say(summary["sentence"], facts, files)


def _table(drops: list[dict[str, Any]]) -> Any:
    """Drops of frequency as a table, a row for each joint [-]."""
    import pandas as pd

    return pd.DataFrame(
        [{"joint": row["joint"]} | {_called(drop): drop["drop"] for drop in row["drops"]} for row in drops]
    )


def _called(mode: dict[str, Any]) -> str:
    """A mode in words, with its direction where a column has two."""
    towards = mode.get("azimuth_deg")
    return f"{mode['kind']} {mode['number']}" + ("" if towards is None else f" at {towards:.0f}°")


def _facts(natural_modes: Modes, number: int, drops: list[dict[str, Any]], share_left: float) -> dict[str, str]:
    """Frequencies, joints and drops for people."""
    summary, facts = natural_modes.summary(number), {"model": natural_modes.model}
    for mode in summary["modes"]:
        unit = "rad" if mode["kind"] == "torsion" else "m"
        holds = mode[f"holds_to_{unit}"]
        words = f"{mode['frequency_hz']:.5g} Hz; bends {mode['bent_joint']} most"
        if mode["limited_by"]:
            words += f"; holds to {holds:.2g} {unit} of the top, where {mode['limited_by']}"
        facts[_called(mode)] = words
    for name, words in (("joint_bending_stiffness", "k_b/J_A"), ("joint_shear_stiffness", "k_s")):
        value = summary[name]
        if isinstance(value, float):
            facts[words] = f"{value:.4g} N/m³"
        elif value and natural_modes.structure.stack is not None:
            facts[words] = f"{min(value):.4g} to {max(value):.4g} N/m³, from joint to joint"
    if natural_modes.structure.stack is not None:
        solid = natural_modes.solid_modulus / 1e9
        facts["bends as solid stone of"] = f"{solid.min():.3g} to {solid.max():.3g} GPa"
    if natural_modes.doubt:
        facts["mind"] = natural_modes.doubt
    notes = natural_modes.standing.left_out
    if notes:
        more = f"; and {len(notes) - 3} more, in the JSON" if len(notes) > 3 else ""
        facts["at rest"] = "; ".join(notes[:3]) + more
    if natural_modes.structure.stack is not None:
        for row in drops:
            words = ", ".join(
                f"{_called(drop)} {100.0 * drop['drop']:.2g} %" for drop in row["drops"] if drop["kind"] == "bending"
            )
            facts[f"{100.0 * share_left:g} % of {row['joint']} left"] = words
    return facts


def _inferred(joints: MeasuredJoints) -> dict[str, str]:
    """What measured frequencies tell, for people."""
    facts = {}
    for name, words in (("joint_bending_stiffness", "k_b/J_A"), ("joint_shear_stiffness", "k_s")):
        sides = joints.bounded_by[name]
        bounds = [f"{side} side by {which}" for side, which in sides.items() if which is not None]
        facts[f"{words} bounded"] = ", ".join(bounds) or "by nothing measured"
    if joints.open_words:
        facts["open"] = "; ".join(joints.open_words)
    return facts


def _write_joints(files: Any, joints: MeasuredJoints) -> None:
    """The column on its inferred joints, and the scatter of studies, where nothing is open."""
    from ..column.toml import toml_text

    tables, scatter = joints.tables(), joints.scatter
    if tables is not None:
        measured = ", ".join(
            f"{mode.name} {mode.frequency:g} Hz ± {100.0 * mode.spread:g} %" for mode in joints.measured
        )
        files.data(
            toml_text(tables, [f"Joints from measured frequencies: {measured}", joints.sentence]).encode(),
            "column.toml",
        )
    if scatter is not None:
        note = ["[scatter] of a study file, beside realisations and seed; --scatter joint_stiffness= likewise"]
        files.data(toml_text({"scatter": scatter}, note).encode(), "scatter.toml")
