"""The view from Python and over HTTP, without a browser."""

from __future__ import annotations

import base64
import gc
import http.client
import json
import os
import socket
import struct
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from view_support import LOOPBACK, children, listening

import pinscrew as ps
from pinscrew.ground.errors import ViewError
from pinscrew.view import notebook, prepare
from pinscrew.view.meshcat import View
from pinscrew.view.server import HOST


@pytest.fixture
def view() -> Iterator[View]:
    with ps.show(ps.load("scara"), [0.1, 0.2, 0.1], open_browser=False, port=17000) as shown:
        yield shown


def port_of(view: View) -> int:
    return int(view.url.rstrip("/").rpartition(":")[2])


def get(view: View, path: str = "/", **headers: str) -> tuple[int, bytes]:
    connection = http.client.HTTPConnection(HOST, port_of(view), timeout=10)
    try:
        connection.request("GET", path, headers=headers)
        answer = connection.getresponse()
        return answer.status, answer.read()
    finally:
        connection.close()


class Page:
    """A page's side of the connection, by hand: just enough of the WebSocket protocol."""

    def __init__(self, view: View, origin: str | None = None, token: str | None = None) -> None:
        port = port_of(view)
        token = view._server.token if token is None else token
        self.socket = socket.create_connection((HOST, port), timeout=10)
        key = base64.b64encode(os.urandom(16)).decode()
        lines = [
            f"GET /live/{token} HTTP/1.1",
            f"Host: {HOST}:{port}",
            "Upgrade: websocket",
            "Connection: Upgrade",
            f"Sec-WebSocket-Key: {key}",
            "Sec-WebSocket-Version: 13",
            f"Origin: {f'http://{HOST}:{port}' if origin is None else origin}",
        ]
        self.socket.sendall(("\r\n".join(lines) + "\r\n\r\n").encode())
        self.stream = self.socket.makefile("rb")
        self.status = int(self.stream.readline().split()[1])
        while self.stream.readline() not in (b"\r\n", b""):
            pass

    def hear(self, kind: str) -> dict[str, Any]:
        """The next message of a kind."""
        while True:
            head = self.stream.read(2)
            length = head[1] & 127
            if length in (126, 127):
                length = int.from_bytes(self.stream.read(2 if length == 126 else 8), "big")
            message: dict[str, Any] = json.loads(self.stream.read(length))
            if message["type"] == kind:
                return message

    def say(self, text: str) -> None:
        data = text.encode()
        assert len(data) < 65536
        mask = b"\1\2\3\4"
        masked = bytes(byte ^ mask[i % 4] for i, byte in enumerate(data))
        self.socket.sendall(b"\x81\xfe" + len(data).to_bytes(2, "big") + mask + masked)

    def close(self) -> None:
        self.stream.close()
        self.socket.close()


def eventually(condition: Any) -> None:
    """Wait for what another thread is about to do."""
    for _ in range(1000):
        if condition():
            return
        time.sleep(0.01)
    raise AssertionError("it did not happen")


def test_the_page_is_served_to_this_computer_alone(view: View) -> None:
    status, body = get(view)
    assert status == 200
    assert b"scara_rrp" in body
    listens = [entry for entry in listening(os.getpid()) if entry[1] == port_of(view)]
    assert listens == [(LOOPBACK, port_of(view))]
    started = [
        pid for pid in children(os.getpid()) if b"expansions.py" not in Path(f"/proc/{pid}/cmdline").read_bytes()
    ]
    assert started == [] or "PYTEST_XDIST_WORKER" in os.environ


def test_another_name_for_this_computer_is_refused(view: View) -> None:
    assert get(view, Host="evil.example")[0] == 403
    page = Page(view, origin="http://evil.example")
    assert page.status == 403
    page.close()


def test_a_page_of_another_view_is_refused(view: View) -> None:
    for token in ("", "0123456789ABCDEF", "0123456789abcdef0"):
        page = Page(view, token=token)
        assert page.status == 404
        page.close()
    page = Page(view, token=f"{0:016x}")
    page.say('{"q": [1, 2, 0.3]}')
    head = page.stream.read(2)
    assert (head[0] & 15, page.stream.read(2)) == (8, (4001).to_bytes(2, "big")), "sent away, and told nothing"
    page.close()
    assert view.q.tolist() == [0.1, 0.2, 0.1]


