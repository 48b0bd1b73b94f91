"""Draw the bundled robots, each with its screws, and a workspace into docs/gallery.

python scripts/gallery.py             # all
python scripts/gallery.py scara_rrp   # some; "circles" and "workspace" are names too

It takes Chromium or Chrome; the pictures depend on its version, so nothing compares them.
"""

from __future__ import annotations

import sys
from pathlib import Path

import pinscrew as ps
from pinscrew.description.catalogue import bundled
from pinscrew.ground import files
from pinscrew.view import figures, plot_workspace, prepare
from pinscrew.view.shapes import Group

FOLDER = Path(__file__).resolve().parents[1] / "docs" / "gallery"
WIDTH, HEIGHT = 900, 650

USUAL: tuple[Group, ...] = ("links", "frames", "screws")

# A configuration that shows the arm's shape, by coordinate; where there is none, zero does.
POSES: dict[str, dict[str, float]] = {
    "spherical_rrp": {"joint1": -0.5, "joint2": -0.5, "joint3": 0.1},
    "planar_2r": {"joint1": 0.35, "joint2": -0.5},
    "scara_rrp": {"joint1": 0.3, "joint2": 0.9, "joint3": 0.12},
    "stanford_rrp": {"joint1": 0.3, "joint2": 0.4, "joint3": 0.5},
    "planar_rrr": {"joint1": 0.3, "joint2": 0.7, "joint3": 0.6},
    "drone": {"joint1": 1.2, "joint2": 0.3, "joint3": 0.5},
    "anthropomorphic_rrr": {"joint1": 0.4, "joint2": 0.6, "joint3": 0.8},
    "one_joint": {"joint1": 0.6},
    "two_joint": {"joint1": -0.6, "joint2": 1.0},
    "gear_pair": {"joint1": 0.6},
    "bevel_pair": {"joint1": 0.6},
}


def main() -> None:
    """Write the pictures that are asked for."""
    wanted = sys.argv[1:]
    FOLDER.mkdir(parents=True, exist_ok=True)
    for entry in bundled():
        if wanted and entry.name not in wanted:
            continue
        robot = ps.load(entry.name)
        model = prepare.prepare(robot)
        q = robot.configuration(POSES.get(entry.name, {}))
        file = FOLDER / f"{entry.name}.png"
        files.write(file, prepare.picture(model, prepare.begin(model, q, draw=USUAL), WIDTH, HEIGHT))
        print(
            f"{file.relative_to(Path.cwd()) if file.is_relative_to(Path.cwd()) else file}: {file.stat().st_size} bytes"
        )
    if not wanted or "circles" in wanted:
        model = prepare.prepare(ps.load("two_joint"))
        q = model.robot.configuration(POSES["two_joint"])
        drawn: tuple[Group, ...] = ("links", "screws", "circles")
        file = FOLDER / "two_joint_circles.png"
        files.write(file, prepare.picture(model, prepare.begin(model, q, draw=drawn), WIDTH, HEIGHT))
        print(f"{file.name}: {file.stat().st_size} bytes")
    if not wanted or "workspace" in wanted:
        file = FOLDER / "planar_2r_workspace.png"
        swept = ps.sweep(ps.load("planar_2r"))
        figures.save(plot_workspace.plot_sweep(swept, "manipulability"), file, dpi=80.0)
        print(f"{file.name}: {file.stat().st_size} bytes")


if __name__ == "__main__":
    main()
