//! Who gets in, and what there is to get.
use serde_json::json;

use crate::client::{Client, get, parts, raw, serve, small, token};

fn status(live: &durer_view::Live, request: &str) -> u16 {
    let request = request.replace("HOST", &live.address().to_string()).replace("TOKEN", &token(live));
    parts(&raw(live.address(), &request)).0
}

#[test]
fn the_page_is_sent_to_who_knows_the_token() {
    let live = serve("mirrors", small());
    let (code, head, body) = get(&live, &format!("/?token={}", token(&live)));
    assert_eq!(code, 200, "{head}");
    let lower = head.to_lowercase();
    let policy = lower.lines().find(|l| l.starts_with("content-security-policy")).expect("a policy");
    let nonce = policy.split("'nonce-").nth(1).and_then(|n| n.split('\'').next()).expect("a nonce");
    assert_eq!(String::from_utf8_lossy(&body), format!("<script nonce=\"{nonce}\">1</script>"));
    for part in ["default-src 'none'", "connect-src 'self'", "frame-ancestors 'none'"] {
        assert!(policy.contains(part), "{policy}");
    }
    for line in ["cache-control: no-store", "x-content-type-options: nosniff", "referrer-policy: no-referrer"]
    {
        assert!(lower.contains(line), "{head}");
    }
    assert!(!lower.contains("access-control"), "{head}");
    let other = get(&live, &format!("/?token={}", token(&live))).2;
    assert_ne!(other, body, "a new nonce each time");
}

#[test]
fn strangers_are_refused() {
    let live = serve("mirrors", small());
    let cases = [
        ("GET / HTTP/1.1\r\nHost: HOST\r\n\r\n", 403),
        ("GET /?token=0123456789abcdef0123456789abcdef HTTP/1.1\r\nHost: HOST\r\n\r\n", 403),
        ("GET /?token=TOKEN HTTP/1.1\r\nHost: evil.example\r\n\r\n", 403),
        ("GET /?token=TOKEN HTTP/1.1\r\nHost: HOST\r\nOrigin: http://evil.example\r\n\r\n", 403),
        ("GET /?token=TOKEN HTTP/1.1\r\nHost: HOST\r\nOrigin: null\r\n\r\n", 403),
        ("GET /?token=TOKEN HTTP/1.1\r\n\r\n", 403),
        ("POST /?token=TOKEN HTTP/1.1\r\nHost: HOST\r\nContent-Length: 0\r\n\r\n", 405),
        ("OPTIONS /?token=TOKEN HTTP/1.1\r\nHost: HOST\r\n\r\n", 405),
        ("GET /socket?token=TOKEN HTTP/1.1\r\nHost: HOST\r\n\r\n", 400),
        ("nonsense\r\n\r\n", 400),
    ];
    for (request, expected) in cases {
        let request = request.replace("\r\n\r\n", "\r\nConnection: close\r\n\r\n");
        assert_eq!(status(&live, &request), expected, "{request}");
    }
}

#[test]
fn sockets_are_opened_to_our_own_page_only() {
    let live = serve("mirrors", small());
    let upgrade = "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n\
                   Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n";
    let cases = [
        ("/socket?token=wrong", "HOST", "", 403),
        ("/socket?token=TOKEN", "evil.example", "", 403),
        ("/socket?token=TOKEN", "HOST", "Origin: http://evil.example\r\n", 403),
        ("/other?token=TOKEN", "HOST", "", 404),
    ];
    for (path, host, origin, expected) in cases {
        let request = format!("GET {path} HTTP/1.1\r\nHost: {host}\r\n{origin}{upgrade}\r\n");
        assert_eq!(
            status(&live, &request.replace("Connection: Upgrade", "Connection: close, Upgrade")),
            expected
        );
    }
}

#[test]
fn there_is_no_way_to_files() {
    let live = serve("mirrors", small());
    let paths = [
        "/etc/passwd",
        "/../../../../etc/passwd",
        "/%2e%2e/%2e%2e/etc/passwd",
        "/..%2f..%2fetc%2fpasswd",
        "//etc/passwd",
        "/Cargo.toml",
        "/index.html",
        "/save/../../Cargo.toml",
    ];
    for path in paths {
        let (code, _, body) = get(&live, &format!("{path}?token={}", token(&live)));
        assert_eq!((code, &*body), (404, b"there is nothing here\n".as_slice()), "{path}");
    }
    for (query, expected) in [("format=png&session=no", 404), ("format=../x&session=no", 400), ("", 400)] {
        assert_eq!(get(&live, &format!("/save?token={}&{query}", token(&live))).0, expected, "{query}");
    }
}

#[test]
fn what_cannot_be_read_is_answered_and_what_is_too_long_ends_it() {
    let live = serve("mirrors", small());
    let mut page = Client::new(&live);
    for text in ["nonsense", "{}", "[1]", "{\"type\":\"trace\",\"id\":1,\"x\":-1,\"y\":0}", "\"\\ud800\""] {
        page.mumble(text);
        assert_eq!(page.text("error")["about"], "protocol", "{text}");
    }
    page.say(&json!({ "type": "pick", "id": 1, "x": 3, "y": 4 }));
    assert_eq!(page.text("pick")["id"], 1, "and it goes on");
    // More than the system keeps for who does not read: the reason arrives all the same.
    page.mumble(&"x".repeat(1 << 25));
    assert_eq!(page.closed(), Some(1009));
}

#[test]
fn it_stops_at_once_and_says_goodbye() {
    let live = serve("cornell", durer::Options { samples: Some(100_000), ..small() });
    let mut page = Client::new(&live);
    page.frame();
    let at = live.address();
    drop(live);
    assert_eq!(page.closed(), Some(1001));
    assert!(std::net::TcpStream::connect(at).is_err(), "nobody listens any more");
}
