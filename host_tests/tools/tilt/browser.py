"""A headless Chromium for tests, driven by its DevTools protocol over two pipes (--remote-debugging-pipe: JSON, each message ended by a
zero byte; the browser reads descriptor 3 and writes descriptor 4)."""
import base64
import json
import os
import select
import shutil
import signal
import subprocess
import tempfile
import time

PROGRAM = next((path for path in map(shutil.which, ("chromium", "chromium-browser", "google-chrome", "chrome")) if path), None)
ABSENT = None if PROGRAM else "no Chromium here: sh tools/deps.sh live"
ANSWER_S = 120.0  # only reached when something is broken, however busy the machine
LAST_WORDS = 12  # lines of the browser that a failure shows


class Failed(Exception):
    """The browser refused, ended, or did not answer."""


def descriptors(reading, writing):
    """In the child, before the browser: its two pipes to where it looks for them, by way of numbers that neither is."""
    spare = [os.dup2(reading, 200), os.dup2(writing, 201)]
    for source, target in zip(spare, (3, 4)):
        os.dup2(source, target, inheritable=True)
        os.close(source)


class Browser:
    """`with Browser() as browser: page = browser.open(address)`"""

    def __init__(self, *options):
        self.folder = tempfile.mkdtemp(prefix="tilt-browser-")
        self._words = open(os.path.join(self.folder, "words.log"), "w+", encoding="utf-8", errors="replace")  # pylint: disable=consider-using-with
        ours, theirs = os.pipe(), os.pipe()
        words = [PROGRAM, "--headless", "--no-sandbox", "--disable-gpu", "--no-first-run", "--disable-background-networking", "--hide-scrollbars",
                 "--disable-dev-shm-usage", f"--user-data-dir={self.folder}", "--remote-debugging-pipe", "--window-size=1280,900", *options]
        self._program = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=self._words, stderr=self._words, close_fds=False,
                                         start_new_session=True, preexec_fn=lambda: descriptors(ours[0], theirs[1]))
        os.close(ours[0])
        os.close(theirs[1])
        self._write, self._read = ours[1], theirs[0]
        self._rest, self._number, self._answers = b"", 0, {}
        self.messages = []

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for end in (self._write, self._read):
            os.close(end)
        try:
            os.killpg(self._program.pid, signal.SIGKILL)  # its own session: no process but the browser's
        except ProcessLookupError:
            pass
        self._program.wait()
        self._words.close()
        shutil.rmtree(self.folder, ignore_errors=True)

    def words(self):
        """What the browser itself has said last, as one text of lines."""
        self._words.flush()
        self._words.seek(0)
        return "\n".join(self._words.read().splitlines()[-LAST_WORDS:])

    def call(self, method, session=None, **params):
        self._number += 1
        number = self._number
        request = {"id": number, "method": method, "params": params}
        if session:
            request["sessionId"] = session
        os.write(self._write, json.dumps(request).encode() + b"\0")
        end = time.monotonic() + ANSWER_S
        while number not in self._answers:
            self._take(end - time.monotonic(), method)
        answer = self._answers.pop(number)
        if "error" in answer:
            raise Failed(f"{method}: {answer['error']['message']}")
        return answer["result"]

    def _take(self, left_s, method):
        if left_s <= 0 or not select.select([self._read], [], [], left_s)[0]:
            raise Failed(f"{method}: no answer within {ANSWER_S:.0f} s\n{self.words()}")
        data = os.read(self._read, 1 << 16)
        if not data:
            raise Failed(f"{method}: the browser has ended\n{self.words()}")
        *whole, self._rest = (self._rest + data).split(b"\0")
        for text in whole:
            message = json.loads(text)
            if "id" in message:
                self._answers[message["id"]] = message
            else:
                self.messages.append(message)

    def open(self, address, before=None, size=(1280, 900)):
        """A new page in a window of its own, so that none is hidden and stops drawing; `before` is JavaScript that runs in it ahead of its own."""
        target = self.call("Target.createTarget", url="about:blank", newWindow=True)["targetId"]
        page = Page(self, self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"], target)
        page.call("Page.enable")
        page.call("Runtime.enable")
        page.call("Log.enable")
        page.call("Emulation.setDeviceMetricsOverride", width=size[0], height=size[1], deviceScaleFactor=1, mobile=False)
        if before:
            page.call("Page.addScriptToEvaluateOnNewDocument", source=before)
        page.call("Page.navigate", url=address)
        return page


class Page:
    """One tab."""

    def __init__(self, browser, session, target):
        self._browser, self._session, self.target = browser, session, target

    def call(self, method, **params):
        return self._browser.call(method, self._session, **params)

    def value(self, expression):
        """What an expression comes to in the page, promises awaited."""
        answer = self.call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in answer:
            details = answer["exceptionDetails"]
            raise Failed(f"{expression}: {details.get('exception', {}).get('description', details['text'])}")
        return answer["result"].get("value")

    def until(self, expression, seconds=ANSWER_S):
        """Waits for an expression to be true; its value. Failed with the page's figures when it does not become so."""
        end = time.monotonic() + seconds
        while True:
            value = self.value(f"typeof tiltPage !== 'undefined' && ({expression})")
            if value:
                return value
            if time.monotonic() > end:
                figures = self.value("typeof tiltPage === 'undefined' ? 'no page' : JSON.stringify(tiltPage.figures())")
                raise Failed(f"not within {seconds} s: {expression}; {figures}\n{self.console()}")
            time.sleep(0.05)

    def figures(self):
        return self.value("tiltPage.figures()")

    def console(self):
        """What the page threw, logged or was refused, a line each."""
        lines = []
        for message in self._browser.messages:
            params = message["params"]
            if message.get("sessionId") != self._session:
                continue
            if message["method"] == "Runtime.exceptionThrown":
                details = params["exceptionDetails"]
                lines.append(f"thrown: {details.get('exception', {}).get('description', details['text'])}")
            elif message["method"] == "Runtime.consoleAPICalled":
                lines.append(f"console: {' '.join(str(each.get('value', each.get('description'))) for each in params['args'])}")
            elif message["method"] == "Log.entryAdded":
                lines.append(f"log: {params['entry']['text']} {params['entry'].get('url', '')}")
        return "\n".join(lines[-LAST_WORDS:])

    def errors(self):
        """What the page threw, or was refused by its own content policy."""
        return [message["params"] for message in self._browser.messages
                if message.get("sessionId") == self._session and message["method"] == "Runtime.exceptionThrown"]

    def press(self, key, code=None):
        for kind in ("keyDown", "keyUp"):
            text = {"text": "\r"} if key == "Enter" and kind == "keyDown" else {}
            self.call("Input.dispatchKeyEvent", type=kind, key=key, code=code or key,
                      windowsVirtualKeyCode={"Tab": 9, "Enter": 13, " ": 32, "Home": 36, "ArrowRight": 39, "ArrowUp": 38}.get(key, 0), **text)

    def type(self, text):
        self.call("Input.insertText", text=text)

    def picture(self, path):
        with open(path, "wb") as file:
            file.write(base64.b64decode(self.call("Page.captureScreenshot", format="png")["data"]))
