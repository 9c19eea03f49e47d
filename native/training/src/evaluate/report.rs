//! Medians over outcomes: by side and by category.

use std::collections::BTreeMap;
use std::path::PathBuf;

use orbflow_geometry::progress::{Cancelled, Progress};
use orbflow_network::weights::Header;
use serde::Serialize;

use super::outcome::{Cost, Outcome, Proposed, Subject, Whole};
use crate::collect::{Gathered, Item, N_AT_ONCE, Side, gather};

/// What was measured.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// The header of the weights.
    pub weights: Header,
    /// The shapes trained on, those held back, those of other folders.
    pub sides: BTreeMap<Side, SideReport>,
    /// Files without a usable part, and why.
    pub left_out: Vec<(PathBuf, String)>,
}

/// What was measured on one side.
#[derive(Clone, Debug, Serialize)]
pub struct SideReport {
    /// All shapes.
    pub overall: Summary,
    /// The shapes of each category.
    pub categories: BTreeMap<String, Summary>,
    /// One by one.
    pub shapes: Vec<Outcome>,
}

/// Medians over some shapes.
#[derive(Clone, Copy, PartialEq, Debug, Serialize)]
pub struct Summary {
    /// How many shapes.
    pub n_shapes: usize,
    /// The directions from the centre.
    pub radial: ProposedSummary,
    /// The network's proposals, before any repair.
    pub network: ProposedSummary,
    /// The solver's maps of the level.
    pub solver: ProposedSummary,
    /// Of the shapes, in how many percent the network's proposal is worse than the radial one.
    pub worse_than_radial_pct: f64,
    /// Medians of the angles to the solver's points: the median and what 90 % stay below.
    pub angles_deg: [f64; 2],
    /// The finished maps of whole meshes.
    pub whole: Option<WholeSummary>,
}

/// Medians over proposals.
#[derive(Clone, Copy, PartialEq, Debug, Serialize)]
pub struct ProposedSummary {
    /// Distortion.
    pub energy: f64,
    /// Distortion in shares of the solver's: the median.
    pub energy_ratio: f64,
    /// What 90 % of these shares stay below.
    pub energy_ratio_p90: f64,
    /// Folded triangles of a hundred.
    pub folds_pct: f64,
    /// Of the rebuilt shape, what is right, within half a percent of the diagonal and within one.
    pub precision_pct: [f64; 2],
    /// Of the shape, what was rebuilt.
    pub recall_pct: [f64; 2],
    /// Their harmonic mean.
    pub f1_pct: [f64; 2],
}

/// Medians over finished maps: the network's figures in shares of the solver's.
#[derive(Clone, Copy, PartialEq, Debug, Serialize)]
pub struct WholeSummary {
    /// How many shapes were finished.
    pub n_shapes: usize,
    /// Vertices.
    pub n_vertices: f64,
    /// Distortion.
    pub energy_ratio: f64,
    /// Relaxations of single vertices.
    pub relaxations_ratio: f64,
    /// Processor time; none where the system does not tell.
    pub cpu_ratio: Option<f64>,
    /// Of the shapes, in how many percent the proposal was given up.
    pub gave_up_pct: f64,
}

/// Evaluates a network on the shapes of some items; the maps of shapes that it was not trained on
/// are finished too where `finish` says so.
///
/// # Errors
/// [`Cancelled`]; a file whose shapes cannot be used is left out and named.
pub fn report(
    (weights, subject): (&Header, &Subject),
    items: &[Item],
    finish: bool,
    progress: &Progress,
) -> Result<Report, Cancelled> {
    let outcome = |side, shape| subject.outcome(shape, finish && side != Side::Training);
    // One after the other where processor time is measured: it is that of the whole process.
    let n_at_once = if finish { 1 } else { N_AT_ONCE };
    let Gathered { all, left_out } = gather(items, outcome, n_at_once, progress)?;
    let mut sides: BTreeMap<Side, Vec<Outcome>> = BTreeMap::new();
    for (side, outcome) in all {
        sides.entry(side).or_default().push(outcome);
    }
    let sides = sides.into_iter();
    Ok(Report {
        weights: weights.clone(),
        sides: sides
            .map(|(side, shapes)| (side, SideReport::new(shapes)))
            .collect(),
        left_out,
    })
}

/// At most `n` items of each side, evenly taken from all of them.
pub fn thinned(items: &[Item], n: usize) -> Vec<Item> {
    let count = |side: Side| items.iter().filter(|item| item.side == side).count();
    let counts = [Side::Training, Side::HeldOut, Side::Other].map(|side| (side, count(side)));
    let counts = BTreeMap::from(counts);
    let mut seen: BTreeMap<Side, usize> = BTreeMap::new();
    let is_taken = |item: &&Item| {
        let (total, i) = (counts[&item.side], seen.entry(item.side).or_default());
        *i += 1;
        // Where the number of items taken grows by one.
        *i * n / total.max(n) > (*i - 1) * n / total.max(n)
    };
    items.iter().filter(is_taken).cloned().collect()
}

