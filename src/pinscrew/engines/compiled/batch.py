"""The same questions about a million configurations: compiled for the robot, many at a time.

The product of exponentials becomes a program of vector instructions in which the robot's constants are folded and
every lane of a register is a configuration (see `pinscrew.engines.compiled`). What is left to pay for is memory:
results are written once, past the cache if they are many, into arrays that the caller can give and use again.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any, Final, TypeAlias, TypeVar, cast

import numpy as np
from numpy.typing import NDArray

from pinscrew.engines.answers import Bound
from pinscrew.engines.compiled import can_compile, say_slow
from pinscrew.engines.compiled.chain import LARGEST_ANGLE, Part, Question, chain_to
from pinscrew.engines.compiled.flat import in_fewer_directions
from pinscrew.engines.compiled.outputs import Results, outputs, thread_count
from pinscrew.engines.poe import PoE
from pinscrew.ground.errors import InputError
from pinscrew.ground.typing import ArrayLike, FloatArray, JacobianKind, KindLike, jacobian_kind
from pinscrew.robot.loading import RobotLike

if TYPE_CHECKING:
    from pinscrew.engines.compiled.kernel import Kernel

__all__ = ["Batch", "Frames", "for_many"]

_S = TypeVar("_S")
Frames: TypeAlias = str | Sequence[str] | None
"""A frame's name, several, or None for the tip."""

BLOCK: Final = 2048
"""Configurations of a block of `Batch.reduce`: its results stay in the cache."""
MOST_NUMBERS: Final = 2**13
"""Numbers about each configuration up to which a kernel is compiled; it then takes 1 MB of the stack. Compiling more
takes longer than numpy does for what fits in memory."""


