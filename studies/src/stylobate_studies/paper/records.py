"""Records of the study: nine from a folder beside the project, or those of the samples that come with the package."""

from __future__ import annotations

from pathlib import Path

from stylobate.errors import InputError
from stylobate.motion import Motion
from stylobate.motion.conditioning import trim
from stylobate.motion.readers import read_motion, sample_motion

#: Files of the nine records, as their networks published them, by what the tables call them.
FILES = {
    "Northridge 1994, 116th St": "csmip_v1_Northridge1994_LA116thSt.RAW",
    "Ridgecrest 2019, China Lake": "csmip_v1_Ridgecrest2019_ChinaLake_CLC.v1",
    "Coalinga 1983, Parkfield FZ14": "csmip_v2_Coalinga1983_ParkfieldFZ14.V2",
    "Kaikoura 2016, Hanmer Springs": "geonet_v1a_Kaikoura2016_HSES.V1A",
    "South Napa 2014, 58667": "csmip_v2_SouthNapa2014_CE58667.V2",
    "El Centro 1940": "twocol_ElCentro1940_NS.dat",
    "Loma Prieta 1989, Shafter": "smc_v2_LomaPrieta1989_1295Shafter_360.smc",
    "Loma Prieta 1989, Del Valle Dam": "smc_v1_LomaPrieta1989_DelValleDam_065.smc",
    "Waipukurau 2018": "geonet_v2a_Waipukurau2018_WPWS.V2A",
}

#: Samples that are among them, by the same names.
SAMPLES = {
    "Kaikoura 2016, Hanmer Springs": "hanmer-springs-2016",
    "El Centro 1940": "el-centro-1940",
    "Loma Prieta 1989, Shafter": "san-francisco-1989",
    "Loma Prieta 1989, Del Valle Dam": "del-valle-dam-1989",
    "Waipukurau 2018": "waipukurau-2018",
}

#: What is kept of a record: between these shares of its squared acceleration, and so long before and after [s].
KEPT, BEFORE, AFTER = (0.01, 0.95), 2.0, 3.0


def read_records(folder: Path | None) -> list[Motion]:
    """The nine records of a folder, or the samples without one, cut to their shaking.

    Raises
    ------
    InputError
        The folder is none, or a file is not in it.
    """
    if folder is None:
        records = {name: sample_motion(sample) for name, sample in SAMPLES.items()}
    else:
        if not folder.is_dir():
            raise InputError(f"{folder} is no folder; give one with the nine records, or leave it out for the samples.")
        missing = [file for file in FILES.values() if not (folder / file).is_file()]
        if missing:
            raise InputError(
                f"{folder} lacks {len(missing)} of the {len(FILES)} records, {missing[0]} among them; give a folder that "
                "has all, or leave it out for the samples."
            )
        units = {"El Centro 1940": "g"}
        records = {name: read_motion(folder / file, unit=units.get(name)) for name, file in FILES.items()}
    return [
        trim(record.replace(name=name), *KEPT, before=BEFORE, after=AFTER).replace(name=name)
        for name, record in records.items()
    ]
