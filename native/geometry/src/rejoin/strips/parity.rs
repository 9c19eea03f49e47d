//! Odd differences: strips that are doubled together.
//!
//! A sheet of quads has an even number of border edges, so one more on a line means one more or less
//! elsewhere: at the other end of a strip. Which strips to double is a linear equation modulo 2 for
//! each two neighbouring sheets of a line; the cheapest strips that solve all of them are taken, or
//! as many as can be.

use std::collections::{BTreeMap, BTreeSet};

use super::{Leveling, Strip};
use crate::progress::{Cancelled, Progress};
use crate::rejoin::Edge;

/// A strip of a sheet that had better stay costs so much more.
const KEPT: f64 = 1e3;

/// A set of equations as bits.
type Bits = Vec<u64>;

/// Equations that a strip changes.
struct Column {
    sheet: usize,
    /// An edge on a line that the strip crosses.
    edge: Edge,
    bits: Bits,
    cost: f64,
}

impl Leveling {
    /// Doubles strips until the counts of each line differ by even numbers, as far as can be.
    pub(super) fn make_even(&mut self, progress: &Progress<'_>) -> Result<(), Cancelled> {
        let (rows, is_odd) = self.rows();
        if is_odd.iter().all(|&bits| bits == 0) {
            return Ok(());
        }
        let mut columns = self.columns(&rows, progress)?;
        columns.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        for which in solved(&columns, is_odd) {
            let Column { sheet, edge, .. } = columns[which];
            let sides = self.sides(sheet);
            if sides.contains_key(&edge)
                && let Some(strip) = self.strip(edge, sheet, &sides)
            {
                self.double(&strip);
            }
        }
        Ok(())
    }

    /// The number of the equation of each line's chains but its first: it has as many edges as the one
    /// before, modulo 2. And which of them are not fulfilled.
    fn rows(&self) -> (Vec<Vec<[Option<usize>; 2]>>, Bits) {
        let mut n = 0_usize;
        let mut odd = Vec::new();
        let mut rows = Vec::new();
        for chains in &self.chains {
            let mut of_line = vec![[None, None]; chains.len()];
            // Other faces than quads are cut wherever it is needed.
            let are_quads = |k: &usize| self.are_quads[chains[*k].sheet];
            let of_quads: Vec<usize> = (0..chains.len()).filter(are_quads).collect();
            for pair in of_quads.windows(2) {
                of_line[pair[0]][1] = Some(n);
                of_line[pair[1]][0] = Some(n);
                let length = |k: usize| chains[k].vertices.len();
                odd.push((length(pair[0]) + length(pair[1])) % 2 == 1);
                n += 1;
            }
            rows.push(of_line);
        }
        let mut is_odd = vec![0; n.div_ceil(64)];
        for (i, _) in odd.iter().enumerate().filter(|(_, odd)| **odd) {
            flip(&mut is_odd, i);
        }
        (rows, is_odd)
    }

    /// All strips that cross lines.
    fn columns(
        &self,
        rows: &[Vec<[Option<usize>; 2]>],
        progress: &Progress<'_>,
    ) -> Result<Vec<Column>, Cancelled> {
        let n_bits = rows.iter().flatten().flatten().flatten().max();
        let n_words = n_bits.map_or(0, |&n| n / 64 + 1);
        let mut columns = Vec::new();
        for sheet in (0..self.faces.len()).filter(|&sheet| self.are_quads[sheet]) {
            progress.check()?;
            let mut on: BTreeMap<Edge, Vec<usize>> = BTreeMap::new();
            for (chains, rows) in self.chains.iter().zip(rows) {
                let own = chains.iter().zip(rows).filter(|(c, _)| c.sheet == sheet);
                for (chain, rows) in own {
                    for edge in chain.edges() {
                        on.entry(edge).or_default().extend(rows.iter().flatten());
                    }
                }
            }
            if on.is_empty() {
                continue;
            }
            let sides = self.sides(sheet);
            let mut seen: BTreeSet<Edge> = BTreeSet::new();
            for &edge in on.keys() {
                if seen.contains(&edge) {
                    continue;
                }
                let Some(strip) = self.strip(edge, sheet, &sides) else {
                    continue;
                };
                seen.extend(&strip.rungs);
                let mut bits = vec![0; n_words];
                let crossed = strip.rungs.iter().filter_map(|rung| on.get(rung));
                crossed.flatten().for_each(|&row| flip(&mut bits, row));
                if bits.iter().any(|&word| word != 0) {
                    columns.push(Column {
                        sheet,
                        edge,
                        bits,
                        cost: self.cost(&strip),
                    });
                }
            }
        }
        Ok(columns)
    }

    /// What it costs to double a strip: its faces, as many more as its edges on lines are short.
    fn cost(&self, strip: &Strip) -> f64 {
        let lengths = strip.rungs.iter().map(|&edge| self.length(edge));
        let mean = lengths.sum::<f64>() / strip.rungs.len() as f64;
        let kept = if self.is_kept[strip.sheet] { KEPT } else { 1.0 };
        kept * strip.faces.len() as f64 / mean.max(f64::MIN_POSITIVE)
    }
}

/// Which columns make the odd equations even; where that cannot be for all, for as many as are found.
fn solved(columns: &[Column], mut is_odd: Bits) -> Vec<usize> {
    // Each pivot column reduced by those before, with the columns that it is made of.
    let mut pivots: Vec<(usize, Bits, Vec<usize>)> = Vec::new();
    for (i, column) in columns.iter().enumerate() {
        let (mut bits, mut of) = (column.bits.clone(), vec![i]);
        for (at, pivot, made_of) in &pivots {
            if is_set(&bits, *at) {
                add(&mut bits, pivot);
                of.extend(made_of);
            }
        }
        if let Some(at) = first(&bits) {
            pivots.push((at, bits, of));
        }
    }
    let mut wanted: BTreeMap<usize, bool> = BTreeMap::new();
    for (at, pivot, made_of) in &pivots {
        if is_set(&is_odd, *at) {
            add(&mut is_odd, pivot);
            for &i in made_of {
                let twice = wanted.entry(i).or_insert(false);
                *twice = !*twice;
            }
        }
    }
    let odd = wanted.into_iter().filter(|&(_, is_odd)| is_odd);
    odd.map(|(i, _)| i).collect()
}

fn flip(bits: &mut Bits, i: usize) {
    bits[i / 64] ^= 1 << (i % 64);
}

fn is_set(bits: &Bits, i: usize) -> bool {
    bits[i / 64] >> (i % 64) & 1 == 1
}

fn add(bits: &mut Bits, other: &Bits) {
    for (word, other) in bits.iter_mut().zip(other) {
        *word ^= other;
    }
}

/// The first bit that is set.
fn first(bits: &Bits) -> Option<usize> {
    let word = bits.iter().position(|&word| word != 0)?;
    Some(64 * word + bits[word].trailing_zeros() as usize)
}
