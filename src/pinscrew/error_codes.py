"""The codes of all errors and warnings: what kind of mistake each stands for.

``docs/errors.md`` is written from this list, and a test holds it against the code.
"""

from __future__ import annotations

from typing import Final

__all__ = ["ERRORS", "WARNINGS"]

ERRORS: Final[dict[str, str]] = {
    # Files
    "no-file": "There is no file at this path.",
    "unreadable": "The file exists, but the system does not let it be read: a folder, say, or a lack of rights.",
    "too-large": "The file, or the expansion of a xacro file, is larger than 20 MB.",
    "encoding": "The file is not UTF-8, declares another encoding, or holds a NUL character.",
    "not-xml": "The text is not well-formed XML.",
    "doctype": "The file has a DOCTYPE, which URDF does not use and which can define entities.",
    # Elements of a URDF
    "root-element": "The root element is not `<robot>`.",
    "no-name": "A robot, link or joint has no name.",
    "no-links": "The robot has no links.",
    "unexpanded-xacro": "A file read as URDF has `xacro:` elements.",
    "duplicate-name": "Two links or two joints have one name.",
    "duplicate-element": "A joint has two of what it may have one of: `<origin>`, `<axis>`, `<parent>`, …",
    "joint-type": "A joint has no type, or one that does not exist.",
    "reserved-name": "A name is taken by pinscrew or Pinocchio: a joint `universe`, or what a floating base needs.",
    "no-link": "A joint has no parent or no child link.",
    "unknown-link": "A joint names a link that is not defined.",
    "number-count": "There are more or fewer numbers than are due.",
    "number": "A number is not a finite decimal number, such as `-0.5` or `1e-3`.",
    "no-axis": "An `<axis>` has no `xyz`.",
    "zero-axis": "An axis is zero, or so short (1e-9 or less) that its direction means nothing.",
    "planar-axis": "A planar joint's axis is not z; Pinocchio ignores it.",
    "no-limit": "A revolute or prismatic joint has no `<limit>`, or a limit lacks effort or velocity.",
    "reversed-limits": "A lower limit is above the upper one.",
    "mimic-unknown": "A `<mimic>` names no joint, or one that is not defined.",
    "mimic-type": "A joint mimics, or is mimicked, that has no single value.",
    "mimic-cycle": "Joints mimic each other in a circle.",
    "two-roots": "More than one link is at the top.",
    "two-parents": "Two joints lead to one link.",
    "self-loop": "A joint joins a link to itself.",
    "cycle": "Joints form a cycle that no root link leads to.",
    # xacro, packages and meshes
    "xacro": "xacro can't expand the file; the message carries its words.",
    "xacro-argument": "An argument was given that the file does not declare; a plain URDF declares none.",
    "xacro-forbidden": "An expression goes beyond arithmetic, comparison, conditionals and the known functions.",
    "xacro-limit": "An expansion takes too long, too much memory, or includes itself.",
    "unknown-package": "A ROS package is in none of the places where packages are looked for.",
    "outside": "A file is asked for that is outside the robot's own folder and the declared packages.",
    "remote-file": "A mesh or image is asked for that is not a local file.",
    "no-mesh": "A mesh is not where the file says.",
    "mesh-format": "A mesh is none of STL, OBJ and COLLADA, or can't be read as what its name says.",
    "geometry": "A visual has no geometry, one that does not exist, or a negative or missing size.",
    # Names
    "unknown-robot": "No bundled robot, file or URDF of example-robot-data has this name.",
    "unknown-frame": "The robot has no link of this name.",
    "unknown-coordinate": "The robot has no coordinate of this name.",
    "ambiguous-tip": "The robot has several leaves, so a tip must be named.",
    # Arguments of calls
    "shape": "An array has another shape than expected.",
    "not-numbers": "A value is not an array of numbers.",
    "not-finite": "An array holds NaN or infinity.",
    "quaternion": "The quaternion of a floating joint does not have norm 1.",
    "jacobian-kind": "There is no such kind of Jacobian.",
    "at": "Screw axes are asked for at what is neither space nor body.",
    "reference": "A reference frame moves, or is given for body axes.",
    "frames": "There are no frames to compare.",
    "samples": "A number of samples is negative.",
    "seed": "A seed is negative.",
    "tolerance": "A tolerance is not positive.",
    "draw": "Something is to be drawn that does not exist.",
    "fps": "A number of pictures per second is not within 0 to 240.",
    "derive-option": "An option of a derivation has a value that does not exist or is out of range.",
    "derive-part": "A derivation has no part of this letter or key.",
    "derive-size": "More than 8 moving joints lead to a frame: too many for closed forms to be of use.",
    "derive-joint": "A floating or planar joint leads to a frame, and closed forms are asked for.",
    "symbol-collision": "A symbol for a length has the name of another, of a joint's value, or of a sine or cosine.",
    "no-errata": "No printed coursework belongs to this robot.",
    "unwritable": "An output file can't be written.",
    # Lie groups and screws
    "not-a-rotation": "A matrix is not a rotation.",
    "not-a-pose": "A 4×4 matrix does not have the bottom row 0, 0, 0, 1.",
    "improper": "A matrix has a negative determinant: the nearest rotation would not be near.",
    "singular": "A matrix or map has no inverse or no nearest rotation there.",
    "zero-twist": "A zero twist is no screw.",
    "zero-direction": "A zero vector is no direction.",
    "not-unit": "A screw's direction is not a unit vector.",
    "pitch": "A screw's pitch is NaN or minus infinity.",
    "magnitude": "A screw's magnitude is not positive and finite.",
    "overflow": "A screw's numbers are too large for a double.",
    # Engines and extras
    "pinocchio-refuses": "Pinocchio does not load a file that pinscrew accepts; the message carries its words.",
    "pinocchio-size": "The robot is too large for Pinocchio; the PoE engine takes it.",
    "pinocchio-frames": "Pinocchio's model lacks a link that the description has.",
    "pinocchio-coordinates": "Pinocchio's model has a joint that no coordinate drives.",
    # Showing a robot
    "server": "The server of a view does not start, or has stopped.",
    "no-browser": "A picture needs Chromium or Chrome, and there is none.",
    "browser-failed": "The browser made no picture, or not in time.",
    "missing-extra": "An optional dependency is not installed.",
}

WARNINGS: Final[dict[str, str]] = {
    "axis-normalised": "A joint's axis was not a unit vector, and was normalised.",
    "limit-zero": "A limit lacks `lower` or `upper`, which URDF takes as 0.",
    "no-mesh": "Meshes are not where the file says; their links are drawn as frames.",
    "mimic-fixed": "A fixed joint has a `<mimic>`, which was ignored.",
    "xacro": "xacro has something to say about the file.",
}
