"""A headless chromium with one page, driven by the browser's protocol over a pipe."""
import base64
import json
import os
import subprocess
import sys
import tempfile
import time


class Page:
    def __init__(self, url):
        to_browser_read, self.to_browser = os.pipe()
        self.from_browser, from_browser_write = os.pipe()

        def become():  # chromium reads from file 3 and writes to file 4
            os.dup2(to_browser_read, 13)
            os.dup2(from_browser_write, 14)
            os.dup2(13, 3)
            os.dup2(14, 4)

        self.profile = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        self.browser = subprocess.Popen(
            ["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run",
             "--remote-debugging-pipe", "--user-data-dir=" + self.profile.name, "--window-size=1280,1000",
             "about:blank"],
            preexec_fn=become, close_fds=False, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(to_browser_read)
        os.close(from_browser_write)
        self.received = b""
        self.number = 0
        self.errors = []
        self.session = None
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Runtime", "Log", "Page"):
            self.call(domain + ".enable")
        self.call("Page.navigate", url=url)

    def call(self, method, **parameters):
        self.number += 1
        message = {"id": self.number, "method": method, "params": parameters}
        if self.session:
            message["sessionId"] = self.session
        os.write(self.to_browser, json.dumps(message).encode() + b"\0")
        while True:
            while b"\0" not in self.received:
                part = os.read(self.from_browser, 1 << 16)
                if not part:
                    sys.exit("chromium ended")
                self.received += part
            line, self.received = self.received.split(b"\0", 1)
            answer = json.loads(line)
            if answer.get("method") in ("Runtime.exceptionThrown", "Log.entryAdded"):
                self.errors.append(json.dumps(answer["params"]))
            if answer.get("id") == self.number:
                if "error" in answer:
                    sys.exit(method + ": " + json.dumps(answer["error"]))
                return answer["result"]

    def value(self, expression):
        return self.call("Runtime.evaluate", expression=expression, returnByValue=True)["result"].get("value")

    def wait_for(self, what, expression, seconds=40):
        end = time.time() + seconds
        while time.time() < end:
            if self.value(expression):
                return
            time.sleep(0.2)
        sys.exit("never seen: " + what + "; the page says " + str(self.value("document.body.innerText")))

    def choose(self, name, value):
        """As a user does: sets the control of that id, which tells of the change."""
        self.value("{ const control = document.getElementById(" + json.dumps(name) + "); control.value = " +
                   json.dumps(value) + "; for (const kind of ['input', 'change']) "
                   "control.dispatchEvent(new Event(kind, { bubbles: true })); }")

    def click(self, selector):
        self.value("document.querySelector(" + json.dumps(selector) + ").click()")

    def drag(self, selector, right, down):
        """From the middle of what the selector names, by so many pixels, with the left button."""
        box = self.value("{ const r = document.querySelector(" + json.dumps(selector) +
                         ").getBoundingClientRect(); [r.x + r.width / 2, r.y + r.height / 2]; }")
        for kind, buttons, part in (("mouseMoved", 0, 0), ("mousePressed", 1, 0), ("mouseMoved", 1, 0.5),
                                    ("mouseMoved", 1, 1), ("mouseReleased", 0, 1)):
            self.call("Input.dispatchMouseEvent", type=kind, x=box[0] + part * right, y=box[1] + part * down,
                      button="none" if buttons == 0 and kind == "mouseMoved" else "left", buttons=buttons,
                      clickCount=1)

    def save_screenshot(self, file):
        with open(file, "wb") as out:
            out.write(base64.b64decode(self.call("Page.captureScreenshot")["data"]))

    def close(self):
        """Ends with what the page has reported; that the program has gone is no error of the page."""
        problems = [e for e in self.errors if "ERR_CONNECTION_REFUSED" not in e]
        if problems:
            sys.exit("the page reports " + "\n".join(problems))
        self.browser.kill()
        self.browser.wait()
