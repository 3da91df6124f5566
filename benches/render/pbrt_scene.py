"""Reads what the scenes of `cargo xtask bench render` use of pbrt-v4's format, so that every renderer is given the same file.

Kinds that are not known here are errors: a scene that is read in half would be compared as if it were whole.
"""
import gzip
import os
import re

import numpy as np

KINDS = "bool float integer normal point2 point3 rgb spectrum string texture vector3".split()
TOKEN = re.compile(r'#[^\n]*|"[^"]*"|[\[\]]|[^\s\[\]"#]+')


class Scene:
    """camera_from_world (4 x 4, pbrt's left-handed camera), fov (degrees, shorter edge), depth (scattering events), shapes, lights."""

    def __init__(self, path):
        self.folder = os.path.dirname(os.path.abspath(path))
        self.camera_from_world, self.fov, self.depth = np.eye(4), 90.0, 5
        self.textures, self.materials, self.shapes, self.lights = {}, {}, [], []
        self._read(_directives(path))

    def path(self, name):
        """Of a file that the scene names."""
        return os.path.join(self.folder, name)

    def _read(self, directives):
        here, stack = State(), []
        for word, args, params in directives:
            if word in ("AttributeBegin", "TransformBegin"):
                stack.append(here.copy())
            elif word in ("AttributeEnd", "TransformEnd"):
                here = stack.pop()
            elif word == "WorldBegin":
                here = State()
            elif word in MOVES:
                here.matrix = MOVES[word](here.matrix, [float(a) for a in args])
            else:
                self._take(word, args, params, here)

    def _take(self, word, args, params, here):
        if word == "Camera":
            self.camera_from_world, self.fov = here.matrix, params["fov"][0]
        elif word == "Integrator":
            self.depth = int(params["maxdepth"][0])
        elif word == "Texture":
            self.textures[args[0]] = self.path(params["filename"][0])
        elif word == "MakeNamedMaterial":
            self.materials[args[0]] = params
        elif word == "NamedMaterial":
            here.material = args[0]
        elif word == "Material":
            here.material = "material %d" % len(self.materials)
            self.materials[here.material] = dict(params, type=[args[0]])
        elif word == "AreaLightSource":
            here.emission = params["L"]
        elif word == "LightSource":
            self.lights.append((args[0], params, here.matrix))
        elif word == "Shape":
            shape = {"plymesh": lambda: read_ply(self.path(params["filename"][0])), "trianglemesh": lambda: given(params)}
            self.shapes.append((shape[args[0]](), here.matrix, here.material, here.emission))
        elif word not in ("Film", "Sampler", "PixelFilter"):
            raise ValueError("unknown directive " + word)


class State:
    """What a shape inherits."""

    def __init__(self):
        self.matrix, self.material, self.emission = np.eye(4), None, None

    def copy(self):
        other = State()
        other.__dict__.update(self.__dict__)
        return other


def _look_at(matrix, n):
    eye, at, up = np.array(n[:3]), np.array(n[3:6]), np.array(n[6:])
    forward = (at - eye) / np.linalg.norm(at - eye)
    right = np.cross(up / np.linalg.norm(up), forward)
    right /= np.linalg.norm(right)
    world_from_camera = np.eye(4)
    world_from_camera[:3, :4] = np.stack([right, np.cross(forward, right), forward, eye], 1)
    return matrix @ np.linalg.inv(world_from_camera)


# `Transform` holds columns, and replaces what was there within the world too.
MOVES = {
    "Transform": lambda matrix, n: np.array(n).reshape(4, 4).T,
    "LookAt": _look_at,
    "Scale": lambda matrix, n: matrix @ np.diag(n + [1.0]),
}


def _directives(path):
    """(word, words and numbers after it, named parameters)."""
    tokens = [t for t in TOKEN.findall(open(path).read()) if not t.startswith("#")]
    found, at = [], 0
    while at < len(tokens):
        word, args, params, at = tokens[at], [], {}, at + 1
        while at < len(tokens) and not tokens[at][0].isupper():
            token = tokens[at]
            if _is_parameter(token):
                values, at = _values(tokens, at + 1)
                kind, name = token.strip('"').split()
                text = kind in ("string", "texture", "bool") or not _is_number(values[0])
                params[name] = values if text else [float(v) for v in values]
            else:
                args += [token.strip('"')] if token not in "[]" else []
                at += 1
        found.append((word, args, params))
    return found


def _is_parameter(token):
    """Names of parameters are two words in one pair of quotation marks, of which the first is the type."""
    words = token.strip('"').split()
    return token.startswith('"') and len(words) == 2 and words[0] in KINDS


def _values(tokens, at):
    if tokens[at] != "[":
        return [tokens[at].strip('"')], at + 1
    end = tokens.index("]", at)
    return [t.strip('"') for t in tokens[at + 1:end]], end + 1


def _is_number(text):
    try:
        float(text)
        return True
    except ValueError:
        return False


