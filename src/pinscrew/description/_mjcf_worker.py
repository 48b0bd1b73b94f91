"""The child process of `mjcf`: MuJoCo compiles an MJCF here, within limits; its tree is answered as JSON.

The text has neither includes nor assets any more, so that no file is opened.
"""

from __future__ import annotations

import sys

if __name__ == "__main__" and not getattr(sys.flags, "safe_path", False):
    del sys.path[0]  # this script's folder, whose modules must not shadow anyone's

import json
import warnings
from typing import Any

import mujoco

from pinscrew.ground.children import end_with_parent, limit


def _tree(model: Any) -> dict[str, Any]:
    """The compiled bodies, joints, sites and joint couplings, each in the order of its index."""
    m = model
    kinds = [mujoco.mjtJoint(kind).name.removeprefix("mjJNT_").lower() for kind in m.jnt_type.tolist()]
    bodies = {"name": [m.body(i).name for i in range(m.nbody)], "parent": m.body_parentid.tolist()}
    joints = {"name": [m.joint(i).name for i in range(m.njnt)], "kind": kinds, "body": m.jnt_bodyid.tolist()}
    joints |= {"point": m.jnt_pos.tolist(), "axis": m.jnt_axis.tolist(), "range": m.jnt_range.tolist()}
    joints |= {"limited": m.jnt_limited.tolist(), "rest": m.qpos0[m.jnt_qposadr].tolist()}
    joints |= {"force": m.jnt_actfrcrange.tolist(), "force_limited": m.jnt_actfrclimited.tolist()}
    sites = {"name": [m.site(i).name for i in range(m.nsite)], "body": m.site_bodyid.tolist()}
    bodies |= {"position": m.body_pos.tolist(), "quaternion": m.body_quat.tolist()}
    sites |= {"position": m.site_pos.tolist(), "quaternion": m.site_quat.tolist()}
    couplings = [
        {"joint": one, "of": other, "coefficients": data}
        for one, other, kind, active, data in zip(
            m.eq_obj1id.tolist(),
            m.eq_obj2id.tolist(),
            m.eq_type.tolist(),
            m.eq_active0.tolist(),
            m.eq_data[:, :5].tolist(),
            strict=True,
        )
        if kind == mujoco.mjtEq.mjEQ_JOINT and active
    ]
    return {"bodies": bodies, "joints": joints, "sites": sites, "couplings": couplings}


def answered(text: str) -> dict[str, Any]:
    """The compiled tree of an MJCF, or the error that MuJoCo has about it."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of masses that are not the file's
            return _tree(mujoco.MjSpec.from_string(text).compile())
    except ValueError as error:
        return {"error": str(error)}


def main() -> None:
    """Answer one request."""
    end_with_parent()
    request = json.load(sys.stdin)
    limit(request["seconds"], request["memory"])
    mujoco.set_mju_user_warning(lambda _: None)  # it would write a file
    json.dump(answered(request["text"]), sys.stdout)


if __name__ == "__main__":
    main()
