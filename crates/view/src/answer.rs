//! Questions that take a while, answered beside the session's own thread: the rays of a pixel, the scene around them.
use std::{
    panic::{AssertUnwindSafe, catch_unwind},
    sync::{
        Arc, Weak,
        mpsc::{Receiver, Sender, channel},
    },
    thread,
    time::Instant,
};

use durer::{
    Gather, Prepared,
    drive::Taken,
    probe::{Clock, Detail},
    spectrum::luminance,
    tree::{Comparison, GhostScene, Other, Page, Subject, Surroundings, Tree},
};
use serde_json::json;

use crate::{
    message::{TraceMessage, Which},
    session::{Out, Outbox, Request, Session},
};

/// Rays of a page in all; other samples than the one that was asked for are left out beyond.
const MOST_NODES: usize = 10_000;
/// Rays whose boxes are recorded.
const WALKS: usize = 16;
/// Rays of a tree that are recorded.
const MOST_RAYS: usize = 100_000;
/// Samples of a pixel that are looked through.
const MOST_SAMPLES: u32 = 1 << 16;

/// A question about a pixel.
pub(crate) struct Traced {
    pub(crate) trace: TraceMessage,
    /// The scene as the user named it.
    pub(crate) name: String,
    pub(crate) revision: u64,
    pub(crate) seq: u64,
    pub(crate) prepared: Arc<Prepared>,
    /// Other light transport, and how it differs in words.
    pub(crate) twin: Option<(Prepared, String)>,
}

/// A question.
pub(crate) enum Question {
    Trace(Box<Traced>),
    Ghost { id: u64, name: String, revision: u64, seq: u64, prepared: Arc<Prepared> },
}

/// The thread that answers.
pub(crate) struct Answerer {
    questions: Sender<(Question, Outbox)>,
}

impl Question {
    fn id(&self) -> u64 {
        match self {
            Self::Trace(traced) => traced.trace.id,
            Self::Ghost { id, .. } => *id,
        }
    }

    fn answer(&self) -> String {
        match self {
            Self::Trace(traced) => answer(traced),
            Self::Ghost { id, name, revision, seq, prepared } => {
                let scene = GhostScene::new(name, prepared);
                json!({ "type": "ghost", "id": id, "revision": revision, "seq": seq, "scene": scene })
                    .to_string()
            }
        }
    }
}

/// The message about a question that has no answer.
fn refused(id: u64, message: &str) -> String {
    json!({ "type": "error", "about": "trace", "param": null, "message": message, "hint": null, "id": id })
        .to_string()
}

impl Answerer {
    pub(crate) fn start(session: &Arc<Session>) -> Self {
        let (questions, asked) = channel();
        let session = Arc::downgrade(session);
        // Without the thread nothing takes questions, which `ask` says.
        let run = move || answer_all(&asked, &session);
        drop(thread::Builder::new().name("durer answers".to_owned()).spawn(run));
        Self { questions }
    }

    /// Whether there will be an answer.
    pub(crate) fn ask(&self, question: Question, outbox: Outbox) -> bool {
        self.questions.send((question, outbox)).is_ok()
    }
}

fn answer_all(asked: &Receiver<(Question, Outbox)>, session: &Weak<Session>) {
    for (question, outbox) in asked {
        // A fault of ours ends this answer, not the session that waits for it.
        let answered = catch_unwind(AssertUnwindSafe(|| question.answer()));
        let text = answered
            .unwrap_or_else(|_| refused(question.id(), "durer failed at this question: please report it"));
        outbox.send(Out::Text(text));
        match session.upgrade() {
            Some(session) => session.ask(Request::Answered),
            None => return,
        }
    }
}