class Mesh:
    """Points, triangles, and normals and texture coordinates or None."""

    def __init__(self, points, triangles, normals=None, uv=None):
        self.points, self.triangles, self.normals, self.uv = points, triangles, normals, uv

    def placed(self, matrix):
        """In the world. Normals stay outside where a mirroring turns triangles."""
        linear = matrix[:3, :3]
        points = (self.points @ linear.T + matrix[:3, 3]).astype(np.float32)
        triangles = self.triangles if np.linalg.det(linear) > 0 else np.ascontiguousarray(self.triangles[:, ::-1])
        normals = self.normals
        if normals is not None:
            normals = normals @ np.linalg.inv(linear)
            normals = (normals / np.linalg.norm(normals, axis=1, keepdims=True).clip(1e-30)).astype(np.float32)
        return Mesh(points, triangles, normals, self.uv)


def given(params):
    rows = lambda name, n: np.array(params[name], np.float32).reshape(-1, n) if name in params else None
    mesh = Mesh(rows("P", 3), rows("indices", 3).astype(np.int32), rows("N", 3), rows("uv", 2))
    if mesh.normals is not None:
        # pbrt turns faces to where their normals point.
        a, b, c = (mesh.points[mesh.triangles[:, k]] for k in range(3))
        away = (np.cross(b - a, c - a) * mesh.normals[mesh.triangles[:, 0]]).sum(1) < 0
        mesh.triangles[away] = mesh.triangles[away][:, ::-1]
    return mesh


def read_ply(path):
    """Binary files of little end whose faces are all triangles or all quadrangles."""
    with (gzip.open if path.endswith(".gz") else open)(path, "rb") as file:
        data = file.read()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    head = data[:end].decode().split("\n")
    if "format binary_little_endian 1.0" not in head:
        raise ValueError(path + " is no binary PLY file")
    types = {"float": "<f4", "float32": "<f4", "int": "<i4", "int32": "<i4", "uint": "<u4", "uint32": "<u4", "uchar": "u1", "uint8": "u1"}
    counts, fields, element = {}, [], None
    for line in (line.split() for line in head):
        if line[:1] == ["element"]:
            element = line[1]
            counts[element] = int(line[2])
        elif line[:1] == ["property"] and element == "vertex":
            fields.append((line[2], types[line[1]]))
        elif line[:2] == ["property", "list"]:
            size, index = types[line[2]], types[line[3]]
    vertices = np.frombuffer(data, np.dtype(fields), counts["vertex"], end)
    at = end + vertices.nbytes
    corners = int(np.frombuffer(data, size, 1, at)[0])
    faces = np.frombuffer(data, np.dtype([("n", size), ("v", index, (corners,))]), counts["face"], at)
    if (faces["n"] != corners).any():
        raise ValueError(path + " mixes polygons")
    fans = [faces["v"][:, [0, k, k + 1]] for k in range(1, corners - 1)]
    triangles = np.stack(fans, 1).reshape(-1, 3).astype(np.int32)
    named = lambda names: np.stack([vertices[n] for n in names], 1).astype(np.float32) if names[0] in vertices.dtype.names else None
    return Mesh(named("xyz"), triangles, named(("nx", "ny", "nz")), named(("u", "v")) if "u" in vertices.dtype.names else named("st"))


def sky(path, matrix, height=512):
    """An environment in pbrt's equal-area octahedral form (Clarberg 2008) as an equirectangular one whose rows run from
    +y to -y and whose columns from -z over +x (`Mitsuba`'s `envmap` without a transform)."""
    image = read_pfm(path)
    n = image.shape[0]
    theta = (np.arange(height) + 0.5) / height * np.pi
    phi = (np.arange(2 * height) + 0.5) / height * np.pi
    theta, phi = np.meshgrid(theta, phi, indexing="ij")
    world = np.stack([np.sin(phi) * np.sin(theta), np.cos(theta), -np.cos(phi) * np.sin(theta)], -1)
    d = world @ np.linalg.inv(matrix[:3, :3]).T
    x, y, z = np.abs(d[..., 0]), np.abs(d[..., 1]), np.abs(d[..., 2])
    r = np.sqrt((1 - z).clip(0))
    share = np.arctan2(y, x) * 2 / np.pi
    u, v = r - share * r, share * r
    u, v = np.where(d[..., 2] < 0, 1 - v, u), np.where(d[..., 2] < 0, 1 - u, v)
    u, v = np.copysign(u, d[..., 0]), np.copysign(v, d[..., 1])
    column = ((u + 1) / 2 * n).astype(int).clip(0, n - 1)
    row = ((v + 1) / 2 * n).astype(int).clip(0, n - 1)
    return image[row, column]


def read_pfm(path):
    with open(path, "rb") as file:
        if file.readline().strip() != b"PF":
            raise ValueError(path + " is no PFM file in colour")
        width, height = map(int, file.readline().split())
        order = "<f4" if float(file.readline()) < 0 else ">f4"
        # Rows run upwards.
        return np.frombuffer(file.read(), order).reshape(height, width, 3)[::-1].astype(np.float32)
