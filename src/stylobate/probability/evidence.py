"""Evidence for fragilities: what runs say of a limit state; an incremental dynamic analysis and its curves."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import text_tables as tables
from ..campaign.twins import LAW, Twins
from ..column.structure import Structure
from ..errors import InputError, check_kind
from ..messages import say
from ..models.base import Model
from ..motion.intensity import ENDS, IntensityMeasure, measure_of_column, parse_measure
from ..notebook import NotebookSummary
from ..outcome import Outcome
from ..response.measures import blank_row
from ..text_tables import check_file, printable
from ..verdicts import verdict as v
from ..verdicts.directions import peak_of
from ..verdicts.limit_states import EXCEEDED, FAILED, NOT_EXCEEDED, OPEN, LimitState, parse_state
from ..verdicts.verdict import SHARES, Capacity, bounds, of_levels, quantiles
from .lognormal import fit

if TYPE_CHECKING:
    import pandas


def check_response(edp: str, column: Structure, model: Model) -> None:
    """Refuse a measure of the response that runs of this column will not have, before they are made."""
    if column.links:  # what is measured of links has many names
        return
    row = blank_row(space="y" in model.axes, blocks=column.base_width is None)
    numbers = [name for name, value in row.items() if isinstance(value, float)]
    if edp not in numbers:
        raise unknown_response(edp, numbers)


def unknown_response(edp: str, names: Iterable[str]) -> InputError:
    """The sentence that runs have no such measure."""
    known = [name for name in names if name.startswith(("peak_", "residual_"))]
    return InputError(f"the runs have no measure {edp!r}; measures are {', '.join(known)}.")


@dataclass(frozen=True, eq=False)
class Curve:
    """One motion with one column.

    Parameters
    ----------
    record : str
        That the motion is of.
    motion : str
        The record, or one of its components.
    realisation : int
    im, edp : array
        Intensity, rising, and the measure of the response of the runs that stand, shape (k,).
    stands, collapses : float
        The largest intensity up to which every run stands, and that of the first collapse; 0 and +inf where there is
        none. What is undecided or failed between them may be a collapse.
    resurrections : array
        Intensities above the first collapse at which it stands.
    open_runs : int
        Runs that are undecided or failed.
    """

    record: str
    motion: str
    realisation: int
    im: np.ndarray
    edp: np.ndarray
    stands: float
    collapses: float
    resurrections: np.ndarray
    open_runs: int

    def at(self, im: np.ndarray) -> np.ndarray:
        """Response at given intensities: straight between runs, +inf from half way to the first collapse on.

        NaN where it did not collapse and no run stands at an intensity as large: what is undecided or failed tells of no
        response; and below a collapse under which no run stands.
        """
        below = self.im < self.collapses
        x, y = np.concatenate(([0.0], self.im[below])), np.concatenate(([0.0], self.edp[below]))
        response = np.interp(im, x, y) if below.any() else np.full(np.shape(im), np.nan)
        if math.isinf(self.collapses):
            return np.where(im > x[-1], np.nan, response)
        edge = math.sqrt(self.stands * self.collapses) if self.stands else 0.5 * self.collapses
        return np.where(im > edge, np.inf, response)


@dataclass(frozen=True, eq=False)
class Ida(NotebookSummary):
    """An incremental dynamic analysis.

    Parameters
    ----------
    runs : pandas.DataFrame
        One row per run: record, motion, realisation, level, factor, verdict, measures of the response and of the scaled
        motion.
    measure : IntensityMeasure
        That the records were scaled to.
    column : Column or Assembly
    model : str
    wall_time : float
        [s]
    twins : Twins, optional
        The columns like this one that were run in its place.
    doubt : str
        What stands before all that rests on these runs, because of the model; empty where nothing does.
    """

    runs: pandas.DataFrame
    measure: IntensityMeasure
    column: Structure
    model: str
    wall_time: float
    twins: Twins | None = None
    doubt: str = ""

    def curves(self, edp: str | None = None) -> list[Curve]:
        """One curve per motion and realisation.

        Parameters
        ----------
        edp : str, optional
            A measure of the response, as a column of the table of runs; the peak displacement by default, of the top or of
            the body of an assembly that goes farthest.
        """
        edp = peak_of(self.runs) if edp is None else edp
        if edp not in self.runs:
            raise unknown_response(edp, self.runs.columns)
        curves = []
        groups: Any = self.runs.groupby(["record", "motion", "realisation"], sort=False)
        for (record, motion, realisation), rows in groups:
            x = rows["level"].to_numpy(dtype=float)
            verdict = rows["verdict"].to_numpy(dtype=object)
            stands, (low, first) = verdict == v.STANDS, of_levels(x, verdict)
            curves.append(
                Curve(
                    str(record),
                    str(motion),
                    int(realisation),
                    x[stands],
                    np.abs(rows[edp].to_numpy(dtype=float)[stands]),
                    low,
                    first,
                    x[stands & (x > first)],
                    int(np.count_nonzero((verdict == v.UNDECIDED) | (verdict == v.FAILED))),
                )
            )
        return curves

    def fractiles(self, edp: str | None = None, points: int = 100) -> pandas.DataFrame:
        """Response that 16, 50 and 84 % of the curves do not exceed, over the intensity.

        A collapse exceeds every response: +inf. A curve counts no further than its runs stand or collapse; where fewer
        than half of all curves are left there is none.
        """
        import pandas

        curves = self.curves(edp)
        im = np.geomspace(self.runs["level"].min(), self.runs["level"].max(), points)
        values = np.array([curve.at(im) for curve in curves])
        table = {"im": im, "curves": np.count_nonzero(~np.isnan(values), axis=0)}
        for share in SHARES:
            column = []
            for row in values.T:
                known = row[~np.isnan(row)]
                enough = 2 * len(known) >= len(curves)
                column.append(float(np.quantile(known, share, method="inverted_cdf")) if enough else math.nan)
            table[f"edp_{100 * share:.0f}"] = np.array(column)
        return pandas.DataFrame(table)

    @property
    def capacities(self) -> pandas.DataFrame:
        """One row per curve: between which levels its first collapse lies, and how often it stands again above."""
        import pandas

        runs = self.runs.groupby(["record", "motion", "realisation"], sort=False).size().tolist()
        return pandas.DataFrame(
            [
                {
                    "record": curve.record,
                    "motion": curve.motion,
                    "realisation": curve.realisation,
                    "stands_until": curve.stands,
                    "collapses_from": None if math.isinf(curve.collapses) else curve.collapses,
                    "resurrections": len(curve.resurrections),
                    "runs": count,
                    "open": curve.open_runs,
                }
                for curve, count in zip(self.curves(), runs)
            ]
        )

    def summary(self) -> dict[str, Any]:
        """The JSON object of ``stylobate ida``."""
        table: Any = self.capacities
        runs: Any = self.runs
        counts = v.count(self.runs["verdict"].to_numpy(dtype=object))
        capacities = table.astype(object).where(table.notna(), None).to_dict("records")
        pairs = zip(SHARES, quantiles(map(_capacity, capacities)), strict=True)
        shares = {f"capacity_{100 * share:.0f}": quantile for share, quantile in pairs}
        return {
            "im": self.measure.name,
            "unit": self.measure.unit,
            "records": int(runs["record"].nunique()),
            "curves": len(table),
            "runs": len(self.runs),
            **{verdict: counts[verdict] for verdict in v.COMPUTED},
            "resurrections": int(table["resurrections"].sum()),
            "curves_with_resurrections": int((table["resurrections"] > 0).sum()),
            **{name: quantile.high for name, quantile in shares.items()},
            "bounds": bounds({name: (quantile, 1.0) for name, quantile in shares.items()}),
            "largest_factor": float(runs["factor"].max()),
            "capacities": capacities,
            "wall_s": self.wall_time,
            "model": self.model,
            "doubt": self.doubt,
            **({} if self.twins is None else {"replicates": len(self.twins.columns), "certainty": self.twins.facts}),
        }


def _capacity(row: Mapping[str, Any]) -> Capacity:
    high = row["collapses_from"]
    return Capacity(float(row["stands_until"]), math.inf if high is None else float(high))


def median_of(summary: Mapping[str, Any]) -> str:
    """Between which levels half of the curves have collapsed, in words; from the JSON object of ``stylobate ida``.

    It is counted, without a curve. The median of a fragility is that of the lognormal curve that fits all capacities best.
    """
    (half,) = quantiles(map(_capacity, summary["capacities"]), (0.5,))
    unit = "" if summary.get("unit") in (None, "-") else f" {summary['unit']}"
    known = {"im": say(str(summary.get("im"))), "low": half.low, "high": half.high, "unit": unit}
    bound = half.bound()
    if bound is None:
        return say("half of the curves have collapsed between {im} = {low:.3g} and {high:.3g}{unit}", **known)
    if half.low > 0.0:
        fewer = say("fewer than half of the curves collapse up to {im} = {low:.3g}{unit}, and the median lies above")
        return fewer.of(**known)
    if bound.startswith("≤"):
        below = say("half of the curves have collapsed at {im} = {high:.3g}{unit}, or below: no lower level was stood")
        return below.of(**known)
    return say("no level tells where half of the curves have collapsed")


#: Tables of runs that a folder may hold, the first that is there.
TABLES = ("runs.csv", "runs.parquet", "states.csv", "study.csv", "study.parquet", "suite.csv")

#: Columns that say what stood, the first that a table has: by name, or as which state of one column.
STOOD = ("column", "state")

#: Other names that tables have for a measure, by its key.
ALSO = {
    "pga_g": ("amplitude_g",),
    "d5_95_s": ("duration_5_95_s",),
    "d5_75_s": ("duration_5_75_s",),
    **{f"sa_{t}s_g": (f"psa_{t}s_g",) for t in ("0.1", "0.2", "0.5", "1", "2", "4")},
}

#: Columns of an intensity that is not named, each with one that is, in the same unit.
UNNAMED = {f"im{ENDS[measure.unit]}": measure.key for measure in map(parse_measure, ("pga", "pgv", "d5_95"))}

#: Intensities whose logarithms differ in later digits only are one.
DIGITS = 6

#: Largest table that is read [bytes].
MOST = 2_000_000_000


@dataclass(frozen=True, eq=False)
class Evidence:
    """Runs and whether they exceed a state.

    Parameters
    ----------
    records : array of str, shape (n,)
        Which record each run is of; runs of one record are not independent.
    im : array, shape (n,)
        Intensity of each run, positive.
    codes : array of int, shape (n,)
        Exceeded, not exceeded, open or failed, as of :mod:`~stylobate.verdicts.limit_states`.
    measure : str
        The intensity measure, as typed; ``im`` where a table does not say.
    unit : str
    state : str
    name : str
        What the runs are of, for a legend.
    brackets : bool
        Levels were chosen to bracket the capacity under each record (an IDA).
    curves : array, shape (n,), optional
        Which runs have one capacity: those under one motion of a record with one column; all of a record by default.
    doubt : str
        What stands before all that rests on these runs, because of the model; empty where nothing does.
    laws : array, shape (n,), optional
        Number of the law of the joints of each run, where it varies.
    """

    records: np.ndarray
    im: np.ndarray
    codes: np.ndarray
    measure: str
    unit: str
    state: str
    name: str
    brackets: bool = False
    curves: np.ndarray | None = None
    doubt: str = ""
    laws: np.ndarray | None = None

    def only(self, mask: np.ndarray) -> Evidence:
        """Some of these runs."""
        alike = {name: None if (values := getattr(self, name)) is None else values[mask] for name in ("curves", "laws")}
        return replace(self, records=self.records[mask], im=self.im[mask], codes=self.codes[mask], **alike)

    def count(self, code: int) -> int:
        """Number of runs that say so."""
        return int(np.count_nonzero(self.codes == code))


def table_of(source: str | Path) -> Path:
    """The table of runs of a folder, or the file itself.

    Raises
    ------
    InputError
        The folder has none.
    """
    place = Path(source)
    if not place.is_dir():
        return place
    path = next((place / table for table in TABLES if (place / table).is_file()), None)
    if path is None:
        raise InputError(
            f"{printable(place)} holds no table of runs ({', '.join(TABLES)}); give the folder of a study, an IDA, a "
            "suite or states, or a CSV file with the columns record, im, collapsed."
        )
    return path


def read_table(source: str | Path) -> pandas.DataFrame:
    """The table of runs of a folder or a file (CSV, Parquet).

    Raises
    ------
    InputError
        There is none, or it has no column ``record``.
    """
    import pandas

    place = table_of(source)
    if place.suffix == ".parquet":
        check_file(place, MOST)
        try:
            table = pandas.read_parquet(place)
        except (ValueError, OSError, ImportError) as error:
            raise InputError(
                f"{printable(place)} is no table that can be read ({str(error).splitlines()[0]})."
            ) from None
    else:
        cells = tables.read(place, MOST, "record", "the columns record, im, collapsed")
        cells.refuse_halves("im", ("collapsed", "record"))
        table = pandas.read_csv(cells.to_csv(), low_memory=False)
        if cells.rows:
            table["record"] = cells.texts("record")  # names, whatever they look like
    if "record" not in table or not len(table):
        raise InputError(
            f"{printable(place)} has no runs with a column 'record'; it needs the columns record, im, collapsed."
        )
    return table


def names_in(table: pandas.DataFrame) -> list[str] | None:
    """Structure of each run, as the table calls it, with the model where there are several; None if it does not say."""
    who = [column for column in STOOD if column in table][:1]
    who += [column for column in ("model",) if column in table and len(set(table[column])) > 1]
    return [", ".join(map(str, row)) for row in table[who].to_numpy()] if who else None


def evidence(
    table: pandas.DataFrame | Ida,
    measure: IntensityMeasure | str | None = None,
    state: LimitState | str = "collapse",
    name: str = say("runs"),
    unit: str = "-",
    doubt: str = "",
    *,
    im: IntensityMeasure | str | None = None,
) -> Evidence:
    """Evidence of a table of runs about a state.

    Parameters
    ----------
    table : pandas.DataFrame or Ida
        One row per run, as of :func:`stylobate.suite_table`, of a study, or of a file (:func:`read_table`); or an
        incremental dynamic analysis, then over the measure that its records were scaled to by default.
    measure, im : IntensityMeasure or str, optional
        Two names of one: looked for among the columns, such as ``pgv``; the column called ``im`` by default.
    state : LimitState or str
        Such as ``collapse`` or ``top:0.35d``.
    name : str
    unit : str
        Of the column ``im`` where no measure is given.
    doubt : str
        Of the evidence; by default what the table says itself.

    Raises
    ------
    InputError
        The measure or the state is not in the table, or a value makes no sense.
    """
    import pandas

    if measure is not None and im is not None:
        raise InputError("the intensity is given twice, as measure and as im; give it once.")
    measure = im if measure is None else measure
    what = "a table of runs, such as that of read_table or suite_table, or an Ida"
    check_kind("table", table, (pandas.DataFrame, Ida), allowed=what)
    if isinstance(table, Ida):
        measure, table = measure or table.measure, table.runs
    if not len(table):
        raise InputError(f"the table of {name} is empty; give one with a row per run.")
    doubt = doubt or str(table.attrs.get("doubt", ""))
    check_kind("measure", measure, (str, IntensityMeasure), optional=True)
    check_kind("state", state, (str, LimitState), allowed="a limit state, such as 'collapse'")
    measure = parse_measure(measure) if isinstance(measure, str) else measure
    if measure is None and "im" not in table and len(known := _measures(table)) == 1:
        measure = known[0]
    state = parse_state(state) if isinstance(state, str) else state
    key = "im" if measure is None else next(
        (column for column in (measure.key, *ALSO.get(measure.key, ())) if column in table), "im"
    )  # fmt: skip
    scaled_measure = scaled_to(table)
    if key not in table or (key == "im" and measure is not None and scaled_measure not in (None, measure.name)):
        raise InputError(
            f"the runs of {name} have no intensity {measure.name if measure else 'im'!r}; "
            f"columns are {', '.join(map(str, list(table.columns)[:40]))}{_remedy(table, measure)}."
        )
    if key == "im" and measure is not None and scaled_measure is None and (rivals := _rivals(table, measure)):
        raise InputError(
            f"the runs of {name} have the columns im and {' and '.join(rivals)}, and which of them is {measure.name} in "
            f"{measure.unit} is not said; call that one {measure.key}."
        )
    numbers: Any = pandas.to_numeric(table[key], errors="coerce")
    sizes = np.asarray(numbers, dtype=float)
    bad = np.flatnonzero(~(np.isfinite(sizes) & (sizes >= 0.0)))
    if bad.size:
        text = str(table[key].iloc[bad[0]])
        raise InputError(
            f"the intensity {key!r} of run {bad[0] + 1} of {name} is {text[: tables.LONGEST]!r}; allowed is a number from "
            f"0{tables.points(text)}."
        )
    nameless = np.flatnonzero((table["record"].isna() | (table["record"].astype(str).str.strip() == "")).to_numpy())
    if nameless.size:
        raise InputError(
            f"run {nameless[0] + 1} of {name} has no record, and runs of one record hang together; name it in the column "
            "'record'."
        )
    if "outcome" in table or "verdict" in table:
        _check_words(table, name)
        rows = table.astype(object).where(table.notna(), None).to_dict("records")
        codes = np.array([state.of(row) for row in rows], dtype=np.int8)
    else:
        codes = _plain_codes(table, state, name)
    zero = sizes == 0.0  # of no intensity: nothing is exceeded, and the logarithm does not exist
    if (codes[zero] == EXCEEDED).any():
        k = int(np.flatnonzero(zero & (codes == EXCEEDED))[0])
        raise InputError(
            f"run {k + 1} of {name} exceeds {state.name} at an intensity {key!r} of 0; choose an intensity that its motion "
            "has, with `im`."
        )
    alike = [column for column in ("record", "motion", "realisation") if column in table]
    return Evidence(
        np.array([str(record) for record in table["record"]], dtype=object)[~zero],
        sizes[~zero],
        codes[~zero],
        "im" if measure is None else measure.name,
        unit if measure is None else measure.unit,
        state.name,
        name,
        "hunted" in table and bool(table["hunted"].iloc[0]),
        table.groupby(alike, dropna=False).ngroup().to_numpy()[~zero],
        doubt,
        _laws(table, ~zero),
    )


def _laws(table: pandas.DataFrame, mask: np.ndarray) -> np.ndarray | None:
    """Law of the joints of some runs; None where a table does not say that it varies."""
    import pandas

    laws = np.nan_to_num(np.asarray(pandas.to_numeric(table[LAW], errors="coerce"))) if LAW in table else np.zeros(1)
    return laws[mask].astype(int) if laws.any() else None


def _rivals(table: pandas.DataFrame, measure: IntensityMeasure) -> list[str]:
    """Columns besides ``im`` that may be the measure as well: of its kind in no unit that is known, or of none."""
    stem = measure.name.replace(":", "_").replace("@", "_")
    names = [str(column) for column in table.columns]
    return [name for name in names if name in UNNAMED or name == stem or name.startswith(f"{stem}_")]


def _measures(table: pandas.DataFrame) -> list[IntensityMeasure]:
    """The measures after which columns of a table are called."""
    return [measure for measure in map(measure_of_column, map(str, table.columns)) if measure is not None]


def _remedy(table: pandas.DataFrame, measure: IntensityMeasure | None) -> str:
    """Remedies where a table has not the intensity that is asked for."""
    unnamed = [str(column) for column in table.columns if column in UNNAMED]
    if unnamed:
        alike = measure is not None and ENDS[measure.unit] == unnamed[0].removeprefix("im")
        key = measure.key if measure is not None and alike else UNNAMED[unnamed[0]]
        return f". Which intensity {unnamed[0]} is, is not said: call the column after it, such as {key}"
    if measure is None and (known := _measures(table)):
        return f"; choose one with `im`, such as `im={known[0].name!r}`"
    return ""


def scaled_to(table: pandas.DataFrame) -> str | None:
    """The intensity measure that the runs of a study or an IDA were scaled to; None where a table does not say.

    Raises
    ------
    InputError
        They were scaled to several.
    """
    key = next((column for column in ("im_name", "measure") if column in table), None)
    if key is None:
        return None
    names = list(dict.fromkeys(str(name) for name in table[key]))
    if len(names) > 1:
        raise InputError(f"runs are over different intensities ({', '.join(names[:5])}); give those of one of them.")
    return names[0]


def _check_words(table: pandas.DataFrame, name: str) -> None:
    """Refuse words about the end of a run that are none of ours: what they mean would be guessed."""
    allowed: dict[str, tuple[Any, ...]] = {"verdict": v.VERDICTS}
    if "verdict" not in table:
        allowed = {"outcome": tuple(map(str, Outcome)), "decided": (True, False), "collapsed": (True, False)}
        missing = [column for column in allowed if column not in table]
        if missing:
            raise InputError(
                f"the runs of {name} have an outcome but no column {missing[0]!r}; give the columns record, im, collapsed."
            )
    for key, words in allowed.items():
        strange = [word for word in table[key].dropna().unique() if word not in words]
        if strange:
            text = str(strange[0])
            raise InputError(
                f"{key!r} of a run of {name} is {text[: tables.LONGEST]!r}; allowed is {', '.join(map(str, words))}."
            )


def _plain_codes(table: pandas.DataFrame, state: LimitState, name: str) -> np.ndarray:
    if state.what or "collapsed" not in table:
        raise InputError(f"the runs of {name} say only {', '.join(map(str, table.columns))}; {state.name} needs more.")
    words = {"1": EXCEEDED, "0": NOT_EXCEEDED, "1.0": EXCEEDED, "0.0": NOT_EXCEEDED, "true": EXCEEDED,
             "false": NOT_EXCEEDED, "": OPEN, "failed": FAILED}  # fmt: skip
    values, missing = table["collapsed"].tolist(), table["collapsed"].isna().tolist()
    texts = ["" if gone else str(value).strip().lower() for value, gone in zip(values, missing)]
    strange = [text for text in texts if text not in words]
    if strange:
        raise InputError(f"'collapsed' of {name} is {strange[0]!r}; allowed is 0, 1, or nothing where it is undecided.")
    return np.array([words[text] for text in texts], dtype=np.int8)


def intervals(evidence: Evidence, codes: np.ndarray, method: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Intervals of ln capacity that the runs say, as of :func:`lognormal.fit`, and the number of each one's record.

    Open and failed runs say nothing. By ``records`` there is one of each curve.
    """
    y = np.log(evidence.im)
    owner = np.unique(evidence.records, return_inverse=True)[1]
    if method == "runs":
        known = codes >= 0
        low = np.where(codes[known] == EXCEEDED, -np.inf, y[known])
        return low, np.where(codes[known] == EXCEEDED, y[known], np.inf), owner[known]
    mine = evidence.records if evidence.curves is None else evidence.curves
    _, first, curve = np.unique(mine, return_index=True, return_inverse=True)
    low, high = np.full(len(first), -np.inf), np.full(len(first), np.inf)
    np.minimum.at(high, curve[codes == EXCEEDED], y[codes == EXCEEDED])
    below = (codes == NOT_EXCEEDED) & (y < high[curve])  # above the first that exceeds it stands again: a resurrection
    np.maximum.at(low, curve[below], y[below])
    known = np.isfinite(low) | np.isfinite(high)
    return low[known], high[known], owner[first][known]


