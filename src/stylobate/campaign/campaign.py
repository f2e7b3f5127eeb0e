"""Settings of a batch of runs: replicates, tail, executor, ledger, progress."""

from __future__ import annotations

from collections.abc import Callable, Container, Mapping
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Any

from ..column.scatter import Scatter
from ..errors import InputError, as_typed, check_choice, check_kind, check_range, check_whole
from ..models.base import RunOptions
from ..response.measures import CPU, DEVICES, GPU
from .ledger import RUNS_FILE

#: Many runs go on until their verdicts are certain.
DECIDED = RunOptions(until_decided=True)

#: Largest number of twins.
MAX_TWINS = 100_000

#: Called with (finished runs, all runs) whenever a run finishes; by a single run with times.
Progress = Callable[[Any, Any], None]

#: Fields about replicates, about the runs themselves, and about where runs are computed and kept, and who is told.
TWINS = ("replicates", "scatter", "seed")
RUNS = (*TWINS, "whole")
COMPUTING = ("threads", "dask", "device", "mix_devices", "progress", "ledger")


@dataclass(frozen=True)
class Campaign:
    """Settings of a batch of runs, the same for the command line, study files, the page and Python.

    Functions that make runs take a campaign, its fields as keywords, or both: a keyword fills a field that the campaign
    leaves at its default; where both say something else, they are refused.

    Parameters
    ----------
    replicates : int
        Number of columns like each one, its twins; 0 for none.
    scatter : Scatter, optional
        How they differ; by default as columns of their material do.
    seed : int
        Of these columns: the same seed gives the same ones.
    tail : float
        Time to go on after each motion has ended [s]. Assemblies of which nothing has fallen go on from there until all
        lies still, a minute at most.
    whole : bool
        Step all of a record; by default its quiet, below a tenth of what opens a joint, is left out before and between
        shocks and at the end, where the column lies at rest (``stepped_from_s``, ``stepped_to_s``, ``stepped_s`` say so).
    threads : int, optional
        All cores by default.
    dask : str, optional
        Scheduler of a Dask cluster that computes instead, such as ``tcp://10.0.0.1:8786``; ``local`` starts workers here.
    device : {"cpu", "gpu"}
        ``gpu`` lets the graphics card of this machine step the columns for which it has kernels, and processors the rest.
        Its last digits are its own, and so may be a verdict near the border.
    mix_devices : bool
        Go on from finished runs that another kind of device has computed; by default they are refused.
    progress : callable, optional
        Called with (finished, all).
    ledger : path, optional
        File that keeps every finished run for good: a call that was stopped goes on from there, another one makes only the
        runs that are new. It stays for the caller to remove.

    Raises
    ------
    InputError
        A number that is not allowed.
    """

    replicates: int = 0
    scatter: Scatter | None = None
    seed: int = 0
    tail: float = 0.0
    whole: bool = False
    threads: int | None = None
    dask: str | None = None
    device: str = CPU
    mix_devices: bool = False
    progress: Progress | None = None
    ledger: str | Path | None = None

    def __post_init__(self) -> None:
        check_whole("`replicates`", self.replicates, 0, MAX_TWINS)
        check_whole("`seed`", self.seed, 0, 2**63 - 1)
        such = "a Scatter, such as Scatter(friction=0.1)"
        check_kind("`scatter`", self.scatter, Scatter, allowed=such, optional=True)
        check_range("`tail`", self.tail, 0.0, 1e4, unit="s")
        check_kind("`whole`", self.whole, bool, allowed="True or False")
        check_choice("`device`", self.device, DEVICES)
        if self.device == GPU and self.dask is not None:
            raise InputError("`dask` and a `device` of gpu are both given; give one of the two.", "device")
        check_kind("`mix_devices`", self.mix_devices, bool, allowed="True or False")
        check_kind("progress", self.progress, Callable, allowed="a function of two numbers", optional=True)
        check_kind("ledger", self.ledger, (str, Path), allowed="the path of a file", optional=True)
        if self.threads is not None:
            check_range("`threads`", self.threads, 1, 1024, remedy="leave it out to use all cores")

    @classmethod
    def of(
        cls,
        function: str,
        campaign: Campaign | None,
        settings: Mapping[str, Any],
        without: Container[str] = (),
        **usual: Any,
    ) -> Campaign:
        """Settings of a ``function`` that takes a campaign, fields of it as keywords, or both, with ``usual`` defaults.

        Raises
        ------
        TypeError
            A keyword that is none, or one of those that the function goes ``without``.
        InputError
            A value that is not allowed, or one thing in the campaign and another in a keyword.
        """
        standard = cls(**usual)
        value = (
            standard
            if campaign is None
            else check_kind("campaign", campaign, cls, allowed="a Campaign, such as Campaign(replicates=30)")
        )
        names = [option.name for option in fields(cls) if option.name not in without]
        for name, typed in settings.items():
            if name not in names:
                raise TypeError(
                    f"{function}: there is no keyword {name!r}; settings of its runs are {', '.join(names)}"
                )
            stated = getattr(value, name)
            if stated not in (typed, getattr(cls, name), getattr(standard, name)):
                raise InputError(
                    f"`{name}` is {as_typed(typed)}, and {as_typed(stated)} in the campaign; give it in one of the two.",
                    name,
                )
        for field in fields(cls):
            if field.name not in names and getattr(value, field.name) != field.default:
                raise InputError(f"{function} takes no {field.name}; leave it out of the campaign.")
        return replace(value, **settings)

    @property
    def options(self) -> RunOptions:
        """How long its runs go on."""
        return replace(DECIDED, tail=float(self.tail))

    @property
    def quiet(self) -> float | None:
        """Share of quiet of its motions [-]: 0 where all of them is stepped, None for that of each."""
        return 0.0 if self.whole else None

    @property
    def of_runs(self) -> Campaign:
        """What it says of the runs themselves."""
        return replace(self, **{name: getattr(Campaign, name) for name in COMPUTING})

    @property
    def of_computing(self) -> Campaign:
        """Where it says that they are computed and kept, and who is told."""
        return Campaign(**{name: getattr(self, name) for name in COMPUTING})

    def kept_in(self, folder: str | Path | None) -> Campaign:
        """The same, with the ledger of a folder unless it has one.

        Raises
        ------
        InputError
            There is no such folder.
        """
        made = self if folder is None or self.ledger is not None else replace(self, ledger=Path(folder) / RUNS_FILE)
        if made.ledger is not None and not Path(made.ledger).parent.is_dir():
            raise InputError(f"folder {Path(made.ledger).parent} does not exist; create it first.")
        return made
