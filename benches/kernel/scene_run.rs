//! All cells of one scene.
use std::{process, time::Instant};

use cpu_time::ProcessTime;
use durer::math::Ray;
use durer_benches::{
    embree::{Embree, Quality, Slot},
    options::Options,
    ours::{Input, Isa, Mode, Ours, Preset},
    pin::pin,
    ratio::Quartiles,
    rays::{Class, Found, Query, RaySet},
    report::{BuildRow, Cell, Report, Who},
    scene::Scene,
    spawn::spawn,
    turns::{Competitor, Kernel, race},
};

use crate::obvhs::Obvhs;

/// Threads of builds.
const BUILD_THREADS: usize = 2;
/// Most repeats of a build.
const BUILD_RUNS: usize = 3;
/// What is built against what.
const BUILDS: [(Preset, Quality); 4] = [
    (Preset::Fast, Quality::Low),
    (Preset::Fast, Quality::Medium),
    (Preset::Balanced, Quality::Medium),
    (Preset::High, Quality::High),
];
/// Of Embree's scenes: the one that is raced, which the next one replaces.
const SLOT: u8 = 0;

/// One scene and who traces it.
pub(crate) struct SceneRun<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) embree: &'a Embree,
    pub(crate) options: &'a Options,
    /// Cores we may use; none if processes cannot be pinned.
    pub(crate) cores: &'a [usize],
}

