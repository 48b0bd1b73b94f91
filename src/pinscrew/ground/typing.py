"""Types shared by all layers: float arrays and the three Jacobian kinds.

==========  ===========================  =======================
kind        Murray–Li–Sastry             Pinocchio
==========  ===========================  =======================
spatial     spatial Jacobian, eq. 3.54   ``WORLD``
body        body Jacobian, eq. 3.56      ``LOCAL``
hybrid      ``diag(R, R) @ body``        ``LOCAL_WORLD_ALIGNED``
==========  ===========================  =======================
"""

from __future__ import annotations

from typing import Any, Final, Literal, Protocol, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pinscrew.ground.errors import InputError

__all__ = ["KINDS", "ArrayLike", "FloatArray", "JacobianKind", "KindLike", "jacobian_kind"]

FloatArray: TypeAlias = NDArray[np.float64]
"""A float64 array; the docstring of whoever takes or returns it gives the shape."""

JacobianKind: TypeAlias = Literal["spatial", "body", "hybrid"]

KINDS: Final[tuple[JacobianKind, ...]] = ("spatial", "body", "hybrid")


class _Named(Protocol):
    """An enum member, such as ``pinocchio.ReferenceFrame.LOCAL``; any object with its ``name`` will do."""

    @property
    def name(self) -> Any: ...


KindLike: TypeAlias = str | _Named
"""A `JacobianKind`, Pinocchio's name for it, or a member of ``pinocchio.ReferenceFrame``."""

_NAMES_IN_PINOCCHIO: Final[dict[JacobianKind, str]] = {
    "spatial": "WORLD",
    "body": "LOCAL",
    "hybrid": "LOCAL_WORLD_ALIGNED",
}


def jacobian_kind(kind: KindLike) -> JacobianKind:
    """The Jacobian kind that a name of ours, a name of Pinocchio's or its enum member stands for.

    Raises:
        InputError: if ``kind`` names no Jacobian.
    """
    name = kind if isinstance(kind, str) else getattr(kind, "name", None)
    for known in KINDS:
        if isinstance(name, str) and name in (known, _NAMES_IN_PINOCCHIO[known]):
            return known
    raise InputError(
        "jacobian-kind",
        f"{kind!r} is not a kind of Jacobian",
        remedy="use 'spatial' (Pinocchio's WORLD), 'body' (LOCAL) or 'hybrid' (LOCAL_WORLD_ALIGNED)",
    )
