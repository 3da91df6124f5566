//! Which pixels are recorded.
use durer::Prepared;

/// How many places are looked at for each pixel that is wanted, until too little is to be seen.
const PATIENCE: u32 = 100;
/// Steps that spread points over a square evenly, however many they are: 1/p and 1/p² of Roberts' sequence R2, where p
/// is the real root of p³ = p + 1.
const STEPS: [f64; 2] = [0.754_877_666_246_693, 0.569_840_290_998_053];

/// `count` pixels spread over the picture, or fewer if there is little, whose first eye ray hits something: the sky costs
/// nothing to record and would flatter the figures.
pub(crate) fn that_show_something(prepared: &Prepared, count: usize) -> Vec<[u32; 2]> {
    let size = [prepared.scene.view.width, prepared.scene.view.height];
    let job = prepared.job();
    let hits = |pixel: &[u32; 2]| job.record(*pixel, 0).0.nodes.first().is_some_and(|eye| eye.hit.is_some());
    let candidates = (1..=PATIENCE * count as u32).map(|index| place(index, size));
    candidates.filter(hits).take(count).collect()
}

/// The pixel of a number of the sequence.
fn place(index: u32, size: [u32; 2]) -> [u32; 2] {
    [0, 1].map(|axis| {
        let share = (0.5 + f64::from(index) * STEPS[axis]).fract();
        ((share * f64::from(size[axis])) as u32).min(size[axis] - 1)
    })
}
