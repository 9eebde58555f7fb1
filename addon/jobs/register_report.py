# SPDX-License-Identifier: GPL-3.0-or-later
"""The report of a registration."""

from dataclasses import dataclass, field

from .. import messages
from ..registration.registered import Registered

_SOME = 0.005  # of the surface is not 0 %
_MIRRORED = 3  # so many landmarks on a disk tell front from back


@dataclass
class Report:
    """The name of the shape key that was written, and figures of the registration.

    `facts` say what came of other pieces, masks and holes; `notes` what should be looked at.
    """

    key: str
    registered: Registered
    notes: list[str]
    seconds: float
    facts: list[str] = field(default_factory=list)
    refusals: tuple[str, ...] = ()

    def __str__(self) -> str:
        registered = self.registered
        figures = _figures_of_curves(registered) if registered.by_curves else _figures_of_points(registered)
        ending = [registered.status.replace("_", " "), f"{self.seconds:.2f} s"]
        line = ", ".join([*figures, *ending])
        return "; ".join([f"{self.key} on {registered.source.name}: {line}", *self.facts, *self.notes])


def warnings(registered: Registered) -> list[str]:
    """Notes on a registration that is not as requested."""
    early = messages.ENDED_EARLY_BY_CURVES if registered.keeps_shapes else messages.ENDED_EARLY
    notes = [early] if registered.ended_early else []
    if registered.missed and registered.by_curves and not registered.ended_early:
        notes.append(f"curves that do not meet: {messages.listed(registered.missed)}")
    elif registered.missed and not registered.ended_early:
        notes.append(f"pairs that do not meet without a fold: {messages.listed(registered.missed)}")
        if registered.domain == "DISK" and len(registered.names) >= _MIRRORED:
            notes.append("if most do not, the normals of the two may face opposite ways: flip those of one")
    if registered.strain.is_high:
        share = f"{100 * registered.strain.stretched:.0f} % of the surface is stretched or shrunk over 2×"
        remedy = "check that pair, or add pairs" if registered.strain.worst else "add landmarks"
        notes.append(f"the strain is high: {share}{_most_near(registered)}; {remedy}")
    return [*notes, *registered.remarks]


def _strain(registered: Registered) -> str:
    strain = registered.strain
    share = f"{100 * strain.stretched:.0f} % of the surface stretched over 2×{_most_near(registered)}"
    return f"strain {strain.median:.2f} ({share})"


def _most_near(registered: Registered) -> str:
    strain = registered.strain
    return f', most near "{strain.worst}"' if strain.worst and strain.stretched >= _SOME else ""


def _figures_of_points(registered: Registered) -> list[str]:
    return [
        *(_errors_of_points(registered) if registered.names else ["by a feature alone"]),
        messages.count(registered.folds, "fold"),
        _strain(registered),
        *([] if registered.keeps_shapes else [f"authalic energy {registered.energy:.3g}"]),
    ]


def _errors_of_points(registered: Registered) -> list[str]:
    mean, most = 100 * registered.errors.mean(), 100 * registered.errors.max()
    error = f"landmark error mean {mean:.3f} % and max {most:.3f} % of the size of {registered.target.name}"
    return [messages.count(len(registered.names), "landmark pair"), f"{error}{_worst(registered)}"]


def _figures_of_curves(registered: Registered) -> list[str]:
    most = 100 * registered.errors.max(initial=0)
    error = f"curve error max {most:.3f} % of the size of {registered.target.name}{_worst(registered)}"
    return [
        messages.count(len(registered.names), "landmark curve") if registered.names else "boundaries alone",
        *([error] if registered.names else []),
        messages.count(registered.folds, "fold"),
        _strain(registered),
    ]


def _worst(registered: Registered) -> str:
    """The pairs that end furthest from each other, for a report."""
    named = [f'"{name}" {100 * error:.3f} %' for name, error in registered.worst]
    return f", worst at {messages.listed(named)}" if named else ""
