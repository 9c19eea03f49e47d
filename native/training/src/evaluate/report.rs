//! Medians over outcomes: by side and by category.

use std::collections::{BTreeMap, BTreeSet};

use orbflow_geometry::progress::Progress;
use orbflow_network::weights::Header;
use rayon::prelude::*;
use serde::Serialize;

use super::outcome::{Cost, Outcome, Proposed, Proposer, Subject, Whole};
use crate::set::{Set, SetError, Split, Which};

/// Shapes that are measured at once, where no time is.
const N_AT_ONCE: usize = 32;

/// What training knew of a shape.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Side {
    /// It was trained on.
    Train,
    /// It was held back.
    Test,
    /// It is of a set that training was not given.
    Other,
}

/// A shape that is to be measured.
#[derive(Clone, Copy, Debug)]
pub struct Asked<'a> {
    /// On which side it is.
    pub side: Side,
    /// Its set.
    pub set: &'a Set,
    /// Which shape of the set.
    pub which: Which<'a>,
}

/// What was measured.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// The header of the weights.
    pub weights: Header,
    /// The shapes trained on, those held back, those of other sets.
    pub sides: BTreeMap<Side, SideReport>,
    /// Shapes that could not be measured, and why.
    pub left_out: Vec<(String, String)>,
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
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct Summary {
    /// How many shapes.
    pub n_shapes: usize,
    /// The maps of the level, by who proposes them.
    pub proposals: BTreeMap<Proposer, ProposedSummary>,
    /// Of the shapes, in how many percent the network's proposal is worse than the radial one.
    pub worse_than_radial_pct: f64,
    /// The same against the solver before any sweep.
    pub worse_than_unswept_pct: f64,
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

/// Medians over finished maps, in shares of the solver's.
#[derive(Clone, Copy, PartialEq, Debug, Serialize)]
pub struct WholeSummary {
    /// How many shapes were finished.
    pub n_shapes: usize,
    /// Vertices.
    pub n_vertices: f64,
    /// The solver in a hurry.
    pub brisk: CostSummary,
    /// The network, its proposals grown in a hurry.
    pub network: CostSummary,
    /// Of the shapes, in how many percent the proposal was given up.
    pub gave_up_pct: f64,
}

/// Medians of shares.
#[derive(Clone, Copy, PartialEq, Debug, Serialize)]
pub struct CostSummary {
    /// Distortion.
    pub energy_ratio: f64,
    /// Relaxations of single vertices.
    pub relaxations_ratio: f64,
    /// Processor time; none where the system does not tell.
    pub cpu_ratio: Option<f64>,
}

impl<'a> Asked<'a> {
    /// The shapes of a set that training was given.
    pub fn of(set: &'a Set) -> impl Iterator<Item = Self> {
        set.shapes().into_iter().map(move |which| Self {
            side: match which.source.split {
                Split::Train => Side::Train,
                Split::Test => Side::Test,
            },
            set,
            which,
        })
    }

    /// The shapes of a set that training was not given.
    pub fn of_other(set: &'a Set) -> impl Iterator<Item = Self> {
        Self::of(set).map(|asked| Self {
            side: Side::Other,
            ..asked
        })
    }

    /// Its name as part of a file's name: letters, digits and underscores.
    pub fn file_stem(&self) -> String {
        let name = self.which.name();
        name.replace(|c: char| !c.is_ascii_alphanumeric(), "_")
    }

    fn measure(&self, subject: &Subject, finish: bool) -> Result<Measured, SetError> {
        let shape = self.set.read(self.which)?;
        let finish = finish && self.side != Side::Train;
        let outcome = subject.outcome(self.which, &shape, finish);
        Ok(outcome.map_err(|error| (self.which.name(), error.to_string())))
    }
}

/// What was reached on a shape, or its name and why it could not be measured.
type Measured = Result<Outcome, (String, String)>;

/// Evaluates a network on shapes; the maps of shapes that it was not trained on are finished too where
/// `finish` says so.
///
/// # Errors
/// [`SetError`]; a shape that cannot be measured is left out and named.
pub fn report(
    (weights, subject): (&Header, &Subject),
    shapes: &[Asked<'_>],
    finish: bool,
    progress: &Progress,
) -> Result<Report, SetError> {
    // One after the other where processor time is measured: it is that of the whole process.
    let n_at_once = if finish { 1 } else { N_AT_ONCE };
    let mut sides: BTreeMap<Side, Vec<Outcome>> = BTreeMap::new();
    let mut left_out = Vec::new();
    for (i, chunk) in shapes.chunks(n_at_once).enumerate() {
        progress.at((n_at_once * i) as f64 / shapes.len() as f64)?;
        let measured = chunk.par_iter().map(|asked| asked.measure(subject, finish));
        let measured: Vec<_> = measured.collect::<Result<_, _>>()?;
        for (asked, measured) in chunk.iter().zip(measured) {
            match measured {
                Ok(outcome) => sides.entry(asked.side).or_default().push(outcome),
                Err(reason) => left_out.push(reason),
            }
        }
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

/// At most `n` shapes of each side, evenly taken from all of them.
pub fn thinned<'a>(shapes: &[Asked<'a>], n: usize) -> Vec<Asked<'a>> {
    let mut counts: BTreeMap<Side, usize> = BTreeMap::new();
    for shape in shapes {
        *counts.entry(shape.side).or_default() += 1;
    }
    let mut seen: BTreeMap<Side, usize> = BTreeMap::new();
    let is_taken = |shape: &&Asked<'_>| {
        let i = seen.entry(shape.side).or_default();
        *i += 1;
        is_one_of(*i - 1, counts[&shape.side], n)
    };
    shapes.iter().filter(is_taken).copied().collect()
}

