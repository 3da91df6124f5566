//! HTTP: the page, the door to the WebSocket, files to keep. Nothing else, and nothing from disk.
use std::{convert::Infallible, net::SocketAddr, sync::Arc, time::Duration};

use http_body_util::Full;
use hyper::{
    Method, Request, Response, StatusCode,
    body::{Bytes, Incoming},
    header::{self, HeaderValue},
    server::conn::http1,
    service::service_fn,
};
use hyper_util::rt::{TokioIo, TokioTimer};
use tokio::{
    net::{TcpListener, TcpStream},
    sync::{Semaphore, oneshot, watch},
};

use crate::{
    develop::developed,
    guard::{Guard, asked, secret},
    page::PageSource,
    save::{File, SaveFormat},
    session::{self, Session},
    socket,
    stage::Stage,
};

/// Connections at once.
const MOST_CONNECTIONS: usize = 256;
/// How long a request may take to come in.
const PATIENCE: Duration = Duration::from_secs(10);

/// What requests are answered with.
pub(crate) struct Server {
    pub(crate) guard: Guard,
    pub(crate) stage: Arc<Stage>,
    pub(crate) page: PageSource,
    /// One picture is developed at a time.
    pub(crate) developing: Semaphore,
    /// True once the server stops.
    pub(crate) stop: watch::Receiver<bool>,
}

type Answer = Response<Full<Bytes>>;

impl Server {
    /// Answers until it is told to stop.
    pub(crate) async fn run(self: Arc<Self>, listener: TcpListener) {
        let room = Arc::new(Semaphore::new(MOST_CONNECTIONS));
        let mut stop = self.stop.clone();
        loop {
            let accepted = tokio::select! {
                accepted = listener.accept() => accepted,
                _ = stop.wait_for(|stop| *stop) => return,
            };
            let (Ok((stream, from)), Ok(place)) = (accepted, Arc::clone(&room).try_acquire_owned()) else {
                // Out of files or of places: whoever knocks again may be luckier.
                tokio::time::sleep(Duration::from_millis(20)).await;
                continue;
            };
            let server = Arc::clone(&self);
            tokio::spawn(async move {
                server.serve(stream, from).await;
                drop(place);
            });
        }
    }

    async fn serve(self: Arc<Self>, stream: TcpStream, _from: SocketAddr) {
        // Frames are whole: waiting for more only makes them late.
        let _ = stream.set_nodelay(true);
        let service = service_fn(|request| {
            let server = Arc::clone(&self);
            async move { Ok::<_, Infallible>(server.answer(request).await) }
        });
        let mut http = http1::Builder::new();
        http.timer(TokioTimer::new()).header_read_timeout(PATIENCE).max_buf_size(32 << 10);
        // Who breaks off has his reasons.
        let _ = http.serve_connection(TokioIo::new(stream), service).with_upgrades().await;
    }

    async fn answer(self: Arc<Self>, mut request: Request<Incoming>) -> Answer {
        if let Err((status, why)) = self.guard.check(request.uri(), request.headers()) {
            return text(status, why);
        }
        let (needed, words) = match request.uri().path() {
            "/develop" => (Method::POST, "POST"),
            _ => (Method::GET, "GET"),
        };
        if request.method() != needed {
            let mut refused =
                text(StatusCode::METHOD_NOT_ALLOWED, "only GET is answered, and POST by /develop");
            refused.headers_mut().insert(header::ALLOW, HeaderValue::from_static(words));
            return refused;
        }
        match request.uri().path() {
            "/develop" => self.develop(request).await,
            "/" => self.page(),
            "/socket" => self.socket(&mut request),
            "/save" => self.save(&request).await,
            _ => text(StatusCode::NOT_FOUND, "there is nothing here"),
        }
    }

    fn page(&self) -> Answer {
        let Ok(nonce) = secret() else {
            return text(StatusCode::INTERNAL_SERVER_ERROR, "the system has no random numbers");
        };
        let html = self.page.html(&nonce);
        let policy = format!(
            "default-src 'none'; script-src 'nonce-{nonce}'; style-src 'nonce-{nonce}'; img-src 'self' data: blob:; \
             connect-src 'self'; frame-ancestors 'none'; base-uri 'none'; form-action 'none'"
        );
        let mut answer = plain(StatusCode::OK, "text/html; charset=utf-8", html.into());
        if let Ok(policy) = policy.parse() {
            answer.headers_mut().insert(header::CONTENT_SECURITY_POLICY, policy);
        }
        answer
    }

