"""Mitsuba 3 renders a scene of `cargo xtask bench render`: one picture and one line of JSON.

A picture of one sample per pixel goes before the one that is timed, so that nothing is compiled while the clock runs.
usage: mitsuba_peer.py SCENE.pbrt OUT.exr --variant V --sampler S --width W --height H --spp N --seed K --threads T
"""
import argparse
import json
import os
import resource
import tempfile

import drjit
import mitsuba as mi
import numpy as np

import pbrt_scene


def arguments():
    parser = argparse.ArgumentParser()
    parser.add_argument("scene")
    parser.add_argument("out")
    for name in ("variant", "sampler"):
        parser.add_argument("--" + name, required=True)
    for name in ("width", "height", "spp", "seed", "threads"):
        parser.add_argument("--" + name, required=True, type=int)
    return parser.parse_args()


def rgb(values):
    return {"type": "rgb", "value": list(values)}


def material(scene, params):
    kind = params["type"][0]
    if kind == "diffuse":
        return twosided({"type": "diffuse", "reflectance": reflectance(scene, params)})
    if kind == "conductor":
        named = params["eta"][0] if isinstance(params["eta"][0], str) else None
        metal = {"material": named.split("-")[1]} if named else {"eta": rgb(params["eta"]), "k": rgb(params["k"])}
        return twosided({**rough("conductor", params), **metal})
    if kind == "dielectric":
        return {**rough("dielectric", params), "int_ior": params["eta"][0], "ext_ior": 1.0}
    if kind == "coateddiffuse":
        coat = rough("plastic", params)
        return twosided({**coat, "diffuse_reflectance": reflectance(scene, params), "nonlinear": True, "int_ior": 1.5, "ext_ior": 1.0})
    raise ValueError("unknown material " + kind)


def rough(kind, params):
    """Mitsuba's smooth kind or, from a roughness on that can be seen, its rough one. Ours are Trowbridge and Reitz's."""
    alpha = params.get("uroughness", params.get("roughness", [0.0]))[0]
    return {"type": "rough" + kind, "distribution": "ggx", "alpha": alpha} if alpha > 0.01 else {"type": kind}


def twosided(bsdf):
    return {"type": "twosided", "bsdf": bsdf}


def reflectance(scene, params):
    """In pbrt's scenes texture coordinates count upwards, in Mitsuba's downwards."""
    value = params["reflectance"]
    if isinstance(value[0], str):
        flip = mi.ScalarTransform4f().translate([0, 1, 0]).scale([1, -1, 1])
        return {"type": "bitmap", "filename": scene.textures[value[0]], "to_uv": flip}
    return rgb(value)


def write_ply(path, mesh):
    columns = [mesh.points] + [c for c in (mesh.normals, mesh.uv) if c is not None]
    names = list("xyz") + ["nx", "ny", "nz"] * (mesh.normals is not None) + ["u", "v"] * (mesh.uv is not None)
    faces = np.empty(len(mesh.triangles), np.dtype([("n", "u1"), ("v", "<i4", (3,))]))
    faces["n"], faces["v"] = 3, mesh.triangles
    with open(path, "wb") as file:
        lines = ["ply", "format binary_little_endian 1.0", "element vertex %d" % len(mesh.points)]
        lines += ["property float " + name for name in names]
        lines += ["element face %d" % len(faces), "property list uchar int vertex_indices", "end_header", ""]
        file.write("\n".join(lines).encode())
        file.write(np.concatenate(columns, 1).astype("<f4").tobytes())
        file.write(faces.tobytes())


def light(scene, kind, params, matrix):
    if kind == "distant":
        towards = np.array(params["to"]) - np.array(params["from"])
        return {"type": "directional", "direction": (matrix[:3, :3] @ towards).tolist(), "irradiance": rgb(params["L"])}
    if "filename" in params:
        picture = pbrt_scene.sky(scene.path(params["filename"][0]), matrix)
        return {"type": "envmap", "bitmap": mi.Bitmap(picture), "to_world": mi.ScalarTransform4f()}
    return {"type": "constant", "radiance": rgb(params["L"])}


def description(scene, options, folder):
    to_world = np.linalg.inv(scene.camera_from_world) @ np.diag([-1, 1, 1, 1])
    film = {"type": "hdrfilm", "width": options.width, "height": options.height, "rfilter": {"type": "box"}}
    film.update(pixel_format="rgb", component_format="float32")
    found = {
        "type": "scene",
        # Mitsuba counts the edges of a path, pbrt its scattering events.
        "integrator": {"type": "path", "max_depth": scene.depth + 1},
        "sensor": {
            "type": "perspective", "fov": scene.fov, "fov_axis": "smaller", "near_clip": 1e-3, "far_clip": 1e5,
            "to_world": mi.ScalarTransform4f(to_world), "film": film,
            "sampler": {"type": options.sampler, "sample_count": options.spp},
        },
    }
    names = {name: "m%d" % number for number, name in enumerate(scene.materials)}
    for name, params in scene.materials.items():
        found[names[name]] = material(scene, params)
    for number, (mesh, matrix, name, emission) in enumerate(scene.shapes):
        path = os.path.join(folder, "%d.ply" % number)
        write_ply(path, mesh.placed(matrix))
        shape = {"type": "ply", "filename": path, "face_normals": mesh.normals is None, "bsdf": {"type": "ref", "id": names[name]}}
        if emission is not None:
            shape["emitter"] = {"type": "area", "radiance": rgb(emission)}
        found["s%d" % number] = shape
    for number, (kind, params, matrix) in enumerate(scene.lights):
        found["l%d" % number] = light(scene, kind, params, matrix)
    return found


def render(scene, spp, seed):
    picture = mi.render(scene, spp=spp, seed=seed)
    drjit.eval(picture)
    drjit.sync_thread()
    return np.array(picture)


def cpu():
    usage = resource.getrusage(resource.RUSAGE_SELF)
    return usage.ru_utime + usage.ru_stime


def main():
    options = arguments()
    mi.set_variant(options.variant)
    drjit.set_thread_count(options.threads)
    with tempfile.TemporaryDirectory() as folder:
        scene = mi.load_dict(description(pbrt_scene.Scene(options.scene), options, folder))
    render(scene, 1, options.seed + 1000)
    before = cpu()
    picture = render(scene, options.spp, options.seed)
    seconds = cpu() - before
    mi.Bitmap(picture).write(options.out)
    print(json.dumps({"version": mi.__version__, "render_cpu": seconds}))


main()
