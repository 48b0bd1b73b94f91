"""The loop around the arithmetic: coordinates in, rows of results out, past the cache if they are many.

Configurations are taken `CHUNK` at a time and as many as a vector has lanes at once. Results come out of the
arithmetic lane by lane, but belong in memory configuration by configuration: they are transposed into a scratch
that stays in the first-level cache, and copied from there a cache line at a time. Large results are copied by
non-temporal stores, which do not read a line before they overwrite it; these want whole aligned lines, so what
begins before the first or ends after the last of them is stored by number.
"""

from __future__ import annotations

import ctypes
import os
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from functools import lru_cache
from typing import Any, Final, TypeAlias

import numpy as np
from llvmlite import ir
from numpy.typing import NDArray

from pinscrew.engines.compiled.lanes import Lanes, double, integer, intrinsic
from pinscrew.engines.compiled.machine import Compiled, lanes
from pinscrew.engines.compiled.walk import LaneNumber

__all__ = ["CHUNK", "Kernel", "Rows"]

CHUNK: Final = 16
"""Configurations from one copy to memory to the next; rows of so many doubles or floats are whole cache lines."""
SLICE: Final = 2048
"""Configurations that a thread takes at a time; a multiple of `CHUNK`."""
STREAMED: Final = 2**24
"""Bytes of results from which they are written past the cache, which would not hold them."""
LINE: Final = 64
"""Bytes of a cache line."""

Rows: TypeAlias = Callable[[list[Lanes]], tuple[Sequence[Sequence[LaneNumber]], list[ir.Value]]]
"""From coordinates to one row of numbers per output, and vectors of bits that are all set if the input was good."""

