# SPDX-License-Identifier: GPL-3.0-or-later
"""What is said of a registration."""

from dataclasses import dataclass

from .. import messages
from ..registration.registered import Registered

_MIRRORED = 3  # so many landmarks on a disk tell front from back


@dataclass
class Report:
    """What was written: the shape key's name and figures of the registration."""

    key: str
    registered: Registered
    notes: list[str]
    seconds: float
    refusals: tuple[str, ...] = ()

    def __str__(self) -> str:
        one = self.registered
        figures = _figures_of_curves(one) if one.by_curves else _figures_of_points(one)
        ending = [one.status.replace("_", " "), f"{self.seconds:.2f} s"]
        line = ", ".join([*figures, *ending])
        return "; ".join([f"{self.key} on {one.source.name}: {line}", *self.notes])


def warnings(registered: Registered) -> list[str]:
    """What is not as it was asked for."""
    early = messages.ENDED_EARLY_BY_CURVES if registered.by_curves else messages.ENDED_EARLY
    notes = [early] if registered.ended_early else []
    if registered.missed and registered.by_curves and not registered.ended_early:
        notes.append(f"curves that do not meet: {messages.listed(registered.missed)}")
    elif registered.missed and not registered.ended_early:
        notes.append(f"pairs that do not meet without a fold: {messages.listed(registered.missed)}")
        if registered.domain == "DISK" and len(registered.names) >= _MIRRORED:
            notes.append("if most do not, the normals of the two may face opposite ways: flip those of one")
    return [*notes, *registered.remarks]


def _figures_of_points(one: Registered) -> list[str]:
    mean, most = 100 * one.errors.mean(), 100 * one.errors.max()
    error = f"landmark error mean {mean:.3f} % and max {most:.3f} % of the size of {one.target.name}"
    return [
        messages.count(len(one.names), "landmark pair"),
        f"{error}{_worst(one)}",
        messages.count(one.folds, "fold"),
        f"authalic energy {one.energy:.3g}",
    ]


def _figures_of_curves(one: Registered) -> list[str]:
    most = 100 * one.errors.max(initial=0)
    error = f"curve error max {most:.3f} % of the size of {one.target.name}{_worst(one)}"
    return [
        messages.count(len(one.names), "landmark curve") if one.names else "boundaries alone",
        *([error] if one.names else []),
        messages.count(one.folds, "fold"),
    ]


def _worst(registered: Registered) -> str:
    """The pairs that end furthest from each other, for a report."""
    named = [f'"{name}" {100 * error:.3f} %' for name, error in registered.worst]
    return f", worst at {messages.listed(named)}" if named else ""
