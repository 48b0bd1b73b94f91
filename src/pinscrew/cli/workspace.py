"""``pinscrew workspace``: where a frame can get, and how well it moves there."""

from __future__ import annotations

from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import click

from pinscrew.cli import arguments, output
from pinscrew.cli.progress import progress

if TYPE_CHECKING:
    from pinscrew.robot.robot import Robot
    from pinscrew.workspace.reachability_map import ReachabilityMap
    from pinscrew.workspace.sweep import Sweep

__all__ = ["command"]


def _samples(_ctx: click.Context, _param: click.Parameter, value: str | None) -> float | None:
    return None if value is None else arguments.number(value)


def _steps(_ctx: click.Context, _param: click.Parameter, value: str | None) -> float | dict[str, str] | None:
    """One step for all angles; or the text of each coordinate's, which is read when its unit is known."""
    if value is None or "=" not in value:
        return None if value is None else arguments.number(value, unit="rad")
    return arguments.pairs(value.split(","), "NAME=STEP")


def _ranges(_ctx: click.Context, _param: click.Parameter, values: tuple[str, ...]) -> dict[str, tuple[str, str]]:
    """The texts of the ends of each range."""
    texts = {}
    for name, text in arguments.pairs(values, "NAME=FROM:TO").items():
        lower, colon, upper = text.partition(":")
        if not colon:
            raise click.BadParameter(f"{text!r} is not FROM:TO")
        texts[name] = (lower, upper)
    return texts


def _of(robot: Robot, name: str, text: str, option: str) -> float:
    """A value of a coordinate, in its unit; a name that does not exist is told by whoever takes the value."""
    units = dict(zip(robot.coordinate_names, robot.coordinate_units, strict=True))
    return arguments.number(text, option, units.get(name, ""), of=name)


_ONLY_SWEEPS: Final = {"grid": "--grid", "compare": "--compare", "npz": "--npz"}
_ONLY_MAPS: Final = {"voxel": "--voxel", "jobs": "--jobs", "scheduler": "--scheduler", "resume": "--resume"}


@click.command(name="workspace", short_help="Where a frame can get, and how well it moves there.")
@arguments.robot_argument()
@arguments.tip_option
@click.option(
    "--grid", metavar="STEP", callback=_steps, help="A grid: the step of all angles, 5deg, or a=5deg,b=1cm by name."
)
@click.option("--samples", metavar="N", callback=_samples, help="A sample of so many configurations, such as 1e5.")
@click.option("--seed", default=0, show_default=True, type=click.IntRange(0), help="Of the sample.")
@click.option(
    "--range",
    "ranges",
    multiple=True,
    metavar="NAME=FROM:TO",
    callback=_ranges,
    help="A coordinate's range instead of its limits, such as joint1=-90deg:90deg; may be repeated.",
)
@click.option("--npz", type=output.FILE, help="Write everything to this file, for numpy.")
@click.option("--plot", type=output.FILE, help="Draw a picture: .png, .svg or .pdf.")
@click.option(
    "--color",
    "colour",
    type=click.Choice(["density", "manipulability", "condition", "singularity", "coverage"]),
    help="What the picture's colours tell: by default density, and of a map manipulability.",
)
@click.option(
    "--compare",
    metavar="[FRAME]",
    is_flag=False,
    flag_value="",
    help="Compute it from this choice of frame 0 too (or from the only one there is), and draw both.",
)
@click.option("--map", "target", type=output.FILE, help="Write a map of voxels instead, for many samples.")
@click.option(
    "--voxel", metavar="EDGE", callback=arguments.amount("m"), help="Edge of the map's voxels. By default 5cm."
)
@click.option("--jobs", type=click.IntRange(1), help="Processes for the map. By default as many as cores.")
@click.option("--scheduler", metavar="ADDRESS", help="Let a dask cluster compute the map: its scheduler.")
@click.option("--resume", is_flag=True, help="Go on with the unfinished map in the file, if there is one.")
@arguments.json_option
def command(words: tuple[str, ...], target: Path | None, plot: Path | None, as_json: bool, **options: Any) -> None:
    """Find where a frame of ROBOT can get within its joints' ranges.

    Over a grid (by default of 5° for an arm of one or two angles), or a sample of low discrepancy (16384 for any
    other), or, with --map, over as many random configurations as you like, kept as voxels only. A map is written
    as it grows; --resume goes on after an interruption.

    \b
      pinscrew workspace planar_2r --grid 5deg --compare --plot a2.png
      pinscrew workspace scara --samples 1e4 --npz scara.npz
      pinscrew workspace scara --map map.npz --voxel 5cm --samples 1e5 --jobs 1
    """
    wrong = [name for key, name in (_ONLY_SWEEPS if target else _ONLY_MAPS).items() if options[key]]
    if wrong:
        raise click.UsageError(f"{wrong[0]} is of no use {'with' if target else 'without'} --map")
    if options["jobs"] and options["scheduler"]:
        raise click.UsageError("--jobs is for processes of this machine, --scheduler for a cluster's")
    if plot is not None:
        from pinscrew.view import figures

        figures.check(plot)
    _check_colour(options["colour"], plot, target, options["compare"])
    robot = arguments.robot(words).load()
    if isinstance(options["grid"], dict):
        options["grid"] = {name: _of(robot, name, text, "--grid") for name, text in options["grid"].items()}
    options["ranges"] = {
        name: (_of(robot, name, lower, "--range"), _of(robot, name, upper, "--range"))
        for name, (lower, upper) in options["ranges"].items()
    }
    if target is None:
        _sweep(robot, plot, as_json, **options)
    else:
        _map(robot, target, plot, as_json, **options)


