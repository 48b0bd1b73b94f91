"""The Python of the pages on derivations runs, and what it asserts holds."""

import re
from pathlib import Path
from typing import Any

import pytest

DOCS = Path(__file__).resolve().parents[2] / "docs"
BLOCKS = re.findall(r"```python\n(.*?)```", (DOCS / "derivations.md").read_text(encoding="utf-8"), re.DOTALL)


@pytest.mark.parametrize("block", BLOCKS)
def test_python_of_derivations(block: str) -> None:
    module: dict[str, Any] = {}
    exec(block, module)  # noqa: S102 (our own)
    assert "d" in module


def test_a_wrong_step_is_found() -> None:
    by_hand = BLOCKS[1].replace("[0, -L0, 0, -1, 0, 0]", "[0, L0, 0, -1, 0, 0]")
    assert by_hand != BLOCKS[1]
    with pytest.raises(AssertionError):
        exec(by_hand, {})  # noqa: S102
