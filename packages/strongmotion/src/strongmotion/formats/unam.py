"""Mexico's standard acceleration file (ASA) of the UNAM network: channels as columns."""

from __future__ import annotations

import re

from stylobate.errors import InputError, within
from stylobate.motion.readers.numbers import read_numbers
from stylobate.motion.readers.record import CUT, Component, direction
from stylobate.motion.readers.source import Source
from stylobate.motion.specs import acceleration_unit

from .stated import check_count, check_length, check_peak, check_step, oriented
from .volume1 import is_numeric, keyed


def recognises(source: Source) -> bool:
    """Whether the head names the standard file."""
    return "archivo estandar de aceleracion" in source.head.replace("á", "a").replace("ó", "o")


def read(source: Source) -> tuple[list[Component], dict]:
    """All channels and what the header says."""
    lines, file = source.lines, source.name
    header = keyed(lines[:160])
    labels = [_label(text, file) for text in _list(header, "orientacion c1-c6", file)]
    unit, size = _unit(header, file)
    steps = [
        _number(text, "INTERVALO DE MUESTREO", file) for text in _list(header, "intervalo de muestreo, c1-c6", file)
    ]
    counts = [
        _number(text, "NUM. TOTAL DE MUESTRAS", file) for text in _list(header, "num. total de muestras, c1-c6", file)
    ]
    channels = min(len(labels), len(steps), len(counts))
    if channels == 0:
        raise InputError(f"{file}: the header describes no channel (ORIENTACION C1-C6); fetch the file again.")
    at = header_line(header, "intervalo de muestreo")
    steps = [check_step(step, file, at) for step in steps]
    last = max(line for _, line in header.values())
    start = next(
        (
            i
            for i in range(last, min(last + 60, len(lines)))
            if is_numeric(lines[i]) and len(lines[i].split()) >= channels
        ),
        None,
    )
    if start is None:
        raise InputError(f"{file}, below line {last}: expected rows of {channels} accelerations; fetch the file again.")
    _check_heading(lines[start - 1].split(), labels[:channels], file, start)
    count = check_count(max(counts[:channels]), file, header_line(header, "num. total de muestras"))
    table = read_numbers(
        lines[start:], start, file, f"rows of {channels} accelerations", count=channels * count
    ).reshape(-1, channels)
    lengths = _channels(header, "duracion del registro")
    for count_of, step, length in zip(counts, steps, lengths):
        check_length(int(count_of), step, length, file, header_line(header, "duracion del registro"))
    components = []
    for i in range(channels):
        samples = table[: check_count(counts[i], file, header_line(header, "num. total de muestras")), i]
        components.append(oriented(Component(samples * size, steps[i], labels[i])))
    key = next((key for key in header if re.match(r"acel\.? *max\.? *\( *gal", key)), "")
    for component, peak in zip(components, _channels(header, key) if key else []):
        check_peak(component.values, peak, 0.01, file, header[key][1], wrong=0.1)  # may be of another base line
    text = {key: value for key, (value, _) in header.items()}
    return components, {
        "format": "UNAM ASA",
        "stage": "not stated",
        "unit": unit,
        "station": text.get("clave de la estacion") or None,
        "station_name": text.get("nombre de la estacion") or None,
        "network": "UNAM",
        "event": text.get("fecha del sismo [gmt]") or None,
        "start_time": text.get("hora de la primera muestra (gmt)") or None,
    }


def _label(orientation: str, file: str) -> str:
    """Direction of a channel out of ``S00E;+L``, ``+V`` or ``V;-``: bearing, and sense and axis of the sensor."""
    bearing, _, sensor = (part.strip() for part in orientation.partition(";"))
    if sensor != "-":
        return bearing.strip(" +")
    if not direction(bearing)[1]:
        raise InputError(
            f"{file}: ORIENTACION holds {orientation!r}, and whether the bearing counts the sign is not known; allowed is a "
            "sign without an axis of a vertical channel only: convert the file to columns."
        )
    return f"{bearing};-"


def _unit(header: dict[str, tuple[str, int]], file: str) -> tuple[str, float]:
    """Unit of the samples, and its size in m/s²: gal, where the header states none."""
    value, line = next((entry for key, entry in header.items() if key.startswith("unidades de los datos")), ("", 0))
    words = re.findall(r"[^\s,;()\[\]]+", value.lower().replace("gales", "gal").replace("seg", "s")) or ["gal"]
    with within(f"{file}, line {line}"):
        units = [acceleration_unit(word) for word in words]
    if len({size for _, size in units}) > 1:
        raise InputError(f"{file}, line {line}: the header states the units {value!r}, of which one is right; {CUT}.")
    return units[0]


def _check_heading(words: list[str], labels: list[str], file: str, line: int) -> None:
    """Directions above the columns are those of ORIENTACION, in its order."""
    pairs = [(direction(word)[:2], direction(label)[:2]) for word, label in zip(words, labels)]
    if len(words) == len(labels) and any(
        first != other and (None, False) not in (first, other) for first, other in pairs
    ):
        raise InputError(
            f"{file}, line {line}: the columns are named {' '.join(words)}, ORIENTACION C1-C6 states {' '.join(labels)}; "
            f"{CUT}."
        )


def header_line(header: dict[str, tuple[str, int]], key: str) -> int:
    """Line of the first key that begins so."""
    return next((line for name, (_, line) in header.items() if name.startswith(key)), 0)


def _channels(header: dict[str, tuple[str, int]], key: str) -> list[str]:
    """Values of the channels where they are stated."""
    value, _ = next((entry for name, entry in header.items() if name.startswith(key)), ("", 0))
    return [part.strip() for part in value.split("/") if part.strip()]


def _list(header: dict[str, tuple[str, int]], key: str, file: str) -> list[str]:
    """Values of the channels, between slashes."""
    parts = _channels(header, key)
    if not parts:
        line = header_line(header, key)
        raise InputError(
            f"{file}, line {line}: expected the channels' values of {key.upper()!r}; fetch the file again."
        )
    return parts


def _number(text: str, key: str, file: str) -> float:
    if not re.fullmatch(r"(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", text):
        raise InputError(f"{file}: {key} holds {text!r}, where a number is expected; fetch the file again.")
    return float(text)
