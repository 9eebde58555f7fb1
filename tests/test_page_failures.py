# SPDX-License-Identifier: MIT OR Apache-2.0
"""What the page says where its core fails, by Node, which needs no core for that."""

import json
import shutil
import subprocess
from pathlib import Path

import pytest

MODULE = Path(__file__).resolve().parents[1] / "rust" / "web" / "page" / "failures.js"
NODE = shutil.which("node")
CODE = """
const source = require("fs").readFileSync(process.argv[1], "utf-8");
import("data:text/javascript," + encodeURIComponent(source)).then(({ wordsOfFailure }) => {
  const [panic, error] = [process.argv[2], eval(process.argv[3])];
  console.log(JSON.stringify(wordsOfFailure(panic, error)));
});
"""


@pytest.mark.skipif(NODE is None, reason="needs Node")
@pytest.mark.parametrize(
    ("panic", "error", "kind"),
    [
        ("", 'new WebAssembly.RuntimeError("unreachable")', "out_of_memory"),
        ("", 'new WebAssembly.RuntimeError("unreachable executed")', "out_of_memory"),
        ("", 'new RangeError("Array buffer allocation failed")', "out_of_memory"),
        ("", 'new RangeError("WebAssembly.Memory.grow(): Unable to grow instance memory")', "out_of_memory"),
        (
            "memory allocation of 9 bytes",
            'new WebAssembly.RuntimeError("unreachable")',
            "out_of_memory",
        ),
        ("", 'new RangeError("Out of memory")', "out_of_memory"),
        ("", 'new RangeError("Invalid typed array length: 9")', "out_of_memory"),
        ("capacity overflow at raw_vec.rs", 'new WebAssembly.RuntimeError("unreachable")', "out_of_memory"),
        ("index out of bounds", 'new WebAssembly.RuntimeError("unreachable")', "panic"),
        ("", 'new WebAssembly.RuntimeError("integer divide by zero")', "panic"),
        ("", 'new WebAssembly.RuntimeError("memory access out of bounds")', "panic"),
        ("panicked at rust/core/src/memory.rs:9:5", 'new WebAssembly.RuntimeError("unreachable")', "panic"),
        ("", 'new RangeError("Maximum call stack size exceeded")', "panic"),
        ("", 'new TypeError("x is not a function")', "panic"),
    ],
)
def test_a_page_without_memory_says_that_the_mesh_is_too_large(panic: str, error: str, kind: str) -> None:
    done = subprocess.run(
        [str(NODE), "-e", CODE, str(MODULE), panic, error], capture_output=True, text=True, timeout=60
    )
    assert done.returncode == 0, done.stderr
    words = json.loads(done.stdout)
    assert words["errorKind"] == kind and words["isFatal"]
    assert ("too large" in words["message"]) == (kind == "out_of_memory")
    assert ("report this mesh" in words["message"]) == (kind == "panic")