def _check_colour(colour: str | None, plot: Path | None, target: Path | None, compare: str | None) -> None:
    if colour is None:
        return
    from pinscrew.view.plot_workspace import MAP_COLOURS, SWEEP_COLOURS

    if plot is None or compare is not None:
        raise click.UsageError("--color is for a picture, --plot, without --compare")
    known = MAP_COLOURS if target else SWEEP_COLOURS
    if colour not in known:
        raise click.UsageError(f"{'a map' if target else 'a sweep'} has no {colour}; --color takes {', '.join(known)}")


def _sweep(
    robot: Robot,
    plot: Path | None,
    as_json: bool,
    *,
    tip: str | None,
    npz: Path | None,
    compare: str | None,
    colour: str | None,
    grid: Any,
    samples: float | None,
    seed: int,
    ranges: Any,
    **_: Any,
) -> None:
    from pinscrew.cli import workspace_summary as summary
    from pinscrew.workspace.comparison import from_reference, other_reference
    from pinscrew.workspace.sweep import sweep

    found = sweep(robot, grid=grid, samples=samples, seed=seed, frame=tip, ranges=ranges)
    others = None
    if compare is not None:
        compare = compare or other_reference(robot)
        others = from_reference(robot, found.q, found.metadata["frame"], compare)[:, :3, 3]
    if npz is not None:
        found.save(npz)
    if plot is not None:
        _plot_sweep(plot, found, others, compare, colour)
    document = summary.of_sweep(found, others, compare)
    if as_json:
        output.print_json(document)
    else:
        summary.print_sweep(document)


def _plot_sweep(file: Path, found: Sweep, others: Any, reference: str | None, colour: str | None) -> None:
    from pinscrew.view import figures, plot_workspace

    if reference is not None:
        figures.save(plot_workspace.plot_comparison(found, others, reference), file)
    else:
        figures.save(plot_workspace.plot_sweep(found, colour or "density"), file)


def _map(
    robot: Robot,
    target: Path,
    plot: Path | None,
    as_json: bool,
    *,
    tip: str | None,
    samples: float | None,
    voxel: float | None,
    jobs: int | None,
    scheduler: str | None,
    colour: str | None,
    **options: Any,
) -> None:
    from pinscrew.cli import workspace_summary as summary
    from pinscrew.workspace import executors
    from pinscrew.workspace.blocks import block_count
    from pinscrew.workspace.reachability import SAMPLES, reachability

    given = {"seed": options["seed"], "ranges": options["ranges"], "resume": options["resume"]}
    given |= {key: value for key, value in (("samples", samples), ("voxel", voxel)) if value is not None}
    chosen = nullcontext((None, jobs)) if scheduler is None else executors.dask_executor(scheduler)
    total = block_count(int(SAMPLES if samples is None else samples))
    with chosen as (executor, workers), progress("mapping", total) as advance:
        found = reachability(robot, frame=tip, executor=executor, jobs=workers, path=target, advance=advance, **given)
    if plot is not None:
        _plot_map(plot, found, colour)
    document = summary.of_map(found)
    if as_json:
        output.print_json(document)
    else:
        summary.print_map(document)


def _plot_map(file: Path, found: ReachabilityMap, colour: str | None) -> None:
    from pinscrew.view import figures, plot_workspace

    figures.save(plot_workspace.plot_map(found, colour or "manipulability"), file)
