//! A scene as all kernels get it: meshes and where they are placed.
use std::{
    fs::File,
    io::{self, BufWriter, Write},
    path::Path,
};

use durer::math::{Bounds3, Point3, Transform};

use crate::view::View;

/// Triangles in a space of their own.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Vertices.
    pub positions: Vec<Point3>,
    /// Three vertices each.
    pub indices: Vec<[u32; 3]>,
}

/// A mesh somewhere.
#[derive(Clone, Debug, PartialEq)]
pub struct Instance {
    /// Index in [`Scene::meshes`].
    pub mesh: usize,
    /// `world_from_object`; `None` if the mesh is in world space: then it is no instance to Embree either.
    pub placed: Option<Transform>,
}

/// What is traced and from where.
#[derive(Clone, Debug)]
pub struct Scene {
    /// What `--scenes` calls it.
    pub name: String,
    /// Each mesh once.
    pub meshes: Vec<Mesh>,
    /// In the order of the instance ids that all kernels return.
    pub instances: Vec<Instance>,
    /// The camera of the first rays.
    pub view: View,
}

impl Scene {
    /// A scene of one mesh in world space.
    pub fn of_mesh(name: &str, mesh: Mesh, view: View) -> Self {
        let instances = vec![Instance { mesh: 0, placed: None }];
        Self { name: name.to_owned(), meshes: vec![mesh], instances, view }
    }

    /// Triangles stored, each mesh once.
    pub fn triangles(&self) -> usize {
        self.meshes.iter().map(|mesh| mesh.indices.len()).sum()
    }

    /// True if a mesh is placed by a transform.
    pub fn has_transforms(&self) -> bool {
        self.instances.iter().any(|instance| instance.placed.is_some())
    }

    /// The only mesh of a scene without transforms.
    pub fn only_mesh(&self) -> Option<&Mesh> {
        match self.instances.as_slice() {
            [Instance { mesh, placed: None }] => self.meshes.get(*mesh),
            _ => None,
        }
    }

    /// World-space corners of a triangle.
    ///
    /// # Panics
    /// If there is no such instance or triangle.
    pub fn corners(&self, instance: u32, prim: u32) -> [Point3; 3] {
        let instance = &self.instances[instance as usize];
        let mesh = &self.meshes[instance.mesh];
        let corners = mesh.indices[prim as usize].map(|vertex| mesh.positions[vertex as usize]);
        match &instance.placed {
            Some(placed) => corners.map(|p| placed.point(p)),
            None => corners,
        }
    }

    /// World-space box around everything; a placed mesh counts by the corners of its box.
    pub fn bounds(&self) -> Bounds3 {
        let own: Vec<Bounds3> =
            self.meshes.iter().map(|mesh| Bounds3::around(mesh.positions.iter().copied())).collect();
        let placed = self.instances.iter().map(|instance| match &instance.placed {
            Some(placed) => placed.bounds(&own[instance.mesh]),
            None => own[instance.mesh],
        });
        placed.fold(Bounds3::EMPTY, Bounds3::union)
    }

    /// Writes it as the Embree process reads it: little-endian, 32 bits a number.
    ///
    /// # Errors
    /// What the system says.
    pub fn write(&self, path: &Path) -> io::Result<()> {
        let mut file = BufWriter::new(File::create(path)?);
        let mut number = |n: u32| file.write_all(&n.to_le_bytes());
        number(self.meshes.len() as u32)?;
        for mesh in &self.meshes {
            number(mesh.positions.len() as u32)?;
            number(mesh.indices.len() as u32)?;
            for x in mesh.positions.iter().flat_map(|p| p.to_array()) {
                number(x.to_bits())?;
            }
            for &vertex in mesh.indices.iter().flatten() {
                number(vertex)?;
            }
        }
        number(self.instances.len() as u32)?;
        for instance in &self.instances {
            number(instance.mesh as u32)?;
            number(instance.placed.is_some().into())?;
            let rows = instance.placed.unwrap_or(Transform::IDENTITY);
            for &x in rows.rows().iter().flatten() {
                number(x.to_bits())?;
            }
        }
        file.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer::math::Vector3;

    fn triangle() -> Mesh {
        let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 2.0, 0.0]];
        Mesh { positions: positions.map(Point3::from).to_vec(), indices: vec![[0, 1, 2]] }
    }

    #[test]
    fn a_placed_mesh_is_where_it_is_placed() {
        let view = View::looking(Point3::new(0.0, 0.0, 5.0), Point3::ZERO, 40.0);
        let mut scene = Scene::of_mesh("one", triangle(), view);
        assert!(scene.only_mesh().is_some() && !scene.has_transforms());
        let placed = Some(Transform::translate(Vector3::new(3.0, 0.0, 1.0)));
        scene.instances.push(Instance { mesh: 0, placed });
        assert!(scene.only_mesh().is_none() && scene.has_transforms());
        assert_eq!(scene.corners(1, 0)[1], Point3::new(4.0, 0.0, 1.0));
        // The box of something placed is rounded outwards.
        let bounds = scene.bounds();
        assert!(bounds.contains(Point3::new(4.0, 2.0, 1.0)));
        assert!((bounds.max - Point3::new(4.0, 2.0, 1.0)).max_component() < 1e-5);
        assert_eq!(scene.triangles(), 1);
    }
}
