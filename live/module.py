"""The engine of the plane as a WebAssembly module: the functions of a page, compiled by the compiler of all kernels.

Python's way of calling compiled code is left out; in its place stands a function for each that reads its arguments, one
after the other as words of 64 bits, from one place in memory. Run as ``python -m live.module FILE`` in a process of its own
(:func:`built`), whose compiler must not take this processor's own instructions.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

from .link import linked

#: Instructions beyond the first version of WebAssembly that the module uses; browsers have had all of them since 2023.
FEATURES = "+simd128,+bulk-memory,+nontrapping-fptoint,+sign-ext"

#: Data layout and name of the machine that the module is for.
LAYOUT = "e-m:e-p:32:32-p10:8:8-p20:8:8-i64:64-i128:128-n32:64-S128-ni:1:10:20"
TRIPLE = "wasm32-unknown-unknown"

#: Of a compiler that must not take what this processor alone has: the same bits everywhere.
GENERIC = {"NUMBA_CPU_NAME": "generic", "NUMBA_CPU_FEATURES": ""}


def built(path: Path) -> bytes:
    """The module, made in a process of its own; written to a file as well."""
    command = [sys.executable, "-m", "live.module", str(path)]
    subprocess.run(command, env=os.environ | GENERIC, cwd=Path(__file__).parents[1], check=True)
    return path.read_bytes()


def module() -> bytes:
    """The module, linked; see :func:`built`."""
    import llvmlite.binding as llvm

    llvm.initialize_all_targets()
    llvm.initialize_all_asmprinters()
    whole = None
    for name, function in functions().items():
        part = llvm.parse_assembly(retargeted(name, function))
        part.verify()
        if whole is None:
            whole = part
        else:
            whole.link_in(part)
    machine = llvm.Target.from_triple(TRIPLE).create_target_machine(
        cpu="generic", features=FEATURES, opt=3, reloc="static"
    )
    options = llvm.create_pipeline_tuning_options(speed_level=3)
    options.loop_vectorization = options.slp_vectorization = True
    llvm.create_pass_builder(machine, options).getModulePassManager().run(
        whole, llvm.create_pass_builder(machine, options)
    )
    return linked(machine.emit_object(whole), [*functions()])


def functions() -> dict[str, Any]:
    """What the page calls, compiled for the types of its records."""
    import numba

    from stylobate.kernels.plane import step

    from . import kernel
    from .columns import arguments

    result = {"begin": kernel.begin, "advance": step.advance, "judge": kernel.judge}
    for name, function in result.items():
        function._cache.disable()  # of what is read from disk there is no intermediate code
        function.compile(tuple(numba.typeof(item) for item in arguments(name)))
    return result


def retargeted(name: str, function: Any) -> str:
    """The intermediate code of a compiled function for the module's machine, with the function ``name`` that calls it."""
    (compiled,) = function.overloads.values()
    text, mangled = compiled.library.get_llvm_str(), compiled.fndesc.mangled_name
    text = without_wrappers(text).replace("@" + mangled, f"@{name}.compiled")
    text = re.sub(r"^declare .*@(Py|numba_)[^\n]*\n", "", text, flags=re.M)
    text = re.sub(r"^target datalayout = .*$", f'target datalayout = "{LAYOUT}"', text, flags=re.M)
    text = re.sub(r"^target triple = .*$", f'target triple = "{TRIPLE}"', text, flags=re.M)
    text = text.replace("= common ", "= internal ")
    text = re.sub(r"^define (?!internal|linkonce)", "define internal ", text, flags=re.M)
    return text + caller(name, text)


def without_wrappers(text: str) -> str:
    """The code without the functions by which Python and C call what is compiled."""
    kept, skips = [], False
    for line in text.split("\n"):
        skips = skips or (line.startswith("define") and ("@_ZN7cpython" in line or "@cfunc." in line))
        if not skips:
            kept.append(line)
        skips = skips and line != "}"
    return "\n".join(kept)


def caller(name: str, text: str) -> str:
    """A function of that name that reads the arguments of the compiled one from words in memory; its return value is last.

    The compiled function is given where to put its return value and its error first, then its arguments.
    """
    head = re.search(rf"^define [^@]*@{name}\.compiled\((.*)\)[^)]*{{$", text, flags=re.M)
    assert head is not None, name
    lines, call = [f"\ndefine i32 @{name}(ptr %words) {{"], []
    for i, kind in enumerate(part.split()[0] for part in split_arguments(head[1])):
        lines += [f"  %p{i} = getelementptr i64, ptr %words, i32 {i}", f"  %w{i} = load i64, ptr %p{i}, align 8"]
        turn = {"ptr": "inttoptr i64 %w{} to ptr", "double": "bitcast i64 %w{} to double"}.get(kind)
        if turn is None:
            assert kind == "i64", (name, kind)
        else:
            lines.append(f"  %a{i} = {turn.format(i)}")
        call.append(f"{kind} %{'w' if turn is None else 'a'}{i}")
    lines += [f"  %r = call i32 @{name}.compiled({', '.join(call)})", "  ret i32 %r", "}"]
    return "\n".join(lines) + "\n"


def split_arguments(text: str) -> list[str]:
    """Arguments of a function, which may hold commas in parentheses."""
    return [item.strip() for item in re.split(r",\s*(?![^()]*\))", text)]


if __name__ == "__main__":
    Path(sys.argv[1]).write_bytes(module())
