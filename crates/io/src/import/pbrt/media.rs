//! Media and which of them are on the two sides of surfaces.
use durer_scene::{MediumInterface, Node};

use super::{
    input::{Reported, Word},
    lexer::{Token, TokenKind},
    params::{ParamList, stored},
    parser::Parser,
    state::Target,
};

impl Parser<'_> {
    /// `MakeNamedMedium`
    pub(super) fn make_named_medium(&mut self, head: Token) -> Result<(), Reported> {
        let name = self.input.string(head, "a name")?;
        let params = self.params();
        if name.text.is_empty() {
            self.input.error(name.at, "a medium needs a name: the empty one stands for nothing");
            return params.map(|_| ());
        }
        let node = params.as_ref().ok().cloned().and_then(|params| self.medium_node(params, &name));
        let has_place = node.as_ref().is_some_and(|node| node.kind != "homogeneous");
        if has_place && !self.state.ctm.motion(self.world.times).is_still() {
            let message =
                format!("the medium \"{}\" moves, which media do not: it stays where it starts", name.text);
            self.input
                .diagnostics
                .warning(name.at, message)
                .hint("a shape that moves takes along where its medium begins and ends");
        }
        self.world.define_medium(&name, (node, &self.state.ctm), self.input.diagnostics);
        params.map(|_| ())
    }

    fn medium_node(&mut self, params: ParamList, name: &Word) -> Option<Node> {
        let mut params = self.inherit(Target::Medium, params, name);
        let (kind, at) = self.type_of(&mut params, (name, "MakeNamedMedium"))?;
        Some(Node { kind, params: stored(params), at })
    }

    /// `MediumInterface`: what is inside and outside; one name stands for both, an empty one for nothing.
    pub(super) fn medium_interface(&mut self, head: Token) -> Result<(), Reported> {
        let inside = self.input.string(head, "the name of a medium")?;
        let inside = self.world.use_medium(&inside);
        let outside = match self.input.lexer.peek().kind {
            TokenKind::Plain | TokenKind::Escaped => {
                let name = self.input.string(head, "the name of a medium")?;
                self.world.use_medium(&name)
            }
            _ => inside,
        };
        self.state.media = Some(MediumInterface { inside, outside });
        Ok(())
    }
}
