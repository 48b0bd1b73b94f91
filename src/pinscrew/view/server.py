"""A small web server in a thread of our own process: it serves one page and talks to it.

It listens on the loopback interface only, on the next free port if the one asked for is taken, and answers only
requests that name it so: another site can't reach it through a name of its own that points here. There is no child
process; the thread ends with `close`, or with the process.
"""

from __future__ import annotations

import asyncio
import concurrent.futures
import contextlib
import errno
import json
import secrets
import socket
import threading
from collections.abc import Callable
from typing import Any, Final, TypeVar

from pinscrew.ground.errors import ViewError

__all__ = ["HOST", "PORT", "Server"]

HOST: Final = "127.0.0.1"
PORT: Final = 7000
"""Where a port is looked for first, as meshcat does."""
ATTEMPTS: Final = 200
PATIENCE: Final = 5.0
"""Seconds after which a server that does not answer counts as dead."""
BEAT: Final = 1.0
"""Seconds between words to the page, so that it knows that the server lives."""
RESTARTED: Final = 4001
"""Code by which a page is sent away that another server has served: it loads itself anew."""
LONGEST: Final = 2**20
"""Bytes of the longest message from a page."""

_T = TypeVar("_T")


class Server:
    """A server of one page.

    Attributes:
        url: where the page is.
        token: what a page must name to talk to this server; one left over from another view on this port can't.
    """

    def __init__(
        self,
        page: Callable[[], str],
        greeting: Callable[[], dict[str, Any]],
        hear: Callable[[dict[str, Any]], dict[str, Any]],
        port: int | None = None,
    ) -> None:
        """Start to listen.

        Args:
            page: makes the page's HTML; called in the server's thread for each request, as are the others.
            greeting: what to tell a page that connects.
            hear: takes what a page says, and gives what the other pages are to be told.
            port: where to look for a free port first; by default `PORT`.

        Raises:
            ViewError: if no port is free, or the server does not start.
        """
        self._page, self._greeting, self._hear = page, greeting, hear
        self._pages: set[Any] = set()
        self._socket = _listen(PORT if port is None else port)
        self.port: int = self._socket.getsockname()[1]
        self.url = f"http://{HOST}:{self.port}/"
        self.token = secrets.token_hex(8)
        self._loop: asyncio.AbstractEventLoop | None = None
        self._ready: concurrent.futures.Future[None] = concurrent.futures.Future()
        self._thread = threading.Thread(target=self._run, name=f"pinscrew view on {self.port}", daemon=True)
        self._thread.start()
        try:
            self._ready.result(PATIENCE)
        except Exception as error:
            self._socket.close()
            what = f"the server did not start ({type(error).__name__}: {error})"
            raise ViewError("server", what, where=self.url) from error

    @property
    def alive(self) -> bool:
        """Whether the server answers; known within `PATIENCE` seconds."""
        try:
            self._call(lambda: None)
        except ViewError:
            return False
        return True

    def tell(self, message: dict[str, Any]) -> None:
        """Send a message to every page.

        Raises:
            ViewError: if the server is dead.
        """
        text = json.dumps(message, allow_nan=False)
        self._call(lambda: self._send(text))

    def close(self) -> None:
        """Stop listening, close the pages' connections, and end the thread; again does nothing."""
        if self._loop is not None and self._thread.is_alive():
            with contextlib.suppress(RuntimeError):  # the loop has just closed of itself
                self._loop.call_soon_threadsafe(self._stopped.set)
            if threading.current_thread() is not self._thread:
                self._thread.join(PATIENCE)
        self._socket.close()

    def _call(self, function: Callable[[], _T]) -> _T:
        """The function's answer, from the server's thread."""
        gone = ViewError("server", "the view's server has stopped", where=self.url, remedy="show the robot again")
        if self._loop is None or not self._thread.is_alive():
            raise gone
        if threading.current_thread() is self._thread:
            return function()

        async def answer() -> _T:
            return function()

        try:
            return asyncio.run_coroutine_threadsafe(answer(), self._loop).result(PATIENCE)
        except (RuntimeError, concurrent.futures.TimeoutError, concurrent.futures.CancelledError):
            raise gone from None

    def _send(self, text: str, but: Any = None) -> None:
        """Send a text to every page ``but`` one. A page that has gone meanwhile is no error of who speaks."""
        from tornado.websocket import WebSocketClosedError

        for page in tuple(self._pages - {but}):
            try:
                # What it learns of a page that goes while it writes comes later, by the future; nobody else asks it.
                page.write_message(text).add_done_callback(asyncio.Future.exception)
            except WebSocketClosedError:
                self._pages.discard(page)

    def _run(self) -> None:
        try:
            asyncio.run(self._serve())
        except Exception as error:  # reported by the constructor, or by the next call
            if not self._ready.done():
                self._ready.set_exception(error)

    async def _serve(self) -> None:
        from tornado.httpserver import HTTPServer

        self._loop = asyncio.get_running_loop()
        self._stopped = asyncio.Event()
        server = HTTPServer(self._application(), max_body_size=LONGEST, max_buffer_size=LONGEST)
        server.add_sockets([self._socket])
        self._ready.set_result(None)
        while not self._stopped.is_set():
            self._send('{"type":"beat"}')
            try:
                await asyncio.wait_for(self._stopped.wait(), BEAT)
            except asyncio.TimeoutError:
                continue
        server.stop()
        for page in tuple(self._pages):
            page.close()
        await asyncio.wait_for(server.close_all_connections(), BEAT)

    def _application(self) -> Any:
        import tornado.web
        import tornado.websocket

        own = self
        names = {f"{HOST}:{self.port}", f"localhost:{self.port}"}

        class Page(tornado.web.RequestHandler):
            def prepare(self) -> None:
                if self.request.host not in names:
                    raise tornado.web.HTTPError(403)

            def get(self) -> None:
                self.set_header("Content-Type", "text/html; charset=utf-8")
                self.set_header("Cache-Control", "no-store")
                self.set_header("X-Frame-Options", "SAMEORIGIN")
                self.write(own._page())

        class Live(tornado.websocket.WebSocketHandler):
            def check_origin(self, origin: str) -> bool:
                return self.request.host in names and origin.removeprefix("http://") in names

            def open(self, *given: str) -> None:
                if given != (own.token,):
                    self.close(RESTARTED)
                    return
                greeting = json.dumps(own._greeting(), allow_nan=False)
                self.write_message(greeting).add_done_callback(asyncio.Future.exception)
                own._pages.add(self)

            def on_message(self, message: str | bytes) -> None:
                if self not in own._pages:
                    return
                try:
                    said = json.loads(message)
                except (ValueError, RecursionError):  # no JSON, or lists in lists in lists: no page of ours says such
                    return
                if isinstance(said, dict):
                    own._send(json.dumps(own._hear(said), allow_nan=False), but=self)

            def on_close(self) -> None:
                own._pages.discard(self)

        return tornado.web.Application(
            [("/", Page), ("/live/([0-9a-f]{16})", Live)],
            log_function=lambda _: None,
            websocket_max_message_size=LONGEST,
        )


def _listen(port: int) -> socket.socket:
    """A socket that listens on the loopback interface, on ``port`` or the next that is free."""
    for candidate in range(port, min(port + ATTEMPTS, 65536)) if port else (0,):
        made = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
        try:
            made.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            made.bind((HOST, candidate))
            made.listen(128)
        except OSError as error:
            made.close()
            if error.errno not in (errno.EADDRINUSE, errno.EACCES):
                raise ViewError("server", f"can't listen ({error.strerror})", where=f"{HOST}:{candidate}") from None
            continue
        made.setblocking(False)
        return made
    what = f"no port from {port} to {port + ATTEMPTS - 1} is free"
    raise ViewError("server", what, where=HOST, remedy="name another with port=..., or --port")
