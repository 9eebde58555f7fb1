# SPDX-License-Identifier: MIT OR Apache-2.0
"""The extension's manual as one page of HTML, which the zip holds: made from docs/blender.md.

It knows the Markdown of that page: headings, paragraphs, tables, lists, indented code, `code`, *emphasis* and
links. Pictures are left out, and links to other files become plain text, since the page stands alone.
"""

from __future__ import annotations

import html
import re
from collections.abc import Callable, Iterator
from itertools import groupby

_STYLE = (
    "body{max-width:46em;margin:2em auto;padding:0 1em;font:16px/1.5 sans-serif;color:#222;background:#fff}"
    "table{border-collapse:collapse}td,th{border:1px solid #ccc;padding:.3em .6em;text-align:left;"
    "vertical-align:top}code,pre{background:#f2f2f2}:target{background:#fff3c4}"
)


def to_html(markdown: str) -> str:
    """A whole page."""
    body = "\n".join(_blocks(re.sub(r"<!--.*?-->", "", markdown, flags=re.DOTALL)))
    title = re.search(r"^# (.+)$", markdown, re.MULTILINE)
    head = f'<meta charset="utf-8"><title>{html.escape(title[1] if title else "")}</title>'
    head = f"<head>{head}<style>{_STYLE}</style></head>"
    return f"<!DOCTYPE html>\n<html lang=en>{head}\n<body>\n{body}\n</body></html>\n"


def anchor(heading: str) -> str:
    """The id of a heading, as GitHub makes it."""
    return re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


def _blocks(markdown: str) -> Iterator[str]:
    for block in re.split(r"\n\s*\n", markdown.strip("\n")):
        lines = block.strip("\n").splitlines()
        # A heading needs no empty line below it.
        while lines and (heading := re.match(r"(#+) (.+)", lines[0])):
            level, text = len(heading[1]), heading[2]
            yield f'<h{level} id="{anchor(text)}">{_inline(text)}</h{level}>'
            lines = lines[1:]
        if lines:
            yield next(make for starts, make in _KINDS if re.match(starts, lines[0]))(lines)


def _table(lines: list[str]) -> str:
    rows = [[cell.strip() for cell in line.strip().strip("|").split("|")] for line in lines]
    head, body = rows[0], rows[2:]
    cells = [_row(head, "th"), *(_row(row, "td") for row in body)]
    return f"<table>{''.join(cells)}</table>"


def _row(cells: list[str], kind: str) -> str:
    return "<tr>" + "".join(f"<{kind}>{_inline(cell)}</{kind}>" for cell in cells) + "</tr>"


def _list(kind: str) -> Callable[[list[str]], str]:
    def make(lines: list[str]) -> str:
        starts = [re.match(r"(-|\d+\.) ", line) is not None for line in lines]
        numbers = [sum(starts[: index + 1]) for index in range(len(lines))]
        items = groupby(zip(numbers, lines), key=lambda numbered: numbered[0])
        texts = [" ".join(line.strip() for _, line in item) for _, item in items]
        inner = "".join(f"<li>{_inline(re.sub(r'^(-|[0-9]+[.]) ', '', text))}</li>" for text in texts)
        return f"<{kind}>{inner}</{kind}>"

    return make


def _code(lines: list[str]) -> str:
    return f"<pre>{html.escape(chr(10).join(line[4:] for line in lines))}</pre>"


def _paragraph(lines: list[str]) -> str:
    return f"<p>{_inline(' '.join(lines))}</p>"


_KINDS = (
    (r"\|", _table),
    (r"- ", _list("ul")),
    (r"\d+\. ", _list("ol")),
    (r" {4}", _code),
    (r"", _paragraph),
)


def _inline(text: str) -> str:
    """Code, links and emphasis within a line. What is code stays as it is."""
    parts = re.split(r"(`[^`]+`)", text)
    return "".join(
        f"<code>{html.escape(part[1:-1])}</code>" if part.startswith("`") else _plain(part) for part in parts
    )


def _plain(text: str) -> str:
    text = html.escape(text, quote=False)
    text = re.sub(r"!\[[^\]]*\]\([^)]*\)", "", text)
    text = re.sub(r"\[([^\]]+)\]\((#[^)]+|https?://[^)]+)\)", r'<a href="\2">\1</a>', text)
    text = re.sub(r"\[([^\]]+)\]\([^)]+\)", r"\1", text)
    text = re.sub(r"\*\*([^*]+)\*\*", r"<b>\1</b>", text)
    return re.sub(r"(?<![\w*])\*([^*\s][^*]*)\*(?!\w)", r"<i>\1</i>", text)
