//! placeholder
use serde::{Deserialize, Serialize};
use super::document::*;
/// c
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(default)]
pub struct Comparison { /// s
 pub summary: String }
#[allow(unused)] fn x(_: &Tree) {}
