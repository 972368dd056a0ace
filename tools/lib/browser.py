"""A browser without a window or a network but this machine's own that a program drives: Debian's chromium."""

import base64
import contextlib
import fcntl
import json
import os
import select
import subprocess
import time

# Ends when the page has decoded the images that it loads, for which it gets 0.3 s, and has drawn itself anew.
SETTLED = """Promise.race([new Promise((done) => setTimeout(done, 300)),
    Promise.all([...document.images].map((image) => image.decode().catch(() => null)))])
    .then(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(null)))))"""
TIMEOUT = 60  # seconds for an answer of the browser


class NavigatedError(RuntimeError):
    """The page was loaded anew before it could answer."""


class Browser:
    """Chromium's DevTools protocol over a pair of pipes: JSON objects that end in a zero byte."""

    def __init__(self, program, profile, takes_screenshots=True):
        self.takes_screenshots = takes_screenshots
        # The browser reads from descriptor 3 and writes to 4: ours are moved out of their way.
        ours = [fcntl.fcntl(end, fcntl.F_DUPFD_CLOEXEC, 10) for end in (*os.pipe(), *os.pipe())]
        theirs_in, self.output, self.input, theirs_out = ours

        def connect():
            os.dup2(theirs_in, 3)
            os.dup2(theirs_out, 4)

        self.process = subprocess.Popen(
            # /dev/shm of a container is 64 MB, less than screenshots of long pages take.
            [program, "--headless=new", "--remote-debugging-pipe", f"--user-data-dir={profile}", "--disable-gpu",
             "--disable-dev-shm-usage", "--disable-background-networking", "--disable-component-update", "--no-first-run",
             "--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE 127.0.0.1", *(["--no-sandbox"] if os.geteuid() == 0 else []), "about:blank"],
            preexec_fn=connect, close_fds=False, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL)
        os.close(theirs_in)
        os.close(theirs_out)
        self.buffer = b""
        self.calls = 0
        self.session = None
        self.events = []

    def receive(self, deadline):
        while b"\0" not in self.buffer:
            if not select.select([self.input], [], [], max(0.0, deadline - time.monotonic()))[0]:
                return None
            chunk = os.read(self.input, 1 << 20)
            if not chunk:
                raise RuntimeError("the browser ended")
            self.buffer += chunk
        data, self.buffer = self.buffer.split(b"\0", 1)
        message = json.loads(data)
        if message.get("method") == "Page.javascriptDialogOpening":  # the page would answer no more
            raise RuntimeError(f"dialog: {message['params']['message']}")
        return message

    def call(self, method, **parameters):
        self.calls += 1
        request = {"id": self.calls, "method": method, "params": parameters}
        if self.session:
            request["sessionId"] = self.session
        data = json.dumps(request).encode() + b"\0"
        while data:
            data = data[os.write(self.output, data):]
        deadline = time.monotonic() + TIMEOUT
        while (message := self.receive(deadline)) is not None:
            if message.get("id") == self.calls:
                if "error" in message:
                    said = message["error"]["message"]
                    raise (NavigatedError if "navigated" in said else RuntimeError)(f"{method}: {said}")
                return message["result"]
            self.events.append(message)
        raise RuntimeError(f"{method}: no answer within {TIMEOUT} s")

    def wait(self, seconds):
        deadline = time.monotonic() + seconds
        while (message := self.receive(deadline)) is not None:
            self.events.append(message)

    def attach(self):
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(f"{domain}.enable")

    def load(self, url, width):
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=1000, deviceScaleFactor=1, mobile=False)
        first = len(self.events)
        self.call("Page.navigate", url=url)
        deadline = time.monotonic() + TIMEOUT
        while not any(event.get("method") == "Page.loadEventFired" for event in self.events[first:]):
            if time.monotonic() > deadline:
                raise RuntimeError("the page does not finish loading")
            self.wait(0.1)
        self.settle()

    def settle(self):
        self.value(SETTLED)

    def value(self, expression):
        try:
            result = self.evaluated(expression)
        except NavigatedError:  # a page that loads itself again is asked again
            result = self.evaluated(expression)
        if "exceptionDetails" in result:
            raise RuntimeError(f"tried on the page: {result['exceptionDetails']['exception']['description']}")
        return result["result"].get("value")

    def evaluated(self, expression):
        return self.call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)

    def mouse(self, kind, x, y, **more):
        self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, **more)

    def drag(self, start, end):
        self.mouse("mouseMoved", *start)
        self.mouse("mousePressed", *start, button="left", buttons=1, clickCount=1)
        self.mouse("mouseMoved", *end, button="left", buttons=1)
        self.mouse("mouseReleased", *end, button="left", clickCount=1)

    def press(self, key, code, **more):
        """`more`: the text that the key types, or the windowsVirtualKeyCode without which Tab and Enter do nothing."""
        self.call("Input.dispatchKeyEvent", type="keyDown", key=key, code=code, **more)
        self.call("Input.dispatchKeyEvent", type="keyUp", key=key, code=code, **more)
        self.settle()

    def choose(self, identifier, option):
        """The option at the index `option` of a select, from the end if it is negative; returns its text."""
        text = self.value(f"""(() => {{ const select = document.getElementById("{identifier}");
            select.selectedIndex = ({option} + select.length) % select.length;
            select.dispatchEvent(new Event("change")); return select.selectedOptions[0].textContent; }})()""")
        self.settle()
        return text

    def screenshot(self, path, width, scheme):
        if not self.takes_screenshots:
            return
        self.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": scheme}])
        self.settle()
        size = self.call("Page.getLayoutMetrics")["cssContentSize"]
        clip = {"x": 0, "y": 0, "width": width, "height": size["height"], "scale": 1}
        data = self.call("Page.captureScreenshot", captureBeyondViewport=True, clip=clip)["data"]
        path.write_bytes(base64.b64decode(data))

    def close(self):
        with contextlib.suppress(RuntimeError, OSError):
            self.session = None
            self.call("Browser.close")
        self.process.terminate()
        self.process.wait()


def faults_of_events(events, page):
    """What the browser told of while the page was tried."""
    for event in events:
        method, parameters = event.get("method"), event.get("params", {})
        if method == "Runtime.exceptionThrown":
            details = parameters["exceptionDetails"]
            yield f"exception: {details.get('exception', {}).get('description', details['text'])}"
        elif method == "Runtime.consoleAPICalled" and parameters["type"] in ("error", "assert"):
            yield f"console: {' '.join(str(a.get('value', a.get('description'))) for a in parameters['args'])}"
        elif method == "Log.entryAdded" and parameters["entry"]["level"] == "error":
            yield f"console: {parameters['entry']['text']}"
        elif method == "Network.requestWillBeSent":
            url = parameters["request"]["url"]
            if url.split("#")[0] != page and not url.startswith(("data:", "blob:")):
                yield f"request: {url}"
        elif method == "Network.loadingFailed":
            yield f"loading failed: {parameters['errorText']}"
