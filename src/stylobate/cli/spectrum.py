"""``stylobate spectrum``: what a motion does to oscillators of all periods, or to rocking blocks of all sizes."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from ..errors import InputError
from . import options as o

if TYPE_CHECKING:
    import numpy as np

    from ..motion import Motion
    from .files import Files


def spectrum(
    files: list[Path] | None = o.argument("[MOTION]...", "Record, or the files of its components.", None),
    kind: str = o.option("KIND", "response or rocking.", "response"),
    *,
    motions: Annotated[o.Motions, o.Without("motion", *o.SEVERAL)],
    damping: float | None = o.option("SHARE", "Of a response spectrum; 0.05 by default.", read=o.number),
    periods: str | None = o.option("T:T:N", "Of a response spectrum [s], such as 0.02:10:120."),
    sizes: str | None = o.option("P:P:N", "Of a rocking spectrum [rad/s], such as 0.8:8:64.", flag="--p"),
    slendernesses: str | None = o.option("A:A:N", "Of a rocking spectrum [rad], such as 0.05:0.4:64.", flag="--alpha"),
    restitution: float | None = o.option("E", "Of a rocking spectrum; Housner's by default.", read=o.number),
    tail: float | None = o.option("TIME", "Of a rocking spectrum: go on after the motion.", read=o.time),
    execution: o.Plain,
) -> None:
    """Response spectrum, or rocking spectrum of a motion.

    Peaks of linear oscillators over their period, or of Housner's blocks over their size p and slenderness α.
    """
    from ..models.rocking.model import HousnerBlock
    from . import console

    if kind not in ("response", "rocking"):
        raise InputError(f"`kind` is {kind!r}; allowed is response or rocking.", "kind")
    _only_for(kind, "response", {"damping": damping, "periods": periods})
    _only_for(kind, "rocking", {"p": sizes, "alpha": slendernesses, "restitution": restitution, "tail": tail})
    vertical = motions.vertical if kind == "rocking" else "on"
    motion = motions.request(motion=files, vertical=vertical).motion()
    if kind == "rocking":
        motion = HousnerBlock().taken(motion)
        blocks = {
            "frequency_parameters": _values("p", sizes, geometric=True),
            "slendernesses": _values("alpha", slendernesses),
            "restitution": restitution,
            "tail": tail or 0.0,
            "threads": execution.count,
        }
        compute = partial(rocking, motion, blocks)
    else:
        share = 0.05 if damping is None else damping
        compute = partial(response, motion, _values("periods", periods, geometric=True), share)
    with execution.files("spectrum", "spectrum.csv", "spectrum.json", "spectrum") as written:
        result, facts = compute(written)
        result = {"kind": kind, **o.input_facts(motion), **result}
        if written.wanted:
            written.json(result, "spectrum.json")
            result["files"] = written.names
    if not execution.emits(result):
        lines = o.input_lines(motion)
        console.say(lines.pop("motion"), lines | facts, written)


def response(
    motion: Motion, periods: np.ndarray | None, damping: float, files: Files
) -> tuple[dict[str, Any], dict[str, str]]:
    """Response spectrum of every component, and over all horizontal directions where there are two."""
    from ..constants import g
    from ..motion.spectra import response_spectrum, rotated_spectrum

    spectra = {axis: response_spectrum(motion, periods, damping, component=axis) for axis in motion.components}
    first = next(iter(spectra.values()))
    columns: dict[str, Any] = {"period_s": first.period}
    for axis, spectrum in spectra.items():
        columns |= {f"sd_{axis}_m": spectrum.sd, f"sv_{axis}_m_s": spectrum.sv, f"sa_{axis}_g": spectrum.sa / g}
        columns |= {f"psv_{axis}_m_s": spectrum.psv, f"psa_{axis}_g": spectrum.psa / g}
    if motion.y_samples is not None:
        rotated = rotated_spectrum(motion, (50.0, 100.0), periods, damping)
        columns |= {"psa_rotd50_g": rotated[50.0] / g, "psa_rotd100_g": rotated[100.0] / g}
    result = {"damping": damping} | {key: values.tolist() for key, values in columns.items()}
    facts = {}
    for axis, spectrum in spectra.items():
        top = int(spectrum.psa.argmax())
        facts[f"largest PSA, {axis}"] = f"{spectrum.psa[top] / g:.3g} g at {spectrum.period[top]:.3g} s"
    if files.wanted:
        import pandas

        from .. import plots

        files.table(pandas.DataFrame(columns), "spectrum.csv")
        files.picture(plots.draw_spectra(motion, spectra=spectra), "spectrum")
    return result, facts


def rocking(motion: Motion, blocks: dict[str, Any], files: Files) -> tuple[dict[str, Any], dict[str, str]]:
    """Rocking spectrum along x, with the vertical component where it is on."""
    from ..response.words import longer_tail
    from ..verdicts.rocking_spectrum import rocking_spectrum

    spectrum = rocking_spectrum(motion, **blocks)
    summary = spectrum.summary()
    facts = {
        "blocks": f"{summary['cells']}: {summary['closed_cells']} stay closed, "
        f"{summary['collapsed_cells']} overturn, {summary['undecided_cells']} end far from rest "
        f"(try {longer_tail(blocks['tail'])}), {summary['failed_cells']} could not be computed",
        "strongest pulse": f"{spectrum.pulse_period:.3g} s",
    }
    if files.wanted:
        from .. import plots

        files.table(spectrum.table, "spectrum.csv")
        files.picture(plots.draw_rocking_spectrum(spectrum), "spectrum")
    return summary, facts


def _only_for(kind: str, needed: str, given: dict[str, Any]) -> None:
    for name, value in given.items():
        if value is not None and kind != needed:
            raise InputError(f"`{name}` belongs to `kind` {needed}, and `kind` is {kind}; leave it out.", name)


def _values(name: str, text: str | None, *, geometric: bool = False) -> np.ndarray | None:
    """Numbers as typed: first:last:number, evenly spaced, or in equal ratios."""
    import numpy as np

    if text is None:
        return None
    parts = text.split(":")
    if len(parts) != 3 or not parts[2].isdecimal() or not 1 <= int(parts[2]) <= 1000:
        raise InputError(f"`{name}` is {text!r}; write first:last:number with a number from 1 to 1000.", name)
    low, high, count = o.number(parts[0], name), o.number(parts[1], name), int(parts[2])
    if not 0.0 < low <= high < np.inf or (count > 1 and low == high):
        raise InputError(f"`{name}` is {text!r}; both ends must be positive and the first below the last.", name)
    return np.geomspace(low, high, count) if geometric else np.linspace(low, high, count)
