//! The main loop: directive after directive, each handed to its method; errors are reported and read over.
use std::{
    collections::{HashMap, HashSet},
    path::PathBuf,
};

use durer_scene::{Diagnostics, Location, SceneDesc, Sources, nearest_word};

use super::{
    directive::{Directive, Place},
    files::{Files, Text},
    input::{Input, Reported},
    lexer::{Lexer, Token, TokenKind},
    placement::{Active, Placement},
    state::{Block, State},
    world::World,
};

/// A file that waits for the one it includes.
#[derive(Debug)]
pub(super) struct Waiting {
    pub(super) lexer: Lexer,
    pub(super) folder: Option<PathBuf>,
    /// For `Import`: the state to return to and the number of blocks open before.
    pub(super) import: Option<(State, usize)>,
}

/// All that reading a scene takes.
#[derive(Debug)]
pub(super) struct Parser<'a> {
    pub(super) input: Input<'a>,
    pub(super) sources: &'a mut Sources,
    pub(super) world: World<'a>,
    pub(super) files: Files,
    /// Folder of the text being read.
    pub(super) folder: Option<PathBuf>,
    /// The files that wait, outermost first.
    pub(super) waiting: Vec<Waiting>,
    /// The files being read, outermost first.
    pub(super) open: Vec<PathBuf>,
    pub(super) state: State,
    pub(super) blocks: Vec<Block>,
    pub(super) coordinate_systems: HashMap<String, Placement>,
    world_began: bool,
    /// What is said once only.
    said: HashSet<&'static str>,
}

impl<'a> Parser<'a> {
    pub(super) fn new(
        main: Text,
        files: Files,
        desc: &'a mut SceneDesc,
        sources: &'a mut Sources,
        diagnostics: &'a mut Diagnostics,
    ) -> Self {
        Self {
            input: Input { lexer: Lexer::new(main.source, main.text), diagnostics },
            sources,
            world: World::new(desc),
            files,
            folder: main.folder,
            waiting: Vec::new(),
            open: vec![main.path],
            state: State::new(),
            blocks: Vec::new(),
            coordinate_systems: HashMap::new(),
            world_began: false,
            said: HashSet::new(),
        }
    }

    /// Reads everything.
    pub(super) fn run(mut self) {
        loop {
            if self.input.diagnostics.is_full() {
                let message = "too many errors: the rest of the scene is not checked";
                self.input.diagnostics.note(Location::None, message);
                return;
            }
            let token = self.input.lexer.next();
            if token.kind == TokenKind::End {
                if self.leave_file() {
                    continue;
                }
                self.finish(token);
                return;
            }
            if self.directive(token).is_err() {
                self.input.resync();
            }
        }
    }

    fn finish(mut self, end: Token) {
        self.unclosed(0);
        if !self.world_began && self.first_time("before WorldBegin") {
            let at = self.input.lexer.span(end);
            self.input.error(at, "the scene has no WorldBegin");
        }
        self.world.finish(self.input.diagnostics);
    }

    /// True the first time it is asked about `what`.
    pub(super) fn first_time(&mut self, what: &'static str) -> bool {
        self.said.insert(what)
    }

    /// Warns once per `key`.
    pub(super) fn warn_once(
        &mut self,
        key: &'static str,
        at: impl Into<Location>,
        message: impl Into<String>,
    ) {
        if self.first_time(key) {
            self.input.diagnostics.warning(at, message);
        }
    }

    fn directive(&mut self, head: Token) -> Result<(), Reported> {
        if head.kind != TokenKind::Word {
            return Err(self.input.unexpected(head, "a directive such as Shape"));
        }
        let Some(directive) = Directive::of(self.input.lexer.text(head)) else {
            return Err(self.unknown(head));
        };
        self.check_place(directive, head);
        self.obey(directive, head)
    }

