//! Decoders of others that panic at damaged files: what they panic of becomes an error, and nobody needs to read about it.
use std::{
    panic,
    sync::Once,
    thread::{self, Builder},
};

/// The threads that decode, known to the hook by their name: so nothing has to be kept of who is decoding.
const DECODER: &str = "durer-decoder";

/// What a decoder gives; `None` if it panics.
pub(crate) fn caught<T: Send>(decode: impl FnOnce() -> T + Send) -> Option<T> {
    thread::scope(|scope| Builder::new().name(DECODER.into()).spawn_scoped(scope, decode).ok()?.join().ok())
}

/// From now on the process's panic hook is not told of panics that are made errors by who reads a file: by default it prints
/// what none of its users can use. For programs; a library leaves the hook to them.
pub fn hush_decoders() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let told = panic::take_hook();
        panic::set_hook(Box::new(move |info| {
            if !is_decoder() {
                told(info);
            }
        }));
    });
}

fn is_decoder() -> bool {
    thread::current().name() == Some(DECODER)
}

#[cfg(test)]
#[allow(clippy::panic, reason = "what is caught")]
mod tests {
    use super::*;

    #[test]
    fn a_panic_is_nothing_and_only_decoders_are_not_told_of() {
        assert_eq!(caught(is_decoder), Some(true));
        assert_eq!(caught(|| panic!("damaged")), None::<()>);
        assert!(!is_decoder());
        // Within each other too.
        assert_eq!(caught(|| (caught(|| panic!("damaged")), is_decoder())), Some((None::<()>, true)));
    }
}
