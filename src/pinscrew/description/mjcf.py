"""MJCF as a description: MuJoCo's own compiler reads it, and what it compiles is written as URDF."""

from __future__ import annotations

import importlib.util
import re
import warnings
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

from pinscrew.description import expand, markup, mjcf_text, mjcf_tree, urdf
from pinscrew.description.model import Description, Joint, MjcfModel
from pinscrew.description.packages import Packages
from pinscrew.ground.errors import DescriptionError, MissingExtraError, PinscrewWarning
from pinscrew.ground.words import brief, one_line

__all__ = ["description_of", "text_is_mjcf"]

_WORKER: Final = Path(__file__).with_name("_mjcf_worker.py")
_SAID: Final = re.compile(r"(?:XML Error:|Error:|\s)*(.*?)(?:\s*Element '?[^\n]*, line (\d+))?\s*", re.DOTALL)
"""MuJoCo's words, and the line of the text that they are about."""
_BEFORE_ROOT: Final = re.compile(r"\s*(?:(?:<\?.*?\?>|<!--.*?-->)\s*)*<mujoco[\s/>]", re.DOTALL)


def text_is_mjcf(text: str) -> bool:
    """Whether the root element of a text is ``<mujoco>``."""
    return "<mujoco" in text and _BEFORE_ROOT.match(text) is not None


def description_of(text: str, packages: Packages, *, strict: bool = False) -> Description:
    """The description of an MJCF.

    Args:
        text: the file's.
        packages: the file itself, and which others it may include.
        strict: whether what is left out, such as closed loops, is an error.

    Raises:
        MissingExtraError: if MuJoCo is not installed.
        DescriptionError: if MuJoCo refuses it, or it is no tree that can be taken; the message carries its words.
    """
    if importlib.util.find_spec("mujoco") is None:
        raise MissingExtraError("MuJoCo, which reads MJCF, is not installed", "mujoco")
    file = str(packages.file)
    plain = mjcf_text.plain(markup.parse(text, file), packages)
    _remark(plain.notes, file, strict=strict)
    tree = _compiled(plain, file)
    written = mjcf_tree.write(plain.name, tree, file)
    urdf_text = written.text()
    with warnings.catch_warnings():  # what it says is MuJoCo's, and reversed limits are ours
        warnings.simplefilter("ignore", PinscrewWarning)
        try:
            parsed = urdf.parse(urdf_text, file)
        except DescriptionError as error:  # the lines are not those of the file
            raise DescriptionError(error.code, error.what, file=file) from None
    return replace(
        parsed,
        joints=tuple(_joint(joint, written, plain, file) for joint in parsed.joints),
        mjcf=MjcfModel(plain.text, written.bodies, written.joints, written.sites),
    )


def _remark(notes: Sequence[str], file: str, *, strict: bool) -> None:
    for note in notes:
        remark = PinscrewWarning("mjcf-left-out", note, file=file)
        if strict:
            raise DescriptionError(remark.code, note, file=file)
        warnings.warn(remark, stacklevel=2)


def _compiled(plain: mjcf_text.PlainMjcf, file: str) -> dict[str, Any]:
    """What MuJoCo compiles.

    Raises:
        DescriptionError: if it refuses, or takes more than it may.
    """

    def ended(what: str, remedy: str) -> DescriptionError:
        return DescriptionError("mjcf-limit", f"MuJoCo's compiler takes {what}", file=file, remedy=remedy)

    def failed(words: str) -> DescriptionError:
        return DescriptionError("mjcf", f"MuJoCo's compiler failed: {words}", file=file)

    answer = expand.ask(_WORKER, {"text": plain.text}, ended, failed)
    if "error" not in answer:
        return answer
    match = _SAID.fullmatch(answer["error"])
    words, number = match.groups() if match else (answer["error"], None)
    place: tuple[str, int | None] = plain.places[int(number) - 1] if number else (file, None)
    what = f"MuJoCo refuses it: {one_line(brief(words.strip()))}"
    raise DescriptionError("mjcf", what, file=place[0], line=place[1])


def _joint(joint: Joint, written: mjcf_tree.WrittenTree, plain: mjcf_text.PlainMjcf, file: str) -> Joint:
    """The joint with the limits that the file has and a URDF can't say it lacks, and the place where it is written."""
    limits = replace(joint.limits, velocity=float("inf"), effort=written.efforts.get(joint.name, float("inf")))
    place, line = plain.joints.get(joint.name, ("", None))
    return replace(joint, limits=limits, line=line, file="" if place == file else place)
