"""What is replaced inside the compiler, all of it: each with its reason, and with a test in ``test_numba_patches.py``.

Imported once, by ``jit.py``, before anything is compiled. ``pyproject.toml`` bounds the version of numba from above: a newer
one is admitted when these tests pass with it.
"""

from __future__ import annotations

import copy
import hashlib
import operator
from collections.abc import Sequence
from typing import Any

import llvmlite.binding as llvm
from llvmlite import ir
from numba.core import cgutils, codegen, cpu, options, targetconfig, types
from numba.core import ir as numba_ir
from numba.extending import lower_builtin, lower_getattr, lower_getattr_generic
from numba.np import arrayobj

# 1. The compiler can be told that the arrays of a loop do not overlap, but numba gives this flag no name of its own.
cpu.CPUTargetOptions.noalias = options.TargetOptions.Mapping("noalias")

# 2. A law is compiled for each type of record that it is given, whatever was compiled before: the compiler would take what
# it has for a record that begins with the same fields, with a warning.
types.Record.can_convert_to = lambda *_: None


def _record_name(record: Any) -> tuple[str, tuple[str]]:
    return "Record", (hashlib.sha256(record.name.encode()).hexdigest()[:32],)


# 3. The name of a record in that of compiled code is of what it holds. The compiler would number records in each process, so
# that code for two of them, kept on disk by two processes, could bear one name, and the one be run for the other.
types.Record.mangling_args = property(_record_name)


class OwnCode(codegen.JITCodeLibrary):
    """The code of a kernel, which calls the copies of other kernels that were compiled into it.

    By themselves copies of one name are one to the linker, which takes whichever the process has loaded first: code that was
    compiled twice may contract other products and sums, so that last bits would hang on what had been compiled or loaded.
    """

    def _finalize_final_module(self) -> None:
        if self._shared_module is None:  # not read from disk
            self._shared_module = self._final_module.clone()  # what other kernels copy
            for functions, before, after in (
                (self._shared_module.functions, llvm.Linkage.external, llvm.Linkage.linkonce_odr),
                (self._final_module.functions, llvm.Linkage.linkonce_odr, llvm.Linkage.internal),
            ):
                for function in functions:
                    if not function.is_declaration and function.linkage == before:
                        function.linkage = after
        super()._finalize_final_module()


# 4. As its docstring says.
codegen.JITCPUCodegen._library_class = OwnCode


# 5. Fields of records. A field that is an array lies at a fixed place, with a fixed shape: to read a number of it takes four
# instructions. The compiler writes some fifty, a description of the array in memory at every use, which its optimiser then
# removes: nearly half of the time of compiling. The code that comes out is the same.


@lower_getattr_generic(types.Record)
def record_field(context: Any, builder: Any, record: Any, value: Any, name: str) -> Any:
    """A field of a record; one that is an array as a constant description of it with its address."""
    field = record.typeof(name)
    if not isinstance(field, types.NestedArray):
        return arrayobj.record_getattr(context, builder, record, value, name)
    context.sentry_record_alignment(record, name)
    data = cgutils.get_record_member(builder, value, record.offset(name), context.get_data_type(field.dtype))
    return builder.insert_value(_description(context, field), data, _place_of_data(context, field))


def _description(context: Any, field: Any) -> Any:
    """A constant that describes an array of a shape, without its address."""
    whole = [context.get_constant(types.intp, number) for number in (field.nitems, field.size)]
    values = dict(zip(("nitems", "itemsize"), whole, strict=True))
    for attribute in ("shape", "strides"):
        numbers = [context.get_constant(types.intp, number) for number in getattr(field, attribute)]
        values[attribute] = ir.Constant(ir.ArrayType(numbers[0].type, len(numbers)), numbers)
    kind = context.get_value_type(field)
    model = context.data_model_manager[field]
    parts = [
        values[name] if name in values else ir.Constant(part, ir.Undefined if name == "data" else None)
        for name, part in zip(model._fields, kind.elements, strict=True)
    ]
    return ir.Constant(kind, parts)


def _place_of_data(context: Any, field: Any) -> int:
    return context.data_model_manager[field].get_field_position("data")


