//! Tells the vertices of a loop off against the points of the border that it lies on.
//!
//! The cheapest way through both at once, from a pair of them round to the same pair: along what is
//! held, blocks of one edge against one, of one against some, or of some against one; along what is
//! free any number against any.

use glam::DVec3;

use super::Border;
use crate::progress::{Cancelled, Progress};

/// What a block with a triangle costs more, in squares of an edge. One of one edge against three costs
/// 1, against five 3, against seven 6: a place off by one edge is worth about two vertices of another
/// valence.
const COST_OF_ODD: f64 = 40.0;
/// Against how many edges one may stand where counts are alike, and at most.
const USUAL: usize = 9;
const MOST: usize = 41;
/// The same in triangles.
const COST_OF_TRIANGLE: f64 = 0.7;
/// What a vertex costs that has one face and loses the border: it gets two in all.
const COST_OF_EAR: f64 = 20.0;
/// What a vertex costs that has a right angle, or a third of two in triangles, too many or too few.
const COST_OF_ANGLE: f64 = 0.5;
/// What a place off the border costs where nothing stays, as a share.
const FREE: f64 = 0.05;
/// How many pairs are tried to begin with, to each side of the nearest.
const N_BESIDE: usize = 2;
/// Of larger tables the nearest pair alone.
const LARGE: usize = 1_000_000;
/// Places of a loop whose distance from a border is asked.
const N_ASKED: usize = 12;

/// A loop of vertices.
pub struct Chain<'a> {
    pub places: Vec<DVec3>,
    /// How many faces each of them has.
    pub valences: Vec<usize>,
    pub are_quads: bool,
    /// Whether two of them are the ends of an edge.
    pub is_joined: &'a dyn Fn(usize, usize) -> bool,
}

/// Vertices of the loop against points of the border, by their numbers; one of both has one edge.
pub struct Block {
    pub made: Vec<usize>,
    pub line: Vec<usize>,
}

/// Which vertex stands where.
pub struct Aligned {
    pub blocks: Vec<Block>,
    /// Points at which something stays that has no edge there.
    pub pins: Vec<(usize, usize)>,
    cost: f64,
    /// The pairs on the way.
    way: Vec<[usize; 2]>,
}

/// A step of so many vertices and so many points.
type Step = [u8; 2];

/// How far places are from a border in the mean, some of them.
pub fn distance(places: &[DVec3], border: &Border) -> f64 {
    let some = places.iter().step_by(places.len().div_ceil(N_ASKED));
    let n = some.len() as f64;
    let off = |p: &DVec3| {
        let next = border.points.iter().cycle().skip(1);
        let pieces = border.points.iter().zip(next);
        let away = pieces.map(|(&a, &b)| {
            let along = b - a;
            let share = (*p - a).dot(along) / along.length_squared().max(f64::MIN_POSITIVE);
            (a + along * share.clamp(0.0, 1.0)).distance(*p)
        });
        away.fold(f64::INFINITY, f64::min)
    };
    some.map(off).sum::<f64>() / n.max(1.0)
}

