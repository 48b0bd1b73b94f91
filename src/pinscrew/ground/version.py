"""The version of pinscrew, and of the packages that an answer was made with."""

__all__ = ["__version__", "version_of"]

__version__ = "0.1.0"  # the build reads it from this line, so it has no annotation


def version_of(distribution: str) -> str:
    """The version of an installed distribution, or ``"unknown"`` where its metadata can't be read.

    A zipped application or a process that may not enter ``site-packages`` has modules without metadata; a report
    says so instead of ending for it.
    """
    if distribution == "pinscrew":
        return __version__
    import importlib.metadata  # here, since it takes 20 ms that no command should wait for

    try:
        return importlib.metadata.version(distribution)
    except importlib.metadata.PackageNotFoundError:
        return "unknown"
