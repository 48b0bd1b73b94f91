"""Figures as files: their formats, the same bytes each time, and nothing half-written."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from command_line import process
from pinscrew.ground import files
from pinscrew.ground.errors import InputError, MissingExtraError
from pinscrew.view import figures

pytest.importorskip("matplotlib")

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def drawn() -> Figure:
    figure = figures.figure(2.0, 1.5)
    axes = figure.subplots()
    axes.plot([0, 1, 2], [0, 1, 0], label="words")
    axes.legend()
    return figure


@pytest.mark.parametrize(("suffix", "magic"), [(".png", b"\x89PNG"), (".svg", b"<?xml"), (".PDF", b"%PDF")])
def test_formats(tmp_path: Path, suffix: str, magic: bytes) -> None:
    """The same bytes each time: no date, no random id, nobody's version."""
    one, other = tmp_path / f"a{suffix}", tmp_path / f"b{suffix}"
    figures.save(drawn(), one)
    figures.save(drawn(), other)
    data = one.read_bytes()
    assert data.startswith(magic)
    assert data == other.read_bytes()
    assert not any(word in data for word in (b"CreationDate", b"<dc:date>", b"Matplotlib v"))
    if suffix == ".svg":
        assert b">words</text>" in data
    assert "matplotlib.pyplot" not in sys.modules


@pytest.mark.parametrize("name", ["a.gif", "a", "a.png.txt", ".png"])
def test_other_suffixes(tmp_path: Path, name: str) -> None:
    with pytest.raises(InputError, match=r"can't be written with the suffix '.*'; use \.png, \.svg, \.pdf"):
        figures.check(tmp_path / name)
    with pytest.raises(InputError):
        figures.save(drawn(), tmp_path / name)
    assert list(tmp_path.iterdir()) == []


def test_no_folder(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="can't be written") as caught:
        figures.save(drawn(), tmp_path / "none" / "a.png")
    assert caught.value.code == "unwritable"
    assert list(tmp_path.iterdir()) == []


def test_without_matplotlib(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    for call in (figures.figure, lambda: figures.check(Path("a.png"))):
        with pytest.raises(MissingExtraError, match=r'pip install "pinscrew\[plot\]"') as caught:
            call()
        assert caught.value.extra == "plot"


def test_settings_of_matplotlib_that_it_refuses() -> None:
    """Such as a backend that does not exist; ours needs none."""
    done = process("workspace", "one_joint", "--samples", "2", "--plot", "a.png", MPLBACKEND="none")
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.count("\n") == 1
    assert "matplotlib can't be loaded with its settings" in done.stderr


def test_files_are_written_whole_or_not_at_all(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "a.txt"
    files.write(file, b"first")

    def full(*_: Path) -> Path:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "replace", full)
    with pytest.raises(InputError, match=r"a\.txt: can't be written \(No space left on device\)"):
        files.write(file, b"second")
    assert file.read_bytes() == b"first"
    assert list(tmp_path.iterdir()) == [file]
    with pytest.raises(InputError, match="can't be written"):
        files.write(Path("a\0b"), b"")
