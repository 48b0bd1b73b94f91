"""Write the table and the pictures of robots in robots/README.md from the catalogue and the files.

python scripts/robots_table.py           # write
python scripts/robots_table.py --check   # exit status 1 if it is not up to date
"""

from __future__ import annotations

import sys

import pinscrew as ps
from pinscrew.description import catalogue

GALLERY = "../docs/gallery"
COLUMNS = 3
BEGIN, END = "<!-- robots_table.py: begin -->", "<!-- robots_table.py: end -->"
LETTERS = {"revolute": "R", "continuous": "R", "prismatic": "P"}
HEADER = ("name", "what it is", "from", "joints", "arguments", "also known as")


def joints(robot: ps.Robot) -> str:
    """The kinds of the joints on the way to the tip, such as RRP; a mimic joint in brackets."""
    motions = [robot.mechanism.motions[i] for i in robot.motions_above(robot.tip)]
    kinds = [(LETTERS[motion.joint.type], motion.joint.mimic) for motion in motions]
    return "".join(f"({letter})" if mimic else letter for letter, mimic in kinds)


def table() -> str:
    """The table, in Markdown."""
    rows = [HEADER, tuple("---" for _ in HEADER)]
    for entry in catalogue.bundled():
        arguments = catalogue.declared_arguments(entry.file)
        rows.append(
            (
                f"[`{entry.name}`]({entry.file.name})",
                entry.title,
                entry.coursework,
                joints(ps.load(entry.name)),
                " ".join(f"`{name}:={default}`" for name, default in arguments.items()),
                ", ".join(f"`{alias}`" for alias in entry.aliases),
            )
        )
    return "\n".join(f"| {' | '.join(row)} |" for row in rows)


def gallery() -> str:
    """The pictures that scripts/gallery.py makes, a few in a row."""
    cells = []
    for entry in catalogue.bundled():
        picture = f'<img src="{GALLERY}/{entry.name}.png" width="280" alt="{entry.title}">'
        cells.append(f'<td align="center">{picture}<br>{entry.name}</td>')
    rows = ["".join(cells[i : i + COLUMNS]) for i in range(0, len(cells), COLUMNS)]
    return "\n".join(["<table>", *(f"<tr>{row}</tr>" for row in rows), "</table>"])


def main() -> int:
    """Write the table, or tell whether it is up to date."""
    path = catalogue.robots_directory() / "README.md"
    text = path.read_text(encoding="utf-8")
    before, _, rest = text.partition(BEGIN)
    _, _, after = rest.partition(END)
    wanted = f"{before}{BEGIN}\n{table()}\n\n{gallery()}\n{END}{after}"
    if "--check" in sys.argv[1:]:
        if text != wanted:
            print(f"{path} is not up to date: run python scripts/robots_table.py", file=sys.stderr)
        return int(text != wanted)
    path.write_text(wanted, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
