//! temporary
use durer::tree::*;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let mut im = durer::open(&a[1]);
    let o = durer::Options {
        width: Some(a[2].parse().unwrap()),
        samples: Some(a[3].parse().unwrap()),
        integrator: a.get(7).cloned(),
        ..Default::default()
    };
    let p = durer::prepare(&mut im, &o).unwrap();
    let s = Subject { name: &a[1], prepared: &p };
    let t = std::time::Instant::now();
    let page =
        s.page([a[4].parse().unwrap(), a[5].parse().unwrap()], &[0], Surroundings::SceneAndSamples(10_000));
    eprintln!("{:?}", t.elapsed());
    let text = page.compact().unwrap();
    std::fs::write(&a[6], &text).unwrap();
    let packed = page.packed(usize::MAX).unwrap();
    let nodes: usize = page.trees.iter().map(|t| t.nodes.len()).sum();
    let mut only = page.clone();
    only.trees.clear();
    eprintln!(
        "trees {} nodes {nodes} json {} packed {} without trees {}",
        page.trees.len(),
        text.len(),
        packed.len(),
        only.packed(usize::MAX).unwrap().len()
    );
}
