"""``python -m pinscrew``."""

from pinscrew.cli import main

main()