impl Chain<'_> {
    /// Which vertex stands for which point; none where one edge would have to stand for too many.
    ///
    /// # Errors
    /// When cancelled.
    pub fn aligned(
        &self,
        border: &Border,
        progress: &Progress<'_>,
    ) -> Result<Option<Aligned>, Cancelled> {
        let n = self.places.len();
        let held = |j: usize| border.is_held[j];
        let m = border.points.len();
        let is_inside = |j: &usize| held(*j) && held((j + m - 1) % m);
        let first = (0..m).find(is_inside).or_else(|| (0..m).find(|&j| held(j)));
        let first = first.or_else(|| border.names.iter().position(Option::is_some));
        let Some(first) = first else {
            return Ok(None);
        };
        let Some(found) = self.best_from(border, first, progress)? else {
            return Ok(None);
        };
        // Once more from the other side of the loop, where the first pair has no say.
        let half = found.way[found.way.len() / 2];
        let other = (0..m).map(|k| (half[1] + k) % m).find(is_inside);
        let Some(other) = other.filter(|&other| other != first) else {
            return Ok(Some(found));
        };
        let at = found.way.iter().position(|pair| pair[1] % m == other);
        let again = match at {
            Some(at) => self.round(border, [found.way[at][0] % n, other], progress)?,
            None => self.best_from(border, other, progress)?,
        };
        Ok(Some(match again {
            Some(again) if again.cost < found.cost => again,
            _ => found,
        }))
    }

    fn best_from(
        &self,
        border: &Border,
        first: usize,
        progress: &Progress<'_>,
    ) -> Result<Option<Aligned>, Cancelled> {
        let n = self.places.len();
        let off = |&i: &usize| self.places[i].distance_squared(border.points[first]);
        let nearest = (0..n).min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(0);
        let is_large = n * border.points.len() > LARGE;
        let beside = if is_large {
            0
        } else {
            N_BESIDE.min((n - 1) / 2)
        };
        let mut best: Option<Aligned> = None;
        for k in 0..=2 * beside {
            let from = (nearest + n + k - beside) % n;
            if let Some(found) = self.round(border, [from, first], progress)?
                && best.as_ref().is_none_or(|best| found.cost < best.cost)
            {
                best = Some(found);
            }
        }
        Ok(best)
    }

    /// The cheapest way from a pair round to it.
    fn round(
        &self,
        border: &Border,
        from: [usize; 2],
        progress: &Progress<'_>,
    ) -> Result<Option<Aligned>, Cancelled> {
        let (n, m) = (self.places.len(), border.points.len());
        let table = Table {
            chain: self,
            border,
            from,
            edge: border.length() / n as f64,
            most: (2 * n.max(m) / n.min(m)).clamp(USUAL, MOST),
        };
        let mut costs = vec![f64::INFINITY; (n + 1) * (m + 1)];
        let mut steps: Vec<Step> = vec![[0, 0]; costs.len()];
        costs[0] = table.off(0, 0);
        for i in 0..=n {
            progress.check()?;
            for j in 0..=m {
                if (i, j) != (0, 0) {
                    let at = i * (m + 1) + j;
                    (costs[at], steps[at]) = table.best((i, j), &costs);
                }
            }
        }
        let cost = costs[costs.len() - 1];
        Ok(cost.is_finite().then(|| table.told(cost, &steps)))
    }
}

/// Both loops from a pair on.
struct Table<'a> {
    chain: &'a Chain<'a>,
    border: &'a Border,
    from: [usize; 2],
    /// The mean edge of the loop.
    edge: f64,
    /// Against how many edges one may stand.
    most: usize,
}

