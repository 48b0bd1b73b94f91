"""Numbers of a compiled function: a vector with one lane for each configuration, whose arithmetic emits instructions.

Python's floats are the constants. What a constant makes superfluous (0·x, 1·x, x + 0) is never emitted, so a robot
whose axes are parallel or square to each other costs less. Multiplications and additions may contract to fused ones;
no other liberty is taken with floating-point arithmetic, since the range reduction of `turn` would not survive it.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence
from typing import Any, Final

from llvmlite import ir

__all__ = ["Lanes", "double", "integer", "intrinsic"]

double: Final = ir.DoubleType()
integer: Final = ir.IntType(64)

_FLAGS: Final = ("contract", "nsz", "arcp")

# sin and cos on [-π/4, π/4], to 2⁻⁵⁸: the coefficients of FreeBSD's msun (k_sin.c and k_cos.c, Sun Microsystems 1993).
_SIN: Final = (
    -1.66666666666666324348e-01,
    8.33333333332248946124e-03,
    -1.98412698298579493134e-04,
    2.75573137070700676789e-06,
    -2.50507602534068634195e-08,
    1.58969099521155010221e-10,
)
_COS: Final = (
    4.16666666666666019037e-02,
    -1.38888888888741095749e-03,
    2.48015872894767294178e-05,
    -2.75573143513906633035e-07,
    2.08757232129817482790e-09,
    -1.13596475577881948265e-11,
)
# π/2 in two parts (Cody and Waite 1980); with fused multiply-add the product of the first with a quadrant is exact.
_HALF_PI: Final = (math.pi / 2.0, 6.123233995736766e-17)
_ROUNDING: Final = 1.5 * 2.0**52
"""Added to a number, this leaves its nearest integer in the last bits."""


class Lanes:
    """A number per lane. Arithmetic with floats and other lanes emits instructions where the builder stands."""

    __slots__ = ("build", "value")

    def __init__(self, build: ir.IRBuilder, value: ir.Value) -> None:
        self.build = build
        self.value = value

    def constant(self, number: float) -> ir.Constant:
        """The vector with this number in each lane."""
        return ir.Constant(self.value.type, [number] * self.value.type.count)

    def _make(self, value: ir.Value) -> Lanes:
        return Lanes(self.build, value)

    def _of(self, other: Lanes | float) -> ir.Value:
        return other.value if isinstance(other, Lanes) else self.constant(float(other))

    def __add__(self, other: Lanes | float) -> Lanes:
        if not isinstance(other, Lanes) and other == 0.0:
            return self
        return self._make(self.build.fadd(self.value, self._of(other), flags=_FLAGS))

    __radd__ = __add__

    def __sub__(self, other: Lanes | float) -> Lanes:
        if not isinstance(other, Lanes) and other == 0.0:
            return self
        return self._make(self.build.fsub(self.value, self._of(other), flags=_FLAGS))

    def __rsub__(self, other: float) -> Lanes:
        if other == 0.0:
            return -self
        return self._make(self.build.fsub(self.constant(other), self.value, flags=_FLAGS))

    def __mul__(self, other: Lanes | float) -> Lanes | float:
        if not isinstance(other, Lanes):
            if other == 0.0:
                return 0.0
            if other == 1.0:
                return self
            if other == -1.0:
                return -self
        return self._make(self.build.fmul(self.value, self._of(other), flags=_FLAGS))

    __rmul__ = __mul__

    def __neg__(self) -> Lanes:
        return self._make(self.build.fneg(self.value, flags=_FLAGS))

    def reciprocal(self, other: Lanes | float) -> Lanes | float:
        """1 / other, or 0 where it is below the normal numbers, whose reciprocals are all finite."""
        if not isinstance(other, Lanes):
            return 1.0 / other if other >= sys.float_info.min else 0.0
        inverse = self.build.fdiv(self.constant(1.0), other.value, flags=_FLAGS)
        normal = self.build.fcmp_ordered(">=", other.value, self.constant(sys.float_info.min))
        return self._make(self.build.select(normal, inverse, self.constant(0.0)))

    def root(self) -> Lanes:
        """The square root."""
        return self._make(self._call("sqrt", self.value))

    def within(self, limit: float) -> ir.Value:
        """In which lanes the absolute value is at most ``limit``; not where it is NaN."""
        return self.build.fcmp_ordered("<=", self._call("fabs", self.value), self.constant(limit))

    def turn(self) -> tuple[Lanes, Lanes]:
        """Cosine and sine, to about 1 ulp of 1 for angles up to `chain.LARGEST_ANGLE`."""
        build = self.build
        bits = ir.VectorType(integer, self.value.type.count)
        shifted = self._call("fma", self.value, self.constant(2.0 / math.pi), self.constant(_ROUNDING))
        quadrant = build.fsub(shifted, self.constant(_ROUNDING))
        rest = self.value
        for part in _HALF_PI:
            rest = self._call("fma", quadrant, self.constant(-part), rest)
        r = self._make(rest)
        square = self._make(build.fmul(rest, rest))
        sine = r + r * (square * _polynomial(square, _SIN))
        cosine = (1.0 - 0.5 * square) + square * (square * _polynomial(square, _COS))
        # The last two bits say in which quadrant the angle is: odd ones exchange sine and cosine.
        number = build.bitcast(shifted, bits)
        one, two = (ir.Constant(bits, [n] * bits.count) for n in (1, 2))
        odd = build.icmp_unsigned("!=", build.and_(number, one), ir.Constant(bits, [0] * bits.count))
        sine_value, cosine_value = (
            build.select(odd, cosine.value, sine.value),
            build.select(odd, sine.value, cosine.value),
        )
        return self._signed(cosine_value, build.and_(build.add(number, one), two)), self._signed(
            sine_value, build.and_(number, two)
        )

    def _signed(self, value: ir.Value, second_bit: ir.Value) -> Lanes:
        """The value, negative where that bit is set."""
        build, bits = self.build, second_bit.type
        sign = build.shl(second_bit, ir.Constant(bits, [62] * bits.count))
        return self._make(build.bitcast(build.xor(build.bitcast(value, bits), sign), value.type))

    def _call(self, name: str, *arguments: ir.Value) -> ir.Value:
        kind = self.value.type
        return self.build.call(
            intrinsic(self.build, f"{name}.v{kind.count}f64", kind, [kind] * len(arguments)), arguments
        )


def intrinsic(build: ir.IRBuilder, name: str, result: ir.Type, arguments: Sequence[ir.Type]) -> ir.Function:
    """A function that LLVM knows, declared once in the module."""
    full = f"llvm.{name}"
    known = build.module.globals.get(full)
    return known or ir.Function(build.module, ir.FunctionType(result, arguments), full)


def _polynomial(x: Any, coefficients: Sequence[float]) -> Any:
    """By Horner's rule, the constant term first."""
    total: Any = coefficients[-1]
    for coefficient in reversed(coefficients[:-1]):
        total = coefficient + x * total
    return total
