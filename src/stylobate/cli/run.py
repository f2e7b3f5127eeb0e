"""``stylobate run``: one column, one motion, one verdict."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from . import options as o

if TYPE_CHECKING:
    from ..motion import Motion
    from ..response import Response


def run(
    column: o.ColumnName,
    model: o.ModelName,
    harmonic: o.Harmonic = None,
    pulse: o.Pulse = None,
    synthetic: o.Synthetic = None,
    motion: o.MotionFiles = None,
    unit: o.Unit = None,
    dt: o.Step = None,
    component: o.ComponentName = None,
    azimuth: o.Azimuth = None,
    condition: o.Condition = None,
    scale: o.Scale = None,
    pga: o.Pga = None,
    vertical: o.Vertical = "on",
    tail: o.Tail = "0s",
    until_end: Annotated[bool, typer.Option("--until-end", help="Go on after the collapse is certain.")] = False,
    until_rest: Annotated[
        bool, typer.Option("--until-rest", help="Go on until everything lies still, on the ground if need be (dem2d).")
    ] = False,
    output_interval: Annotated[
        str, typer.Option("--output-interval", metavar="TIME", help="Time between recorded states.")
    ] = "0.01s",
    settings: o.Settings = None,
    threads: o.Threads = None,
    out: o.Out = None,
    as_json: o.Json = False,
) -> None:
    """Shake one column once.

    Prints the outcome; with --out, writes histories and figures. A folder of records is one run after the other.
    """
    from ..column.files import load_column
    from ..motion.specs import parse_time
    from ..simulate import simulate
    from . import console

    o.the_threads(threads)  # a single run has one thread
    o.check_one_motion(harmonic, pulse, motion, unit, dt, synthetic, component)
    stone = load_column(column)
    how = o.the_model(model, settings)
    if o.is_suite(motion):
        suite = o.of_each(
            o.the_suite(motion or [], unit, dt, component),
            lambda one: o.plane(o.scaled(o.shaped(one, azimuth, condition), scale, pga), vertical),
        )
        motions, refused = suite.motions, suite.refused
    else:
        shaking = o.the_motion(
            stone,
            harmonic=harmonic,
            pulse=pulse,
            file=motion,
            synthetic=synthetic,
            unit=unit,
            dt=dt,
            component=component,
            azimuth=azimuth,
            condition=condition,
            scale=scale,
            pga=pga,
            vertical=vertical,
        )
        motions, refused = (shaking,), None
    following = {
        "tail": o.the_tail(tail),
        "output_interval": parse_time(output_interval),
        "until_end": until_end,
        "until_rest": until_rest,
    }
    summaries, found = [], []
    with console.folder(out) as folder:
        for one in motions:
            response = simulate(stone, one, how, **following)
            place = folder if folder is None or refused is None else folder / safe_name(one.name, found)
            summary, files = conclude(response, one, place)
            summaries.append(summary)
            found.append(place)
            if not as_json:
                describe(response, one, files)
    if as_json:
        console.emit(summaries[0] if refused is None else {"runs": summaries, "refused": refused})
    else:
        console.print_refused(refused or {})


def conclude(response: Response, motion: Motion, folder: Path | None) -> tuple[dict, list[Path]]:
    """Summary of a run, and its files where a folder is given."""
    from . import console

    summary = response.summary() | o.input_facts(motion)
    if folder is None:
        return summary, []
    with console.folder(folder):
        files = [*write(response, motion, folder), folder / "run.json"]
        summary["files"] = [str(file) for file in files]
        console.write_json(files[-1], summary)
    return summary, files


def safe_name(name: str, taken: Sequence[Path | None]) -> str:
    """Name of a folder for a record: its own, without what file systems dislike, numbered if it is taken."""
    plain = "".join(one if one.isalnum() or one in "-_." else "_" for one in name.split(",")[0]).strip("._") or "record"
    used = {path.name for path in taken if path is not None}
    return next(one for one in (plain, *(f"{plain}-{i}" for i in range(2, len(used) + 3))) if one not in used)


def write(response: Response, motion: Motion, folder: Path) -> list[Path]:
    """Histories and figures of one run."""
    from .. import plots

    files = [response.save(folder / "response.nc")]
    for name, figure in (
        ("histories", plots.draw_histories(response)),
        ("filmstrip", plots.draw_filmstrip(response)),
        ("joints", plots.draw_joints(response)),
        ("energy", plots.draw_energy(response)),
        ("motion", plots.draw_motion(motion)),
    ):
        files += plots.save(figure, folder / name)
    return files


def describe(response: Response, motion: Motion, files: list[Path]) -> None:
    """Print the verdict for people."""
    from . import console

    m, column = response.measures, response.column
    sentence = m.outcome.sentence
    if m.reason:
        sentence += f" Reason: {m.reason}."
    if not m.decided:
        sentence += " The verdict may still change: at the end the column is far from rest; go on with --tail 5s."
    facts = {
        "column": f"{column.name}, {column.n} {'drum' if column.n == 1 else 'drums'}, {column.height:g} m high",
        **o.input_lines(motion),
        "model": f"{response.model}, step {m.time_step:.3g} s, {m.steps} steps, {response.wall_time:.2f} s",
    }
    if m.collapsed:
        facts["collapse"] = f"certain at {m.collapse_time:.2f} s"
    peak = m.peak_top_displacement
    facts |= {
        "peak top displacement": f"{console.length(peak)} ({peak / column.base_width:.2f} base widths)",
        "residual top displacement": console.length(m.residual_top_displacement),
        "peak rotation": f"{m.peak_rotation:.4f} rad",
        "peak joint opening": console.length(m.peak_joint_opening),
        "residual joint slip": console.length(m.residual_joint_slip),
        "energy imbalance": f"{m.energy_imbalance:.1e} of the input work",
    }
    console.say(sentence, facts, files)
