"""Writes the geometry of the scene `durer`: python3 durer.py > durer.pbrt

After the woodcut "Der Zeichner der Laute" in Albrecht Duerer, "Underweysung der Messung", Nuremberg 1525. Metres; y is up, x
leads from the lute to the wall with the eyelet, z away from the viewer. The dots on the paper are where threads from the
eyelet to points of the lute pass the frame.
"""
from math import acos, cos, hypot, pi, radians, sin, sqrt

TAU = 2 * pi
out = print


def add(a, b): return tuple(x + y for x, y in zip(a, b))
def sub(a, b): return tuple(x - y for x, y in zip(a, b))
def mul(a, s): return tuple(x * s for x in a)
def dot(a, b): return sum(x * y for x, y in zip(a, b))
def cross(a, b): return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
def unit(a): return mul(a, 1 / sqrt(dot(a, a)))


def text(values, digits):
    return " ".join(f"{v:.{digits}f}".rstrip("0").rstrip(".").replace("-0", "0") if abs(v) < 0.5 * 10 ** -digits
                    else f"{v:.{digits}f}".rstrip("0").rstrip(".") for v in values)


def wrapped(key, values):
    words, line = [], f'        "{key}" ['
    for v in values:
        if len(line) + len(v) > 150:
            words.append(line.rstrip())
            line = "            "
        line += v + "  "
    out("\n".join(words + [line.rstrip() + "]"]))


def mesh(name, points, triangles, normals=None):
    out(f'    Shape "trianglemesh" "string name" "{name}"')
    wrapped("point3 P", [text(p, 5) for p in points])
    if normals:
        wrapped("normal N", [text(n, 3) for n in normals])
    wrapped("integer indices", [" ".join(map(str, t)) for t in triangles])


def grid(name, rows, normals=None, around=False):
    """Rows of points as a surface; `around` joins the ends of each row."""
    n, m = len(rows), len(rows[0])
    triangles = []
    for i in range(n - 1):
        for j in range(m if around else m - 1):
            a, b = i * m + j, i * m + (j + 1) % m
            triangles += [(a, b, b + m), (a, b + m, a + m)]
    flat = lambda table: [v for row in table for v in row]
    mesh(name, flat(rows), triangles, flat(normals) if normals else None)