impl Table<'_> {
    fn made(&self, i: usize) -> usize {
        (self.from[0] + i) % self.chain.places.len()
    }

    fn point(&self, j: usize) -> usize {
        (self.from[1] + j) % self.border.points.len()
    }

    /// Whether something stays beyond the edge that ends at a point.
    fn is_held_before(&self, j: usize) -> bool {
        let m = self.border.points.len();
        self.border.is_held[(self.from[1] + j + m - 1) % m]
    }

    fn is_held_after(&self, j: usize) -> bool {
        self.border.is_held[self.point(j)]
    }

    fn off(&self, i: usize, j: usize) -> f64 {
        let [p, q] = [
            self.chain.places[self.made(i)],
            self.border.points[self.point(j)],
        ];
        p.distance_squared(q) / (self.edge * self.edge).max(f64::MIN_POSITIVE)
    }

    /// What it costs that a vertex has other angles than the border wants there, with more faces.
    fn lack(&self, i: usize, j: usize, more: f64) -> f64 {
        let wanted = if self.chain.are_quads { 90.0 } else { 60.0 };
        let angle = self.border.angles[self.point(j)].to_degrees() / wanted;
        let off = self.chain.valences[self.made(i)] as f64 + more - angle;
        COST_OF_ANGLE * off * off
    }

    /// The cheapest step to a pair.
    fn best(&self, (i, j): (usize, usize), costs: &[f64]) -> (f64, Step) {
        let m = self.border.points.len();
        let before = |step: Step| costs[(i - step[0] as usize) * (m + 1) + j - step[1] as usize];
        let mut best = (f64::INFINITY, [0, 0]);
        let mut take = |step: Step, cost: f64| {
            let cost = before(step) + cost;
            if cost < best.0 {
                best = (cost, step);
            }
        };
        let off = self.off(i, j);
        if j > 0 && i > 0 && self.is_held_before(j) {
            let off = off + self.lack(i, j, 0.0);
            take([1, 1], off);
            for k in 2..=self.most {
                if k <= j && self.is_held_before(j + 1 - k) && self.are_held(j, k) {
                    take([1, k as u8], off + self.cost(k));
                }
                if k <= i && !(self.chain.is_joined)(self.made(i - k), self.made(i)) {
                    let is_ear = |&i: &usize| self.chain.valences[self.made(i)] == 1;
                    let ears = (i + 1 - k..i).filter(is_ear).count() as f64 * COST_OF_EAR;
                    // Both ends get a face more.
                    let more = |i, j| self.lack(i, j, 1.0) - self.lack(i, j, 0.0);
                    let more = more(i, j) + more(i - k, j - 1);
                    take([k as u8, 1], off + self.cost(k) + ears + more);
                }
            }
            return best;
        }
        if j > 0 && !self.is_held_before(j) {
            if i > 0 {
                take([1, 1], FREE * off);
            }
            let is_named = self.border.names[self.point(j)].is_some();
            if !self.is_held_after(j) && !is_named {
                let [a, b] = [j - 1, j].map(|j| self.border.points[self.point(j)]);
                take(
                    [0, 1],
                    FREE * off * a.distance(b) / self.edge.max(f64::MIN_POSITIVE),
                );
            }
        }
        if i > 0 && (!self.is_held_before(j) || !self.is_held_after(j)) {
            take([1, 0], FREE * off);
        }
        best
    }

    /// Whether something stays beyond each of the last edges before a point.
    fn are_held(&self, j: usize, n: usize) -> bool {
        (0..n).all(|k| self.is_held_before(j - k))
    }

    fn cost(&self, n: usize) -> f64 {
        if self.chain.are_quads {
            let pairs = ((n - 1) / 2) as f64;
            let odd = if n.is_multiple_of(2) {
                COST_OF_ODD
            } else {
                0.0
            };
            odd + pairs * (pairs + 1.0) / 2.0
        } else {
            COST_OF_TRIANGLE * (n - 1) as f64
        }
    }

    fn told(&self, cost: f64, steps: &[Step]) -> Aligned {
        let m = self.border.points.len();
        let (mut i, mut j) = (self.chain.places.len(), m);
        let mut way = vec![[i, j]];
        while (i, j) != (0, 0) {
            let [a, b] = steps[i * (m + 1) + j];
            (i, j) = (i - a as usize, j - b as usize);
            way.push([i, j]);
        }
        way.reverse();
        let (mut blocks, mut pins) = (Vec::new(), Vec::new());
        for pair in way.windows(2) {
            let [[i, j], [to, end]] = [pair[0], pair[1]];
            if end > j && self.is_held_before(end) {
                blocks.push(Block {
                    made: (i..=to).map(|i| self.made(i)).collect(),
                    line: (j..=end).map(|j| self.point(j)).collect(),
                });
            } else if end > j && !self.is_held_after(end) {
                let is_named = self.border.names[self.point(end)].is_some();
                pins.extend(is_named.then(|| (self.made(to), self.point(end))));
            }
        }
        let named = |[i, j]: [usize; 2]| [self.made(i), self.point(j)];
        Aligned {
            blocks,
            pins,
            cost,
            way: way.into_iter().map(named).collect(),
        }
    }
}
