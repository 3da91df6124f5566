//! `durer view` as its page meets it: how soon there is a picture, how many follow while the camera goes round, how long the
//! rays of a pixel take.
use std::{
    io::{BufRead, BufReader},
    net::TcpStream,
    path::{Path, PathBuf},
    process::{Child, Command, Stdio},
    time::{Duration, Instant},
};

use anyhow::{Context, bail};
use serde_json::{Value, json};
use tokio_tungstenite::tungstenite::{Message, WebSocket, client::client};

use crate::bench::median;

/// How long the camera goes round.
const ORBIT: Duration = Duration::from_secs(5);
/// Pixels whose rays are asked for.
const PIXELS: usize = 40;
/// Size of the picture.
const SIZE: [u32; 2] = [1280, 720];

/// A running server; ends with this.
struct Server(Child);

impl Drop for Server {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// A page without a browser.
struct Page {
    socket: WebSocket<TcpStream>,
    hello: Value,
}

impl Page {
    fn open(url: &str) -> anyhow::Result<Self> {
        let (at, token) =
            url.strip_prefix("http://").and_then(|rest| rest.split_once("/?")).context("an address")?;
        let stream = TcpStream::connect(at)?;
        stream.set_nodelay(true)?;
        stream.set_read_timeout(Some(Duration::from_secs(120)))?;
        let (socket, _) = client(format!("ws://{at}/socket?{token}"), stream).context("a handshake")?;
        let mut page = Self { socket, hello: Value::Null };
        page.hello = page.text("hello")?;
        Ok(page)
    }

    fn say(&mut self, message: &Value) -> anyhow::Result<()> {
        Ok(self.socket.send(Message::text(message.to_string()))?)
    }

    /// The next text of a type, or frame.
    fn next(&mut self) -> anyhow::Result<Value> {
        loop {
            match self.socket.read()? {
                Message::Text(text) => return Ok(serde_json::from_str(&text)?),
                Message::Binary(bytes) => {
                    let (length, rest) = bytes.split_at_checked(4).context("a frame")?;
                    let length = u32::from_le_bytes(length.try_into()?) as usize;
                    let mut head: Value = serde_json::from_slice(rest.get(..length).context("a head")?)?;
                    self.say(&json!({ "type": "ack", "frame": head["frame"] }))?;
                    head["type"] = "frame".into();
                    head["bytes"] = bytes.len().into();
                    return Ok(head);
                }
                Message::Close(_) => bail!("the server closed"),
                _ => {}
            }
        }
    }

    fn text(&mut self, kind: &str) -> anyhow::Result<Value> {
        self.when(|message| message["type"] == kind)
    }

    fn when(&mut self, is: impl Fn(&Value) -> bool) -> anyhow::Result<Value> {
        loop {
            let message = self.next()?;
            if message["type"] == "error" {
                bail!("the server complains: {message}");
            }
            if is(&message) {
                return Ok(message);
            }
        }
    }
}

/// Figures of one scene under one integrator.
pub(super) fn measure(durer: &PathBuf, name: &str, scene: &Path, integrator: &str) -> anyhow::Result<Value> {
    eprintln!("==> durer view, {name}, {integrator}");
    let start = Instant::now();
    let mut command = Command::new(durer);
    command.arg("view").arg(scene).args(["--quiet", "--integrator", integrator, "--spp", "64"]);
    command.args(["--width", &SIZE[0].to_string(), "--height", &SIZE[1].to_string()]);
    let mut server = Server(command.stdout(Stdio::piped()).spawn()?);
    let mut url = String::new();
    let stdout = server.0.stdout.take().context("an output")?;
    BufReader::new(stdout).read_line(&mut url)?;
    let loaded = start.elapsed();
    let asked = Instant::now();
    let mut page = Page::open(url.trim()).context("the server's page")?;
    let first = page.text("frame")?;
    let first_after = asked.elapsed();
    let orbit = orbit(&mut page)?;
    let traces = traces(&mut page)?;
    Ok(json!({
        "scene": name,
        "integrator": integrator,
        "triangles": page.hello["scene"]["triangles"],
        "loaded": loaded.as_secs_f64(),
        "first_picture": first_after.as_secs_f64(),
        "first_size": [first["width"], first["height"]],
        "orbit": orbit,
        "trace": traces,
    }))
}

/// The next move comes when a picture of the last one is there, as from a browser that draws at once.
fn orbit(page: &mut Page) -> anyhow::Result<Value> {
    let camera = page.hello["camera"].clone();
    let vector =
        |name: &str| -> anyhow::Result<[f64; 3]> { Ok(serde_json::from_value(camera[name].clone())?) };
    let (eye, forward, up, right) = (vector("eye")?, vector("forward")?, vector("up")?, vector("right")?);
    let distance = camera["distance"].as_f64().context("a distance")?;
    let mut waits = Vec::new();
    let mut edges = Vec::new();
    let start = Instant::now();
    let mut seq = 0;
    while start.elapsed() < ORBIT {
        seq += 1;
        let (sin, cos) = (f64::from(seq) * 0.02).sin_cos();
        let turned: [f64; 3] = std::array::from_fn(|i| forward[i] * cos + right[i] * sin);
        let moved: [f64; 3] = std::array::from_fn(|i| eye[i] + distance * (forward[i] - turned[i]));
        let asked = Instant::now();
        page.say(&json!({ "type": "camera", "seq": seq, "eye": moved, "forward": turned, "up": up }))?;
        let frame = page.when(|m| m["type"] == "frame" && m["seq"] == seq)?;
        waits.push(asked.elapsed().as_secs_f64());
        edges.push(f64::from(SIZE[0]) / frame["width"].as_f64().unwrap_or(1.0));
    }
    let worst = waits.iter().copied().fold(0.0, f64::max);
    Ok(json!({
        "frames": waits.len(),
        "per_second": waits.len() as f64 / start.elapsed().as_secs_f64(),
        "median": median(waits),
        "worst": worst,
        "pixels_per_sample_edge": median(edges),
    }))
}

/// The rays of one sample, and of all with what the page shows of them.
fn traces(page: &mut Page) -> anyhow::Result<Value> {
    page.say(&json!({ "type": "camera", "seq": 100_000, "name": null }))?;
    page.when(|m| m["type"] == "frame" && m["seq"] == 100_000)?;
    let mut figures = serde_json::Map::new();
    for (name, samples) in [("one_sample", false), ("all_samples", true)] {
        let mut times = Vec::new();
        let mut nodes: Vec<f64> = Vec::new();
        for i in 0..PIXELS {
            // Scattered over the middle of the picture, where there is something.
            let x = SIZE[0] as usize * 3 / 10 + i * 131 % (SIZE[0] as usize * 4 / 10);
            let y = SIZE[1] as usize * 3 / 10 + i * 71 % (SIZE[1] as usize * 4 / 10);
            let asked = Instant::now();
            page.say(&json!({ "type": "trace", "id": i, "x": x, "y": y, "samples": samples }))?;
            let answer = page.text("trace")?;
            times.push(asked.elapsed().as_secs_f64());
            let trees = answer["page"]["trees"].as_array().context("trees")?;
            nodes.push(trees.iter().map(|t| t["nodes"].as_array().map_or(0, Vec::len)).sum::<usize>() as f64);
        }
        let worst = times.iter().copied().fold(0.0, f64::max);
        let rays = median(nodes);
        figures.insert(name.to_owned(), json!({ "median": median(times), "worst": worst, "rays": rays }));
    }
    Ok(figures.into())
}
