"""Tables of runs as other programs write them: the curve is that of a fit of its own, or one sentence says why none is."""

from __future__ import annotations

import math
import random
from pathlib import Path
from typing import NamedTuple
from unittest.mock import patch

import numpy as np
from scipy.optimize import minimize
from scipy.special import log_ndtr
from scipy.stats import t

from stylobate.errors import InputError
from stylobate.probability import fragility as fragility_points
from stylobate.probability.evidence import evidence, read_table
from stylobate.probability.fragility import fragility

from .command import command
from .target import Fault, Target, sentence

#: Names that a spreadsheet, a delimiter or a comment could spoil; each record has one of its own.
NAMES = (
    "r{}",
    "0{}",
    "{}",
    "{}.0",
    "#{}",
    "a#{}",
    "Ναός {}",
    "RSN{} H1",
    "nan{}",
    "x, {}",
    'gun 12" {}',
    "{}e3",
    "-{}",
    "NA {}",
)

#: What stands for a run that exceeds, for one that does not, and for one that is undecided.
WORDS = (("1", "0", ""), ("1.0", "0.0", ""), ("true", "false", ""), ("TRUE", "False", "NaN"), ("1", "0", "nan"))

#: Texts that are no intensity, and no end of a run.
NO_NUMBERS = (
    "",
    "nan",
    "inf",
    "-inf",
    "-0.3",
    "0,45",
    "1,234.5",
    "1.234,5",
    "0.5 g",
    "1_000",
    "0x1",
    "--",
    "1e999",
    "half",
)
NO_ENDS = ("2", "yes", "collapse", "0.5", "-1", "x", "10")


class Run(NamedTuple):
    """A run that was written: its record, its intensity, and whether it exceeds (1), does not (0) or is undecided (−1)."""

    record: str
    im: float
    code: int


def runs_of(rng: random.Random) -> list[Run]:
    """Runs by one of the designs that people have, good ones and hopeless ones."""
    number = rng.choice((1, 5, 9, *[rng.randint(10, 14)] * 12))
    name = rng.choice(NAMES)
    names = [name.format(k + 1) for k in range(number)]
    kind = rng.choice(
        ("good",) * 6 + ("narrow",) * 3 + ("cloud", "cloud", "reversed", "same", "chance", "one level", "undecided")
    )
    beta = {"narrow": rng.choice((0.0, 0.03, 0.1)), "same": 0.0}.get(kind, rng.uniform(0.2, 0.7))
    levels = [float(f"{x:.3g}") for x in np.geomspace(0.11, rng.uniform(0.6, 4.0), rng.randint(2, 8))]
    middle = rng.uniform(math.log(levels[0]), math.log(levels[-1]))
    if kind == "same":
        middle = rng.choice((-9.0, 9.0))
    if kind == "one level":
        levels = levels[:1]
    runs = []
    for record in names:
        capacity = rng.gauss(middle, beta)
        for im in [float(f"{math.exp(rng.gauss(middle, 0.6)):.4g}")] if kind == "cloud" else levels:
            code = int(math.log(im) >= capacity)
            code = 1 - code if kind == "reversed" else rng.randint(0, 1) if kind in ("chance", "one level") else code
            runs.append(Run(record, im, -1 if kind == "undecided" or rng.random() < 0.02 else code))
    return runs


