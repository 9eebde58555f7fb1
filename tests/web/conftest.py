# SPDX-License-Identifier: MIT OR Apache-2.0
"""The page of the site in headless Chromium; `scripts/site --test` says where both are."""

import os
import threading
from collections.abc import Iterator
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

import pytest
from page import Page
from selenium import webdriver

_ARGUMENTS = (
    *("--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--window-size=1500,900"),
    *("--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update"),
    *("--disable-sync", "--disable-extensions", "--disable-default-apps"),
    # WebGL by the processor
    *("--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"),
)


class _Quiet(SimpleHTTPRequestHandler):
    def log_message(self, format: str, *words: object) -> None:
        pass


@pytest.fixture(scope="session")
def address() -> Iterator[str]:
    """The address of the page."""
    server = ThreadingHTTPServer(("127.0.0.1", 0), partial(_Quiet, directory=os.environ["AUTHALIC_SITE"]))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    yield f"http://127.0.0.1:{server.server_port}/try/index.html"
    server.shutdown()


@pytest.fixture(scope="session")
def browser() -> Iterator[webdriver.Remote]:
    options = webdriver.ChromeOptions()
    for argument in _ARGUMENTS:
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    found = webdriver.Remote(os.environ["AUTHALIC_WEBDRIVER"], options=options)
    yield found
    found.quit()


@pytest.fixture
def page(browser: webdriver.Remote, address: str) -> Iterator[Page]:
    """The page anew; a message on the browser's console is a failure."""
    page = Page(browser, address, Path(os.environ["AUTHALIC_PICTURES"]))
    yield page
    assert page.console() == []
