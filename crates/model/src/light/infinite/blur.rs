//! A picture around everything as matte and glossy surfaces see it, tabulated when somebody first asks: paths
//! ask for no glossy one.
//!
//! Ambient: the cosine-weighted mean over the hemisphere about the normal (irradiance / pi). Glossy: the same lobes as the
//! gradient sky (`sky_blur.rs`), at nodes over the square root of alpha. Tables have
//! rows of latitude: bilinear lookups see no edges there, as they would in octahedral maps.
use std::sync::OnceLock;

use super::{
    layout::Layout,
    panorama::{Panorama, weighted},
    pyramid::{Lobe, Pyramid},
};
use durer_core::math::{
    Vector3,
    float::{lerp, sqr},
};

/// Rows of the tables of glossy lobes; entry i is for alpha `((i + 1) / n)²`. Narrow lobes need finer ones.
const ROWS: [u32; 6] = [80, 40, 24, 24, 24, 24];
/// Rows of the table of the ambient term.
const AMBIENT_ROWS: u32 = 32;

/// Rows of tables for each row of the picture that are always enough: it is interpolated between pixels itself.
const PER_PIXEL: u32 = 8;
/// Least rows of any table.
const LEAST_ROWS: u32 = 16;

/// A small picture in latitude and longitude.
#[derive(Debug)]
struct Table {
    size: [u32; 2],
    texels: Vec<[f32; 3]>,
}

impl Table {
    const LAYOUT: Layout = Layout::LatitudeLongitude;

    fn of(pyramid: &Pyramid, lobe: Lobe, rows: u32) -> Self {
        let columns = 2 * rows;
        let place = |i: u32, n: u32| (i as f32 + 0.5) / n as f32;
        let texel = |i: u32| {
            let axis = Self::LAYOUT.direction([place(i % columns, columns), place(i / columns, rows)]);
            pyramid.mean(lobe, axis)
        };
        // On one thread: a pool's thread that waits for others may be given work that asks for this very table.
        Self { size: [columns, rows], texels: (0..columns * rows).map(texel).collect() }
    }
    fn at(&self, d: Vector3) -> [f32; 3] {
        let corners = Self::LAYOUT.corners(Self::LAYOUT.uv(d), self.size);
        weighted(corners, |x, y| self.texels[(y * self.size[0] + x) as usize])
    }
}

/// The blurred picture.
#[derive(Debug)]
pub(super) struct Blur {
    pyramid: Pyramid,
    /// Most rows of a table.
    most_rows: u32,
    ambient: OnceLock<Table>,
    glossy: [OnceLock<Table>; ROWS.len()],
}

impl Blur {
    /// Of a picture of so many rows.
    pub(super) fn of(pyramid: Pyramid, picture_rows: u32) -> Self {
        // Most of the time goes into the finest table, which a picture of a few pixels does not need.
        let most_rows = picture_rows.saturating_mul(PER_PIXEL).max(LEAST_ROWS);
        Self { pyramid, most_rows, ambient: OnceLock::new(), glossy: Default::default() }
    }
    /// Mean over the cosine lobe about unit direction `n`.
    pub(super) fn ambient(&self, n: Vector3) -> [f32; 3] {
        self.ambient.get_or_init(|| Table::of(&self.pyramid, Lobe::Cosine, AMBIENT_ROWS)).at(n)
    }
    fn table(&self, i: usize) -> &Table {
        let alpha = sqr((i + 1) as f32 / ROWS.len() as f32);
        self.glossy[i]
            .get_or_init(|| Table::of(&self.pyramid, Lobe::Glossy(alpha), ROWS[i].min(self.most_rows)))
    }
    /// Mean over the glossy lobe of roughness `alpha` in `[0, 1]` about unit direction `d`.
    pub(super) fn glossy(&self, picture: &Panorama, d: Vector3, alpha: f32) -> [f32; 3] {
        let x = alpha.clamp(0.0, 1.0).sqrt() * ROWS.len() as f32;
        let i = (x as usize).min(ROWS.len() - 1);
        let sharp = if i == 0 { picture.seen(d) } else { self.table(i - 1).at(d) };
        let soft = self.table(i).at(d);
        std::array::from_fn(|c| lerp(x - i as f32, sharp[c], soft[c]))
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use durer_scene::{Image, ImageData};

    use super::*;

    #[test]
    fn a_picture_of_a_few_pixels_is_blurred_into_small_tables() {
        let rows = |height: u32| {
            let values = vec![1.0; 6 * height as usize * height as usize];
            let image = Image { width: 2 * height, height, channels: 3, data: ImageData::F32(values) };
            let picture = Panorama::new(Arc::new(image), Layout::LatitudeLongitude);
            let blur = Blur::of(Pyramid::of(&picture), height);
            std::array::from_fn::<_, { ROWS.len() }, _>(|i| blur.table(i).size[1])
        };
        assert_eq!(rows(1), [LEAST_ROWS; ROWS.len()]);
        assert_eq!(rows(4), [32, 32, 24, 24, 24, 24]);
        assert_eq!(rows(10), ROWS, "eight rows for each are as many as there are at all");
    }
}
