//! Media and which of them are on the two sides of surfaces.
use durer_scene::{MediumInterface, MediumRef};

use super::{Writer, place::Frame, value::quoted};

impl Writer<'_> {
    /// All media, in their order; behind it the next directive begins at the origin again.
    pub(super) fn media(&mut self) {
        let desc = self.desc;
        for medium in &desc.media {
            let owner = format!("medium \"{}\"", medium.name);
            self.line("");
            Frame::Still(medium.world_from_medium).write(&mut self.text);
            let kind = quoted(&medium.node.kind);
            self.text
                .push_str(&format!("MakeNamedMedium {} \"string type\" [ {kind} ]", quoted(&medium.name)));
            self.params(&medium.node, &owner);
        }
        if !desc.media.is_empty() {
            self.line("Identity");
        }
    }

    /// What is on both sides of what follows; where nothing is said the same is said of both. Of scenes without media
    /// nothing is.
    pub(super) fn sides(&mut self, sides: Option<MediumInterface>) {
        if self.desc.media.is_empty() {
            return;
        }
        let sides = sides.unwrap_or_default();
        let name = |medium: Option<MediumRef>| {
            let known = medium.and_then(|medium| self.desc.media.get(medium.index()));
            quoted(known.map_or("", |medium| medium.name.as_str()))
        };
        let line = format!("MediumInterface {} {}", name(sides.inside), name(sides.outside));
        self.line(&line);
    }
}
