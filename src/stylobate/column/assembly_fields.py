"""Fields of an assembly, of the plane and in space, that are checked before anything reads them."""

from __future__ import annotations

from typing import Any

from ..errors import InputError, as_typed, check_all, check_kind, check_name
from .joint import Joint
from .links.link import Link


def check_fields(assembly: Any, bodies: str, kind: type) -> None:
    """Refuse what is no body, link, override or law; bodies, links and overrides are tuples afterwards.

    Parameters
    ----------
    assembly : Assembly or SpatialAssembly
    bodies : str
        Name of the field of its bodies.
    kind : type
        Of these.

    Raises
    ------
    InputError
    """
    for name, each in ((bodies, kind), ("links", Link)):
        object.__setattr__(assembly, name, tuple(check_all(name, getattr(assembly, name), each)))
    object.__setattr__(assembly, "overrides", tuple(check_kind("overrides", assembly.overrides, (tuple, list))))
    for one in assembly.overrides:
        kinds = (str, str, Joint)
        if not isinstance(one, (tuple, list)) or len(one) != 3 or not all(map(isinstance, one, kinds)):
            raise InputError(f"an override is {as_typed(one)}; allowed is (name, name, Joint), of two blocks.")
    check_kind("joint", assembly.joint, Joint)
    check_name("the name of an assembly", assembly.name)
