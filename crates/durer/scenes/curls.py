"""Writes curls.pbrt: three curls of hair, each strand a cubic B-spline around a helix."""
from math import cos, pi, sin
from pathlib import Path
from random import Random

STRANDS, TURNS, POINTS = 120, 3.6, 24
TOP, BOTTOM = 2.45, 0.12
CURLS = (
    ("blond", -0.78, 0.4, 1, '"float eumelanin" 0.12 "float pheomelanin" 0.1'),
    ("red", 0.02, 2.6, -1, '"float eumelanin" 0.08 "float pheomelanin" 0.75'),
    ("brown", 0.8, 4.4, 1, '"float eumelanin" 1.1'),
)

HEAD = """\
# Three curls of hair. A lamp behind them shines through the hairs: light is bent into each, loses what its pigment keeps and leaves on
# the far side. A window in front is mirrored twice: white by the scales, and beside it, in the hair's own colour, by its
# far side from within. Written by curls.py beside this file.
Film "rgb" "integer xresolution" 800 "integer yresolution" 600
Sampler "zsobol" "integer pixelsamples" 64
Integrator "path" "integer maxdepth" 24

LookAt 0 1.12 -8  0 1.04 0  0 1 0
Camera "perspective" "float fov" 15

WorldBegin

LightSource "gradientsky" "string name" "dusk"
    "rgb zenith" [0.1 0.12 0.16] "rgb horizon" [0.16 0.15 0.14] "rgb ground" [0.03 0.03 0.03]
AttributeBegin
    AreaLightSource "diffuse" "rgb L" [44 36 27]
    Material "diffuse" "rgb reflectance" [0 0 0]
    Shape "polygon" "string name" "lamp" "point3 P" [-2.2 4.6 2.2  -0.4 4.6 2.6  -0.4 3.2 3.2  -2.2 3.2 2.8]
AttributeEnd
AttributeBegin
    AreaLightSource "diffuse" "rgb L" [15 15.6 16.5]
    Material "diffuse" "rgb reflectance" [0 0 0]
    Shape "polygon" "string name" "window" "point3 P" [4.4 0.4 -2.4  4.4 3 -2.8  2.8 3 -4.4  2.8 0.4 -4]
AttributeEnd

Material "diffuse" "rgb reflectance" [0.1 0.15 0.17]
Shape "bilinearmesh" "string name" "wall" "point3 P" [-9 -4 4  -9 9 4  9 -4 4  9 9 4]
"""


def strand(random, phase, side):
    """Control points of a strand about the y axis: straight above, wound up below."""
    across, along = random.gauss(0, 0.4), random.uniform(-1, 1)
    ahead, frizz = random.gauss(0, 0.09), random.uniform(0.0, 0.02)
    shift, end = random.uniform(0, 2 * pi), random.uniform(0.93, 1.0)
    points = []
    for i in range(POINTS):
        s = end * i / (POINTS - 1)
        wound = min(1.0, max(0.0, (s - 0.02) / 0.3)) ** 1.2
        gathered = 1 - 0.55 * s**4
        radius = 0.05 + 0.24 * wound * (1 - 0.25 * s) + 0.045 * across * gathered
        angle = phase + side * 2 * pi * TURNS * s + ahead * wound
        height = TOP + (BOTTOM - TOP) * s + 0.13 * along * gathered * (0.4 + 0.6 * wound)
        wave = [frizz * wound * sin(shift + 9 * s + k) for k in range(3)]
        points.append((radius * cos(angle) + wave[0], height + wave[1], radius * sin(angle) + wave[2]))
    return points


def main():
    random = Random(5)
    out = []
    for name, x, phase, side, pigment in CURLS:
        out += ["", "AttributeBegin", f'    Material "hair" {pigment} "float beta_m" 0.2 "float beta_n" 0.3']
        out += [f'    Attribute "shape" "string name" "{name}" "string basis" "bspline" "float width0" 0.011 "float width1" 0.004']
        out += [f"    Translate {x} 0 0"]
        for _ in range(STRANDS):
            points = "  ".join(" ".join(f"{c:.2f}" for c in p) for p in strand(random, phase, side))
            out.append(f'    Shape "curve" "point3 P" [{points}]')
        out.append("AttributeEnd")
    Path(__file__).with_suffix(".pbrt").write_text(HEAD + "\n".join(out) + "\n", encoding="utf-8")


main()
