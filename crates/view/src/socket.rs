//! A WebSocket: messages of the page to its session, and what the session says to the page.
use std::{
    sync::{
        Arc,
        atomic::{AtomicU64, Ordering},
    },
    time::Duration,
};

use futures_util::{SinkExt, StreamExt};
use hyper::{HeaderMap, header, upgrade::Upgraded};
use hyper_util::rt::TokioIo;
use tokio::{
    io::{AsyncReadExt, AsyncWriteExt},
    sync::{mpsc, watch},
};
use tokio_tungstenite::{
    WebSocketStream,
    tungstenite::{
        Message as Packet,
        error::{CapacityError, Error},
        handshake::derive_accept_key,
        protocol::{CloseFrame, Role, WebSocketConfig, frame::coding::CloseCode},
    },
};

use crate::{
    session::{Out, Outbox, Request, Session},
    stage::Stage,
};

/// Longest message of a page, in bytes.
const LONGEST: usize = 1 << 20;
/// How long a page may take to read what waits for it.
const PATIENCE: Duration = Duration::from_secs(30);
/// How long a page may take to hang up once it was told why.
const FAREWELL: Duration = Duration::from_millis(500);

type Stream = WebSocketStream<TokioIo<Upgraded>>;

/// What a request for a WebSocket is answered with (RFC 6455, 4.2.2); `None` if it is none.
pub(crate) fn accept(headers: &HeaderMap) -> Option<String> {
    let is = |name: header::HeaderName, word: &str| {
        let values = headers.get_all(name).iter().filter_map(|v| v.to_str().ok());
        values.flat_map(|v| v.split(',')).any(|v| v.trim().eq_ignore_ascii_case(word))
    };
    let asks = is(header::CONNECTION, "upgrade")
        && is(header::UPGRADE, "websocket")
        && is(header::SEC_WEBSOCKET_VERSION, "13");
    let key = headers.get(header::SEC_WEBSOCKET_KEY).filter(|_| asks)?;
    Some(derive_accept_key(key.as_bytes()))
}

/// Sockets in the order in which they were opened.
pub(crate) struct Numbers(AtomicU64);

impl Numbers {
    pub(crate) const fn new() -> Self {
        Self(AtomicU64::new(0))
    }
    fn next(&self) -> u64 {
        self.0.fetch_add(1, Ordering::Relaxed)
    }
}

/// Until one side ends it.
pub(crate) async fn run(
    upgraded: TokioIo<Upgraded>,
    (session, resumed): (Arc<Session>, bool),
    stage: &Stage,
    mut stop: watch::Receiver<bool>,
) {
    let config = WebSocketConfig::default().max_message_size(Some(LONGEST)).max_frame_size(Some(LONGEST));
    let stream: Stream = WebSocketStream::from_raw_socket(upgraded, Role::Server, Some(config)).await;
    let (mut sink, mut packets) = stream.split();
    let number = stage.numbers.next();
    let (outbox, waiting) = Outbox::new(number);
    session.ask(Request::Connect(outbox, resumed));
    stage.viewer_came();
    let writing = async {
        if let Some((code, reason)) = write(&mut sink, waiting).await {
            let close = CloseFrame { code: CloseCode::from(code), reason: reason.into() };
            let _ = tokio::time::timeout(PATIENCE, sink.send(Packet::Close(Some(close)))).await;
        }
    };
    let reading = async {
        while let Some(packet) = packets.next().await {
            match packet {
                Ok(Packet::Text(text)) => session.ask(match serde_json::from_str(&text) {
                    Ok(message) => Request::Said(message),
                    Err(error) => Request::Unreadable(error.to_string()),
                }),
                Ok(Packet::Binary(_)) => {
                    session.ask(Request::Unreadable("binary messages mean nothing here".to_owned()));
                }
                // Answered by the library.
                Ok(Packet::Ping(_) | Packet::Pong(_) | Packet::Frame(_)) => {}
                Ok(Packet::Close(_)) => return None,
                Err(Error::Capacity(CapacityError::MessageTooLong { .. })) => {
                    return Some((1009, "this message is too long"));
                }
                Err(_) => return None,
            }
        }
        None
    };
    let end = tokio::select! {
        () = writing => None,
        end = reading => end,
        _ = stop.wait_for(|stop| *stop) => Some((1001, "durer stops")),
    };
    session.ask(Request::Disconnect(number));
    stage.viewer_left();
    if let Some((code, reason)) = end
        && let Ok(mut stream) = sink.reunite(packets)
    {
        let close = CloseFrame { code: CloseCode::from(code), reason: reason.into() };
        let farewell = async {
            if stream.close(Some(close)).await.is_ok() {
                drain(stream.get_mut()).await;
            }
        };
        let _ = tokio::time::timeout(FAREWELL, farewell).await;
    }
}

/// Reads what still comes until the page hangs up: a socket dropped with unread bytes is reset by the system, and a
/// reset takes the reason away from a page that has not read it yet (RFC 7230, 6.6, tells the same of HTTP).
async fn drain(raw: &mut TokioIo<Upgraded>) {
    let mut waste = vec![0; 1 << 14];
    if raw.shutdown().await.is_ok() {
        while raw.read(&mut waste).await.is_ok_and(|count| count > 0) {}
    }
}

/// Sends what there is until there is no more, the page does not read, or the session wants to end it.
async fn write(
    sink: &mut futures_util::stream::SplitSink<Stream, Packet>,
    mut waiting: mpsc::Receiver<Out>,
) -> Option<(u16, &'static str)> {
    while let Some(out) = waiting.recv().await {
        let packet = match out {
            Out::Text(text) => Packet::Text(text.into()),
            Out::Frame(bytes) => Packet::Binary(bytes.into()),
            Out::Close(code, reason) => return Some((code, reason)),
        };
        match tokio::time::timeout(PATIENCE, sink.send(packet)).await {
            Ok(Ok(())) => {}
            Ok(Err(_)) | Err(_) => return None,
        }
    }
    None
}