def independent(low: np.ndarray, high: np.ndarray, owner: np.ndarray, method: str) -> tuple[np.ndarray, float]:
    """How much each interval counts beside others of its record, shape (n,), and how many equal records all come to.

    Runs of one record at one intensity, as of columns like one another, or capacities of one record, count as one together.
    Records with more intensities than others are fewer than their number: (Σ m)²/Σ m² of them (Kish 1965), with m
    intensities each.

    Parameters
    ----------
    low, high, owner : array, shape (n,)
    method : str
        All as of :func:`intervals`.
    """
    place = np.where(np.isfinite(low), low, high) if method == "runs" else np.zeros(len(low))
    _, cell, count = np.unique(np.stack((owner, place), axis=1), axis=0, return_inverse=True, return_counts=True)
    weight = 1.0 / count[cell.ravel()]
    each = np.bincount(np.unique(owner, return_inverse=True)[1], weight)
    return weight, float(each.sum() ** 2 / (each**2).sum())


def medians_by_law(evidence: Evidence, codes: np.ndarray, method: str) -> np.ndarray:
    """ln of the median capacity under each law of the joints, shape (laws,).

    Infinite where no run under a law exceeds the state, or every one does; NaN where none is decided.
    """
    assert evidence.laws is not None
    medians = []
    for law in np.unique(evidence.laws):
        mine = evidence.laws == law
        low, high, _ = intervals(evidence.only(mine), codes[mine], method)
        medians.append(float(fit(low, high).log_median[0]) if len(low) else np.nan)
    return np.array(medians)
