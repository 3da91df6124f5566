//! Strands to trails: lines of one kind that go on through junctions as the eye goes on.
//!
//! An outline continues past the line that ends at it, since both parts belong to the same thing in front; folds and contacts
//! continue where they run straight.
use durer_core::glam::DVec2;

use crate::{
    Kind,
    strand::{End, Station, Strand, Strands, length},
};

/// Where the direction of a strand at its end is taken, in pixels from there.
const AHEAD: f64 = 1.5;
/// Cosine of the turn up to which a line goes on straight through a junction.
const STRAIGHT: f64 = 0.8;
/// A line that is of another kind for less than this is not, in pixels.
const PASSING: f64 = 2.0;

/// A line of one kind.
#[derive(Clone, Debug)]
pub(crate) struct Trail {
    pub(crate) kind: Kind,
    pub(crate) stations: Vec<Station>,
    /// The last station leads to the first.
    pub(crate) closed: bool,
    /// Whether either end is nowhere.
    pub(crate) is_loose: bool,
}

/// An end of a strand at a junction.
#[derive(Clone, Copy, Debug)]
struct Arm {
    strand: usize,
    end: usize,
    towards: DVec2,
    kind: Kind,
    front: [u32; 2],
}

/// A strand's stations from one of its ends.
fn from_end(strand: &Strand, end: usize) -> Vec<Station> {
    match end {
        0 => strand.stations.clone(),
        _ => strand.stations.iter().rev().copied().collect(),
    }
}

fn arm(strands: &Strands, strand: usize, end: usize, junction: DVec2) -> Arm {
    let stations = from_end(&strands.strands[strand], end);
    let ahead = stations.iter().find(|s| s.at.distance(junction) >= AHEAD).or(stations.last());
    let towards = ahead.map_or(DVec2::X, |s| (s.at - junction).normalize_or_zero());
    let near: Vec<&Station> = stations.iter().take_while(|s| s.at.distance(junction) < AHEAD).collect();
    let typical = near.get(near.len() / 2).copied().unwrap_or(&stations[0]);
    Arm { strand, end, towards, kind: typical.change.kind, front: typical.change.front }
}

/// Which end of which strand each end goes on with.
fn partners(strands: &Strands) -> Vec<[Option<(usize, usize)>; 2]> {
    let mut arms: Vec<Vec<Arm>> = vec![Vec::new(); strands.junctions.len()];
    for (index, strand) in strands.strands.iter().enumerate() {
        for end in 0..2 {
            if let End::Junction(junction) = strand.ends[end] {
                arms[junction].push(arm(strands, index, end, strands.junctions[junction]));
            }
        }
    }
    let mut partners = vec![[None; 2]; strands.strands.len()];
    for arms in arms {
        let mut pairs = Vec::new();
        for (i, a) in arms.iter().enumerate() {
            for b in &arms[i + 1..] {
                let straight = -a.towards.dot(b.towards);
                let is_outline = a.kind == Kind::Silhouette && a.front == b.front;
                if a.kind == b.kind
                    && (is_outline && straight > -0.9 || straight > STRAIGHT || arms.len() == 2)
                {
                    pairs.push((straight + if is_outline { 1.0 } else { 0.0 }, *a, *b));
                }
            }
        }
        pairs.sort_by(|p, q| q.0.total_cmp(&p.0));
        for (_, a, b) in pairs {
            if partners[a.strand][a.end].is_none() && partners[b.strand][b.end].is_none() {
                partners[a.strand][a.end] = Some((b.strand, b.end));
                partners[b.strand][b.end] = Some((a.strand, a.end));
            }
        }
    }
    partners
}

/// Adds a junction between two strands where the line turns in it; where it goes straight on its neighbours know better.
fn turn(stations: &mut Vec<Station>, junction: DVec2, next: &[Station]) {
    let before = stations.iter().rev().find(|s| s.at.distance(junction) >= AHEAD).or(stations.first());
    let after = next.iter().find(|s| s.at.distance(junction) >= AHEAD).or(next.last());
    if let (Some(before), Some(after), Some(last)) = (before, after, stations.last()) {
        let cos = (junction - before.at).normalize_or_zero().dot((after.at - junction).normalize_or_zero());
        if cos < STRAIGHT {
            stations.push(Station { at: junction, ..*last });
        }
    }
}

