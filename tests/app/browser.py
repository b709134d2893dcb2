"""A real browser for tests, driven over its own protocol: chromium without a window."""

import base64
import contextlib
import json
import shutil
import subprocess
import tempfile
import time
import urllib.request
from pathlib import Path

from websockets.sync.client import connect

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
PATIENCE = 60.0  # seconds: the machine may be busy; nothing waits longer than it has to


class Navigated(Exception):
    """The page went elsewhere while it was looked at."""


class Browser:
    """Chromium; a `with` block ends it."""

    def __init__(self):
        self._home = tempfile.mkdtemp(prefix="bem-browser-")
        self._process = subprocess.Popen(
            [
                CHROMIUM, "--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
                "--remote-debugging-port=0", f"--user-data-dir={self._home}", "--no-first-run", "--mute-audio",
                "--disable-background-networking", "--window-size=1500,1100", "about:blank",
            ],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        )  # fmt: skip
        port = Path(self._home) / "DevToolsActivePort"
        end = time.monotonic() + PATIENCE
        while not (port.is_file() and port.read_text().count("\n")):
            assert time.monotonic() < end, "chromium does not start"
            time.sleep(0.05)
        self._port = int(port.read_text().splitlines()[0])
        self._tabs = contextlib.ExitStack()

    def tab(self):
        """A new tab."""
        asked = urllib.request.Request(f"http://127.0.0.1:{self._port}/json/new?about:blank", method="PUT")
        with urllib.request.urlopen(asked) as answer:
            return self._tabs.enter_context(contextlib.closing(Tab(json.load(answer)["webSocketDebuggerUrl"])))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._tabs.close()  # their sockets have threads
        self._process.terminate()
        self._process.wait(20)
        shutil.rmtree(self._home, ignore_errors=True)


