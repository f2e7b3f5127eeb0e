"""``stylobate fetch``: the accelerograms of an earthquake from a data centre."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from stylobate.cli import options as o
from stylobate.errors import InputError

if TYPE_CHECKING:
    import pandas

    from stylobate.motion.earthquakes import Earthquake

    from ..data_centres import StationRecord


def fetch(
    earthquake: str = o.argument("EARTHQUAKE", "Its number in the catalogue of the data centre, or a QuakeML file."),
    service: str = o.option("CENTRE", "Data centre (FDSN): a name such as INGV, or the address of its services.", ...),
    events: str | None = o.option("CENTRE", "Data centre whose catalogue has the number, if another."),
    within: str = o.option("KM", "Largest distance from the epicentre.", "50km"),
    stations: list[str] | None = o.option("NET.STA", "Only this station; may be repeated."),
    channels: str = o.option("CODES", "SEED codes of accelerometers; the first that a station has.", "HN?,EN?,HL?,HG?"),
    before: str = o.option("TIME", "Begin before the time of origin.", "10s"),
    lasts: str = o.option("TIME", "Length of the records.", "120s"),
    *,
    execution: o.Plain,
) -> None:
    """Accelerograms of an earthquake from a data centre (needs the extra seismology).

    Without --out, says which stations it has. With --out, writes for each a miniSEED and its StationXML, which all commands
    read as --motion, the QuakeML, and about.csv for --about of records and ida. What has gaps or is no acceleration is left
    out and said.
    """
    from stylobate.cli import console
    from stylobate.motion.earthquakes import read_earthquake
    from stylobate.motion.specs import parse_time

    from ..data_centres import DataCentre

    far, length = _kilometres(within), parse_time(lasts, "lasts")
    early, codes = parse_time(before, "before"), [code.strip() for code in channels.split(",")]
    if not 0.0 <= early < length <= 3600.0:
        raise InputError(
            f"`before` is {before} and `lasts` {lasts}; allowed are 0s <= before < lasts <= 3600s, such as 10s and 120s.",
            "lasts",
        )
    if bad := [code for code in codes if len(code) != 3 or not code.isascii()]:
        raise InputError(
            f"`channels` has {bad[0]!r}; write SEED codes of three characters, such as HN?,HG?.", "channels"
        )
    centre = DataCentre(service)
    if Path(earthquake).is_file():
        event, quakeml = read_earthquake(earthquake), Path(earthquake).read_bytes()
    elif Path(earthquake).suffix.lower() in (".xml", ".quakeml"):
        raise InputError(f"there is no file {earthquake}; check its name and folder.", "earthquake")
    else:
        catalogue = centre if events is None else DataCentre(events)
        event, quakeml = catalogue.earthquake(earthquake)
    near = centre.stations(event, far, stations or (), codes)
    rows = [{"station": name, "distance_km": round(distance, 2)} for name, distance in near]
    summary: dict[str, Any] = {
        "earthquake": event._asdict(),
        "service": service,
        "stations": rows,
        "refused": {},
        "files": [],
    }
    with execution.files("fetch", "fetch.json", "about.csv", "earthquake.xml") as files:
        if files.wanted and near:
            if files.folder is not None and (there := sorted(files.folder.glob("*.mseed"))):
                raise InputError(
                    f"{files.folder} holds {there[0].name} of an earlier request, which would be read with these; choose "
                    "another folder for `out`.",
                    "out",
                )
            records: list[StationRecord] = []
            with console.progress("stations") as progress:
                for number, (name, distance) in enumerate(near, 1):
                    try:
                        records.append(centre.record(event, name, distance, early, length, codes))
                    except InputError as error:
                        summary["refused"][name] = str(error)
                    progress(number, len(near))
            if not records:
                why = next(iter(summary["refused"].values()))
                raise InputError(
                    f"none of {len(near)} stations has an accelerogram that can be read; the nearest: {why}"
                )
            for record in records:
                files.data(record.counts, f"{record.name}.mseed")
                files.data(record.description, f"{record.name}.xml")
            files.data(quakeml, "earthquake.xml")
            files.table(_about(event, records), "about.csv")
            files.summary(summary, "fetch.json")
    if execution.emits(summary):
        return
    print(f"{event.words}: {len(near)} stations of {service} within {far:g} km of the epicentre.")
    for row in rows:
        print(f"  {row['station']:<10} {row['distance_km']:7.1f} km")
    console.print_refused(summary["refused"])
    console.print_files(files)


def _about(event: Earthquake, records: list[StationRecord]) -> pandas.DataFrame:
    """The table that ``--about`` takes."""
    import pandas

    return pandas.DataFrame(
        {
            "record": [f"{record.name}.mseed" for record in records],
            "magnitude": event.magnitude,
            "distance_km": [round(record.distance_km, 2) for record in records],
        }
    )


def _kilometres(text: str) -> float:
    from stylobate.motion.specs import parse_number

    return parse_number("`within`", text.strip().removesuffix("km").strip())
