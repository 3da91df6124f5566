//! `durer view` as a program: its address, its words, its end.
use std::{
    io::{BufRead, BufReader, Read, Write},
    net::TcpStream,
    process::{Child, ChildStdout, Command, Stdio},
    time::Duration,
};

use serde_json::{Value, json};
use tokio_tungstenite::tungstenite::{Message, WebSocket, client::client};

use crate::run::Place;

/// A server; ends with this.
struct Server {
    child: Child,
    stdout: BufReader<ChildStdout>,
    url: String,
}

impl Server {
    fn start(place: &Place, words: &str) -> Self {
        let mut child = place
            .command(&format!("view {words}"))
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("durer runs");
        let mut stdout = BufReader::new(child.stdout.take().expect("a pipe"));
        let mut url = String::new();
        stdout.read_line(&mut url).expect("a line");
        Self { child, stdout, url: url.trim_end().to_owned() }
    }

    fn place_and_query(&self) -> (&str, &str) {
        let rest = self.url.strip_prefix("http://").expect("an address");
        rest.split_once("/?").expect("a query")
    }

    fn socket(&self) -> WebSocket<TcpStream> {
        let (at, token) = self.place_and_query();
        let stream = TcpStream::connect(at).expect("a server");
        stream.set_read_timeout(Some(Duration::from_secs(60))).expect("a timeout");
        client(format!("ws://{at}/socket?{token}"), stream).expect("a handshake").0
    }

    /// Everything on stderr, after its end by Ctrl-C.
    fn interrupt(mut self) -> (Option<i32>, String) {
        let sent = Command::new("kill").args(["-INT", &self.child.id().to_string()]).status();
        assert!(sent.expect("kill runs").success());
        let mut rest = String::new();
        self.stdout.read_to_string(&mut rest).expect("the rest");
        assert_eq!(rest, "", "stdout holds the address only");
        let mut said = String::new();
        let stderr = self.child.stderr.as_mut().expect("a pipe");
        stderr.read_to_string(&mut said).expect("text");
        (self.child.wait().expect("an end").code(), said)
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// The next text of a type.
fn text(socket: &mut WebSocket<TcpStream>, kind: &str) -> Value {
    loop {
        if let Message::Text(text) = socket.read().expect("an open socket") {
            let value: Value = serde_json::from_str(&text).expect("JSON");
            if value["type"] == kind {
                return value;
            }
        }
    }
}

/// Words and numbers that both have are the same; what the page leaves out is null, nothing or a default.
fn same(page: &Value, printed: &Value, place: &str) {
    match (page, printed) {
        (Value::Object(page), Value::Object(printed)) => {
            for (key, value) in page.iter().filter(|(key, _)| *key != "ns" && *key != "walk") {
                same(value, printed.get(key).unwrap_or(&Value::Null), &format!("{place}.{key}"));
            }
        }
        (Value::Array(page), Value::Array(printed)) => {
            assert_eq!(page.len(), printed.len(), "{place}");
            page.iter().zip(printed).for_each(|(a, b)| same(a, b, place));
        }
        (page, printed) => assert_eq!(page, printed, "{place}"),
    }
}

#[test]
fn a_click_has_the_numbers_that_trace_prints() {
    let place = Place::new();
    let options = "whitted --width 40 --height 30 --spp 4 --max-depth 6 --seed 3";
    let server = Server::start(&place, options);
    let mut socket = server.socket();
    socket
        .send(Message::text(json!({ "type": "trace", "id": 1, "x": 18, "y": 14, "sample": 2 }).to_string()))
        .expect("sent");
    let answer = text(&mut socket, "trace");
    let printed = place.done(&format!("trace {options} --pixel 18,14 --sample 2 --json")).stdout;
    let printed: Value = serde_json::from_str(&printed).expect("JSON");
    let tree = &answer["page"]["trees"][0];
    assert_eq!(tree["nodes"].as_array().map(Vec::len), printed["nodes"].as_array().map(Vec::len));
    assert_eq!(tree["rgb"], printed["rgb"]);
    same(tree, &printed, "tree");
}

#[test]
#[cfg(unix)]
fn ctrl_c_stops_it_at_once_whatever_it_does() {
    let place = Place::new();
    let server = Server::start(&place, "cornell --integrator path --spp 100000");
    let mut socket = server.socket();
    text(&mut socket, "hello");
    // A question that takes a while, and a picture that never ends.
    socket
        .send(Message::text(
            json!({ "type": "trace", "id": 1, "x": 640, "y": 360, "samples": true }).to_string(),
        ))
        .expect("sent");
    let (code, said) = server.interrupt();
    assert_eq!(code, Some(130), "{said}");
    assert!(said.contains("Ctrl-C stops"), "{said}");
    let end = loop {
        match socket.read() {
            Ok(Message::Close(frame)) => break frame.map(|f| u16::from(f.code)),
            Ok(_) => {}
            Err(_) => break Some(0),
        }
    };
    assert_eq!(end, Some(1001), "and says goodbye");
}

#[test]
fn the_address_is_of_this_machine_and_has_a_secret() {
    let place = Place::new();
    let server = Server::start(&place, "mirrors --width 8 --height 8 --quiet");
    let (at, query) = server.place_and_query();
    assert!(at.starts_with("127.0.0.1:"), "{at}");
    assert!(query.strip_prefix("token=").is_some_and(|t| t.len() == 32), "{query}");
    let mut stream = TcpStream::connect(at).expect("a server");
    write!(stream, "GET / HTTP/1.1\r\nHost: {at}\r\nConnection: close\r\n\r\n").expect("sent");
    let mut answer = String::new();
    stream.read_to_string(&mut answer).expect("text");
    assert!(answer.starts_with("HTTP/1.1 403 "), "{answer}");
}

#[test]
fn what_cannot_be_shown_is_said_before_anything_starts() {
    let place = Place::new().with("broken.pbrt", "WorldBegin\nShape \"spere\"\n");
    let cases = [
        ("view broken.pbrt", 1, "spere"),
        ("view nothing.pbrt", 1, "no such file"),
        ("view --antialias adaptive", 2, "supersampled"),
        ("view --camera nobody", 2, "nobody"),
        ("view --port 99999", 2, "port"),
        ("view --bind here", 2, "bind"),
        ("view --bind 192.0.2.1", 1, "192.0.2.1"),
    ];
    for (words, code, expected) in cases {
        let ran = place.run(words);
        assert_eq!(ran.code, code, "durer {words}\n{}", ran.stderr);
        assert!(ran.stderr.contains(expected) && ran.stdout.is_empty(), "durer {words}\n{}", ran.stderr);
    }
    let server = Server::start(&place, "mirrors --width 8 --height 8");
    let port = server.place_and_query().0.rsplit(':').next().expect("a port").to_owned();
    let ran = place.run(&format!("view mirrors --port {port}"));
    assert!(ran.code == 1 && ran.stderr.contains("take another --port"), "{}", ran.stderr);
}
