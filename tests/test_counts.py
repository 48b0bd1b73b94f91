"""Whole numbers that callers give."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from pinscrew.ground.counts import whole
from pinscrew.ground.errors import InputError


@pytest.mark.parametrize("value", [3, 3.0, np.int64(3), np.float32(3)])
def test_whole(value: Any) -> None:
    found = whole("samples", value, 1)
    assert (found, type(found)) == (3, int)
    assert whole("samples", 1e7, 1) == 10_000_000
    assert whole("seed", 10**30, 0) == 10**30


@pytest.mark.parametrize("value", [0, -1, 1.5, math.inf, math.nan, None, "3", 3j, [3]])
def test_what_is_none(value: Any) -> None:
    with pytest.raises(InputError, match=r"^arm: samples=.*; give a whole number, 1 or more$") as caught:
        whole("samples", value, 1, where="arm")
    assert caught.value.code == "samples"