    fn socket(self: &Arc<Self>, request: &mut Request<Incoming>) -> Answer {
        let Some(accept) = socket::accept(request.headers()) else {
            return text(StatusCode::BAD_REQUEST, "this address is for WebSockets");
        };
        let Some((session, resumed)) = self.session(request) else {
            return text(StatusCode::SERVICE_UNAVAILABLE, "too many viewers");
        };
        let (stage, stop) = (Arc::clone(&self.stage), self.stop.clone());
        let upgrade = hyper::upgrade::on(request);
        tokio::spawn(async move {
            if let Ok(upgraded) = upgrade.await {
                socket::run(TokioIo::new(upgraded), (session, resumed), &stage, stop).await;
            }
        });
        let mut answer = plain(StatusCode::SWITCHING_PROTOCOLS, "", Bytes::new());
        let headers = answer.headers_mut();
        headers.clear();
        headers.insert(header::CONNECTION, HeaderValue::from_static("Upgrade"));
        headers.insert(header::UPGRADE, HeaderValue::from_static("websocket"));
        if let Ok(accept) = accept.parse() {
            headers.insert(header::SEC_WEBSOCKET_ACCEPT, accept);
        }
        answer
    }

    /// The session that is asked for, and whether it was there before.
    fn session(&self, request: &Request<Incoming>) -> Option<(Arc<Session>, bool)> {
        let known = |key: &str| asked(request.uri(), key).and_then(|id| self.stage.session(id));
        match known("session") {
            Some(session) => Some((session, true)),
            None => Some((self.stage.new_session(known("from"))?, false)),
        }
    }

    /// A picture of light as the session shows its own.
    async fn develop(&self, request: Request<Incoming>) -> Answer {
        let id = asked(request.uri(), "session").unwrap_or_default();
        let Some(session) = self.stage.session(id) else {
            return text(StatusCode::NOT_FOUND, "there is no such session");
        };
        let (sender, look) = oneshot::channel();
        session.ask(session::Request::Look(sender));
        let Ok(look) = look.await else {
            return text(StatusCode::GONE, "the session is over");
        };
        match developed(request.into_body(), look, &self.developing).await {
            Ok(png) => plain(StatusCode::OK, "image/png", png.into()),
            Err(why) => {
                let why = format!("{why}\n").into();
                plain(StatusCode::UNSUPPORTED_MEDIA_TYPE, "text/plain; charset=utf-8", why)
            }
        }
    }

    async fn save(&self, request: &Request<Incoming>) -> Answer {
        let asked = |key: &str| asked(request.uri(), key).unwrap_or_default();
        let Some(format) = SaveFormat::from_word(asked("format")) else {
            let why = format!("format is {}\n", SaveFormat::WORDS);
            return plain(StatusCode::BAD_REQUEST, "text/plain; charset=utf-8", why.into());
        };
        let Some(session) = self.stage.session(asked("session")) else {
            return text(StatusCode::NOT_FOUND, "there is no such session");
        };
        let (sender, answer) = oneshot::channel();
        session.ask(session::Request::Save(format, sender));
        match answer.await {
            Ok(Ok(File { name, mime, bytes })) => {
                let mut answer = plain(StatusCode::OK, mime, bytes.into());
                if let Ok(disposition) = format!("attachment; filename=\"{name}\"").parse() {
                    answer.headers_mut().insert(header::CONTENT_DISPOSITION, disposition);
                }
                answer
            }
            Ok(Err(why)) => {
                plain(StatusCode::CONFLICT, "text/plain; charset=utf-8", format!("{why}\n").into())
            }
            Err(_) => text(StatusCode::GONE, "the session is over"),
        }
    }
}

fn text(status: StatusCode, words: &'static str) -> Answer {
    plain(status, "text/plain; charset=utf-8", format!("{words}\n").into())
}

/// An answer that browsers keep for themselves and for no time.
fn plain(status: StatusCode, mime: &'static str, body: Bytes) -> Answer {
    let mut answer = Response::new(Full::new(body));
    *answer.status_mut() = status;
    let all = [
        (header::CONTENT_TYPE, mime),
        (header::CACHE_CONTROL, "no-store"),
        (header::REFERRER_POLICY, "no-referrer"),
        (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
        (header::X_FRAME_OPTIONS, "DENY"),
        (header::HeaderName::from_static("cross-origin-resource-policy"), "same-origin"),
        (header::HeaderName::from_static("cross-origin-opener-policy"), "same-origin"),
    ];
    for (name, value) in all {
        answer.headers_mut().insert(name, HeaderValue::from_static(value));
    }
    answer
}
