# SPDX-License-Identifier: MIT OR Apache-2.0
"""Newton's method beside the paper's heat diffusion and its Ricci flow, on one pair."""

import time
from dataclasses import dataclass

import numpy as np

import authalic
from bench.hyperbolic.methods import curves_result
from bench.peers.worker import message

SOLVERS = {
    "Newton (default)": {},
    "heat diffusion": {"solver": "heat"},
    "metric by Ricci flow": {"metric": "ricci_flow"},
}
NEWTON = "Newton (default)"
SAME_METRIC = (NEWTON, "heat diffusion")
"""Solvers whose energies compare."""
COLUMNS = (
    "solver", "steps", "energy at first", "energy at last", "above Newton's", "folds", "curvature left",
    "away from Newton's map, mean", "max, mm", "s", "remark",
)  # fmt: skip
NOTE = """\
All start from the same map. Energies are harmonic ones in the hyperbolic metric. The heat diffusion ends with
2,000 steps. The Ricci flow of the metric is finished by Newton's method where it is too slow; its energy is
in another discrete metric."""


@dataclass(frozen=True)
class Solved:
    """A registration and the seconds it took."""

    result: object
    seconds: float

    @property
    def energies(self):
        """The energies before and after each step, of the piece with the most steps."""
        return max(self.result.energies, key=len)


def compared(pair, write):
    """{solver: Solved}; `write` gets the rows."""
    solved = {}
    for name, options in SOLVERS.items():
        began = time.perf_counter()
        try:
            result = curves_result(pair, **options)
        except authalic.SolverError as problem:
            write((name, *("–",) * 9, message(problem).replace("|", "/")))
            continue
        solved[name] = Solved(result, time.perf_counter() - began)
        write((name, *cells(solved[name], solved.get(NEWTON))))
    return solved


def cells(solved, newton):
    """The cells of a row, from the steps on."""
    result, energies = solved.result, solved.energies
    best = (newton or solved).energies[-1]
    away = np.linalg.norm(result.positions - (newton or solved).result.positions, axis=1)
    return (
        len(energies) - 1, f"{energies[0]:.4f}", f"{energies[-1]:.6f}", f"{energies[-1] - best:.1e}",
        len(result.certificates.folded), f"{max(result.certificates.curvature):.0e}", f"{away.mean():.4f}",
        f"{away.max():.3f}", f"{solved.seconds:.1f}", "; ".join([result.status, *result.warnings]),
    )  # fmt: skip
