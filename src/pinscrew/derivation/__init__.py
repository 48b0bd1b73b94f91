"""Layer 4: closed forms of a robot's kinematics, derived from its description, proved against both engines.

How it goes: `reading` and `arguments` turn a file's numbers into exact ones and symbols, `chain` composes them to
screws and a home pose, `trig` multiplies matrices in a normal form in which equal expressions are equal, `normal_forms`
forms every item of the coursework, `factoring` writes entries as a person would, `proof` asks both engines, and the
modules of reports write it all down.
"""

from importlib.util import find_spec

from pinscrew.ground.errors import MissingExtraError

if find_spec("sympy") is None:
    raise MissingExtraError("sympy is not installed", "derive")
