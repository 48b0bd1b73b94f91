"""What `derive` gives: closed forms, and what is found out about them."""

from __future__ import annotations

from functools import cached_property

from pinscrew.derivation import proof
from pinscrew.derivation.forms import ClosedForms
from pinscrew.derivation.singularities import Singularities, singularities

__all__ = ["Derivation"]


class Derivation(ClosedForms):
    """Closed forms of the kinematics of one frame, their proof and their singularities. Make one with `derive`."""

    @cached_property
    def singularities(self) -> Singularities:
        """Manipulability and singular configurations; see `pinscrew.derivation.singularities`."""
        return singularities(self)

    def prove(self, samples: int = 100, seed: int = 0) -> proof.Proof:
        """The largest difference from both engines over random configurations and lengths; see `proof.prove`."""
        return proof.prove(self, samples, seed)
