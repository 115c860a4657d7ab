#!/usr/bin/env python3
"""make_models.py — writes the example models beside this script. All are made of convex solids.

dice.stl          the six polyhedral dice, each resting on a face; 3, 4 or 5 faces at a corner
keypad.obj        a numeric keypad in millimetres, with materials (keypad.mtl)
arch.obj          a stone arch; its 20 stones touch face to face
cornell_room.obj  the air of a room as a solid, seen from inside, with two boxes (cornell_room.mtl)
"""

import math
import struct
from itertools import combinations
from pathlib import Path

FOLDER = Path(__file__).resolve().parent


def subtract(a, b):
    return [x - y for x, y in zip(a, b)]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a):
    return [x / math.sqrt(dot(a, a)) for x in a]


def hull(points):
    """Faces of the convex hull: vertex indices, counter-clockwise seen from outside."""
    size = max(max(p) - min(p) for p in zip(*points))
    faces = {}
    for i, j, k in combinations(range(len(points)), 3):
        normal = cross(subtract(points[j], points[i]), subtract(points[k], points[i]))
        if dot(normal, normal) < 1e-18 * size**4:
            continue
        normal = unit(normal)
        heights = [dot(normal, subtract(p, points[i])) for p in points]
        if max(heights) > 1e-6 * size:
            normal = [-x for x in normal]
            heights = [-h for h in heights]
        if max(heights) > 1e-6 * size:
            continue
        corners = frozenset(n for n, h in enumerate(heights) if h > -1e-6 * size)
        faces[corners] = normal
    return [ordered(points, sorted(corners), normal) for corners, normal in faces.items()]


def ordered(points, corners, normal):
    centre = [sum(points[n][axis] for n in corners) / len(corners) for axis in range(3)]
    x = unit(subtract(points[corners[0]], centre))
    y = cross(normal, x)

    def angle(n):
        arm = subtract(points[n], centre)
        return math.atan2(dot(arm, y), dot(arm, x))

    return sorted(corners, key=angle)


class Solid:
    """A named convex solid: the hull of its points."""

    def __init__(self, name, points, material=None):
        self.name = name
        self.points = [list(map(float, p)) for p in points]
        self.faces = hull(self.points)
        self.material = material

    def mapped(self, function):
        self.points = [function(p) for p in self.points]
        return self


def box(name, low, high, material=None):
    (x0, y0, z0), (x1, y1, z1) = low, high
    corners = [(x, y, z) for x in (x0, x1) for y in (y0, y1) for z in (z0, z1)]
    return Solid(name, corners, material)


def write_obj(path, solids, header, material_of_face=None):
    lines = [f"# {header}"]
    if any(s.material for s in solids) or material_of_face:
        lines.append(f"mtllib {path.stem}.mtl")
    first = 1
    for solid in solids:
        lines.append(f"o {solid.name}")
        if solid.material:
            lines.append(f"usemtl {solid.material}")
        lines += ["v " + " ".join(f"{x:.6g}" for x in p) for p in solid.points]
        for face in solid.faces:
            if material_of_face and not solid.material:
                lines.append("usemtl " + material_of_face(solid, face))
            lines.append("f " + " ".join(str(first + n) for n in face))
        first += len(solid.points)
    path.write_text("\n".join(lines) + "\n")


def write_mtl(path, materials):
    """materials: name → {statement: values}"""
    lines = []
    for name, statements in materials.items():
        lines.append(f"newmtl {name}")
        lines += [f"{key} {value}" for key, value in statements.items()]
    path.write_text("\n".join(lines) + "\n")


def write_stl(path, solids):
    triangles = []
    for solid in solids:
        for face in solid.faces:
            for a, b in zip(face[1:], face[2:]):
                triangles.append([solid.points[n] for n in (face[0], a, b)])
    data = struct.pack("<80sI", b"written by make_models.py", len(triangles))
    for a, b, c in triangles:
        normal = unit(cross(subtract(b, a), subtract(c, a)))
        data += struct.pack("<12fH", *normal, *a, *b, *c, 0)
    path.write_bytes(data)


def icosahedron():
    golden = (1 + math.sqrt(5)) / 2
    points = []
    for a in (-1, 1):
        for b in (-golden, golden):
            points += [(0, a, b), (a, b, 0), (b, 0, a)]
    return points