/// All strands, joined through junctions, each with whether it is closed and whether it has a loose end.
fn joined(strands: &Strands) -> Vec<(Vec<Station>, bool, bool)> {
    let partners = partners(strands);
    let mut used = vec![false; strands.strands.len()];
    let place = |end: End| match end {
        End::Junction(j) => Some(strands.junctions[j]),
        _ => None,
    };
    let mut all = Vec::new();
    // Lines with ends first, so that what remains is closed.
    let starts = (0..partners.len()).flat_map(|i| [(i, 0), (i, 1)]);
    let (ended, round): (Vec<_>, Vec<_>) = starts.partition(|&(i, end)| partners[i][end].is_none());
    for (start, end) in ended.into_iter().chain(round) {
        if used[start] {
            continue;
        }
        let (mut strand, mut from) = (start, end);
        let mut stations: Vec<Station> = Vec::new();
        let first = place(strands.strands[start].ends[end]);
        loop {
            used[strand] = true;
            stations.extend(from_end(&strands.strands[strand], from));
            match partners[strand][1 - from] {
                Some((next, next_end)) => {
                    if let Some(junction) = place(strands.strands[strand].ends[1 - from]) {
                        let ahead = from_end(&strands.strands[next], next_end);
                        turn(&mut stations, junction, &ahead);
                    }
                    if used[next] {
                        break;
                    }
                    (strand, from) = (next, next_end);
                }
                None => break,
            }
        }
        let is_loop = strands.strands[start].ends == [End::Loop; 2];
        let closed = is_loop || partners[start][end].is_some();
        let last_end = strands.strands[strand].ends[1 - from];
        if !closed {
            // A line that ends at others ends in the same point as they do.
            let at = |at: DVec2, like: &Station| Station { at, ..*like };
            if let Some(at) = first.map(|p| at(p, &stations[0])) {
                stations.insert(0, at);
            }
            if let (Some(place), Some(like)) = (place(last_end), stations.last().copied()) {
                stations.push(at(place, &like));
            }
        } else if is_loop && stations.len() > 1 {
            // The walk came back to where it began.
            stations.pop();
        }
        let loose = !closed && (strands.strands[start].ends[end] == End::Free || last_end == End::Free);
        all.push((stations, closed, loose));
    }
    all
}

/// Runs of stations of the same kind: first index, and one past the last.
fn runs(stations: &[Station]) -> Vec<(usize, usize)> {
    let mut runs: Vec<(usize, usize)> = Vec::new();
    for (i, station) in stations.iter().enumerate() {
        match runs.last_mut() {
            Some((start, end)) if stations[*start].change.kind == station.change.kind => *end = i + 1,
            _ => runs.push((i, i + 1)),
        }
    }
    runs
}

/// Gives stations that are of another kind for a moment only the kind of their longer neighbours.
fn steady(stations: &mut [Station]) {
    loop {
        let runs = runs(stations);
        let reach = |&(start, end): &(usize, usize)| length(&stations[start..end]);
        let shortest = runs.iter().enumerate().min_by(|a, b| reach(a.1).total_cmp(&reach(b.1)));
        let Some((index, &(start, end))) = shortest.filter(|(_, run)| runs.len() > 1 && reach(run) < PASSING)
        else {
            return;
        };
        let before = index.checked_sub(1).map(|i| runs[i]);
        let after = runs.get(index + 1).copied();
        let longer = [before, after].into_iter().flatten().max_by(|a, b| reach(a).total_cmp(&reach(b)));
        let Some(kind) = longer.map(|(start, _)| stations[start].change.kind) else { return };
        stations[start..end].iter_mut().for_each(|s| s.change.kind = kind);
    }
}

/// All lines of one kind each.
pub(crate) fn trails(strands: &Strands) -> Vec<Trail> {
    let mut trails = Vec::new();
    for (mut stations, closed, is_loose) in joined(strands) {
        if closed {
            // So that no run goes over the seam: begin where the kind changes, if it does.
            let kind = |s: &Station| s.change.kind;
            let last = stations.last().map(kind);
            if last == stations.first().map(kind) {
                let change = stations.windows(2).position(|w| kind(&w[0]) != kind(&w[1]));
                stations.rotate_left(change.map_or(0, |i| i + 1));
            }
        }
        steady(&mut stations);
        let runs = runs(&stations);
        if let [_] = runs.as_slice() {
            trails.push(Trail { kind: stations[0].change.kind, stations, closed, is_loose });
            continue;
        }
        for &(start, end) in &runs {
            let mut part = stations[start..end].to_vec();
            // Lines of two kinds meet in the first station of the second.
            match stations.get(end) {
                Some(next) => part.push(*next),
                None if closed => part.push(stations[0]),
                None => {}
            }
            let is_loose = is_loose && (start == 0 || end == stations.len());
            trails.push(Trail { kind: stations[start].change.kind, stations: part, closed: false, is_loose });
        }
    }
    trails
}
