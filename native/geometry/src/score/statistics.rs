//! Means and quantiles.

/// The mean; NaN of nothing.
pub fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// The share of values for which something is true.
pub fn share<T>(values: &[T], is_counted: impl Fn(&T) -> bool) -> f64 {
    values.iter().filter(|&value| is_counted(value)).count() as f64 / values.len() as f64
}

/// The value below which a share `q` of all lies, linear between two of them.
pub fn quantile(mut values: Vec<f64>, q: f64) -> f64 {
    let at = q * (values.len() - 1) as f64;
    let (_, &mut low, above) = values.select_nth_unstable_by(at as usize, f64::total_cmp);
    let high = above.iter().copied().min_by(f64::total_cmp).unwrap_or(low);
    low + (high - low) * at.fract()
}

/// The middle value, of an even number the mean of the two in the middle.
pub fn median(values: &[u32]) -> f64 {
    quantile(values.iter().map(|&value| f64::from(value)).collect(), 0.5)
}

/// The harmonic mean of precision and recall.
pub fn harmonic(precision: f64, recall: f64) -> f64 {
    if precision + recall > 0.0 {
        2.0 * precision * recall / (precision + recall)
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_lie_between_the_values() {
        assert!((quantile(vec![4.0, 1.0, 3.0, 2.0], 0.5) - 2.5).abs() < 1e-15);
        assert!((quantile(vec![4.0, 1.0, 3.0, 2.0], 0.95) - 3.85).abs() < 1e-12);
        assert!((quantile(vec![7.0], 0.01) - 7.0).abs() < 1e-15);
        assert!((median(&[5, 1, 2]) - 2.0).abs() < 1e-15);
    }
}
