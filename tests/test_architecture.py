# SPDX-License-Identifier: MIT OR Apache-2.0
"""Dependencies point one way only: from the mesh up to Blender's panels (see ARCHITECTURE.md)."""

import ast
import re
from pathlib import Path

import pytest
from rust_arrows import Crate, without_comments

ROOT = Path(__file__).resolve().parents[1]
CORE = ROOT / "rust" / "core" / "src"
BINDINGS = ROOT / "rust" / "python"
ADDON = ROOT / "addon"

# The rooms of the crate, lowest first: a room may use those of lower rows only, and itself.
CORE_ROOMS = (
    {"clock"},
    {"vector", "error", "control", "parallel", "sets"},
    {"arrays", "memory"},
    {"record"},
    {"mesh", "options"},
    {"sparse", "distortion", "codomain", "location", "packing"},
    {"energy", "embedding", "alignment", "filling"},
    {"optimize", "repair"},
    {"disk", "sphere", "untangle"},
    {"layout", "seams"},
    {"unwrap"},
    {"registration", "resampling"},
    {"hyperbolic"},
    {"testing"},
)

# The rooms of `hyperbolic/` likewise.
HYPERBOLIC_ROOMS = (
    {"moebius", "features", "metric"},
    {"options", "slice"},
    {"harmonic"},
    {"between", "warnings"},
    {"assembly"},
    {"filling", "record"},
    {"register", "structure"},
)

# The rooms of the add-on, lowest first: folders, and files beside them.
ADDON_ROOMS = (
    {"messages"},
    {"surfaces"},
    {"blender"},
    {"landmarks"},
    {"overlay", "registration"},
    {"bridge"},
    {"jobs"},
    {"operators"},
    {"ui"},
    {"__init__"},
)
ADDON_RANK = {room: rank for rank, rooms in enumerate(ADDON_ROOMS) for room in rooms}

# The folders of the package, lowest first. Nothing outside uses them, so that `import authalic` stays small.
PACKAGE_ROOMS = ("io", "runs", "batch", "cli")
OPTIONAL_PACKAGES = {"click", "rich", "trimesh", "meshio", "nibabel", "dask", "distributed", "pyarrow"}

# Python code that knows nothing of Blender.
WITHOUT_BLENDER = {"messages", "surfaces", "registration", "bridge"}
BLENDER_MODULES = {"bpy", "bmesh", "mathutils", "gpu", "blf", "bpy_extras", "gpu_extras"}

# Names by which Blender's meshes give and take their data, and which nothing else in the add-on has.
MESH_DATA = {"foreach_get", "foreach_set", "from_edit_mesh", "from_pydata", "update_edit_mesh"} | {
    *("attributes", "color_attributes", "key_blocks", "modifiers", "uv_layers")
}

# Folders in which no files may import each other in a circle.
PYTHON_HOUSES = (ADDON, ROOT / "scripts" / "lib", BINDINGS / "authalic")


def rust_files(folder: Path) -> list[Path]:
    return sorted(folder.rglob("*.rs"))


