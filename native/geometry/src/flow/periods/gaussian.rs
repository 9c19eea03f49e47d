//! Arithmetic of the Gaussian integers.

use glam::IVec2;

/// The product of two complex numbers.
pub(super) fn product(a: IVec2, b: IVec2) -> IVec2 {
    IVec2::new(a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x)
}

/// |a|².
pub(super) fn norm(a: IVec2) -> i32 {
    a.x * a.x + a.y * a.y
}

/// The Gaussian integer nearest to a / b: |a − q b|² ≤ |b|² / 2, so that Euclid's algorithm ends.
pub(super) fn quotient(a: IVec2, b: IVec2) -> IVec2 {
    let scaled = product(a, IVec2::new(b.x, -b.y));
    let n = norm(b);
    let nearest = |x: i32| (2 * x + n).div_euclid(2 * n);
    IVec2::new(nearest(scaled.x), nearest(scaled.y))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn a_remainder_is_smaller_than_its_divisor(
            [a, b, c, d] in prop::array::uniform4(-40..40i32),
        ) {
            let [dividend, divisor] = [IVec2::new(a, b), IVec2::new(c, d)];
            prop_assume!(divisor != IVec2::ZERO);
            let rest = dividend - product(quotient(dividend, divisor), divisor);
            prop_assert!(2 * norm(rest) <= norm(divisor));
        }

        #[test]
        fn the_norm_of_a_product_is_the_product_of_norms(
            [a, b, c, d] in prop::array::uniform4(-40..40i32),
        ) {
            let [p, q] = [IVec2::new(a, b), IVec2::new(c, d)];
            prop_assert_eq!(norm(product(p, q)), norm(p) * norm(q));
        }
    }
}
