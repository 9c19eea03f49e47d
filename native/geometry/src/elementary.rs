//! Elementary functions with the same bits on every machine.
//!
//! Those of the standard library are the system's: their last bit depends on the C library and on
//! what the processor can do, and a mesh that is built by decisions makes other faces of it.
//! These are plain arithmetic everywhere; `clippy.toml` forbids the others.

use glam::DVec2;

pub use libm::{
    acos, atan2, cos, exp, exp2, hypot, log as ln, log1p as ln_1p, log2, pow as powf, sin,
    sincos as sin_cos, tan,
};

/// The unit vector at an angle, in radians, from the first axis.
pub fn direction(angle: f64) -> DVec2 {
    let (y, x) = sin_cos(angle);
    DVec2::new(x, y)
}

/// The angle from one vector to another, in −π..=π; zero if one is zero.
pub fn angle_to(from: DVec2, to: DVec2) -> f64 {
    atan2(from.perp_dot(to), from.dot(to))
}

/// The angle of a vector from the first axis, in −π..=π; zero for no vector.
pub fn argument(vector: DVec2) -> f64 {
    atan2(vector.y, vector.x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_are_the_recorded_ones() {
        let functions: [fn(f64) -> f64; 12] = [
            sin,
            cos,
            tan,
            exp,
            exp2,
            ln,
            ln_1p,
            log2,
            |x| acos(x / 2.0),
            |x| atan2(x, 0.7),
            |x| hypot(x, 0.7),
            |x| powf(x, 0.7),
        ];
        let places = (1..=4000).map(|i| f64::from(i) / 2017.0);
        let values = places.flat_map(|x| functions.map(|function| function(x)));
        let mixed = values.fold(0u64, |mixed, x| mixed.rotate_left(1) ^ x.to_bits());
        assert_eq!(mixed, 464_787_552_927_576_916);
    }

    #[test]
    fn a_direction_has_its_angle() {
        for i in -31..=31 {
            let angle = f64::from(i) / 10.0;
            assert!((argument(direction(angle)) - angle).abs() < 1e-15);
            assert!((angle_to(direction(0.1), direction(angle + 0.1)) - angle).abs() < 1e-15);
        }
        assert!(argument(DVec2::ZERO).abs() < f64::MIN_POSITIVE);
    }
}