def python_imports(file: Path) -> set[tuple[int, str]]:
    """(number of leading dots, dotted name) of every import in a file, also inside functions.

    `from a import b` counts as `a.b`, since `b` may be a module.
    """
    imports = set()
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            imports |= {(0, alias.name) for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            package = f"{node.module}." if node.module else ""
            imports |= {(node.level, package + alias.name) for alias in node.names}
    return imports


def absolute_imports(file: Path) -> set[str]:
    """The top-level packages that a file imports."""
    return {name.split(".")[0] for dots, name in python_imports(file) if dots == 0}


def attributes_named(file: Path) -> set[str]:
    """All x that occur in a file as `something.x`."""
    tree = ast.parse(file.read_text(encoding="utf-8"))
    return {node.attr for node in ast.walk(tree) if isinstance(node, ast.Attribute)}


def python_files(folder: Path) -> list[Path]:
    return sorted(folder.rglob("*.py"))


def addon_room(file: Path) -> str:
    """`ui/panels.py` belongs to the room "ui", `messages.py` and `__init__.py` at the top to themselves."""
    return file.relative_to(ADDON).with_suffix("").parts[0]


def imported_file(folder: Path, name: str) -> Path | None:
    """The file below a folder that a dotted name comes from: a module or a package."""
    parts = name.split(".")
    for length in range(len(parts), 0, -1):
        place = folder.joinpath(*parts[:length])
        for file in (place.with_suffix(".py"), place / "__init__.py"):
            if file.is_file():
                return file
    return None


def files_imported(file: Path, house: Path) -> set[Path]:
    """The files of a house that one of them imports."""
    files = set()
    for dots, name in python_imports(file):
        places = [file.parents[dots - 1]] if dots else [house, house.parent]
        files |= {imported_file(place, name) for place in places}
    return {
        imported for imported in files if imported and imported != file and imported.is_relative_to(house)
    }


def circles(arrows: dict[str, set[str]]) -> list[str]:
    """The nodes that lie on a circle of arrows, or between two of them."""
    arrows = {node: targets & arrows.keys() for node, targets in arrows.items()}
    while True:
        reached = set().union(*arrows.values()) if arrows else set()
        inner = {node for node, targets in arrows.items() if targets and node in reached}
        if len(inner) == len(arrows):
            return sorted(arrows)
        arrows = {node: targets & inner for node, targets in arrows.items() if node in inner}


def room_of(module: str, inside: tuple[str, ...]) -> str | None:
    """The room of a module that lies inside another: the next name of its path."""
    names = tuple(module.split("::"))
    return names[len(inside)] if len(names) > len(inside) and names[: len(inside)] == inside else None


def upward_arrows(
    arrows: dict[str, set[str]], rooms: tuple[set[str], ...], inside: tuple[str, ...] = ()
) -> list[str]:
    """The arrows between rooms that do not lead to a lower row."""
    ranks = {room: rank for rank, row in enumerate(rooms) for room in row}
    unknown = {room_of(module, inside) for module in arrows if module} - ranks.keys() - {None}
    assert not unknown, f"new rooms need their places in the rows: {unknown}"
    upward = []
    for module, targets in arrows.items():
        room = room_of(module, inside)
        others = {target: room_of(target, inside) for target in targets} if room else {}
        upward += [
            f"{module} -> {target}"
            for target, used_room in others.items()
            if used_room and used_room != room and ranks[used_room] >= ranks[room]
        ]
    return sorted(upward)


@pytest.fixture(scope="module")
def core_arrows() -> dict[str, set[str]]:
    return Crate(CORE).arrows()


def test_core_uses_lower_rooms_only(core_arrows: dict[str, set[str]]) -> None:
    assert upward_arrows(core_arrows, CORE_ROOMS) == []


def test_hyperbolic_uses_lower_rooms_only(core_arrows: dict[str, set[str]]) -> None:
    assert upward_arrows(core_arrows, HYPERBOLIC_ROOMS, ("hyperbolic",)) == []


@pytest.mark.parametrize("folder", [CORE, BINDINGS / "src"], ids=["core", "bindings"])
def test_no_circle_of_rust_files(folder: Path) -> None:
    arrows = Crate(folder).arrows()
    assert sum(map(len, arrows.values())) > len(arrows)
    assert circles(arrows) == []


def test_one_file_names_faer() -> None:
    """Other files of `sparse/` name the module `faer.rs`, by a path or its declaration."""
    allowed = CORE / "sparse" / "faer.rs"
    sources = [*rust_files(CORE), *rust_files(BINDINGS / "src")]
    naming = [
        f
        for f in sources
        if re.search(r"(?<!::)(?<!mod )\bfaer\b", without_comments(f.read_text(encoding="utf-8")))
    ]
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


@pytest.mark.parametrize("room", PACKAGE_ROOMS)
def test_package_uses_lower_rooms_only(room: str) -> None:
    house = BINDINGS / "authalic"
    higher = PACKAGE_ROOMS[PACKAGE_ROOMS.index(room) + 1 :]
    for file in python_files(house / room):
        used = {used_file.relative_to(house).parts[0] for used_file in files_imported(file, house)}
        assert not used & {*higher, "__init__.py"}, file


def test_the_package_itself_uses_no_optional_package() -> None:
    for file in (BINDINGS / "authalic").glob("*.py"):
        if file.name != "__main__.py":
            assert not absolute_imports(file) & OPTIONAL_PACKAGES, file
            assert not {used.parent.name for used in files_imported(file, file.parent)} & {*PACKAGE_ROOMS}, (
                file
            )


def test_only_the_bridge_imports_authalic() -> None:
    importing = {file for file in python_files(ADDON) if "authalic" in absolute_imports(file)}
    assert {addon_room(file) for file in importing} == {"bridge"}


@pytest.mark.parametrize("file", python_files(ADDON), ids=lambda file: file.relative_to(ADDON).as_posix())
def test_addon_uses_lower_rooms_only(file: Path) -> None:
    room = addon_room(file)
    assert room in ADDON_RANK, f"the new room {room} needs its place in ADDON_ROOMS"
    used = {addon_room(used_room) for used_room in files_imported(file, ADDON)} - {room}
    upward = {used_room for used_room in used if ADDON_RANK[used_room] >= ADDON_RANK[room]}
    assert not upward, f"{room} must not use {sorted(upward)}"


@pytest.mark.parametrize("room", sorted(WITHOUT_BLENDER))
def test_arrays_know_no_blender(room: str) -> None:
    for file in python_files(ADDON):
        if addon_room(file) == room:
            assert not absolute_imports(file) & BLENDER_MODULES, file


def test_only_the_room_blender_reads_and_writes_meshes() -> None:
    for file in python_files(ADDON):
        if addon_room(file) != "blender":
            assert "bmesh" not in absolute_imports(file), file
            assert not attributes_named(file) & MESH_DATA, file


def test_ui_touches_no_arrays() -> None:
    for file in python_files(ADDON / "ui"):
        assert "numpy" not in absolute_imports(file), file


@pytest.mark.parametrize("house", PYTHON_HOUSES, ids=lambda house: house.relative_to(ROOT).as_posix())
def test_no_circle_of_python_files(house: Path) -> None:
    files = python_files(house)
    arrows = {str(file): {str(imported) for imported in files_imported(file, house)} for file in files}
    assert any(arrows.values()) or len(files) == 1
    assert circles(arrows) == []


def test_circles_are_seen(tmp_path: Path) -> None:
    (tmp_path / "inner").mkdir()
    sources = {
        "low.py": "import os",
        "first.py": "from . import low\nfrom .inner import second",
        "inner/__init__.py": "",
        "inner/second.py": "def late():\n    from ..third import name",
        "third.py": "from .first import other",
        "top.py": "from . import first",
    }
    for name, source in sources.items():
        (tmp_path / name).write_text(source)
    files = python_files(tmp_path)
    arrows = {
        file.relative_to(tmp_path).as_posix(): {
            imported.relative_to(tmp_path).as_posix() for imported in files_imported(file, tmp_path)
        }
        for file in files
    }
    assert circles(arrows) == ["first.py", "inner/second.py", "third.py"]
    arrows["inner/second.py"].clear()
    assert circles(arrows) == []


@pytest.fixture
def made_up_crate(tmp_path: Path) -> Path:
    sources = {
        "lib.rs": ["mod low;", "pub mod shapes;", "mod top;", "pub use shapes::Square;"],
        "low.rs": [
            *("// crate::top::Top", "use std::fmt;", "pub struct Low;"),
            *("#[cfg(test)]", "mod tests {", "    use crate::top::Top;", "}"),
        ],
        "shapes/mod.rs": [
            *("mod circle;", "mod square;"),
            *("pub use circle::{Circle, area as circle_area};", "pub use square::Square;"),
        ],
        "shapes/square.rs": ["use super::circle_area;", "pub struct Square;"],
        "shapes/circle.rs": [
            "use crate::low;",
            "pub struct Circle;",
            "pub fn area() -> low::Low { low::Low }",
        ],
        "top.rs": [
            "use crate::{low::Low, shapes::{self, Square as Box}};",
            *("pub struct Top;", "fn f() { shapes::circle_area(); }"),
        ],
    }
    (tmp_path / "shapes").mkdir()
    for name, lines in sources.items():
        (tmp_path / name).write_text("\n".join(lines) + "\n")
    return tmp_path


def test_rust_arrows_lead_to_where_a_name_is_defined(made_up_crate: Path) -> None:
    assert Crate(made_up_crate).arrows() == {
        "": set(),
        "low": set(),
        "shapes": set(),
        "shapes::square": {"shapes::circle"},
        "shapes::circle": {"low"},
        "top": {"low", "shapes::circle", "shapes::square"},
    }


def test_circles_of_rust_files_are_seen(made_up_crate: Path) -> None:
    circle = made_up_crate / "shapes" / "circle.rs"
    assert circles(Crate(made_up_crate).arrows()) == []
    circle.write_text(circle.read_text(encoding="utf-8") + "fn grown() { crate::Square; }\n")
    assert circles(Crate(made_up_crate).arrows()) == ["shapes::circle", "shapes::square"]


def test_upward_rust_arrows_are_seen(made_up_crate: Path) -> None:
    arrows = Crate(made_up_crate).arrows()
    assert upward_arrows(arrows, ({"low"}, {"shapes"}, {"top"})) == []
    assert upward_arrows(arrows, ({"shapes"}, {"low"}, {"top"})) == ["shapes::circle -> low"]
    assert upward_arrows(arrows, ({"low", "shapes"}, {"top"})) == ["shapes::circle -> low"]
    assert upward_arrows(arrows, ({"low"}, {"shapes", "top"})) == [
        "top -> shapes::circle",
        "top -> shapes::square",
    ]
    assert upward_arrows(arrows, ({"square"}, {"circle"}), ("shapes",)) == [
        "shapes::square -> shapes::circle"
    ]


@pytest.mark.parametrize(
    "file",
    [
        *(file for house in (*PYTHON_HOUSES, ROOT / "tests") for file in python_files(house)),
        *(file for file in sorted((ROOT / "scripts").iterdir()) if file.is_file() and not file.suffix),
    ],
    ids=lambda file: file.relative_to(ROOT).as_posix(),
)
def test_files_mean_the_same_on_windows(file: Path) -> None:
    """Its paths have backslashes as texts, and its files are read in another encoding than UTF-8."""
    calls = [node for node in ast.walk(ast.parse(file.read_text("utf-8"))) if isinstance(node, ast.Call)]
    for call in calls:
        inner = call.args[0] if call.args and isinstance(call.args[0], ast.Call) else call
        texts = isinstance(call.func, ast.Name) and call.func.id == "str"
        assert not (texts and method(inner) == "relative_to"), f"line {call.lineno}: as_posix()"
        assert method(call) != "read_text" or call.args or call.keywords, f"line {call.lineno}: encoding"


def method(call: ast.Call) -> str | None:
    """The name of the method that is called."""
    return call.func.attr if isinstance(call.func, ast.Attribute) else None


def class_names(node: ast.ClassDef) -> set[str]:
    """The names that the body of a class binds."""
    names = {part.name for part in node.body if isinstance(part, ast.FunctionDef | ast.ClassDef)}
    for part in node.body:
        if isinstance(part, ast.Assign):
            names |= {target.id for target in part.targets if isinstance(target, ast.Name)}
        if isinstance(part, ast.AnnAssign) and part.value is not None and isinstance(part.target, ast.Name):
            names.add(part.target.id)
    return names


@pytest.mark.parametrize("file", python_files(ADDON), ids=lambda file: file.relative_to(ADDON).as_posix())
def test_properties_use_no_name_of_their_class(file: Path) -> None:
    """Python 3.14 evaluates annotations late, and finds methods before what the file imports."""
    classes = [
        node for node in ast.walk(ast.parse(file.read_text("utf-8"))) if isinstance(node, ast.ClassDef)
    ]
    for node in classes:
        annotations = [part.annotation for part in node.body if isinstance(part, ast.AnnAssign)]
        names = {name.id for part in annotations for name in ast.walk(part) if isinstance(name, ast.Name)}
        assert not names & class_names(node), f"{node.name}: {names & class_names(node)}"
