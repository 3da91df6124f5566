//! Where the page comes from, and what is shown where there is none.

/// Where the page wants a number that is new at each request: scripts and styles without it are not run.
const NONCE: &str = "__DURER_NONCE__";

/// The page.
#[derive(Clone, Debug)]
pub enum PageSource {
    /// As it was built, with a marker where a nonce goes.
    Built(&'static str),
    /// A file that is read again at each request: for those who work on the page.
    File(std::path::PathBuf),
    /// There is none: why, in words.
    Missing(String),
}

impl PageSource {
    /// What is sent.
    pub(crate) fn html(&self, nonce: &str) -> String {
        match self {
            Self::Built(page) => page.replace(NONCE, nonce),
            Self::File(file) => match std::fs::read_to_string(file) {
                Ok(page) => page.replace(NONCE, nonce),
                Err(error) => excuse(&format!("{}: {error}", file.display())),
            },
            Self::Missing(why) => excuse(why),
        }
    }
}

/// A page without anything.
fn excuse(why: &str) -> String {
    let why = why.replace('&', "&amp;").replace('<', "&lt;");
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<head><meta charset=\"utf-8\"><title>durer</title></head>\n\
         <body><h1>There is no page to show</h1><p>{why}</p></body>\n</html>\n"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nonce_goes_everywhere_and_texts_are_no_markup() {
        let page =
            PageSource::Built("<script nonce=\"__DURER_NONCE__\"></script><style nonce=\"__DURER_NONCE__\">");
        assert_eq!(page.html("n1"), "<script nonce=\"n1\"></script><style nonce=\"n1\">");
        assert!(PageSource::Missing("<script>".to_owned()).html("").contains("&lt;script>"));
    }
}
