//! Quarter turns of vectors of the plane.

use glam::{DVec2, I64Vec2, IVec2};

/// A vector that can be multiplied by a power of i exactly.
pub trait Turn: Copy {
    /// The vector turned counter-clockwise by so many quarter turns.
    #[must_use]
    fn turned(self, quarters: u8) -> Self;
}

macro_rules! turn {
    ($vector:ty) => {
        impl Turn for $vector {
            fn turned(self, quarters: u8) -> Self {
                match quarters % 4 {
                    0 => self,
                    1 => self.perp(),
                    2 => -self,
                    _ => -self.perp(),
                }
            }
        }
    };
}

turn!(DVec2);
turn!(IVec2);
turn!(I64Vec2);
