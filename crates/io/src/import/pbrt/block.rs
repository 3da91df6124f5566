//! Blocks and files: what nests.
use durer_scene::Span;

use super::{
    directive::Directive,
    input::Reported,
    lexer::{Lexer, Token},
    parser::{Parser, Waiting},
    state::Block,
};

/// The word that closes a block.
fn end_word(begin: Directive) -> &'static str {
    match begin {
        Directive::ObjectBegin => "ObjectEnd",
        Directive::TransformBegin => "TransformEnd",
        _ => "AttributeEnd",
    }
}

impl Parser<'_> {
    /// `AttributeBegin`, `TransformBegin`
    pub(super) fn begin_block(&mut self, begin: Directive, head: Token) {
        let at = self.input.lexer.span(head);
        if begin == Directive::TransformBegin {
            let message = "TransformBegin is deprecated: pbrt-v4 has AttributeBegin only";
            self.warn_once("TransformBegin", at, message);
        }
        self.push_block(begin, at);
    }

    fn push_block(&mut self, begin: Directive, at: Span) {
        let most = self.files.depth();
        if self.blocks.len() >= most && self.first_time("deep blocks") {
            self.input.error(at, format!("blocks are nested more than {most} deep"));
        }
        self.blocks.push(Block { begin, at, saved: self.state.clone() });
    }

    /// `AttributeEnd`, `TransformEnd`, `ObjectEnd`
    pub(super) fn end_block(&mut self, begin: Directive, head: Token) {
        // An imported file cannot close what was open before it.
        let outer =
            self.waiting.iter().rev().find_map(|w| w.import.as_ref()).map_or(0, |(_, blocks)| *blocks);
        let found = self.blocks.iter().skip(outer).rposition(|b| b.begin == begin);
        let Some(index) = found else {
            let at = self.input.lexer.span(head);
            self.input.error(at, format!("{} without {}", end_word(begin), begin.word()));
            return;
        };
        self.unclosed(outer + index + 1);
        if let Some(block) = self.blocks.pop() {
            if block.begin == Directive::ObjectBegin {
                self.world.end_object();
            }
            block.restore(&mut self.state);
        }
    }

    /// Closes all blocks but the first `keep`, with a complaint each.
    pub(super) fn unclosed(&mut self, keep: usize) {
        while self.blocks.len() > keep {
            let Some(block) = self.blocks.pop() else { return };
            if !self.input.diagnostics.is_full() {
                let message = format!("{} is not closed by {}", block.begin.word(), end_word(block.begin));
                self.input.error(block.at, message);
            }
            if block.begin == Directive::ObjectBegin {
                self.world.end_object();
            }
            block.restore(&mut self.state);
        }
    }

    /// `ObjectBegin`
    pub(super) fn begin_object(&mut self, head: Token) -> Result<(), Reported> {
        let name = self.input.string(head, "a name")?;
        if self.world.in_object() {
            self.input.error(name.at, "an object cannot be defined within another");
        }
        self.push_block(Directive::ObjectBegin, self.input.lexer.span(head));
        self.world.begin_object(&name, self.input.diagnostics);
        Ok(())
    }

    /// `ObjectInstance`
    pub(super) fn object_instance(&mut self, head: Token) -> Result<(), Reported> {
        let name = self.input.string(head, "the name of an object")?;
        if self.world.in_object() {
            self.input.error(name.at, "an object cannot contain instances");
            return Ok(());
        }
        self.world.instance(&name, self.state.ctm.clone());
        Ok(())
    }

    /// `Include`, `Import`
    pub(super) fn include(&mut self, directive: Directive, head: Token) -> Result<(), Reported> {
        let name = self.input.string(head, "a file name")?;
        let text = self.files.include(
            &name.text,
            self.folder.as_deref(),
            &self.open,
            name.at,
            self.sources,
            self.input.diagnostics,
        );
        let Some(text) = text else { return Ok(()) };
        let import = (directive == Directive::Import).then(|| (self.state.clone(), self.blocks.len()));
        let lexer = std::mem::replace(&mut self.input.lexer, Lexer::new(text.source, text.text));
        let folder = std::mem::replace(&mut self.folder, text.folder);
        self.waiting.push(Waiting { lexer, folder, import });
        self.open.push(text.path);
        Ok(())
    }

    /// Goes on with the file that included this one; false if there is none.
    pub(super) fn leave_file(&mut self) -> bool {
        let Some(waiting) = self.waiting.pop() else {
            return false;
        };
        self.open.pop();
        self.input.lexer = waiting.lexer;
        self.folder = waiting.folder;
        if let Some((state, blocks)) = waiting.import {
            self.unclosed(blocks);
            self.state = state;
        }
        true
    }
}