def test_pages_follow_each_other_within_reason(view: View) -> None:
    first, second = Page(view), Page(view)
    second.hear("hello")
    first.say('{"q": [1, 2, 0.3], "tip": "nowhere"}')
    told = second.hear("state")
    assert (told["q"], told["tip"]) == ([1, 2, 0.3], "tool")
    first.close()
    second.close()


def test_other_paths_lead_nowhere(view: View) -> None:
    for path in ("/static/main.min.js", "/../../etc/passwd", "/live/x"):
        assert get(view, path)[0] == 404


def test_the_configuration_goes_both_ways(view: View) -> None:
    page = Page(view)
    assert page.status == 101
    assert page.hear("hello")["q"] == [0.1, 0.2, 0.1]
    view.q = [0.3, 0.4, 0.05]
    assert page.hear("state")["q"] == [0.3, 0.4, 0.05]
    page.say(json.dumps({"type": "state", "q": [1, 2, 0.3], "tip": "link2", "kind": "body", "draw": ["frames"]}))
    eventually(lambda: view.q.tolist() == [1, 2, 0.3])
    assert view.tip == "link2"
    assert '"kind":"body","draw":["frames"]' in view.html()
    page.close()


@pytest.mark.parametrize(
    "said", ["nonsense", "[1]", '{"q": [1]}', '{"q": [1, 2, 1e999]}', '{"q": "x", "tip": 5}', "{}"]
)
def test_a_page_may_say_anything(view: View, said: str) -> None:
    page = Page(view)
    page.say(said)
    page.say('{"qd": [7, 8, 9]}')
    eventually(lambda: view.qd.tolist() == [7, 8, 9])
    assert view.q.tolist() == [0.1, 0.2, 0.1]
    page.close()


def test_an_animation_is_sent_and_ends_at_its_last(view: View) -> None:
    page = Page(view)
    trajectory = np.linspace([0, 0, 0], [1, 1, 0.2], 5)
    view.animate(trajectory, fps=50)
    message = page.hear("animate")
    assert message["animation"] == {"trajectory": trajectory.tolist(), "fps": 50}
    assert view.q.tolist() == [1, 1, 0.2]
    assert '"fps":50' in view.html()
    page.close()


@pytest.mark.parametrize(
    ("trajectory", "fps", "code"),
    [([], 30, "shape"), ([[1, 2]], 30, "shape"), ([[1, 2, np.nan]], 30, "not-finite"), ([[1, 2, 3]], 0, "fps")],
)
def test_bad_animations(view: View, trajectory: Any, fps: float, code: str) -> None:
    with pytest.raises(ps.PinscrewError) as caught:
        view.animate(trajectory, fps)
    assert caught.value.code == code


def test_bad_configurations(view: View) -> None:
    for q, code in (([1, 2], "shape"), ([1, 2, np.inf], "not-finite"), ("abc", "not-numbers")):
        with pytest.raises(ps.PinscrewError) as caught:
            view.q = q
        assert caught.value.code == code
    with pytest.raises(ps.PinscrewError, match="no frame"):
        view.tip = "nothing"
    assert view.q.tolist() == [0.1, 0.2, 0.1]


def test_a_taken_port_gives_the_next(view: View) -> None:
    with ps.show(ps.load("scara"), open_browser=False, port=port_of(view)) as second:
        assert port_of(second) > port_of(view)
        assert get(second)[0] == 200


def test_closing_leaves_no_socket_and_no_thread(view: View) -> None:
    port, page = port_of(view), Page(view)
    view.close()
    view.close()
    assert (LOOPBACK, port) not in listening(os.getpid())
    assert not [thread for thread in threading.enumerate() if thread.name.endswith(f"on {port}")]
    assert not view.alive
    with pytest.raises(ViewError, match="stopped"):
        view.q = [0, 0, 0]
    page.close()


def test_a_view_that_nobody_holds_closes() -> None:
    shown = ps.show(ps.load("one_joint"), open_browser=False, port=17000)
    port = port_of(shown)
    del shown
    gc.collect()
    eventually(lambda: (LOOPBACK, port) not in listening(os.getpid()))


