"""``pinscrew show``: as a process where it stays, in this one where it ends by itself."""

from __future__ import annotations

import http.client
import signal
from pathlib import Path

import pytest
from view_support import LOOPBACK, children, command, listening

from command_line import run


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_a_signal_ends_it_and_leaves_nothing(number: signal.Signals) -> None:
    with command("scara", "-q", "0.1,0.2,0.1", "--no-open", "--port", "17300") as process:
        assert process.stdout is not None
        url = process.stdout.readline().strip()
        port = int(url.rstrip("/").rpartition(":")[2])
        assert url == f"http://127.0.0.1:{port}/"
        connection = http.client.HTTPConnection("127.0.0.1", port, timeout=10)
        connection.request("GET", "/")
        assert connection.getresponse().read().endswith(b"</html>\n")
        assert listening(process.pid) == [(LOOPBACK, port)]
        assert children(process.pid) == []
        process.send_signal(number)
        _, said = process.communicate(timeout=30)
        assert process.returncode == 0
        assert said == "pinscrew: Ctrl-C ends\n"
        connection.close()
    with pytest.raises(ConnectionRefusedError):
        http.client.HTTPConnection("127.0.0.1", port, timeout=10).connect()


def test_without_a_browser_the_address_is_printed() -> None:
    with command("scara", "--port", "17320") as process:
        assert process.stdout is not None
        assert process.stderr is not None
        assert process.stdout.readline().startswith("http://127.0.0.1:")
        assert "no browser" in process.stderr.readline()
        process.terminate()
        assert process.wait(30) == 0


def test_the_page_as_a_file(tmp_path: Path) -> None:
    file = tmp_path / "arm.html"
    done = run("show", "two_joint", "--qd", "1,0.5", "--tip", "B", "--draw", "screws,circles", "--html", str(file))
    assert (done.status, done.out, done.err) == (0, "", "")
    text = file.read_text(encoding="utf-8")
    assert '"qd":[1.0,0.5]' in text
    assert '"draw":["links","screws","circles"]' in text
    assert '"tip":"B"' in text


def test_velocities_by_name(tmp_path: Path) -> None:
    file = tmp_path / "arm.html"
    assert run("show", "two_joint", "--qd", "joint2=pi/4", "--html", str(file)).status == 0
    assert '"qd":[0.0,0.7853981633974483]' in file.read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["nothing"], "there is no robot or file"),
        (["scara", "-q", "1,2"], "takes 3"),
        (["scara", "--qd", "1,2"], "takes 3"),
        (["scara", "--qd", "joint9=1"], "joint9"),
        (["scara", "--qd", "a,b,c"], "is not a number"),
        (["scara", "--tip", "nothing"], "there is no frame"),
        (["scara", "--draw", "nothing"], "can't be drawn"),
        (["scara", "--html", "/nowhere/a.html"], "can't be written"),
        (["scara", "--port", "0"], "not in the range"),
    ],
)
def test_bad_words(words: list[str], said: str) -> None:
    done = run("show", *words, "--no-open")
    assert done.status == 2
    assert said in done.err
    assert "Traceback" not in done.err


def test_a_picture_without_a_browser(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    done = run("show", "scara", "--png", tmp_path / "a.png")
    assert done.status == 2
    assert "none is on the PATH" in done.err
    assert not (tmp_path / "a.png").exists()


@pytest.mark.parametrize(
    ("script", "said"), [("echo broken >&2; exit 1", "made no picture (broken)"), ("exit 0", "it says nothing")]
)
def test_a_browser_that_fails(script: str, said: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", f"{tmp_path}:/bin:/usr/bin")
    browser = tmp_path / "chromium"
    browser.write_text(f"#!/bin/sh\n{script}\n")
    browser.chmod(0o755)
    done = run("show", "scara", "--png", tmp_path / "a.png")
    assert done.status == 2
    assert said in done.err


def test_a_mesh_outside_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "robot" / "r.urdf"
    file.parent.mkdir()
    mesh = '<visual><geometry><mesh filename="../secret.stl"/></geometry></visual>'
    file.write_text(f'<robot name="r"><link name="base">{mesh}</link></robot>')
    (tmp_path / "secret.stl").write_text("solid s\nendsolid s\n")
    done = run("show", file, "--html", tmp_path / "a.html")
    assert done.status == 2
    assert "outside" in done.err
    assert not (tmp_path / "a.html").exists()


def test_a_missing_mesh_is_warned_of_once(tmp_path: Path) -> None:
    file = tmp_path / "r.urdf"
    mesh = '<visual><geometry><mesh filename="gone.stl"/></geometry></visual>'
    file.write_text(f'<robot name="r"><link name="base">{mesh}{mesh}</link></robot>')
    done = run("show", file, "--html", tmp_path / "a.html")
    assert done.status == 0
    assert done.err.count("warning") == 1
    assert "gone.stl" in done.err
