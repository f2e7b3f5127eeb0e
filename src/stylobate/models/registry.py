"""Models by their names; a model is loaded when it is asked for."""

from __future__ import annotations

import dataclasses
import importlib
from collections.abc import Mapping, Sequence
from typing import Any

from ..column.files import losses_by
from ..column.joint import NAMED, Losses
from ..errors import InputError, suggest
from .base import Model

#: Name: module of this package and class in it.
MODELS = {
    "housner": ("rocking.model", "HousnerBlock"),
    "rigid-beam": ("rigid_beam.model", "RigidBeam"),
    "rigid-block": ("rigid_block.model", "RigidBlock"),
    "dem2d": ("dem2d.model", "DistinctElement2D"),
    "dem3d": ("dem3d.model", "DistinctElement3D"),
}


def model_class(name: str) -> type[Model]:
    """The class of a model.

    Raises
    ------
    InputError
        There is no model of that name.
    """
    if name not in MODELS:
        message = f"there is no model {name!r}; {suggest(name, MODELS)}models are {', '.join(MODELS)}."
        raise InputError(message, "model", value=name)
    module, attribute = MODELS[name]
    return getattr(importlib.import_module(f"{__package__}.{module}"), attribute)


def make_model(name: str, settings: Mapping[str, str] | None = None, losses: str | None = None) -> Model:
    """A model of that name with parameters given as texts, e.g. ``make_model("dem2d", {"points": "3"})``.

    Parameters
    ----------
    name : str
    settings : mapping of str to str, optional
        They name no files, because strangers may give them.
    losses : str, optional
        Losses by name, or the path of a file of losses.
    """
    chosen = None if losses is None else losses_by(losses)
    named = {} if chosen is None else {"losses": chosen if isinstance(chosen, str) else NAMED[0]}
    made: Any = model_class(name).from_settings({**(settings or {}), **named})
    return dataclasses.replace(made, losses=chosen) if isinstance(chosen, Losses) else made


def make_models(named: Sequence[tuple[str, Mapping[str, str]]], losses: str | None = None) -> list[Model]:
    """Models side by side, each by its name and its settings, with losses by name or file for those that know them.

    A model whose settings name losses keeps these.

    Raises
    ------
    InputError
        None of the models knows losses by name, and they are given.
    """
    knows = [any(field.name == "losses" for field in dataclasses.fields(model_class(name))) for name, _ in named]
    if losses is not None and not any(knows):
        raise InputError(
            f"losses are {losses!r}, and none of the models {', '.join(name for name, _ in named)} knows them; leave them "
            "out, or take dem2d or dem3d.",
            "losses",
        )
    return [
        make_model(name, settings, losses if known and "losses" not in settings else None)
        for (name, settings), known in zip(named, knows)
    ]
