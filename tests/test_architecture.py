# SPDX-License-Identifier: MIT OR Apache-2.0
"""Dependencies point one way only: from the mesh up to Blender's panels (see ARCHITECTURE.md)."""

import ast
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
CORE = ROOT / "rust" / "core" / "src"
BINDINGS = ROOT / "rust" / "python"
ADDON = ROOT / "addon"

# The rooms of the crate, lowest first: a room may use those of lower rows only, and itself.
CORE_ROOMS = (
    {"error", "control", "parallel"},
    {"mesh"},
    {"sparse", "geometry", "distortion"},
    {"energy"},
    {"optimize", "embedding"},
    {"disk", "sphere", "untangle"},
    {"registration"},
    {"hyperbolic"},
)
CORE_RANK = {room: rank for rank, rooms in enumerate(CORE_ROOMS) for room in rooms}

# The same for the add-on; every module that is not named here is pure logic below the operators.
ADDON_RANK = {
    "bridge": 1,
    "jobs": 2,
    "operators": 3,
    "ui": 4,
    "ui_text": 4,
    "ui_curves": 5,
    "ui_register": 6,
    "ui_landmarks": 7,
    "__init__": 8,
}


def rust_files(folder: Path) -> list[Path]:
    return sorted(folder.rglob("*.rs"))


def without_comments(source: str) -> str:
    """Rust code without its comments (and with string contents, which name no module)."""
    return re.sub(r"//[^\n]*|/\*.*?\*/", "", source, flags=re.DOTALL)


def module_path(file: Path, folder: Path) -> list[str]:
    """The module of a file: `mesh/cut.rs` is ["mesh", "cut"], `mesh/mod.rs` is ["mesh"], `lib.rs` is []."""
    parts = list(file.relative_to(folder).with_suffix("").parts)
    return parts[:-1] if parts[-1] in ("mod", "lib") else parts


def first_names(group: str) -> set[str]:
    """The first path segments in `a::B` or `{a::B, c::{D, E}}`."""
    if not group.startswith("{"):
        return set(re.findall(r"^\w+", group))
    depth, flat = 0, ""
    for character in group:
        depth -= character == "}"
        flat += character if depth == 1 else ""
        depth += character == "{"
        if depth == 0:
            break
    return {name.strip().split("::")[0] for name in flat.split(",")}


def rooms_used(source: str, module: list[str]) -> set[str]:
    """The rooms of the crate that a file names through `crate::` or `super::` paths."""
    used = set()
    for path in re.finditer(r"\b(crate|(?:super::)*super)::", source):
        levels = path.group(1).count("super")
        if path.group(1) == "crate" or levels == len(module):
            used |= first_names(source[path.end() :])
    return used & CORE_RANK.keys()


def python_imports(file: Path) -> set[tuple[int, str]]:
    """(number of leading dots, dotted name) of every import in a file, also inside functions."""
    found = set()
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found |= {(0, alias.name) for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            found.add((node.level, node.module))
        elif isinstance(node, ast.ImportFrom):
            found |= {(node.level, alias.name) for alias in node.names}
    return found


def absolute_imports(file: Path) -> set[str]:
    """The top-level packages that a file imports."""
    return {name.split(".")[0] for dots, name in python_imports(file) if dots == 0}


def addon_files() -> list[Path]:
    return sorted(ADDON.rglob("*.py"))


def addon_room(file: Path) -> str:
    """`ui/panels.py` and `ui.py` belong to the room "ui"; `__init__.py` at the top to itself."""
    parts = file.relative_to(ADDON).with_suffix("").parts
    return parts[0]


def addon_rooms_used(file: Path) -> set[str]:
    """The add-on's own rooms that a file imports by relative imports."""
    depth = len(file.relative_to(ADDON).parts)
    return {name.split(".")[0] for dots, name in python_imports(file) if dots == depth}


@pytest.mark.parametrize("file", rust_files(CORE), ids=lambda file: str(file.relative_to(CORE)))
def test_core_uses_lower_rooms_only(file: Path) -> None:
    module = module_path(file, CORE)
    if not module:
        return  # lib.rs only re-exports
    room = module[0]
    assert room in CORE_RANK, f"the new room {room} needs its place in CORE_ROOMS"
    used = rooms_used(without_comments(file.read_text(encoding="utf-8")), module) - {room}
    upward = {other for other in used if CORE_RANK[other] >= CORE_RANK[room] > 0}
    assert not upward, f"{room} must not use {sorted(upward)}"
    assert CORE_RANK[room] > 0 or not used - CORE_ROOMS[0], f"{room} is a base module: it must not use {used}"


def test_only_factor_names_faer() -> None:
    allowed = CORE / "sparse" / "factor.rs"
    sources = [*rust_files(CORE), *rust_files(BINDINGS / "src")]
    naming = [f for f in sources if re.search(r"\bfaer\b", without_comments(f.read_text(encoding="utf-8")))]
    assert set(naming) <= {allowed}


def test_core_knows_neither_python_nor_blender() -> None:
    for file in [*rust_files(CORE), CORE.parent / "Cargo.toml"]:
        code = re.sub(r"#.*", "", file.read_text(encoding="utf-8")) if file.suffix == ".toml" else ""
        code = code or without_comments(file.read_text(encoding="utf-8"))
        assert not re.search(r"\b(pyo3|numpy|bpy)\b", code), file


def test_package_knows_no_blender() -> None:
    for file in (BINDINGS / "authalic").glob("*.py*"):
        if file.suffix in (".py", ".pyi"):
            assert not absolute_imports(file) & {"bpy", "bmesh", "mathutils"}, file


def test_only_the_bridge_imports_authalic() -> None:
    importing = {file for file in addon_files() if "authalic" in absolute_imports(file)}
    assert importing <= {ADDON / "bridge.py"}


@pytest.mark.parametrize("file", addon_files(), ids=lambda file: str(file.relative_to(ADDON)))
def test_addon_uses_lower_rooms_only(file: Path) -> None:
    room = addon_room(file)
    used = addon_rooms_used(file) - {room, "__init__"}
    upward = {other for other in used if ADDON_RANK.get(other, 0) >= max(ADDON_RANK.get(room, 0), 1)}
    assert not upward, f"{room} must not use {sorted(upward)}"


def test_ui_touches_no_arrays() -> None:
    for file in addon_files():
        if addon_room(file).split("_")[0] == "ui":
            assert "numpy" not in absolute_imports(file), file


def test_the_parser_sees_upward_paths() -> None:
    source = (
        "use crate::{error::Error, disk::{Start, Map}}; fn f() { super::super::energy::g(); super::cut(); }"
    )
    assert rooms_used(source, ["mesh", "cut"]) == {"error", "disk", "energy"}
