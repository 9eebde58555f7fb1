# SPDX-License-Identifier: MIT OR Apache-2.0
"""The table of the comparison: its columns, its cells, and what they mean."""

from bench.seams.figures import SAMPLES
from bench.seams.layout import Failure
from bench.seams.peers import GAP, ITERATIONS

COLUMNS = (
    "mesh", "V", "method", "seams", "islands", "SD", "σ₁/σ₂ mean", "σ₁/σ₂ p99", "E_S", "flips",
    "own overlap", "packed", "s", "packed by Blender", "its s", "remark",
)  # fmt: skip
NOTE = f"""\
*Seams* is their length over √area: edges across which the UVs differ, each once, without the mesh's own
boundary. *Islands* counts beside them those that are not disks. *SD* is of the area ratio, with the layout as
a whole scaled to the area of the surface; σ₁/σ₂ and the symmetric Dirichlet energy *E_S* (4 for an isometry)
are per face; all are weighted by area. *Flips* are faces that lie the other way round than most of their
island. *Own overlap* is the share of the covered area that an island covers more than once by itself, by a
raster of {SAMPLES:,} points over the area of the layout, one island at a time. *Packed* is the share of the
unit square that the faces take as the tool leaves them. The bench computes all figures from the UVs, without
the package.

`authalic` is `authalic.unwrap` with that bound of the mean σ₁/σ₂: seams, maps and packing. Blender's Smart UV
Project has its defaults; the borders of its islands are the seams of Minimum Stretch, with {ITERATIONS}
iterations. Its seconds are of both, and include the operator's own packing, by boxes without a gap. xatlas
has its defaults, its square is the smallest that holds the atlas, and its seconds include packing. *Packed
by Blender* is the share after Pack Islands, with concave outlines, any rotation and a gap of {GAP:g}, of the
same islands, whichever tool made them."""


def cells(name, vertices, method, layout, figures, packed):
    """The cells of a row; `packed` is (share, seconds) by Blender's packer, a Failure or None."""
    head = (name, len(vertices), method)
    if figures is None:
        return (*head, *("–",) * 12, in_a_cell(layout.remark))
    return (
        *head, f"{figures.length:.2f}", islands(figures), f"{figures.deviation:.4f}",
        f"{figures.shear:.3f}", f"{figures.shear_p99:.2f}", f"{figures.dirichlet:.3f}", figures.flips,
        f"{100 * figures.overlap:.2f} %", f"{figures.packed:.3f}", f"{layout.seconds:.2f}",
        *packed_cells(packed), in_a_cell(remarks(layout, packed)),
    )  # fmt: skip


def islands(figures):
    """The number of islands, and how many of them are not disks."""
    return f"{figures.islands} ({figures.not_disks} not disks)" if figures.not_disks else figures.islands


def packed_cells(packed):
    """The share and the seconds of Blender's packer."""
    if packed is None or isinstance(packed, Failure):
        return "–", "–"
    share, seconds = packed
    return f"{share:.3f}", f"{seconds:.2f}"


def remarks(layout, packed):
    """The remark on a layout, and the problem of the packer."""
    problem = f"packer: {packed.remark}" if isinstance(packed, Failure) else ""
    return "; ".join(filter(None, (layout.remark, problem)))


def in_a_cell(text):
    """A text as one line that does not break the table."""
    return " ".join(text.replace("|", "/").split())
