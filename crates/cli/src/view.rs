//! `durer view`: a page that renders while you watch.
use std::{
    net::{IpAddr, Ipv4Addr, SocketAddr},
    path::PathBuf,
    process::{Command, Stdio},
    sync::atomic::Ordering,
    time::Duration,
};

use anyhow::anyhow;
use durer::{drive::Antialias, film::ToneMap};
use durer_view::{Config, Live, Look, PageSource, StartError};

use crate::{
    exit::{Exit, WrongUsage, emit, tell},
    interrupt::Interrupt,
    load,
    options::{SampleOptions, TalkOptions},
    report,
    value::{finite, tonemap, whole},
};

const EXAMPLES: &str = "\
Examples:
  durer view                                the built-in scene; open the address that is printed
  durer view room.glb --open                your own, in the browser at once
  durer view room.pbrt --integrator path --spp 1024
  durer view car.glb --env studio.hdr --width 960
  durer view room.glb --port 8642           at the same place each time

stdout holds the address of the page, a line. It contains a secret: whoever knows it
may look, and only he. The server answers on this machine alone, unless --bind says
otherwise. It reads the scene and nothing else, and writes no file: what you save
comes through the browser. When a file of the scene changes it is opened again.

In the page: drag to orbit, with the right button to pan, wheel to dolly; click to see
what is there and the rays that made the pixel; forms for everything that durer info
and the reference list; layers, comparison, playback. The messages between page and
server are described in docs/view.md.

Ctrl-C stops at once.";

/// Shows a scene in a web page that renders while you watch, to walk through, change and ask for the rays of any pixel.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    #[command(flatten)]
    sample: SampleOptions,
    /// Brightens the picture by so many stops, at first.
    #[arg(long, value_name = "EV", value_parser = finite, allow_negative_numbers = true, default_value_t = 0.0)]
    #[arg(help_heading = "Picture")]
    exposure: f32,
    /// How light becomes 8-bit colours, at first [default: none for cast, whitted and distributed, else agx].
    #[arg(long, value_name = "NAME", value_parser = tonemap(), help_heading = "Picture")]
    tonemap: Option<ToneMap>,
    /// The port of the server [default: any that is free].
    #[arg(long, value_name = "N", value_parser = whole(0u16..=65535), allow_negative_numbers = true)]
    #[arg(default_value_t = 0, hide_default_value = true, help_heading = "Server")]
    port: u16,
    /// Which of this machine's addresses others may use [default: 127.0.0.1, this machine alone].
    #[arg(long, value_name = "ADDRESS", help_heading = "Server")]
    bind: Option<IpAddr>,
    /// Starts the browser.
    #[arg(long, help_heading = "Server")]
    open: bool,
    /// Shows this page instead of the one that was built in: for those who work on it.
    #[arg(long, value_name = "FILE", help_heading = "Server", hide = !cfg!(debug_assertions))]
    page: Option<PathBuf>,
    /// Worker threads [default: all cores].
    #[arg(long, value_name = "N", value_parser = whole(1u32..=4096))]
    #[arg(allow_negative_numbers = true, help_heading = "Running")]
    threads: Option<u32>,
    #[command(flatten)]
    talk: TalkOptions,
}

pub(crate) fn run(args: &Args) -> anyhow::Result<Exit> {
    let interrupt = Interrupt::listen("the page stops")?;
    let scene = &args.sample.scene.scene;
    let options = durer::Options { threads: args.threads.map(|n| n as usize), ..args.sample.wishes() };
    if options.antialias != Antialias::Supersample {
        let why = "pictures that grow while you watch are supersampled: leave --antialias out";
        return Err(WrongUsage(why.to_owned()).into());
    }
    let at = SocketAddr::new(args.bind.unwrap_or(Ipv4Addr::LOCALHOST.into()), args.port);
    let config = Config {
        scene: scene.clone(),
        options: options.clone(),
        look: Look { exposure: args.exposure, tonemap: args.tonemap },
        at,
        page: args.page(),
        describe: describe(scene.clone()),
    };
    let imported = load::import(scene, &options);
    let failure = load::failure(&imported, &options);
    let live = match Live::start(imported, config) {
        Ok(live) => live,
        Err(StartError::Scene(imported)) => {
            report::print(scene, &imported, &args.talk);
            return Ok(failure);
        }
        Err(StartError::System(error)) => {
            let hint = "another server may be there: take another --port, or leave it out";
            return Err(anyhow!("nobody may listen at {at}: {error}\n  help: {hint}"));
        }
    };
    live.scene(|imported| report::print(scene, imported, &args.talk));
    args.warn_about_place(live.address());
    if let (None, Err(missing)) = (&args.page, durer_page::live()) {
        tell(&format!("warning: {missing}"));
    }
    emit(&format!("{}\n", live.url()))?;
    if args.open && !start_browser(&live.url()) {
        tell("warning: no browser could be started: open the address above");
    }
    if !args.talk.quiet {
        tell("Ctrl-C stops");
    }
    let stop = interrupt.rendering();
    while !stop.load(Ordering::Relaxed) {
        std::thread::sleep(Duration::from_millis(20));
    }
    drop(live);
    Ok(Exit::Interrupted)
}

impl Args {
    fn page(&self) -> PageSource {
        self.page.clone().map_or(PageSource::Built, PageSource::File)
    }

    /// Says who else may look.
    fn warn_about_place(&self, at: SocketAddr) {
        if !at.ip().is_loopback() && !self.talk.quiet {
            tell(&format!(
                "warning: {at} can be reached from other machines, and what goes there is not encrypted: whoever \
                 reads the address on its way may look too"
            ));
        }
    }
}

/// Complaints in words, as they would stand on stderr.
fn describe(scene: String) -> durer_view::Describe {
    Box::new(move |imported, least| {
        report::render(&scene, imported, least, report::Looks::PLAIN).trim_end().to_owned()
    })
}

/// Whether a browser was asked to show the page.
fn start_browser(url: &str) -> bool {
    let (program, before): (&str, &[&str]) = if cfg!(windows) {
        ("rundll32", &["url.dll,FileProtocolHandler"])
    } else if cfg!(target_os = "macos") {
        ("open", &[])
    } else {
        ("xdg-open", &[])
    };
    let mut command = Command::new(program);
    command.args(before).arg(url).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    command.spawn().is_ok()
}