def dodecahedron():
    golden = (1 + math.sqrt(5)) / 2
    points = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    for a in (-1 / golden, 1 / golden):
        for b in (-golden, golden):
            points += [(0, a, b), (a, b, 0), (b, 0, a)]
    return points


def trapezohedron():
    """The ten-sided die. The apex height makes its kites flat."""
    tilt = 0.105
    apex = tilt * (1 + math.cos(math.pi / 5)) / (1 - math.cos(math.pi / 5))
    ring = [
        (math.cos(n * math.pi / 5), math.sin(n * math.pi / 5), tilt if n % 2 else -tilt)
        for n in range(10)
    ]
    return [*ring, (0, 0, apex), (0, 0, -apex)]


def rested(name, points, inradius, place, turn_deg):
    """The die scaled to its inradius, turned so that a face lies on z = 0, and put in its place."""
    solid = Solid(name, points)
    face = solid.faces[0]
    a, b, c = (solid.points[n] for n in face[:3])
    down = unit(cross(subtract(b, a), subtract(c, a)))
    scale = inradius / dot(down, a)
    x = unit(subtract(b, a))
    y = cross(x, down)
    turn = math.radians(turn_deg)

    def put(p):
        u, v, w = scale * dot(p, x), scale * dot(p, y), inradius - scale * dot(p, down)
        return [
            place[0] + u * math.cos(turn) - v * math.sin(turn),
            place[1] + u * math.sin(turn) + v * math.cos(turn),
            w,
        ]

    return solid.mapped(put)


def dice():
    cube = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    tetrahedron = [p for p in cube if p[0] * p[1] * p[2] > 0]
    octahedron = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]
    return [
        rested("d4", tetrahedron, 4.2, (-24, -13), 20),
        rested("d6", cube, 7.5, (2, -17), 28),
        rested("d8", octahedron, 7, (26, -11), 75),
        rested("d10", trapezohedron(), 7.2, (-23, 14), 40),
        rested("d12", dodecahedron(), 9, (1, 11), 10),
        rested("d20", icosahedron(), 9.5, (27, 15), 55),
    ]


def key(name, material, x, y, width, depth, place_on_top):
    """A tapered key cap in the plane of the keypad's top, sunk 1 mm into it."""
    rim, height = 1.7, 7.0
    low = [(x, y), (x + width, y), (x + width, y + depth), (x, y + depth)]
    high = [
        (x + rim, y + rim),
        (x + width - rim, y + rim),
        (x + width - rim, y + depth - 0.8 * rim),
        (x + rim, y + depth - 0.8 * rim),
    ]
    points = [(u, v, -1) for u, v in low] + [(u, v, height) for u, v in high]
    return Solid(name, points, material).mapped(place_on_top)


def keypad():
    width, depth, front, back = 86.0, 132.0, 11.0, 24.0
    tilt = math.atan2(back - front, depth)

    def place_on_top(p):
        return [
            p[0],
            p[1] * math.cos(tilt) - p[2] * math.sin(tilt),
            front + p[1] * math.sin(tilt) + p[2] * math.cos(tilt),
        ]

    slope = [(x, y, z) for x in (0, width) for y, z in ((0, front), (depth, back))]
    sole = [(x, y, 0) for x in (2, width - 2) for y in (2, depth - 2)]
    waist = [(x, y, 3) for x in (0, width) for y in (0, depth)]
    solids = [Solid("body", slope + sole + waist, "shell")]

    pitch, cap, left, near = 19.0, 17.4, 5.9, 5.5
    long_cap = cap + pitch
    caps = [("zero", "light", 0, 0, long_cap, cap), ("point", "light", 2, 0, cap, cap)]
    for row in range(3):
        for column in range(3):
            caps.append((f"n{3 * row + column + 1}", "light", column, row + 1, cap, cap))
    caps += [
        ("enter", "accent", 3, 0, cap, long_cap),
        ("plus", "dark", 3, 2, cap, long_cap),
        ("clear", "accent", 0, 4, cap, cap),
        ("divide", "dark", 1, 4, cap, cap),
        ("times", "dark", 2, 4, cap, cap),
        ("minus", "dark", 3, 4, cap, cap),
    ]
    for name, material, column, row, w, d in caps:
        solids.append(
            key(name, material, left + column * pitch, near + row * pitch, w, d, place_on_top)
        )
    frame = box("frame", (left, 103, -1), (width - left, 127, 3), "dark").mapped(place_on_top)
    glass = box("display", (left + 4, 106.5, -1), (width - left - 4, 123.5, 3.6), "display")
    return [*solids, frame, glass.mapped(place_on_top)]


