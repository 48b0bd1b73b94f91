"""One configuration at a time: the same arithmetic with a single lane, called with buffers that stay where they are.

What a call from Python costs is the way there and back: finding the addresses of arrays takes longer than a Panda's
pose and Jacobian. So each thread has a buffer for coordinates and two for results, whose addresses are found once.
Nobody else gets these: what is returned is a copy, and outlives them, the engine and the thread.
"""

from __future__ import annotations

import ctypes
import math
import threading
from typing import Any, Final

import numpy as np
from llvmlite import ir

from pinscrew.engines.answers import Bound
from pinscrew.engines.asking import Answer, written
from pinscrew.engines.compiled.chain import Chain, Question
from pinscrew.engines.compiled.lanes import Lanes, double, integer
from pinscrew.engines.compiled.machine import Compiled
from pinscrew.engines.compiled.rows import rows_of
from pinscrew.ground.typing import ArrayLike, JacobianKind
from pinscrew.robot.robot import Robot

__all__ = ["short_way"]

_pointer: Final = ir.PointerType()
_one_lane: Final = ir.VectorType(double, 1)
_DOUBLE: Final = np.dtype(np.float64)


def short_way(chain: Chain, kind: JacobianKind, robot: Robot, rest: Bound) -> Bound:
    """The pose and Jacobian at the end of a chain; to ``rest`` goes what is no float64 array of moderate numbers."""
    nq, nv = robot.nq, robot.nv
    compiled = _compile(chain, Question(poses=True, kind=kind), nq, nv)
    shape, local = (nq,), _Buffers(nq, nv)

    def ask(q: ArrayLike, *, out: Answer | None = None, call: Any = compiled.call, _kept: Any = compiled) -> Answer:
        try:
            if q.dtype is not _DOUBLE or q.shape != shape:  # type: ignore[union-attr]
                return rest(q, out=out)
        except AttributeError:  # no array
            return rest(q, out=out)
        coordinates, pose, J, addresses = local.buffers
        coordinates[:] = q
        # The interpreter's lock is held meanwhile: to let it go takes longer than the call.
        if call(addresses):
            return rest(q, out=out)
        return (pose.copy(), J.copy()) if out is None else written((pose, J), out)

    return ask


class _Buffers(threading.local):
    """Where a thread's coordinates and results are: the arrays, and where their addresses stand."""

    def __init__(self, nq: int, nv: int) -> None:
        arrays = np.zeros(nq), np.zeros((4, 4)), np.zeros((6, nv))
        self._kept = np.array([array.ctypes.data for array in arrays], np.uintp)
        self.buffers = (*arrays, self._kept.ctypes.data)


def _compile(chain: Chain, question: Question, nq: int, nv: int) -> Compiled:
    """From where the addresses of q, T and J stand to 0, or another number if the coordinates were not good."""
    module = ir.Module("pinscrew")
    function = ir.Function(module, ir.FunctionType(integer, [_pointer]), "single")
    build = ir.IRBuilder(function.append_basic_block("entry"))
    places = [build.gep(function.args[0], [integer(i)], source_etype=_pointer) for i in range(3)]
    source, *targets = (build.load(place, typ=_pointer) for place in places)
    coordinates = [Lanes(build, build.load(_at(build, source, i), typ=_one_lane, align=8)) for i in range(nq)]
    rows, good = rows_of([chain], question, nv)(coordinates)
    for row, target, shape in zip(rows, targets, question.shapes(nv), strict=True):
        for i, number in zip(range(math.prod(shape)), row, strict=True):
            value = number.value if isinstance(number, Lanes) else ir.Constant(_one_lane, [float(number)])
            build.store(value, _at(build, target, i), align=8)
    all_good = good[0]
    for bits in good[1:]:
        all_good = build.and_(all_good, bits)
    bad = build.not_(build.extract_element(all_good, ir.IntType(32)(0)))
    build.ret(build.zext(bad, integer))
    return Compiled(module, "single", ctypes.PYFUNCTYPE(ctypes.c_int64, ctypes.c_void_p))


def _at(build: ir.IRBuilder, place: ir.Value, index: int) -> ir.Value:
    return build.gep(place, [integer(index)], source_etype=double)
