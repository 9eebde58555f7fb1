# SPDX-License-Identifier: MIT OR Apache-2.0
"""The page of the site in headless Chromium; `scripts/site --test` says where both are."""

import os
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

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


class _Lacking(_Quiet):
    """Lacks one file, and keeps in a list each request for it."""

    def __init__(self, *words: Any, missing: str, requests: list[str], **options: Any) -> None:
        self._missing, self._requests = missing, requests
        super().__init__(*words, **options)

    def do_GET(self) -> None:
        if self.path.endswith(f"/{self._missing}"):
            self._requests.append(self.path)
            self.send_error(404)
        else:
            super().do_GET()


@contextmanager
def _served(handler: Callable[..., _Quiet]) -> Iterator[str]:
    """The address of the page, while it is served."""
    site = os.environ["AUTHALIC_SITE"]
    server = ThreadingHTTPServer(("127.0.0.1", 0), partial(handler, directory=site))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    yield f"http://127.0.0.1:{server.server_port}/try/index.html"
    server.shutdown()


@pytest.fixture(scope="session")
def address() -> Iterator[str]:
    """The address of the page."""
    with _served(_Quiet) as found:
        yield found


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


@pytest.fixture(params=["authalic_web_bg.wasm", "authalic_web.js", "worker.js"])
def lacking(browser: webdriver.Remote, request: pytest.FixtureRequest) -> Iterator[tuple[Page, list[str]]]:
    """The page without a file that its core needs, and the requests for that file so far."""
    requests: list[str] = []
    with _served(partial(_Lacking, missing=request.param, requests=requests)) as address:
        page = Page(browser, address, Path(os.environ["AUTHALIC_PICTURES"]))
        yield page, requests
        page.console()  # tells of the file
