"""Every error and warning of pinscrew, to catch: the public face of `pinscrew.ground.errors`."""

from pinscrew.ground.errors import (
    AmbiguousTipError,
    DescriptionError,
    EngineError,
    InputError,
    MissingExtraError,
    PinscrewError,
    PinscrewWarning,
    UnknownNameError,
    UnsupportedError,
    ViewError,
    XacroError,
)

__all__ = [
    "AmbiguousTipError",
    "DescriptionError",
    "EngineError",
    "InputError",
    "MissingExtraError",
    "PinscrewError",
    "PinscrewWarning",
    "UnknownNameError",
    "UnsupportedError",
    "ViewError",
    "XacroError",
]
