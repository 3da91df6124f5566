"""Writes the water of pool.pbrt: `python3 pool.py > water`, to be put between its two lines of dashes."""
from math import cos, pi, sin, sqrt

# Metres along x and z, points along each.
SIZE, POINTS = (3.1, 2.1), (32, 22)
# Length in metres, direction in degrees, height, phase. The smaller ones fold light on the floor.
WAVES = [
    (1.30, 25, 0.0140, 0.3),
    (0.95, -40, 0.0130, 2.1),
    (0.72, 75, 0.0130, 4.4),
    (0.55, 10, 0.0105, 1.2),
    (0.48, -70, 0.0095, 5.6),
    (0.60, 130, 0.0110, 3.3),
]


def height(x, z):
    """A sum of waves, and a ring around the ball that swims."""
    sum_ = 0.0
    for length, direction, high, phase in WAVES:
        a = direction * pi / 180
        sum_ += high * sin(2 * pi * (x * cos(a) + z * sin(a)) / length + phase)
    r = sqrt((x - 0.55) ** 2 + (z + 0.2) ** 2)
    return sum_ + 0.006 * cos(2 * pi * r / 0.42) * 2.718 ** (-((r - 0.7) / 0.35) ** 2)


def main():
    nx, nz = POINTS
    rows = []
    for j in range(nz):
        row = []
        for i in range(nx):
            x, z = ((k / (n - 1) - 0.5) * s for k, n, s in ((i, nx, SIZE[0]), (j, nz, SIZE[1])))
            row.append(f"{x:.4g} {height(x, z):.4f} {z:.4g}")
        rows.append("  ".join(row))
    faces = []
    for j in range(nz - 1):
        row = []
        for i in range(nx - 1):
            a = j * nx + i
            row.append(f"{a} {a + nx} {a + nx + 1}  {a} {a + nx + 1} {a + 1}")
        faces.append("  ".join(row))
    print('    Shape "loopsubdiv" "string name" "water" "integer levels" 3')
    print('        "point3 P" [\n' + "\n".join(rows) + "]")
    print('        "integer indices" [\n' + "\n".join(faces) + "]")


main()
