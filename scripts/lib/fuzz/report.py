# SPDX-License-Identifier: MIT OR Apache-2.0
"""What a fuzzer has found, from its output."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Sequence


@dataclass(frozen=True)
class Finding:
    """An input that failed, and how."""

    target: str
    file: Path
    problem: str


@dataclass(frozen=True)
class Line:
    """A target, for how long it ran, how many inputs it tried, and how much of the code they reached."""

    target: str
    seconds: float
    runs: int
    coverage: int


def table(lines: Sequence[Line], findings: Sequence[Finding]) -> str:
    """All targets, and below them what failed, as Markdown."""
    text = ["| target | seconds | inputs | edges reached | findings |", "|---|---|---|---|---|"]
    for line in lines:
        count = sum(finding.target == line.target for finding in findings)
        text.append(f"| {line.target} | {line.seconds:.0f} | {line.runs} | {line.coverage} | {count} |")
    text += ["", *(f"- {each.target}: {each.problem} ({each.file})" for each in findings)]
    return "\n".join(text) + "\n"


def runs_and_coverage(output: str) -> tuple[int, int]:
    """The last numbers of inputs and of edges that libFuzzer has printed."""
    counted = re.findall(r"(?m)^#(\d+)\s.*?cov: (\d+)", output)
    return (int(counted[-1][0]), int(counted[-1][1])) if counted else (0, 0)


def problem_in(output: str) -> str:
    """What a target failed with: the message of its panic or exception, or libFuzzer's summary."""
    panic = re.search(r"panicked at ([^\n]*):\n([^\n]*)", output)
    if panic:
        return f"{panic.group(2)} at {panic.group(1)}"
    raised = re.findall(r"(?m)^(\w+(?:Error|Exception|Exit)\b[^\n]*)", output)
    if raised:
        return raised[-1]
    summary = re.search(r"SUMMARY: ([^\n]*)", output)
    return summary.group(1) if summary else "ended without a word"
