# SPDX-License-Identifier: MIT OR Apache-2.0
"""The files of a Rust crate as a graph: an arrow A → B if the code of A names an item that B defines.

Names are followed through re-exports to the file that defines them. Code for tests only draws no arrow, nor
does the declaration or the re-export of a child module.
"""

import re
from dataclasses import dataclass, field
from pathlib import Path

Module = tuple[str, ...]

_ITEM = re.compile(
    r"^(?:pub(?:\([^)]*\))? )?(?:const |unsafe )*(?:fn|struct|enum|trait|type|const|static) (\w+)",
    re.MULTILINE,
)
_USE = re.compile(r"^\s*(pub(?:\([^)]*\))? )?use ([^;]+);", re.MULTILINE)
_PATH = re.compile(r"(?<![\w:])\w+(?:::\w+)+")


def without_comments(source: str) -> str:
    """Rust code without its comments."""
    return re.sub(r"//[^\n]*|/\*.*?\*/", "", source, flags=re.DOTALL)


def module_path(file: Path, folder: Path) -> Module:
    """The module of a file: `mesh/cut.rs` is ("mesh", "cut"), `mesh/mod.rs` is ("mesh",), `lib.rs` is ()."""
    parts = file.relative_to(folder).with_suffix("").parts
    return parts[:-1] if parts[-1] in ("mod", "lib") else parts


def use_paths(tree: str) -> list[tuple[Module, str]]:
    """The paths of a use tree with the names they get: `a::{B, c::D as E}` has a::B as B and a::c::D as E."""
    tree = tree.strip()
    head, brace, rest = tree.partition("{")
    if brace:
        prefix = tuple(name for name in re.split(r"[\s:]+", head) if name)
        leaves = [leaf for branch in _branches(rest) for leaf in use_paths(branch)]
        return [(prefix, prefix[-1]) if path == ("self",) else (prefix + path, name) for path, name in leaves]
    path, _, alias = tree.partition(" as ")
    names = tuple(re.split(r"\s*::\s*", path.strip()))
    return [(names, alias.strip() or names[-1])]


def _branches(group: str) -> list[str]:
    """The parts of `a, b::{c, d}}` up to its closing brace."""
    depth, branches = 0, [""]
    for character in group:
        if character == "}" and depth == 0:
            break
        depth += (character == "{") - (character == "}")
        if character == "," and depth == 0:
            branches.append("")
        else:
            branches[-1] += character
    return [branch for branch in branches if branch.strip()]


def _without_tests(code: str) -> tuple[str, set[str]]:
    """Code without the parts for tests only, and the names of such modules in files of their own."""
    files = set(re.findall(r"^#\[cfg\(test\)\]\n(?:pub(?:\([^)]*\))? )?mod (\w+);\n", code, re.MULTILINE))
    code = re.sub(r"^#\[cfg\(test\)\]\n[^\n{]*;\n", "", code, flags=re.MULTILINE)
    return re.sub(r"^( *)#\[cfg\(test\)\]\n.*?^\1\}", "", code, flags=re.MULTILINE | re.DOTALL), files


@dataclass
class _File:
    module: Module
    # Items defined in the file itself.
    items: set[str]
    # Imports and re-exports: the name here → its path from the root of the crate.
    imports: dict[str, Module] = field(default_factory=dict)
    # Paths from the root that its code names, re-exports of children aside.
    named: list[Module] = field(default_factory=list)


class Crate:
    """The files of a crate, and the items that they name."""

    def __init__(self, folder: Path) -> None:
        sources = {
            module_path(file, folder): without_comments(file.read_text(encoding="utf-8"))
            for file in sorted(folder.rglob("*.rs"))
        }
        stripped = {module: _without_tests(code) for module, code in sources.items()}
        tests = {(*module, name) for module, (_, names) in stripped.items() for name in names}
        self._files: dict[Module, _File] = {
            module: _File(module, set(_ITEM.findall(code)))
            for module, (code, _) in stripped.items()
            if not any(module[: len(test)] == test for test in tests)
        }
        for module, file in self._files.items():
            self._read(file, stripped[module][0])

    def _read(self, file: _File, code: str) -> None:
        for public, tree in _USE.findall(code):
            for path, name in use_paths(tree):
                whole = self._from_root(path, file.module)
                if whole is None:
                    continue
                file.imports[name] = whole
                is_child = whole[: len(file.module)] == file.module
                if not (public and is_child):
                    file.named.append(whole)
        for path in _PATH.findall(_USE.sub("", code)):
            names = tuple(path.split("::"))
            whole = self._from_root(names, file.module)
            if whole is None and names[0] in file.imports:
                whole = file.imports[names[0]] + names[1:]
            if whole is not None:
                file.named.append(whole)

    def _from_root(self, path: Module, module: Module) -> Module | None:
        """A path as seen from the root of the crate; `None` for other crates and local names."""
        if path[0] == "crate":
            return path[1:]
        if path[0] == "self":
            return module + path[1:]
        above = sum(1 for name in path if name == "super")
        if above:
            return module[: len(module) - above] + path[above:]
        return module + path if (*module, path[0]) in self._files else None

    def _definer(self, path: Module, asked: frozenset[Module] = frozenset()) -> Module | None:
        """The module of the file that defines what a path from the root names; `None` for a whole module."""
        module: Module = ()
        while path and (*module, path[0]) in self._files:
            module, path = (*module, path[0]), path[1:]
        if not path or path in asked:
            return None
        file = self._files[module]
        if path[0] not in file.items and path[0] in file.imports:
            whole = file.imports[path[0]] + path[1:]
            return self._definer(whole, asked | {whole}) if whole not in asked else None
        return module

    def arrows(self) -> dict[str, set[str]]:
        """The modules that each module names items of, `a::b` for `a/b.rs` and `a/b/mod.rs`."""
        arrows = {}
        for module, file in self._files.items():
            definers = {self._definer(path) for path in file.named} - {None, module}
            arrows["::".join(module)] = {"::".join(definer) for definer in definers if definer is not None}
        return arrows
