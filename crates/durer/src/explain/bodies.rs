//! What fills the place where a ray is, counted anew from the bodies that it is in.
use durer_core::spectrum::Basis;
use durer_render::Media;

use crate::{Id, MediumStack, model::Medium};

/// Index of refraction, and whose it is; 1 and `None` in empty space.
pub(super) fn present(media: &Media, basis: &Basis, bodies: &MediumStack) -> (f64, Option<Id<Medium>>) {
    let (mut n, mut whose, mut winner) = (1.0, None, None);
    for id in bodies.iter() {
        let medium = media.get(id);
        let own = f64::from(medium.eta(basis));
        match medium.priority {
            // It lies in what the ray was in, and its index is relative to that.
            None => (n, whose) = (n * own, Some(id)),
            Some(priority) if winner.is_none_or(|best| best < (priority, own)) => {
                winner = Some((priority, own));
                (n, whose) = (own, Some(id));
            }
            Some(_) => {}
        }
    }
    (n, whose)
}
