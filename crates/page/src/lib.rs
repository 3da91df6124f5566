//! The HTML pages, each one file with program and style, made from `page/` by `cargo xtask page`: the offline page that
//! shows a ray tree, and the live page that `durer view` serves.
//!
//! Where they were not built, for want of Node, [`html`] and [`live`] say so and all else of durer works.
#![forbid(unsafe_code)]

use std::{error::Error, fmt};

/// The page with [`MARKER`] in place of the data.
#[cfg(page_built)]
const PAGE: Option<&str> = Some(include_str!("../dist/durer.html"));
/// No page.
#[cfg(not(page_built))]
const PAGE: Option<&str> = None;

/// The live page with [`NONCE_MARKER`] at its script and its style.
#[cfg(live_built)]
const LIVE: Option<&str> = Some(include_str!("../dist/view.html"));
/// No live page.
#[cfg(not(live_built))]
const LIVE: Option<&str> = None;

/// Stands in the live page at each script and style element, in place of the nonce that the Content-Security-Policy of
/// the answer names.
pub const NONCE_MARKER: &str = "__DURER_NONCE__";

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

/// The page of `durer view`, with [`NONCE_MARKER`] where a nonce must be put. It has no policy of its own: the answer's
/// header sets it.
///
/// # Errors
/// If the page was not built.
pub fn live() -> Result<&'static str, NotBuilt> {
    LIVE.ok_or(NotBuilt)
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

    #[test]
    fn the_live_page_runs_under_a_nonce_and_loads_nothing() {
        let Ok(page) = live() else {
            assert_eq!(live(), Err(NotBuilt));
            return;
        };
        assert_eq!(page.matches(NONCE_MARKER).count(), 2);
        assert!(page.contains("<script type=\"module\" nonce=\"__DURER_NONCE__\">"));
        assert!(page.contains("<style nonce=\"__DURER_NONCE__\">") && !page.contains("http-equiv"));
        assert!(
            !page.contains("<script src")
                && !page.contains("<link rel=\"stylesheet\"")
                && page.len() < 900_000
        );
    }
}
