"""Compiled kernels are found by what they are compiled from and for: an edit of what they call asks for new code."""

import json
import os
import pickle
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import stylobate
from stylobate.kernels import cache, levels, sources

KERNELS = Path(stylobate.__file__).parent / "kernels"

# A loop in one file and the law that it calls in another one, compiled by the package's own decorators.
LOOP = """
import importlib, sys
sys.path.insert(0, {root!r})
from {name}.loop import total
print(total(3))
"""


#: What a package of kernels of one's own needs of the package's.
MACHINERY = ("jit.py", "cache.py", "known_branches.py", "levels.py", "numba_patches.py", "sources.py")


def test_digest_changes_with_any_kernel_file(tmp_path):
    copy = tmp_path / "kernels"
    shutil.copytree(KERNELS, copy, ignore=shutil.ignore_patterns("__pycache__"))
    before = sources.source_digest(copy)
    assert before == sources.source_digest(KERNELS) == sources.source_digest()
    for name in ("plane/contact.py", "jit.py"):
        path = copy / name
        text = path.read_text(encoding="utf-8")
        path.write_text(text + "\n# another law\n", encoding="utf-8")
        assert sources.source_digest(copy) != before
        path.write_text(text, encoding="utf-8")
    assert sources.source_digest(copy) == before


def digests(root: Path) -> dict[str, str]:
    """Digests of what modules are compiled from, without those that this process has made before."""
    sources._imported.cache_clear()
    return {name: sources.module_digest.__wrapped__(name, root) for name in ("plane.step", "dem3d.step", "space.step")}


@pytest.mark.parametrize(
    ("edited", "changed"),
    [
        ("plane/step.py", {"plane.step"}),
        ("dem3d/step.py", {"dem3d.step"}),
        ("space/bed.py", {"space.step"}),
        ("dem3d/links.py", {"dem3d.step", "space.step"}),
        ("shared/links.py", {"plane.step", "dem3d.step", "space.step"}),
        ("run_codes.py", {"plane.step", "dem3d.step", "space.step"}),
        ("numba_patches.py", {"plane.step", "dem3d.step", "space.step"}),
        ("rocking/step.py", set()),
    ],
)
def test_an_edit_asks_for_new_code_of_what_is_compiled_from_it(tmp_path, edited, changed):
    copy = tmp_path / "kernels"
    shutil.copytree(KERNELS, copy, ignore=shutil.ignore_patterns("__pycache__"))
    before = digests(copy)
    assert before == digests(KERNELS)  # wherever it is
    path = copy / edited
    path.write_text(path.read_text(encoding="utf-8") + "\n# another law\n", encoding="utf-8")
    after = digests(copy)
    assert {name for name in before if before[name] != after[name]} == changed


def test_what_a_module_is_compiled_from_is_all_that_python_imports_for_it():
    # The compiler takes laws from modules; those that importing plane.step loads are those whose text is in its digest.
    script = "import sys; import stylobate.kernels.plane.step; print(*sorted(sys.modules))"
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    prefix = "stylobate.kernels."
    loaded = {name.removeprefix(prefix) for name in done.stdout.split() if name.startswith(prefix)}
    assert loaded <= sources.modules_of("plane.step", KERNELS)


def trial(tmp_path):
    package = tmp_path / "trial" / "kernels"
    package.mkdir(parents=True)
    (package.parent / "__init__.py").write_text("", encoding="utf-8")
    (package / "__init__.py").write_text("", encoding="utf-8")
    for name in MACHINERY:
        shutil.copy(KERNELS / name, package / name)
    (package / "loop.py").write_text(
        "from .jit import kernel\nfrom .rule import rule\n\n"
        "@kernel\ndef total(n):\n    out = 0\n    for i in range(n):\n        out += rule(i)\n    return out\n",
        encoding="utf-8",
    )
    return package, LOOP.format(root=str(tmp_path), name="trial.kernels")


def test_an_edited_law_is_used_by_a_cached_loop(tmp_path, monkeypatch):
    package, script = trial(tmp_path)
    monkeypatch.setenv("STYLOBATE_CACHE", str(tmp_path / "cache"))

    def total(factor):
        (package / "rule.py").write_text(
            f"from .jit import law\n\n@law\ndef rule(i):\n    return {factor} * i\n", encoding="utf-8"
        )
        done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
        return int(done.stdout)

    assert total(1) == 3
    assert total(1) == 3
    assert total(10) == 30
    assert len(list((tmp_path / "cache" / "kernels").rglob("loop.total-*"))) == 2
    assert total(1) == 3
    assert len(list((tmp_path / "cache" / "kernels").rglob("loop.total-*"))) == 2


