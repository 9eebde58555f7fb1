# SPDX-License-Identifier: MIT OR Apache-2.0
"""One method on one mesh, in a process of its own, so that its memory and crashes are told apart.

Usage: python -m bench.peers.worker KIND METHOD MESH.npz RESULT.npz

RESULT.npz has the map (`image`, and `vertices`, `faces` if the method cut the mesh) and `facts`, JSON with
seconds, peak memory and a remark; or only `facts` with an error.
"""

import json
import os
import resource
import sys
import time
from pathlib import Path

import numpy as np

from bench.peers import methods


def main(kind, name, mesh, target):
    """Measures and writes; an exception of the method is a result."""
    with np.load(mesh) as arrays:
        vertices, faces = arrays["V"].astype(float), arrays["F"].astype(np.int64)
    method = methods.named(name, kind)
    try:
        method.prepare()
        before = peak_memory()
        began = time.perf_counter()
        result = method.call(vertices, faces)
        seconds = result.seconds or time.perf_counter() - began
    except Exception as problem:
        np.savez(target, facts=json.dumps({"error": message(problem)}))
        return
    facts = {"seconds": seconds, "before": before, "peak": peak_memory(), "remark": result.remark}
    arrays = {"image": result.image, "vertices": result.vertices, "faces": result.faces}
    existing = {key: array for key, array in arrays.items() if array is not None}
    np.savez(target, facts=json.dumps(facts), **existing)


def message(problem):
    """An exception in one line."""
    return " ".join(f"{type(problem).__name__}: {problem}".split())


def peak_memory():
    """The peak of this process's resident memory so far, in MiB.

    On Linux a process inherits the figure of `getrusage` from its parent; that of /proc starts anew.
    """
    try:
        status = Path("/proc/self/status").read_text(encoding="utf-8")
        return int(status.split("VmHWM:")[1].split()[0]) / 1024
    except (OSError, IndexError):
        unit = 2**20 if sys.platform == "darwin" else 2**10
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / unit


if __name__ == "__main__":
    main(*sys.argv[1:])
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(0)  # Blender has been seen to hang at a normal exit
