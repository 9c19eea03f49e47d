//! Lines as linear equations on the periods.

use glam::{DVec2, IVec2};

use super::seams::Walker;
use super::sides::Sides;
use crate::flow::complex::{Complex, Counted, FirmLine, Tie, Turn};
use crate::flow::periods::{Part, real_row};
use crate::flow::rings::off_axis;

/// A line is not put onto an axis from which its wish is farther than this share of its length.
const OBLIQUE: f64 = 0.5;

/// The equation that puts a line along an axis.
pub struct Row {
    /// Its factors, one for each real part of the periods.
    pub row: Vec<f64>,
    /// Whether the line has to be met.
    pub is_firm: bool,
}

/// The equations that put the lines of a complex with chosen periods along the axes they are
/// wished to be near, those of firm lines first; none for lines that are wished to be oblique
/// and not firm, and those of ties.
pub fn rows(complex: &Complex) -> Vec<Row> {
    let is_tied = |line: &usize| (complex.chains.ties.iter()).any(|tie| tie.lines.contains(line));
    let lines = (0..complex.chains.n_lines()).filter(|line| !is_tied(line));
    let mut rows: Vec<Row> = lines.filter_map(|line| row(complex, line)).collect();
    rows.sort_by_key(|row| !row.is_firm);
    rows
}

/// The equations that make the lines of ties each other's images, two for each tie.
pub fn tie_rows(complex: &Complex) -> Vec<Vec<f64>> {
    let ties = complex.chains.ties.iter();
    ties.flat_map(|&tie| tied(complex, tie)).collect()
}

fn tied(complex: &Complex, Tie { lines, turns }: Tie) -> [Vec<f64>; 2] {
    let [own, image] = lines.map(|line| complex.coefficients_along(line));
    let own: Vec<IVec2> = own.iter().map(|x| x.turned(turns)).collect();
    // Conjugation keeps the real part and turns the other round.
    [(Part::Real, -1.0), (Part::Imaginary, 1.0)].map(|(part, sign)| {
        let own = real_row(&own, part).into_iter();
        let image = real_row(&image, part).into_iter();
        image.zip(own).map(|(a, b)| a + sign * b).collect()
    })
}

/// The equations that make the two loops of twins equally long, one for each two: the sum of
/// lengths of their lines, each along the axis and in the direction that it is wished to be near.
pub fn twin_rows(complex: &Complex) -> Vec<Vec<f64>> {
    let twins = complex.chains.twins.iter().map(|[own, other]| {
        let [own, other] = [own, other].map(|lines| length_of(complex, lines));
        own.iter().zip(other).map(|(a, b)| a - b).collect()
    });
    twins.collect()
}

/// The length of a loop of lines as a sum over periods.
fn length_of(complex: &Complex, lines: &[usize]) -> Vec<f64> {
    let mut sum = vec![0.0; 2 * complex.coefficients.n_columns()];
    for &line in lines {
        let wished = complex.sum_along(line, &complex.wish);
        let along = match off_axis(wished) {
            Part::Real => Part::Imaginary,
            Part::Imaginary => Part::Real,
        };
        let sign = along.of(wished).signum();
        let row = real_row(&complex.coefficients_along(line), along);
        for (value, part) in sum.iter_mut().zip(row) {
            *value += sign * part;
        }
    }
    sum
}

fn row(complex: &Complex, line: usize) -> Option<Row> {
    let wished = complex.sum_along(line, &complex.wish);
    let part: Part = off_axis(wished);
    let is_firm = complex.chains.is_firm(line);
    if !is_firm && part.of(wished).abs() > OBLIQUE * wished.length() {
        return None;
    }
    Some(Row {
        row: real_row(&complex.coefficients_along(line), part),
        is_firm,
    })
}

/// Firm lines as sums of periods, to tell in how many a grid has no straight way between the ends.
pub struct Firm {
    lines: Vec<(Vec<IVec2>, FirmLine)>,
    counted: Counted,
}

/// What a grid tells of firm lines.
pub struct Told {
    /// How many have no straight way.
    pub n_unmet: usize,
    /// By how much all quads are to become more, so that those that count are as many as wanted.
    pub growth: Option<f64>,
}

impl Firm {
    /// The firm lines of a complex with chosen periods.
    pub fn of(complex: &Complex) -> Self {
        let lines = complex.chains.firm.iter();
        Self {
            lines: lines
                .map(|firm| (complex.coefficients_along(firm.line), *firm))
                .collect(),
            counted: complex.chains.counted.clone(),
        }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.lines.is_empty()
    }

    /// What a grid of the given periods tells of them.
    pub fn told(&self, (quads, n_vertices): (&[[u32; 4]], usize), periods: &[f64]) -> Told {
        let mut told = Told {
            n_unmet: 0,
            growth: None,
        };
        if self.lines.is_empty() {
            return told;
        }
        let ends = self.lines.iter().map(|(_, firm)| firm.ends);
        let walker = Walker::new(quads, n_vertices).stopping_at(ends);
        let periods = periods.as_chunks::<2>().0;
        let mut borders = Vec::new();
        for (coefficients, firm) in &self.lines {
            let span = coefficients.iter().zip(periods);
            let span: DVec2 = span.map(|(c, &x)| c.as_dvec2().rotate(x.into())).sum();
            let walks = walker.along(span, firm.ends);
            told.n_unmet += usize::from(walks.is_empty());
            if firm.is_border {
                borders.push(walks);
            }
        }
        if let Some(n_wanted) = self.counted.n_wanted.filter(|_| told.n_unmet == 0) {
            let n_real = Sides::new(quads, &self.counted.is_real).n_real(&borders);
            told.growth = (n_real > 0).then(|| n_wanted as f64 / n_real as f64);
        }
        told
    }
}