#: A kernel too long to be written into the loop that calls it, and whose copies the code of that loop has.
SUMS = "".join(f"    x += math.atan2(x, {k}.5) * math.hypot(x, {k}.25)\n" for k in range(30))
LONG = f"import math\n\nfrom .jit import kernel\n\n@kernel\ndef rule(i):\n    x = float(i)\n{SUMS}    return x\n"
COPIES = """
from {name}.loop import total
code = next(iter(total.overloads.values())).library
kinds = [(one.name.count("rule") > 0, one.linkage.name) for one in code.get_defined_functions()]
print(sorted(set(kinds)))
"""


def test_the_code_of_a_kernel_calls_its_own_copies_of_others(tmp_path, monkeypatch):
    # Or the linker would take the first of that name in the process, and last bits would hang on what was compiled before.
    package, script = trial(tmp_path)
    (package / "rule.py").write_text(LONG, encoding="utf-8")
    monkeypatch.setenv("STYLOBATE_CACHE", str(tmp_path / "cache"))
    look = script + COPIES.format(name="trial.kernels")
    done = subprocess.run([sys.executable, "-c", look], capture_output=True, text=True, check=True)
    first, kinds = done.stdout.splitlines()
    assert "(True, 'internal')" in kinds
    assert "linkonce" not in kinds
    again = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert again.stdout.splitlines()[0] == first  # from disk, to the last bit


#: A kernel that calls a long one twice, for records of which each process compiles those that it is asked for.
TWICE = f"""
import math
from .jit import strict

@strict
def last(record):
    x = 0.0
{SUMS}    return x + record[0].last

@strict
def twice(record):
    return last(record) + last(record)
"""
RECORDS = """
import sys
import numpy as np
sys.path.insert(0, {root!r})
from {name}.rule import twice

def record(names):
    one = np.zeros(1, np.dtype([(name, float) for name in names]))
    one["last"] = 7.0
    return one

print(*(twice(record(names)) for names in {records}))
"""


def test_code_for_two_records_by_two_processes_is_told_apart(tmp_path, monkeypatch):
    # Both bore one name: slips of damped columns were read where undamped ones have something else, and were 1e20 m.
    package, _ = trial(tmp_path)
    (package / "rule.py").write_text(TWICE, encoding="utf-8")
    monkeypatch.setenv("STYLOBATE_CACHE", str(tmp_path / "cache"))

    def outputs(*records):
        script = RECORDS.format(root=str(tmp_path), name="trial.kernels", records=records)
        done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
        return done.stdout.split()

    short, long = ("last", "other"), ("a", "b", "c", "last")
    assert outputs(short) == outputs(long) == ["14.0"]
    assert outputs(short, long) == outputs(long, short) == ["14.0", "14.0"]


