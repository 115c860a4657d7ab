#!/usr/bin/env python3
"""make_scenes.py — scenes that sampling finds hard

Writes  plate.csg, fence.csg, spheres.csg and the .csg files beside them, and a .toml for each scene:
        a plate with 400 holes of 1/4 to 1 pixel; 120 pickets of 0.3 pixel and their shadows; 500 balls of
        radius 0.2 pixel on a lawn; mirrors: a ball and a dish that reflect, and a ball of glass, among wires
        that are a few tenths of a pixel in them. All at 640x480; seeds are fixed. objects.json says where every
        small thing of the first three is in the picture, in pixels from the upper left corner.
Usage   make_scenes.py [FOLDER]
"""

import json
import math
import random
import sys
from pathlib import Path

WIDTH, HEIGHT = 640, 480


def sub(a, b):
    return [x - y for x, y in zip(a, b)]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a):
    length = math.sqrt(dot(a, a))
    return [x / length for x in a]


class Camera:
    def __init__(self, position, target, horizontal_fov_deg):
        self.position, self.target = position, target
        self.forward = unit(sub(target, position))
        self.right = unit(cross(self.forward, [0, 1, 0]))
        self.up = cross(self.right, self.forward)
        self.tan = math.tan(math.radians(horizontal_fov_deg) / 2)

    def project(self, p):
        q = sub(p, self.position)
        z = dot(q, self.forward)
        x = (dot(q, self.right) / z / self.tan + 1) / 2 * WIDTH
        y = (1 - dot(q, self.up) / z / self.tan * WIDTH / HEIGHT) / 2 * HEIGHT
        return x, y, z

    def pixels_per_unit(self, z):
        return WIDTH / (2 * self.tan * z)

    def ray(self, x, y):
        u = (2 * x / WIDTH - 1) * self.tan
        v = (1 - 2 * y / HEIGHT) * self.tan * HEIGHT / WIDTH
        return [f + u * r + v * w for f, r, w in zip(self.forward, self.right, self.up)]

    def toml(self):
        fov = 2 * math.degrees(math.atan(self.tan * HEIGHT / WIDTH))
        return (f"up = [0, 1, 0]\n\n[image]\nsize = [{WIDTH}, {HEIGHT}]\nsamples = 16\nmax_depth = 1\n"
                f'filter = "box"\n\n[camera]\nposition = {self.position}\ntarget = {self.target}\n'
                f"fov = {fov:.9f}\n\n[environment]\ntype = \"constant\"\ncolor = [0, 0, 0]\n")


def box(low, high):
    size = [b - a for a, b in zip(low, high)]
    place = "".join(f"[{', '.join('1' if i == k else '0' for k in range(3))}, {low[i]:.9g}], " for i in range(3))
    sides = ", ".join(f"{s:.9g}" for s in size)
    return f"multmatrix([{place}[0, 0, 0, 1]]) {{ cube(size = [{sides}], center = false); }}"


def cylinder(a, b, radius):
    axis = sub(b, a)
    length = math.sqrt(dot(axis, axis))
    z = unit(axis)
    x = unit(cross([0.3, 0.1, 0.9] if abs(z[1]) > 0.5 else [0, 1, 0], z))
    y = cross(z, x)
    rows = ", ".join(f"[{x[i]:.9g}, {y[i]:.9g}, {z[i]:.9g}, {a[i]:.9g}]" for i in range(3))
    return (f"multmatrix([{rows}, [0, 0, 0, 1]]) {{ cylinder($fn = 0, $fa = 12, $fs = 2, h = {length:.9g}, "
            f"r1 = {radius:.9g}, r2 = {radius:.9g}, center = false); }}")


def sphere(center, radius):
    rows = ", ".join(f"[{', '.join('1' if i == k else '0' for k in range(3))}, {center[i]:.9g}]" for i in range(3))
    return f"multmatrix([{rows}, [0, 0, 0, 1]]) {{ sphere($fn = 0, $fa = 12, $fs = 2, r = {radius:.9g}); }}"


def block(name, parts):
    return name + "() {\n\t" + "\n\t".join(parts) + "\n}\n"


def material(name, color, emission=None):
    text = f"\n[material.{name}]\nbase_color = {color}\nglossy_mix = 0\n"
    return text + (f"emission = {emission}\n" if emission else "")