fn answer(traced: &Traced) -> String {
    let start = Instant::now();
    let Traced { trace, revision, seq, .. } = traced;
    let page = page(traced).and_then(|page| page.compact().map_err(|e| e.to_string()));
    match page {
        Ok(page) => {
            let ms = start.elapsed().as_secs_f64() * 1e3;
            let head = json!({ "type": "trace", "id": trace.id, "ms": ms, "revision": revision, "seq": seq });
            let head = head.to_string();
            // The document is large: it is not read again to be put in here.
            format!("{},\"page\":{page}}}", head.trim_end_matches('}'))
        }
        Err(message) => refused(trace.id, &message),
    }
}

/// The document, as `durer trace` makes it but for the scene and the picture.
fn page(traced: &Traced) -> Result<Page, String> {
    let Traced { trace, name, prepared, twin, .. } = traced;
    let (subject, pixel) = (Subject { name, prepared }, [trace.x, trace.y]);
    let count = prepared.job().sample_count(pixel);
    if (trace.samples || trace.sample != Which::Number(0)) && count > MOST_SAMPLES {
        return Err(format!(
            "the pixel has {count} samples: more than {MOST_SAMPLES} are not looked through"
        ));
    }
    let sample = sample(prepared, pixel, &trace.sample, count)?;
    let detail = Detail { walks: WALKS, clock: Clock::On, rays: MOST_RAYS };
    let mut page = subject.page(pixel, &[sample], Surroundings::None, detail);
    if trace.samples {
        add_others(&subject, &mut page, pixel, count);
        subject.add_samples(&mut page, pixel);
    }
    if let Some((twin, words)) = twin {
        compare(&mut page, &Subject { name, prepared: twin }, words)?;
    }
    Ok(page)
}

/// Trees of the pixel's other samples, while there is room.
fn add_others(subject: &Subject<'_>, page: &mut Page, pixel: [u32; 2], count: u32) {
    let mut nodes: usize = page.trees.iter().map(|t| t.nodes.len()).sum();
    let first = page.trees.first().map(|t| t.sample);
    for sample in (0..count).filter(|s| Some(*s) != first) {
        let tree = subject.tree_of(pixel, count, sample, Detail::default());
        nodes += tree.nodes.len();
        if nodes > MOST_NODES {
            break;
        }
        page.trees.push(tree);
    }
}

fn sample(prepared: &Prepared, pixel: [u32; 2], which: &Which, count: u32) -> Result<u32, String> {
    match which {
        Which::Number(sample) if *sample < count => Ok(*sample),
        Which::Number(sample) => Err(format!("there is no sample {sample}: the pixel has {count}")),
        Which::Word(word) if word == "brightest" => {
            let light = |taken: &Taken| luminance(taken.rgb.unwrap_or_default().map(f64::from));
            let all = prepared.job().samples_of(pixel, Gather::Rays);
            let finite = all.iter().map(|s| (s.sample, light(s))).filter(|(_, light)| light.is_finite());
            let best = finite.reduce(|best, s| if s.1 > best.1 { s } else { best });
            Ok(best.map_or(0, |(sample, _)| sample))
        }
        Which::Word(word) => Err(format!("\"{word}\" is no sample: expected a number or \"brightest\"")),
    }
}

/// Adds the trees of the same samples under other light transport, and what differs.
fn compare(page: &mut Page, twin: &Subject<'_>, words: &str) -> Result<(), String> {
    let Some(pixel) = page.trees.first().map(|t| t.pixel) else { return Ok(()) };
    let samples = twin.prepared.job().sample_count(pixel);
    page.trees.retain(|tree| tree.sample < samples);
    if page.trees.is_empty() {
        return Err(format!("the other light transport takes {samples} samples: this one is not among them"));
    }
    let others: Vec<Tree> =
        page.trees.iter().map(|t| twin.tree_of(pixel, samples, t.sample, Detail::default())).collect();
    for (tree, other) in page.trees.iter_mut().zip(&others) {
        tree.diff = Some(Comparison::new(tree, other, words, "this sample"));
    }
    let diff = page.trees.first().and_then(|t| t.diff.clone()).unwrap_or_default();
    page.other = Some(Other { options: words.to_owned(), trees: others, diff });
    Ok(())
}
