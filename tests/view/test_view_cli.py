"""``pinscrew show`` as a process."""

from __future__ import annotations

import http.client
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from view_support import LOOPBACK, children, command, listening


def run(*words: str, **environment: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "pinscrew", "show", *words],
        capture_output=True,
        text=True,
        timeout=120,
        env=os.environ | environment,
    )


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
    done = run("two_joint", "--qd", "1,0.5", "--tip", "B", "--draw", "screws,circles", "--html", str(file))
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    text = file.read_text(encoding="utf-8")
    assert '"qd":[1.0,0.5]' in text
    assert '"draw":["links","screws","circles"]' in text
    assert '"tip":"B"' in text


def test_velocities_by_name(tmp_path: Path) -> None:
    file = tmp_path / "arm.html"
    assert run("two_joint", "--qd", "joint2=pi/4", "--html", str(file)).returncode == 0
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
    done = run(*words, "--no-open")
    assert done.returncode == 2
    assert said in done.stderr
    assert "Traceback" not in done.stderr


def test_a_picture_without_a_browser(tmp_path: Path) -> None:
    done = run("scara", "--png", str(tmp_path / "a.png"), PATH=str(tmp_path))
    assert done.returncode == 2
    assert "none is on the PATH" in done.stderr
    assert not (tmp_path / "a.png").exists()


@pytest.mark.parametrize(
    ("script", "said"), [("echo broken >&2; exit 1", "made no picture (broken)"), ("exit 0", "it says nothing")]
)
def test_a_browser_that_fails(script: str, said: str, tmp_path: Path) -> None:
    browser = tmp_path / "chromium"
    browser.write_text(f"#!/bin/sh\n{script}\n")
    browser.chmod(0o755)
    done = run("scara", "--png", str(tmp_path / "a.png"), PATH=f"{tmp_path}:/bin:/usr/bin")
    assert done.returncode == 2
    assert said in done.stderr


def test_a_mesh_outside_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "robot" / "r.urdf"
    file.parent.mkdir()
    mesh = '<visual><geometry><mesh filename="../secret.stl"/></geometry></visual>'
    file.write_text(f'<robot name="r"><link name="base">{mesh}</link></robot>')
    (tmp_path / "secret.stl").write_text("solid s\nendsolid s\n")
    done = run(str(file), "--html", str(tmp_path / "a.html"))
    assert done.returncode == 2
    assert "outside" in done.stderr
    assert not (tmp_path / "a.html").exists()


def test_a_missing_mesh_is_warned_of_once(tmp_path: Path) -> None:
    file = tmp_path / "r.urdf"
    mesh = '<visual><geometry><mesh filename="gone.stl"/></geometry></visual>'
    file.write_text(f'<robot name="r"><link name="base">{mesh}{mesh}</link></robot>')
    done = run(str(file), "--html", str(tmp_path / "a.html"))
    assert done.returncode == 0
    assert done.stderr.count("warning") == 1
    assert "gone.stl" in done.stderr
