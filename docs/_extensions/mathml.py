# SPDX-License-Identifier: MIT OR Apache-2.0
"""Sphinx writes formulas as MathML, which browsers show without a script from elsewhere."""

from __future__ import annotations

import re
from typing import Any

from docutils import nodes
from docutils.utils.math import latex2mathml
from sphinx.application import Sphinx
from sphinx.writers.html5 import HTML5Translator


def setup(app: Sphinx) -> dict[str, Any]:
    app.add_html_math_renderer("mathml", (write_inline, None), (write_block, None))
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}


def write_inline(translator: HTML5Translator, node: nodes.math) -> None:
    translator.body.append(formula(node.astext()))
    raise nodes.SkipNode


def write_block(translator: HTML5Translator, node: nodes.math_block) -> None:
    translator.body.append(f'<div class="math">{formula(node.astext(), as_block=True)}</div>\n')
    raise nodes.SkipNode


def formula(text: str, as_block: bool = False) -> str:
    """TeX as MathML. Bars and slashes are set as letters: as operators they would stand apart."""
    markup = latex2mathml.tex2mathml(text, as_block=as_block)
    return re.sub(r"<mo[^>]*>([|/])</mo>", r'<mi mathvariant="normal">\1</mi>', markup)