class Tab:
    """A page: go somewhere, look, type, click. `addresses` are all it has asked for."""

    def __init__(self, address):
        self._open = contextlib.ExitStack()
        self._socket = self._open.enter_context(connect(address, max_size=None))
        self._number = 0
        self.addresses, self.errors = [], []
        for domain in ("Page", "Runtime", "Network", "DOM", "Log"):
            self._do(f"{domain}.enable")

    def _do(self, method, **parameters):
        self._number += 1
        self._socket.send(json.dumps({"id": self._number, "method": method, "params": parameters}))
        while True:
            message = json.loads(self._socket.recv(PATIENCE))
            self._hear(message)
            if message.get("id") == self._number:
                if "navigated" in message.get("error", {}).get("message", ""):
                    raise Navigated(method)
                assert "error" not in message, message["error"]
                return message["result"]

    def _hear(self, message):
        if message.get("method") == "Network.requestWillBeSent":
            self.addresses.append(message["params"]["request"]["url"])
        elif message.get("method") == "Runtime.exceptionThrown":
            self.errors.append(message["params"]["exceptionDetails"].get("exception", {}).get("description", "?"))

    def go(self, address):
        self._do("Page.navigate", url=address)
        self.wait("document.readyState === 'complete'")

    def look(self, script):
        """What a piece of script gives."""
        found = self._do("Runtime.evaluate", expression=script, awaitPromise=True, returnByValue=True)
        assert "exceptionDetails" not in found, found["exceptionDetails"]
        return found["result"].get("value")

    def wait(self, script):
        """Until a piece of script gives something true."""
        end = time.monotonic() + PATIENCE
        while True:
            with contextlib.suppress(Navigated):  # where it is now, it is looked for again
                if self.look(f"(() => {{ try {{ return Boolean({script}) }} catch (e) {{ return false }} }})()"):
                    return
            assert time.monotonic() < end, f"not within {PATIENCE:g} s: {script}\n{self.text()[:3000]}\n{self.errors}"
            time.sleep(0.1)

    def text(self):
        return self.look("document.body.innerText")

    def wait_text(self, words):
        self.wait(f"document.body.innerText.includes({json.dumps(words)})")

    def click(self, selector):
        """Once what is there takes clicks."""
        self.wait(f"document.querySelector({json.dumps(selector)}).closest('[inert]') === null")
        self.look(f"document.querySelector({json.dumps(selector)}).click()")

    def type(self, key, words):
        """Into the field of a key once it takes them, as a person would: select what is there, and type."""
        where = f"input[data-key={json.dumps(key)}]"
        self.wait(f"document.querySelector({json.dumps(where)}).closest('[inert]') === null")
        self.look(f"(() => {{ const i = document.querySelector({json.dumps(where)}); i.focus(); i.select() }})()")
        if words:
            self._do("Input.insertText", text=words)
        else:
            for kind in ("keyDown", "keyUp"):
                self._do("Input.dispatchKeyEvent", type=kind, key="Delete", code="Delete", windowsVirtualKeyCode=46)

    def choose(self, key, name):
        """A name from a list that can be typed in; again until it is taken, since a list shuts when focus moves."""
        field = f"document.querySelector('input[data-key={json.dumps(key)}]').value"
        items = "[...document.querySelectorAll('.q-menu .q-item')]"
        end = time.monotonic() + PATIENCE
        self._do("Page.bringToFront")
        while self.look(field) != name:
            assert time.monotonic() < end, f"{name} is not taken for {key}\n{self.text()[:3000]}"
            self.type(key, name[:5])
            time.sleep(1)
            self.look(f"{items}.filter(one => one.innerText.trim() === {json.dumps(name)}).forEach(one => one.click())")
            time.sleep(1)

    def pick(self, key, name):
        """One of a list that opens on a click."""
        where = f"[data-key={json.dumps(key)}]"
        items = "[...document.querySelectorAll('.q-menu .q-item')]"
        one = f"{items}.find(one => one.innerText.trim() === {json.dumps(name)})"
        self._do("Page.bringToFront")
        self.click(where)
        self.wait(one)
        self.look(f"{one}.click()")
        self.wait(f"document.querySelector({json.dumps(where)}).innerText.trim() === {json.dumps(name)}")

    def unnamed(self):
        """Role and place of every control that a screen reader has no name for."""
        self._do("Accessibility.enable")
        controls = ("button", "link", "textbox", "combobox", "checkbox", "switch", "tab", "spinbutton", "searchbox")
        found = []
        for node in self._do("Accessibility.getFullAXTree")["nodes"]:
            role = node.get("role", {}).get("value")
            if role in controls and not node["ignored"] and not node.get("name", {}).get("value", "").strip():
                found.append((role, self._do("DOM.describeNode", backendNodeId=node["backendDOMNodeId"])["node"]))
        return found

    def dark(self, dark):
        """What the system's user prefers."""
        value = "dark" if dark else "light"
        self._do("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": value}])
        self.wait(f"document.body.classList.contains('body--{value}')")

    def settle(self):
        """Until no colour moves any more."""
        self.wait("document.getAnimations().every(one => !(one instanceof CSSTransition))")

    def faint(self):
        """Texts whose contrast with what is behind them is below 4.5 (3 where they are large), with their contrast."""
        return self.look(_FAINT)

    def unfocused(self, count):
        """Of the next controls that the tabulator key goes to, those that nothing marks."""
        found = []
        for _ in range(count):
            for kind in ("keyDown", "keyUp"):
                self._do("Input.dispatchKeyEvent", type=kind, key="Tab", code="Tab", windowsVirtualKeyCode=9)
            found.append(self.look(_MARK))
        return [one for one in found if one]

    def narrow(self, width=390, height=844):
        """A window as narrow as a telephone."""
        self._do("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=True)

    def drop(self, path):
        """A file into the page's field for files."""
        self.wait("document.querySelector('input[type=file]') !== null")
        root = self._do("DOM.getDocument")["root"]["nodeId"]
        node = self._do("DOM.querySelector", nodeId=root, selector="input[type=file]")["nodeId"]
        self._do("DOM.setFileInputFiles", files=[str(path)], nodeId=node)

    def mouse(self, x, y):
        for kind in ("mouseMoved", "mousePressed", "mouseReleased"):
            self._do("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)

    def picture(self, path):
        Path(path).write_bytes(base64.b64decode(self._do("Page.captureScreenshot", captureBeyondViewport=True)["data"]))

    def close(self):
        self._open.close()


_MARK = """(() => {
  const at = document.activeElement, style = getComputedStyle(at)
  if (at === document.body) return ''
  const field = at.closest('.q-field__control')
  const marked = parseFloat(style.outlineWidth) >= 2 && style.outlineStyle !== 'none'
  return marked || (field && getComputedStyle(field).boxShadow !== 'none') ? '' : at.outerHTML.slice(0, 200)
})()"""

_FAINT = """(() => {
  const parse = text => {
    const c = document.createElement('canvas').getContext('2d', {willReadFrequently: true})
    c.fillStyle = text; c.fillRect(0, 0, 1, 1)
    const d = c.getImageData(0, 0, 1, 1).data
    return [d[0], d[1], d[2], d[3] / 255]
  }
  const known = {}, rgba = text => known[text] ??= parse(text)
  const over = (top, under) => top.slice(0, 3).map((v, i) => v * top[3] + under[i] * (1 - top[3])).concat(1)
  const light = c => {
    const [r, g, b] = c.slice(0, 3).map(v => v / 255).map(v => v <= 0.03928 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4)
    return 0.2126 * r + 0.7152 * g + 0.0722 * b
  }
  const behind = item => {
    const layers = []
    for (let at = item; at; at = at.parentElement) {
      const colour = rgba(getComputedStyle(at).backgroundColor)
      if (colour[3] > 0) layers.push(colour)
      if (colour[3] === 1) break
    }
    return layers.reverse().reduce((under, top) => over(top, under), [255, 255, 255, 1])
  }
  const found = [], walk = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT)
  while (walk.nextNode()) {
    const item = walk.currentNode.parentElement, text = walk.currentNode.textContent.trim()
    if (!text || item.closest('script, style, .q-icon, .hoverlayer')) continue
    if (item.closest('[disabled], .disabled, [aria-disabled=true]')) continue
    if (!item.checkVisibility({checkOpacity: true, checkVisibilityCSS: true})) continue
    const style = getComputedStyle(item), size = parseFloat(style.fontSize)
    const own = rgba(item.closest('svg') ? style.fill : style.color), back = behind(item)
    let opacity = own[3]
    for (let at = item; at; at = at.parentElement) opacity *= parseFloat(getComputedStyle(at).opacity)
    const [a, b] = [light(over([...own.slice(0, 3), opacity], back)), light(back)]
    const ratio = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05)
    const large = size >= 24 || (size >= 18.66 && parseInt(style.fontWeight) >= 700)
    if (ratio < (large ? 3 : 4.5)) found.push([text.slice(0, 60), Math.round(ratio * 100) / 100])
  }
  return found
})()"""
