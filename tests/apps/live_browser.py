"""Opens the page of a live run in a headless chromium, waits for a frame and a chart, and presses the button that stops
the run. Speaks the browser's protocol over a pipe.  live_browser.py URL [SCREENSHOT.png]"""
import base64
import json
import os
import subprocess
import sys
import tempfile
import time

url = sys.argv[1]
to_browser_read, to_browser = os.pipe()
from_browser, from_browser_write = os.pipe()


def become():  # chromium reads from file 3 and writes to file 4
    os.dup2(to_browser_read, 13)
    os.dup2(from_browser_write, 14)
    os.dup2(13, 3)
    os.dup2(14, 4)


profile = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
browser = subprocess.Popen(
    ["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run",
     "--remote-debugging-pipe", "--user-data-dir=" + profile.name, "--window-size=1280,1000", "about:blank"],
    preexec_fn=become, close_fds=False, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
os.close(to_browser_read)
os.close(from_browser_write)
received = b""
number = 0
errors = []


def call(method, session=None, **parameters):
    global received, number
    number += 1
    message = {"id": number, "method": method, "params": parameters}
    if session:
        message["sessionId"] = session
    os.write(to_browser, json.dumps(message).encode() + b"\0")
    while True:
        while b"\0" not in received:
            part = os.read(from_browser, 1 << 16)
            if not part:
                sys.exit("chromium ended")
            received += part
        line, received = received.split(b"\0", 1)
        answer = json.loads(line)
        if answer.get("method") in ("Runtime.exceptionThrown", "Log.entryAdded"):
            errors.append(json.dumps(answer["params"]))
        if answer.get("id") == number:
            if "error" in answer:
                sys.exit(method + ": " + json.dumps(answer["error"]))
            return answer["result"]


def value(session, expression):
    return call("Runtime.evaluate", session, expression=expression, returnByValue=True)["result"].get("value")


def wait_for(session, what, expression, seconds=40):
    end = time.time() + seconds
    while time.time() < end:
        if value(session, expression):
            return
        time.sleep(0.2)
    sys.exit("never seen: " + what + "; the page says " + str(value(session, "document.body.innerText")))


target = call("Target.createTarget", url="about:blank")["targetId"]
page = call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
call("Runtime.enable", page)
call("Log.enable", page)
call("Page.enable", page)
call("Page.navigate", page, url=url)
wait_for(page, "a frame", "document.getElementById('frame')?.naturalWidth > 0")
wait_for(page, "the state", "document.getElementById('state').textContent.startsWith('running')")
wait_for(page, "fields to choose from", "document.getElementById('colour').options.length > 3")
before = value(page, "document.getElementById('frame').src")
call("Runtime.evaluate", page, expression="""{ const field = document.getElementById('colour');
  field.value = 'stress.zz'; field.dispatchEvent(new Event('change', { bubbles: true })); }""")
wait_for(page, "another frame", "document.getElementById('frame').src !== " + json.dumps(before))
wait_for(page, "the field that was chosen",
         "fetch('status').then((r) => r.json()).then((s) => { window.drawn = s.shown.colour; }), "
         "window.drawn === 'stress.zz'")
if len(sys.argv) > 2:
    time.sleep(2)
    with open(sys.argv[2], "wb") as file:
        file.write(base64.b64decode(call("Page.captureScreenshot", page)["data"]))
call("Runtime.evaluate", page, expression="document.getElementById('stop').click()")
wait_for(page, "the end", "/exit code 130/.test(document.getElementById('state').textContent)")
problems = [e for e in errors if "ERR_CONNECTION_REFUSED" not in e]
if problems:
    sys.exit("the page reports " + "\n".join(problems))
browser.kill()
browser.wait()
print("seen: frame, choice of field, stop, end")
