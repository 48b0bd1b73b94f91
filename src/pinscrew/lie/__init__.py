"""Lie groups of rigid motion: rotations (:mod:`so3`) and poses (:mod:`se3`), on numpy arrays and sympy matrices.

Both modules hold the same ten functions. On arrays all are batched over leading axes and return float64.

========================= ==================================== =====================================
operation                 so3                                  se3
========================= ==================================== =====================================
tangent vector            ω ``(..., 3)``, rad                  ξ = (v, ω) ``(..., 6)``, m and rad
group element             R ``(..., 3, 3)``                    T ``(..., 4, 4)``
``hat``, ``vee``          ω̂                                    [[ω̂, v], [0, 0]]
``exp``, ``log``          e^ω̂                                  e^ξ̂ = [[R, J v], [0, 1]]
``inverse``               Rᵀ                                   [[Rᵀ, −Rᵀp], [0, 1]]
``adjoint``               R                                    [[R, p̂R], [0, R]]
``ad``                    ω̂                                    [[ω̂, v̂], [0, ω̂]]
``left_jacobian``         J(ω) = Σ ω̂ⁿ/(n+1)!                   [[J, Q], [0, J]] = Σ ad_ξⁿ/(n+1)!
``left_jacobian_inverse`` J⁻¹                                  [[J⁻¹, −J⁻¹QJ⁻¹], [0, J⁻¹]]
``project``               the nearest rotation                 the nearest pose
========================= ==================================== =====================================

``hat``, ``vee``, ``exp``, ``inverse``, ``adjoint`` and ``ad`` also take a sympy matrix, with symbols or without, and
give sympy's ``ImmutableMatrix``, exactly. Vectors are columns, of shape (3, 1) or (6, 1), as
``sympy.Matrix([a, b, c])`` makes them; there are no batches. A norm ‖ω‖ that symbols leave open is taken not to be 0.
"""

from pinscrew.lie import se3, so3

__all__ = ["se3", "so3"]
