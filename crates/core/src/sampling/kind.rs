//! Kinds of sampler and their words.

/// How sample indices become numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SamplerKind {
    /// Owen-scrambled Sobol pairs, padded: stratified in every pair of numbers, random between pairs and between pixels.
    PaddedSobol,
    /// Unrelated random numbers.
    Independent,
    /// One random number in each cell of a grid, cells in random order (Cook 1984): stratified in every pair of numbers
    /// and in every single number, random between them.
    Stratified,
    /// The middles of those cells.
    Regular,
    /// Halton points with Owen-scrambled digits: along the first vertices of a path every number has a prime of its own as
    /// its base, so that all of them together are stratified. Random between pixels.
    Halton,
    /// Owen-scrambled Sobol points of many dimensions: all numbers of eye and first hit are stratified together, later
    /// those that decide one thing, such as lobe and direction. Random between pixels.
    Sobol,
    /// The same points dealt out along a curve through the picture, so that neighbouring pixels get points that complete
    /// each other and what is left of the noise is fine-grained (Ahmed and Wonka 2020).
    #[default]
    ZSobol,
}

impl SamplerKind {
    /// All kinds, in the order of their numbers.
    pub const ALL: [Self; 7] = [
        Self::PaddedSobol,
        Self::Independent,
        Self::Stratified,
        Self::Regular,
        Self::Halton,
        Self::Sobol,
        Self::ZSobol,
    ];

    /// Its word in scene files, but for [`Self::Regular`]: there it is `stratified` without jitter.
    pub fn word(self) -> &'static str {
        match self {
            Self::PaddedSobol => "paddedsobol",
            Self::Independent => "independent",
            Self::Stratified => "stratified",
            Self::Regular => "regular",
            Self::Halton => "halton",
            Self::Sobol => "sobol",
            Self::ZSobol => "zsobol",
        }
    }

    /// The kind of which [`Self::word`] is `word`.
    pub fn from_word(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.word() == word)
    }

    /// Whether its numbers depend on how many ways were taken since the eye.
    #[inline]
    pub(super) fn counts_forks(self) -> bool {
        matches!(self, Self::Halton | Self::Sobol | Self::ZSobol)
    }

    /// Whether its points are dealt out over the whole picture.
    #[inline]
    pub(super) fn spans_pixels(self) -> bool {
        self == Self::ZSobol
    }
}
