//! What a scene holds in memory, in bytes.
use durer::{
    Prepared,
    film::{BLOCK, Pixel},
};
use serde::Serialize;

/// Bytes.
#[derive(Serialize)]
pub(super) struct Memory {
    /// Trees with what lies in them, as built.
    pub(super) hierarchy: u64,
    /// The same, guessed from the counts before they were built.
    pub(super) hierarchy_expected: u64,
    /// What building them takes at most, guessed likewise.
    pub(super) hierarchy_building: u64,
    /// Meshes as described, a shared one once.
    pub(super) meshes: u64,
    /// Copies of meshes that were moved to where they stand.
    pub(super) meshes_placed: u64,
    /// Decoded images of textures and lights, a shared one once, and the smaller copies that textures make of them.
    pub(super) textures: u64,
    /// Tables of measured materials, those of a file once.
    pub(super) measured: u64,
    /// What a render will sum into, layers beside colours included.
    pub(super) film: u64,
    /// Most that the process held at a time so far; `None` where the system does not tell.
    pub(super) peak: Option<u64>,
}

impl Memory {
    pub(super) fn new(prepared: &Prepared, textures: u64) -> Self {
        let report = &prepared.scene.report;
        let view = &prepared.scene.view;
        let pixels = u64::from(view.width) * u64::from(view.height);
        // The block being filled, and a film per digit of the number of blocks.
        let blocks = prepared.settings.samples.div_ceil(BLOCK);
        let films = 1 + u64::from(u32::BITS - blocks.leading_zeros());
        let layers = view.layers.map_or(0, |layers| layers.bytes());
        Self {
            hierarchy: prepared.scene.accel.stats().bytes,
            hierarchy_expected: report.expected_bytes,
            hierarchy_building: report.building_bytes,
            meshes: report.geometry.mesh_bytes,
            meshes_placed: report.placed_mesh_bytes,
            textures: textures + report.texture_bytes,
            measured: report.measured_bytes,
            film: pixels * (size_of::<Pixel>() as u64 * films + layers),
            peak: peak(),
        }
    }
}

/// The high-water mark of resident memory, as Linux tells it.
fn peak() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kilobytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kilobytes * 1024)
}
