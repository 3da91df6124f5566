//! Shutter times: known to every camera, without effect until things move.
use durer_scene::ParamSpec;

pub(super) const SHUTTER_OPEN: ParamSpec =
    ParamSpec::float("shutteropen", 0.0, "When the shutter opens; without effect.").unit("s");
pub(super) const SHUTTER_CLOSE: ParamSpec =
    ParamSpec::float("shutterclose", 1.0, "When the shutter closes; without effect.").unit("s");