KEYPAD_MATERIALS = {
    "shell": {"Kd": "0.30 0.31 0.32", "Pr": "0.45", "Pm": "0"},
    "light": {"Kd": "0.62 0.60 0.54", "Pr": "0.35", "Pm": "0"},
    "dark": {"Kd": "0.055 0.06 0.07", "Pr": "0.3", "Pm": "0"},
    "accent": {"Kd": "0.70 0.16 0.02", "Pr": "0.3", "Pm": "0"},
    "display": {"Kd": "0.02 0.035 0.03", "Pr": "0.08", "Pm": "0"},
}


def voussoir(name, inner, outer, half_depth, first_deg, last_deg, centre_z):
    points = []
    for angle in (math.radians(first_deg), math.radians(last_deg)):
        for radius in (inner, outer):
            for y in (-half_depth, half_depth):
                points.append((radius * math.cos(angle), y, centre_z + radius * math.sin(angle)))
    return Solid(name, points)


def arch():
    inner, outer, springing, count = 3.0, 4.1, 4.0, 11
    solids = [box("plinth", (-5.4, -2.0, 0), (5.4, 2.0, 0.7))]
    for side, sign in (("left", -1), ("right", 1)):

        def course(name, inside, outside, half_depth, low, high):
            x = sorted((sign * inside, sign * outside))
            return box(f"{side}_{name}", (x[0], -half_depth, low), (x[1], half_depth, high))

        solids += [
            course("foot", 2.75, 4.4, 1.45, 0.7, 1.2),
            course("lower", 3.0, 4.1, 1.2, 1.2, 2.4),
            course("upper", 3.0, 4.1, 1.2, 2.4, 3.6),
            course("impost", 2.8, 4.3, 1.4, 3.6, 4.0),
        ]
    step = 180 / count
    for n in range(count):
        keystone = n == count // 2
        solids.append(
            voussoir(
                "keystone" if keystone else f"voussoir_{n}",
                inner - (0.15 if keystone else 0),
                outer + (0.45 if keystone else 0),
                1.35 if keystone else 1.2,
                n * step,
                (n + 1) * step,
                springing,
            )
        )
    return solids


def cornell_room():
    """A closed box about the origin, two wide and high, with two boxes on its floor."""

    def turned(solid, centre, angle_deg):
        c, s = math.cos(math.radians(angle_deg)), math.sin(math.radians(angle_deg))
        return solid.mapped(
            lambda p: [centre[0] + c * p[0] - s * p[1], centre[1] + s * p[0] + c * p[1], p[2]]
        )

    return [
        box("room", (-1, -3, -1), (1, 1, 1)),
        turned(box("tall", (-0.3, -0.3, -1), (0.3, 0.3, 0.2), "white"), (-0.34, 0.32), 18),
        turned(box("short", (-0.3, -0.3, -1), (0.3, 0.3, -0.4), "white"), (0.36, -0.32), -17),
    ]


def wall_material(solid, face):
    xs = {solid.points[n][0] for n in face}
    return "red" if xs == {-1.0} else "green" if xs == {1.0} else "white"


CORNELL_MATERIALS = {
    "white": {"Kd": "0.73 0.73 0.73", "Pr": "0.9", "Pm": "0"},
    "red": {"Kd": "0.63 0.065 0.05", "Pr": "0.9", "Pm": "0"},
    "green": {"Kd": "0.14 0.45 0.091", "Pr": "0.9", "Pm": "0"},
}


def main():
    write_stl(FOLDER / "dice.stl", dice())
    write_obj(FOLDER / "keypad.obj", keypad(), "a numeric keypad, millimetres, z up")
    write_mtl(FOLDER / "keypad.mtl", KEYPAD_MATERIALS)
    write_obj(FOLDER / "arch.obj", arch(), "a stone arch, z up; the stones touch")
    write_obj(FOLDER / "cornell_room.obj", cornell_room(), "the air of a room, z up", wall_material)
    write_mtl(FOLDER / "cornell_room.mtl", CORNELL_MATERIALS)


if __name__ == "__main__":
    main()
