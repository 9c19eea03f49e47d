//! The first triangles over a loop, between its own vertices.

use glam::DVec3;

use crate::measure::clip_ears;
use crate::mesh::VertexId;

/// Loops of more vertices lose ears until so many are left, whose best triangles are searched for:
/// that takes the third power of time. Fewer find worse ones.
const SEARCHED: usize = 64;

/// What the square of a diagonal costs beside the area of a triangle. Without it the triangles of a
/// slit, all without area, lie anyhow; tenfold, they leave a bent crescent.
const DIAGONAL: f64 = 0.01;

/// Loops whose triangles have more than this share of their area on a plane are planar enough to
/// be cut there.
const PLANAR: f64 = 0.8;

/// Cuts a loop of three vertices or more into triangles that go round as it does.
pub fn triangles(points: &[DVec3]) -> Vec<[VertexId; 3]> {
    let flat = cut_flat(points);
    if let Some(flat) = flat.as_ref().filter(|flat| flat.is_planar) {
        return named(&flat.triangles);
    }
    let found = cut_in_space(points);
    let area = |triangles: &[[u32; 3]]| -> f64 { triangles.iter().map(|t| area(points, *t)).sum() };
    match flat {
        Some(flat) if area(&flat.triangles) < area(&found) => named(&flat.triangles),
        _ => named(&found),
    }
}

fn named(triangles: &[[u32; 3]]) -> Vec<[VertexId; 3]> {
    triangles.iter().map(|t| t.map(VertexId)).collect()
}

fn twice_area_vector(points: &[DVec3], triangle: [u32; 3]) -> DVec3 {
    let [a, b, c] = triangle.map(|i| points[i as usize]);
    (b - a).cross(c - a)
}

fn area(points: &[DVec3], triangle: [u32; 3]) -> f64 {
    twice_area_vector(points, triangle).length() / 2.0
}

struct Flat {
    triangles: Vec<[u32; 3]>,
    is_planar: bool,
}

/// Triangles that do not overlap on the plane that fits best, where there are such.
fn cut_flat(points: &[DVec3]) -> Option<Flat> {
    let triangles = clip_ears(points)?;
    let vectors: Vec<DVec3> = triangles
        .iter()
        .map(|&t| twice_area_vector(points, t))
        .collect();
    let whole: DVec3 = vectors.iter().sum();
    let normal = whole.try_normalize()?;
    let folded: f64 = vectors.iter().map(|v| -v.dot(normal).min(0.0)).sum();
    let area: f64 = vectors.iter().map(|v| v.length()).sum();
    // What rounding leaves of corners on a straight line is no fold.
    let is_simple = folded <= 1e-9 * whole.length();
    is_simple.then_some(Flat {
        is_planar: whole.length() > PLANAR * area,
        triangles,
    })
}

/// The corners left of a loop, and those beside each.
struct Ring {
    before: Vec<u32>,
    after: Vec<u32>,
}

/// Cuts off the cheapest corners first, then the rest in the best way.
fn cut_in_space(points: &[DVec3]) -> Vec<[u32; 3]> {
    let n = points.len() as u32;
    let mut ring = Ring {
        before: (0..n).map(|i| (i + n - 1) % n).collect(),
        after: (0..n).map(|i| (i + 1) % n).collect(),
    };
    let mut triangles = Vec::with_capacity(points.len() - 2);
    let mut is_left = vec![true; points.len()];
    let mut queue = std::collections::BTreeSet::new();
    let mut prices: Vec<u64> = (0..n).map(|i| price(points, &ring, i)).collect();
    queue.extend((0..n).map(|i| (prices[i as usize], i)));
    while queue.len() > SEARCHED {
        let Some((_, i)) = queue.pop_first() else {
            break;
        };
        is_left[i as usize] = false;
        let [before, after] = [ring.before[i as usize], ring.after[i as usize]];
        triangles.push([before, i, after]);
        ring.after[before as usize] = after;
        ring.before[after as usize] = before;
        for j in [before, after] {
            queue.remove(&(prices[j as usize], j));
            prices[j as usize] = price(points, &ring, j);
            queue.insert((prices[j as usize], j));
        }
    }
    let left: Vec<u32> = (0..n).filter(|&i| is_left[i as usize]).collect();
    let corners: Vec<DVec3> = left.iter().map(|&i| points[i as usize]).collect();
    let best = cut_best(&corners);
    triangles.extend(best.iter().map(|t| t.map(|i| left[i as usize])));
    triangles
}

/// What the corner costs when it is cut off; never negative, so that its bits are in order.
fn price(points: &[DVec3], ring: &Ring, i: u32) -> u64 {
    let ends = [ring.before[i as usize], ring.after[i as usize]];
    cost(points, [ends[0], i, ends[1]]).to_bits()
}

/// What a triangle costs whose longest side in the order of corners is a diagonal.
fn cost(points: &[DVec3], [a, b, c]: [u32; 3]) -> f64 {
    let diagonal = points[a as usize].distance_squared(points[c as usize]);
    area(points, [a, b, c]) + DIAGONAL * diagonal
}

/// The triangles that cost least together (Barequet and Sharir 1995).
fn cut_best(points: &[DVec3]) -> Vec<[u32; 3]> {
    let n = points.len();
    let mut costs = vec![0.0; n * n];
    let mut apexes = vec![0; n * n];
    for span in 2..n {
        for from in 0..n - span {
            let to = from + span;
            let mut least = (f64::INFINITY, from + 1);
            for apex in from + 1..to {
                let own = cost(points, [from, apex, to].map(|i| i as u32));
                let all = costs[from * n + apex] + costs[apex * n + to] + own;
                if all < least.0 {
                    least = (all, apex);
                }
            }
            (costs[from * n + to], apexes[from * n + to]) = least;
        }
    }
    let mut triangles = Vec::with_capacity(n - 2);
    let mut open = vec![[0, n - 1]];
    while let Some([from, to]) = open.pop() {
        if to - from < 2 {
            continue;
        }
        let apex = apexes[from * n + to];
        triangles.push([from, apex, to].map(|i| i as u32));
        open.extend([[from, apex], [apex, to]]);
    }
    triangles
}
