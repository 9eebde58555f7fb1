# SPDX-License-Identifier: GPL-3.0-or-later
"""Small meshes of all kinds, sound and unsound, for random sequences; each becomes the active object."""

import random

import bpy
import meshes


def grid(chance: random.Random) -> None:
    meshes.add_grid(n=chance.randint(1, 9), bump=chance.choice([0, 0.6, 2]))


def monkey(chance: random.Random) -> None:
    meshes.suzanne(0)


def ball(chance: random.Random) -> None:
    meshes.bumpy(meshes.icosphere(chance.randint(1, 3)), chance.choice([0, 0.2]))


def uv_sphere(chance: random.Random) -> None:
    meshes.uv_sphere(chance.randint(3, 16), chance.randint(3, 8))


def cube(chance: random.Random) -> None:
    bpy.ops.mesh.primitive_cube_add()


def cone(chance: random.Random) -> None:
    bpy.ops.mesh.primitive_cone_add(vertices=chance.randint(3, 12), radius2=chance.choice([0, 0.5]))


def cylinder(chance: random.Random) -> None:
    bpy.ops.mesh.primitive_cylinder_add(
        vertices=chance.randint(3, 12), end_fill_type=chance.choice(["NGON", "NOTHING", "TRIFAN"])
    )


def torus(chance: random.Random) -> None:
    meshes.torus()


def several(chance: random.Random) -> None:
    offset = (4 * k for k in range(3))
    meshes.add(
        *meshes.together(
            meshes.grid(4), meshes.tetrahedron((next(offset) + 4, 0, 0)), meshes.moebius(offset=(0, 8, 0)),
            meshes.ring((0, -8, 0)),
        )
    )  # fmt: skip


def soup(chance: random.Random) -> None:
    """Random triangles and quads: edges with three faces, faces without area, vertices without faces."""
    count = chance.randint(4, 14)
    vertices = [[chance.choice([0, 1, chance.random()]) for _ in range(3)] for _ in range(count)]
    faces = {
        tuple(chance.sample(range(count), chance.choice([3, 3, 4]))) for _ in range(chance.randint(1, 12))
    }
    distinct = {frozenset(face): face for face in sorted(faces)}
    meshes.add(vertices, list(distinct.values()), "Soup")


def nothing(chance: random.Random) -> None:
    meshes.add([(0, 0, 0), (1, 0, 0)][: chance.randint(0, 2)], [], "Nothing")


ALL = (grid, monkey, ball, uv_sphere, cube, cone, cylinder, torus, several, soup, nothing)