/// Whether the `i`-th of `total` is among `n` that are taken evenly: where their number grows by one.
fn is_one_of(i: usize, total: usize, n: usize) -> bool {
    let (n, total) = (n.min(total), total.max(1));
    (i + 1) * n / total > i * n / total
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
        let who = shapes.iter().flat_map(|outcome| outcome.proposals.keys());
        let who: BTreeSet<Proposer> = who.copied().collect();
        let worse_than_pct = |other: Proposer| {
            share_pct(shapes, |outcome| {
                let energy = |who: Proposer| outcome.proposals[&who].energy;
                energy(Proposer::Network) > energy(other)
            })
        };
        Self {
            n_shapes: shapes.len(),
            proposals: who
                .into_iter()
                .map(|who| (who, ProposedSummary::new(shapes, who)))
                .collect(),
            worse_than_radial_pct: worse_than_pct(Proposer::Radial),
            worse_than_unswept_pct: worse_than_pct(Proposer::Unswept),
            angles_deg: [0, 1].map(|i| median(shapes.iter().map(|outcome| outcome.angles_deg[i]))),
            whole: WholeSummary::new(shapes),
        }
    }
}

impl ProposedSummary {
    fn new(shapes: &[&Outcome], who: Proposer) -> Self {
        let proposed = || {
            shapes
                .iter()
                .filter_map(|outcome| outcome.proposals.get(&who))
        };
        let figures = |figure: &dyn Fn(&Proposed) -> f64| median(proposed().map(figure));
        let ratios = || {
            let ratio = |outcome: &&Outcome| {
                let energy = outcome.proposals.get(&who)?.energy;
                Some(energy / outcome.proposals[&Proposer::Solver].energy)
            };
            shapes.iter().filter_map(ratio)
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
        (!wholes.is_empty()).then(|| Self {
            n_shapes: wholes.len(),
            n_vertices: median(wholes.iter().map(|whole| whole.n_vertices as f64)),
            brisk: CostSummary::new(&wholes, |whole| &whole.brisk),
            network: CostSummary::new(&wholes, |whole| &whole.network),
            gave_up_pct: share_pct(&wholes, |whole| whole.gave_up),
        })
    }
}

impl CostSummary {
    fn new(wholes: &[Whole], which: fn(&Whole) -> &Cost) -> Self {
        let ratio = |figure: fn(&Cost) -> f64| {
            let ratio =
                |whole: &Whole| figure(which(whole)) / figure(&whole.solver).max(f64::MIN_POSITIVE);
            median(wholes.iter().map(ratio))
        };
        let tells_time = wholes.iter().all(|whole| whole.solver.cpu_ms.is_some());
        Self {
            energy_ratio: ratio(|cost| cost.energy),
            relaxations_ratio: ratio(|cost| cost.n_relaxations as f64),
            cpu_ratio: tells_time.then(|| ratio(|cost| cost.cpu_ms.unwrap_or(0.0))),
        }
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

    #[test]
    fn shapes_are_taken_evenly() {
        for (total, most) in [
            (100, 0),
            (100, 1),
            (100, 10),
            (7, 3),
            (7, 10),
            (0, 4),
            (7, usize::MAX),
        ] {
            let n = (0..total).filter(|&i| is_one_of(i, total, most)).count();
            assert_eq!(n, most.min(total));
        }
        let ten: Vec<usize> = (0..100).filter(|&i| is_one_of(i, 100, 10)).collect();
        assert_eq!(ten, [9, 19, 29, 39, 49, 59, 69, 79, 89, 99]);
    }

    #[test]
    fn quantiles_are_values_of_the_list() {
        let values = [3.0, 1.0, 2.0, 5.0, 4.0];
        assert_eq!(median(values.into_iter()).to_bits(), 3f64.to_bits());
        assert_eq!(quantile(values.into_iter(), 0.9).to_bits(), 5f64.to_bits());
        assert_eq!(median(std::iter::empty()).to_bits(), 0f64.to_bits());
    }
}
