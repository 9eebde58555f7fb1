# SPDX-License-Identifier: MIT OR Apache-2.0
"""One method on the large pair, in a process of its own, so that its memory can be measured.

Usage: python -m bench.hyperbolic.worker METHOD TIMES RESULT.json

TIMES says how often the pair is subdivided. RESULT.json has the figures, or only an error.
"""

import json
import sys
from pathlib import Path

from bench.hyperbolic import pairs
from bench.hyperbolic.measures import measured
from bench.hyperbolic.methods import METHODS
from bench.peers.worker import message, peak_memory


def main(name, times, target):
    """Measures and writes; an exception of the method is a result."""
    pair = pairs.subdivided(pairs.across("pial", 10), int(times))
    before = peak_memory()
    try:
        registration = METHODS[name](pair)
    except Exception as problem:
        Path(target).write_text(json.dumps({"error": message(problem)}))
        return
    figures = {"seconds": registration.seconds, "remark": registration.remark}
    figures |= {"before": before, "peak": peak_memory()}
    measures = measured(pair, registration)
    figures |= {"flipped": measures.flipped, "areas": float(measures.areas.mean())}
    figures |= {"vertices": len(pair.source.vertices), "variation": measures.variation}
    Path(target).write_text(json.dumps(figures | {"difference": measures.difference["sulc"]}))


if __name__ == "__main__":
    main(*sys.argv[1:])
