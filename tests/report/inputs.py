#!/usr/bin/env python3
"""Presses real keys and moves a real mouse on a report page in headless Chromium, through its DevTools.

    tests/report/inputs.py REPORT.html WIDTH light|dark

Tab comes to all that keys work on, in the order of the document; keys work there; each plot tells the
values of the marks that the mouse is on.
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

KEYS = {"Tab": 9, "ArrowDown": 40, "ArrowUp": 38, " ": 32, "Enter": 13, "+": 187, "0": 48}


class Browser:
    """Chromium with a page open; the protocol goes over a pair of pipes, in messages that end with a 0."""

    def __init__(self, folder, width, scheme):
        command_read, self.commands = os.pipe()
        self.answers, answer_write = os.pipe()
        flags = ["--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--disable-dev-shm-usage",
                 "--no-first-run", "--remote-debugging-pipe", f"--user-data-dir={folder}/profile"]
        if scheme == "dark":
            flags.append("--blink-settings=preferredColorScheme=0")
        # Chromium wants the pipes as files 3 and 4.
        shell = f'exec chromium "$@" 3<&{command_read} 4>&{answer_write}'
        self.process = subprocess.Popen(["bash", "-c", shell, "chromium", *flags, "about:blank"],
                                        pass_fds=(command_read, answer_write),
                                        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(command_read)
        os.close(answer_write)
        self.buffer, self.number, self.session = b"", 0, None
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=1000, deviceScaleFactor=1, mobile=False)
        self.call("Emulation.setFocusEmulationEnabled", enabled=True)

    def call(self, method, **parameters):
        self.number += 1
        message = {"id": self.number, "method": method, "params": parameters}
        if self.session:
            message["sessionId"] = self.session
        os.write(self.commands, json.dumps(message).encode() + b"\0")
        while True:
            while b"\0" not in self.buffer:
                part = os.read(self.answers, 1 << 16)
                if not part:
                    raise RuntimeError("the browser is gone")
                self.buffer += part
            text, self.buffer = self.buffer.split(b"\0", 1)
            answer = json.loads(text)
            if answer.get("id") == self.number:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']}")
                return answer["result"]

    def ask(self, expression):
        answer = self.call("Runtime.evaluate", expression=expression, awaitPromise=True, returnByValue=True)
        if "exceptionDetails" in answer:
            raise RuntimeError(f"{expression[:200]}: {answer['exceptionDetails']}")
        return answer["result"].get("value")

    def open(self, page):
        self.call("Page.navigate", url=page.resolve().as_uri())
        self.wait("document.documentElement?.dataset.ready === 'yes'", 60)

    def wait(self, expression, seconds=10.0):
        """Whether it becomes true in time."""
        end = time.monotonic() + seconds
        while not self.ask(expression):
            if time.monotonic() > end:
                return False
            time.sleep(0.02)
        return True

    def press(self, key, shift=False):
        text = {"text": key} if len(key) == 1 else {"text": "\r"} if key == "Enter" else {}
        common = {"key": key, "code": {" ": "Space", "0": "Digit0", "+": "Equal"}.get(key, key),
                  "windowsVirtualKeyCode": KEYS[key], "modifiers": 8 if shift else 0}
        self.call("Input.dispatchKeyEvent", type="keyDown" if text else "rawKeyDown", **common, **text)
        self.call("Input.dispatchKeyEvent", type="keyUp", **common)

    def point(self, x, y):
        self.call("Input.dispatchMouseEvent", type="mouseMoved", x=x, y=y)

    def close(self):
        try:
            self.session = None
            self.call("Browser.close")
        except (OSError, RuntimeError):
            self.process.kill()
        self.process.wait()


class Test:
    def __init__(self, browser):
        self.browser, self.passed, self.failed = browser, 0, 0

    def expect(self, what, holds):
        self.passed, self.failed = self.passed + bool(holds), self.failed + (not holds)
        if not holds:
            print(f"FAILED {what}")

    def tab_order(self):
        number = self.browser.ask("inputs.numControls()")
        for _ in range(number):
            self.browser.press("Tab")
        turn = self.browser.ask("inputs.wrongTurn()")
        self.expect(f"Tab comes to {number} controls in the order of the document: {turn}", number > 10 and turn == "")
        self.browser.press("Tab", shift=True)
        self.expect("Shift and Tab go back", self.browser.ask("document.activeElement === inputs.expected.at(-2)"))

    def keys(self):
        """On what the page of runs has."""
        browser = self.browser
        browser.ask("document.querySelector('#filters input').focus()")
        before = browser.ask("chosen.length")
        browser.press(" ")
        self.expect("the space bar takes a problem out", browser.ask("chosen.length") < before)
        browser.press(" ")
        self.expect("and puts it back", browser.ask("chosen.length") == before)
        browser.ask("document.querySelector('#summary th button').focus()")
        browser.press("Enter")
        self.expect("Enter sorts a table",
                    browser.ask("document.querySelector('#summary th').ariaSort") == "ascending")
        browser.ask("inputs.plot('Convergence').view.focus()")
        browser.ask("inputs.plot('Convergence').view.scrollIntoView({ block: 'center' })")
        # What the filters changed is drawn only now that it comes into view.
        browser.wait("inputs.plot('Convergence').isSeen && !inputs.plot('Convergence').isStale")
        browser.ask("inputs.settled()")
        width = "(() => { const { px } = inputs.plot('Convergence').domains(); return px[1] / px[0] || px[1]; })()"
        whole = browser.ask(width)
        browser.press("+")
        self.expect("plus zooms a plot", browser.wait(f"{width} !== {whole!r}"))
        browser.press("0")
        self.expect("0 shows all of it", browser.wait(f"{width} === {whole!r}"))
        self.pair_keys()

    def pair_keys(self):
        browser = self.browser
        title = browser.ask("inputs.titles().find(title => title.startsWith('Pair profile')) ?? null")
        is_many = browser.ask("doc.groups.length > 1")
        self.expect("there is a pair profile where there are two problems", (title is not None) == is_many)
        if title is None:
            return
        first = f"inputs.plot({json.dumps(title)}).figure.querySelector('select')"
        browser.ask(f"{first}.focus()")
        before = browser.ask(f"{first}.value")
        is_last = browser.ask(f"{first}.selectedIndex === {first}.options.length - 1")
        browser.press("ArrowUp" if is_last else "ArrowDown")
        self.expect("arrows choose another solver", browser.ask(f"{first}.value") != before)
        caption = f"inputs.plot({json.dumps(title)}).caption.textContent"
        self.expect("and its profile is drawn", browser.wait(f"{caption}.startsWith({first}.value)"))

    def hover(self):
        browser = self.browser
        for title in browser.ask("inputs.titles()"):
            named = json.dumps(title)
            places = [place for place in browser.ask(f"inputs.places({named})") if place]
            self.expect(f"{title}: has marks to point at", len(places) == 3)
            for place in places:
                browser.point(1, 1)
                self.expect(f"{title}: no tooltip beside the plot", browser.wait("inputs.tooltip() === null"))
                browser.point(*place)
                self.expect(f"{title}: tells the values at {place}: {browser.ask('inputs.tooltip()')}",
                            browser.wait(f"inputs.tells({named}, {place})"))


def main():
    page, width, scheme = pathlib.Path(sys.argv[1]), int(sys.argv[2]), sys.argv[3]
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        browser = Browser(folder, width, scheme)
        try:
            browser.open(page)
            browser.ask(pathlib.Path(__file__).with_name("inputs.js").read_text() + "\ninputs.begin()")
            test = Test(browser)
            test.tab_order()
            test.hover()
            if browser.ask("rows.length") > 0:
                test.keys()
        finally:
            browser.close()
    print(f"input test: {width} px, {scheme}: {test.passed} passed, {test.failed} failed")
    sys.exit(1 if test.failed else 0)


main()
