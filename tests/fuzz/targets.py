"""The targets: every module of this package that has a ``TARGET``."""

from __future__ import annotations

import importlib
import pkgutil
from pathlib import Path

from .target import Target


def by_name() -> dict[str, Target]:
    """Targets by name."""
    names = [module_info.name for module_info in pkgutil.iter_modules([str(Path(__file__).parent)])]
    modules = [
        importlib.import_module(f"{__package__}.{name}")
        for name in names
        if name != "__main__" and not name.startswith("test_")
    ]
    targets = [module.TARGET for module in modules if hasattr(module, "TARGET")]
    return {target.name: target for target in targets}
