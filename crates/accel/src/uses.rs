//! Which instances place a geometry.

/// Instances by geometry, those of a geometry in their order.
#[derive(Clone, Debug, Default)]
pub(crate) struct Uses {
    /// Where those of each geometry begin, and an end mark.
    starts: Vec<u32>,
    instances: Vec<u32>,
}

impl Uses {
    /// `places` are the geometries of all instances, one after another, each below `geometries`.
    pub(crate) fn new(geometries: usize, places: impl Iterator<Item = usize> + Clone) -> Self {
        let mut starts = vec![0u32; geometries + 1];
        places.clone().for_each(|geometry| starts[geometry + 1] += 1);
        for geometry in 0..geometries {
            starts[geometry + 1] += starts[geometry];
        }
        let mut next = starts.clone();
        let mut instances = vec![0; starts[geometries] as usize];
        for (index, geometry) in (0..).zip(places) {
            instances[next[geometry] as usize] = index;
            next[geometry] += 1;
        }
        Self { starts, instances }
    }

    /// The instances of a geometry.
    pub(crate) fn of(&self, geometry: usize) -> &[u32] {
        &self.instances[self.starts[geometry] as usize..self.starts[geometry + 1] as usize]
    }

    /// Heap memory held.
    pub(crate) fn bytes(&self) -> usize {
        size_of_val(self.starts.as_slice()) + size_of_val(self.instances.as_slice())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_instance_is_found_where_it_belongs() {
        let places = [2usize, 0, 2, 3, 0, 2];
        let uses = Uses::new(5, places.into_iter());
        let all: Vec<&[u32]> = (0..5).map(|geometry| uses.of(geometry)).collect();
        assert_eq!(all, [&[1, 4][..], &[], &[0, 2, 5], &[3], &[]]);
    }
}
