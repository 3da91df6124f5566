//! Decoders of others that panic at damaged files: what they panic of becomes an error, and nobody needs to read about it.
use std::{
    cell::Cell,
    panic::{self, UnwindSafe, catch_unwind},
    sync::Once,
};

thread_local! {
    static IS_DECODING: Cell<bool> = const { Cell::new(false) };
}

/// What a decoder gives; `None` if it panics.
pub(crate) fn caught<T>(decode: impl FnOnce() -> T + UnwindSafe) -> Option<T> {
    let before = IS_DECODING.replace(true);
    let decoded = catch_unwind(decode).ok();
    IS_DECODING.set(before);
    decoded
}

/// From now on the process's panic hook is not told of panics that are made errors by who reads a file: by default it prints
/// what none of its users can use. For programs; a library leaves the hook to them.
pub fn hush_decoders() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let told = panic::take_hook();
        panic::set_hook(Box::new(move |info| {
            if !IS_DECODING.get() {
                told(info);
            }
        }));
    });
}

#[cfg(test)]
#[allow(clippy::panic, reason = "what is caught")]
mod tests {
    use super::*;

    #[test]
    fn a_panic_is_nothing_and_what_comes_later_is_told_of() {
        assert_eq!(caught(|| 1), Some(1));
        assert_eq!(
            caught(|| if IS_DECODING.get() {
                panic!("damaged")
            }),
            None
        );
        assert!(!IS_DECODING.get());
        // Within each other too.
        assert_eq!(caught(|| (caught(|| panic!("damaged")), IS_DECODING.get())), Some((None::<()>, true)));
    }
}
