"""Digests of source files: of a whole folder, and of all that a kernel is compiled from."""

from __future__ import annotations

import ast
import hashlib
from functools import cache
from pathlib import Path


def source_digest(folder: Path | None = None) -> str:
    """Digest of all files of a folder and the folders in it; of the kernels', if none is named."""
    root = folder or Path(__file__).parent
    digest = hashlib.sha256()
    for path in sorted(root.rglob("*.py")):
        digest.update(path.relative_to(root).as_posix().encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


@cache
def module_digest(module: str, root: Path) -> str:
    """Digest of the files that the code of a module is compiled from: its own, and all that it imports by relative imports.

    Parameters
    ----------
    module : str
        Name inside the package of the kernels, like ``plane.step``.
    root : Path
        Folder of that package.
    """
    digest = hashlib.sha256()
    for name in sorted(modules_of(module, root)):
        path = _file(name, root)
        assert path is not None
        digest.update(name.encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()


def modules_of(module: str, root: Path) -> set[str]:
    """Modules and packages that the code of a module is compiled from, by their names inside the package of the kernels."""
    modules, todo = set[str](), [module]
    while todo:
        name = todo.pop()
        if name not in modules and _file(name, root) is not None:
            modules.add(name)
            todo += _imported(name, root)
    return modules


def _file(module: str, root: Path) -> Path | None:
    """File of a module, or of a package; None where there is none."""
    place = root.joinpath(*module.split(".")) if module else root
    return next((path for path in (place.with_suffix(".py"), place / "__init__.py") if path.is_file()), None)


@cache
def _imported(module: str, root: Path) -> tuple[str, ...]:
    """Names that the relative imports of a module may mean, as modules of the package."""
    path = _file(module, root)
    assert path is not None
    parts = module.split(".") if module else []
    package = parts if path.name == "__init__.py" else parts[:-1]
    names = [".".join(package)]
    for node in ast.walk(ast.parse(path.read_bytes())):
        if isinstance(node, ast.ImportFrom) and 0 < node.level <= len(package) + 1:
            above = package[: len(package) - node.level + 1]
            source = above + (node.module.split(".") if node.module else [])
            names += [".".join(source), *(".".join([*source, alias.name]) for alias in node.names)]
    return tuple(names)
