"""Serves the page of `tilt live` to this machine only, with the board's lines as server-sent events and commands by POST.

Other sites open in the browser must neither read nor type: each request carries a random token (in the opened address after the #, which
browsers never send by themselves), the Host must be this server's (another name that points at 127.0.0.1 is refused), and nothing allows
another origin.
"""
import contextlib
import http.server
import json
import secrets
import threading
import time
import urllib.parse

from tilt.errors import TiltError
from tilt.whole_page import whole

PAGE = "live.html"
ADDRESS = "127.0.0.1"
ALIVE_S = 5.0      # keep-alive, by which a closed browser is noticed
BATCH_S = 0.02     # lines that arrive within this time are one event
LONGEST_BODY = 200
SAFE_HEADERS = {"Cache-Control": "no-store", "X-Content-Type-Options": "nosniff", "X-Frame-Options": "DENY", "Referrer-Policy": "no-referrer",
                "Cross-Origin-Resource-Policy": "same-origin"}


def event(number, kind, data):
    """One server-sent event; JSON keeps its data on one line."""
    return f"id: {number}\nevent: {kind}\ndata: {json.dumps(data)}\n\n".encode("ascii")


def events_of(entries):
    """The entries as events; consecutive lines are joined into one."""
    parts, joined, last = [], [], 0
    for number, kind, data in entries:
        if kind == "lines":
            joined.append(data)
            last = number
            continue
        if joined:
            parts.append(event(last, "lines", b"".join(joined).decode("latin-1")))
            joined = []
        parts.append(event(number, kind, data))
    if joined:
        parts.append(event(last, "lines", b"".join(joined).decode("latin-1")))
    return b"".join(parts)


class Handler(http.server.BaseHTTPRequestHandler):
    """One request, in its own thread."""

    server_version, sys_version = "tilt", ""

    def log_message(self, *_):
        """Prints nothing: the terminal is for what a person must know."""

    def do_GET(self):
        where = urllib.parse.urlsplit(self.path)
        if not self._is_for_us():
            return
        if where.path == "/":
            self._answer(200, self.server.page, "text/html; charset=utf-8")
        elif where.path == "/events":
            if self._knows(urllib.parse.parse_qs(where.query).get("token", [""])[0]):
                self._stream()
        else:
            self._refuse(404, "nothing here")

    def do_POST(self):
        if not self._is_for_us() or not self._knows(self.headers.get("X-Tilt-Token", "")):
            return
        if self.path != "/send":
            self._refuse(404, "nothing here")
            return
        size = self.headers.get("Content-Length", "")
        if not size.isdecimal() or int(size) > LONGEST_BODY:
            self._refuse(413, f"a command of more than {LONGEST_BODY} bytes")
            return
        try:
            self.server.board.send(self.rfile.read(int(size)).decode("utf-8", "replace").strip())
        except TiltError as error:
            self._refuse(409, str(error))
            return
        self._answer(204, b"", "text/plain")

    def _is_for_us(self):
        own = {f"{name}:{self.server.server_port}" for name in (ADDRESS, "localhost")}
        origin = self.headers.get("Origin")
        if self.headers.get("Host", "") in own and (origin is None or origin in {f"http://{name}" for name in own}):
            return True
        self._refuse(403, "this request does not come from the page of tilt live")
        return False

    def _knows(self, token):
        if secrets.compare_digest(token.encode("utf-8", "replace"), self.server.token.encode("ascii")):
            return True
        self._refuse(403, "no valid token: open the address that tilt live has printed")
        return False

    def _refuse(self, status, why):
        self.close_connection = True
        self._answer(status, why.encode("utf-8"), "text/plain; charset=utf-8")

    def _answer(self, status, body, kind):
        self.send_response(status)
        self._headers({"Content-Type": kind, "Content-Length": str(len(body))})
        self.wfile.write(body)

    def _headers(self, more):
        for name, value in {**SAFE_HEADERS, **more}.items():
            self.send_header(name, value)
        self.end_headers()

    def _stream(self):
        last = self.headers.get("Last-Event-ID", "")
        number = int(last) if last.isdecimal() else 0
        self.send_response(200)
        self._headers({"Content-Type": "text/event-stream", "Connection": "close"})
        self.close_connection = True
        with self.server.stream():
            self.wfile.write(b"retry: 500\n\n")
            over = False
            while not over:
                over = self.server.ending.is_set()
                number, ended = self._pass_on(number)
                over = over or ended
                time.sleep(BATCH_S)

    def _pass_on(self, number):
        """(number of the newest entry sent to the page, whether the end was among them)"""
        entries, missed = self.server.feed.after(number, ALIVE_S)
        if missed:
            self.wfile.write(event(entries[-1][0] if entries else number, "missed", missed))
        self.wfile.write(events_of(entries) or b": alive\n\n")
        return entries[-1][0] if entries else number, any(kind == "ended" for _, kind, _ in entries)


class Server(http.server.ThreadingHTTPServer):
    """Serves from creation until close(). `address` is the one to open; TiltError if the port is taken."""

    daemon_threads = True
    allow_reuse_address = True

    def __init__(self, feed, board, port=0):
        self.feed, self.board = feed, board
        self.token = secrets.token_urlsafe(18)
        self.ending = threading.Event()
        self.streams, self.streams_changed = 0, threading.Condition()
        self.page = whole(PAGE).encode("utf-8")
        try:
            super().__init__((ADDRESS, port), Handler)
        except (OSError, OverflowError) as error:
            raise TiltError(f"{ADDRESS}:{port}: {getattr(error, 'strerror', None) or error}: choose another --port-http") from error
        self.address = f"http://{ADDRESS}:{self.server_port}/#{self.token}"
        self._thread = threading.Thread(target=self.serve_forever, args=(0.05,), name="pages", daemon=True)
        self._thread.start()

    @contextlib.contextmanager
    def stream(self):
        """Sends the events to one page, which may close at any time."""
        with self.streams_changed:
            self.streams += 1
        try:
            with contextlib.suppress(OSError):
                yield
        finally:
            with self.streams_changed:
                self.streams -= 1
                self.streams_changed.notify_all()

    def close(self):
        """Sends the pages all entries and the end, then stops."""
        self.feed.put("ended", "")
        self.ending.set()
        with self.streams_changed:
            self.streams_changed.wait_for(lambda: self.streams == 0, ALIVE_S)
        self.shutdown()
        self.server_close()

    def handle_error(self, request, client_address):
        """Ignores a browser that closes the connection during an answer."""
