"""The page of `identify` works as it says."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

import pinscrew as ps
from command_line import ok

PAGE = (Path(__file__).parents[2] / "docs" / "identify.md").read_text(encoding="utf-8")


def test_the_page(tmp_path: Path) -> None:
    printed: list[str] = []
    scope: dict[str, object] = {"print": lambda each: printed.append(str(each))}
    code = "".join(re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL))
    exec(code, scope)  # noqa: S102 (the page's own code)
    said = re.findall(r"^print\(.*\)  # (.*)$", code, re.MULTILINE)
    assert len(said) == len(printed) == 9
    for line, claimed in zip(printed, said, strict=True):
        assert line == claimed or (claimed.endswith(" …") and line.startswith(claimed[:-2])), claimed
    assert np.allclose(np.asarray(scope["ours"]), np.asarray(scope["J"]), atol=1e-12)
    table, archive = tmp_path / "J.csv", tmp_path / "samples.npz"
    q = [0.3, -1.0, 0.5, 0.2, 0.4, 0.1]
    np.savetxt(table, ps.Pinocchio(ps.load("ur5_robot")).jacobian(q, "tool0", "body"))
    np.savez(archive, q=np.asarray(scope["q"]), J=np.asarray(scope["theirs"]))
    screws = tmp_path / "S.csv"
    np.savetxt(screws, ps.load("ur5_robot").screws("tool0")[[3, 4, 5, 0, 1, 2]])
    for command in re.findall(r"^\$ pinscrew (.*)$", PAGE, re.MULTILINE):
        words = (
            command.replace("J.csv", str(table))
            .replace("Slist.csv", str(screws))
            .replace("samples.npz", str(archive))
            .split()
        )
        assert ok(*words).out