impl SideReport {
    fn new(shapes: Vec<Outcome>) -> Self {
        let mut categories: BTreeMap<String, Vec<&Outcome>> = BTreeMap::new();
        for shape in &shapes {
            let list = categories.entry(shape.category.clone()).or_default();
            list.push(shape);
        }
        let categories = categories.into_iter();
        Self {
            overall: Summary::new(&shapes.iter().collect::<Vec<_>>()),
            categories: categories
                .map(|(name, shapes)| (name, Summary::new(&shapes)))
                .collect(),
            shapes,
        }
    }
}

impl Summary {
    fn new(shapes: &[&Outcome]) -> Self {
        let proposed = |which: fn(&Outcome) -> &Proposed| ProposedSummary::new(shapes, which);
        Self {
            n_shapes: shapes.len(),
            radial: proposed(|outcome| &outcome.radial),
            network: proposed(|outcome| &outcome.network),
            solver: proposed(|outcome| &outcome.solver),
            worse_than_radial_pct: share_pct(shapes, |outcome| {
                outcome.network.energy > outcome.radial.energy
            }),
            angles_deg: [0, 1].map(|i| median(shapes.iter().map(|outcome| outcome.angles_deg[i]))),
            whole: WholeSummary::new(shapes),
        }
    }
}

impl ProposedSummary {
    fn new(shapes: &[&Outcome], which: fn(&Outcome) -> &Proposed) -> Self {
        let figures = |figure: &dyn Fn(&Proposed) -> f64| {
            median(shapes.iter().map(|outcome| figure(which(outcome))))
        };
        let ratios = || {
            let ratio = |outcome: &&Outcome| which(outcome).energy / outcome.solver.energy;
            shapes.iter().map(ratio)
        };
        let pair = |figure: fn(&Proposed) -> [f64; 2]| [0, 1].map(|i| figures(&|p| figure(p)[i]));
        Self {
            energy: figures(&|p| p.energy),
            energy_ratio: median(ratios()),
            energy_ratio_p90: quantile(ratios(), 0.9),
            folds_pct: figures(&|p| p.folds_pct),
            precision_pct: pair(|p| p.rebuilt.precision_pct),
            recall_pct: pair(|p| p.rebuilt.recall_pct),
            f1_pct: pair(|p| p.rebuilt.f1_pct),
        }
    }
}

impl WholeSummary {
    fn new(shapes: &[&Outcome]) -> Option<Self> {
        let wholes: Vec<_> = shapes.iter().filter_map(|outcome| outcome.whole).collect();
        let ratio = |figure: fn(&Cost) -> f64| {
            let ratio = |whole: &Whole| {
                figure(&whole.network) / figure(&whole.solver).max(f64::MIN_POSITIVE)
            };
            median(wholes.iter().map(ratio))
        };
        let tells_time = |whole: &Whole| whole.solver.cpu_ms.is_some();
        (!wholes.is_empty()).then(|| Self {
            n_shapes: wholes.len(),
            n_vertices: median(wholes.iter().map(|whole| whole.n_vertices as f64)),
            energy_ratio: ratio(|cost| cost.energy),
            relaxations_ratio: ratio(|cost| cost.n_relaxations as f64),
            cpu_ratio: wholes
                .iter()
                .all(tells_time)
                .then(|| ratio(|cost| cost.cpu_ms.unwrap_or(0.0))),
            gave_up_pct: share_pct(&wholes, |whole| whole.gave_up),
        })
    }
}

fn share_pct<T>(all: &[T], is_counted: impl Fn(&T) -> bool) -> f64 {
    let n = all.iter().filter(|one| is_counted(one)).count();
    100.0 * n as f64 / all.len().max(1) as f64
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    quantile(values, 0.5)
}

/// The value that a share of all stays below; zero of none.
fn quantile(values: impl Iterator<Item = f64>, share: f64) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    let last = values.len().saturating_sub(1);
    values
        .get((share * last as f64).round() as usize)
        .copied()
        .unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::collect::{Sources, items};

    #[test]
    fn every_side_is_thinned_evenly() {
        let sources = Sources {
            n_shapes: 100,
            n_held_out: 7,
            folders: Vec::new(),
        };
        let all = items(&sources).expect("there is nothing to read");
        for most in [0, 1, 3, 10, 200] {
            let few = thinned(&all, most);
            let of = |side: Side| few.iter().filter(|item| item.side == side).count();
            assert_eq!(of(Side::Training), most.min(100));
            assert_eq!(of(Side::HeldOut), most.min(7));
        }
        let ten = thinned(&all, 10);
        assert_eq!(
            [&ten[0], &ten[1], &ten[9]],
            [&all[9], &all[19], &all[99]],
            "one of every ten"
        );
    }

    #[test]
    fn quantiles_are_values_of_the_list() {
        let values = [3.0, 1.0, 2.0, 5.0, 4.0];
        assert_eq!(median(values.into_iter()).to_bits(), 3f64.to_bits());
        assert_eq!(quantile(values.into_iter(), 0.9).to_bits(), 5f64.to_bits());
        assert_eq!(median(std::iter::empty()).to_bits(), 0f64.to_bits());
    }
}
