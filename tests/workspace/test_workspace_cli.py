"""``pinscrew workspace``: sweeps, pictures, maps, and what it refuses."""

from __future__ import annotations

import asyncio
import json
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import pinscrew as ps
from command_line import ok, refused
from pinscrew.workspace.executors import dask_executor


def test_a2(tmp_path: Path) -> None:
    """The whole of part (f): 1036 points, both choices of frame 0, one picture."""
    picture = tmp_path / "a2.png"
    done = ok("workspace", "planar_2r", "--grid", "5deg", "--compare", "--plot", picture)
    lines = done.out.splitlines()
    assert lines[0] == "planar_2r, tool in base: 1036 configurations, a grid of 28 × 37"
    (last,) = (line for line in lines if line.startswith("from frame 0 at frame0, brought to base: "))
    assert float(last.split()[-4]) < 1e-12
    assert done.err == ""
    with Image.open(picture) as image:
        pixels = np.asarray(image.convert("RGB"), dtype=int)
    blue, orange = pixels[..., 2] - pixels[..., 0] > 80, pixels[..., 0] - pixels[..., 2] > 80
    assert blue.sum() > 1000
    assert orange.sum() > 5000
    assert ok("workspace", "planar_2r").out.splitlines()[0] == lines[0], "the grid is the default"


def test_json(tmp_path: Path) -> None:
    words = ("workspace", "scara", "l1:=0.5", "--samples", "1e2", "--seed", "3", "--range", "joint3=0:10cm")
    done = ok(*words, "--range", "joint1=-90deg:pi/2", "--json", "--npz", tmp_path / "a.npz")
    document = json.loads(done.out, parse_constant=pytest.fail)
    assert document["schema"] == "pinscrew.workspace/1"
    assert (document["configurations"], document["seed"]) == (100, 3)
    assert document["ranges"]["joint3"] == [0.0, 0.1]
    assert document["ranges"]["joint1"] == [-np.pi / 2, np.pi / 2]
    swept = ps.Sweep.load(tmp_path / "a.npz")
    assert document["translation"]["manipulability"]["largest"] == swept.translation.manipulability.max()
    assert document["positions"]["z"]["least"] == swept.positions[:, 2].min()
    assert document["translation"]["manipulability"]["unit"] == "m³ per (rad or m)³"
    assert (document["rotation"]["rank"], document["rotation"]["smallest"]["unit"]) == (1, "rad per (rad or m)")


def test_infinite_conditions_are_null_in_json() -> None:
    document = json.loads(ok("workspace", "planar_2r", "--range", "joint2=90deg:90deg", "--json").out)
    assert document["configurations"] == 28
    smallest = document["translation"]["smallest"]
    assert smallest["largest"] < 1e-15
    condition = document["translation"]["condition"]["largest"]
    assert condition is None or condition > 1e15


def test_steps_by_name() -> None:
    out = ok("workspace", "scara", "--grid", "joint1=90deg,joint2=180deg,joint3=5cm").out
    assert out.splitlines()[0].endswith("a grid of 5 × 3 × 8")
    assert "there is no rotation" in ok("workspace", "drone", "--tip", "link1", "--samples", "4").out


@pytest.mark.parametrize("colour", ["density", "manipulability", "condition", "singularity"])
def test_pictures(tmp_path: Path, colour: str) -> None:
    ok("workspace", "planar_2r", "--grid", "20deg", "--plot", tmp_path / "a.svg", "--color", colour)
    assert "y [m]" in (tmp_path / "a.svg").read_text()


def test_map(tmp_path: Path) -> None:
    words = ("workspace", "one_joint", "--map", tmp_path / "a.npz", "--voxel", "5cm", "--samples", "1e3", "--jobs", "1")
    out = ok(*words, "--plot", tmp_path / "a.png", "--color", "coverage").out.splitlines()
    found = ps.ReachabilityMap.load(tmp_path / "a.npz")
    assert out[0] == f"one_joint, tool in base: {len(found)} voxels of 0.05 m, 1000 samples, seed 0"
    with Image.open(tmp_path / "a.png") as image:
        assert image.width > 300
    document = json.loads(ok(*words, "--resume", "--json").out)
    assert document["schema"] == "pinscrew.workspace-map/1"
    assert (document["voxels"], document["volume"]) == (len(found), found.volume)
    x = document["positions"]["x"]
    assert (x["least"], x["largest"]) == pytest.approx((-0.2, 1.2), abs=0.051)
    message = refused(*words, "--resume", "--seed", "1")
    assert message.endswith("holds another map: its seed is 0, not 1; give what it was made with, or another file")


