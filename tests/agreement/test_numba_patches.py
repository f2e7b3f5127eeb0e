"""What is replaced inside the compiler is replaced in this version of it, and does what it is there for."""

import copy
import warnings

import llvmlite.binding as llvm
import numba
import numpy as np
import pytest
from numba.core import codegen, ir, targetconfig
from numba.core.compiler import Flags

from stylobate.kernels.numba_patches import OwnCode

FIELDS = np.dtype([("a", np.float64, (4,)), ("b", np.float64, (2, 4)), ("n", np.int64), ("x", np.float64)])
LONGER = np.dtype([*((name, FIELDS[name]) for name in FIELDS.names), ("y", np.float64)])


def optimised(dispatcher) -> str:
    (code,) = (overload.library.get_llvm_str() for overload in dispatcher.overloads.values())
    return code


def test_arrays_may_be_said_not_to_overlap():
    # What `apart` asks for becomes an attribute of the arguments.
    def copied(a, b):
        for i in range(len(a)):
            a[i] = b[i] + 1.0

    plain, apart = (numba.njit(**how)(copied) for how in ({}, {"noalias": True}))
    for function in (plain, apart):
        function(np.zeros(3), np.ones(3))
    assert optimised(apart).count("noalias") > optimised(plain).count("noalias")


def test_a_record_is_never_taken_for_a_shorter_one():
    # LONGER begins with the fields of FIELDS: the compiler would run code for the one on the other, with a warning.
    @numba.njit
    def last(records):
        return records[0].x

    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for kind in (FIELDS, LONGER):
            records = np.zeros(1, kind)
            records["x"] = 3.0
            assert last(records) == 3.0
    assert len(last.overloads) == 2
    assert numba.from_dtype(LONGER).can_convert_to(None, numba.from_dtype(FIELDS)) is None


def test_a_record_is_named_by_its_fields():
    record_type, same, other = (numba.from_dtype(np.dtype(kind)) for kind in (FIELDS, FIELDS.descr, LONGER))
    assert record_type.mangling_args == same.mangling_args != other.mangling_args
    assert str(record_type._code) not in record_type.mangling_args[1][0]  # the number that it has in this process


def test_the_code_of_a_kernel_holds_its_own_copies_of_others():
    # As they are kept on disk, test_kernel_cache.py tries the same.
    assert codegen.JITCPUCodegen._library_class is OwnCode

    @numba.njit
    def inner(x):
        for k in range(1, 30):
            x += np.arctan2(x, k) * np.hypot(x, k)
            print(x)
        return x

    @numba.njit
    def outer(x):
        return inner(x) + inner(2.0 * x)

    outer.compile("float64(float64)")
    (code,) = (overload.library for overload in outer.overloads.values())
    kinds = {function.linkage for function in code.get_defined_functions() if "inner" in function.name}
    assert kinds == {llvm.Linkage.internal}


@pytest.mark.parametrize("at", [0, 3, -1, -4, np.int32(2), np.uint64(1)])
def test_fields_are_read_and_written_as_numpy_does(at):
    @numba.njit(error_model="numpy")
    def shuffle(records, k, at):
        u = records[k]
        u.a[at] = 10.0 * u.b[1, at] + u.x
        u.b[0, at] = u.a[at] + u.a.shape[0] + u.b.shape[0] * len(u.a)
        u.n = u.b[-1].shape[0]
        return u.a[at], u.b[0, at], u.b[-1, at], u.a.sum()

    records = np.zeros(3, FIELDS)
    records["a"], records["b"] = np.arange(12.0).reshape(3, 4), np.arange(24.0).reshape(3, 2, 4)
    records["x"] = 0.5
    expected = records.copy()
    result = shuffle(records, 1, at)
    u = expected[1]
    u["a"][at] = 10.0 * u["b"][1, at] + u["x"]
    u["b"][0, at] = u["a"][at] + 4 + 2 * 4
    u["n"] = 4
    assert (records == expected).all()
    assert result == (u["a"][at], u["b"][0, at], u["b"][-1, at], u["a"].sum())


def test_fields_are_reached_without_a_description_of_them_in_memory():
    @numba.njit(error_model="numpy", _nrt=False)
    def sums(records):
        u = records[0]
        return u.a[0] + u.b[1, 2] + u.a[1] + u.b[0, 3]

    lines = []
    add = codegen.CPUCodeLibrary.add_ir_module

    def count(self, module):
        lines.append(len(str(module).splitlines()))
        add(self, module)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(codegen.CPUCodeLibrary, "add_ir_module", count)
        sums(np.zeros(1, FIELDS))
    assert lines[0] < 200  # 500 with the compiler's own


def test_flags_are_compared_as_the_compiler_does():
    first, second = Flags(), Flags()
    assert first == second
    assert first.values() == {name: getattr(first, name) for name in first.options}
    second.nrt = not first.nrt
    assert first != second
    assert targetconfig.TargetConfig.values(second)["nrt"] is second.nrt


def test_places_in_sources_are_not_copied():
    place = ir.Loc("file.py", 3)
    assert copy.deepcopy([place, place]) == [place, place]
    assert copy.deepcopy(place) is place


def test_a_copy_of_a_scope_is_the_compilers_own():
    def scope():
        whole = ir.Scope(parent=None, loc=place)
        for name in ("a", "b", "a", "a"):
            whole.redefine(name, place)
        return whole

    place = ir.Loc("file.py", 3)
    first = scope()
    block = ir.Block(first, place)
    block.append(ir.Assign(value=first.get("b"), target=first.get("a"), loc=place))
    copied = copy.deepcopy(block)
    made = copied.scope
    assert made is not first
    assert made == first
    assert made.redefined == first.redefined
    assert made.var_redefinitions == first.var_redefinitions == {"a": {"a.1", "a.2"}}
    assert {name: made.get_exact(name).scope is made for name in ("a", "b", "a.1", "a.2")} == {
        "a": True, "b": True, "a.1": True, "a.2": True,
    }  # fmt: skip
    assert copied.body[0].target is made.get("a")
    made.redefine("a", place)
    assert "a.3" not in first.localvars
