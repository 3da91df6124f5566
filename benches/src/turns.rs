//! Timing in turns: for every chunk of rays all competitors run, one right after the other, in an order that rotates.
//!
//! So what else the machine does hits all of them alike, and ratios of one chunk can be compared. What is measured is
//! the processor time of the thread that traces, which others on the machine disturb less than the clock on the wall.
use std::{ops::Range, sync::Barrier, thread};

use cpu_time::ThreadTime;
use durer::math::Ray;

use crate::rays::{Found, Query, RaySet};

/// Rays that a thread traces before the clock starts.
pub const WARM_UP: usize = 6_144;

/// A kernel in this process.
pub trait Kernel: Sync {
    /// Traces all rays and forgets the results.
    fn trace(&self, rays: &[Ray], query: Query);
    /// The result of one ray.
    fn find(&self, ray: &Ray, query: Query) -> Option<Found>;
}

/// Whoever can trace chunks of rays and tell the time it took.
pub trait Competitor {
    /// Traces each chunk in a thread of its own; processor seconds of all of them.
    ///
    /// # Errors
    /// The competitor is a process, and that failed.
    fn run(&self, set: &RaySet, chunks: &[Range<usize>]) -> anyhow::Result<f64>;
}

impl<K: Kernel> Competitor for K {
    fn run(&self, set: &RaySet, chunks: &[Range<usize>]) -> anyhow::Result<f64> {
        let together = Barrier::new(chunks.len());
        let part = |chunk: &Range<usize>| {
            let query = set.class.query();
            self.trace(set.warm_up(chunk, WARM_UP), query);
            together.wait();
            let start = ThreadTime::now();
            self.trace(&set.rays[chunk.clone()], query);
            start.elapsed().as_secs_f64()
        };
        let Some((first, others)) = chunks.split_first() else {
            return Ok(0.0);
        };
        Ok(thread::scope(|scope| {
            let others: Vec<_> = others.iter().map(|chunk| scope.spawn(|| part(chunk))).collect();
            let first = part(first);
            others.into_iter().fold(first, |sum, thread| sum + thread.join().expect("tracing does not panic"))
        }))
    }
}

/// Seconds of each competitor (outer) for each chunk and repeat (inner), and how many rays each of those traced.
pub struct Times {
    /// By competitor.
    pub seconds: Vec<Vec<f64>>,
    /// The same for all.
    pub rays: Vec<usize>,
}

impl Times {
    /// All rays by all seconds of a competitor.
    pub fn rays_per_second(&self, competitor: usize) -> f64 {
        self.rays.iter().sum::<usize>() as f64 / self.seconds[competitor].iter().sum::<f64>()
    }

    /// How much faster one is than another, for each chunk and repeat.
    pub fn ratios(&self, faster: usize, than: usize) -> Vec<f64> {
        self.seconds[than].iter().zip(&self.seconds[faster]).map(|(slow, fast)| slow / fast).collect()
    }
}

/// Traces all of `set` `repeats` times, `threads` chunks at a time.
///
/// # Errors
/// As [`Competitor::run`].
pub fn race(
    competitors: &[&dyn Competitor],
    set: &RaySet,
    threads: usize,
    repeats: usize,
) -> anyhow::Result<Times> {
    let chunks = set.chunks();
    let mut times = Times { seconds: vec![Vec::new(); competitors.len()], rays: Vec::new() };
    let mut turn = 0;
    for _ in 0..repeats {
        for first in (0..chunks.len()).step_by(threads) {
            // A last one without companion gets the first one.
            let parts: Vec<_> =
                (first..first + threads).map(|index| chunks[index % chunks.len()].clone()).collect();
            for place in 0..competitors.len() {
                let index = (turn + place) % competitors.len();
                times.seconds[index].push(competitors[index].run(set, &parts)?);
            }
            times.rays.push(parts.iter().map(Range::len).sum());
            turn += 1;
        }
    }
    Ok(times)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rays::Class;
    use durer::math::{Point3, Vector3};
    use std::cell::RefCell;

    /// Pretends to take as many seconds as it is given, and notes its name.
    struct Pretender<'a>(char, f64, &'a RefCell<String>);

    impl Competitor for Pretender<'_> {
        fn run(&self, _: &RaySet, chunks: &[Range<usize>]) -> anyhow::Result<f64> {
            self.2.borrow_mut().push(self.0);
            Ok(self.1 * chunks.len() as f64)
        }
    }

    fn set() -> RaySet {
        let ray = Ray::new(Point3::ZERO, Vector3::new(0.0, 0.0, 1.0));
        RaySet { class: Class::Primary, rays: vec![ray; 100_000] }
    }

    #[test]
    fn the_order_rotates() {
        let log = RefCell::new(String::new());
        let (a, b) = (Pretender('a', 1.0, &log), Pretender('b', 2.0, &log));
        let times = race(&[&a, &b], &set(), 1, 2).expect("pretenders do not fail");
        assert_eq!(*log.borrow(), "abbaabbaabba");
        assert_eq!(times.ratios(0, 1), [2.0; 6]);
        assert_eq!(times.rays.iter().sum::<usize>(), 200_000);
        assert_eq!(race(&[&a], &set(), 2, 1).map(|t| t.seconds).ok(), Some(vec![vec![2.0, 2.0]]));
    }

    /// Counts the rays it is given.
    struct Counter(std::sync::atomic::AtomicUsize);

    impl Kernel for Counter {
        fn trace(&self, rays: &[Ray], _: Query) {
            self.0.fetch_add(rays.len(), std::sync::atomic::Ordering::Relaxed);
        }
        fn find(&self, _: &Ray, _: Query) -> Option<Found> {
            None
        }
    }

    #[test]
    fn each_thread_warms_up_and_traces_its_chunk() {
        let counter = Counter(0.into());
        let seconds = counter.run(&set(), &[0..1_000, 50_000..53_000]).expect("kernels do not fail");
        assert!(seconds >= 0.0);
        assert_eq!(counter.0.into_inner(), 2 * WARM_UP + 4_000);
    }
}
