"""Branches that the types of records decide: what is not in a structure is not compiled.

Records tell by their types what there is: ``if e.d.shape[0] > 1`` asks whether a joint has dashpots, ``u.px.shape[0] > 1``
whether a body has corners. The compiler types and translates both branches, with all that they call, and its optimiser then
removes one. Here that one is left out as soon as laws are written into the loop, before it is typed.
"""

from __future__ import annotations

import operator
from typing import Any

from numba.core import ir, types
from numba.core.analysis import compute_cfg_from_blocks
from numba.core.compiler import CompilerBase, DefaultPassBuilder
from numba.core.compiler_machinery import FunctionPass, register_pass
from numba.core.ir_utils import build_definitions
from numba.core.postproc import PostProcessor
from numba.core.untyped_passes import InlineInlinables

#: What is computed of numbers that are known.
OPERATIONS = {
    operator.lt, operator.le, operator.gt, operator.ge, operator.eq, operator.ne,
    operator.add, operator.sub, operator.mul,
}  # fmt: skip


class Constant:
    """A number, a truth or a shape that the types alone decide."""

    def __init__(self, value: Any) -> None:
        self.value = value


class Known:
    """What is known of the variables of a function before it is typed: a :class:`Constant`, a type, or nothing (None).

    Parameters
    ----------
    func_ir : numba.core.ir.FunctionIR
    args : sequence of numba types
        Of its arguments.
    """

    def __init__(self, func_ir: Any, args: Any) -> None:
        self._definitions, self._args = build_definitions(func_ir.blocks), args
        self._found: dict[str, Any] = {}

    def of(self, variable: Any) -> Any:
        """What is known of a variable; of one that is written at several places nothing."""
        name = variable.name
        if name not in self._found:
            self._found[name] = None  # of what is defined by itself
            definitions = self._definitions[name]
            if len(definitions) == 1:
                self._found[name] = self._value(definitions[0])
        return self._found[name]

    def _value(self, node: Any) -> Any:
        if isinstance(node, ir.Arg):
            kind = self._args[node.index]
            return Constant(kind.literal_value) if isinstance(kind, types.IntegerLiteral) else kind
        if isinstance(node, ir.Var):
            return self.of(node)
        if isinstance(node, (ir.Const, ir.Global, ir.FreeVar)):
            return Constant(node.value) if isinstance(node.value, (bool, int)) else None
        if isinstance(node, ir.Expr):
            return getattr(self, f"_{node.op}", lambda _: None)(node)
        return None

    def _cast(self, node: Any) -> Any:
        return self.of(node.value)

    _exhaust_iter = _cast  # a tuple that is unpacked

    def _getattr(self, node: Any) -> Any:
        kind = self.of(node.value)
        if isinstance(kind, types.Record) and node.attr in kind.fields:
            return kind.typeof(node.attr)
        if isinstance(kind, types.NestedArray) and node.attr == "shape":
            return Constant(kind.shape)
        return None

    def _static_getitem(self, node: Any) -> Any:
        return self._item(self.of(node.value), node.index if isinstance(node.index, int) else None)

    def _getitem(self, node: Any) -> Any:
        index = self.of(node.index)
        if isinstance(index, Constant):
            return self._item(self.of(node.value), index.value)
        return self._item(self.of(node.value), None) if self._is_number(node.index) else None

    def _item(self, kind: Any, index: int | None) -> Any:
        if isinstance(kind, Constant) and isinstance(kind.value, tuple) and index is not None:
            return Constant(kind.value[index])
        if isinstance(kind, types.BaseTuple) and index is not None:
            return kind[index]
        if type(kind) is types.Array and kind.ndim == 1 and isinstance(kind.dtype, types.Record):
            return kind.dtype
        return None

    def _is_number(self, variable: Any) -> bool:
        """Whether an index is certainly a number, and not a slice: of a loop, of a record, or reckoned."""
        definitions = self._definitions[variable.name]
        if len(definitions) != 1:
            return False
        node = definitions[0]
        if isinstance(node, ir.Var):
            return self._is_number(node)
        if not isinstance(node, ir.Expr):
            return isinstance(self._value(node), types.Integer)
        if node.op == "cast":
            return self._is_number(node.value)
        return node.op in ("pair_first", "binop") or isinstance(self._value(node), types.Integer)

    def _binop(self, node: Any) -> Any:
        left, right = self.of(node.lhs), self.of(node.rhs)
        if isinstance(left, Constant) and isinstance(right, Constant) and node.fn in OPERATIONS:
            return Constant(node.fn(left.value, right.value))
        return None

    def _unary(self, node: Any) -> Any:
        value = self.of(node.value)
        return Constant(not value.value) if node.fn is operator.not_ and isinstance(value, Constant) else None

    def _call(self, node: Any) -> Any:
        function = self._definitions[node.func.name]
        if len(function) == 1 and isinstance(function[0], ir.Global) and function[0].value is bool:
            value = self.of(node.args[0])
            return Constant(bool(value.value)) if isinstance(value, Constant) else None
        return None


@register_pass(mutates_CFG=True, analysis_only=False)
class KnownBranches(FunctionPass):
    """Leaves out what the types of the arguments rule out."""

    _name = "known_branches"

    def __init__(self) -> None:
        FunctionPass.__init__(self)

    def run_pass(self, state: Any) -> bool:
        """Whether something is left out."""
        func_ir = state.func_ir
        known, decided = Known(func_ir, state.args), False
        for block in func_ir.blocks.values():
            branch = block.body[-1]
            if isinstance(branch, ir.Branch) and isinstance(value := known.of(branch.cond), Constant):
                block.body[-1] = ir.Jump(branch.truebr if value.value else branch.falsebr, loc=branch.loc)
                decided = True
        if decided:
            for dead in compute_cfg_from_blocks(func_ir.blocks).dead_nodes():
                del func_ir.blocks[dead]
            func_ir._definitions = build_definitions(func_ir.blocks)
            PostProcessor(func_ir).run()
        return decided


class KernelCompiler(CompilerBase):
    """The compiler's own passes, with :class:`KnownBranches` between writing laws into a loop and typing it."""

    def define_pipelines(self) -> list[Any]:
        """All passes."""
        passes = DefaultPassBuilder.define_nopython_pipeline(self.state)
        passes.add_pass_after(KnownBranches, InlineInlinables)
        passes.finalize()
        return [passes]
