//! Better matchings by small changes.
//!
//! Alternating cycles that gain weight are turned over until none of up to [`MOST_NEW`] new pairs is
//! left: no such small change makes the matching better.

use super::matching::{Arcs, NONE};
use crate::progress::{Cancelled, Progress};

/// How many pairs a cycle that is turned over has at most; at 4 a fiftieth of the weight is missing,
/// more than 10 find next to nothing.
const MOST_NEW: usize = 8;
/// Less gain than this is rounding.
const LEAST_GAIN: f64 = 1e-9;

/// Turns over alternating cycles that gain weight, and ways from nodes without a partner, until none
/// of up to [`MOST_NEW`] pairs is left.
pub(super) fn improve(arcs: &Arcs, mate: &mut [u32], progress: &Progress) -> Result<(), Cancelled> {
    loop {
        let mut is_done = true;
        for a in 0..mate.len() as u32 {
            if a % 1024 == 0 {
                progress.at(f64::from(a) / mate.len() as f64)?;
            }
            let mut a = a;
            while mate[a as usize] == NONE {
                let Some(way) = gaining_way(arcs, mate, a) else {
                    break;
                };
                is_done = false;
                for pair in way.chunks_exact(2) {
                    (mate[pair[0] as usize], mate[pair[1] as usize]) = (pair[1], pair[0]);
                }
                a = way[way.len() - 1];
                mate[a as usize] = NONE;
            }
            while let Some(cycle) = gaining_cycle(arcs, mate, a) {
                is_done = false;
                for i in (1..cycle.len()).step_by(2) {
                    let [b, c] = [cycle[i], cycle[(i + 1) % cycle.len()]];
                    (mate[b as usize], mate[c as usize]) = (c, b);
                }
            }
        }
        if is_done {
            return Ok(());
        }
    }
}

/// What two partners are worth.
pub(super) fn worth(arcs: &Arcs, a: u32, b: u32) -> f64 {
    let arc = arcs[a as usize].iter().find(|arc| arc.0 == b);
    arc.expect("partners are neighbours").1
}

/// An alternating cycle that begins with a node and its partner and gains weight.
///
/// Every cycle that gains has a node from which on all beginnings gain (Lin & Kernighan 1973), so
/// that others need not be followed.
pub(super) fn gaining_cycle(arcs: &Arcs, mate: &[u32], a: u32) -> Option<Vec<u32>> {
    let b = mate[a as usize];
    if b == NONE {
        return None;
    }
    let mut path = vec![a, b];
    extend(arcs, mate, &mut path, -worth(arcs, a, b)).then_some(path)
}

fn extend(arcs: &Arcs, mate: &[u32], path: &mut Vec<u32>, gain: f64) -> bool {
    let [first, last] = [path[0], path[path.len() - 1]];
    for (next, worth_of_next) in arcs[last as usize] {
        let gain = gain + worth_of_next;
        let is_free = next == NONE || mate[next as usize] == NONE;
        if is_free || gain <= LEAST_GAIN || next == mate[last as usize] {
            continue;
        }
        if next == first {
            return true;
        }
        if path.len() == 2 * MOST_NEW || path.contains(&next) {
            continue;
        }
        let partner = mate[next as usize];
        path.extend([next, partner]);
        if extend(arcs, mate, path, gain - worth(arcs, next, partner)) {
            return true;
        }
        path.truncate(path.len() - 2);
    }
    false
}

/// An alternating way from a node without a partner to one that loses its own, and gains weight.
fn gaining_way(arcs: &Arcs, mate: &[u32], free: u32) -> Option<Vec<u32>> {
    let mut path = vec![free];
    lead(arcs, mate, &mut path, 0.0).then_some(path)
}

fn lead(arcs: &Arcs, mate: &[u32], path: &mut Vec<u32>, gain: f64) -> bool {
    let last = path[path.len() - 1];
    for (next, worth_of_next) in arcs[last as usize] {
        if next == NONE || path.contains(&next) || path.len() > MOST_NEW {
            continue;
        }
        let partner = mate[next as usize];
        let gain = gain + worth_of_next - worth(arcs, next, partner);
        path.extend([next, partner]);
        if gain > LEAST_GAIN || lead(arcs, mate, path, gain) {
            return true;
        }
        path.truncate(path.len() - 2);
    }
    false
}
