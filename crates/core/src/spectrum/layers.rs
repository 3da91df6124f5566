//! Where the colours lie of which smooth reflectances are tabulated: see `upsample.rs`.

/// Nodes of the table along each axis.
pub(super) const SIZE: usize = 32;

/// Brightness of the table's layers: denser near 0 and 1, where curves change fastest. Black and white are no curves.
pub(super) const fn layer(i: usize) -> f64 {
    const fn smooth(x: f64) -> f64 {
        x * x * (3.0 - 2.0 * x)
    }
    0.001 + 0.998 * smooth(i as f64 / (SIZE - 1) as f64)
}
