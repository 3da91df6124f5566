//! What the page may say. `docs/view.md` describes all messages of both sides.
use serde::Deserialize;
use serde_json::{Map, Value};

/// A message of the page.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(tag = "type", rename_all = "lowercase")]
pub(crate) enum Message {
    /// A frame was drawn: there may be another.
    Ack {
        /// Its number.
        frame: u64,
    },
    /// Look from elsewhere: from a pose, or as a camera of the scene does.
    Camera(CameraMessage),
    /// A parameter gets a value, or with `null` none.
    Set {
        /// The form.
        form: String,
        /// The parameter.
        param: String,
        /// Its value.
        #[serde(default)]
        value: Value,
    },
    /// Another kind of thing.
    Kind {
        /// The form.
        form: String,
        /// The registered word.
        kind: String,
    },
    /// As it was opened.
    Reset {
        /// The form; everything if there is none.
        #[serde(default)]
        form: Option<String>,
    },
    /// Another view of the same.
    Layer {
        /// `beauty` or what `cast` shows.
        layer: String,
    },
    /// Rest, or go on.
    Pause {
        /// Whether to rest.
        paused: bool,
    },
    /// Forms that were left out at first.
    Forms {
        /// Which.
        ids: Vec<String>,
    },
    /// What is seen in a pixel?
    Pick(PickMessage),
    /// The rays of a pixel, please.
    Trace(TraceMessage),
    /// The scene around the rays, please.
    Ghost {
        /// Of the request.
        id: u64,
    },
}

/// See [`Message::Camera`].
#[derive(Clone, Debug, Deserialize, PartialEq)]
pub(crate) struct CameraMessage {
    /// Counts up; frames tell which they are of.
    pub(crate) seq: u64,
    /// Where it is, in world space.
    #[serde(default)]
    pub(crate) eye: Option<[f64; 3]>,
    /// Where it looks.
    #[serde(default)]
    pub(crate) forward: Option<[f64; 3]>,
    /// What is up.
    #[serde(default)]
    pub(crate) up: Option<[f64; 3]>,
    /// A camera of the scene, without a pose; the first if there is no name either.
    #[serde(default)]
    pub(crate) name: Option<String>,
}

/// See [`Message::Pick`].
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
pub(crate) struct PickMessage {
    /// Of the request.
    pub(crate) id: u64,
    /// Column.
    pub(crate) x: u32,
    /// Row.
    pub(crate) y: u32,
}

/// See [`Message::Trace`].
#[derive(Clone, Debug, Deserialize, PartialEq)]
pub(crate) struct TraceMessage {
    /// Of the request.
    pub(crate) id: u64,
    /// Column.
    pub(crate) x: u32,
    /// Row.
    pub(crate) y: u32,
    /// Which of the pixel's samples.
    #[serde(default)]
    pub(crate) sample: Which,
    /// Whether the other samples are wanted too.
    #[serde(default)]
    pub(crate) samples: bool,
    /// Other light transport, to compare.
    #[serde(default)]
    pub(crate) diff: Option<Diff>,
}

/// A sample of a pixel.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(untagged)]
pub(crate) enum Which {
    /// By its number.
    Number(u32),
    /// `brightest`.
    Word(String),
}

impl Default for Which {
    fn default() -> Self {
        Self::Number(0)
    }
}

/// Light transport that differs from the session's.
#[derive(Clone, Debug, Deserialize, PartialEq)]
pub(crate) struct Diff {
    /// Another integrator; the session's if there is none.
    #[serde(default)]
    pub(crate) kind: Option<String>,
    /// Parameters with their values.
    #[serde(default)]
    pub(crate) params: Map<String, Value>,
}

impl Message {
    /// Whether the picture that is being rendered is of no use any more.
    pub(crate) fn ends_picture(&self) -> bool {
        match self {
            Self::Camera(_) | Self::Kind { .. } | Self::Reset { form: None } | Self::Layer { .. } => true,
            Self::Set { form, .. } | Self::Reset { form: Some(form) } => form != "look",
            _ => false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Message, String> {
        serde_json::from_str(text).map_err(|e| e.to_string())
    }

    #[test]
    fn messages_are_read() {
        let camera = r#"{"type":"camera","seq":5,"eye":[1,2,3],"forward":[0,0,1],"up":[0,1,0]}"#;
        assert!(matches!(
            read(camera),
            Ok(Message::Camera(CameraMessage { seq: 5, eye: Some(_), name: None, .. }))
        ));
        assert_eq!(read(r#"{"type":"reset"}"#), Ok(Message::Reset { form: None }));
        let trace =
            r#"{"type":"trace","id":8,"x":3,"y":4,"sample":"brightest","diff":{"params":{"maxdepth":2}}}"#;
        let Ok(Message::Trace(trace)) = read(trace) else { panic!("a trace") };
        assert_eq!(trace.sample, Which::Word("brightest".to_owned()));
        assert_eq!(trace.diff.map(|d| d.params.len()), Some(1));
    }

    #[test]
    fn what_is_none_is_an_error() {
        for text in ["", "[]", "{}", r#"{"type":"format disk"}"#, r#"{"type":"pick","id":-1,"x":0,"y":0}"#] {
            assert!(read(text).is_err(), "{text}");
        }
    }
}
