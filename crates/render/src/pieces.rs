//! The geometry of a compiled scene, for those who draw it instead of tracing rays.
use durer_core::{Id, math::Transform};
use durer_model::shape::Shape;
use durer_scene::Mesh;

use crate::{Object, Scene, scene::Target};

/// What a piece is made of, in its own space.
#[derive(Clone, Copy, Debug)]
pub enum Form<'a> {
    /// Triangles. Those that are placed several times are the same mesh, also by address.
    Mesh(&'a Mesh),
    /// Something else.
    Shape(&'a dyn Shape),
}

/// A part of a scene, placed.
#[derive(Clone, Copy, Debug)]
pub struct Piece<'a> {
    /// Whose part it is.
    pub object: Id<Object>,
    /// Its form.
    pub form: Form<'a>,
    /// Where it is.
    pub render_from_object: Transform,
}

impl Scene {
    /// All of them, as they are placed at `time` seconds.
    pub fn pieces(&self, time: f32) -> Vec<Piece<'_>> {
        let mut pieces = Vec::new();
        for (instance, target) in (0..).zip(self.targets.iter()) {
            let moved = || self.accel.instance_transform(instance, time);
            match target {
                Target::Baked(object, mesh) => pieces.push(Piece {
                    object: *object,
                    form: Form::Mesh(mesh),
                    render_from_object: Transform::IDENTITY,
                }),
                Target::Mesh(object, mesh) => pieces.push(Piece {
                    object: *object,
                    form: Form::Mesh(mesh),
                    render_from_object: moved(),
                }),
                Target::Shapes => pieces.extend(self.shapes.iter().map(|placed| Piece {
                    object: placed.object,
                    form: Form::Shape(&*placed.shape),
                    render_from_object: placed.render_from_object,
                })),
                // Too fine to be drawn: rays show them.
                Target::Strands(..) => {}
                Target::Mover(index) => {
                    let placed = &self.movers[*index as usize];
                    let form = Form::Shape(&*placed.shape);
                    pieces.push(Piece { object: placed.object, form, render_from_object: moved() });
                }
            }
        }
        pieces
    }
}