@pytest.mark.slow
def test_two_thousand_loads_leave_the_server_answering(view: View) -> None:
    """meshcat's own server freezes after some five hundred: it prints a line for each into a pipe nobody reads."""
    connection = http.client.HTTPConnection(HOST, port_of(view), timeout=10)
    for i in range(2000):
        connection.request("GET", "/")
        assert connection.getresponse().read().endswith(b"</html>\n")
        if i % 10 == 0:
            page = Page(view)
            assert page.status == 101
            page.close()
    connection.close()
    assert view.alive
    assert get(view)[0] == 200


def test_the_file_refers_to_nothing_outside(view: View) -> None:
    page = view.html()
    assert "connect-src 'none'" in page.split("<style>")[0].replace("&#39;", "'")
    assert " src=" not in page.split("<script", maxsplit=1)[0]
    assert '"live":""' in page


def test_the_notebook_gets_a_frame(monkeypatch: pytest.MonkeyPatch) -> None:
    robot = ps.load("scara")
    shown = robot._repr_html_()
    assert shown.startswith('<iframe title="scara_rrp" sandbox="allow-scripts"')
    assert shown.count("<") == 2
    monkeypatch.setattr(notebook, "page", lambda *_: "\"'<>&")
    assert 'srcdoc="&quot;&#39;&lt;&gt;&amp;"' in notebook.robot(robot)


def test_only_what_exists_is_drawn() -> None:
    model = prepare.prepare(ps.load("scara"))
    with pytest.raises(ps.PinscrewError, match="nothing"):
        prepare.begin(model, draw=["nothing"])  # type: ignore[list-item]


def test_a_file_that_cannot_be_written(view: View, tmp_path: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("pinscrew.view.png.picture", lambda *_: pytest.fail("there was a picture"))
    for save in (view.save_html, view.save_png):  # before the browser is started
        with pytest.raises(ps.PinscrewError) as caught:
            save(tmp_path / "nowhere" / "a")
        assert caught.value.code == "unwritable"


SAID = {
    "no JSON": "{",
    "a number": "7",
    "10⁴ lists in each other": "[" * 10_000 + "]" * 10_000,
    "10⁴ objects in each other": '{"q":' * 10_000 + "1" + "}" * 10_000,
    "an integer of 400 digits": '{"type":"state","q":[1' + "0" * 400 + ",0,0]}",
    "an integer of 5000 digits": '{"type":"state","q":[1' + "0" * 5000 + ",0,0]}",
    "no number": '{"type":"state","q":[NaN,0,0],"qd":[Infinity,0,0]}',
    "lists for names": '{"type":"state","q":{"a":1},"tip":["tool"],"kind":[],"draw":[[],{}]}',
    "half a surrogate": '{"type":"state","tip":"\\ud800"}',
}


@pytest.mark.parametrize("text", SAID.values(), ids=SAID)
def test_what_no_page_of_ours_says(view: View, text: str, caplog: pytest.LogCaptureFixture) -> None:
    """It is not heeded; who said it stays connected, and so do the others."""
    page, other = Page(view), Page(view)
    for each in (page, other):
        each.hear("hello")
    page.say(text)
    page.say(json.dumps({"type": "state", "q": [0.5, 0.0, 0.0]}))
    while other.hear("state")["q"] != [0.5, 0.0, 0.0]:
        pass
    view.q = [0.25, 0.0, 0.0]
    assert page.hear("state")["q"] == [0.25, 0.0, 0.0]
    assert caplog.records == []
    for each in (page, other):
        each.close()


def test_pages_that_vanish_while_another_sends(view: View, caplog: pytest.LogCaptureFixture) -> None:
    """With a reset in the middle of what is sent to them, or with a word of farewell: it costs the sender nothing."""
    sender = Page(view)
    sender.hear("hello")
    for k in range(40):
        gone = [Page(view) for _ in range(3)]
        for page in gone:
            page.hear("hello")
            page.socket.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        for i in range(20):
            sender.say(json.dumps({"type": "state", "q": [0.01 * k, 0.001 * i, 0.0]}))
            if i == 3:
                gone[0].close()
            if i == 10:
                gone[1].socket.sendall(b"\x88\x80\0\0\0\0")  # it closes, and has not gone yet
        view.q = [1.0, 0.01 * k, 0.0]
        assert sender.hear("state")["q"] == [1.0, 0.01 * k, 0.0]
        for page in gone[1:]:
            page.close()
    gc.collect()
    assert caplog.records == []
    sender.close()
