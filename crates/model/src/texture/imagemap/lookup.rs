//! An image with its smaller copies, looked up at points and under footprints.
use super::{
    filter::{Filter, WEIGHTS, level, weight},
    footprint::Ellipse,
    pyramid::Pyramid,
    texels::Texels,
    wrap::Wrap,
};

/// An image, what lies beyond its edges, and how it is filtered. Coordinates are 0 to 1 from its upper left corner.
#[derive(Clone, Debug)]
pub(super) struct Picture {
    texels: Texels,
    wrap: [Wrap; 2],
    filter: Filter,
    /// Of filters that need it.
    pyramid: Option<Pyramid>,
}

impl Picture {
    pub(super) fn new(texels: Texels, wrap: [Wrap; 2], filter: Filter) -> Self {
        let pyramid = filter.has_levels().then(|| Pyramid::new(&texels));
        Self { texels, wrap, filter, pyramid }
    }

    /// Whether footprints matter.
    pub(super) fn has_levels(&self) -> bool {
        self.pyramid.is_some()
    }
    /// No value is of larger magnitude.
    pub(super) fn largest(&self) -> f32 {
        self.texels.largest()
    }
    /// Heap memory of the copies, in bytes.
    pub(super) fn bytes(&self) -> u64 {
        self.pyramid.as_ref().map_or(0, Pyramid::bytes)
    }

    /// Columns and rows of the image, 0, or of a copy.
    fn size(&self, level: usize) -> [u32; 2] {
        match (&self.pyramid, level) {
            (Some(pyramid), 1..) => pyramid.size(level - 1),
            _ => [self.texels.width(), self.texels.height()],
        }
    }
    /// A texel of the image, 0, or of a copy.
    fn texel(&self, level: usize, x: i64, y: i64) -> [f32; 4] {
        let inside = Wrap::texel(self.wrap, [x, y], self.size(level));
        inside.map_or([0.0; 4], |[x, y]| match (&self.pyramid, level) {
            (Some(pyramid), 1..) => pyramid.rgba(level - 1, x, y),
            _ => self.texels.rgba(x, y),
        })
    }

    /// Linear RGBA at a point. Black at coordinates that are not finite.
    pub(super) fn at(&self, c: [f64; 2]) -> [f32; 4] {
        match self.filter {
            Filter::Point => {
                let [x, y] = self.in_texels(0, c);
                if x.is_finite() && y.is_finite() {
                    self.texel(0, x.floor() as i64, y.floor() as i64)
                } else {
                    [0.0; 4]
                }
            }
            _ => self.bilinear(0, c),
        }
    }

    /// The mean under the parallelogram around a point that two steps span.
    pub(super) fn under(&self, c: [f64; 2], steps: [[f64; 2]; 2]) -> [f32; 4] {
        let size = self.size(0).map(f64::from);
        let steps = steps.map(|[x, y]| [(x * size[0]) as f32, (y * size[1]) as f32]);
        match &self.filter {
            Filter::Point | Filter::Bilinear => self.at(c),
            Filter::Trilinear => {
                let width = steps.iter().flatten().fold(0.0, |most: f32, s| most.max(s.abs()));
                // The footprint reaches so far to either side.
                self.between(level(2.0 * width), |level| self.bilinear(level, c))
            }
            Filter::Ewa { most, weights } => match Ellipse::new(steps, *most) {
                None => self.bilinear(0, c),
                Some(ellipse) => {
                    self.between(level(ellipse.minor), |level| self.ellipse(level, c, &ellipse, weights))
                }
            },
        }
    }

    /// Linear interpolation between what `value` says of the two levels around `level`.
    fn between(&self, level: f32, value: impl Fn(usize) -> [f32; 4]) -> [f32; 4] {
        let last = self.pyramid.as_ref().map_or(0, Pyramid::count);
        if level >= last as f32 {
            return self.texel(last, 0, 0);
        }
        let finer = level as usize;
        let share = level - finer as f32;
        if share == 0.0 {
            return value(finer);
        }
        let (a, b) = (value(finer), value(finer + 1));
        std::array::from_fn(|c| a[c] + (b[c] - a[c]) * share)
    }

    fn in_texels(&self, level: usize, c: [f64; 2]) -> [f64; 2] {
        let [w, h] = self.size(level).map(f64::from);
        [c[0] * w, c[1] * h]
    }

    /// Between the four texel centres around a point.
    fn bilinear(&self, level: usize, c: [f64; 2]) -> [f32; 4] {
        let [x, y] = self.in_texels(level, c).map(|c| c - 0.5);
        if !(x.is_finite() && y.is_finite()) {
            return [0.0; 4];
        }
        let (x0, y0) = (x.floor(), y.floor());
        let (fx, fy) = ((x - x0) as f32, (y - y0) as f32);
        // Saturates far out, where neighbours are one anyway.
        let (x0, y0) = (x0 as i64, y0 as i64);
        let (x1, y1) = (x0.saturating_add(1), y0.saturating_add(1));
        let corners = [
            (self.texel(level, x0, y0), (1.0 - fx) * (1.0 - fy)),
            (self.texel(level, x1, y0), fx * (1.0 - fy)),
            (self.texel(level, x0, y1), (1.0 - fx) * fy),
            (self.texel(level, x1, y1), fx * fy),
        ];
        std::array::from_fn(|c| corners.iter().map(|(texel, weight)| texel[c] * weight).sum())
    }

    /// The weighted mean of the texels within an ellipse.
    fn ellipse(&self, level: usize, c: [f64; 2], ellipse: &Ellipse, weights: &[f32; WEIGHTS]) -> [f32; 4] {
        let [w, h] = self.size(0).map(|n| n as f32);
        let [lw, lh] = self.size(level).map(|n| n as f32);
        let centre = self.in_texels(level, c).map(|c| c - 0.5);
        // Far out whole numbers are no neighbours any more.
        if !centre.iter().all(|c| c.abs() < 1e15) {
            return self.bilinear(level, c);
        }
        let (mut sum, mut total) = ([0.0; 4], 0.0);
        ellipse.scaled([lw / w, lh / h]).each(centre, |x, y, r2| {
            let weight = weight(weights, r2);
            if weight > 0.0 {
                let texel = self.texel(level, x, y);
                sum.iter_mut().zip(texel).for_each(|(s, v)| *s += weight * v);
                total += weight;
            }
        });
        if total > 0.0 { sum.map(|s| s / total) } else { self.bilinear(level, c) }
    }
}