impl SceneRun<'_> {
    /// Times everything; all rows go to `report`.
    pub(crate) fn run(&self, report: &mut Report) -> anyhow::Result<()> {
        self.embree.scene(self.scene)?;
        if !self.keep_on(self.cores) {
            eprintln!("processes are not kept on cores: `taskset` is wanted for that");
        }
        if self.options.builds {
            self.builds(report)?;
        }
        let sets = self.rays()?;
        let obvhs = self.scene.only_mesh().map(Obvhs::build);
        for &mode in &self.options.modes {
            self.keep_on(self.cores);
            self.embree.build(SLOT, Quality::High, mode, BUILD_THREADS)?;
            let ours: Vec<(Isa, Ours)> = self
                .options
                .isas
                .iter()
                .map(|&isa| (isa, Ours::build(Input::new(self.scene), Preset::High, Some(isa), mode)))
                .collect();
            let others = obvhs.as_ref().filter(|_| mode == Mode::Fast);
            for set in sets.iter().filter(|set| !set.rays.is_empty()) {
                self.cells(mode, set, &ours, others, report)?;
            }
        }
        self.embree.drop_slot(SLOT)
    }

    /// Keeps both processes on some cores, if that can be done.
    fn keep_on(&self, cores: &[usize]) -> bool {
        [process::id(), self.embree.id()].into_iter().all(|process| pin(process, cores))
    }

    /// The rays of all kinds. Embree finds where they arrive, so that a fault of our kernel cannot choose the rays.
    fn rays(&self) -> anyhow::Result<Vec<RaySet>> {
        self.embree.build(SLOT, Quality::High, Mode::Robust, BUILD_THREADS)?;
        let primary = RaySet { class: Class::Primary, rays: self.scene.view.rays(self.options.edge) };
        self.embree.rays(&primary)?;
        let hits = self.embree.hits(SLOT, Class::Primary)?;
        let first = spawn(self.scene, Class::Diffuse1, &primary, &hits);
        let occlusion = spawn(self.scene, Class::Occlusion, &primary, &hits);
        self.embree.rays(&first)?;
        let hits = self.embree.hits(SLOT, Class::Diffuse1)?;
        let second = spawn(self.scene, Class::Diffuse2, &first, &hits);
        self.embree.rays(&second)?;
        self.embree.rays(&occlusion)?;
        Ok(vec![primary, first, second, occlusion])
    }

    fn cells(
        &self,
        mode: Mode,
        set: &RaySet,
        ours: &[(Isa, Ours)],
        obvhs: Option<&Obvhs>,
        report: &mut Report,
    ) -> anyhow::Result<()> {
        let embree = Slot { embree: self.embree, number: SLOT };
        let theirs = self.embree.hits(SLOT, set.class)?;
        let mut names = Vec::new();
        let mut competitors: Vec<&dyn Competitor> = vec![&embree];
        let mut differing = vec![0];
        for (isa, kernel) in ours {
            names.push(Who::Ours(*isa));
            competitors.push(kernel);
            differing.push(differing_hits(kernel, set, &theirs));
        }
        if let Some(kernel) = obvhs {
            names.push(Who::Obvhs);
            competitors.push(kernel);
            differing.push(differing_hits(kernel, set, &theirs));
        }
        for &threads in self.options.threads.iter().filter(|&&n| n == 1 || self.cores.len() != 1) {
            self.keep_on(&self.cores[..threads.min(self.cores.len())]);
            let times = race(&competitors, set, threads, self.options.runs)?;
            for (index, who) in (1..).zip(&names) {
                report.cells.push(Cell {
                    scene: self.scene.name.clone(),
                    class: set.class,
                    who: *who,
                    threads,
                    mode,
                    ratio: Quartiles::of(times.ratios(index, 0)),
                    rays_per_second: times.rays_per_second(index),
                    embree_rays_per_second: times.rays_per_second(0),
                    rays: set.rays.len(),
                    differing_hits: differing[index],
                });
            }
        }
        Ok(())
    }

    /// Builds in turns.
    fn builds(&self, report: &mut Report) -> anyhow::Result<()> {
        let triangles = self.scene.triangles() as f64;
        for (preset, quality) in BUILDS {
            let (mut wall, mut cpu, mut bytes, mut fastest) =
                (Vec::new(), Vec::new(), (0, 0), (f64::MAX, f64::MAX));
            for _ in 0..self.options.runs.min(BUILD_RUNS) {
                let theirs = self.embree.build(SLOT, quality, Mode::Fast, BUILD_THREADS)?;
                self.embree.drop_slot(SLOT)?;
                let input = Input::new(self.scene);
                let (start, start_cpu) = (Instant::now(), ProcessTime::now());
                let ours = Ours::build(input, preset, None, Mode::Fast);
                let (seconds, cpu_seconds) =
                    (start.elapsed().as_secs_f64(), start_cpu.elapsed().as_secs_f64());
                bytes = (ours.bytes(), theirs.bytes);
                wall.push(theirs.wall / seconds);
                cpu.push(theirs.cpu / cpu_seconds);
                fastest = (fastest.0.min(seconds), fastest.1.min(theirs.wall));
            }
            report.builds.push(BuildRow {
                scene: self.scene.name.clone(),
                preset,
                quality,
                ratio: Quartiles::of(wall).median,
                ratio_cpu: Quartiles::of(cpu).median,
                triangles_per_second: triangles / fastest.0,
                embree_triangles_per_second: triangles / fastest.1,
                bytes_per_triangle: bytes.0 as f64 / triangles,
                embree_bytes_per_triangle: bytes.1 as f64 / triangles,
            });
        }
        Ok(())
    }
}

/// Rays that meet something for one and nothing for the other, or other triangles at distances more than a
/// thousandth apart.
fn differing_hits(kernel: &dyn Kernel, set: &RaySet, theirs: &[Option<Found>]) -> usize {
    let query = set.class.query();
    let differs = |(ray, theirs): (&Ray, &Option<Found>)| match (kernel.find(ray, query), theirs) {
        (None, None) => false,
        (Some(a), Some(b)) => {
            let apart = (a.t - b.t).abs() > 1e-3 * a.t.abs().max(b.t.abs());
            query == Query::Closest && apart && (a.instance, a.prim) != (b.instance, b.prim)
        }
        _ => true,
    };
    set.rays.iter().zip(theirs).filter(|pair| differs(*pair)).count()
}
