"""The catalogue of columns by name: the founding paper's two, and columns of the world with what is published on them.

Each figure is read in a source or assumed here, and says so. Nothing else knows a preset.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from ..bibliography import bibliography
from ..errors import InputError, suggest
from .column import Column
from .drum import Drum
from .joint import Joint
from .materials import material

#: Of every joint of the catalogue. Baraldi et al., section 3, print the stiffnesses for theirs; for all
#: others, and the friction coefficient of all, this is an assumption of this package.
JOINT = Joint(normal_stiffness=5.0e10, shear_stiffness=2.5e10, friction_coefficient=0.70)

FOOT = 0.3048


@dataclass(frozen=True)
class Figure:
    """A figure of a column, measured (read in a source) or assumed here.

    Parameters
    ----------
    value : float
    unit : str
        ``m``, ``kg/m³``, or ``-`` for a number of drums.
    source : str, optional
        Key in the bibliography; None where it is assumed here.
    words : str
        What the source says, or why this is assumed.
    """

    value: float
    unit: str
    source: str | None
    words: str

    @property
    def measured(self) -> bool:
        """Whether a source states it."""
        return self.source is not None

    @property
    def text(self) -> str:
        """The figure with its source, or the word assumed, in one line."""
        unit = "" if self.unit == "-" else f" {self.unit}"
        who = "assumed" if self.source is None else f"measured, {bibliography()[self.source].cited}"
        return f"{self.value:.4g}{unit} ({who}): {self.words}"

    def to_dict(self) -> dict[str, Any]:
        """Under the names of the JSON object of ``stylobate columns``."""
        return asdict(self) | {"measured": self.measured}


@dataclass(frozen=True)
class KnownColumn:
    """A column of the catalogue, as it would stand free: drums of equal height in a straight taper, without entasis.

    Parameters
    ----------
    name : str
        Of the preset.
    title : str
        What and where it is.
    height : Figure
        All that stands [m], with base and capital.
    bottom_width, top_width : Figure
        Of the shaft [m]; diameters of a round one.
    drums : Figure
        Number of drums in the shaft.
    density : Figure
        [kg/m³]
    base, capital : Figure, optional
        Their heights [m]; computed as cylinders as wide as the end of the shaft that they lie at. None where the source
        gives the height of the whole column alone: then the taper goes through all of it.
    section : {"circular", "rectangular"}
    """

    name: str
    title: str
    height: Figure
    bottom_width: Figure
    top_width: Figure
    drums: Figure
    density: Figure
    base: Figure | None = None
    capital: Figure | None = None
    section: str = "circular"

    @property
    def figures(self) -> dict[str, Figure]:
        """What is known of it, by name."""
        names = ("height", "bottom_width", "top_width", "drums", "density", "base", "capital")
        return {name: figure for name in names if (figure := getattr(self, name)) is not None}

    @property
    def sources(self) -> list[str]:
        """Keys in the bibliography of all figures, each once."""
        return list(dict.fromkeys(figure.source for figure in self.figures.values() if figure.source is not None))

    @property
    def shaft(self) -> float:
        """Height of the shaft [m]."""
        return self.height.value - sum(figure.value for figure in (self.base, self.capital) if figure is not None)

    @cached_property
    def column(self) -> Column:
        """The column that is computed."""
        shaft = Column.tapered(
            height=self.shaft, bottom_width=self.bottom_width.value, top_width=self.top_width.value,
            drums=int(self.drums.value), density=self.density.value, joint=JOINT, section=self.section, name=self.name,
        )  # fmt: skip

        def ends(part: Figure | None, width: Figure) -> list[Drum]:
            return (
                [] if part is None else [Drum(part.value, width.value, width.value, self.density.value, self.section)]
            )

        drums = [*ends(self.base, self.bottom_width), *shaft.drums, *ends(self.capital, self.top_width)]
        return Column.of_drums(drums, JOINT, name=self.name)

    def to_dict(self) -> dict[str, Any]:
        """Under the names of the JSON object of ``stylobate columns``."""
        known = self.figures
        return {
            "name": self.name,
            "title": self.title,
            "figures": {name: figure.to_dict() for name, figure in known.items()},
            "measured": [name for name, figure in known.items() if figure.measured],
            "assumed": [name for name, figure in known.items() if not figure.measured],
            "sources": [bibliography()[key].text for key in self.sources],
        }


def _read(value: float, source: str, words: str, unit: str = "m") -> Figure:
    return Figure(round(value, 4), unit, source, words)


def _assumed(value: float, words: str, unit: str = "m") -> Figure:
    return Figure(round(value, 4), unit, None, words)


def _doric_top(bottom: float) -> Figure:
    """The upper diameter of a Doric column of which none was read."""
    return _assumed(
        0.78 * bottom, "0.78 of the lower one, as those of Segesta, Sounion and the Propylaea (0.76 to 0.80)"
    )


def _roman_top(bottom: float) -> Figure:
    """The upper diameter of a Corinthian column of which none was read."""
    return _assumed(0.886 * bottom, "0.886 of the lower one, as that of Pompey's Pillar")


def _equal(height: float, bottom: float) -> Figure:
    """The number of drums of a column of which none was read."""
    words = "none was read; drums about half a lower diameter high (the paper's 0.43, those of the Olympieion 0.85)"
    return _assumed(round(2.0 * height / bottom), words, "-")


def _of_stone(stone: str, words: str) -> Figure:
    return _assumed(material(stone).density.value, f"that of {stone} in `stylobate materials`; {words}", "kg/m³")


def _one_piece(source: str) -> Figure:
    return _read(1, source, "the shaft is a monolith", "-")


def _paper(name: str, drums: int, title: str) -> KnownColumn:
    stated = "section 3; the width of a rectangular column 1 m deep"
    return KnownColumn(
        name, title, _read(5.0, "baraldi", "section 3"),
        _read(0.96, "baraldi", stated),
        _read(0.66, "baraldi", stated),
        _read(drums, "baraldi", "section 3", "-"),
        _read(1600.0, "baraldi", "section 3", "kg/m³"), section="rectangular",
    )  # fmt: skip


_WITH_CAPITAL = "of the whole column; the capital is taken as part of the taper"

_COLUMNS = (
    _paper("paper-monolithic", 1, "The founding paper's column in one piece"),
    _paper("paper-12-drums", 12, "The founding paper's column in twelve drums"),
    KnownColumn(
        "parthenon", "Parthenon, Athens, outer columns (Doric)",
        _read(10.43, "lvsparthenon", f"10.43 m, {_WITH_CAPITAL}"),
        _read(1.9, "lvsparthenon", "about 1.9 m at the base"),
        _doric_top(1.9), _equal(10.43, 1.9), _of_stone("marble", "marble of Pentelicon"),
    ),
    KnownColumn(
        "propylaea", "Propylaea, Athens, western portico (Doric)",
        _read(8.81, "dooge1908", f"8.81 m, {_WITH_CAPITAL}"),
        _read(5.25 * FOOT, "penrose", "5¼ feet, nearly 29 feet being five and a half diameters; as quoted"),
        _read(3.97 * FOOT, "penrose", "3.97 feet between the fillets, of the angle columns; as quoted"),
        _equal(8.81, 1.6), _of_stone("marble", "marble of Pentelicon"),
    ),
    KnownColumn(
        "hephaisteion", "Temple of Hephaistos, Athens, outer columns (Doric)",
        _read(5.71, "perseushephaistos", f"5.71 m, {_WITH_CAPITAL}"),
        _read(1.02, "perseushephaistos", "1.02 m; 1.04 m at the corners"),
        _doric_top(1.02), _equal(5.71, 1.02), _of_stone("marble", "marble of Pentelicon"),
    ),
    KnownColumn(
        "olympieion", "Temple of Olympian Zeus, Athens (Corinthian)",
        _read(57.0 * FOOT, "knowltonolympieion", "57 feet, base and capital in the taper; others state 16.8 to 18.8 m"),
        _read(1.7, "balyolympieion", "about 1.7 m; the Godden collection states 6 ft 4 in (1.93 m)"),
        _roman_top(1.7), _read(12, "goddenslides", "twelve segments, counted on the fallen column", "-"),
        _of_stone("marble", "marble of Pentelicon"),
    ),
    KnownColumn(
        "sounion", "Temple of Poseidon, Sounion (Doric)",
        _read(6.10, "williams2021", f"6.10 m, {_WITH_CAPITAL}; another page states 6.02 m"),
        _read(1.0, "williams2021", "1 m at the base; another page states 1.04 m"),
        _read(0.79, "williams2021", "79 cm at the top"),
        _equal(6.1, 1.0), _of_stone("marble", "marble of Agrileza"),
    ),
    KnownColumn(
        "corinth", "Temple of Apollo, Corinth (Doric)",
        _read(23.667 * FOOT, "edinburghcorinth", "23 ft 8 in with the capital, and a fraction that cannot be read"),
        _read(67.0 / 12.0 * FOOT, "edinburghcorinth", "5 ft 7 in; a travel page states 1.8 m"),
        _doric_top(1.702), _one_piece("edinburghcorinth"), _of_stone("limestone", "poros"),
    ),
    KnownColumn(
        "segesta", "Temple of Segesta (Doric)",
        _read(9.36, "buehler2004", "9.36 m with the capital, which is taken as part of the taper"),
        _read(1.95, "buehler2004", "1.95 m at the base"), _read(1.56, "buehler2004", "1.56 m under the capital"),
        _equal(9.36, 1.95), _of_stone("limestone", "a limestone like travertine"),
    ),
    KnownColumn(
        "selinunte-g", "Temple G, Selinunte, fallen (Doric)",
        _read(49.0 * FOOT, "iconographic", "nearly 15 m (49 feet)"),
        _read(3.0, "iconographic", "3 m (10 feet) at the bottom"),
        _read(2.0, "iconographic", "about 2 m (nearly 7 feet) at the top"), _equal(14.935, 3.0),
        _of_stone("limestone", "no source was read on the stone"),
    ),
    KnownColumn(
        "paestum-neptune", "Temple called of Neptune, Paestum, outer columns (Doric)",
        _read(28.0 * FOOT, "baedekeritaly", "28 feet"), _read(7.0 * FOOT, "baedekeritaly", "7 feet"),
        _doric_top(2.134), _equal(8.534, 2.134), _of_stone("limestone", "a species of travertine"),
    ),
    KnownColumn(
        "pompeii-forum", "Portico of the Forum, Pompeii",
        _read(12.0 * FOOT, "dyerpompeii", "twelve feet"), _read(27.5 / 12.0 * FOOT, "dyerpompeii", "2 ft 3½ in"),
        _doric_top(0.699),
        _equal(3.658, 0.699),
        _of_stone("tuff", "older columns of the Forum are of tufa; taken for these"),
    ),
    KnownColumn(
        "baalbek-jupiter", "Temple of Jupiter, Baalbek (Corinthian)",
        _read(20.0, "buildingbaalbek", "20 m; others state 19 to 22 m"),
        _read(2.5, "buildingbaalbek", "2.5 m; others state 2 to 2.2 m"),
        _roman_top(2.5), _assumed(3, "three, as is often said; no source was read", "-"),
        _of_stone("limestone", "no source was read on the stone"),
    ),
    KnownColumn(
        "trajan", "Column of Trajan, Rome, taken as solid",
        _read(29.78, "museumislandtrajan", "29.78 m without the pedestal"),
        _read(3.695, "museumislandtrajan", "diameter of the shaft 3.695 m"),
        _assumed(3.555, "14 cm less than below, as that of Marcus Aurelius"),
        _read(17, "giuffre1996", "seventeen stones; 26.92 m over a mean drum of 1.521 m would be 17.7", "-"),
        _of_stone("marble", "marble of Carrara; the staircase inside is left out"),
        base=_read(1.70, "museumislandtrajan", "1.7 m"), capital=_read(1.16, "museumislandtrajan", "1.16 m"),
    ),
    KnownColumn(
        "marcus-aurelius", "Column of Marcus Aurelius, Rome, taken as solid",
        _read(29.77, "lacuscurtius", "100 Roman feet (29.77 m), shaft, torus and capital"),
        _read(3.90, "lacuscurtius", "3.90 m"),
        _read(3.76, "worldhistoryaurelius", "14 cm less than below"),
        _read(17, "giuffre1996", "seventeen stones; Lacus Curtius counts twenty-six rings in all", "-"),
        _of_stone("marble", "marble of Luni; the staircase inside is left out"),
        base=_assumed(1.754, "what the height leaves beside a shaft of 26.494 m and the capital"),
        capital=_read(1.522, "paulycentenaria", "1.522 m, measured by Calderini"),
    ),
    KnownColumn(
        "pompeys-pillar", "Pompey's Pillar, Alexandria, the shaft alone",
        _read(20.46, "grailpompey", "20.46 m; pedestal, base and capital are left out"),
        _read(2.71, "grailpompey", "2.71 m at the base"),
        _read(2.4, "egypttours", "tapers from 2.7 to 2.4 m"), _one_piece("grailpompey"),
        _of_stone("granite", "granite of Aswan"),
    ),
    KnownColumn(
        "pantheon", "Portico of the Pantheon, Rome, a shaft alone",
        _read(39.0 * FOOT, "encirclepantheon", "39 feet; base and capital are left out"),
        _read(5.0 * FOOT, "encirclepantheon", "five feet wide"),
        _roman_top(1.524), _one_piece("romechurches"), _of_stone("granite", "granite of Egypt"),
    ),
)  # fmt: skip

#: All columns by the names of their presets, the paper's first.
CATALOGUE = {column.name: column for column in _COLUMNS}


# Presets: the columns of the catalogue by name.

#: Young's modulus of the blocks in the paper [Pa]; see ``DistinctElement2D(block_modulus=…)``.
PAPER_BLOCK_MODULUS = 2.5e9

#: The paper's two columns (Baraldi et al., section 3).
PAPER = ("paper-monolithic", "paper-12-drums")

PRESETS = tuple(CATALOGUE)

#: Assemblies by name: files, with source and licence in their first lines.
ASSEMBLIES = {"evora": Path(__file__).with_name("evora.toml")}


def known_column(name: str) -> KnownColumn:
    """What the catalogue knows of the column of that name: its figures with their sources.

    Raises
    ------
    InputError
        There is no preset of that name.
    """
    if name not in CATALOGUE:
        raise InputError(
            f"there is no column preset {name!r}; {suggest(name, PRESETS)}presets are {', '.join(PRESETS)}.", "columns"
        )
    return CATALOGUE[name]


def preset(name: str) -> Column:
    """The column preset of that name.

    Raises
    ------
    InputError
        There is no preset of that name.
    """
    return known_column(name).column