_pointer: Final = ir.PointerType()
_line: Final = ir.VectorType(integer, LINE // 8)


class Kernel:
    """A compiled function from coordinates (N, nq) to rows of numbers, for each configuration on its own."""

    def __init__(self, nq: int, rows: Rows, lengths: Sequence[int], single: tuple[bool, bool]) -> None:
        """Compile.

        Args:
            nq: coordinates of a configuration.
            rows: the arithmetic.
            lengths: of the rows that it gives.
            single: whether coordinates, and whether results, are float32.
        """
        module = ir.Module("pinscrew")
        signature = ir.FunctionType(integer, [_pointer, integer, integer, *[_pointer] * len(lengths)])
        function = ir.Function(module, signature, "kernel")
        for argument in (function.args[0], *function.args[3:]):
            argument.add_attribute("noalias")
        _Writer(function, nq, rows, *(ir.FloatType() if small else double for small in single)).write(lengths)
        prototype = ctypes.CFUNCTYPE(
            ctypes.c_int64, ctypes.c_void_p, ctypes.c_int64, ctypes.c_int64, *[ctypes.c_void_p] * len(lengths)
        )
        self._compiled = Compiled(module, "kernel", prototype)

    def run(self, q: NDArray[Any], results: Sequence[NDArray[Any]], threads: int) -> bool:
        """Compute.

        Args:
            q: coordinates (N, nq), C-contiguous and of the type compiled for.
            results: what to write to, one array for each row: C-contiguous, N rows' numbers.
            threads: how many to use at most.

        Returns:
            Whether all coordinates were good; if not, what is in ``results`` means nothing.
        """
        whole = len(q) // CHUNK * CHUNK
        stream = sum(array.nbytes for array in results) >= STREAMED
        # With the arrays themselves: whoever works holds them, so that they can't be freed under a helper's hands.
        rows = [(array, array.ctypes.data, array.strides[0]) for array in (q, *results)]
        starts = iter(range(0, whole, SLICE))
        bad = []

        def work() -> None:
            for start in starts:  # each start goes to one thread only
                source, *targets = (address + start * stride for _, address, stride in rows)
                bad.append(self._compiled.call(source, min(SLICE, whole - start), stream, *targets))

        helpers = [_pool().submit(work) for _ in range(min(threads, whole // SLICE) - 1)]
        try:
            work()
        finally:
            for _ in starts:  # what an interrupt left undone is not to be done by the helpers
                pass
            for helper in helpers:
                if not helper.cancel():  # one that has not begun finds nothing to do
                    helper.result()
        return self._rest(q[whole:], [array[whole:] for array in results]) and not any(bad)

    def _rest(self, q: NDArray[Any], results: Sequence[NDArray[Any]]) -> bool:
        """The configurations that do not fill a chunk, in one that is filled up."""
        if not len(q):
            return True
        padded = np.zeros((CHUNK, q.shape[1]), q.dtype)
        padded[: len(q)] = q
        chunks = [np.empty((CHUNK, *array.shape[1:]), array.dtype) for array in results]
        bad = self._compiled.call(padded.ctypes.data, CHUNK, False, *(chunk.ctypes.data for chunk in chunks))
        for array, chunk in zip(results, chunks, strict=True):
            array[:] = chunk[: len(q)]
        return not bad


@lru_cache(maxsize=1)
def _pool() -> ThreadPoolExecutor:
    """Threads that wait for work; starting some for each call would take as long as 5000 configurations."""
    return ThreadPoolExecutor(os.cpu_count(), "pinscrew")


os.register_at_fork(after_in_child=_pool.cache_clear)  # threads do not survive a fork


class _Writer:
    """Writes the instructions of one kernel."""

    def __init__(self, function: ir.Function, nq: int, rows: Rows, source: ir.Type, target: ir.Type) -> None:
        self.function = function
        self.build = ir.IRBuilder(function.append_basic_block("entry"))
        self.nq = nq
        self.rows = rows
        self.source, self.target = source, target
        self.width = lanes()
        self.in_line = LINE // (4 if target != double else 8)
        """Numbers in a cache line."""

    def write(self, lengths: Sequence[int]) -> None:
        """All of it."""
        build = self.build
        q, count, stream, *outputs = self.function.args
        bad_type = ir.VectorType(ir.IntType(1), self.width)
        bad = build.alloca(bad_type)
        build.store(ir.Constant(bad_type, [0] * self.width), bad)
        scratches = [self._scratch(length) for length in lengths]
        offsets = [self._offset(output) for output in outputs]
        with self._loop(count, CHUNK) as start:
            with self._loop(integer(CHUNK), self.width) as group:
                first = self.build.add(start, group)
                rows, good = self.rows(self._coordinates(q, first))
                for one in good:
                    self.build.store(self.build.or_(self.build.load(bad, typ=bad_type), self.build.not_(one)), bad)
                for row, scratch in zip(rows, scratches, strict=True):
                    place = self.build.add(integer(self.in_line), self.build.mul(group, integer(len(row))))
                    self._store_transposed(row, self._at(scratch, place))
            for length, scratch, offset, output in zip(lengths, scratches, offsets, outputs, strict=True):
                done = self.build.mul(start, integer(length))
                self._flush(scratch, offset, output, done, length, stream)
        for length, scratch, offset, output in zip(lengths, scratches, offsets, outputs, strict=True):
            end = self._at(output, self.build.sub(self.build.mul(count, integer(length)), offset))
            kept = self._at(scratch, self.build.sub(integer(self.in_line), offset))
            with self._loop(offset, 1) as i:
                self._copy(self.target, self._at(kept, i), self._at(end, i))
        self.build.fence("seq_cst")  # non-temporal stores know no other order
        reduced = intrinsic(self.build, f"vector.reduce.or.v{self.width}i1", ir.IntType(1), [bad_type])
        any_bad = self.build.call(reduced, [self.build.load(bad, typ=bad_type)])
        self.build.ret(self.build.zext(any_bad, integer))

    def _scratch(self, length: int) -> ir.Value:
        """Memory for the rows of a chunk, behind a line for what is left of the chunk before it."""
        scratch = self.build.alloca(ir.ArrayType(self.target, CHUNK * length + self.in_line))
        scratch.align = LINE
        scratch.type = _pointer  # llvmlite's own would only let an array be stored there
        return scratch

    def _offset(self, output: ir.Value) -> ir.Value:
        """How many numbers of its first cache line lie before an output."""
        size = LINE // self.in_line
        address = self.build.ptrtoint(output, integer)
        return self.build.udiv(self.build.and_(address, integer(LINE - 1)), integer(size))

    def _coordinates(self, q: ir.Value, first: ir.Value) -> list[Lanes]:
        """The coordinates of the configurations from ``first`` on, one vector for each coordinate."""
        start = self.build.gep(q, [self.build.mul(first, integer(self.nq))], source_etype=self.source)
        vectors = []
        for j in range(self.nq):
            vector: ir.Value = ir.Constant(ir.VectorType(self.source, self.width), ir.Undefined)
            for i in range(self.width):
                place = self.build.gep(start, [integer(i * self.nq + j)], source_etype=self.source)
                number = self.build.load(place, typ=self.source)
                vector = self.build.insert_element(vector, number, ir.IntType(32)(i))
            if self.source != double:
                vector = self.build.fpext(vector, ir.VectorType(double, self.width))
            vectors.append(Lanes(self.build, vector))
        return vectors

    def _store_transposed(self, row: Sequence[LaneNumber], place: ir.Value) -> None:
        """Store rows side by side, lane after lane."""
        for start in range(0, len(row), self.width):
            numbers = [self._vector(number) for number in row[start : start + self.width]]
            missing = self.width - len(numbers)
            numbers += [ir.Constant(numbers[0].type, ir.Undefined)] * missing
            for lane, vector in enumerate(self._transposed(numbers)):
                self._store_first(vector, self.width - missing, self._at(place, integer(lane * len(row) + start)))

    def _vector(self, number: LaneNumber) -> ir.Value:
        wide = ir.VectorType(double, self.width)
        value = number.value if isinstance(number, Lanes) else ir.Constant(wide, [float(number)] * self.width)
        return value if self.target == double else self.build.fptrunc(value, ir.VectorType(self.target, self.width))

    def _transposed(self, vectors: list[ir.Value]) -> list[ir.Value]:
        """The transpose of a square of numbers, by exchanging ever larger squares off its diagonal."""
        n = len(vectors)
        half = 1
        while half < n:
            keep = [i if not i & half else n + i - half for i in range(n)]
            other = [i + half if not i & half else n + i for i in range(n)]
            for i in range(n):
                if not i & half:
                    pair = vectors[i], vectors[i + half]
                    vectors[i], vectors[i + half] = self._shuffled(*pair, keep), self._shuffled(*pair, other)
            half *= 2
        return vectors

    def _shuffled(self, a: ir.Value, b: ir.Value, places: Sequence[int]) -> ir.Value:
        mask = ir.Constant(ir.VectorType(ir.IntType(32), len(places)), list(places))
        return self.build.shuffle_vector(a, b, mask)

    def _store_first(self, vector: ir.Value, count: int, place: ir.Value) -> None:
        """Store the first numbers of a vector, in powers of two."""
        size = LINE // self.in_line
        done = 0
        while done < count:
            part = 1 << ((count - done).bit_length() - 1)
            whole = part == vector.type.count
            piece = vector if whole else self._shuffled(vector, vector, range(done, done + part))
            self.build.store(piece, self._at(place, integer(done)), align=size)
            done += part

    def _flush(
        self, scratch: ir.Value, offset: ir.Value, output: ir.Value, done: ir.Value, length: int, stream: ir.Value
    ) -> None:
        """Copy the whole lines of a chunk to memory, and keep the numbers of the last line for the next chunk."""
        build = self.build
        total = CHUNK * length
        is_first = build.icmp_unsigned("==", done, integer(0))
        begins_inside = build.and_(is_first, build.icmp_unsigned("!=", offset, integer(0)))
        target = self._at(output, build.sub(done, offset))
        missing = build.sub(integer(self.in_line), offset)
        # Loads pay less for crossing lines than stores do, so it is here that rows are shifted to where lines begin.
        source = self._at(scratch, missing)
        with build.if_then(begins_inside, likely=False), self._loop(missing, 1) as i:
            at = self.build.add(offset, i)
            self._copy(self.target, self._at(source, at), self._at(target, at))
        first = build.zext(begins_inside, integer)
        lines = build.sub(integer(total // self.in_line), first)
        number = LINE // self.in_line
        with build.if_else(build.icmp_unsigned("!=", stream, integer(0))) as (then, otherwise):
            for branch, temporal in ((then, False), (otherwise, True)):
                with branch, self._loop(lines, 1) as i:
                    at = self.build.mul(self.build.add(first, i), integer(self.in_line))
                    places = self._at(source, at), self._at(target, at)
                    self._copy(_line, *places, number, LINE, temporal=temporal)
        self._copy(_line, self._at(scratch, integer(total)), scratch, LINE, LINE)

    def _copy(
        self,
        kind: ir.Type,
        source: ir.Value,
        target: ir.Value,
        source_align: int | None = None,
        target_align: int | None = None,
        *,
        temporal: bool = True,
    ) -> None:
        value = self.build.load(source, typ=kind, align=source_align)
        store = self.build.store(value, target, align=target_align)
        if not temporal:
            store.set_metadata("nontemporal", self.build.module.add_metadata([ir.IntType(32)(1)]))

    def _at(self, place: ir.Value, index: ir.Value) -> ir.Value:
        return self.build.gep(place, [index], source_etype=self.target)

    @contextmanager
    def _loop(self, end: ir.Value, step: int) -> Iterator[ir.Value]:
        """A loop from 0 to below ``end``; what is built inside is its body."""
        before = self.build.block
        head = self.build.append_basic_block()
        body = self.build.append_basic_block()
        after = self.build.append_basic_block()
        self.build.branch(head)
        self.build.position_at_end(head)
        index = self.build.phi(integer)
        index.add_incoming(integer(0), before)
        self.build.cbranch(self.build.icmp_unsigned("<", index, end), body, after)
        self.build.position_at_end(body)
        yield index
        index.add_incoming(self.build.add(index, integer(step)), self.build.block)
        self.build.branch(head)
        self.build.position_at_end(after)
