"""The version of pinscrew; the build reads it from this line, so it has no annotation."""

__all__ = ["__version__"]

__version__ = "0.1.0"