    fn unknown(&mut self, head: Token) -> Reported {
        let at = self.input.lexer.span(head);
        let word = self.input.describe(head);
        if !word.starts_with(char::is_alphabetic) {
            return self.input.unexpected(head, "a directive such as Shape");
        }
        match Directive::retired(&word) {
            Some(hint) => {
                self.input.error(at, format!("unknown directive \"{word}\"")).hint(hint);
            }
            None => {
                self.input.diagnostics.unknown(at, "directive", &word, Directive::words());
                // What follows is not to be complained about as standing before it.
                let meant = nearest_word(&word, Directive::words());
                if meant == Some(Directive::WorldBegin.word()) && !self.world_began {
                    self.begin_world();
                }
            }
        }
        Reported
    }

    /// Complains about a directive on the wrong side of `WorldBegin`; it is read all the same.
    fn check_place(&mut self, directive: Directive, head: Token) {
        let at = self.input.lexer.span(head);
        let word = directive.word();
        match (directive.place(), self.world_began) {
            (Place::Options, true) if directive == Directive::WorldBegin => {
                self.input.error(at, "a second WorldBegin");
            }
            (Place::Options, true) => {
                self.input.error(at, format!("{word} must stand before WorldBegin"));
            }
            (Place::World, false) if self.first_time("before WorldBegin") => {
                self.input.error(at, format!("{word} must stand after WorldBegin"));
            }
            _ => {}
        }
    }

    fn obey(&mut self, directive: Directive, head: Token) -> Result<(), Reported> {
        use Directive as D;
        match directive {
            D::Identity
            | D::Translate
            | D::Scale
            | D::Rotate
            | D::LookAt
            | D::Transform
            | D::ConcatTransform
            | D::CoordinateSystem
            | D::CoordSysTransform
            | D::ActiveTransform
            | D::InverseTransform
            | D::TransformKeys
            | D::TransformTimes => self.transform(directive, head),
            D::Camera => self.camera(head),
            D::Film => self.film(head),
            D::Sampler => self.sampler(head),
            D::PixelFilter => self.pixel_filter(head),
            D::Integrator => self.integrator(head),
            D::Accelerator => self.accelerator(head),
            D::Option => self.option(head),
            D::ColorSpace => self.color_space(head),
            D::WorldBegin => {
                self.begin_world();
                Ok(())
            }
            D::WorldEnd => {
                let at = self.input.lexer.span(head);
                self.warn_once("WorldEnd", at, "pbrt-v4 has no WorldEnd: it is ignored");
                Ok(())
            }
            D::AttributeBegin | D::TransformBegin => {
                self.begin_block(directive, head);
                Ok(())
            }
            D::AttributeEnd => {
                self.end_block(D::AttributeBegin, head);
                Ok(())
            }
            D::TransformEnd => {
                self.end_block(D::TransformBegin, head);
                Ok(())
            }
            D::ObjectBegin => self.begin_object(head),
            D::ObjectEnd => {
                self.end_block(D::ObjectBegin, head);
                Ok(())
            }
            D::ObjectInstance => self.object_instance(head),
            D::ReverseOrientation => {
                self.state.reverse = !self.state.reverse;
                Ok(())
            }
            D::Attribute => self.attribute(head),
            D::Shape => self.shape(head),
            D::LightSource => self.light(head),
            D::AreaLightSource => self.area_light(head),
            D::Material => self.material(head),
            D::MakeNamedMaterial => self.make_named_material(head),
            D::NamedMaterial => self.named_material(head),
            D::Texture => self.texture(head),
            D::MakeNamedMedium => self.medium(head),
            D::MediumInterface => self.medium_interface(head),
            D::Include | D::Import => self.include(directive, head),
        }
    }

    fn begin_world(&mut self) {
        self.world_began = true;
        self.state.ctm = Placement::identity();
        self.state.active = Active::All;
        self.coordinate_systems.insert("world".to_owned(), Placement::identity());
    }
}
