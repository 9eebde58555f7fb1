# SPDX-License-Identifier: MIT OR Apache-2.0
"""The folders of the site: the documentation, and in try/ the page that runs the core."""

from __future__ import annotations

import shutil
from pathlib import Path

import distribution
import documentation
import environment
from shell import OUT, PYTHONPATH, ROOT, run, say
from steps import Count, run_pytest
from web import browser, wasm

SITE = OUT / "site"
LOG = OUT / "web" / "site.log"
PICTURES = OUT / "web" / "pictures"
_PAGE = ROOT / "rust" / "web" / "page"


def build_page(folder: Path) -> None:
    """The page with the core and its shapes, in a new folder."""
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(_PAGE, folder)
    wasm.build(folder, LOG)
    run([environment.dev().python, "-m", "web.shapes", folder / "shapes"], PYTHONPATH, LOG)


def build(with_documentation: bool) -> None:
    """The site."""
    shutil.rmtree(SITE, ignore_errors=True)
    if with_documentation:
        say("building the documentation ...")
        documentation.build(distribution.build_wheel(environment.dev(), log=LOG), LOG, with_page=True)
        shutil.copytree(documentation.PAGES, SITE)
    say("compiling the core for the browser ...")
    build_page(SITE / "try")


def test() -> Count:
    """Drives the page in a browser, beside the package of the same sources."""
    dev = environment.dev()
    environment.add(dev, "web")
    distribution.install_wheel(distribution.build_wheel(dev, log=LOG), dev, LOG)
    PICTURES.mkdir(parents=True, exist_ok=True)
    with browser.driver(LOG) as address:
        variables = {
            **{"AUTHALIC_SITE": str(SITE), "AUTHALIC_WEBDRIVER": address},
            "AUTHALIC_PICTURES": str(PICTURES),
        }
        return run_pytest(dev, ("tests/web",), variables, LOG)
