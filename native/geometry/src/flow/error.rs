//! Why there are no quads that flow.

use thiserror::Error;

use super::conformal::FlattenError;
use super::field::FieldError;
use super::place::PlaceError;
use super::search::QuantiseError;
use super::sizes::SizesError;
use super::wish::WishError;
use crate::mesh::PolygonMeshError;
use crate::progress::Cancelled;

/// Why no quads were found.
#[derive(Clone, PartialEq, Debug, Error)]
pub enum Error {
    /// The user asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// There are no sizes.
    #[error("no sizes: {0}")]
    Sizes(SizesError),
    /// There is no orientation field.
    #[error("no orientation field: {0}")]
    Field(FieldError),
    /// There is no wish.
    #[error("no map along the field: {0}")]
    Wish(WishError),
    /// There is no flat metric.
    #[error("no flat metric: {0}")]
    Flatten(FlattenError),
    /// There are no whole periods.
    #[error("no whole periods: {0}")]
    Quantise(QuantiseError),
    /// There are no positions.
    #[error("no positions: {0}")]
    Place(PlaceError),
    /// The grid has vertices that no mesh can have.
    #[error("the grid is no mesh: {0}")]
    Mesh(#[from] PolygonMeshError),
    /// Two edges of the grid join the same two vertices.
    #[error("{n_doubled} edges of the grid join vertices that are joined already")]
    Doubled {
        /// How many halfedges that are.
        n_doubled: usize,
    },
    /// Not all creases of a solid have edges along them.
    #[error("edges lie along {n_met} of {n_lines} lines of sharp edges")]
    Creases {
        /// How many have.
        n_met: usize,
        /// How many there are.
        n_lines: usize,
    },
    /// The creases are no solid's: none are there, or many end loosely.
    #[error("sharp edges make no solid")]
    NoSolid,
    /// The grid is not its own image in the plane of symmetry.
    #[error("the grid is not its own image in the plane")]
    Uneven,
    /// The grid has too many or too few quads.
    #[error("the grid has {n_quads} quads; {n_wanted} were wanted")]
    Count {
        /// How many it has.
        n_quads: usize,
        /// How many were wanted.
        n_wanted: usize,
    },
}

/// Lifts a pass's cancellation to that of the whole.
macro_rules! lift {
    ($($error:ident => $variant:ident),*) => {$(
        impl From<$error> for Error {
            fn from(error: $error) -> Self {
                match error {
                    $error::Cancelled(cancelled) => Self::Cancelled(cancelled),
                    error => Self::$variant(error),
                }
            }
        }
    )*};
}

lift!(
    SizesError => Sizes,
    FieldError => Field,
    WishError => Wish,
    FlattenError => Flatten,
    QuantiseError => Quantise,
    PlaceError => Place
);
