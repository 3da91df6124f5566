"""Writes jade.pbrt: a trefoil of jade before a lamp, as a control cage that loopsubdiv rounds."""
from math import cos, pi, sin
from pathlib import Path

ALONG, AROUND = 60, 6
LIFT = 1.16


def centre(t):
    """The trefoil, upright: it looks along z."""
    r = 0.62 + 0.3 * cos(3 * t)
    return (r * cos(2 * t), r * sin(2 * t) + LIFT, 0.36 * sin(3 * t))


def unit(v):
    length = sum(c * c for c in v) ** 0.5
    return tuple(c / length for c in v)


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def cage():
    points, triangles = [], []
    for i in range(ALONG):
        t = 2 * pi * i / ALONG
        here, ahead, behind = centre(t), centre(t + 1e-4), centre(t - 1e-4)
        along = unit(tuple(a - b for a, b in zip(ahead, behind)))
        outward = (cos(2 * t), sin(2 * t), 0.0)
        side = unit(cross(along, outward))
        up = cross(side, along)
        radius = 0.2
        for j in range(AROUND):
            a = 2 * pi * j / AROUND
            offset = tuple(radius * (cos(a) * u + sin(a) * s) for u, s in zip(up, side))
            points.append(tuple(c + o for c, o in zip(here, offset)))
            a, b = i * AROUND + j, i * AROUND + (j + 1) % AROUND
            c, d = (a + AROUND) % (ALONG * AROUND), (b + AROUND) % (ALONG * AROUND)
            triangles += [(a, b, c), (b, d, c)]
    return points, triangles


def rows(items, each, form):
    texts = [" ".join(form(c) for c in item) for item in items]
    lines = ["  ".join(texts[i : i + each]) for i in range(0, len(texts), each)]
    return "\n            ".join(lines)


points, triangles = cage()
text = f"""# A trefoil of jade with a lamp behind it: light gets in at the back, walks at random among the crystals, which keep red and
# blue, and leaves in front where the stone is thin. The ball is of marble, the egg of wax. Written by jade.py beside this
# file.
Film "rgb" "integer xresolution" 800 "integer yresolution" 720
Sampler "zsobol" "integer pixelsamples" 64
Integrator "path" "integer maxdepth" 6

LookAt 0.3 1.75 -5.4  0 1.04 0  0 1 0
Camera "perspective" "float fov" 28

WorldBegin

LightSource "gradientsky" "string name" "evening"
    "rgb zenith" [0.03 0.04 0.06] "rgb horizon" [0.02 0.022 0.03] "rgb ground" [0.01 0.01 0.01]
AttributeBegin
    AreaLightSource "diffuse" "rgb L" [46 33 20]
    Material "diffuse" "rgb reflectance" [0 0 0]
    Translate 0 1.16 0.62
    Shape "sphere" "string name" "lamp" "float radius" 0.2
AttributeEnd
AttributeBegin
    AreaLightSource "diffuse" "rgb L" [3.2 3.6 4.2]
    Material "diffuse" "rgb reflectance" [0 0 0]
    Shape "polygon" "string name" "window" "point3 P" [-3 1 -4.6  -3 3.4 -4.6  -4 3.4 -3  -4 1 -3]
AttributeEnd

Material "coateddiffuse" "rgb reflectance" [0.05 0.03 0.02] "float roughness" 0.02
Shape "bilinearmesh" "string name" "table" "point3 P" [-6 0 -6  -6 0 5  6 0 -6  6 0 5]

MakeNamedMaterial "jade" "string type" "subsurface" "rgb reflectance" [0.3 0.72 0.4]
    "rgb mfp" [0.08 0.08 0.08] "float eta" 1.61 "float roughness" 0.004
MakeNamedMaterial "marble" "string type" "subsurface" "rgb reflectance" [0.86 0.83 0.8]
    "rgb mfp" [0.04 0.04 0.04] "float eta" 1.5 "float roughness" 0.001
MakeNamedMaterial "wax" "string type" "principled" "float subsurface" 1 "rgb basecolor" [0.95 0.56 0.24]
    "rgb subsurfaceradius" [0.02 0.02 0.02] "float eta" 1.45 "float roughness" 0.42

NamedMaterial "jade"
Shape "loopsubdiv" "string name" "trefoil" "integer levels" 2
    "integer indices" [
            {rows(triangles, 12, str)}]
    "point3 P" [
            {rows(points, 5, lambda c: f"{c:.4f}".rstrip("0").rstrip("."))}]
AttributeBegin
    NamedMaterial "marble"
    Translate -0.98 0.3 -0.75
    Shape "sphere" "string name" "ball" "float radius" 0.3
AttributeEnd
AttributeBegin
    NamedMaterial "wax"
    Translate 1.0 0.33 -0.7
    Rotate 24 0 0 1
    Scale 0.85 1.15 0.85
    Shape "sphere" "string name" "egg" "float radius" 0.3
AttributeEnd
"""
Path(__file__).with_name("jade.pbrt").write_text(text)
