//! Rays as the camera sees them, over the picture.
use std::fmt::Write;

use crate::{
    glam::DVec3,
    tree::{
        document::{Node, Tree},
        ghost::GhostCamera,
        look::Look,
        number::Place,
        page::Page,
    },
};

use super::{cut, escaped};

/// Width of the picture, in user units.
const WIDTH: f64 = 480.0;
/// Nearest depth that is drawn, by the size of the scene.
const NEAR: f64 = 1e-4;

/// Places to the picture: `None` of places behind the camera.
struct Eye<'a> {
    camera: &'a GhostCamera,
    size: [f64; 2],
    near: f64,
}

impl Eye<'_> {
    fn local(&self, p: DVec3) -> DVec3 {
        let axis = |v: [crate::tree::number::Number; 3]| DVec3::from_array(v.map(|v| f64::from(v.0)));
        let c = self.camera;
        let p = p - vector(c.eye);
        DVec3::new(p.dot(axis(c.right)), p.dot(axis(c.up)), p.dot(axis(c.look)))
    }
    fn is_parallel(&self) -> bool {
        self.camera.kind == "orthographic"
    }
    fn on_picture(&self, p: DVec3) -> [f64; 2] {
        let (x, y) = if self.is_parallel() { (p.x, p.y) } else { (p.x / p.z, p.y / p.z) };
        let [x0, x1, y0, y1] = self.camera.window.map(|v| f64::from(v.0));
        [(x - x0) / (x1 - x0) * self.size[0], (y - y0) / (y1 - y0) * self.size[1]]
    }
    /// Both ends of what is before the camera.
    fn segment(&self, a: DVec3, b: DVec3) -> Option<[[f64; 2]; 2]> {
        let (mut a, mut b) = (self.local(a), self.local(b));
        if !self.is_parallel() {
            if a.z < self.near && b.z < self.near {
                return None;
            }
            let at_near = |p: DVec3, q: DVec3| p + (q - p) * ((self.near - p.z) / (q.z - p.z));
            if a.z < self.near {
                a = at_near(a, b);
            } else if b.z < self.near {
                b = at_near(b, a);
            }
        }
        let ends = [self.on_picture(a), self.on_picture(b)];
        ends.iter().flatten().all(|v| v.is_finite() && v.abs() < 1e7).then_some(ends)
    }
}

/// The picture, pale, with the rays of a tree over it, and its size; `None` if the page knows no scene.
pub(super) fn picture(page: &Page, tree: &Tree) -> Option<(String, [f64; 2])> {
    let scene = page.scene.as_ref()?;
    let size = [WIDTH, WIDTH * f64::from(tree.height) / f64::from(tree.width.max(1))];
    let [low, high] = scene.bounds.map(vector);
    let span = (high - low).length().max(1e-6);
    let eye = Eye { camera: &scene.camera, size, near: span * NEAR };
    let mut text = format!(
        "<clipPath id=\"frame\"><rect width=\"{0}\" height=\"{1}\"/></clipPath>\n<rect width=\"{0}\" height=\"{1}\" fill=\"#eee\"/>\n",
        cut(size[0]),
        cut(size[1])
    );
    if let Some(picture) = page.picture.as_ref().filter(|p| p.png.starts_with("data:image/png;base64,")) {
        let _ = writeln!(
            text,
            "<image xlink:href=\"{}\" width=\"{}\" height=\"{}\" preserveAspectRatio=\"none\" opacity=\"0.45\"/>",
            escaped(&picture.png),
            cut(size[0]),
            cut(size[1])
        );
    }
    text.push_str("<g clip-path=\"url(#frame)\" stroke-linecap=\"round\">\n");
    for node in tree.nodes.iter().filter(|n| n.parent.is_some() && !n.is_untraced()) {
        ray(&mut text, &eye, node, span);
    }
    let scale = [size[0] / f64::from(tree.width.max(1)), size[1] / f64::from(tree.height.max(1))];
    let film = [0, 1].map(|i| f64::from(tree.film[i].0) * scale[i]);
    let (x, y) = (cut(film[0]), cut(film[1]));
    let _ = writeln!(
        text,
        "<circle cx=\"{x}\" cy=\"{y}\" r=\"5\" fill=\"none\" stroke=\"#fff\" stroke-width=\"3\"/>\n\
         <circle cx=\"{x}\" cy=\"{y}\" r=\"5\" fill=\"none\" stroke=\"#000\" stroke-width=\"1.2\"/>\n</g>"
    );
    let _ = writeln!(
        text,
        "<rect width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"#333\"/>",
        cut(size[0]),
        cut(size[1])
    );
    legend(&mut text, size[1] + 18.0);
    Some((text, [size[0], size[1] + 26.0]))
}

fn ray(text: &mut String, eye: &Eye<'_>, node: &Node, span: f64) {
    let start = vector(node.origin);
    let direction = DVec3::from_array(node.direction.map(|v| f64::from(v.0)));
    // A ray that meets nothing goes on across the scene.
    let end = node.end().map_or(start + direction * span, vector);
    let Some([a, b]) = eye.segment(start, end) else { return };
    let look = Look::of(&node.kind);
    let dashes =
        if look.dashes.is_empty() { String::new() } else { format!(" stroke-dasharray=\"{}\"", look.dashes) };
    let dark = if node.light.as_ref().is_some_and(|l| !l.visible) { " opacity=\"0.5\"" } else { "" };
    let _ = writeln!(
        text,
        "<line x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\" stroke=\"{}\" stroke-width=\"1.6\"{dashes}{dark}/>",
        cut(a[0]),
        cut(a[1]),
        cut(b[0]),
        cut(b[1]),
        look.color
    );
}

fn legend(text: &mut String, y: f64) {
    let kinds = [("shadow", "L shadow ray"), ("reflection", "R reflected"), ("refraction", "T transmitted")];
    for (index, (kind, words)) in kinds.into_iter().enumerate() {
        let (look, x) = (Look::of(kind), 120.0 * index as f64);
        let dashes = if look.dashes.is_empty() {
            String::new()
        } else {
            format!(" stroke-dasharray=\"{}\"", look.dashes)
        };
        let _ = writeln!(
            text,
            "<line x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\" stroke=\"{}\" stroke-width=\"1.6\"{dashes}/>\
             <text x=\"{}\" y=\"{}\" font-size=\"10\">{words}</text>",
            cut(x),
            cut(y - 3.0),
            cut(x + 24.0),
            cut(y - 3.0),
            look.color,
            cut(x + 29.0),
            cut(y)
        );
    }
}

fn vector(p: Place) -> DVec3 {
    DVec3::from_array(p.map(|v| v.0))
}
