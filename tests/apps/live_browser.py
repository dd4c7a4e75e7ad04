"""Opens the page of a live run in a headless chromium, waits for a frame, chooses a field, turns the model and presses the
button that stops the run.  live_browser.py URL [SCREENSHOT.png]"""
import json
import sys
import time

from browser import Page

page = Page(sys.argv[1])
page.wait_for("a frame", "document.getElementById('frame')?.naturalWidth > 0")
page.wait_for("the state", "document.getElementById('state').textContent.startsWith('running')")
page.wait_for("fields to choose from", "document.getElementById('colour').options.length > 3")
before = page.value("document.getElementById('frame').src")
page.choose("colour", "stress.zz")
page.wait_for("another frame", "document.getElementById('frame').src !== " + json.dumps(before))
page.wait_for("the field that was chosen", "shown.colour === 'stress.zz'")
page.click("[data-turn='15']")
page.wait_for("the model turned", "shown.turn === 15")
if len(sys.argv) > 2:
    time.sleep(2)
    page.save_screenshot(sys.argv[2])
page.click("#stop")
page.wait_for("the end", "/exit code 130/.test(document.getElementById('state').textContent)")
page.close()
print("seen: frame, choice of field, turn, stop, end")
