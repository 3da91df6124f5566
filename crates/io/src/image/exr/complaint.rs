//! What is said about damaged OpenEXR files: which part is damaged, in words of this program.
use durer_scene::AssetError;
use exr::error::Error;

use super::super::source::Source;

pub(super) const WHAT: &str = "OpenEXR file";

/// What the library says when the file ends.
const END: &str = "reference to missing bytes";

/// What the library's errors about headers, which differ in their texts only, mean.
const HEADER: &[(&str, &str)] = &[
    ("not sorted", "its channels are not sorted by name"),
    ("not unique", "two of its channels share a name"),
    ("at least one channel", "it has no channels"),
    ("compression method", "its header names a compression that OpenEXR 2 does not have"),
    ("empty d", "its header says that it has no pixels"),
    ("duplicate attribute", "its header says something twice"),
    ("", "its header makes no sense"),
];

const PIXELS: &[(&str, &str)] = &[
    ("offset table", "its list of blocks makes no sense"),
    ("chunk start", "its list of blocks makes no sense"),
    ("block position", "its header and its pixels contradict each other"),
    ("tile", "its header and its pixels contradict each other"),
];

/// What is wrong with the header.
pub(super) fn header(source: &Source<'_>, error: &Error) -> AssetError {
    let (Error::Invalid(said) | Error::NotSupported(said)) = error else {
        return source.damaged(WHAT, "its header makes no sense");
    };
    if said == END {
        return source.cut(WHAT, "its header");
    }
    if said.contains("flags") || said.contains("file versions") {
        return source.format_error(
            "an OpenEXR file with an unknown version or unknown flags; export it as OpenEXR 2, or copy it again",
        );
    }
    let entry = said.strip_prefix("missing or invalid ").and_then(|s| s.strip_suffix(" attribute"));
    match entry.filter(|e| e.chars().all(|c| c.is_ascii_alphabetic() || c == ' ')) {
        Some(entry) => {
            source.damaged(WHAT, &format!("the entry \"{entry}\" of its header is missing or wrong"))
        }
        None => source.translated(WHAT, said, HEADER),
    }
}

/// What is wrong with the rest.
pub(super) fn pixels(source: &Source<'_>, error: &Error) -> AssetError {
    match error {
        Error::Invalid(said) if said == END => {
            let reason = "blocks of pixels are missing (it ends too early, or its list of blocks is wrong)";
            source.damaged(WHAT, reason)
        }
        Error::Invalid(said) => match said.strip_prefix("compressed ") {
            Some(method) => {
                let method: String = method.chars().take_while(char::is_ascii_alphanumeric).collect();
                source.damaged(WHAT, &format!("its pixel data cannot be decoded ({method} compression)"))
            }
            None => source.translated(WHAT, said, PIXELS),
        },
        Error::NotSupported(_) => source.unsupported(
            "an OpenEXR file with a compression that durer does not read; save it with ZIP compression",
        ),
        _ => source.damaged(WHAT, "its pixel data cannot be decoded"),
    }
}
