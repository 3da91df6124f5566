//! The offline HTML page that shows a ray tree: one file with program, style and data, made from `page/` by
//! `cargo xtask page`.
//!
//! Where it was not built, for want of Node, [`html`] says so and all else of durer works.
#![forbid(unsafe_code)]

use std::{error::Error, fmt};

/// The page with [`MARKER`] in place of the data.
#[cfg(page_built)]
const PAGE: Option<&str> = Some(include_str!("../dist/durer.html"));
/// No page.
#[cfg(not(page_built))]
const PAGE: Option<&str> = None;

/// Where the data goes.
const MARKER: &str = "__DURER_DATA__";

/// This durer was built without the page.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NotBuilt;

impl fmt::Display for NotBuilt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(
            "this durer was built without the HTML page: run `cargo xtask page` (needs Node), then build durer again",
        )
    }
}

impl Error for NotBuilt {}

/// True if [`html`] can write pages.
pub fn is_built() -> bool {
    PAGE.is_some()
}

/// The page that shows `data`: a document as `docs/json.md` describes it, compressed by gzip, as base64. Other bytes
/// than those of base64 are left out.
///
/// # Errors
/// If the page was not built.
pub fn html(data: &[u8]) -> Result<String, NotBuilt> {
    let page = PAGE.ok_or(NotBuilt)?;
    Ok(filled(page, data))
}

/// Puts the data at the marker, and nothing that could end the element around it.
fn filled(page: &str, data: &[u8]) -> String {
    let (before, behind) = page.split_once(MARKER).unwrap_or((page, ""));
    let mut html = String::with_capacity(page.len() + data.len());
    html.push_str(before);
    let harmless = |byte: &&u8| byte.is_ascii_alphanumeric() || matches!(byte, b'+' | b'/' | b'=');
    html.extend(data.iter().filter(harmless).map(|&byte| char::from(byte)));
    html.push_str(behind);
    html
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn data_goes_to_the_marker_and_nowhere_else() {
        assert_eq!(filled("<a>__DURER_DATA__</a>", b"H4sI+/=="), "<a>H4sI+/==</a>");
    }

    #[test]
    fn what_is_not_base64_does_not_get_into_the_page() {
        assert_eq!(filled("<a>__DURER_DATA__</a>", b"H</a><script>"), "<a>H/ascript</a>");
    }

    #[test]
    fn the_built_page_has_one_marker_and_asks_for_nothing() {
        let Some(page) = PAGE else {
            assert_eq!(html(b""), Err(NotBuilt));
            return;
        };
        assert_eq!(page.matches(MARKER).count(), 1);
        assert!(page.contains("default-src 'none'"), "a page from disk must not be able to load anything");
        assert!(
            !page.contains("<link rel=\"stylesheet\"")
                && !page.contains("<script src")
                && page.len() < 800_000
        );
        assert!(html(b"H4sI").is_ok_and(|html| html.contains(">H4sI</script>")));
    }
}