def box(name, low, high, place=lambda p: p):
    corners = [(x, y, z) for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    mesh(name, [place(p) for p in corners], [t for a, b, c, d in faces for t in ((a, b, c), (a, c, d))])


def tube(name, points, radii, n=8, place=lambda p: p):
    """A round tube along points; its ends are closed by points of radius 0 if wanted."""
    rows, normals = [], []
    side = None
    for i, p in enumerate(points):
        way = unit(sub(points[min(i + 1, len(points) - 1)], points[max(i - 1, 0)]))
        side = unit(cross(way, side and cross(side, way) or ((0, 0, 1) if abs(way[2]) < 0.9 else (1, 0, 0))))
        other = cross(way, side)
        ring = [add(mul(side, cos(TAU * k / n)), mul(other, sin(TAU * k / n))) for k in range(n)]
        rows.append([place(add(p, mul(r, radii[i]))) for r in ring])
        normals.append([unit(sub(place(add(p, r)), place(p))) for r in ring])
    grid(name, rows, normals, around=True)


def lathe(name, profile, base, n=24):
    """A profile of (radius, height) turned about the upright axis through `base`; sharp where a point is repeated."""
    parts, part = [], [profile[0]]
    for q in profile[1:]:
        if q == part[-1]:
            parts.append(part)
            part = []
        part.append(q)
    for number, part in enumerate(parts + [part]):
        rows, normals = [], []
        for i, (r, h) in enumerate(part):
            (r0, h0), (r1, h1) = part[max(i - 1, 0)], part[min(i + 1, len(part) - 1)]
            slope = unit((h1 - h0, r0 - r1, 0))
            turn = [TAU * k / n for k in range(n)]
            rows.append([add(base, (r * cos(a), h, r * sin(a))) for a in turn])
            normals.append([(slope[0] * cos(a), slope[1], slope[0] * sin(a)) for a in turn])
        grid(name, rows, normals, around=True)


def ring(name, center, axis, radius, thick, n=24, m=8):
    u = unit(cross(axis, (0, 1, 0) if abs(axis[1]) < 0.9 else (1, 0, 0)))
    v = cross(axis, u)
    rows, normals = [], []
    for i in range(n + 1):
        a = TAU * i / n
        out_ = add(mul(u, cos(a)), mul(v, sin(a)))
        turn = [add(mul(out_, cos(TAU * k / m)), mul(axis, sin(TAU * k / m))) for k in range(m)]
        normals.append(turn)
        rows.append([add(add(center, mul(out_, radius)), mul(t, thick)) for t in turn])
    grid(name, rows, normals, around=True)


def material(diffuse, specular=0.0, exponent=40):
    d = text(diffuse, 3)
    shine = f' "rgb specular" [{text([specular] * 3, 3)}] "float exponent" {exponent}' if specular else ""
    out(f'    Material "classic" "rgb diffuse" [{d}] "rgb ambient" [{d}]{shine}')


# The lute, in a frame of its own: x from its end to its neck, y up out of the soundboard, z across.
LENGTH, NECK = 0.47, 0.77


def half_width(x):
    if x < 0.17:
        return 0.16 * sqrt(max(0.0, 1 - ((0.17 - x) / 0.17) ** 2))
    s = (x - 0.17) / (LENGTH - 0.17)
    # Hermite: level at the widest place, to the neck with a slope.
    a, b = 0.16, 0.03
    return a * (2 * s ** 3 - 3 * s * s + 1) + b * (3 * s * s - 2 * s ** 3) - 0.30 * (LENGTH - 0.17) * (s ** 3 - s * s)


STEPS = [0.17 * (1 - cos(pi / 2 * i / 14)) for i in range(14)] + [0.17 + 0.30 * i / 20 for i in range(21)]
RIBS = 9


def shell(x, angle):
    """A point of the ribs: angle 0 at the near edge of the soundboard, pi at the far one."""
    w = half_width(x)
    return (x, -0.92 * w * sin(angle), -w * cos(angle))


def shell_normal(x, angle):
    e = 1e-4
    x = min(max(x, 2e-3), LENGTH)
    along = sub(shell(x + e, angle), shell(x - e, angle))
    across = sub(shell(x, angle + e), shell(x, angle - e))
    n = unit(cross(along, across))
    return n if dot(n, sub(shell(x, angle), (x, 0, 0))) > 0 else mul(n, -1)


YAW, PITCH, ROLL, SCALE = radians(24), radians(5), radians(-34), 1.2
ahead = (cos(YAW) * cos(PITCH), sin(PITCH), sin(YAW) * cos(PITCH))
level = unit(cross(ahead, (0, 1, 0)))
upright = cross(level, ahead)
normal = add(mul(upright, cos(ROLL)), mul(level, sin(ROLL)))
aside = cross(ahead, normal)
turned = lambda p: mul(add(add(mul(ahead, p[0]), mul(normal, p[1])), mul(aside, p[2])), SCALE)
lowest = min(turned(shell(x, pi * k / 40))[1] for x in STEPS for k in range(41))
ORIGIN = (-0.95, -lowest, -0.14)
lute = lambda p: add(ORIGIN, turned(p))

# The machine.
FRAME = 0.10            # x of the plane of the frame
EYELET = (0.98, 0.86, -0.12)
LOW, HIGH, HALF = 0.05, 0.70, 0.32   # the opening
BAR, DEEP = 0.045, 0.03
OPEN = radians(104)
POINT = lute(shell(0.16, pi))


def crossing(p):
    """Where the thread from the eyelet to p passes the frame: height and z."""
    t = (EYELET[0] - FRAME) / (EYELET[0] - p[0])
    q = add(EYELET, mul(sub(p, EYELET), t))
    return q[1], q[2]


def door(p):
    """From the closed door, (x - FRAME, y, z), to the open one: it hangs on the far post."""
    s, d = HALF + 0.5 * BAR - p[2], p[0]
    return (FRAME + s * sin(OPEN) + d * cos(OPEN), p[1], HALF + 0.5 * BAR - s * cos(OPEN) + d * sin(OPEN))


def scene():
    out("""# After Albrecht Duerer's woodcut of 1525: a lute on a table, the frame with its door, the thread from an eyelet in the wall,
# which its weight keeps taut, to a point of the lute. The dots on the paper are where the thread passes the frame for other
# points. Written by durer.py beside this file.
Film "rgb" "integer xresolution" 640 "integer yresolution" 480
Sampler "zsobol" "integer pixelsamples" 16
Integrator "distributed" "integer maxdepth" 2

LookAt -0.34 1.10 -2.85  0.03 0.17 0  0 1 0
Camera "perspective" "float fov" 32

WorldBegin

LightSource "gradientsky" "string name" "room"
    "rgb zenith" [0.24 0.24 0.25] "rgb horizon" [0.26 0.24 0.21] "rgb ground" [0.16 0.13 0.10]
AttributeBegin
    AreaLightSource "diffuse" "rgb L" [27 23.5 18]
    Material "diffuse" "rgb reflectance" [0 0 0]
    Shape "polygon" "string name" "window" "point3 P" [-1.9 1.5 -3.4  -1.9 3.1 -3.4  -3.1 3.1 -2.2  -3.1 1.5 -2.2]
AttributeEnd

AttributeBegin""")
    material((0.50, 0.43, 0.34))
    out("""    Shape "polygon" "string name" "wall" "point3 P" [1.06 -0.74 -1.4  1.06 -0.74 1.5  1.06 2.2 1.5  1.06 2.2 -1.4]
    Shape "polygon" "string name" "back wall" "point3 P" [1.06 -0.74 1.5  -4 -0.74 1.5  -4 2.2 1.5  1.06 2.2 1.5]""")
    material((0.36, 0.29, 0.22))
    out("""    Shape "polygon" "string name" "floor" "point3 P" [1.06 -0.74 -1.4  -4 -0.74 -1.4  -4 -0.74 1.5  1.06 -0.74 1.5]
AttributeEnd

# The table.
AttributeBegin""")
    material((0.27, 0.14, 0.07), 0.10, 60)
    box("table top", (-1.06, -0.035, -0.5), (0.80, 0, 0.5))
    material((0.21, 0.105, 0.05), 0.05, 40)
    box("apron", (-1.02, -0.13, -0.40), (0.70, -0.0351, -0.37))
    for x in (-0.98, 0.60):
        for z in (-0.36, 0.36):
            box("leg", (x - 0.03, -0.74, z - 0.03), (x + 0.03, -0.0351, z + 0.03))
        box("rail", (x - 0.018, -0.62, -0.3299), (x + 0.018, -0.57, 0.3299))
    box("stretcher", (-0.9619, -0.61, -0.02), (0.5819, -0.58, 0.02))
    out("AttributeEnd\n\n# The frame, its foot and its door with the paper.\nAttributeBegin")
    material((0.46, 0.29, 0.14), 0.10, 50)
    a, b = FRAME - DEEP / 2, FRAME + DEEP / 2
    box("foot", (a - 0.05, 0.0001, -HALF - BAR - 0.04), (b + 0.05, LOW - BAR, HALF + BAR + 0.04))
    box("sill", (a, LOW - BAR + 0.0001, -HALF - BAR), (b, LOW, HALF + BAR))
    box("lintel", (a, HIGH, -HALF - BAR), (b, HIGH + BAR, HALF + BAR))
    for z in (-HALF - BAR, HALF):
        box("post", (a, LOW + 0.0001, z), (b, HIGH - 0.0001, z + BAR))
    material((0.50, 0.33, 0.17), 0.10, 50)
    # The door's bars lie in the opening when it is closed.
    rim, gap, t = 0.028, 0.008, 0.009
    y0, y1, z1 = LOW + gap, HIGH - gap, HALF - gap
    box("door", (-t, y0, -z1), (t, y0 + rim, z1), door)
    box("door", (-t, y1 - rim, -z1), (t, y1, z1), door)
    for z in (-z1, z1 - rim):
        box("door", (-t, y0 + rim + 0.0001, z), (t, y1 - rim - 0.0001, z + rim), door)
    material((0.30, 0.28, 0.26), 0.3, 80)
    for y in (0.18, 0.53):
        hinge = (FRAME, y, HALF + 0.5 * BAR)
        tube("hinge", [add(hinge, (0.024, -0.03, -0.012)), add(hinge, (0.024, 0.03, -0.012))], [0.007] * 2, 10)
    material((0.86, 0.81, 0.70))
    paper = [(-t / 3, y0 + rim, -z1 + rim), (-t / 3, y1 - rim, -z1 + rim), (-t / 3, y1 - rim, z1 - rim), (-t / 3, y0 + rim, z1 - rim)]
    mesh("paper", [door(p) for p in paper], [(0, 1, 2), (0, 2, 3)])
    material((0.05, 0.04, 0.04))
    points = [shell(LENGTH * (1 - cos(pi * i / 17)) / 2, angle) for i in range(18) for angle in (0.0, pi)]
    points += [(0.285 + 0.045 * cos(TAU * i / 10), 0, 0.045 * sin(TAU * i / 10)) for i in range(10)]
    points += [(LENGTH + (NECK - LENGTH) * i / 6, 0.004, z) for i in range(1, 7) for z in (-0.028, 0.028)]
    for p in points:
        y, z = crossing(lute(p))
        center, dots = door((-t / 3 - 0.0006, y, z)), []
        side, up = unit(sub(door((0, 0, 1)), door((0, 0, 0)))), (0, 1, 0)
        n = 7
        dots = [center] + [add(center, mul(add(mul(side, cos(TAU * k / n)), mul(up, sin(TAU * k / n))), 0.0032)) for k in range(n)]
        mesh("dot", dots, [(0, 1 + k, 1 + (k + 1) % n) for k in range(n)])
    out("AttributeEnd\n\n# The lute: ribs by turns of two woods, soundboard, rose, bridge, neck, peg box, strings.\nAttributeBegin")
    for k in range(RIBS):
        material(((0.40, 0.19, 0.08), (0.55, 0.31, 0.13))[k % 2], 0.35, 90)
        angles = [pi * (k + j / 3) / RIBS for j in range(4)]
        rows = [[lute(shell(x, angle)) for angle in angles] for x in STEPS]
        normals = [[unit(turned(shell_normal(x, angle))) for angle in angles] for x in STEPS]
        grid("rib", rows, normals)
    material((0.74, 0.55, 0.31), 0.12, 60)
    rows = [[lute((x, 0.0005, -half_width(x))), lute((x, 0.0005, half_width(x)))] for x in STEPS]
    grid("soundboard", rows)
    rose = (0.285, 0.0012, 0)
    place = lambda p: lute(add(rose, p))
    material((0.05, 0.03, 0.02))
    n = 40
    mesh("rose", [place((0, 0, 0))] + [place((0.046 * cos(TAU * k / n), 0, 0.046 * sin(TAU * k / n))) for k in range(n)],
         [(0, 1 + k, 1 + (k + 1) % n) for k in range(n)])
    material((0.62, 0.42, 0.20), 0.1, 60)
    flat = lambda name, inner, outer, c, n, y: grid(name, [[place((c[0] + r * cos(TAU * k / n), y, c[1] + r * sin(TAU * k / n)))
                                                            for k in range(n)] for r in (inner, outer)], around=True)
    flat("rose ring", 0.044, 0.052, (0, 0), 40, 0.0008)
    for k in range(6):
        flat("tracery", 0.0125, 0.016, (0.027 * cos(TAU * k / 6), 0.027 * sin(TAU * k / 6)), 20, 0.0006 + 0.0001 * k)
    flat("tracery", 0.0125, 0.016, (0, 0), 20, 0.0014)
    material((0.25, 0.12, 0.05), 0.3, 80)
    box("bridge", (0.070, 0.0006, -0.072), (0.084, 0.010, 0.072), lute)
    # The neck: flat above, round below.
    rows, normals = [], []
    for x in (LENGTH - 0.012, NECK):
        w = 0.031 - 0.006 * (x - LENGTH) / (NECK - LENGTH)
        around = [pi * k / 10 for k in range(11)]
        rows.append([lute((x, -0.024 * sin(a), -w * cos(a))) for a in around])
        normals.append([unit(turned((0, -sin(a), -cos(a)))) for a in around])
    material((0.34, 0.17, 0.08), 0.3, 80)
    grid("neck", rows, normals)
    material((0.12, 0.07, 0.05), 0.3, 80)
    rows = [[lute((x, 0.0035, -w)), lute((x, 0.0035, w))] for x, w in ((LENGTH - 0.012, 0.0311), (NECK + 0.004, 0.0251))]
    rows = [[lute((x, 0.0, -w)), r[0], r[1], lute((x, 0.0, w))] for (x, w), r in
            zip(((LENGTH - 0.012, 0.0311), (NECK + 0.004, 0.0251)), rows)]
    grid("fingerboard", rows)
    material((0.85, 0.80, 0.68))
    box("nut", (NECK + 0.0045, -0.004, -0.025), (NECK + 0.010, 0.0075, 0.025), lute)
    # The peg box, bent back.
    bend = radians(78)
    along, out_ = (cos(bend), -sin(bend), 0), (sin(bend), cos(bend), 0)
    root = (NECK + 0.004, -0.012, 0)
    peg = lambda p: lute(add(root, add(add(mul(along, p[0]), mul(out_, p[1])), (0, 0, p[2]))))
    material((0.30, 0.15, 0.07), 0.3, 80)
    corners = [(x, y, z) for x, w, d in ((-0.01, 0.025, 0.013), (0.175, 0.017, 0.009)) for y in (-d, d) for z in (-w, w)]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    mesh("peg box", [peg(p) for p in corners], [t for a, b, c, d in faces for t in ((a, b, c), (a, c, d))])
    material((0.10, 0.06, 0.04), 0.4, 80)
    for k in range(6):
        x = 0.018 + 0.026 * k
        w = 0.025 - 0.008 * x / 0.175
        for side in (-1, 1):
            ways = [0.0, 0.016, 0.019, 0.024, 0.031, 0.036, 0.038]
            radii = [0.0032, 0.0036, 0.0030, 0.0066, 0.0066, 0.0030, 0.0]
            tube("peg", [(x, 0, side * (w - 0.002 + s)) for s in ways], radii, 8, peg)
    material((0.80, 0.72, 0.52), 0.3, 60)
    for k in range(6):
        z = (k - 2.5) / 2.5
        tube("string", [lute((0.080, 0.0095, 0.052 * z)), lute((NECK + 0.007, 0.0085, 0.020 * z))], [0.0008] * 2, 5)
    for k in range(7):
        x = 0.077 + (NECK - 0.077) * 2 ** (-(k + 1) / 12)
        w = 0.0312 - 0.006 * (x - LENGTH) / (NECK - LENGTH)
        turn = [pi * j / 8 for j in range(9)]
        around = [(x, -0.025 * sin(a), -w * cos(a)) for a in turn]
        tube("fret", [lute(p) for p in around + [(x, 0.0044, w), (x, 0.0044, -w), around[0]]], [0.0009] * 12, 5)
    out("AttributeEnd\n\n# The thread, the pointer at its end, the eyelet, the weight.\nAttributeBegin")
    material((0.42, 0.05, 0.04))
    tube("thread", [EYELET, add(POINT, mul(unit(sub(EYELET, POINT)), 0.004))], [0.0013] * 2, 6)
    weight = add(EYELET, (0, -0.52, 0))
    tube("thread", [EYELET, add(weight, (0, 0.068, 0))], [0.0013] * 2, 6)
    material((0.20, 0.12, 0.07), 0.2, 60)
    held = add(POINT, (-0.15, 0.15, 0.02))
    tube("pointer", [POINT, add(POINT, mul(sub(held, POINT), 0.18)), held, add(held, mul(sub(held, POINT), 0.01))],
         [0.0008, 0.0042, 0.0055, 0.0], 10)
    material((0.30, 0.29, 0.28), 0.5, 80)
    ring("eyelet", add(EYELET, (0, -0.006, 0)), (0, 0, 1), 0.017, 0.0035)
    tube("hook", [add(EYELET, (0.018, -0.006, 0)), (1.06, EYELET[1] - 0.006, 0)], [0.0045] * 2, 10)
    # A pear of lead with a flat foot.
    pear = [(0.006 + 0.028 * (1 - cos(pi * i / 12)) / 2, 0.066 - 0.066 * i / 12) for i in range(13)]
    lathe("weight", [(0.0, 0.068)] + pear + [(0.034, 0.0), (0.034, -0.012), (0.034, -0.012), (0.0, -0.012)], weight, 32)
    out("AttributeEnd")


scene()
