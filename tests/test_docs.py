# SPDX-License-Identifier: MIT OR Apache-2.0
"""The documents: their examples run, and the files, links, commands and labels that they name exist."""

import ast
import functools
import re
from pathlib import Path

import pytest
from test_architecture import ADDON_ROOMS, CORE_ROOMS, HYPERBOLIC_ROOMS

from shell import version

ROOT = Path(__file__).resolve().parents[1]
GUIDES = [ROOT / "README.md", ROOT / "rust" / "python" / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
DOCUMENTS = [
    *GUIDES,
    *(ROOT / "ARCHITECTURE.md", ROOT / "CHANGELOG.md"),
    *(ROOT / "rust" / "core" / "README.md", ROOT / "tests" / "gui" / "README.md"),
]
TOP = sorted(path.name for path in ROOT.iterdir() if path.is_dir())
MADE = (".venv/", "dist/", "out/")
"""Folders that commands make; they need not exist."""


def relative(path: Path) -> str:
    return path.relative_to(ROOT).as_posix()


documents = pytest.mark.parametrize("document", DOCUMENTS, ids=relative)


def blocks(document: Path) -> list[str]:
    """The Python blocks of a document."""
    return re.findall(r"(?ms)^```python\n(.*?)^```$", document.read_text(encoding="utf-8"))


def without_blocks(document: Path) -> str:
    return re.sub(r"(?ms)^```.*?^```$", "", document.read_text(encoding="utf-8"))


def quoted(document: Path) -> list[str]:
    """The words between backticks, outside blocks."""
    return re.findall(r"`([^`\n]+)`", without_blocks(document))


def paths(words: list[str]) -> set[str]:
    """The words that are paths of the repository."""
    first = {word.split()[0] for word in words if word.strip()}
    is_path = re.compile(rf"(?:{'|'.join(map(re.escape, TOP))})/[\w./-]*")
    return {word for word in first if is_path.fullmatch(word) and not word.startswith(MADE)}


def anchors(document: Path) -> set[str]:
    """The targets of links in a document: its headings, as GitHub names them."""
    headings = re.findall(r"(?m)^#+ (.*)$", without_blocks(document))
    return {re.sub(r"[^\w -]", "", heading).lower().replace(" ", "-") for heading in headings}


@functools.cache
def literals(folder: Path) -> set[str]:
    """The strings in the Python code of a folder."""
    trees = (ast.parse(file.read_text(encoding="utf-8")) for file in sorted(folder.rglob("*.py")))
    nodes = (node for tree in trees for node in ast.walk(tree))
    return {node.value for node in nodes if isinstance(node, ast.Constant) and isinstance(node.value, str)}


@pytest.mark.parametrize("document", [guide for guide in GUIDES if blocks(guide)], ids=relative)
def test_python_blocks_run_one_after_the_other(document: Path) -> None:
    pytest.importorskip("authalic")
    names: dict[str, object] = {}
    for number, block in enumerate(blocks(document), start=1):
        exec(compile(block, f"{document.name}, block {number}", "exec"), names)


def test_the_readme_is_short() -> None:
    assert len((ROOT / "README.md").read_text(encoding="utf-8").splitlines()) <= 150


@documents
def test_links_lead_somewhere(document: Path) -> None:
    for link in re.findall(r"\]\(([^)\s]+)\)", without_blocks(document)):
        if link.startswith(("http://", "https://")):
            continue
        name, _, anchor = link.partition("#")
        target = (document.parent / name).resolve() if name else document
        assert target.exists(), link
        assert not anchor or anchor in anchors(target), link


@documents
def test_named_files_exist(document: Path) -> None:
    missing = {path for path in paths(quoted(document)) if not (ROOT / path).exists()}
    assert not missing


def test_paths_of_the_architecture_exist() -> None:
    """Paths start at the root or in one of the three houses; in a table, in the room of the row."""
    text = (ROOT / "ARCHITECTURE.md").read_text(encoding="utf-8")
    places = [ROOT, ROOT / "rust" / "core" / "src", ROOT / "addon", ROOT / "scripts" / "lib"]
    missing = []
    for line in text.splitlines():
        if heading := re.match(r"## .*`([\w/]+/)`", line):
            places[4:] = [ROOT / heading[1]]
        names = re.findall(r"`([\w./-]+(?:/|\.rs|\.py|\.pyi))`", line)
        rooms = [places[-1] / name for name in names[:1] if line.startswith("| `")]
        missing += [name for name in names if not any((place / name).exists() for place in places + rooms)]
    assert not [name for name in missing if not name.startswith(MADE)]


def test_the_graph_of_dependencies_is_the_one_that_is_checked() -> None:
    text = (ROOT / "ARCHITECTURE.md").read_text(encoding="utf-8")
    drawn = re.search(r"(?m)^    core (.*\n(?:    .*\n)+)", text)
    core, _, addon = (rows_of.splitlines() for rows_of in drawn[1].split("↑ uses"))
    addon[1] = addon[1].replace("extension", "")
    rows = [set(line.split()) for line in (*core, *addon) if line.strip()]
    assert rows == [*CORE_ROOMS, *ADDON_ROOMS[:-1]]


def test_the_rows_of_hyperbolic_rooms_are_those_that_are_checked() -> None:
    text = (ROOT / "ARCHITECTURE.md").read_text(encoding="utf-8")
    listed = re.search(r"Within `hyperbolic/` the rows are: ([\w\s,;]+)\.", text)
    assert listed
    rows = [{room.strip() for room in row.split(",")} for row in listed[1].split(";")]
    assert rows == [*HYPERBOLIC_ROOMS]


@documents
def test_named_benches_and_parts_exist(document: Path) -> None:
    launcher = (ROOT / "scripts" / "bench").read_text(encoding="utf-8")
    sources = literals(ROOT / "scripts" / "lib")
    text = document.read_text(encoding="utf-8")
    for subject in re.findall(r"`scripts/bench (\w+)", text):
        assert f'"{subject}"' in launcher, subject
    for part in re.findall(r"--parts ([\w-]+)", text):
        assert part in sources, part


def test_the_reference_has_every_public_name_once() -> None:
    modules = [pytest.importorskip(name) for name in ("authalic", "authalic.io", "authalic.batch")]
    pages = sorted((ROOT / "docs" / "api").glob("*.md"))
    text = "".join(page.read_text(encoding="utf-8") for page in pages)
    listed = re.findall(r"(?m)^\.\. (?:auto\w+|py:data):: (\w+)$", text)
    assert sorted(listed) == sorted({name for module in modules for name in module.__all__} - {"__version__"})
    assert set(listed) <= set(quoted(ROOT / "docs" / "api" / "index.md"))


def test_pictures_of_pages_have_their_examples() -> None:
    for document in GUIDES:
        for name in re.findall(r"sphx_glr_(\w+)_\d{3}\.png", document.read_text(encoding="utf-8")):
            assert (ROOT / "docs" / "examples" / f"{name}.py").exists(), name


def test_the_citation_is_of_this_version() -> None:
    text = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    assert re.findall(r"(?m)^version: (.+)$", text) == [version()]
    assert re.findall(r"(?m)^license: (.+)$", text) == ["[MIT, Apache-2.0]"]


def badge(name: str) -> str:
    """The words on a badge."""
    text = (ROOT / "docs" / "badges" / f"{name}.svg").read_text(encoding="utf-8")
    [label] = re.findall(r'aria-label="(.+)"', text)
    assert f"<title>{label}</title>" in text
    assert label == ": ".join(re.findall(r"<text .*>(.+)</text>", text))
    return label


def test_badges_say_what_is_so() -> None:
    manifest = (ROOT / "addon" / "blender_manifest.toml.in").read_text(encoding="utf-8")
    project = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    [blender] = re.findall(r'(?m)^blender_version_min = "(\d+\.\d+)\.0"$', manifest)
    [python] = re.findall(r'(?m)^requires-python = ">=(.+)"$', project)
    [license] = re.findall(r'(?m)^license = "(.+)"$', project)
    [addon_license] = re.findall(r'(?m)^license = \["SPDX:(.+)-or-later"\]$', manifest)
    assert badge("version") == f"version: {version()}"
    assert badge("blender") == f"Blender: {blender} LTS or newer"
    assert badge("python") == f"Python: {python} or newer"
    assert badge("license") == f"license: {license.replace('OR', 'or')}, add-on {addon_license}"
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    for name in re.findall(r"docs/badges/(\w+)\.svg", readme):
        assert (
            f"[{badge(name).replace(': ', ' ', 1).replace('license ', '')}](docs/badges/{name}.svg)" in readme
        )


@documents
def test_named_operators_exist(document: Path) -> None:
    known = {name for name in literals(ROOT / "addon") if name.startswith("authalic.")}
    named = re.findall(r"bpy\.ops\.(authalic\.\w+)", document.read_text(encoding="utf-8"))
    also = re.findall(r"`(landmark_\w+)`", document.read_text(encoding="utf-8"))
    assert {*named, *(f"authalic.{name}" for name in also)} <= known


def test_all_operators_are_named() -> None:
    sources = [path.read_text(encoding="utf-8") for path in (ROOT / "addon" / "operators").glob("*.py")]
    classes = [
        part for source in sources for part in source.split("\nclass ")[1:] if '"INTERNAL"' not in part
    ]
    known = {name for part in classes for name in re.findall(r'bl_idname = "authalic\.(\w+)"', part)}
    text = (ROOT / "docs" / "blender.md").read_text(encoding="utf-8")
    assert len(known) > 20
    assert known <= set(re.findall(r"\w+", text))


def test_options_in_tables_are_labels_of_the_extension() -> None:
    """The first cells of the tables of options, *Label* or *Label*, *Label*."""
    text = (ROOT / "docs" / "blender.md").read_text(encoding="utf-8")
    cells = re.findall(r"(?m)^\| (\*[^|]*\*) \|", text)
    labels = {label for cell in cells for label in re.findall(r"\*([^*]+)\*", cell)}
    assert len(labels) > 20
    assert labels <= literals(ROOT / "addon")
