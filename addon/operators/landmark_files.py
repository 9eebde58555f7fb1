# SPDX-License-Identifier: GPL-3.0-or-later
"""authalic.landmark_export and authalic.landmark_import: pairs of landmarks and of curves as JSON files."""

from collections.abc import Sized
from pathlib import Path
from pathlib import Path as FilePath
from typing import TYPE_CHECKING

import bpy
import numpy as np
from bpy.props import StringProperty
from bpy_extras.io_utils import ExportHelper, ImportHelper

from .. import messages
from ..blender.types import Landmark, MeshObject, OperatorMixin, Status, is_mesh
from ..landmarks import curves as landmark_curves
from ..landmarks import files as landmark_files
from ..landmarks import points as landmark_points
from ..landmarks.curves import Curve
from ..landmarks.files import CannotRead, Point, TooLarge
from ..landmarks.objects import CannotPair, active_source
from ..landmarks.points import Pair
from . import poll


class _File(OperatorMixin):
    if TYPE_CHECKING:
        filepath: str

        def run(self, source: MeshObject, path: FilePath) -> Status: ...

    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 (Blender reads a plain set)
    filename_ext = ".json"
    filter_glob: StringProperty(default="*.json", options={"HIDDEN"})

    def execute(self, context: bpy.types.Context) -> Status:
        try:
            return self.run(active_source(context), self._path())
        except (CannotPair, CannotRead, TooLarge, OSError, UnicodeError) as problem:
            name = Path(self.filepath).name
            text = problem.strerror if isinstance(problem, OSError) and problem.strerror else problem
            self.report({"ERROR"}, f"{name}: {text}" if name else str(text))
            return {"CANCELLED"}

    def _path(self) -> FilePath:
        if not self.filepath:
            raise CannotPair("No file is named")
        return Path(bpy.path.abspath(self.filepath))


class AUTHALIC_OT_landmark_export(_File, bpy.types.Operator, ExportHelper):  # type: ignore[misc]
    """Write the landmarks and landmark curves to a JSON file, with the numbers of their vertices"""

    bl_idname = "authalic.landmark_export"
    bl_label = "Export Landmarks"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return poll.has_points_or_curves(cls, context)

    def run(self, source: MeshObject, path: FilePath) -> Status:
        pairs, curves = landmark_points.pairs(source), landmark_curves.pairs(source)
        listed = zip(pairs, source.authalic_landmarks, strict=True)
        sound = [_point(pair, landmark) for pair, landmark in listed if pair.problem is None]
        usable = [curve for curve in curves if curve.problem is None]
        whole = [(curve.name, curve.source.vertices, curve.target.vertices) for curve in usable]
        unsound: list[Pair | Curve] = [*pairs, *curves]
        left = [f"{pair.name}: {pair.problem}" for pair in unsound if pair.problem is not None]
        if not sound and not whole:
            raise CannotPair(f"nothing was written, {messages.listed(left)}")
        content = landmark_files.Landmarks(source.name, source.authalic_target.name, sound, whole)
        landmark_files.write(path, content)
        done = f"Wrote {_counted(sound, whole)} to {path.name}"
        if left:
            self.report({"WARNING"}, f"{done}, not {messages.listed(left)}")
        else:
            self.report({"INFO"}, done)
        return {"FINISHED"}


class AUTHALIC_OT_landmark_import(_File, bpy.types.Operator, ImportHelper):  # type: ignore[misc]
    """Replace the landmarks and landmark curves by those of a JSON file.

    A file without curves leaves the curves alone. If there is no target yet, the mesh object that the file
    names becomes the target"""

    bl_idname = "authalic.landmark_import"
    bl_label = "Import Landmarks"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return poll.can_change_lists(cls, context)

    def run(self, source: MeshObject, path: FilePath) -> Status:
        content = landmark_files.read(path)
        named: bpy.types.Object | None = bpy.data.objects.get(content.target)
        before = source.authalic_target
        if before is None and is_mesh(named) and named != source:
            source.authalic_target = named
        try:
            landmark_curves.check_all(source, content.curves or [])
            landmark_points.replace(source, [pair[:3] for pair in content.pairs])
            if content.curves is not None:
                landmark_curves.replace(source, content.curves)
        except CannotPair:
            source.authalic_target = before
            raise
        for landmark, pair in zip(source.authalic_landmarks, content.pairs, strict=True):
            if pair.weight is not None:
                landmark.is_soft, landmark.weight = True, pair.weight
        target = source.authalic_target.name
        done = f"Read {_counted(content.pairs, content.curves)} of {source.name} and {target}"
        is_for_others = (content.source, content.target) != (source.name, target)
        note = f', in the file those of "{content.source}" and "{content.target}"' if is_for_others else ""
        self.report({"INFO"}, done + note)
        return {"FINISHED"}


def _point(pair: Pair, landmark: Landmark) -> Point:
    """A pair as a file has it; weights have single precision, and as few digits as tell them apart."""
    weight = float(str(np.float32(landmark.weight))) if landmark.is_soft else None
    return Point(pair.name, pair.source_vertex, pair.target_vertex, weight)


def _counted(pairs: Sized | None, curves: Sized | None) -> str:
    """ "3 landmarks", "2 landmark curves", or both."""
    counted = ((pairs, "landmark"), (curves, "landmark curve"))
    parts = [messages.count(len(entries), noun) for entries, noun in counted if entries]
    return " and ".join(parts) or "no landmarks"


def register() -> None:
    bpy.utils.register_class(AUTHALIC_OT_landmark_export)
    bpy.utils.register_class(AUTHALIC_OT_landmark_import)


def unregister() -> None:
    bpy.utils.unregister_class(AUTHALIC_OT_landmark_import)
    bpy.utils.unregister_class(AUTHALIC_OT_landmark_export)