def _whole_numbers(indices: Any) -> Sequence[Any]:
    return indices.types if isinstance(indices, types.BaseTuple) else (indices,)


def _is_element(field: Any, indices: Any) -> bool:
    """Whether indices name a single number of a field."""
    each = _whole_numbers(indices)
    return len(each) == field.ndim and all(isinstance(kind, types.Integer) for kind in each)


def _element(context: Any, builder: Any, field: Any, value: Any, indices: Any, index: Any) -> Any:
    """Address of an element of a field; indices may count from its end."""
    kinds = _whole_numbers(indices)
    each = cgutils.unpack_tuple(builder, index, len(kinds)) if isinstance(indices, types.BaseTuple) else [index]
    place = None
    for size, kind, subscript in zip(field.shape, kinds, each, strict=True):
        length = context.get_constant(types.intp, size)
        subscript = context.cast(builder, subscript, kind, types.intp if kind.signed else types.uintp)
        if kind.signed:
            from_end = builder.icmp_signed("<", subscript, ir.Constant(subscript.type, 0))
            subscript = builder.select(from_end, builder.add(subscript, length), subscript)
        place = subscript if place is None else builder.add(builder.mul(place, length), subscript)
    return builder.gep(builder.extract_value(value, _place_of_data(context, field)), [place])


@lower_builtin(operator.getitem, types.NestedArray, types.Integer)
@lower_builtin(operator.getitem, types.NestedArray, types.BaseTuple)
def field_element(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    """An element of a field of a record."""
    field, indices = sig.args
    if context.enable_boundscheck or not _is_element(field, indices):
        general = (
            arrayobj.getitem_array_tuple if isinstance(indices, types.BaseTuple) else arrayobj.getitem_arraynd_intp
        )
        return general(context, builder, sig, args)
    return arrayobj.load_item(context, builder, field, _element(context, builder, field, args[0], indices, args[1]))


@lower_builtin(operator.setitem, types.NestedArray, types.Integer, types.Any)
@lower_builtin(operator.setitem, types.NestedArray, types.BaseTuple, types.Any)
def set_field_element(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    """Write an element of a field of a record."""
    field, indices, kind = sig.args
    if context.enable_boundscheck or not _is_element(field, indices):
        return arrayobj.setitem_array(context, builder, sig, args)
    address = _element(context, builder, field, args[0], indices, args[1])
    return arrayobj.store_item(context, builder, field, context.cast(builder, args[2], kind, field.dtype), address)


@lower_getattr(types.NestedArray, "shape")
def field_shape(context: Any, builder: Any, field: Any, value: Any) -> Any:
    """Shape of a field of a record, which its type knows."""
    return cgutils.pack_array(builder, [context.get_constant(types.intp, size) for size in field.shape])


# 6. The compiler compares its flags whenever it looks up a function, and makes a dictionary of all of them by one call each,
# in a tenth of the time of compiling. This one is equal.
def flag_values(self: Any) -> dict[str, Any]:
    """All flags with their values, the defaults where none is set."""
    values = self._values
    return {name: values.get(name, option.default) for name, option in self.options.items()}


targetconfig.TargetConfig.values = flag_values

# 7. A place in a source file is never changed, and need not be copied with what stands there.
numba_ir.Loc.__deepcopy__ = lambda self, memo: self


# 8. Where a law is written into a loop, the compiler copies all variables of the law with each of its blocks, one attribute
# after another, in half of the time that it takes to write laws into the loop of rims. This is the same copy.
def copied_scope(self: Any, memo: dict[int, Any]) -> Any:
    """A copy of the variables of a function, in which they belong to the copy."""
    memo[id(self)] = scope = numba_ir.Scope(copy.deepcopy(self.parent, memo), self.loc)
    for name, variable in self.localvars._con.items():
        memo[id(variable)] = own = numba_ir.Var(scope, variable.name, variable.loc)
        scope.localvars.define(name, own)
    scope.redefined.update(self.redefined)
    scope.var_redefinitions.update({name: set(all_of_it) for name, all_of_it in self.var_redefinitions.items()})
    return scope


numba_ir.Scope.__deepcopy__ = copied_scope
