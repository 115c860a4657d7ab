#!/usr/bin/env python3
"""make_models.py FOLDER — writes the models of docs/rounding-gallery.md, each with what is to be seen at the origin.

box.obj       a corner of three convex edges
pyramid.obj   an apex of four
bracket.obj   the end of a concave edge, between two convex ones
pocket.obj    an L-shaped pocket: at its inner corner two concave edges meet a convex one
saddle.obj    two convex and two concave edges in turn
boss.obj      a block on a plate
hole.obj      a plate with a round hole of 48 facets, with normals
step.obj      a step that is lower than the others' radius
rib.obj       a plate with a rib that is thinner than two radii, beside one that is thicker
radii.toml    the bracket with edges of several radii
"""

import math
import sys
from pathlib import Path


RADII = """\
[[object]]
file = "bracket.obj"

[object.round]
radius = 0.08
edges = "both"
rules = [
  { radius = 0.6, kind = "concave" },
  { radius = 0.4, edges = [[[2, 0, 0], [2, 2, 0]], [[0, 0, 2], [0, 2, 2]]] },
  { radius = 0, edges = [[[2, 0, -1], [2, 2, -1]]] },
]
"""


def write(path, points, faces, normals=None):
    """faces: lists of corners; normals: one for each corner of each face, or None for faces that are flat."""
    lines = ["# written by make_models.py"]
    lines += ["v " + " ".join(f"{x:.9g}" for x in p) for p in points]
    count = 0
    for at, face in enumerate(faces):
        of_face = normals[at] if normals else None
        if of_face:
            lines += ["vn " + " ".join(f"{x:.9g}" for x in n) for n in of_face]
            lines.append("f " + " ".join(f"{v + 1}//{count + k + 1}" for k, v in enumerate(face)))
            count += len(face)
        else:
            lines.append("f " + " ".join(str(v + 1) for v in face))
    path.write_text("\n".join(lines) + "\n")


def write_cells(path, xs, ys, zs, is_filled):
    """The solid of those cells of a grid whose middle is_filled."""
    grid = [xs, ys, zs]
    sizes = [len(planes) - 1 for planes in grid]

    def filled(cell):
        if not all(0 <= i < n for i, n in zip(cell, sizes)):
            return False
        return is_filled(*[(p[i] + p[i + 1]) / 2 for p, i in zip(grid, cell)])

    points, faces, index = [], [], {}

    def corner(at):
        if at not in index:
            index[at] = len(points)
            points.append([planes[i] for planes, i in zip(grid, at)])
        return index[at]

    cells = [(i, j, k) for i in range(sizes[0]) for j in range(sizes[1]) for k in range(sizes[2])]
    for cell in filter(filled, cells):
        for axis in range(3):
            u, v = (axis + 1) % 3, (axis + 2) % 3
            for side in (0, 1):
                beside = list(cell)
                beside[axis] += 2 * side - 1
                if filled(tuple(beside)):
                    continue
                loop = []
                for du, dv in ((0, 0), (1, 0), (1, 1), (0, 1)):
                    at = list(cell)
                    at[axis] += side
                    at[u] += du
                    at[v] += dv
                    loop.append(corner(tuple(at)))
                faces.append(loop if side else loop[::-1])
    write(path, points, faces)


def write_pyramid(path):
    points = [[0, 0, 0]] + [[1.5 * x, 1.5 * y, -1.8] for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    write(path, points, [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1], [4, 3, 2, 1]])


def write_saddle(path):
    corners = [(1.8, 1.8, 0.9), (-1.8, 1.8, -0.9), (-1.8, -1.8, 0.9), (1.8, -1.8, -0.9)]
    points = [[0, 0, 0], *map(list, corners), *[[x, y, -2.2] for x, y, _ in corners]]
    faces = [[8, 7, 6, 5]]
    for i in range(4):
        a, b = 1 + i, 1 + (i + 1) % 4
        faces += [[0, a, b], [b, a, a + 4, b + 4]]
    write(path, points, faces)


def write_hole(path):
    """Its wall and the rings of its faces have as many pieces as there are facets."""
    count, radius, half, depth = 48, 1.0, 2.0, 1.0
    circle = [(math.cos(2 * math.pi * i / count), math.sin(2 * math.pi * i / count)) for i in range(count)]
    stretch = [half / max(abs(x), abs(y)) for x, y in circle]
    points = []
    for z in (0, -depth):
        points += [[radius * x, radius * y, z] for x, y in circle]
        points += [[s * x, s * y, z] for s, (x, y) in zip(stretch, circle)]
    faces, normals = [], []

    def add(loop, of_corners):
        faces.append(loop)
        normals.append(of_corners)

    for i in range(count):
        j = (i + 1) % count
        top, rim, low, low_rim = 0, count, 2 * count, 3 * count
        middle = [(a + b) / 2 for a, b in zip(points[rim + i], points[rim + j])]
        outward = [float(abs(x) > half - 1e-6) * math.copysign(1, x) for x in middle[:2]] + [0]
        add([top + i, rim + i, rim + j, top + j], [(0, 0, 1)] * 4)
        add([low + j, low_rim + j, low_rim + i, low + i], [(0, 0, -1)] * 4)
        inward_i, inward_j = [(-x, -y, 0) for x, y in (circle[i], circle[j])]
        add([top + i, top + j, low + j, low + i], [inward_i, inward_j, inward_j, inward_i])
        add([rim + i, low_rim + i, low_rim + j, rim + j], [outward] * 4)
    write(path, points, faces, normals)


def main(folder):
    folder.mkdir(parents=True, exist_ok=True)
    write_cells(folder / "box.obj", [-2, 0], [0, 2], [-2, 0], lambda x, y, z: True)
    write_pyramid(folder / "pyramid.obj")
    write_cells(folder / "bracket.obj", [-1, 0, 2], [0, 2], [-1, 0, 2], lambda x, y, z: x < 0 or z < 0)
    write_cells(folder / "pocket.obj", [-3, -2, 0, 2, 3], [-3, -2, 0, 2, 3], [-1, 0, 1],
                lambda x, y, z: z < 0 or max(abs(x), abs(y)) > 2 or (x < 0 < y))
    write_saddle(folder / "saddle.obj")
    write_cells(folder / "boss.obj", [-2, -0.8, 0.8, 2], [-2, -0.8, 0.8, 2], [-0.7, 0, 1.2],
                lambda x, y, z: z < 0 or max(abs(x), abs(y)) < 0.8)
    write_hole(folder / "hole.obj")
    write_cells(folder / "step.obj", [-2, 0, 2], [0, 2], [-1.2, 0, 0.15], lambda x, y, z: z < 0 or x < 0)
    write_cells(folder / "rib.obj", [-2, -0.6, -0.35, 0.35, 1.25, 2], [-0.8, 2], [-0.8, 0, 1],
                lambda x, y, z: z < 0 or -0.6 < x < -0.35 or 0.35 < x < 1.25)
    (folder / "radii.toml").write_text(RADII)


main(Path(sys.argv[1]))
