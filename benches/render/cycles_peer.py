"""Blender's Cycles renders a scene of `cargo xtask bench render`: one picture and one line of JSON.

Blender builds its scene within the call that renders. So a picture of one sample per pixel goes before the one that is
timed; its time is taken off, and what is left is scaled by the number of samples it stands for.
usage: cycles_peer.py SCENE.pbrt OUT.exr --width W --height H --spp N --seed K --threads T
"""
import argparse
import json
import math
import os
import resource

import bpy
import mathutils
import numpy as np

import pbrt_scene


def arguments():
    parser = argparse.ArgumentParser()
    parser.add_argument("scene")
    parser.add_argument("out")
    for name in ("width", "height", "spp", "seed", "threads"):
        parser.add_argument("--" + name, required=True, type=int)
    return parser.parse_args()


def settings(scene, options):
    """As the others render: no denoising, no adaptive sampling, no clamping, one light by its power."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    world = bpy.context.scene
    render, cycles = world.render, world.cycles
    render.engine, cycles.device = "CYCLES", "CPU"
    cycles.use_adaptive_sampling = cycles.use_denoising = cycles.use_auto_tile = False
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
    cycles.blur_glossy, cycles.caustics_reflective, cycles.caustics_refractive = 0, True, True
    # pbrt counts scattering events, of which the last but one and all before are bounces here.
    cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = cycles.transmission_bounces = scene.depth - 1
    cycles.pixel_filter_type, render.filter_size = "BOX", 1.0
    render.resolution_x, render.resolution_y, render.resolution_percentage = options.width, options.height, 100
    render.threads_mode, render.threads = "FIXED", options.threads
    world.view_settings.view_transform = "Raw"
    render.image_settings.file_format, render.image_settings.color_depth = "OPEN_EXR", "32"
    render.filepath = os.path.abspath(options.out)
    return world


class Nodes:
    """The nodes of a material or of the world."""

    def __init__(self, tree):
        self.tree = tree
        tree.nodes.clear()

    def add(self, kind, **inputs):
        node = self.tree.nodes.new("ShaderNode" + kind)
        for name, value in inputs.items():
            self.set(node.inputs[name.replace("_", " ")], value)
        return node

    def set(self, socket, value):
        if isinstance(value, bpy.types.NodeSocket):
            self.tree.links.new(value, socket)
        else:
            socket.default_value = value


def colour(values):
    return (*values, 1.0)


def reflectance(scene, nodes, params):
    value = params["reflectance"]
    if not isinstance(value[0], str):
        return colour(value)
    node = nodes.add("TexImage")
    node.image = bpy.data.images.load(scene.textures[value[0]], check_existing=True)
    return node.outputs["Color"]


def surface(scene, nodes, params):
    kind = params["type"][0]
    alpha = params.get("uroughness", params.get("roughness", [0.0]))[0]
    roughness = math.sqrt(alpha) if alpha > 0.01 else 0.0
    if kind == "diffuse":
        return nodes.add("BsdfDiffuse", Color=reflectance(scene, nodes, params))
    if kind == "conductor":
        eta, k = params["eta"], params["k"]
        # Silver at 611, 549 and 464 nm (Johnson and Christy 1972).
        eta, k = ([0.059, 0.060, 0.047], [4.16, 3.59, 2.80]) if isinstance(eta[0], str) else (eta, k)
        node = nodes.add("BsdfMetallic", Roughness=roughness)
        # The indices of refraction are inputs of this kind of reflectance only.
        node.fresnel_type, node.distribution = "PHYSICAL_CONDUCTOR", "GGX"
        nodes.set(node.inputs["IOR"], eta)
        nodes.set(node.inputs["Extinction"], k)
        return node
    if kind == "dielectric":
        return nodes.add("BsdfGlass", IOR=params["eta"][0], Roughness=roughness)
    if kind == "coateddiffuse":
        return nodes.add("BsdfPrincipled", Base_Color=reflectance(scene, nodes, params), Roughness=roughness, IOR=1.5)
    raise ValueError("unknown material " + kind)


def material(scene, name, params, emission):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    nodes = Nodes(made.node_tree)
    node = surface(scene, nodes, params)
    if emission is not None:
        made.cycles.emission_sampling = "FRONT"
        strength = max(emission)
        front = nodes.add("Math", Value=nodes.add("NewGeometry").outputs["Backfacing"])
        front.operation = "LESS_THAN"
        nodes.set(front.inputs[1], 0.5)
        power = nodes.add("Math", Value=front.outputs[0])
        power.operation = "MULTIPLY"
        nodes.set(power.inputs[1], strength)
        glow = nodes.add("Emission", Color=colour(e / strength for e in emission), Strength=power.outputs[0])
        both = nodes.add("AddShader")
        nodes.set(both.inputs[0], node.outputs[0])
        nodes.set(both.inputs[1], glow.outputs[0])
        node = both
    nodes.set(nodes.add("OutputMaterial").inputs["Surface"], node.outputs[0])
    return made


def add_mesh(world, number, mesh, look):
    made = bpy.data.meshes.new("s%d" % number)
    points, triangles = mesh.points, mesh.triangles
    made.vertices.add(len(points))
    made.vertices.foreach_set("co", points.ravel())
    made.loops.add(triangles.size)
    made.loops.foreach_set("vertex_index", triangles.ravel())
    made.polygons.add(len(triangles))
    made.polygons.foreach_set("loop_start", np.arange(0, triangles.size, 3, dtype=np.int32))
    if mesh.uv is not None:
        made.uv_layers.new().uv.foreach_set("vector", mesh.uv[triangles.ravel()].astype(np.float32).ravel())
    made.update(calc_edges=True)
    if mesh.normals is not None:
        made.normals_split_custom_set_from_vertices(mesh.normals)
    else:
        made.shade_flat()
    made.materials.append(look)
    world.collection.objects.link(bpy.data.objects.new(made.name, made))


def add_camera(world, scene, options):
    made = bpy.data.cameras.new("camera")
    made.sensor_fit = "VERTICAL" if options.width > options.height else "HORIZONTAL"
    made.angle = math.radians(scene.fov)
    made.clip_start, made.clip_end = 1e-3, 1e5
    placed = bpy.data.objects.new("camera", made)
    world_from_camera = np.linalg.inv(scene.camera_from_world) @ np.diag([1, 1, -1, 1])
    placed.matrix_world = mathutils.Matrix(world_from_camera.tolist())
    world.collection.objects.link(placed)
    world.camera = placed


def add_lights(world, scene):
    world.world = bpy.data.worlds.new("sky")
    world.world.use_nodes = True
    nodes = Nodes(world.world.node_tree)
    sky = colour((0, 0, 0))
    for kind, params, matrix in scene.lights:
        if kind == "distant":
            add_sun(world, params, matrix)
        elif "filename" in params:
            sky = environment(nodes, pbrt_scene.sky(scene.path(params["filename"][0]), matrix))
        else:
            sky = colour(params["L"])
    background = nodes.add("Background", Color=sky)
    nodes.set(nodes.add("OutputWorld").inputs["Surface"], background.outputs[0])


def add_sun(world, params, matrix):
    made = bpy.data.lights.new("sun", "SUN")
    made.angle, made.energy, made.color = 0.0, max(params["L"]), [v / max(params["L"]) for v in params["L"]]
    towards = mathutils.Vector(matrix[:3, :3] @ (np.array(params["to"]) - np.array(params["from"])))
    placed = bpy.data.objects.new("sun", made)
    placed.rotation_mode = "QUATERNION"
    placed.rotation_quaternion = towards.to_track_quat("-Z", "Y")
    world.collection.objects.link(placed)


def environment(nodes, picture):
    """The picture's +y is up, and its columns run from -z over +x; Cycles has +z up, and columns from -x over +y backwards."""
    height, width = picture.shape[:2]
    image = bpy.data.images.new("sky", width, height, float_buffer=True)
    image.colorspace_settings.name = "Linear Rec.709"
    image.pixels.foreach_set(np.concatenate([picture[::-1], np.ones((height, width, 1), np.float32)], -1).ravel())
    image.pack()
    direction = nodes.add("TexCoord").outputs["Generated"]
    parts = nodes.add("SeparateXYZ", Vector=direction)
    turned = nodes.add("CombineXYZ")
    for axis, (source, sign) in {"X": ("Z", 1), "Y": ("X", -1), "Z": ("Y", 1)}.items():
        scaled = nodes.add("Math", Value=parts.outputs[source])
        scaled.operation = "MULTIPLY"
        nodes.set(scaled.inputs[1], float(sign))
        nodes.set(turned.inputs[axis], scaled.outputs[0])
    node = nodes.add("TexEnvironment", Vector=turned.outputs[0])
    node.image = image
    return node.outputs["Color"]


def cpu():
    usage = resource.getrusage(resource.RUSAGE_SELF)
    return usage.ru_utime + usage.ru_stime


def render(world, spp, seed):
    """Processor seconds."""
    world.cycles.samples, world.cycles.seed = spp, seed
    before = cpu()
    bpy.ops.render.render(write_still=True)
    return cpu() - before


def main():
    options = arguments()
    scene = pbrt_scene.Scene(options.scene)
    world = settings(scene, options)
    add_camera(world, scene, options)
    add_lights(world, scene)
    looks = {}
    for number, (mesh, matrix, name, emission) in enumerate(scene.shapes):
        key = (name, None if emission is None else tuple(emission))
        if key not in looks:
            looks[key] = material(scene, name, scene.materials[name], emission)
        add_mesh(world, number, mesh.placed(matrix), looks[key])
    once = render(world, 1, options.seed + 1000)
    seconds = (render(world, options.spp, options.seed) - once) * options.spp / (options.spp - 1)
    print(json.dumps({"version": bpy.app.version_string, "render_cpu": seconds}))


main()
