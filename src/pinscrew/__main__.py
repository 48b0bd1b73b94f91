"""``python -m pinscrew``, and the command ``pinscrew``."""

import sys

__all__ = ["run"]

INTERRUPTED = 130
"""Exit status after Ctrl-C, as in `pinscrew.cli`."""


def run() -> None:
    """Run the command; Ctrl-C ends it in silence even while its modules are loaded."""
    try:
        from pinscrew.cli import main
    except KeyboardInterrupt:
        sys.exit(INTERRUPTED)
    main()


if __name__ == "__main__":
    run()