def test_map_by_a_cluster(cluster: str, tmp_path: Path) -> None:
    words = ("workspace", "one_joint", "--voxel", "5cm", "--samples", "1e3")
    ok(*words, "--map", tmp_path / "a.npz", "--scheduler", cluster)
    ok(*words, "--map", tmp_path / "b.npz", "--jobs", "1")
    assert (tmp_path / "a.npz").read_bytes() == (tmp_path / "b.npz").read_bytes()


REFUSED = {
    ("--grid", "5degrees"): "'5degrees' is not a number; write such as 0.1, pi/4 or 45deg",
    ("--grid", "5cm"): "'5cm' is a length, where an angle is needed",
    ("--grid", "joint1=5cm,joint2=5deg"): "'5cm' is a length, where an angle is needed",
    ("--range", "joint1=0:1cm"): "joint1: '1cm' is a length, where an angle is needed",
    ("--map", "m.npz", "--voxel", "5deg"): "'5deg' is an angle, where a length is needed",
    ("--map", "m.npz", "--voxel", "-5cm"): "'-5cm' is negative",
    ("--samples", "1e5cm"): "'1e5cm' is a length, where a number is needed",
    ("--grid", "joint1=5deg,joint1=3deg"): "'joint1' is given twice",
    ("--grid", "joint1=5deg,3deg"): "'3deg' is not NAME=STEP",
    ("--grid", "-5deg"): "the step of 'joint1' is -0.08726646259971647; give a positive number",
    ("--grid", "1e-9deg"): "make a reachability map, which keeps voxels only",
    ("--grid", "5deg", "--samples", "3"): "both a grid and samples are asked for; leave one out",
    ("--range", "joint1"): "'joint1' is not NAME=FROM:TO",
    ("--range", "joint1=3"): "'3' is not FROM:TO",
    ("--range", "joint1=3:2"): "is reversed: 3 to 2; give the lower end first",
    ("--range", "joint9=1:2"): "there is no coordinate 'joint9'; known are: joint1, joint2",
    ("--samples", "0"): "samples=0.0; give a whole number, 1 or more",
    ("--samples", "nan"): "'nan' is not a number",
    ("--voxel", "5cm"): "--voxel is of no use without --map",
    ("--resume",): "--resume is of no use without --map",
    ("--map", "m.npz", "--compare", "frame0"): "--compare is of no use with --map",
    ("--map", "m.npz", "--grid", "5deg"): "--grid is of no use with --map",
    ("--map", "m.npz", "--jobs", "1", "--scheduler", "x:1"): "--jobs is for processes of this machine",
    ("--map", "m.npz", "--voxel", "0"): "voxel=0.0; give an edge in m, such as 0.05",
    ("--map", "m.npz", "--voxel", "1e-8", "--jobs", "1", "--samples", "10"): "take larger voxels",
    ("--color", "density"): "--color is for a picture, --plot, without --compare",
    ("--plot", "a.png", "--color", "coverage"): "a sweep has no coverage; --color takes density,",
    ("--plot", "a.bmp"): "a figure can't be written with the suffix '.bmp'",
    ("--compare", "tool"): "the frame 'tool' moves",
    ("--compare", "nowhere"): "there is no frame 'nowhere'",
    ("--npz", "none/a.npz"): "can't be written",
    ("--floating-base",): "the floating joint 'root_joint' moves the frame 'tool'",
}


@pytest.mark.parametrize(("words", "says"), REFUSED.items(), ids=[" ".join(words) for words in REFUSED])
def test_refused(words: tuple[str, ...], says: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """In one sentence, and with nothing written."""
    monkeypatch.chdir(tmp_path)
    assert says in refused("workspace", "planar_2r", *words)
    assert list(tmp_path.iterdir()) == []


def test_no_other_frame_0() -> None:
    words = refused("workspace", "scara", "--samples", "9", "--compare")
    assert "0 frames but the base are fixed to it: none; name another choice of frame 0" in words


def test_no_scheduler(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("distributed")
    monkeypatch.setattr("pinscrew.workspace.executors.PATIENCE", 0.3)
    words = ("workspace", "one_joint", "--map", tmp_path / "a.npz", "--scheduler", "tcp://127.0.0.1:1")
    assert refused(*words).startswith("tcp://127.0.0.1:1: no dask scheduler answers (")

    async def in_a_notebook() -> None:  # whose cells run in an event loop
        with pytest.raises(ps.PinscrewError, match="no dask scheduler answers") as caught, dask_executor(words[-1]):
            pass
        assert "event loop" not in str(caught.value)

    # In a thread, since a browser of another test may keep a loop running in this one.
    with ThreadPoolExecutor(1) as elsewhere:
        elsewhere.submit(lambda: asyncio.run(in_a_notebook())).result()
    assert list(tmp_path.iterdir()) == []
