"""Compiled kernels are kept by the digest of their sources: an edit anywhere in the folder asks for new code."""

import shutil
import subprocess
import sys
from pathlib import Path

import stylobate
from stylobate.kernels import jit

KERNELS = Path(stylobate.__file__).parent / "kernels"

# A loop in one file and the law that it calls in another one, compiled by the package's own decorators.
LOOP = """
import importlib, sys
sys.path.insert(0, {root!r})
from {name}.loop import total
print(total(3))
"""


def test_digest_changes_with_any_kernel_file(tmp_path):
    copy = tmp_path / "kernels"
    shutil.copytree(KERNELS, copy, ignore=shutil.ignore_patterns("__pycache__"))
    before = jit.source_digest(copy)
    assert before == jit.source_digest(KERNELS)
    for name in ("drums/contact.py", "jit.py"):
        path = copy / name
        text = path.read_text(encoding="utf-8")
        path.write_text(text + "\n# another law\n", encoding="utf-8")
        assert jit.source_digest(copy) != before
        path.write_text(text, encoding="utf-8")
    assert jit.source_digest(copy) == before
    assert jit.cache_folder(copy).name == before


def test_an_edited_law_is_used_by_a_cached_loop(tmp_path, monkeypatch):
    package = tmp_path / "trial" / "kernels"
    package.mkdir(parents=True)
    (package.parent / "__init__.py").write_text("", encoding="utf-8")
    (package / "__init__.py").write_text("", encoding="utf-8")
    (package / "jit.py").write_text((KERNELS / "jit.py").read_text(encoding="utf-8"), encoding="utf-8")
    (package / "loop.py").write_text(
        "from .jit import kernel\nfrom .rule import rule\n\n"
        "@kernel\ndef total(n):\n    out = 0\n    for i in range(n):\n        out += rule(i)\n    return out\n",
        encoding="utf-8",
    )
    monkeypatch.setenv("STYLOBATE_CACHE", str(tmp_path / "cache"))
    script = LOOP.format(root=str(tmp_path), name="trial.kernels")

    def total(factor):
        (package / "rule.py").write_text(
            f"from .jit import law\n\n@law\ndef rule(i):\n    return {factor} * i\n", encoding="utf-8"
        )
        done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
        return int(done.stdout)

    assert total(1) == 3
    assert total(1) == 3
    assert total(10) == 30
    assert len(list((tmp_path / "cache" / "kernels").iterdir())) == 2
