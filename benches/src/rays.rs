//! Sets of rays, and how they are cut into chunks.
use std::{fs::File, io, io::Write, ops::Range, path::Path};

use durer::math::Ray;

/// Rays that are timed at a time; a set of few rays has chunks of about that size.
const CHUNK: usize = 32_768;

/// What is asked of a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Query {
    /// Where it first meets something.
    Closest,
    /// Whether it meets something.
    Any,
}

/// Kinds of rays, in the order of the tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Class {
    /// From the camera, neighbours together.
    Primary,
    /// On from where those arrive, cosine-distributed.
    Diffuse1,
    /// On from where those arrive.
    Diffuse2,
    /// As the first bounce, but to 5 % of the scene's diagonal, and asked whether there is anything.
    Occlusion,
}

impl Class {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Primary, Self::Diffuse1, Self::Diffuse2, Self::Occlusion];

    /// As tables and JSON call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Primary => "primary",
            Self::Diffuse1 => "diffuse1",
            Self::Diffuse2 => "diffuse2",
            Self::Occlusion => "occlusion",
        }
    }

    /// What is asked of its rays.
    pub fn query(self) -> Query {
        if self == Self::Occlusion { Query::Any } else { Query::Closest }
    }
}

/// Where a ray meets something. Of [`Query::Any`] only that it does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Found {
    /// Ray parameter.
    pub t: f32,
    /// Which instance.
    pub instance: u32,
    /// Which triangle of its mesh.
    pub prim: u32,
}

/// Rays of a kind.
#[derive(Clone, Debug)]
pub struct RaySet {
    /// Their kind.
    pub class: Class,
    /// In the order they are traced.
    pub rays: Vec<Ray>,
}

impl RaySet {
    /// The set cut into pieces of about equal size; none if there are no rays.
    pub fn chunks(&self) -> Vec<Range<usize>> {
        let count = self.rays.len();
        let pieces = ((count + CHUNK / 2) / CHUNK).max(1).min(count);
        (0..pieces).map(|i| count * i / pieces..count * (i + 1) / pieces).collect()
    }

    /// The `most` rays before those of `chunk`, or the last ones of the set: to be traced before the clock starts.
    pub fn warm_up(&self, chunk: &Range<usize>, most: usize) -> &[Ray] {
        let warm = most.min(self.rays.len());
        let start = chunk.start.checked_sub(warm).unwrap_or(self.rays.len() - warm);
        &self.rays[start..start + warm]
    }

    /// Writes eight numbers a ray, as the Embree process reads them.
    ///
    /// # Errors
    /// What the system says.
    pub fn write(&self, path: &Path) -> io::Result<()> {
        let mut bytes = Vec::with_capacity(self.rays.len() * 32);
        for Ray { o, d, t_min, t_max, .. } in &self.rays {
            let numbers = [o.x, o.y, o.z, *t_min, d.x, d.y, d.z, *t_max];
            bytes.extend(numbers.iter().flat_map(|x| x.to_le_bytes()));
        }
        File::create(path)?.write_all(&bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer::math::{Point3, Vector3};

    fn set(count: usize) -> RaySet {
        let ray = Ray::new(Point3::ZERO, Vector3::new(0.0, 0.0, 1.0));
        RaySet { class: Class::Primary, rays: vec![ray; count] }
    }

    #[test]
    fn chunks_cover_the_set_once() {
        for (count, pieces) in [(0, 0), (1, 1), (CHUNK, 1), (65_536, 2), (100_000, 3), (262_144, 8)] {
            let chunks = set(count).chunks();
            assert_eq!(chunks.len(), pieces);
            assert!(chunks.windows(2).all(|pair| pair[0].end == pair[1].start));
            assert_eq!(chunks.iter().map(Range::len).sum::<usize>(), count);
        }
    }

    #[test]
    fn warm_up_rays_exist() {
        let set = set(10_000);
        assert_eq!(set.warm_up(&(0..5_000), 6_144).len(), 6_144);
        assert_eq!(set.warm_up(&(8_000..10_000), 6_144).len(), 6_144);
        assert_eq!(set.warm_up(&(0..10_000), 20_000).len(), 10_000);
    }
}
