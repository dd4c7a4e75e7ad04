"""Opens the page of `cdem view` in a headless chromium: chooses a file, a field and a step, turns and zooms the model,
plays the series and ends the viewer.  view_browser.py URL [SCREENSHOT.png]"""
import sys
import time

from browser import Page

page = Page(sys.argv[1])
page.wait_for("a frame", "document.getElementById('frame')?.naturalWidth > 0")
page.wait_for("files to choose from", "document.getElementById('file').options.length === 2")
page.choose("colour", "stress.zz")
page.wait_for("the field that was chosen", "shown.colour === 'stress.zz'")
page.choose("step", 1)
page.wait_for("the step that was chosen", "shown.step === 1 && /2 of 3/.test(document.body.innerText)")
page.click("[data-turn='15']")
page.click("[data-tilt='15']")
page.click("[data-zoom='1.25']")
page.wait_for("the model turned and larger", "shown.turn === 15 && shown.tilt === 15 && shown.zoom === 1.25")
page.drag("#frame", 100, 50)  # by 0.4 degrees a pixel
page.wait_for("the model turned by the mouse", "shown.turn === 15 - 40 && shown.tilt === 15 + 20")
page.choose("low", -1e6)
page.choose("high", 0)
page.wait_for("the range that was given", "shown.range && shown.range[0] === -1e6 && shown.range[1] === 0")
if len(sys.argv) > 2:
    time.sleep(1)
    page.save_screenshot(sys.argv[2])
page.click("#reset")
page.wait_for("the view as it was", "shown.turn === 0 && shown.zoom === 1")
page.choose("step", 0)
page.wait_for("the first step", "shown.step === 0")
page.value("window.steps = new Set(); document.getElementById('frame').addEventListener('load', () => "
           "window.steps.add(shown.step)); document.getElementById('play').click()")
page.wait_for("each step of the series", "window.steps.has(1) && window.steps.has(2) && !playing")
page.choose("file", "1")
page.wait_for("the other file", "shown.file === 1 && document.getElementById('series').hidden")
page.click("#stop")
page.wait_for("the end", "/the viewer has ended/.test(document.getElementById('state').textContent)")
page.close()
print("seen: frame, file, field, step, turn, zoom, mouse, range, series, end")
