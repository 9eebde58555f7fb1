# SPDX-License-Identifier: MIT OR Apache-2.0
"""The property tests of the crates, repeated with new cases."""

import os
import re
import subprocess
import time

from shell import ROOT, tail
from steps import CARGO_OPTIONS

CARGO = ("cargo", "test", *CARGO_OPTIONS)
CASES = "2000"
"""The cases of each property and round, unless the property fixes their number."""


def search(report, seconds, limit):
    """Runs every property at least once, and again until the time is over; returns the failures."""
    report.section("Property tests of the crates", "Each round makes new cases; a failure prints its own.")
    targets = properties()
    print("building the property tests ...", flush=True)
    subprocess.run([*CARGO, "--no-run", "--quiet"], cwd=str(ROOT), check=True)
    failures, rounds, ends = [], dict.fromkeys(targets, 0), time.monotonic() + seconds
    while targets and (time.monotonic() < ends or not all(rounds.values())):
        name = min(targets, key=rounds.get)
        problem = run_once(name, targets[name], seconds + limit)
        rounds[name] += 1
        if problem:
            failures.append(f"{name}: {problem}")
            report.line(f"FAILED {name}:\n\n```\n{problem}\n```\n")
            del targets[name]
    for name, number in rounds.items():
        report.line(f"- {name}: {number} rounds")
    return failures


def properties(root=ROOT / "rust"):
    """{test: the cargo options that select its binary} for every test within a `proptest!` block."""
    targets = {}
    for path in sorted(root.rglob("*.rs")):
        for block in re.findall(r"(?ms)^([ \t]*)proptest! \{\n(.*?)^\1\}", path.read_text(encoding="utf-8")):
            for name in re.findall(r"#\[test\]\s*(?:#\[[^\n]*\]\s*)*fn (\w+)", block[1]):
                targets[name] = target_of(path)
    return targets


def target_of(path):
    """The options by which cargo selects the tests of a file; `--lib` would build tests of the bindings."""
    return ("--test", "it") if "tests" in path.parts else ("--tests",)


def run_once(name, target, limit):
    """Runs one round of a property; returns the problem, or an empty string."""
    command = [*CARGO, "--quiet", *target, "--", name]
    variables = {**os.environ, "PROPTEST_CASES": CASES}
    try:
        done = subprocess.run(
            command, cwd=str(ROOT), env=variables, capture_output=True, text=True, timeout=limit
        )
    except subprocess.TimeoutExpired:
        return f"not done after {limit:g} s"
    if done.returncode:
        return tail(done.stdout + done.stderr, 60)
    return "" if re.search(r"[1-9]\d* passed", done.stdout) else f"no such test ran:\n{tail(done.stdout, 5)}"
