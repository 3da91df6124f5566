//! Nodes that name others of their family: a mixture of materials.
use super::{
    super::{Entry, find},
    Args,
};
use crate::Diagnostics;

impl Args<'_> {
    /// What the node called `word` builds, which parameter `name` names, once more; complains if there is none before this
    /// one, or if it cannot be built. What there is to complain about the other node itself is left to those who build it.
    pub fn build_named<T>(&mut self, name: &str, word: &str, registry: &[Entry<T>]) -> Option<T> {
        // Each level may build two of the one below.
        const MOST_NESTED: u32 = 6;
        let before = self.before;
        let place = before.iter().rposition(|other| other.name == word);
        let Some((node, earlier)) = place.and_then(|i| Some((&before.get(i)?.node, before.get(..i)?))) else {
            let at = self.place(name);
            self.sound = false;
            self.diagnostics.unknown(at, name, word, before.iter().map(|other| other.name.as_str()));
            return None;
        };
        let mut unheard = Diagnostics::default();
        let built = find(registry, name, node, &mut unheard).filter(|_| self.nested < MOST_NESTED).and_then(
            |entry| {
                let mut args = Args::check(node, entry.schema, self.textures, &mut unheard);
                (args.names, args.assets) = (self.names, self.assets);
                (args.before, args.nested) = (earlier, self.nested + 1);
                let built = (entry.build)(&mut args);
                args.is_sound().then_some(built).flatten()
            },
        );
        if built.is_none() {
            self.error(name, format!("\"{word}\" cannot be used in another one"));
        }
        built
    }
}
