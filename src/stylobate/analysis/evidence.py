"""What runs tell about a limit state: the table of a suite, a study or an IDA, or anybody's CSV, as one value."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import InputError
from ..motion.intensity_specs import IntensityMeasure, parse_measure
from ..reading import check_file, shown
from .limit_states import EXCEEDED, FAILED, NOT_EXCEEDED, OPEN, LimitState, parse_state

if TYPE_CHECKING:
    import pandas

#: Tables of runs that a folder may hold, the first that is there.
TABLES = ("runs.csv", "runs.parquet", "study.csv", "study.parquet", "suite.csv")

#: Other names that tables have for a measure, by its key.
ALSO = {
    "pga_g": ("amplitude_g",),
    "d5_95_s": ("duration_5_95_s",),
    "d5_75_s": ("duration_5_75_s",),
    **{f"sa_{t}s_g": (f"psa_{t}s_g",) for t in ("0.1", "0.2", "0.5", "1", "2", "4")},
}

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
        Exceeded, not exceeded, open or failed, as of :mod:`~stylobate.analysis.limit_states`.
    measure : str
        The intensity measure, as typed; ``im`` where a table does not say.
    unit : str
    state : str
    name : str
        What the runs are of, for a legend.
    brackets : bool
        Levels were chosen to bracket the capacity under each record (an IDA).
    """

    records: np.ndarray
    im: np.ndarray
    codes: np.ndarray
    measure: str
    unit: str
    state: str
    name: str
    brackets: bool = False

    def count(self, code: int) -> int:
        """Number of runs that say so."""
        return int(np.count_nonzero(self.codes == code))


def read_table(source: str | Path) -> pandas.DataFrame:
    """The table of runs of a folder or a file (CSV, Parquet).

    Raises
    ------
    InputError
        There is none, or it has no column ``record``.
    """
    import pandas

    place = Path(source)
    if place.is_dir():
        found = [place / one for one in TABLES if (place / one).is_file()]
        if not found:
            raise InputError(
                f"{shown(place)} holds no table of runs ({', '.join(TABLES)}); give the folder of a study, an IDA or a "
                "suite, or a CSV file with the columns record, im, collapsed."
            )
        place = found[0]
    check_file(place, MOST)
    try:
        if place.suffix == ".parquet":
            table = pandas.read_parquet(place)
        else:
            with place.open("rb") as file:  # comments stand above the table; a name below may hold the same mark
                above = next((k for k, line in enumerate(file) if not line.lstrip().startswith(b"#")), 0)
            table = pandas.read_csv(place, skiprows=above, skipinitialspace=True)
    except (ValueError, OSError, ImportError, pandas.errors.ParserError) as error:
        raise InputError(f"{shown(place)} is no table that can be read ({str(error).splitlines()[0]}).") from None
    if "record" not in table or not len(table):
        raise InputError(
            f"{shown(place)} has no runs with a column 'record'; it needs the columns record, im, collapsed."
        )
    return table


def evidence(
    table: pandas.DataFrame,
    measure: IntensityMeasure | str | None = None,
    state: LimitState | str = "collapse",
    name: str = "runs",
    unit: str = "-",
) -> Evidence:
    """What a table of runs tells about a state.

    Parameters
    ----------
    table : pandas.DataFrame
        From :func:`read_table`: one row per run.
    measure : IntensityMeasure or str, optional
        Looked for among the columns, such as ``pgv``; the column called ``im`` by default.
    state : LimitState or str
        Such as ``collapse`` or ``top:0.35d``.
    name : str
    unit : str
        Of the column ``im`` where no measure is given.

    Raises
    ------
    InputError
        The measure or the state is not in the table, or a value makes no sense.
    """
    measure = parse_measure(measure) if isinstance(measure, str) else measure
    state = parse_state(state) if isinstance(state, str) else state
    key = "im" if measure is None else next(
        (one for one in (measure.key, *ALSO.get(measure.key, ())) if one in table), "im"
    )  # fmt: skip
    said = scaled_to(table)
    if key not in table or (key == "im" and measure is not None and said not in (None, measure.name)):
        raise InputError(
            f"the runs of {name} have no intensity {measure.name if measure else 'im'!r}; "
            f"columns are {', '.join(map(str, list(table.columns)[:40]))}."
        )
    import pandas

    numbers: Any = pandas.to_numeric(table[key], errors="coerce")
    im = np.asarray(numbers, dtype=float)
    bad = np.flatnonzero(~(np.isfinite(im) & (im >= 0.0)))
    if bad.size:
        raise InputError(
            f"the intensity {key!r} of run {bad[0] + 1} of {name} is {table[key].iloc[bad[0]]!r}; allowed is a number from "
            "0."
        )
    if "outcome" in table or "verdict" in table:
        rows = table.astype(object).where(table.notna(), None).to_dict("records")
        codes = np.array([state.of(row) for row in rows], dtype=np.int8)
    else:
        codes = _plain_codes(table, state, name)
    zero = im == 0.0  # of no intensity: nothing is exceeded, and the logarithm does not exist
    return Evidence(
        np.array([str(one) for one in table["record"]], dtype=object)[~zero],
        im[~zero],
        codes[~zero],
        "im" if measure is None else measure.name,
        unit if measure is None else measure.unit,
        state.name,
        name,
        "hunted" in table and bool(table["hunted"].iloc[0]),
    )


def scaled_to(table: pandas.DataFrame) -> str | None:
    """The intensity measure that the runs of a study or an IDA were scaled to; None where a table does not say."""
    for key in ("im_name", "measure"):
        if key in table:
            return str(table[key].iloc[0])
    return None


def _plain_codes(table: pandas.DataFrame, state: LimitState, name: str) -> np.ndarray:
    if state.what or "collapsed" not in table:
        raise InputError(f"the runs of {name} say only {', '.join(map(str, table.columns))}; {state.name} needs more.")
    words = {"1": EXCEEDED, "0": NOT_EXCEEDED, "1.0": EXCEEDED, "0.0": NOT_EXCEEDED, "true": EXCEEDED,
             "false": NOT_EXCEEDED, "": OPEN, "failed": FAILED}  # fmt: skip
    values, missing = table["collapsed"].tolist(), table["collapsed"].isna().tolist()
    texts = ["" if gone else str(one).strip().lower() for one, gone in zip(values, missing)]
    strange = [one for one in texts if one not in words]
    if strange:
        raise InputError(f"'collapsed' of {name} is {strange[0]!r}; allowed is 0, 1, or nothing where it is undecided.")
    return np.array([words[one] for one in texts], dtype=np.int8)
