//! Lenses, surface by surface, in double precision: spheres met around their centres, refraction by angles, and the system
//! matrix of rays near the axis. Millimetres; light goes from the scene (left) to the film along +z, the front vertex is at 0.
use glam::DVec3;

/// A row of a lens file: radius of curvature (0 is the stop), way to the next surface, index behind, diameter.
pub type Row = [f64; 4];

/// The rows of a lens file.
pub fn rows(text: &str) -> Vec<Row> {
    let of = |line: &str| -> Vec<f64> {
        let words = line.split('#').next().unwrap_or("").split_whitespace();
        words.map(|word| word.parse().expect("a number")).collect()
    };
    text.lines().map(of).filter(|row| !row.is_empty()).map(|row| [row[0], row[1], row[2], row[3]]).collect()
}

fn index(row: &Row) -> f64 {
    if row[2] == 0.0 { 1.0 } else { row[2] }
}

/// `[a, b, c, d]` such that height and slope in front of the first surface become `a y + b u` and `c y + d u` behind the last.
pub fn system_matrix(rows: &[Row]) -> [f64; 4] {
    let mut m = [1.0, 0.0, 0.0, 1.0];
    let mut before = 1.0;
    let mut apply = |[a, b, c, d]: [f64; 4]| {
        m = [a * m[0] + b * m[2], a * m[1] + b * m[3], c * m[0] + d * m[2], c * m[1] + d * m[3]];
    };
    for (i, row) in rows.iter().enumerate() {
        let behind = index(row);
        if row[0] != 0.0 {
            apply([1.0, 0.0, (before - behind) / (behind * row[0]), before / behind]);
        }
        before = behind;
        if i + 1 < rows.len() {
            apply([1.0, row[1], 0.0, 1.0]);
        }
    }
    m
}

/// What became of a ray: where and whither it leaves, and the largest height on a surface by the surface's radius.
#[derive(Clone, Copy, Debug)]
pub struct Traced {
    /// The last surface's point.
    pub p: DVec3,
    /// Unit direction.
    pub d: DVec3,
    /// Above 1 if the barrel is in the way.
    pub height: f64,
}

/// A ray from the scene through all surfaces; `None` if it misses a sphere or is reflected totally.
pub fn forwards(rows: &[Row], p: DVec3, d: DVec3) -> Option<Traced> {
    let mut at = 0.0;
    let mut order = Vec::new();
    let mut before = 1.0;
    for row in rows {
        order.push((at, row[0], [before, index(row)], row[3] / 2.0));
        before = index(row);
        at += row[1];
    }
    through(order, p, d)
}

/// A ray from the film, travelling along -z.
pub fn backwards(rows: &[Row], p: DVec3, d: DVec3) -> Option<Traced> {
    let mut at = 0.0;
    let mut order = Vec::new();
    let mut before = 1.0;
    for row in rows {
        order.push((at, row[0], [index(row), before], row[3] / 2.0));
        before = index(row);
        at += row[1];
    }
    order.reverse();
    through(order, p, d)
}

fn through(order: Vec<(f64, f64, [f64; 2], f64)>, mut p: DVec3, mut d: DVec3) -> Option<Traced> {
    let mut highest = 0.0f64;
    d = d.normalize();
    for (vertex, radius, [n1, n2], half) in order {
        if radius == 0.0 {
            p += d * ((vertex - p.z) / d.z);
        } else {
            let centre = DVec3::new(0.0, 0.0, vertex + radius);
            let oc = p - centre;
            let b = oc.dot(d);
            let root = b * b - (oc.length_squared() - radius * radius);
            if root < 0.0 {
                return None;
            }
            let candidates = [-b - root.sqrt(), -b + root.sqrt()].map(|t| p + d * t);
            let near = |q: &DVec3| (q.z - vertex).abs();
            p = if near(&candidates[0]) < near(&candidates[1]) { candidates[0] } else { candidates[1] };
            // The plane of incidence: along the normal, and along the surface.
            let mut normal = (p - centre).normalize();
            if normal.dot(d) < 0.0 {
                normal = -normal;
            }
            let across = d - normal * normal.dot(d);
            let sine = across.length();
            if sine > 1e-12 {
                let angle = sine.atan2(normal.dot(d));
                let refracted = n1 / n2 * angle.sin();
                if refracted >= 1.0 {
                    return None;
                }
                let angle = refracted.asin();
                d = (normal * angle.cos() + across / sine * angle.sin()).normalize();
            }
        }
        highest = highest.max(p.x.hypot(p.y) / half);
    }
    Some(Traced { p, d, height: highest })
}
