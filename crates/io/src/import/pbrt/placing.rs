//! The directives that change the current transformation.
use durer_core::glam::{DAffine3, DVec3};
use durer_scene::Node;

use super::{
    directive::Directive,
    input::Reported,
    keys::{self, KEYS},
    lexer::Token,
    params::stored,
    parser::Parser,
    placement::{Active, Placement},
    transform::{look_at, matrix, rotate},
};

/// Most motions within each other: the product has the keys of all.
const MOST_MOTIONS: usize = 4;

/// What a directive does to the matrix.
enum Change {
    /// Multiply from the right.
    Concat(DAffine3),
    /// Replace.
    Set(DAffine3),
    /// Replace by the inverse.
    SetInverse(DAffine3),
}

impl Parser<'_> {
    /// Any directive about transformations.
    pub(super) fn transform(&mut self, directive: Directive, head: Token) -> Result<(), Reported> {
        let change = match directive {
            Directive::CoordinateSystem => return self.coordinate_system(head),
            Directive::CoordSysTransform => return self.coord_sys_transform(head),
            Directive::ActiveTransform => return self.active_transform(head),
            Directive::TransformTimes => return self.transform_times(head),
            Directive::TransformKeys => return self.transform_keys(head),
            Directive::Identity => Ok(Change::Set(DAffine3::IDENTITY)),
            Directive::Translate => Ok(Change::Concat(DAffine3::from_translation(self.input.vector(head)?))),
            Directive::Scale => Ok(Change::Concat(DAffine3::from_scale(self.input.vector(head)?))),
            Directive::Rotate => {
                let [degrees, x, y, z] = self.input.numbers(head)?;
                rotate(degrees, DVec3::new(x, y, z)).map(Change::Concat)
            }
            Directive::LookAt => {
                let [ex, ey, ez, tx, ty, tz, ux, uy, uz] = self.input.numbers(head)?;
                let (eye, target, up) =
                    (DVec3::new(ex, ey, ez), DVec3::new(tx, ty, tz), DVec3::new(ux, uy, uz));
                look_at(eye, target, up).map(Change::Concat)
            }
            Directive::Transform => matrix(&self.input.matrix(head)?).map(Change::Set),
            Directive::InverseTransform => matrix(&self.input.matrix(head)?).map(Change::SetInverse),
            _ => matrix(&self.input.matrix(head)?).map(Change::Concat),
        };
        let (ctm, active) = (&self.state.ctm, self.state.active);
        let applied = change.and_then(|change| match &change {
            Change::Concat(m) => ctm.times(active, m),
            Change::Set(m) => ctm.with(active, m, self.world.times),
            Change::SetInverse(m) => ctm.with_inverse(active, m, self.world.times),
        });
        self.placed(applied, head);
        Ok(())
    }

    fn coordinate_system(&mut self, head: Token) -> Result<(), Reported> {
        let name = self.input.string(head, "a name")?;
        self.coordinate_systems.insert(name.text, self.state.ctm.clone());
        Ok(())
    }

    fn coord_sys_transform(&mut self, head: Token) -> Result<(), Reported> {
        let name = self.input.string(head, "the name of a coordinate system")?;
        let Some(system) = self.coordinate_systems.get(&name.text) else {
            let mut known: Vec<&str> = self.coordinate_systems.keys().map(String::as_str).collect();
            known.sort_unstable();
            self.input.diagnostics.unknown(name.at, "coordinate system", &name.text, known);
            return Ok(());
        };
        let applied = match self.state.active {
            Active::All => Ok(system.clone()),
            active => {
                let (start, end) = self.world.times;
                let at = if active == Active::Start { start } else { end };
                self.state.ctm.with(active, &system.at(at, self.world.times), self.world.times)
            }
        };
        self.placed(applied, head);
        Ok(())
    }

    /// Goes on from a new placement, or complains.
    fn placed(&mut self, applied: Result<Placement, &'static str>, head: Token) {
        match applied {
            Ok(ctm) => self.state.ctm = ctm,
            Err(message) => {
                self.input.error(self.input.lexer.span(head), message);
            }
        }
    }

    /// `TransformKeys`, our addition.
    fn transform_keys(&mut self, head: Token) -> Result<(), Reported> {
        let at = self.input.lexer.span(head);
        let params = self.input.params()?;
        if self.state.active != Active::All {
            self.input.error(at, "TransformKeys says itself what is when: it needs ActiveTransform All");
            return Ok(());
        }
        if self.state.ctm.depth() >= MOST_MOTIONS {
            let message = format!("TransformKeys stands within TransformKeys more than {MOST_MOTIONS} deep");
            self.input.error(at, message);
            return Ok(());
        }
        let node = Node { kind: KEYS.name.to_owned(), params: stored(params), at: at.into() };
        if let Some(motion) = keys::read(&node, self.input.diagnostics) {
            self.state.ctm = self.state.ctm.keyed(motion);
        }
        Ok(())
    }

    fn active_transform(&mut self, head: Token) -> Result<(), Reported> {
        let token = self.input.lexer.peek();
        if self.input.is_directive(token) {
            self.input.error(self.input.lexer.span(head), "ActiveTransform needs StartTime, EndTime or All");
            return Err(Reported);
        }
        self.input.lexer.next();
        let word = self.input.lexer.text(token);
        if let Some((_, active)) = Active::WORDS.iter().find(|(w, _)| *w == word) {
            self.state.active = *active;
            return Ok(());
        }
        let word = self.input.describe(token);
        let at = self.input.lexer.span(token);
        self.input.diagnostics.unknown(at, "time", &word, Active::WORDS.iter().map(|w| w.0));
        Err(Reported)
    }

    fn transform_times(&mut self, head: Token) -> Result<(), Reported> {
        let [start, end] = self.input.numbers(head)?;
        if start < end {
            self.world.times = (start, end);
        } else {
            let message =
                format!("the second of the TransformTimes must be later than the first: {start}, {end}");
            self.input.error(self.input.lexer.span(head), message);
        }
        Ok(())
    }
}
