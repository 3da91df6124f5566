//! Views of the same scene: the picture itself, or what casting a ray shows.
use durer::{
    Show,
    scene::{Node, Params},
};

/// What is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Layer {
    /// What the integrator makes.
    #[default]
    Beauty,
    /// What is hit.
    Data(Show),
}

impl Layer {
    /// The words of all.
    pub(crate) fn words() -> Vec<&'static str> {
        let mut words = vec![Self::Beauty.word()];
        words.extend(Show::WORDS);
        words
    }

    pub(crate) fn word(self) -> &'static str {
        match self {
            Self::Beauty => "beauty",
            Self::Data(show) => show.word(),
        }
    }

    pub(crate) fn from_word(word: &str) -> Option<Self> {
        match word {
            "beauty" => Some(Self::Beauty),
            word => Show::from_word(word).map(Self::Data),
        }
    }

    /// The integrator that makes it instead of the session's.
    pub(crate) fn integrator(self) -> Option<Node> {
        match self {
            Self::Beauty => None,
            Self::Data(show) => Some(Node::new("cast", Params::new().string("show", show.word()))),
        }
    }
}
