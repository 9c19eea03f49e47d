//! How many faces each part gets.

/// Shares `n_faces` among parts by their weights; each gets at least its `least`.
///
/// The largest remainders are rounded up, so the shares sum to `n_faces` unless the least shares
/// alone exceed it.
pub fn share(weights: &[f64], n_faces: usize, least: &[usize]) -> Vec<usize> {
    let mut shares = least.to_vec();
    let mut order: Vec<usize> = (0..weights.len()).collect();
    let each = |i: usize| weights[i] / least[i].max(1) as f64;
    order.sort_by(|&a, &b| each(a).total_cmp(&each(b)));
    // From small to large: who would get less than the least leaves more to share for the others.
    let mut left = n_faces;
    let mut total: f64 = weights.iter().sum();
    for (rank, &i) in order.iter().enumerate() {
        let wanted = if total > 0.0 {
            left as f64 * weights[i] / total
        } else {
            0.0
        };
        let last = rank + 1 == order.len();
        let share = if last { left } else { wanted.round() as usize };
        shares[i] = share.max(least[i]);
        left = left.saturating_sub(shares[i]);
        total -= weights[i];
    }
    shares
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_follow_the_weights_sum_up_and_keep_the_least() {
        assert_eq!(share(&[1.0, 3.0], 100, &[4; 2]), [25, 75]);
        assert_eq!(
            share(&[1.0, 1e-9, 1.0], 100, &[4; 3]).iter().sum::<usize>(),
            100
        );
        assert_eq!(share(&[1.0, 1e-9], 100, &[4; 2]), [96, 4]);
        assert_eq!(share(&[1.0; 3], 5, &[4; 3]), [4, 4, 4]);
        // What one needs more than its weight says, the others give.
        assert_eq!(share(&[1.0, 1.0, 2.0], 100, &[4, 40, 4]), [20, 40, 40]);
        assert_eq!(share(&[1.0, 1.0, 2.0], 100, &[30, 30, 40]), [30, 30, 40]);
        assert_eq!(share(&[0.0; 2], 10, &[4; 2]).iter().sum::<usize>(), 10);
    }
}
