# SPDX-License-Identifier: MIT OR Apache-2.0
"""What the crate's example `bits` prints on two platforms: where the bits differ, and by how much."""

from __future__ import annotations

import math
import struct
from dataclasses import dataclass
from typing import Dict, Sequence

Results = Dict[str, Sequence[float]]
"""{what was computed: its numbers}"""


@dataclass(frozen=True)
class Difference:
    """How the numbers of a result differ on two platforms."""

    name: str
    numbers: int
    differing: int
    """How many have other bits."""
    largest: float
    """The largest difference, in parts of the largest number; infinite if the counts of numbers differ."""


def read(output: str) -> Results:
    """The results that the example has printed; other lines are passed over."""
    results = {}
    for line in output.splitlines():
        name, colon, digits = line.strip().partition(": ")
        words = digits.split(" ")
        if colon and all(len(word) == 16 and set(word) <= set("0123456789abcdef") for word in words):
            results[name] = struct.unpack(f">{len(words)}d", bytes.fromhex("".join(words)))
    return results


def compare(results: Results, other: Results) -> list[Difference]:
    """A difference for each result of either, in the order of the first."""
    names = [*results, *(name for name in other if name not in results)]
    return [_difference(name, results.get(name, ()), other.get(name, ())) for name in names]


def table(differences: Sequence[Difference], platform: str) -> str:
    """All results, as Markdown."""
    lines = [f"| result | numbers | other bits on {platform} | largest difference |", "|---|---|---|---|"]
    for each in differences:
        largest = f"{each.largest:.1e}" if each.differing else ""
        lines.append(f"| {each.name} | {each.numbers} | {each.differing or 'none'} | {largest} |")
    return "\n".join(lines) + "\n"


def summary(differences: Sequence[Difference]) -> str:
    """One line about all results."""
    if not differences:
        return "no results"
    functions = [each for each in differences if each.name.startswith("function ")]
    results = [each for each in differences if each not in functions]
    parts = []
    for kind, those in (("functions", functions), ("results", results)):
        same = sum(not each.differing for each in those)
        largest = max((each.largest for each in those), default=0.0)
        ending = f", the others within {largest:.0e}" if same < len(those) else ""
        parts.append(f"the same bits in {same} of {len(those)} {kind}{ending}")
    return "; ".join(parts)


def _difference(name: str, numbers: Sequence[float], other: Sequence[float]) -> Difference:
    if len(numbers) != len(other):
        return Difference(name, len(numbers), max(len(numbers), len(other)), math.inf)
    differing = [(a, b) for a, b in zip(numbers, other) if struct.pack(">d", a) != struct.pack(">d", b)]
    scale = max((abs(a) for a in numbers if math.isfinite(a)), default=0.0) or 1.0
    sizes = [abs(a - b) / scale if math.isfinite(a) and math.isfinite(b) else math.inf for a, b in differing]
    return Difference(name, len(numbers), len(differing), max(sizes, default=0.0))
