//! A page without a browser: a WebSocket, and requests over HTTP.
use std::{
    io::{Read, Write},
    net::{SocketAddr, TcpStream},
    time::Duration,
};

use durer::Options;
use durer_view::{Config, Live, Look, PageSource};
use serde_json::{Value, json};
use tokio_tungstenite::tungstenite::{Message, WebSocket, client::client};

/// A small picture.
pub(crate) fn small() -> Options {
    Options { width: Some(48), height: Some(36), samples: Some(4), threads: Some(2), ..Options::default() }
}

/// A server of a scene.
pub(crate) fn serve(scene: &str, options: Options) -> Live {
    let config = Config {
        scene: scene.to_owned(),
        options,
        look: Look::default(),
        at: SocketAddr::from(([127, 0, 0, 1], 0)),
        page: PageSource::File(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/live/page.html").into()),
        describe: Box::new(|imported, least| {
            let said = imported.diagnostics.iter().filter(|d| d.severity >= least);
            said.map(|d| d.message.clone()).collect::<Vec<_>>().join("\n")
        }),
    };
    match Live::start(durer::open_for(scene, &config.options), config) {
        Ok(live) => live,
        Err(durer_view::StartError::Scene(imported)) => panic!("{:?}", imported.diagnostics),
        Err(durer_view::StartError::System(error)) => panic!("{error}"),
    }
}

/// The secret in the address.
pub(crate) fn token(live: &Live) -> String {
    live.url().split_once("token=").expect("a token").1.to_owned()
}

/// Sends a request as it stands and returns all of the answer.
pub(crate) fn raw(at: SocketAddr, request: impl AsRef<[u8]>) -> Vec<u8> {
    let mut stream = TcpStream::connect(at).expect("a server");
    stream.set_read_timeout(Some(Duration::from_secs(60))).expect("a timeout");
    // A server that knows enough may stop listening.
    let _ = stream.write_all(request.as_ref());
    let mut answer = Vec::new();
    // A server that breaks off has said what it says.
    let _ = stream.read_to_end(&mut answer);
    answer
}

/// Status, head and body of what a path is answered with.
pub(crate) fn get(live: &Live, path: &str) -> (u16, String, Vec<u8>) {
    let at = live.address();
    let answer = raw(at, format!("GET {path} HTTP/1.1\r\nHost: {at}\r\nConnection: close\r\n\r\n"));
    parts(&answer)
}

/// Cuts an answer into status, head and body.
pub(crate) fn parts(answer: &[u8]) -> (u16, String, Vec<u8>) {
    let end = answer.windows(4).position(|w| w == b"\r\n\r\n").unwrap_or(answer.len());
    let head = String::from_utf8_lossy(&answer[..end]).into_owned();
    let status = head.split(' ').nth(1).and_then(|s| s.parse().ok()).unwrap_or(0);
    (status, head, answer.get(end + 4..).unwrap_or_default().to_vec())
}

/// A frame as the page reads it.
pub(crate) struct Frame {
    pub(crate) head: Value,
    pub(crate) width: u32,
    /// Red, green, blue of every pixel.
    pub(crate) rgb8: Vec<u8>,
}

/// A page.
pub(crate) struct Client {
    socket: WebSocket<TcpStream>,
    pub(crate) hello: Value,
    /// Texts that came while something else was waited for.
    pub(crate) texts: Vec<Value>,
    /// Whether frames are acknowledged.
    pub(crate) acks: bool,
}

impl Client {
    pub(crate) fn new(live: &Live) -> Self {
        Self::with(live, "")
    }

    /// With more in the address.
    pub(crate) fn with(live: &Live, more: &str) -> Self {
        let at = live.address();
        let stream = TcpStream::connect(at).expect("a server");
        stream.set_read_timeout(Some(Duration::from_secs(60))).expect("a timeout");
        let url = format!("ws://{at}/socket?token={}{more}", token(live));
        let (socket, _) = client(url, stream).expect("a handshake");
        let mut new = Self { socket, hello: Value::Null, texts: Vec::new(), acks: true };
        new.hello = new.text("hello");
        new
    }

    pub(crate) fn session(&self) -> String {
        self.hello["session"].as_str().expect("an id").to_owned()
    }

    pub(crate) fn say(&mut self, message: &Value) {
        self.socket.send(Message::text(message.to_string())).expect("sent");
    }

    /// Says what is no message.
    pub(crate) fn mumble(&mut self, text: &str) {
        self.socket.send(Message::text(text)).expect("sent");
    }

    /// The next packet; `None` if the server closed.
    pub(crate) fn packet(&mut self) -> Option<Message> {
        match self.socket.read() {
            Ok(Message::Close(_)) => None,
            Ok(packet) => Some(packet),
            Err(error) => panic!("nothing came: {error}"),
        }
    }

    /// Why the server closes, once it does.
    pub(crate) fn closed(&mut self) -> Option<u16> {
        loop {
            match self.socket.read() {
                Ok(Message::Close(frame)) => return frame.map(|f| f.code.into()),
                Ok(_) => {}
                Err(_) => return None,
            }
        }
    }

    /// The next text of a type; frames on the way are thrown away.
    pub(crate) fn text(&mut self, kind: &str) -> Value {
        if let Some(place) = self.texts.iter().position(|t| t["type"] == kind) {
            return self.texts.remove(place);
        }
        loop {
            match self.packet().expect("an open socket") {
                Message::Text(text) => {
                    let value: Value = serde_json::from_str(&text).expect("JSON");
                    if value["type"] == kind {
                        return value;
                    }
                    self.texts.push(value);
                }
                Message::Binary(bytes) => drop(self.read_frame(&bytes)),
                _ => {}
            }
        }
    }

    /// The next frame.
    pub(crate) fn frame(&mut self) -> Frame {
        loop {
            match self.packet().expect("an open socket") {
                Message::Text(text) => self.texts.push(serde_json::from_str(&text).expect("JSON")),
                Message::Binary(bytes) => return self.read_frame(&bytes),
                _ => {}
            }
        }
    }

    fn read_frame(&mut self, bytes: &[u8]) -> Frame {
        let (length, rest) = bytes.split_at(4);
        let length = u32::from_le_bytes(length.try_into().expect("four bytes")) as usize;
        let (head, png) = rest.split_at(length);
        let head: Value = serde_json::from_slice(head).expect("JSON");
        if self.acks {
            self.say(&json!({ "type": "ack", "frame": head["frame"] }));
        }
        let (width, height, rgb8) = unpacked(png);
        assert_eq!([json!(width), json!(height)], [head["width"].clone(), head["height"].clone()]);
        Frame { head, width, rgb8 }
    }

    /// The first frame for which `is` holds.
    pub(crate) fn frame_when(&mut self, is: impl Fn(&Value) -> bool) -> Frame {
        loop {
            let frame = self.frame();
            if is(&frame.head) {
                return frame;
            }
        }
    }

    /// The finished picture.
    pub(crate) fn finished(&mut self) -> Frame {
        self.frame_when(|head| head["done"] == true)
    }
}

/// Width, height and colours of a PNG.
pub(crate) fn unpacked(png: &[u8]) -> (u32, u32, Vec<u8>) {
    let mut reader = png::Decoder::new(std::io::Cursor::new(png)).read_info().expect("a PNG");
    let mut rgb8 = vec![0; reader.output_buffer_size().expect("a size")];
    let info = reader.next_frame(&mut rgb8).expect("pixels");
    assert_eq!(info.color_type, png::ColorType::Rgb);
    rgb8.truncate(info.buffer_size());
    (info.width, info.height, rgb8)
}
