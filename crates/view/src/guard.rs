//! Who may ask: those who know the token, through a name of ours, from our own page.
//!
//! A page of somebody else, open in the same browser, can send requests to this machine. It does not know the token; it
//! cannot learn it, as nothing of ours allows other origins; a name of its own that leads here (DNS rebinding) stands in
//! `Host` and is refused; and browsers say in `Origin` who opens a WebSocket.
use std::net::{IpAddr, SocketAddr};

use hyper::{HeaderMap, StatusCode, Uri, header};

/// What a request must show.
#[derive(Clone, Debug)]
pub(crate) struct Guard {
    /// The secret.
    pub(crate) token: String,
    /// Where the server listens.
    pub(crate) at: SocketAddr,
}

/// Why a request is refused.
pub(crate) type Refusal = (StatusCode, &'static str);

impl Guard {
    /// A guard with a new secret of 128 bits.
    ///
    /// # Errors
    /// If the system has no randomness.
    pub(crate) fn new(at: SocketAddr) -> Result<Self, getrandom::Error> {
        Ok(Self { token: secret()?, at })
    }

    /// Lets a request pass.
    pub(crate) fn check(&self, uri: &Uri, headers: &HeaderMap) -> Result<(), Refusal> {
        let text = |name: header::HeaderName| {
            let mut values = headers.get_all(name).iter();
            match (values.next(), values.next()) {
                (None, _) => Ok(None),
                (Some(value), None) => value.to_str().map(Some).map_err(|_| ()),
                (Some(_), Some(_)) => Err(()),
            }
        };
        let foreign = (StatusCode::FORBIDDEN, "this server does not answer to that host name");
        let host = text(header::HOST).map_err(|()| foreign)?.ok_or(foreign)?;
        if !self.is_ours(host) {
            return Err(foreign);
        }
        let stranger = (StatusCode::FORBIDDEN, "requests of other pages are refused");
        if let Some(origin) = text(header::ORIGIN).map_err(|()| stranger)?
            && origin != format!("http://{host}")
        {
            return Err(stranger);
        }
        let token = asked(uri, "token").unwrap_or_default();
        if !same(token.as_bytes(), self.token.as_bytes()) {
            return Err((
                StatusCode::FORBIDDEN,
                "the token in the address is wrong: take the address that durer printed",
            ));
        }
        Ok(())
    }

    /// Whether a `Host` is one of ours: an address and not a name, as names can be made to lead anywhere; `localhost`
    /// cannot.
    fn is_ours(&self, host: &str) -> bool {
        let (name, port) = match host.rsplit_once(':') {
            Some((name, port)) if port.bytes().all(|b| b.is_ascii_digit()) => (name, port.parse().ok()),
            _ => (host, Some(80)),
        };
        let address = name.strip_prefix('[').and_then(|name| name.strip_suffix(']')).unwrap_or(name);
        let ours = |ip: IpAddr| match self.at.ip() {
            bound if bound.is_unspecified() => true,
            bound => ip == bound || bound.is_loopback() && ip.is_loopback(),
        };
        let named = name.eq_ignore_ascii_case("localhost") || address.parse().is_ok_and(ours);
        named && port == Some(self.at.port())
    }
}

/// 128 bits as hexadecimal digits.
pub(crate) fn secret() -> Result<String, getrandom::Error> {
    let mut bytes = [0; 16];
    getrandom::fill(&mut bytes)?;
    Ok(bytes.iter().map(|b| format!("{b:02x}")).collect())
}

/// The value of `key` in the address. Ours are words and numbers: nothing is decoded.
pub(crate) fn asked<'u>(uri: &'u Uri, key: &str) -> Option<&'u str> {
    let pairs = uri.query()?.split('&').filter_map(|pair| pair.split_once('='));
    pairs.filter(|(name, _)| *name == key).map(|(_, value)| value).next()
}

/// Compares in a time that does not tell where they differ.
fn same(a: &[u8], b: &[u8]) -> bool {
    a.len() == b.len() && a.iter().zip(b).fold(0, |differs, (a, b)| differs | (a ^ b)) == 0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn guard() -> Guard {
        Guard { token: "abc".to_owned(), at: SocketAddr::from(([127, 0, 0, 1], 8642)) }
    }

    fn check(uri: &str, headers: &[(header::HeaderName, &str)]) -> Result<(), StatusCode> {
        let headers = headers.iter().map(|(name, value)| (name.clone(), value.parse().expect("a header")));
        guard().check(&uri.parse().expect("an address"), &headers.collect()).map_err(|refusal| refusal.0)
    }

    #[test]
    fn our_own_page_passes() {
        for host in ["127.0.0.1:8642", "localhost:8642", "LOCALHOST:8642", "[::1]:8642"] {
            assert_eq!(check("/?token=abc", &[(header::HOST, host)]), Ok(()), "{host}");
        }
        let origin = (header::ORIGIN, "http://localhost:8642");
        assert_eq!(check("/socket?session=9&token=abc", &[(header::HOST, "localhost:8642"), origin]), Ok(()));
    }

    #[test]
    fn strangers_do_not() {
        let host = (header::HOST, "localhost:8642");
        for uri in ["/", "/?token=", "/?token=abd", "/?token=abcd", "/?nottoken=abc", "/?x=token=abc"] {
            assert_eq!(check(uri, std::slice::from_ref(&host)), Err(StatusCode::FORBIDDEN), "{uri}");
        }
        for name in [
            "evil.example:8642",
            "localhost.evil.example:8642",
            "localhost",
            "localhost:80",
            "10.0.0.1:8642",
            "",
        ] {
            assert_eq!(check("/?token=abc", &[(header::HOST, name)]), Err(StatusCode::FORBIDDEN), "{name}");
        }
        assert_eq!(check("/?token=abc", &[]), Err(StatusCode::FORBIDDEN), "no host");
        for origin in ["http://evil.example", "https://localhost:8642", "null", "http://127.0.0.1:8642"] {
            let headers = [host.clone(), (header::ORIGIN, origin)];
            assert_eq!(check("/?token=abc", &headers), Err(StatusCode::FORBIDDEN), "{origin}");
        }
    }

    #[test]
    fn secrets_are_long_and_new() {
        let (a, b) = (secret().expect("randomness"), secret().expect("randomness"));
        assert!(a.len() == 32 && a != b);
    }
}
