//! Real linear equations on periods: what makes a loop close along an axis.

use glam::{DVec2, IVec2};

/// Which part of a sum of periods an equation is about.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Part {
    /// The real part: the sum runs along the imaginary axis where it is 0.
    Real,
    /// The imaginary part: the sum runs along the real axis where it is 0.
    Imaginary,
}

impl Part {
    /// The part of a vector that is meant.
    pub fn of(self, vector: DVec2) -> f64 {
        match self {
            Self::Real => vector.x,
            Self::Imaginary => vector.y,
        }
    }
}

/// The coefficients of a part of Σ tⱼ xⱼ over the real and imaginary parts of x in turn.
pub fn real_row(coefficients: &[IVec2], part: Part) -> Vec<f64> {
    let pair = |t: &IVec2| match part {
        Part::Real => [f64::from(t.x), -f64::from(t.y)],
        Part::Imaginary => [f64::from(t.y), f64::from(t.x)],
    };
    coefficients.iter().flat_map(pair).collect()
}

/// The scalar product.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// Independent equations with integral coefficients whose sums are 0, each solved for one of its
/// components (the pivot, of coefficient ±1), which occurs in no other.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Equations {
    rows: Vec<(Vec<f64>, usize)>,
}

impl Equations {
    /// How many there are.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// The coefficients of each equation, and the component that it is solved for.
    pub fn rows(&self) -> impl Iterator<Item = (&[f64], usize)> {
        self.rows
            .iter()
            .map(|(row, pivot)| (row.as_slice(), *pivot))
    }

    /// Whether a component is decided by the others.
    pub fn is_pivot(&self, component: usize) -> bool {
        self.rows.iter().any(|(_, pivot)| *pivot == component)
    }

    /// The row free of pivots that says the same once these equations hold; 0 if nothing new.
    pub fn reduced(&self, row: &[f64]) -> Vec<f64> {
        let mut row = row.to_vec();
        for (own, pivot) in &self.rows {
            let factor = row[*pivot] * own[*pivot];
            subtract(&mut row, own, factor);
        }
        row
    }

    /// Adds an equation, solved for the component of most weight that can be.
    ///
    /// Returns whether it was new and has a component of coefficient ±1.
    pub fn add(&mut self, row: &[f64], weight: impl Fn(usize) -> f64) -> bool {
        let mut row = self.reduced(row);
        let Some(divisor) = common_divisor(&row) else {
            return false;
        };
        for value in &mut row {
            *value = (*value / divisor).round();
        }
        let units = (0..row.len()).filter(|&k| is_unit(row[k]));
        let Some(pivot) = units.max_by(|&a, &b| weight(a).total_cmp(&weight(b)).then(b.cmp(&a)))
        else {
            return false;
        };
        for (own, _) in &mut self.rows {
            let factor = own[pivot] * row[pivot];
            subtract(own, &row, factor);
        }
        self.rows.push((row, pivot));
        true
    }

    /// Sets every pivot from the other components, exactly when these are whole.
    pub fn solve(&self, periods: &mut [f64]) {
        for (row, pivot) in &self.rows {
            periods[*pivot] -= dot(row, periods) * row[*pivot];
        }
    }
}

/// Whether a whole number is 1 or −1.
pub fn is_unit(value: f64) -> bool {
    (value.abs() - 1.0).abs() < 0.5
}

fn subtract(row: &mut [f64], other: &[f64], factor: f64) {
    if factor != 0.0 {
        for (value, own) in row.iter_mut().zip(other) {
            *value -= factor * own;
        }
    }
}

/// The greatest common divisor of whole numbers; none if all are 0.
pub fn common_divisor(row: &[f64]) -> Option<f64> {
    let divisor = row.iter().fold(0u64, |mut a, &value| {
        let mut b = value.abs().round() as u64;
        while b != 0 {
            (a, b) = (b, a % b);
        }
        a
    });
    (divisor != 0).then_some(divisor as f64)
}

#[cfg(test)]
#[allow(clippy::float_cmp)] // Whole numbers, which are exact.
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn an_equation_that_follows_from_others_is_not_new() {
        let mut equations = Equations::default();
        assert!(equations.add(&[2.0, 4.0, 0.0], |_| 1.0));
        assert!(equations.add(&[0.0, 1.0, 1.0], |_| 1.0));
        assert!(!equations.add(&[1.0, 3.0, 1.0], |_| 1.0));
        assert_eq!(equations.len(), 2);
    }

    #[test]
    fn an_equation_without_unit_coefficient_is_refused() {
        assert!(!Equations::default().add(&[2.0, 3.0], |_| 1.0));
        assert_eq!(common_divisor(&[0.0, 0.0]), None);
    }

    #[test]
    fn a_row_reads_its_part_of_the_sum() {
        let coefficients = [IVec2::new(2, -1), IVec2::new(0, 3)];
        let periods = [1.0, 5.0, -2.0, 4.0];
        let products = coefficients.iter().zip(periods.as_chunks::<2>().0);
        let sum: DVec2 = products.map(|(c, &x)| c.as_dvec2().rotate(x.into())).sum();
        for part in [Part::Real, Part::Imaginary] {
            assert_eq!(dot(&real_row(&coefficients, part), &periods), part.of(sum));
        }
    }

    proptest! {
        #[test]
        fn solved_components_fulfil_every_equation(
            rows in prop::collection::vec(prop::array::uniform6(-2..3i32), 1..4),
            values in prop::array::uniform6(-9..10i32),
        ) {
            let mut equations = Equations::default();
            let rows = rows.into_iter().map(|row| row.map(f64::from));
            let kept: Vec<_> = rows.filter(|row| equations.add(row, |k| k as f64)).collect();
            let mut values = values.map(f64::from);
            equations.solve(&mut values);
            for row in kept {
                prop_assert_eq!(dot(&row, &values), 0.0);
            }
        }
    }
}