RULE = "from .jit import law\n\n@law\ndef rule(i):\n    return 7 * i\n"
DAMAGES = {
    "nothing left": lambda data: b"",
    "cut short": lambda data: data[: len(data) // 2],
    "zeros, as after a power cut": lambda data: bytes(len(data)),
    "noise": lambda data: bytes((137 * i + 41) % 256 for i in range(len(data))),
    "one bit": lambda data: data[:-100] + bytes([data[-100] ^ 4]) + data[-99:],
    "a pickle of something else": lambda data: pickle.dumps({"some": "thing"}),
}


# Every start of a process as an import anew: damages the files, and says what came of it.
STARTS = """
import importlib, json, sys, warnings
from pathlib import Path
sys.path.insert(0, {root!r})
sys.path.insert(0, {here!r})
from test_kernel_cache import DAMAGES
import trial.kernels.loop as loop

def start():
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        importlib.reload(loop)
        return [loop.total(3), sorted({{str(one.message)[-33:] for one in said}})]

found = [["first", "", loop.total(3), []]]
for path in sorted(Path({cache!r}).rglob("*.kernel")):
    sound = path.read_bytes()
    for name, damage in DAMAGES.items():
        path.write_bytes(damage(sound))
        found += [[path.suffix, name, *start()], [path.suffix, "after " + name, *start()]]
print(json.dumps(found))
"""


def test_damaged_compiled_code_is_made_anew_with_a_warning(tmp_path, monkeypatch):
    package, _ = trial(tmp_path)
    (package / "rule.py").write_text(RULE, encoding="utf-8")
    cache = str(tmp_path / "cache")
    monkeypatch.setenv("STYLOBATE_CACHE", cache)
    script = STARTS.format(root=str(tmp_path), here=str(Path(__file__).parent), cache=cache)
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    first, *restarts = json.loads(done.stdout)
    assert len(restarts) == 2 * len(DAMAGES)
    assert {total for _, _, total, _ in (first, *restarts)} == {21}
    for suffix, name, _, messages in restarts:
        expected = [] if name.startswith("after") else ["was damaged and is compiled anew."]
        assert messages == expected, (suffix, name)


def test_code_is_found_by_a_copy_of_the_sources_elsewhere_and_at_another_time(tmp_path, monkeypatch):
    package, script = trial(tmp_path / "here")
    (package / "rule.py").write_text(RULE, encoding="utf-8")
    monkeypatch.setenv("STYLOBATE_CACHE", str(tmp_path / "cache"))
    subprocess.run([sys.executable, "-c", script], check=True, stdout=subprocess.DEVNULL)
    before = kept(tmp_path)
    shutil.copytree(tmp_path / "here", tmp_path / "there")
    for path in (tmp_path / "there").rglob("*.py"):
        os.utime(path, (0, 0))
    there = script.replace(str(tmp_path / "here"), str(tmp_path / "there"))
    look = f"{there}from trial.kernels import cache\nprint([one[1] for one in cache.read])\n"
    done = subprocess.run([sys.executable, "-c", look], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines() == ["21", "['total']"]
    assert kept(tmp_path) == before
    assert not any(str(tmp_path).encode() in path.read_bytes() for path in (tmp_path / "cache").rglob("*.kernel"))


def kept(folder):
    return {path.name: path.stat().st_mtime_ns for path in (folder / "cache").rglob("*.kernel")}


def test_shipped_code_is_taken_by_its_level_and_damaged_one_is_not(tmp_path, monkeypatch):
    package, script = trial(tmp_path)
    (package / "rule.py").write_text(RULE, encoding="utf-8")
    monkeypatch.setenv("STYLOBATE_CACHE", str(tmp_path / "cache"))
    subprocess.run([sys.executable, "-c", script], check=True, stdout=subprocess.DEVNULL)
    shutil.move(tmp_path / "cache" / "kernels", package / "built")

    def run(**environment):
        settings = os.environ | environment
        done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True, env=settings)
        assert done.stdout.strip() == "21"
        return done.stderr, len(list((tmp_path / "cache").rglob("*.kernel")))

    assert run() == ("", 0)
    other = next(name for name in (*levels.X86, *levels.ARM) if name != levels.levels_here()[-1])
    if other in levels.levels_here():
        assert run(**levels.settings(other)) == ("", 1)  # compiled for the other level
        shutil.rmtree(tmp_path / "cache")
    for path in (package / "built").rglob("*.kernel"):
        path.write_bytes(path.read_bytes()[:-1])
    output, count = run()
    assert "was damaged and is compiled anew" in output
    assert count > 0
    assert run()[1] == count


def test_code_that_cannot_be_kept_is_run_all_the_same(tmp_path, monkeypatch):
    package, script = trial(tmp_path)
    (package / "rule.py").write_text(RULE, encoding="utf-8")
    (tmp_path / "cache").write_text("a file where the folder should be")
    monkeypatch.setenv("STYLOBATE_CACHE", str(tmp_path / "cache"))
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "21"
    assert "compiled code cannot be kept" in done.stderr


def test_every_reader_finds_its_folder(monkeypatch, tmp_path):
    monkeypatch.setenv("STYLOBATE_CACHE", str(tmp_path))
    assert cache.cache_folder() == tmp_path / "kernels"
    monkeypatch.delenv("STYLOBATE_CACHE")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "xdg"))
    assert cache.cache_folder() == tmp_path / "xdg" / "stylobate" / "kernels"


def test_a_command_says_that_the_cache_was_damaged_and_gives_its_answer(tmp_path):
    cache = tmp_path / "cache"
    command = [
        sys.executable, "-c", "from stylobate.cli.main import main; main()", "spectrum", "--harmonic",
        "1Hz,0.5g,1s", "--json",
    ]  # fmt: skip
    first, second = (_after(cache, command, damage) for damage in (False, True))
    assert (first.returncode, second.returncode) == (0, 0), second.stderr
    assert "was damaged and is compiled anew" in second.stderr
    assert first.stdout == second.stdout


def _after(cache, command, damage):
    for path in cache.rglob("*.kernel") if damage else ():
        path.write_bytes(b"")
    environment = os.environ | {"STYLOBATE_CACHE": str(cache)}
    return subprocess.run(command, capture_output=True, text=True, check=False, env=environment)


def test_a_kernel_of_another_package_is_compiled_in_every_process(tmp_path):
    """Its sources are not among those that name a file: an edited one would be run as it was."""
    law = "from stylobate.kernels.jit import kernel\n\n@kernel\ndef rule(x):\n    return {} * x\n"
    environment = os.environ | {"STYLOBATE_CACHE": str(tmp_path / "cache"), "PYTHONPATH": str(tmp_path)}
    for factor in ("2.0", "3.0"):
        (tmp_path / "mine.py").write_text(law.format(factor))
        line = [sys.executable, "-B", "-c", "import mine; print(mine.rule(1.0))"]
        done = subprocess.run(line, env=environment, capture_output=True, text=True, check=True)
        assert done.stdout.strip() == factor
