# SPDX-License-Identifier: MIT OR Apache-2.0
"""What a person does on the page, and sees there."""

import json
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from selenium import webdriver
from selenium.webdriver.common.by import By
from selenium.webdriver.remote.command import Command
from selenium.webdriver.support.ui import WebDriverWait

SECONDS = 600
# Fulfilled when the page has begun, or refused: it reads a file's text later than it hears of the file.
_DROP = """
const data = new DataTransfer();
data.items.add(new File([arguments[0]], arguments[1]));
return new Promise((done) => {
  const observer = new MutationObserver(() => {
    observer.disconnect();
    done();
  });
  observer.observe(document.body, { attributeFilter: ["data-state"] });
  document.body.dispatchEvent(new DragEvent("drop", { dataTransfer: data, bubbles: true, cancelable: true }));
});
"""
# The different colors of a canvas, and how many of its pixels are red as seams are.
_COLORS = """
const canvas = document.getElementById(arguments[0]);
const gl = canvas.getContext("webgl2");
const pixels = new Uint8Array(4 * canvas.width * canvas.height);
gl.readPixels(0, 0, canvas.width, canvas.height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
const colors = new Set();
let red = 0;
for (let k = 0; k < pixels.length; k += 4) {
  const [r, g, b] = pixels.subarray(k, k + 3);
  colors.add((r << 16) | (g << 8) | b);
  red += r > 190 && g < 80 && b < 100 ? 1 : 0;
}
return [colors.size, red];
"""
_FRAMES = "return new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));"


class Page:
    """The page, opened anew: ready, or unable to start."""

    def __init__(self, browser: webdriver.Remote, address: str, pictures: Path) -> None:
        self._browser, self._pictures = browser, pictures
        browser.set_script_timeout(SECONDS)
        browser.get(address)
        self._wait(lambda: self._data("ready") == "yes" or self._data("state") == "failed")

    def drop(self, text: str, name: str = "mesh.obj") -> None:
        """Drops a file, and waits for what comes of it."""
        self.begin(text, name)
        self.wait()

    def begin(self, text: str, name: str = "mesh.obj") -> None:
        """Drops a file, which the page begins with, or refuses."""
        self._browser.execute_script(_DROP, text, name)

    def wait(self) -> None:
        """Waits until the page is done."""
        self._wait(lambda: self._data("state") in ("done", "failed"))
        self._browser.execute_script(_FRAMES)

    def is_working(self) -> bool:
        return self._data("state") == "working"

    def press(self, selector: str) -> None:
        self._browser.find_element(By.CSS_SELECTOR, selector).click()

    def choose(self, name: str, value: str) -> None:
        """Chooses one of several options by its label."""
        self.press(f'label:has(input[name="{name}"][value="{value}"])')
        self._browser.execute_script(_FRAMES)

    @property
    def message(self) -> str:
        return self.text("#message")

    @property
    def figures(self) -> dict[str, Any]:
        """The figures that the page shows, as exact as it has them."""
        table = self._browser.find_element(By.ID, "figures")
        assert table.is_displayed(), self.message
        return dict(json.loads(table.get_attribute("data-figures") or "{}"))

    def text(self, selector: str) -> str:
        return self._browser.find_element(By.CSS_SELECTOR, selector).text

    def is_shown(self, selector: str) -> bool:
        return self._browser.find_element(By.CSS_SELECTOR, selector).is_displayed()

    def downloaded(self) -> str:
        """The file behind the link."""
        link = self._browser.find_element(By.ID, "download").get_attribute("href")
        return str(self._browser.execute_script("return fetch(arguments[0]).then((it) => it.text())", link))

    def colors(self, canvas: str) -> tuple[int, int]:
        """How many colors a canvas shows, and how many of its pixels have the red of seams."""
        self._browser.execute_script(_FRAMES)
        count, red = self._browser.execute_script(_COLORS, canvas)
        return int(count), int(red)

    def loaded(self) -> list[str]:
        """The addresses of all that the page has loaded."""
        script = "return performance.getEntriesByType('resource').map((entry) => entry.name)"
        return list(self._browser.execute_script(script))

    def picture(self, name: str) -> None:
        """Keeps a screenshot."""
        self._browser.save_screenshot(str(self._pictures / f"{name}.png"))

    def resize(self, width: int, height: int) -> None:
        self._browser.set_window_size(width, height)

    def console(self) -> list[str]:
        """Warnings and errors since the last call."""
        lines = self._browser.execute(Command.GET_LOG, {"type": "browser"})["value"]
        found = [line["message"] for line in lines if line["level"] in ("SEVERE", "WARNING")]
        # drivers of graphics say this when pixels are read
        return [message for message in found if "GPU stall" not in message]

    def _data(self, name: str) -> str | None:
        return self._browser.find_element(By.TAG_NAME, "body").get_attribute(f"data-{name}")

    def _wait(self, holds: Callable[[], bool]) -> None:
        WebDriverWait(self._browser, SECONDS, 0.2).until(lambda _: holds())
        time.sleep(0.1)
