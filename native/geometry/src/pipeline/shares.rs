//! How many faces each part gets.

/// Shares `n_faces` among parts by their weights; each gets at least `least`.
///
/// The largest remainders are rounded up, so the shares sum to `n_faces` unless the least shares
/// alone exceed it.
pub fn share(weights: &[f64], n_faces: usize, least: usize) -> Vec<usize> {
    let mut shares = vec![least; weights.len()];
    let mut order: Vec<usize> = (0..weights.len()).collect();
    order.sort_by(|&a, &b| weights[a].total_cmp(&weights[b]));
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
        shares[i] = share.max(least);
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
        assert_eq!(share(&[1.0, 3.0], 100, 4), [25, 75]);
        assert_eq!(share(&[1.0, 1e-9, 1.0], 100, 4).iter().sum::<usize>(), 100);
        assert_eq!(share(&[1.0, 1e-9], 100, 4), [96, 4]);
        assert_eq!(share(&[1.0; 3], 5, 4), [4, 4, 4]);
        assert_eq!(share(&[0.0; 2], 10, 4).iter().sum::<usize>(), 10);
    }
}
