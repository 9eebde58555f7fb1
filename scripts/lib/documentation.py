# SPDX-License-Identifier: MIT OR Apache-2.0
"""Builds the site of the documentation."""

from __future__ import annotations

import shutil
from pathlib import Path

import distribution
import environment
from shell import OUT, ROOT, run

FOLDER = OUT / "docs"
PAGES = FOLDER / "html"
_SOURCE, _CACHE = FOLDER / "source", FOLDER / "cache"
_ALSO = {
    "ARCHITECTURE.md": "ARCHITECTURE.md",
    "CHANGELOG.md": "CHANGELOG.md",
    "tests/gui/README.md": "tests_gui.md",
    "scripts/examples/morph.py": "morph.py",
}
"""What pages are made of or link to outside docs/, and its name in the copy; docs/conf.py turns the links."""


def build(wheel: Path, log: Path | None = None, with_page: bool = False) -> None:
    """Makes all pages anew; every warning is an error. Nothing comes from the network but the environment.

    `with_page` links to the page in try/ that runs the core in a browser, which is another's to make.
    """
    place = environment.docs()
    distribution.install_wheel(wheel, place, log)
    _copy_sources()
    sphinx = [place.python, "-m", "sphinx", "--builder", "html", "--doctree-dir", _CACHE]
    sphinx += ["--tag", "page"] if with_page else []
    run([*sphinx, "--fail-on-warning", "--quiet", _SOURCE, PAGES], log=log)


def _copy_sources() -> None:
    """The copy is Sphinx's to write into: what its gallery makes must not lie among the sources."""
    shutil.rmtree(FOLDER, ignore_errors=True)
    shutil.copytree(ROOT / "docs", _SOURCE, ignore=shutil.ignore_patterns("__pycache__"))
    for document, page in _ALSO.items():
        shutil.copy2(ROOT / document, _SOURCE / page)
