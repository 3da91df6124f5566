//! Links to strands: chains of crossings between junctions and ends.
use std::collections::BTreeMap;

use durer_core::glam::DVec2;

use crate::{
    change::Change,
    net::{Link, Net, Node},
};

/// Junctions nearer than this along a line are one, in pixels.
const ONE_JUNCTION: f64 = 0.3;
/// Lines that end nearer than this to a junction are none, in pixels.
const SPUR: f64 = 0.5;

/// A point of a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Station {
    /// In pixels.
    pub(crate) at: DVec2,
    pub(crate) change: Change,
}

/// Where a strand ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum End {
    /// Nowhere: the line is over.
    Free,
    /// At a junction.
    Junction(usize),
    /// At its own beginning.
    Loop,
}

/// Crossings in sequence, without the junctions at their ends.
#[derive(Clone, Debug)]
pub(crate) struct Strand {
    pub(crate) stations: Vec<Station>,
    pub(crate) ends: [End; 2],
}

/// All lines, cut at junctions.
pub(crate) struct Strands {
    pub(crate) strands: Vec<Strand>,
    /// Places of the junctions, in pixels.
    pub(crate) junctions: Vec<DVec2>,
}

/// Length of a polygonal line.
pub(crate) fn length(stations: &[Station]) -> f64 {
    stations.windows(2).map(|w| w[0].at.distance(w[1].at)).sum()
}

/// Nodes and what is linked with each.
struct Graph<'a> {
    net: &'a Net<'a>,
    links: Vec<&'a Link>,
    at: BTreeMap<Node, Vec<usize>>,
}

impl<'a> Graph<'a> {
    fn new(net: &'a Net<'a>) -> Self {
        let links: Vec<&Link> = net.links().collect();
        let mut at: BTreeMap<Node, Vec<usize>> = BTreeMap::new();
        for (index, link) in links.iter().enumerate() {
            link.ends.iter().for_each(|end| at.entry(*end).or_default().push(index));
        }
        Self { net, links, at }
    }

    fn station(&self, node: &Node) -> Option<Station> {
        match node {
            Node::On(side) => self.net.crossing(side).map(|c| Station { at: c.at, change: c.change }),
            Node::In(_) => None,
        }
    }

    /// Whether lines pass through a node without ending.
    fn is_way(&self, node: &Node) -> bool {
        matches!(node, Node::On(_)) && self.at[node].len() == 2
    }

    /// The strand that leaves `start` along `first`; notes the links it uses.
    fn walk(&self, start: Node, first: usize, used: &mut [bool]) -> (Vec<Station>, Node) {
        let mut stations: Vec<Station> = self.station(&start).into_iter().collect();
        let (mut node, mut link) = (start, first);
        loop {
            used[link] = true;
            let ends = self.links[link].ends;
            node = if ends[0] == node { ends[1] } else { ends[0] };
            stations.extend(self.links[link].middle.map(|c| Station { at: c.at, change: c.change }));
            stations.extend(self.station(&node));
            let next = self.at[&node].iter().copied().find(|&l| !used[l]);
            match next.filter(|_| self.is_way(&node)) {
                Some(next) if node != start => link = next,
                _ => return (stations, node),
            }
        }
    }
}

impl Strands {
    /// Of all links.
    pub(crate) fn of(net: &Net<'_>) -> Self {
        let graph = Graph::new(net);
        let mut used = vec![false; graph.links.len()];
        let mut numbers: BTreeMap<Node, usize> = BTreeMap::new();
        for node in graph.at.keys().filter(|node| matches!(node, Node::In(_))) {
            let number = numbers.len();
            numbers.insert(*node, number);
        }
        let end = |node: &Node| numbers.get(node).map_or(End::Free, |&number| End::Junction(number));
        let mut strands = Vec::new();
        for (node, links) in graph.at.iter().filter(|(node, _)| !graph.is_way(node)) {
            for &link in links {
                if !used[link] {
                    let (stations, last) = graph.walk(*node, link, &mut used);
                    strands.push(Strand { stations, ends: [end(node), end(&last)] });
                }
            }
        }
        for (node, links) in &graph.at {
            if !used[links[0]] {
                let (stations, _) = graph.walk(*node, links[0], &mut used);
                strands.push(Strand { stations, ends: [End::Loop; 2] });
            }
        }
        let junctions = numbers.keys().map(|node| graph.place(node)).collect();
        Self { strands, junctions }.tidied()
    }

    /// With junctions that lie together made one, and without spurs.
    fn tidied(mut self) -> Self {
        let mut same: Vec<usize> = (0..self.junctions.len()).collect();
        let is_short = |strand: &Strand| match strand.ends {
            [End::Junction(_), End::Junction(_)] => length(&strand.stations) < ONE_JUNCTION,
            _ => false,
        };
        for strand in self.strands.iter().filter(|s| is_short(s)) {
            if let [End::Junction(a), End::Junction(b)] = strand.ends {
                let (a, b) = (root(&same, a), root(&same, b));
                same[a.max(b)] = a.min(b);
            }
        }
        let mut sums = vec![(DVec2::ZERO, 0.0); self.junctions.len()];
        for (index, place) in self.junctions.iter().enumerate() {
            let sum = &mut sums[root(&same, index)];
            *sum = (sum.0 + *place, sum.1 + 1.0);
        }
        let merged = |end: End| match end {
            End::Junction(j) => End::Junction(root(&same, j)),
            other => other,
        };
        self.strands.retain(|strand| !is_short(strand));
        for strand in &mut self.strands {
            strand.ends = strand.ends.map(merged);
        }
        self.junctions = sums.into_iter().map(|(sum, n)| if n > 0.0 { sum / n } else { sum }).collect();
        let is_spur = |strand: &Strand| {
            let free = strand.ends.iter().filter(|end| **end == End::Free).count();
            free == 1 && length(&strand.stations) < SPUR
        };
        self.strands.retain(|strand| !is_spur(strand) && !strand.stations.is_empty());
        self
    }
}

impl Graph<'_> {
    /// The mean of the crossings around a junction.
    fn place(&self, node: &Node) -> DVec2 {
        let around =
            self.at[node].iter().flat_map(|&link| self.links[link].ends).filter_map(|end| self.station(&end));
        let (sum, n) = around.fold((DVec2::ZERO, 0.0), |(sum, n), s| (sum + s.at, n + 1.0));
        match node {
            Node::In(cell) if n == 0.0 => self.net.middle(cell),
            _ => sum / n,
        }
    }
}

fn root(same: &[usize], mut index: usize) -> usize {
    while same[index] != index {
        index = same[index];
    }
    index
}
