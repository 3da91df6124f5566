//! Shutter times, in every camera's schema. `compile` reads them: cameras are told the time of each ray.
use durer_scene::ParamSpec;

pub(super) const SHUTTER_OPEN: ParamSpec =
    ParamSpec::float("shutteropen", 0.0, "When the shutter opens, if something moves.").unit("s");
pub(super) const SHUTTER_CLOSE: ParamSpec =
    ParamSpec::float("shutterclose", 1.0, "When the shutter closes, if something moves.").unit("s");