def write(rng: random.Random, path: Path, runs: list[Run]) -> bool:
    """Write them in one of the dialects; says whether the table is damaged, so that it must be refused."""
    words = rng.choice(WORDS)
    header, rows = (
        ["record", "im", "collapsed"],
        [[run.record, f"{run.im!r}", words[(1, 0, 2)[run.code]]] for run in runs],
    )
    for _ in range(rng.choice((0, 0, 1, 3))):
        at = rng.randint(0, len(header))
        header.insert(at, f"extra {len(header)}")
        for row in rows:
            row.insert(at, rng.choice(("", "0.3", "x", "a, b")))
    order = sorted(range(len(header)), key=lambda _: rng.random()) if rng.random() < 0.3 else list(range(len(header)))
    header, rows = [header[k] for k in order], [[row[k] for k in order] for row in rows]
    im, end, who = (header.index(column) for column in ("im", "collapsed", "record"))
    delimiter = rng.choice(",,,;\t")
    damage, unlucky = rng.choice((None,) * 18 + tuple(range(12))), rng.choice(rows)
    damaged = damage is not None
    if damage == 0:
        unlucky[im] = rng.choice(NO_NUMBERS)
    elif damage == 1:
        unlucky[end] = rng.choice(NO_ENDS)
    elif damage == 2:
        unlucky[who] = ""
    elif damage == 3:
        header.insert(0, rng.choice(header))
        rows = [[row[0], *row] for row in rows]
    elif damage == 4:
        header[rng.choice((im, end, who))] = "something"
    cells = [[quoted(rng, cell, delimiter) for cell in row] for row in rows]
    if damage in (5, 6):  # decimal commas, of the whole table
        for row in cells:
            row[im] = row[im].strip('"').replace(".", ",")
    if damage == 6:  # as many fields as the header names, if columns are separated by commas
        header.append("note")
    if damage in (7, 8):
        unlucky = rng.choice(cells)
        if damage == 7:
            unlucky.insert(rng.randint(0, len(unlucky)), rng.choice(("", "0", "1", "#")))
        else:
            del unlucky[rng.randrange(len(unlucky))]
    case = rng.choice((str, str, str.upper, str.title))
    lines = [delimiter.join(quoted(rng, case(column), delimiter) for column in header), *map(delimiter.join, cells)]
    if damage == 9:
        k = rng.randrange(1, len(lines))
        lines[k] = '"' + lines[k].replace('"', "")
    for _ in range(rng.choice((0, 0, 2))):
        lines.insert(rng.randint(0, len(lines)), rng.choice(("", "  ")))
    lines[:0] = rng.choice(([], [], ["# of another program, 2,5"]))
    data = (rng.choice(("\n", "\r\n", "\r")).join(lines) + rng.choice(("", "\n"))).encode("utf-8")
    if damage == 10:
        data = "\n".join(lines).encode("utf-16")
    elif damage == 11:
        data = data[: len(data) // 2] + b"\xe9\xff" + data[len(data) // 2 :]
    path.write_bytes(rng.choice((b"", b"", b"\xef\xbb\xbf")) + data)
    return damaged


def quoted(rng: random.Random, text: str, delimiter: str) -> str:
    """A cell, in quotation marks where it must be or may be."""
    must = delimiter in text or '"' in text
    return '"' + text.replace('"', '""') + '"' if must or rng.random() < 0.05 else rng.choice(("", "", " ")) + text


def log_likelihood(runs: list[Run], log_median: float, log_beta: float) -> float:
    """Of the decided runs, Eq. (G1)."""
    z = np.array([(math.log(run.im) - log_median) * math.exp(-log_beta) for run in runs])
    return float(log_ndtr(np.where([run.code == 1 for run in runs], z, -z)).sum())


def check(runs: list[Run], answer: dict) -> str:
    """Whether an answer is right, by a fit of its own."""
    decided = [run for run in runs if run.code >= 0]
    hit, missed = ([math.log(run.im) for run in decided if run.code == code] for code in (1, 0))
    if len({run.record for run in decided}) < 10 or not hit or not missed or len({run.im for run in decided}) == 1:
        raise Fault(f"a curve where there is none: {answer}")
    if np.mean(hit) <= np.mean(missed) - 1e-9:
        raise Fault(f"a curve of runs that do not rise: {answer}")
    if (answer["runs"], answer["exceeded"]) != (len(runs), len(hit)) or answer["undecided"] != len(runs) - len(decided):
        raise Fault(f"other runs than were written: {answer}")
    low, high = answer["median_low"], math.inf if answer["median_high"] is None else answer["median_high"]
    if not low <= answer["median"] <= high or low == high:
        raise Fault(f"no interval about the median: {answer}")
    if max(missed) <= min(hit):
        bracket = math.exp(max(missed)), math.exp(min(hit))
        if not np.allclose(answer["bracket"], bracket) or answer["beta"] is not None or answer["beta_low"] > 0.0:
            raise Fault(f"more than the bracket {bracket} that is known: {answer}")
        if low > bracket[0] * (1 + 1e-9) or high < bracket[1] * (1 - 1e-9):
            raise Fault(f"narrower than the bracket {bracket}: {answer}")
        return "bracket"
    starts = [(np.mean(hit + missed), log_beta) for log_beta in (-2.0, -0.7, 0.7)]
    best = min(
        (
            minimize(lambda x: -log_likelihood(decided, *x), start, method="Nelder-Mead", options={"fatol": 1e-10})
            for start in starts
        ),
        key=lambda fit: fit.fun,
    )
    if abs(math.log(answer["median"]) - best.x[0]) > 1e-3 or abs(math.log(answer["beta"]) - best.x[1]) > 1e-3:
        raise Fault(f"another curve than {np.exp(best.x)}: {answer}")
    n = len({run.record for run in decided})
    drop = 0.5 * n * math.log1p(t.ppf(0.975, n - 1) ** 2 / (n - 1))
    for limit in (low, high):
        if 0.0 < limit < math.inf:
            top = max(log_likelihood(decided, math.log(limit), log_beta) for log_beta in np.linspace(-4.6, 6.9, 300))
            if top > -best.fun - drop:
                raise Fault(f"the limit {limit} is narrower than the likelihood: {answer}")
    return "curve"


def one_table(rng: random.Random, folder: Path) -> str:
    """One table."""
    runs, path = runs_of(rng), folder / "runs.csv"
    damaged = write(rng, path, runs)
    try:
        with patch.object(fragility_points, "SETS", 5):
            summary = fragility(evidence(read_table(path)), samples=40).summary()
    except InputError as error:
        text = sentence(error)
        if "np." in text or "Traceback" in text:
            raise Fault(f"no sentence for people: {text}") from error
        if (
            not damaged
            and "fragility" not in text
            and "curve" not in text
            and "decided" not in text
            and "known" not in text
        ):
            raise Fault(f"a sound table is refused: {text}") from error
        if rng.random() < 0.05 and command(["fragility", str(path)]).code != 2:
            raise Fault(f"the command draws what is refused: {text}") from error
        return "damaged, refused" if damaged else "no curve, refused"
    if damaged:
        raise Fault(f"a damaged table has a curve: {path.read_bytes()[:400]!r}, {summary}")
    if rng.random() < 0.05:
        command(["fragility", str(path), "--json"])
    summary = {key: None if isinstance(value, float) and math.isinf(value) else value for key, value in summary.items()}
    return check(runs, summary)


TARGET = Target("fragility_tables", 6_000, 25, one_table)
