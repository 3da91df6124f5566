//! Checkerboard of unit squares, or of unit cubes.
//!
//! `tex1` where the floors of the coordinates add up to an even number, `tex2` elsewhere (Physically Based Rendering, 4th
//! edition, section 10.4). A square owns its lower and left edge, also at negative coordinates.
//!
//! Filtered, the share of `tex2` is `1/2 - 1/2 s(u) s(v)`: the board is a product of square waves, each of which is
//! averaged under a tent of half width `r = 3/2 max(|du/dx|, |du/dy|)`, as in pbrt-v4. With the second integral `S` of the
//! wave that is `(S(u + r) - 2 S(u) + S(u - r)) / r²`.
use durer_core::{
    glam::DAffine3,
    spectrum::{Color, Spectrum},
};
use durer_scene::{Args, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use super::{
    Filters, Footprint, Texture, TextureAt, Value,
    mapping::{Mapping, Space, mapped},
};
use crate::ShadeCx;

/// What the board is made of.
#[derive(Clone, Debug, PartialEq)]
enum Board {
    Squares(Mapping),
    Cubes(Space),
}

/// Half width of the tent by the larger derivative.
const TENT: f64 = 1.5;
/// Tents wider than this average to nothing, to the last bit of an f32.
const WIDEST: f64 = 1e4;

/// Two alternating textures.
#[derive(Clone, Debug, PartialEq)]
pub struct Checkerboard<V> {
    tex1: V,
    tex2: V,
    board: Board,
    filters: Filters,
}

/// Whether the floor of a coordinate is odd.
fn is_odd(c: f64) -> bool {
    // PERF: floor is a call where the processor is not known to have SSE4.1 (bench render).
    let truncated = c as i64;
    let floor = truncated - i64::from(c < truncated as f64);
    floor & 1 == 1
}

/// The square wave, 1 on `[0, 1)`, -1 on `[1, 2)` and so on, averaged under a tent of half width `r`, or at a point if that
/// is 0.
fn wave(x: f64, r: f64) -> f64 {
    let point = if is_odd(x) { -1.0 } else { 1.0 };
    if r > WIDEST {
        return 0.0;
    }
    // Near 0 differences of the integral keep their digits.
    let x = x - 2.0 * (x / 2.0).floor();
    if r <= 0.0 || !x.is_finite() || (x - r).floor() == (x + r).floor() {
        return point;
    }
    // The first integral is a wave of triangles of mean 1/2, whose linear part second differences do not see.
    let integral = |x: f64| {
        let whole = (x / 2.0).floor();
        let part = x - 2.0 * whole;
        let rest = 2.0 - part;
        let within = if part < 1.0 { part * part / 2.0 } else { 1.0 - rest * rest / 2.0 };
        within - part / 2.0
    };
    ((integral(x + r) - 2.0 * integral(x) + integral(x - r)) / (r * r)).clamp(-1.0, 1.0)
}

impl<V: Value> Checkerboard<V> {
    /// The share of the second texture.
    fn share(&self, at: &TextureAt) -> f32 {
        let footprint = match self.filters {
            Filters::Never => &Footprint::POINT,
            Filters::AsPbrt => at.footprint.usual(),
            Filters::Always => &at.footprint,
        };
        let is_point = footprint.is_point();
        match &self.board {
            Board::Squares(mapping) => {
                let c = mapping.apply(at);
                if is_point {
                    return point_share(c);
                }
                let [x, y] = mapping.spread(at, footprint);
                filtered_share(c, std::array::from_fn(|i| x[i].abs().max(y[i].abs())))
            }
            Board::Cubes(space) => {
                let c = space.point(at).to_array();
                if is_point {
                    return point_share(c);
                }
                let [x, y] = space.sides(footprint);
                filtered_share(c, x.abs().max(y.abs()).to_array())
            }
        }
    }
}

fn point_share<const N: usize>(c: [f64; N]) -> f32 {
    // Parities are added, not floors: large coordinates would round their sum.
    if c.iter().fold(false, |odd, &c| odd != is_odd(c)) { 1.0 } else { 0.0 }
}

fn filtered_share<const N: usize>(c: [f64; N], widths: [f64; N]) -> f32 {
    let product: f64 = c.into_iter().zip(widths).map(|(c, width)| wave(c, TENT * width)).product();
    (0.5 - 0.5 * product) as f32
}

impl<V: Value> Texture for Checkerboard<V> {
    fn color(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> Color {
        V::blend((&self.tex1, &self.tex2), self.share(at), |tex| tex.color(cx, at))
    }
    fn float(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> f32 {
        V::blend((&self.tex1, &self.tex2), self.share(at), |tex| tex.float(cx, at))
    }
    fn weight(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> Spectrum {
        V::blend((&self.tex1, &self.tex2), self.share(at), |tex| tex.weight(cx, at))
    }
    fn largest(&self, cx: &ShadeCx<'_>) -> f32 {
        self.tex1.largest(cx).max(self.tex2.largest(cx))
    }
    fn place(&mut self, render_from_texture: &DAffine3) {
        match &mut self.board {
            Board::Squares(mapping) => mapping.place(render_from_texture),
            Board::Cubes(space) => space.place(render_from_texture),
        }
    }
    fn filters(&self) -> Filters {
        self.filters
    }
}

impl<V: Value> Kind for Checkerboard<V> {
    type Output = Box<dyn Texture>;
    const SCHEMA: Schema = Schema {
        name: "checkerboard",
        aliases: &[],
        doc: "Two values or textures on alternating unit squares of texture space, or unit cubes; tex1 in [0, 1)² or [0, 1)³.",
        params: &mapped::<4, 12>([
            ParamSpec::new("tex1", V::TYPE, V::ONE, "On squares whose coordinates add up to an even number."),
            ParamSpec::new("tex2", V::TYPE, V::ZERO, "On the other squares."),
            ParamSpec::new(
                "dimension",
                ParamType::Int,
                ParamDefault::Int(2),
                "2: squares of texture coordinates; 3: cubes of the texture's own space, whatever the mapping.",
            )
            .range(2.0, 3.0),
            ParamSpec::new(
                "filter",
                ParamType::Choice(&["none", "tent"]),
                ParamDefault::Unset,
                "Whether edges are averaged over a sample's footprint. Default: as pbrt (tent) with the integrators path and \
                 direct, none with the others.",
            ),
        ]),
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        let board = match args.int("dimension") {
            3 => Board::Cubes(Space::WORLD),
            _ => Board::Squares(Mapping::read(args)),
        };
        let filters = match args.text("filter") {
            "none" => Filters::Never,
            "tent" => Filters::Always,
            _ => Filters::AsPbrt,
        };
        let (tex1, tex2) = (V::read(args, "tex1"), V::read(args, "tex2"));
        args.is_sound().then(|| Box::new(Self { tex1, tex2, board, filters }) as Box<dyn Texture>)
    }
}
