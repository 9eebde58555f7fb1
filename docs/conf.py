# SPDX-License-Identifier: MIT OR Apache-2.0
"""How Sphinx builds the site. `scripts/docs` runs it."""

import re
import sys
from pathlib import Path

from sphinx.application import Sphinx
from sphinx.util.logging import getLogger

import authalic

DOCS = Path(__file__).resolve().parent
sys.path[:0] = [str(DOCS / "_extensions"), str(DOCS / "examples")]

project = "Authalic"
author = copyright = "The Authalic developers"
version = release = authalic.__version__

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "numpydoc",
    "sphinx_gallery.gen_gallery",
    "mathml",
]
exclude_patterns = ["examples", "_extensions"]

# Markdown
myst_enable_extensions = ["dollarmath", "colon_fence"]
myst_heading_anchors = 4
html_math_renderer = "mathml"

# The reference
autodoc_typehints = "none"
autodoc_member_order = "groupwise"
autosummary_generate = False
numpydoc_show_class_members = False
numpydoc_xref_param_type = False

# The gallery
sphinx_gallery_conf = {
    "examples_dirs": "examples",
    "gallery_dirs": "gallery",
    "filename_pattern": r"plot_",
    "ignore_pattern": r"pictures\.py",
    "download_all_examples": False,
    "write_computation_times": False,
    "show_memory": False,
    "show_signature": False,
    "min_reported_time": 1e9,
    "remove_config_comments": True,
    "abort_on_example_error": True,
    "copyfile_regex": r"pictures\.py",
}

# The pages
html_theme = "furo"
html_title = f"Authalic {release}"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_show_sphinx = False
templates_path = []


MOVED = (
    (r"\.\./README\.md(#[\w-]+)?\)", r"index.md)"),
    (r"\.\./(?P<name>ARCHITECTURE|CHANGELOG)\.md", r"\g<name>.md"),
    (r"\.\./tests/gui/README\.md", r"tests_gui.md"),
    (r"\.\./scripts/examples/morph\.py", r"morph.py"),
    (r"examples/README\.rst", r"gallery/index.rst"),
    (r"examples/(?P<name>plot_\w+)\.py", r"gallery/\g<name>.rst"),
)
"""Links that lead to sources, and the pages of the site that are made of these."""


def link_to_pages(app: Sphinx, document: str, source: list[str]) -> None:
    for link, page in MOVED:
        source[0] = re.sub(rf"(?<=\]\()((?:\.\./)*){link}", rf"\1{page}", source[0])


def keep_bars(app: Sphinx, what: str, name: str, subject: object, options: object, lines: list[str]) -> None:
    """Bars in docstrings are absolute values; reStructuredText takes them for substitutions."""
    lines[:] = [
        line if line.lstrip().startswith((">>>", "...")) else line.replace("|", r"\|") for line in lines
    ]


def warn_of_foreign_files(app: Sphinx, failure: Exception | None) -> None:
    """Pages must be whole without a network: they load no script, style or picture from elsewhere."""
    foreign = re.compile(
        r"<(?:script|img|iframe|link rel=\"stylesheet\")[^>]* (?:src|href)=\"(?:https?:)?//[^\"]*"
    )
    for page in sorted(Path(app.outdir).rglob("*.html")):
        for tag in foreign.findall(page.read_text(encoding="utf-8")):
            getLogger(__name__).warning("%s loads from elsewhere: %s", page.name, tag)


def setup(app: Sphinx) -> None:
    app.connect("build-finished", warn_of_foreign_files)
    app.connect("autodoc-process-docstring", keep_bars)
    app.connect("source-read", link_to_pages)