class Batch(PoE):
    """The product of exponentials, compiled: for many configurations at once.

    It is an `Engine` like the others. Beside that, ``frame`` may be several names, which gives a frame axis F before
    the last two; ``out`` takes arrays to write to; and float32 coordinates, or float32 arrays to write to, give
    float32 results (computed in double precision all the same). Frames that a planar or floating joint moves are
    computed with numpy, and so are questions with more than `MOST_NUMBERS` numbers to a configuration, and everything
    where llvmlite is not installed (extra ``fast``).

    A call that raises may have written to ``out`` already.
    """

    name = "Batch"

    def __init__(self, robot: RobotLike, *, threads: int | None = None) -> None:
        """Take the screws and home poses of ``robot``.

        Args:
            robot: a robot, or a name or path that `load` takes.
            threads: how many to use; by default as many as the process may use cores.

        Raises:
            InputError: if ``threads`` is below 1 or more than there are cores.
        """
        super().__init__(robot)
        self._threads, self._asked_threads = thread_count(threads), threads
        self._kernels: dict[tuple[Any, ...], Kernel | None] = {}
        self._largest = max((abs(motion.multiplier) for motion in self._robot.mechanism.motions), default=1.0)
        if not can_compile():
            say_slow()

    def __reduce__(self) -> tuple[Any, ...]:
        return partial(type(self), threads=self._asked_threads), (self._robot,)

    def fk(
        self, q: ArrayLike, frame: Frames = None, *, out: Results | None = None, threads: int | None = None
    ) -> FloatArray:
        """Pose of ``frame`` in the base: see `Engine.fk`.

        Args:
            q: coordinates, shape (..., nq), rad and m.
            frame: a link's name, several, or None for the tip.
            out: where to write: shape (..., 4, 4), or (..., F, 4, 4) for several frames; C-contiguous.
            threads: how many to use; by default those of the constructor.

        Returns:
            T_base_frame, shape (..., [F,] 4, 4): ``out`` if given.

        Raises:
            InputError: if ``q`` or ``out`` has another shape or type, ``q`` holds what is no finite number, there
                is not enough memory, or ``threads`` is out of range.
            UnknownNameError, AmbiguousTipError: see `Robot.frame`.
        """
        (poses,) = self._answer(q, frame, Question(poses=True), [out], threads)
        return poses

    def jacobian(
        self,
        q: ArrayLike,
        frame: Frames,
        kind: KindLike,
        *,
        out: Results | None = None,
        threads: int | None = None,
    ) -> FloatArray:
        """Jacobian of ``frame``: see `Engine.jacobian`, and `fk` for the arguments.

        Returns:
            shape (..., [F,] 6, nv): ``out`` if given.
        """
        (jacobians,) = self._answer(q, frame, Question(kind=jacobian_kind(kind)), [out], threads)
        return jacobians

    def fk_jacobian(
        self,
        q: ArrayLike,
        frame: Frames,
        kind: KindLike,
        *,
        out: tuple[Results, Results] | None = None,
        threads: int | None = None,
    ) -> tuple[FloatArray, FloatArray]:
        """Pose and Jacobian of ``frame`` in one pass; see `fk` for the arguments.

        Returns:
            shapes (..., [F,] 4, 4) and (..., [F,] 6, nv): those of ``out`` if given.
        """
        given = [None, None] if out is None else list(out)
        poses, jacobians = self._answer(q, frame, Question(poses=True, kind=jacobian_kind(kind)), given, threads)
        return poses, jacobians

    def manipulability(
        self,
        q: ArrayLike,
        frame: Frames = None,
        part: Part = "translation",
        *,
        out: Results | None = None,
        threads: int | None = None,
    ) -> FloatArray:
        """Yoshikawa's measure of the position or of the rotation; see `pinscrew.engines.measures`.

        The Jacobian is never stored, but where the arm can't move in as many directions as it has rows and joints.

        Args:
            q: coordinates, shape (..., nq), rad and m.
            frame: a link's name, several, or None for the tip.
            part: ``"translation"`` or ``"rotation"``; ``"all"`` six rows, √det(JᵀJ) or √det(JJᵀ), mixes m and rad.
            out: where to write.
            threads: see `fk`.

        Returns:
            shape (..., [F]).
        """
        if part not in ("all", "translation", "rotation"):
            raise InputError("part", f"part={part!r}", remedy="use 'all', 'translation' or 'rotation'")
        (measures,) = self._answer(q, frame, Question(part=part), [out], threads)
        return measures if part == "all" else in_fewer_directions(self, q, frame, part, measures)

    def reduce(
        self,
        q: ArrayLike,
        frame: Frames,
        kind: KindLike,
        function: Callable[[_S, slice, FloatArray, FloatArray], _S],
        initial: _S,
    ) -> _S:
        """Fold poses and Jacobians into something smaller, block by block, while they are in the cache.

        Args:
            q: coordinates, shape (N, nq), rad and m.
            frame, kind: see `fk_jacobian`.
            function: takes the state, the rows of ``q`` and their poses and Jacobians, and returns the next state.
                The arrays are written over for the next block: copy what is to be kept.
            initial: the first state.

        Returns:
            the last state.

        Raises:
            InputError, UnknownNameError, AmbiguousTipError: see `fk`.
        """
        numbers = self._numbers(q)
        if numbers.ndim != 2:
            what = f"q has the batch axes {numbers.shape[:-1]}"
            raise InputError("shape", what, where=self._robot.name, remedy="give one axis of N configurations")
        self._refuse_not_finite(numbers, "q", self._robot.coordinate_names)  # blocks would count their own rows
        state, out = initial, self.fk_jacobian(numbers[:BLOCK], frame, kind, threads=1)
        for start in range(0, len(numbers), BLOCK):
            rows = slice(start, min(start + BLOCK, len(numbers)))
            T, J = out[0][: rows.stop - start], out[1][: rows.stop - start]
            self.fk_jacobian(numbers[rows], frame, kind, out=(T, J), threads=1)
            state = function(state, rows, T, J)
        return state

    def _poses(self, q: FloatArray, frame: str) -> FloatArray:
        return self.fk(q, frame)

    def _jacobians(self, q: FloatArray, frame: str, kind: JacobianKind) -> FloatArray:
        return self.jacobian(q, frame, kind)

    def _bound(self, frame: str, kind: JacobianKind, rest: Bound) -> Bound:
        chain = chain_to(self._robot, frame)
        if chain is not None and can_compile() and self._robot.nv:
            from pinscrew.engines.compiled.single import short_way

            return short_way(chain, kind, self._robot, rest)
        return rest

    def _numbers(self, q: ArrayLike) -> NDArray[Any]:
        """``q`` as a contiguous array of float32 or float64, not yet known to be finite."""
        array = self._shaped(q, "q", self._robot.nq, self._robot.coordinate_names)
        return np.ascontiguousarray(array, np.float32 if array.dtype == np.float32 else np.float64)

    def _answer(
        self,
        q: ArrayLike,
        frame: Frames,
        question: Question,
        given: Sequence[Results | None],
        threads: int | None,
    ) -> list[FloatArray]:
        """The parts of the answer, in the order of `Question`."""
        one = isinstance(frame, str) or not isinstance(frame, Iterable)
        names = tuple(self._robot.frame(name) for name in cast("Sequence[str | None]", [frame] if one else frame))
        if not names:
            raise InputError("frames", "there are no frames to compute", remedy="name one or more")
        count = self._threads if threads is None else thread_count(threads)
        numbers = self._numbers(q)
        batch, ends = numbers.shape[:-1], question.shapes(self._robot.nv)
        start = batch if one else (*batch, len(names))
        shapes = [(*start, *end) for end in ends]
        results = outputs(given, shapes, numbers, self._robot.name)
        flat_q = numbers.reshape(length := math.prod(batch), self._robot.nq)
        flat = [array.reshape(length, len(names), *end) for array, end in zip(results, ends, strict=True)]
        kernel = self._kernel(names, question, numbers.dtype == np.float32, flat[0].dtype == np.float32)
        if kernel is None or not kernel.run(flat_q, flat, count):
            self._refuse_not_finite(numbers, "q", self._robot.coordinate_names)
            self._fill_with_numpy(flat, flat_q, names, question, everything=kernel is None)
        return [cast("FloatArray", array) for array in results]

    def _kernel(self, names: tuple[str, ...], question: Question, *single: bool) -> Kernel | None:
        """The kernel for a question, or None if numpy has to answer it."""
        key = names, question, single
        if key not in self._kernels:
            kernel = None
            chains = [chain_to(self._robot, name) for name in names]
            known, robot = [chain for chain in chains if chain is not None], self._robot
            few = len(names) * sum(map(math.prod, question.shapes(robot.nv))) <= MOST_NUMBERS
            if can_compile() and robot.nv and few and len(known) == len(chains):
                from pinscrew.engines.compiled.rows import compile_kernel

                kernel = compile_kernel(known, question, robot.nq, robot.nv, (single[0], single[1]))
            self._kernels[key] = kernel  # only now: another thread may be waiting for it, or compile the same
        return self._kernels[key]

    def _fill_with_numpy(
        self,
        results: Sequence[Results],
        q: NDArray[Any],
        names: tuple[str, ...],
        question: Question,
        *,
        everything: bool,
    ) -> None:
        """Compute flat results (N, F, …) by the parent class: all, or where angles are too large for a kernel."""
        most = LARGEST_ANGLE / max(1.0, self._largest)
        wanted = np.arange(len(q)) if everything else np.flatnonzero((abs(q) > most).any(axis=1))
        for start in range(0, len(wanted), BLOCK):
            rows = wanted[start : start + BLOCK]
            block, _ = self._coordinates(q[rows])
            for i, name in enumerate(names):
                parts: list[FloatArray] = []
                if question.poses and question.kind is not None:
                    parts += super()._poses_and_jacobians(block, name, question.kind)
                elif question.poses:
                    parts.append(super()._poses(block, name))
                elif question.kind is not None:
                    parts.append(super()._jacobians(block, name, question.kind))
                if question.part is not None:
                    J = super()._jacobians(block, name, "body")
                    parts.append(self._measure(J, name, question.part))
                for array, part in zip(results, parts, strict=True):
                    array[rows, i] = part

    def _measure(self, J: FloatArray, name: str, part: Part) -> FloatArray:
        """Manipulabilities (N,) from Jacobians (N, 6, nv)."""
        motions = [self._robot.mechanism.motions[index] for index in self._robot.motions_above(name)]
        moving = sorted({i for motion in motions for i in range(motion.velocities.start, motion.velocities.stop)})
        rows = {"all": slice(0, 6), "translation": slice(0, 3), "rotation": slice(3, 6)}[part]
        measure: FloatArray = np.linalg.svd(J[:, rows][:, :, moving], compute_uv=False).prod(axis=-1)
        return measure if moving else np.zeros(len(J))


def for_many(robot: RobotLike, threads: int | None = None) -> PoE:
    """The fastest engine for many configurations: `Batch`, or `PoE` where nothing can be compiled."""
    return Batch(robot, threads=threads) if can_compile() else PoE(robot)
