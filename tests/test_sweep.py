"""`scripts/sweep_repository.py`: what became of each file below a folder, beside upstream xacro's verdict."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import urdfs

SCRIPT = Path(__file__).parents[1] / "scripts" / "sweep_repository.py"
XMLNS = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'


def test_every_fate(tmp_path: Path) -> None:
    arm = urdfs.single_revolute()
    files = {
        "good.urdf": arm,
        "sub/good.urdf.xacro": arm.replace("<robot ", f"<robot {XMLNS} ").replace(
            '"0.3 -0.2 0.5"', '"${3/10} -0.2 0.5"'
        ),
        "broken.urdf": arm.replace('<link name="base"/>', ""),
        "asks.xacro": f'<robot name="a" {XMLNS}><link name="$(arg x)"/></robot>',
        "guarded.xacro": f'<robot name="a" {XMLNS}><link name="${{(1).__class__}}"/></robot>',
        "notes.txt": "no robot",
    }
    for name, text in files.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text)
    done = subprocess.run(
        [sys.executable, str(SCRIPT), str(tmp_path), "--all"], capture_output=True, text=True, check=True, timeout=120
    )
    lines = done.stdout.splitlines()
    fates = {line.partition(":")[0]: line.partition(": ")[2].split(";")[0] for line in lines if ";" in line}
    assert fates == {
        "asks.xacro": "xacro-argument",
        "broken.urdf": "unknown-link",
        "good.urdf": "agree",
        "guarded.xacro": "xacro-forbidden",
        "sub/good.urdf.xacro": "agree",
    }
    assert lines[-1].split()[:2] == ["files", "5"]
    assert "xacro expands" in next(line for line in lines if line.startswith("sub/good"))