def item(name, file):
    return f'\n[[object]]\nname = "{name}"\nfile = "{file}"\nmaterial = "{name}"\n'


def directional(toward_light, irradiance):
    direction = [-x for x in toward_light]
    return f'\n[[light]]\ntype = "directional"\ndirection = {direction}\nirradiance = {irradiance:.9g}\n'


def point(position, at):
    """A light that gives an irradiance of pi at a point that faces it."""
    d = sub(position, at)
    return f'\n[[light]]\ntype = "point"\nposition = {position}\nintensity = {math.pi * dot(d, d):.9g}\n'


def make_plate(folder):
    rnd = random.Random(11)
    camera = Camera([4.5, 2.5, 34], [0, 0, 0], 46)
    scale = camera.pixels_per_unit(math.sqrt(dot(camera.position, camera.position)))
    holes, objects = [], []
    for i in range(20):
        for j in range(20):
            diameter = [0.25, 0.5, 0.75, 1.0][(i + 2 * j + (j // 2)) % 4]
            x = (i - 9.5) * 0.9 + rnd.uniform(-0.15, 0.15)
            y = (j - 9.5) * 0.9 + rnd.uniform(-0.15, 0.15)
            holes.append(cylinder([x, y, -1], [x, y, 1], diameter / 2 / scale))
            px, py, _ = camera.project([x, y, 0])
            objects.append({"kind": "hole", "x": px, "y": py, "diameter_px": diameter})
    plate = block("difference", [box([-9.8, -9.8, -0.005], [9.8, 9.8, 0.005])] + holes)
    (folder / "plate.csg").write_text(plate)
    (folder / "plate_wall.csg").write_text(box([-60, -60, -7], [60, 60, -6]) + "\n")
    (folder / "plate.toml").write_text(
        camera.toml() + point([-20, 30, 40], [0, 0, 0]) + material("plate", [0.15, 0.11, 0.08]) +
        material("wall", [0, 0, 0], [0.9, 0.92, 0.95]) + item("plate", "plate.csg") +
        item("wall", "plate_wall.csg"))
    return objects


def make_fence(folder):
    rnd = random.Random(12)
    camera = Camera([0.4, 6.0, 24], [0, 2.2, 0], 60)
    radius = 0.15 / camera.pixels_per_unit(24)
    light = unit([0.1, 0.75, -0.61])  # from behind: the shadows fall towards the camera
    pickets, objects = [], []
    for k in range(120):
        x = (k - 59.5) * 0.2 + rnd.uniform(-0.03, 0.03)
        top = x + rnd.uniform(-0.06, 0.06)
        pickets.append(cylinder([x, 0, 0], [top, 8, 0], radius))
        points = [camera.project([x + (top - x) * t, 8 * t, 0])[:2] for t in [0.3, 0.5, 0.7, 0.95]]
        objects.append({"kind": "picket", "points": points})
        shadow = []
        for t in [0.3, 0.5, 0.7]:
            p = [x + (top - x) * t, 8 * t, 0]
            q = [a - b * (p[1] / light[1]) for a, b in zip(p, light)]
            shadow.append(camera.project(q)[:2])
        objects.append({"kind": "shadow", "points": shadow})
    (folder / "fence.csg").write_text(block("union", pickets))
    rails = [box([-12.2, 0.97, -0.02], [12.2, 1.03, 0.02]), box([-12.2, 6.47, -0.02], [12.2, 6.53, 0.02])]
    (folder / "fence_rails.csg").write_text(block("union", rails))
    (folder / "fence_lawn.csg").write_text(box([-400, -1, -400], [400, 0, 400]) + "\n")
    (folder / "fence.toml").write_text(
        camera.toml() + directional(light, 0.8 * math.pi) +
        directional(unit([-0.3, 0.5, 0.8]), 0.3 * math.pi) + material("pickets", [0.95, 0.9, 0.8]) +
        material("rails", [0.36, 0.24, 0.12]) + material("lawn", [0.385, 0.42, 0.315]) +
        item("pickets", "fence.csg") + item("rails", "fence_rails.csg") + item("lawn", "fence_lawn.csg"))
    return objects


def make_spheres(folder):
    rnd = random.Random(13)
    camera = Camera([0, 8, 14], [0, 0, -2], 50)
    balls, objects = [], []
    while len(objects) < 500:
        x, y = rnd.uniform(6, WIDTH - 6), rnd.uniform(60, HEIGHT - 6)
        if any((x - o["x"]) ** 2 + (y - o["y"]) ** 2 < 64 for o in objects):
            continue
        d = camera.ray(x, y)
        t = -camera.position[1] / d[1]
        if t < 0:
            continue
        p = [c + t * e for c, e in zip(camera.position, d)]
        radius = 0.2 / camera.pixels_per_unit(dot(sub(p, camera.position), camera.forward))
        p[1] = radius
        balls.append(sphere(p, radius))
        px, py, _ = camera.project(p)
        objects.append({"kind": "ball", "x": px, "y": py})
    (folder / "spheres.csg").write_text(block("union", balls))
    bowl = block("difference", [sphere([-5, 1.2, -9], 1.6), box([-7, 1.4, -12], [-3, 4, -6])])
    (folder / "spheres_bowl.csg").write_text(bowl)
    (folder / "spheres_lawn.csg").write_text(box([-400, -1, -400], [400, 0, 400]) + "\n")
    (folder / "spheres.toml").write_text(
        camera.toml() + point([-15, 20, 10], [0, 0, 0]) + material("balls", [1, 0.95, 0.85]) +
        material("bowl", [0.35, 0.14, 0.07]) + material("lawn", [0.1, 0.15, 0.1]) +
        item("balls", "spheres.csg") + item("bowl", "spheres_bowl.csg") + item("lawn", "spheres_lawn.csg"))
    return objects


def make_mirrors(folder):
    camera = Camera([0.8, 4.2, 13], [0, 1.5, 0], 44)
    dish = block("difference", [box([-4.6, 0, -0.2], [-1.9, 2.7, 1]), sphere([-3.25, 1.35, 1.9], 1.6)])
    (folder / "mirrors_metal.csg").write_text(sphere([0.3, 1.5, -0.6], 1.5) + "\n" + dish)
    (folder / "mirrors_glass.csg").write_text(sphere([3.4, 1.2, 1.2], 1.2) + "\n")
    wires = []
    for k in range(60):
        angle = 2 * math.pi * k / 60
        if abs(angle - math.pi / 2) < 0.55:
            continue  # where the camera looks in
        x, z = 9 * math.cos(angle), 9 * math.sin(angle)
        wires.append(cylinder([x, 0, z], [x, 2.5 + math.sin(5 * angle), z], 0.025))
    (folder / "mirrors_wires.csg").write_text(block("union", wires))
    tiles = [box([x, -0.1, z], [x + 2, 0, z + 2]) for x in range(-12, 12, 2) for z in range(-12, 12, 2)
             if (x + z) % 4 == 0]
    (folder / "mirrors_tiles.csg").write_text(block("union", tiles))
    (folder / "mirrors_lawn.csg").write_text(box([-400, -1, -400], [400, -0.1, 400]) + "\n")
    shiny = ("\n[material.metal]\nbase_color = [0.92, 0.92, 0.94]\nmetallic = 1\nroughness = 0\n"
             "\n[material.glass]\nbase_color = [0.97, 1, 0.98]\ntransmission = 1\nroughness = 0\nior = 1.5\n")
    scene = camera.toml().replace("max_depth = 1", "max_depth = 6").replace("[0, 0, 0]", "[0.25, 0.32, 0.42]")
    (folder / "mirrors.toml").write_text(
        scene + directional(unit([-0.4, 0.8, 0.45]), 0.8 * math.pi) + shiny +
        material("wires", [0.8, 0.45, 0.12]) + material("tiles", [0.12, 0.16, 0.26]) +
        material("lawn", [0.7, 0.7, 0.68]) + item("metal", "mirrors_metal.csg") +
        item("glass", "mirrors_glass.csg") + item("wires", "mirrors_wires.csg") +
        item("tiles", "mirrors_tiles.csg") + item("lawn", "mirrors_lawn.csg"))


def main():
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parent)
    scenes = {"plate": make_plate(folder), "fence": make_fence(folder), "spheres": make_spheres(folder)}
    make_mirrors(folder)
    (folder / "objects.json").write_text(json.dumps(scenes) + "\n")


if __name__ == "__main__":
    main()
