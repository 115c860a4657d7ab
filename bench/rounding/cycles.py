#!/usr/bin/env python3
"""Renders the benchmark scenes with Cycles: none, bevel node, bevel modifier.

    build/release/bench_rounding --scenes scene1,blocks --export FOLDER
    python3 bench/rounding/cycles.py FOLDER [--scenes scene1,blocks]
        [--variants none,shader4,shader8,mod1,mod3,mod5,mod10] [--rounds 3] [--pictures FOLDER] [--json FILE]

Needs `blender` on the path; says so and ends without an error where there is none. Rounds are interleaved and run
forwards and backwards in turn; ratios pair renders of one round. Every render is a new Blender process; the time is
Cycles' own path tracing time.
"""
import argparse
import json
import os
import re
import shutil
import statistics
import subprocess
import sys

VARIANTS = "none,shader4,shader8,mod1,mod3,mod5,mod10"


def host(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", help="where bench_rounding --export wrote the scenes")
    parser.add_argument("--scenes", default="scene1,scene2,scene3,blocks")
    parser.add_argument("--variants", default=VARIANTS)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--spp", type=int, default=16)
    parser.add_argument("--threads", type=int, default=os.cpu_count())
    parser.add_argument("--pictures")
    parser.add_argument("--json")
    a = parser.parse_args(arguments)
    blender = shutil.which("blender")
    if blender is None:
        print("skipped: blender is not on the path (Debian: apt-get install blender)")
        return 0
    if a.pictures:
        os.makedirs(a.pictures, exist_ok=True)
    variants = a.variants.split(",")
    results = []
    for scene in a.scenes.split(","):
        if not os.path.exists(os.path.join(a.folder, scene + ".json")):
            print(f"{a.folder}/{scene}.json is missing: run bench_rounding --scenes {scene} --export {a.folder}")
            return 1
        measured = {variant: [] for variant in variants}
        for number in range(a.rounds):
            for variant in variants if number % 2 == 0 else reversed(variants):
                picture = "-"
                if a.pictures and number == 0:
                    picture = os.path.join(a.pictures, f"{scene}-cycles-{variant}.png")
                measured[variant].append(run_blender(blender, a, scene, variant, picture))
        results.append(summarise(scene, measured, variants))
    if a.json:
        with open(a.json, "w") as file:
            json.dump(results, file, indent=1)
    return 0


def run_blender(blender, a, scene, variant, picture):
    command = [blender, "-b", "--factory-startup", "--debug-cycles", "--verbose", "2", "-P", os.path.abspath(__file__),
               "--", "--inside", a.folder, scene, variant, str(a.spp), str(a.threads), picture]
    done = subprocess.run(command, capture_output=True, text=True)
    text = done.stdout + done.stderr
    own = re.search(r"^RESULT (.*)$", text, re.M)
    if own is None:
        sys.exit(f"{scene} {variant}: Blender made no picture\n{text[-3000:]}")
    result = json.loads(own.group(1))
    tracing = re.search(r"Path Tracing\s+([\d.]+)", text)
    if tracing:
        result["seconds"] = float(tracing.group(1))
    peaks = re.findall(r"\| Mem:[\d.]+M, Peak:([\d.]+)M", text)
    result["cycles_peak_mb"] = max(map(float, peaks)) if peaks else None
    return result


def summarise(scene, measured, variants):
    print(f"{scene}\n  {'':<10}{'triangles':>10}{'time s':>9}{'ratio':>8}{'Cycles MB':>11}{'bevel s':>9}")
    rows = []
    for variant in variants:
        runs = measured[variant]
        ratios = [run["seconds"] / base["seconds"] for run, base in zip(runs, measured[variants[0]])]
        row = dict(variant=variant, triangles=runs[0]["triangles"], ratio=statistics.median(ratios),
                   seconds=statistics.median(run["seconds"] for run in runs), bevel_seconds=runs[0]["bevel_seconds"],
                   cycles_peak_mb=runs[0]["cycles_peak_mb"])
        rows.append(row)
        print(f"  {variant:<10}{row['triangles']:>10}{row['seconds']:>9.2f}{row['ratio']:>8.3f}"
              f"{row['cycles_peak_mb'] or 0:>11.0f}{row['bevel_seconds']:>9.2f}", flush=True)
    return dict(scene=scene, rows=rows)


# --- inside Blender ----------------------------------------------------------------------------------------------


def inside(folder, name, variant, samples, threads, picture):
    import time
    import bpy

    with open(os.path.join(folder, name + ".json")) as file:
        described = json.load(file)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    node_samples = int(variant[6:]) if variant.startswith("shader") else 0
    segments = int(variant[3:]) if variant.startswith("mod") else 0
    objects = add_objects(bpy, scene, folder, described, node_samples)
    start = time.time()
    if segments:
        bevel(bpy, objects, segments)
    bevel_seconds = time.time() - start
    add_camera(bpy, scene, described["camera"])
    for light in described["lights"]:
        add_light(bpy, scene, light)
    add_sky(bpy, scene, described["sky_radiance"])
    set_cycles(scene, described["image"], samples, threads)
    triangles = sum(len(p.vertices) - 2 for o, _ in objects for p in o.data.polygons)
    start = time.time()
    bpy.ops.render.render(write_still=False)
    seconds = time.time() - start
    if picture != "-":
        bpy.data.images["Render Result"].save_render(picture)
    print("RESULT " + json.dumps(dict(seconds=seconds, triangles=triangles, bevel_seconds=bevel_seconds)), flush=True)


def add_objects(bpy, scene, folder, described, node_samples):
    import numpy
    import bmesh

    with open(os.path.join(folder, described["name"] + ".bin"), "rb") as file:
        positions = numpy.fromfile(file, "<f4", 3 * described["vertices"]).reshape(-1, 3)
        triangles = numpy.fromfile(file, "<u4", 3 * described["triangles"]).reshape(-1, 3)
    materials = {}  # (material, radius) → Blender material: the bevel node holds the radius
    objects = []
    for o in described["objects"]:
        mesh = bpy.data.meshes.new(o["name"])
        vertices = positions[o["first_vertex"]:o["first_vertex"] + o["vertices"]]
        faces = triangles[o["first_triangle"]:o["first_triangle"] + o["triangles"]]
        mesh.from_pydata(vertices.tolist(), [], faces.tolist())
        for index in sorted(set(o.get("triangle_materials", [o["material"]]))):
            key = (index, o["radius"])
            if key not in materials:
                materials[key] = make_material(bpy, described["materials"][index], o["radius"], node_samples)
            mesh.materials.append(materials[key])
        if "triangle_materials" in o:
            slots = sorted(set(o["triangle_materials"]))
            mesh.polygons.foreach_set("material_index", [slots.index(m) for m in o["triangle_materials"]])
        joined = bmesh.new()  # flat polygons again, as a modeller would hand them to the bevel
        joined.from_mesh(mesh)
        bmesh.ops.dissolve_limit(joined, angle_limit=0.001, verts=joined.verts, edges=joined.edges,
                                 delimit={"MATERIAL"})
        joined.to_mesh(mesh)
        joined.free()
        mesh.use_auto_smooth = True
        mesh.auto_smooth_angle = 0.5236
        mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
        made = bpy.data.objects.new(o["name"], mesh)
        scene.collection.objects.link(made)
        objects.append((made, o["radius"]))
    return objects


def make_material(bpy, m, radius, node_samples):
    made = bpy.data.materials.new(m["name"])
    made.use_nodes = True
    tree = made.node_tree
    tree.nodes.clear()
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    diffuse = tree.nodes.new("ShaderNodeBsdfDiffuse")
    diffuse.inputs["Color"].default_value = (*m["color"], 1)
    glossy = tree.nodes.new("ShaderNodeBsdfGlossy")
    glossy.inputs["Color"].default_value = (1, 1, 1, 1)
    glossy.inputs["Roughness"].default_value = m["roughness"]
    glossy.distribution = "GGX"
    mix = tree.nodes.new("ShaderNodeMixShader")
    mix.inputs[0].default_value = m["glossy_mix"]
    tree.links.new(diffuse.outputs[0], mix.inputs[1])
    tree.links.new(glossy.outputs[0], mix.inputs[2])
    tree.links.new(mix.outputs[0], output.inputs[0])
    if node_samples and radius:
        node = tree.nodes.new("ShaderNodeBevel")
        node.samples = node_samples
        node.inputs["Radius"].default_value = radius
        tree.links.new(node.outputs[0], diffuse.inputs["Normal"])
        tree.links.new(node.outputs[0], glossy.inputs["Normal"])
    return made


def bevel(bpy, objects, segments):
    import math

    for made, radius in objects:
        if not radius:
            continue
        m = made.modifiers.new("bevel", "BEVEL")
        m.width = radius
        m.segments = segments
        m.limit_method = "ANGLE"
        m.angle_limit = math.radians(30)
        m.harden_normals = True
        made.data.auto_smooth_angle = math.pi
    graph = bpy.context.evaluated_depsgraph_get()
    for made, radius in objects:
        if radius:
            mesh = bpy.data.meshes.new_from_object(made.evaluated_get(graph), preserve_all_data_layers=True,
                                                   depsgraph=graph)
            made.modifiers.clear()
            made.data = mesh


def look_along(made, position, forward):
    from mathutils import Vector

    made.location = Vector(position)
    made.rotation_euler = Vector(forward).to_track_quat("-Z", "Y").to_euler()


def add_camera(bpy, scene, c):
    import math
    from mathutils import Vector

    camera = bpy.data.cameras.new("camera")
    camera.sensor_fit = "VERTICAL"
    camera.angle_y = math.radians(c["vertical_fov_deg"])
    camera.clip_end = 1000
    made = bpy.data.objects.new("camera", camera)
    look_along(made, c["position"], Vector(c["target"]) - Vector(c["position"]))
    scene.collection.objects.link(made)
    scene.camera = made


def add_light(bpy, scene, l):
    from mathutils import Matrix, Vector

    u, v = Vector(l["edge_u"]), Vector(l["edge_v"])
    light = bpy.data.lights.new("area", "AREA")
    light.shape = "RECTANGLE"
    light.size, light.size_y = u.length, v.length
    strength = max(l["radiance"])
    light.color = [channel / strength for channel in l["radiance"]]
    light.energy = 4 * strength * u.length * v.length  # radiance = power / (4 area)
    made = bpy.data.objects.new("area", light)
    # Blender's lamp shines along its -Z.
    x, z = u.normalized(), -u.cross(v).normalized()
    turn = Matrix((x, z.cross(x), z)).transposed().to_4x4()
    made.matrix_world = Matrix.Translation(Vector(l["corner"]) + (u + v) / 2) @ turn
    made.visible_camera = l["visible_to_camera"]
    scene.collection.objects.link(made)


def add_sky(bpy, scene, radiance):
    world = bpy.data.worlds.new("sky")
    scene.world = world
    world.use_nodes = True
    background = world.node_tree.nodes["Background"]
    background.inputs[0].default_value = (*radiance, 1)
    background.inputs[1].default_value = 1


def set_cycles(scene, image, samples, threads):
    scene.render.engine = "CYCLES"
    c = scene.cycles
    c.device = "CPU"
    c.samples = samples
    c.use_adaptive_sampling = False
    c.use_denoising = False
    c.max_bounces = image["max_depth"]
    c.diffuse_bounces = c.glossy_bounces = image["max_depth"]
    c.sample_clamp_indirect = 0
    c.blur_glossy = 0
    c.seed = 1
    c.pixel_filter_type = "BOX"
    c.use_auto_tile = False
    scene.render.resolution_x = image["width"]
    scene.render.resolution_y = image["height"]
    scene.render.resolution_percentage = 100
    scene.render.threads_mode = "FIXED"
    scene.render.threads = threads
    scene.view_settings.view_transform = "Standard"


if __name__ == "__main__":
    after = sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else []
    if after[:1] == ["--inside"]:
        folder, name, variant, samples, threads, picture = after[1:]
        inside(folder, name, variant, int(samples), int(threads), picture)
    else:
        sys.exit(host(sys.argv[1:]))
