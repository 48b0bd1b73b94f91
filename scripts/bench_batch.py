"""Measure `ps.Batch` against everything else that is installed, all in one run.

    python scripts/bench_batch.py [--rounds N] [--count N] [--threads N] [--robot NAME]... [--json FILE]
    python scripts/bench_batch.py --lengths     # Batch alone, from 10⁴ to 10⁷ configurations
    python scripts/bench_batch.py --single      # one configuration: ps.Pinocchio against the bare calls

Every contender computes poses and body Jacobians in double precision, once per round; the best and the median of the
rounds are shown as nanoseconds per configuration, and how many times as long as `Batch` into given arrays each takes.
Contenders that loop in Python get fewer configurations. Pinocchio's C++ loop takes part where there are a compiler,
Pinocchio's headers (they are in the wheels) and Eigen's (Debian's libeigen3-dev, or ``pip install cmeel-eigen``); jax,
pytorch_kinematics, MuJoCo and roboticstoolbox where they are installed. Markdown goes to standard output.
"""

from __future__ import annotations

import argparse
import contextlib
import ctypes
import importlib.util
import io
import json
import os
import platform
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin

import pinscrew as ps
from pinscrew.engines.compiled.kernel import Kernel

FEW = 4000
"""Configurations for contenders that loop in Python."""
ROBOTS = {
    "panda": ("panda_hand",),
    "ur5_robot": ("tool0",),
    "anthropomorphic_rrr": ("tool",),
    "simple_humanoid": ("r_wrist", "l_wrist", "r_ankle", "l_ankle"),
}


@dataclass
class Contender:
    """Something that computes ``count`` configurations when called."""

    name: str
    run: Callable[[], object]
    count: int


def load(name: str, folder: Path) -> ps.Robot:
    """A robot; Panda without the fingers, which are not of the arm and which Pinocchio would move independently."""
    robot = ps.load(name)
    if name != "panda":
        return robot
    text = robot.description.text.replace('type="prismatic"', 'type="fixed"')
    file = folder / "panda.urdf"
    file.write_text(text, encoding="utf-8")
    return ps.load(file)


