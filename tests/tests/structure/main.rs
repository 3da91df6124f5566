//! Rules of the project that the compiler does not check: docs/STYLE.md and ARCHITECTURE.md say them, this guards them.
//!
//! Every rule is a function from texts to complaints, tried on a text that breaks it, then on the project.
mod edges;
mod legal;
mod lines;
mod source;
mod words;

/// Fails with one complaint per line.
fn insist(complaints: Vec<String>) {
    assert!(complaints.is_empty(), "\n{}\n", complaints.join("\n"));
}
