//! Views of the same scene: the picture itself, what casting a ray shows, or what the picture's samples are like.
use durer::{
    Show,
    integrator::Survey,
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
    /// What the integrator's samples are like.
    Survey(Survey),
}

impl Layer {
    /// The words of all.
    pub(crate) fn words() -> Vec<&'static str> {
        let mut words = vec![Self::Beauty.word()];
        words.extend(Show::WORDS);
        words.extend(Survey::ALL.map(Survey::word));
        words
    }

    pub(crate) fn word(self) -> &'static str {
        match self {
            Self::Beauty => "beauty",
            Self::Data(show) => show.word(),
            Self::Survey(survey) => survey.word(),
        }
    }

    pub(crate) fn from_word(word: &str) -> Option<Self> {
        match word {
            "beauty" => Some(Self::Beauty),
            word => {
                let survey = Survey::ALL.into_iter().find(|survey| survey.word() == word);
                survey.map(Self::Survey).or_else(|| Show::from_word(word).map(Self::Data))
            }
        }
    }

    /// The integrator that makes it instead of the session's.
    pub(crate) fn integrator(self) -> Option<Node> {
        match self {
            Self::Beauty | Self::Survey(_) => None,
            Self::Data(show) => Some(Node::new("cast", Params::new().string("show", show.word()))),
        }
    }
}