def contenders(robot: ps.Robot, frames: tuple[str, ...], count: int, threads: int, folder: Path) -> Iterator[Contender]:
    """All that can take part."""
    rng = np.random.default_rng(0)
    q = rng.uniform(-3.0, 3.0, (count, robot.nq))
    few = q[:FEW]
    T, J = touched(count, len(frames), 4, 4), touched(count, len(frames), 6, robot.nv)
    w = touched(count, len(frames))
    batch = ps.Batch(robot, threads=threads)
    yield Contender("Batch, out= given", lambda: batch.fk_jacobian(q, frames, "body", out=(T, J)), count)
    yield Contender("Batch, fresh arrays", lambda: batch.fk_jacobian(q, frames, "body"), count)
    yield Contender("Batch, pose alone", lambda: batch.fk(q, frames, out=T), count)
    yield Contender("Batch, manipulability alone", lambda: batch.manipulability(q, frames, out=w), count)
    yield Contender("Batch, float32", float32(batch, q, frames), count)
    loop = cpp_loop(robot, frames, folder)
    if loop is not None:
        yield Contender("Pinocchio C++ loop", lambda: loop(q, T, J, threads), count)
        yield Contender("Pinocchio C++ loop, pose alone", lambda: loop(q, T, None, threads), count)
    poe, mine = ps.PoE(robot), ps.Pinocchio(robot)
    yield Contender("PoE (numpy)", lambda: [poe.fk_jacobian(few, f, "body") for f in frames], len(few))
    yield Contender("Pinocchio, Python loop", python_loop(mine, few, frames), len(few))
    if len(frames) == 1 and importlib.util.find_spec("jax"):  # of four frames it never came back, on two cores
        yield Contender("jax.jit", jax_loop(robot, frames, q[: count // 10]), count // 10)
    if len(frames) == 1 and importlib.util.find_spec("pytorch_kinematics"):
        yield Contender("pytorch_kinematics", torch_loop(robot, frames, few), len(few))
    for name in ("mujoco", "roboticstoolbox"):
        if importlib.util.find_spec(name):
            from pinscrew.witnesses.witness import witness

            engine = witness(name, robot)
            yield Contender(engine.name, lambda e=engine: [e.fk_jacobian(few[:500], f, "body") for f in frames], 500)  # type: ignore[misc]


def touched(*shape: int) -> np.ndarray:
    """An array whose pages are there. Numpy asks for large pages for what is empty, but not for what is zero."""
    array = np.empty(shape)
    array.fill(0.0)
    return array


def float32(batch: ps.Batch, q: np.ndarray, frames: tuple[str, ...]) -> Callable[[], object]:
    """Half the bytes."""
    single = q.astype(np.float32)
    T, J = (array.astype(np.float32) for array in batch.fk_jacobian(q, frames, "body"))
    return lambda: batch.fk_jacobian(single, frames, "body", out=(T, J))


def python_loop(engine: ps.Pinocchio, q: np.ndarray, frames: tuple[str, ...]) -> Callable[[], object]:
    """Pinocchio as its users call it: no engine of ours between."""
    model = engine.model
    data = model.createData()
    indices = [model.getFrameId(frame, pin.FrameType.BODY) for frame in frames]

    def run() -> None:
        for x in q:
            pin.computeJointJacobians(model, data, x)
            for index in indices:
                _ = pin.updateFramePlacement(model, data, index).homogeneous
                _ = pin.getFrameJacobian(model, data, index, pin.LOCAL)

    return run


def cpp_loop(robot: ps.Robot, frames: tuple[str, ...], folder: Path) -> Any:
    """Pinocchio's C++ loop as a function of arrays, compiled when first asked for; None where it can't be."""
    compiler = shutil.which("c++") or shutil.which("g++")
    prefix = Path(pin.__file__).resolve().parents[4]
    eigen = next((p for p in (prefix / "include/eigen3", Path("/usr/include/eigen3")) if p.is_dir()), None)
    if compiler is None or eigen is None or not (prefix / "include/pinocchio").is_dir():
        return None
    library = folder / "libloop.so"
    if not library.exists():
        print("compiling Pinocchio's C++ loop …", file=sys.stderr, flush=True)
        limits = [f"-DBOOST_MPL_LIMIT_{kind}_SIZE=30" for kind in ("LIST", "VECTOR")]
        options = ["-O3", "-march=native", "-DNDEBUG", "-std=c++17", "-shared", "-fPIC", "-pthread", *limits]
        options += ["-DBOOST_MPL_CFG_NO_PREPROCESSED_HEADERS", f"-I{prefix}/include", f"-I{eigen}", f"-L{prefix}/lib"]
        source = Path(__file__).with_name("pinocchio_loop.cpp")
        linked = ["-lpinocchio_default", "-lboost_serialization", f"-Wl,-rpath,{prefix}/lib"]
        subprocess.run([compiler, *options, str(source), "-o", str(library), *linked], check=True, capture_output=True)
    code = ctypes.CDLL(str(library))
    code.open_robot.restype = ctypes.c_void_p
    code.open_robot.argtypes = [ctypes.c_char_p, ctypes.c_void_p, ctypes.c_long]
    pointers = [ctypes.c_void_p] * 2
    code.run.argtypes = [ctypes.c_void_p, ctypes.c_void_p, ctypes.c_long, *pointers, ctypes.c_long]
    model = ps.Pinocchio(robot).model
    file = folder / f"{robot.name}.txt"
    model.saveToText(str(file))
    indices = np.array([model.getFrameId(frame, pin.FrameType.BODY) for frame in frames])
    handle = code.open_robot(str(file).encode(), indices.ctypes.data, len(indices))

    def run(q: np.ndarray, T: np.ndarray, J: np.ndarray | None, threads: int) -> None:
        code.run(handle, q.ctypes.data, len(q), T.ctypes.data, None if J is None else J.ctypes.data, threads)

    return run


def jax_loop(robot: ps.Robot, frames: tuple[str, ...], q: np.ndarray) -> Callable[[], object]:
    """The product of exponentials as one writes it in jax: vmap, jit, double precision."""
    import jax
    import jax.numpy as jnp

    jax.config.update("jax_enable_x64", True)

    def exponential(twist: Any, angle: Any) -> Any:
        v, w = twist[:3], twist[3:]
        W = jnp.array([[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0]])
        turning = jnp.dot(w, w) > 0.5
        R = jnp.eye(3) + jnp.sin(angle) * W + (1 - jnp.cos(angle)) * W @ W
        p = jnp.where(turning, (jnp.eye(3) - R) @ jnp.cross(w, v), angle * v)
        return jnp.block([[R, p[:, None]], [jnp.zeros((1, 3)), jnp.ones((1, 1))]])

    def adjoint(T: Any) -> Any:
        R, p = T[:3, :3], T[:3, 3]
        P = jnp.array([[0, -p[2], p[1]], [p[2], 0, -p[0]], [-p[1], p[0], 0]])
        return jnp.block([[R, P @ R], [jnp.zeros((3, 3)), R]])

    def one(x: Any) -> Any:
        answers = []
        for frame in frames:
            T, J = jnp.eye(4), jnp.zeros((6, robot.nv))
            for index in robot.motions_above(frame):
                motion = robot.mechanism.motions[index]
                twist = motion.multiplier * jnp.array(motion.twists[:, 0])
                J = J.at[:, motion.v].add(adjoint(T) @ twist)
                T = T @ exponential(jnp.array(motion.twists[:, 0]), motion.multiplier * x[motion.q])
            T = T @ jnp.array(robot.home(frame))
            answers.append((T, adjoint(jnp.linalg.inv(T)) @ J))
        return answers

    function = jax.jit(jax.vmap(one))
    jax.block_until_ready(function(q))
    return lambda: jax.block_until_ready(function(q))


def torch_loop(robot: ps.Robot, frames: tuple[str, ...], q: np.ndarray) -> Callable[[], object]:
    """pytorch_kinematics, batched."""
    import pytorch_kinematics as pk
    import torch

    text = robot.description.text.encode()
    with contextlib.redirect_stderr(io.StringIO()):  # it lists what it does not know of a URDF
        chains = [pk.build_serial_chain_from_urdf(text, frame).to(dtype=torch.float64) for frame in frames]
    named = [[robot.coordinate_names.index(name) for name in chain.get_joint_parameter_names()] for chain in chains]
    x = torch.from_numpy(q)

    def run() -> None:
        for chain, columns in zip(chains, named, strict=True):
            chain.forward_kinematics(x[:, columns])
            chain.jacobian(x[:, columns])

    return run


def bandwidth(threads: int) -> Contender:
    """Storing 512 bytes a row and computing nothing: the limit for `Batch`, by the same loop."""
    count = 2**19
    rows = touched(count, 64)
    kernel = Kernel(1, lambda _: ([[float(i) for i in range(64)]], []), [64], (False, False))
    q = np.zeros((count, 1))
    return Contender("stores", lambda: kernel.run(q, [rows], threads), count)


def measure(all_of_them: list[Contender], rounds: int) -> dict[str, tuple[float, float]]:
    """Nanoseconds per configuration, best and median, of rounds in which each has its turn."""
    found: dict[str, list[float]] = {contender.name: [] for contender in all_of_them}
    for _ in range(rounds + 1):
        for contender in all_of_them:
            start = time.perf_counter()
            contender.run()
            found[contender.name].append((time.perf_counter() - start) / contender.count * 1e9)
    return {name: (min(times[1:]), statistics.median(times[1:])) for name, times in found.items()}


def lengths(rounds: int) -> None:
    """Whether the time grows with the number of configurations: Panda, all cores, into given arrays."""
    robot = ps.load("panda")
    batch = ps.Batch(robot)
    most = 10_000_000
    q = np.random.default_rng(0).uniform(-3.0, 3.0, (most, robot.nq))
    T, J = touched(most, 4, 4), touched(most, 6, robot.nv)

    for k in (4, 5, 6, 7):
        n = 10**k
        out = (T[:n], J[:n])

        def run(n: int = n, out: tuple[np.ndarray, np.ndarray] = out) -> None:
            batch.fk_jacobian(q[:n], "panda_hand", "body", out=out)

        # One length after the other: small results stay in the cache, as they do for a caller who reads them.
        (best, median) = measure([Contender("Batch", run, n)], rounds * 10 ** max(0, 6 - k))["Batch"]
        print(f"{n:>12,} configurations: best {best:.1f}, median {median:.1f} ns each")


def single(rounds: int) -> None:
    """One configuration through `ps.Pinocchio`, and through the calls that it makes."""
    for name, (frame, *_) in ROBOTS.items():
        engine = ps.Pinocchio(ps.load(name))
        q = np.random.default_rng(0).uniform(-1.0, 1.0, engine.robot.nq)
        bare = python_loop(engine, np.tile(model_coordinates(engine, q), (FEW, 1)), (frame,))
        times = measure([Contender("bare", bare, FEW), Contender("ours", ours(engine, q, frame), FEW)], rounds)
        ratio = times["ours"][0] / times["bare"][0]
        print(f"{name}: pose and Jacobian {times['ours'][0]:.0f} ns, bare {times['bare'][0]:.0f} ns: {ratio:.2f}")


def model_coordinates(engine: ps.Pinocchio, q: np.ndarray) -> np.ndarray:
    """Ours as Pinocchio's model has them, mimic joints and all."""
    expanded: np.ndarray = engine._expansion.all(q[None])[0]
    return expanded


def ours(engine: ps.Pinocchio, q: np.ndarray, frame: str) -> Callable[[], object]:
    """One configuration, again and again."""
    return lambda: [engine.fk_jacobian(q, frame, "body") for _ in range(FEW)]


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=9)
    parser.add_argument("--count", type=int, default=200_000)
    parser.add_argument("--threads", type=int, action="append", help="by default 1 and all cores")
    parser.add_argument("--robot", choices=ROBOTS, action="append")
    parser.add_argument("--json", type=Path)
    parser.add_argument("--lengths", action="store_true")
    parser.add_argument("--single", action="store_true")
    given = parser.parse_args()
    warnings.simplefilter("ignore", ps.PinscrewWarning)
    if given.lengths or given.single:
        (lengths if given.lengths else single)(given.rounds)
        return
    cores = len(os.sched_getaffinity(0))
    document: dict[str, Any] = {"machine": f"{platform.processor() or platform.machine()}, {cores} cores", "runs": []}
    with tempfile.TemporaryDirectory() as folder:
        for name in given.robot or ROBOTS:
            robot = load(name, Path(folder))
            for threads in given.threads or sorted({1, cores}):
                stores = bandwidth(threads)
                taking_part = list(contenders(robot, ROBOTS[name], given.count, threads, Path(folder)))
                found = measure([stores, *taking_part], given.rounds)
                document["runs"].append({"robot": name, "joints": robot.nq, "threads": threads, "ns": found})
                show(robot, ROBOTS[name], threads, found)
    if given.json:
        given.json.write_text(json.dumps(document, indent=2) + "\n", encoding="utf-8")


def show(robot: ps.Robot, frames: tuple[str, ...], threads: int, found: dict[str, tuple[float, float]]) -> None:
    """A table of one robot and one number of threads."""
    size = 8 * len(frames) * (16 + 6 * robot.nv)
    speed = 512 / found.pop("stores")[0]
    ours = found["Batch, out= given"][0]
    print(f"### {robot.name}: {robot.nq} joints, {len(frames)} frame(s), {threads} thread(s)\n")
    print(f"Stores reach {speed:.1f} GB/s, so {size} bytes take {size / speed:.1f} ns; Batch takes {ours:.1f}.\n")
    print("| | times as long | best, ns | median, ns |")
    print("|---|---:|---:|---:|")
    for name, (best, median) in found.items():
        print(f"| {name} | {best / ours:.2f} | {best:.1f} | {median:.1f} |")
    print(flush=True)


if __name__ == "__main__":
    main()
