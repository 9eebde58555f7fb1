# SPDX-License-Identifier: MIT OR Apache-2.0
"""The core as WebAssembly, with the JavaScript that starts it.

The compiler is this machine's if it has the target, as `rustup target add wasm32-unknown-unknown` installs
it; else that of a Debian system of its own.
"""

from __future__ import annotations

import os
import shutil
from pathlib import Path

from shell import OUT, ROOT, CommandFailed, Unavailable, run, say
from web import system

TARGET = "wasm32-unknown-unknown"
NAME = "authalic_web"
_PROJECT = ROOT / "rust" / "web"
_BINDGEN = _PROJECT / "bindgen" / "Cargo.toml"
_BUILT = OUT / "web" / "target"
_CARGO_HOME = Path(os.environ.get("CARGO_HOME") or Path.home() / ".cargo")
# Numbers of four at a time, which all browsers know since 2023; and a stack for deep recursion.
_FLAGS = ("-C", "target-feature=+simd128", "-C", "link-arg=-zstack-size=8388608")
_BUILD = ("build", "--locked", "--profile", "page", "--target", TARGET)


def build(folder: Path, log: Path) -> None:
    """Writes NAME.js and NAME_bg.wasm into a folder.

    Raises Unavailable where no compiler can be had.
    """
    # 1. The crates, which a Debian system does not fetch by itself
    run(["cargo", "fetch", "--locked", "--manifest-path", _PROJECT / "Cargo.toml"], log=log)
    # 2. The module
    variables = {"CARGO_TARGET_DIR": str(_BUILT), "RUSTFLAGS": " ".join((*_FLAGS, *_without_paths()))}
    manifest = ("--manifest-path", _PROJECT / "Cargo.toml")
    if _has_target():
        run(["cargo", *_BUILD, *manifest], variables, log)
    else:
        say(f"this machine's compiler has no target {TARGET}; that of Debian is taken")
        run(_in_debian(("cargo", *_BUILD, *manifest), variables, log), None, log)
    # 3. The JavaScript
    module = _BUILT / TARGET / "page" / f"{NAME}.wasm"
    bindgen = ["cargo", "run", "--locked", "--release", "--manifest-path", _BINDGEN]
    run([*bindgen, "--", module, folder], {"CARGO_TARGET_DIR": str(_BUILT / "tools")}, log)


def _has_target() -> bool:
    if not shutil.which("rustc"):
        raise Unavailable("the page needs a Rust toolchain")
    try:
        folder = run(["rustc", "--print", "target-libdir", "--target", TARGET]).strip()
    except CommandFailed:
        return False
    return Path(folder).is_dir()


def _in_debian(words: tuple[object, ...], variables: dict[str, str], log: Path) -> list[str]:
    own = {
        **{"CARGO_HOME": str(_CARGO_HOME), "CARGO_NET_OFFLINE": "true"},
        "CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER": "wasm-ld",
    }
    # all of the project, because crates take their edition from its Cargo.toml
    places = [ROOT, _CARGO_HOME / "registry"]
    return system.command(words, log, places, {**variables, **own})


def _without_paths() -> tuple[str, ...]:
    """Messages of panics shall not name this machine's folders."""
    pairs = ((ROOT, "/authalic"), (_CARGO_HOME / "registry" / "src", "/crates"))
    return tuple(f"--remap-path-prefix={place}={name}" for place, name in pairs)
