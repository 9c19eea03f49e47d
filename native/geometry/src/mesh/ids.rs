//! Typed indices and the arrays that they index.

use std::fmt;
use std::marker::PhantomData;
use std::ops::{Index, IndexMut};

use serde::{Deserialize, Serialize};

/// An index type of this crate: a `u32` that says what it counts.
pub trait Id: Copy + Eq + Ord {
    /// Makes the id from a position in an array.
    ///
    /// # Panics
    /// When the index does not fit in 32 bits, which the builders exclude.
    fn from_index(index: usize) -> Self;
    /// The position in an array.
    fn index(self) -> usize;
}

macro_rules! id {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug, Default, Serialize, Deserialize)]
        #[serde(transparent)]
        #[repr(transparent)]
        pub struct $name(pub u32);

        impl Id for $name {
            fn from_index(index: usize) -> Self {
                Self(u32::try_from(index).expect("the builders admit fewer than 2^32 elements"))
            }
            fn index(self) -> usize {
                self.0 as usize
            }
        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                self.0.fmt(f)
            }
        }
    };
}

id!(
    /// A vertex of a mesh.
    VertexId
);
id!(
    /// A face of a mesh.
    FaceId
);
id!(
    /// A halfedge of a triangle mesh: halfedge `3 f + i` leaves corner `i` of face `f`.
    HalfedgeId
);

impl HalfedgeId {
    /// The triangle that the halfedge bounds.
    pub fn face(self) -> FaceId {
        FaceId(self.0 / 3)
    }

    /// The next halfedge around the same triangle.
    #[must_use]
    pub fn next(self) -> Self {
        Self(if self.0 % 3 == 2 {
            self.0 - 2
        } else {
            self.0 + 1
        })
    }

    /// The previous halfedge around the same triangle.
    #[must_use]
    pub fn prev(self) -> Self {
        Self(if self.0.is_multiple_of(3) {
            self.0 + 2
        } else {
            self.0 - 1
        })
    }

    /// The corner (0, 1 or 2) of the triangle that the halfedge leaves.
    pub fn corner(self) -> usize {
        self.0 as usize % 3
    }
}

/// One value per element, indexed by id instead of by number.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
#[serde(transparent)]
pub struct IdMap<I, T> {
    values: Vec<T>,
    #[serde(skip)]
    id: PhantomData<fn(I)>,
}

/// One value per vertex.
pub type VertexMap<T> = IdMap<VertexId, T>;
/// One value per face.
pub type FaceMap<T> = IdMap<FaceId, T>;
/// One value per halfedge.
pub type HalfedgeMap<T> = IdMap<HalfedgeId, T>;

impl<I: Id, T> IdMap<I, T> {
    /// Wraps one value per element, in the order of ids.
    pub fn from_vec(values: Vec<T>) -> Self {
        Self {
            values,
            id: PhantomData,
        }
    }

    /// As many copies of `value` as there are elements.
    pub fn filled(n: usize, value: T) -> Self
    where
        T: Clone,
    {
        Self::from_vec(vec![value; n])
    }

    /// How many elements there are.
    pub fn len(&self) -> usize {
        self.values.len()
    }

    /// Whether there is no element.
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// The values in the order of ids.
    pub fn as_slice(&self) -> &[T] {
        &self.values
    }

    /// The values in the order of ids, to be changed.
    pub fn as_mut_slice(&mut self) -> &mut [T] {
        &mut self.values
    }

    /// Takes the values out.
    pub fn into_vec(self) -> Vec<T> {
        self.values
    }

    /// The values in the order of ids.
    pub fn iter(&self) -> std::slice::Iter<'_, T> {
        self.values.iter()
    }

    /// The ids, in order.
    pub fn ids(&self) -> impl ExactSizeIterator<Item = I> + use<I, T> {
        (0..self.values.len()).map(I::from_index)
    }

    /// Ids and values, in order.
    pub fn iter_ids(&self) -> impl ExactSizeIterator<Item = (I, &T)> {
        self.values
            .iter()
            .enumerate()
            .map(|(i, value)| (I::from_index(i), value))
    }

    /// Appends the value of one more element and returns its id.
    pub fn push(&mut self, value: T) -> I {
        self.values.push(value);
        I::from_index(self.values.len() - 1)
    }
}

impl<I: Id> IdMap<I, bool> {
    /// What is marked in this map or in another one of the same elements.
    #[must_use]
    pub fn or(&self, other: &Self) -> Self {
        self.iter().zip(other).map(|(a, b)| a | b).collect()
    }
}

impl<'a, I: Id, T> IntoIterator for &'a IdMap<I, T> {
    type Item = &'a T;
    type IntoIter = std::slice::Iter<'a, T>;
    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl<I: Id, T> Index<I> for IdMap<I, T> {
    type Output = T;
    fn index(&self, id: I) -> &T {
        &self.values[id.index()]
    }
}

impl<I: Id, T> IndexMut<I> for IdMap<I, T> {
    fn index_mut(&mut self, id: I) -> &mut T {
        &mut self.values[id.index()]
    }
}

impl<I: Id, T> FromIterator<T> for IdMap<I, T> {
    fn from_iter<It: IntoIterator<Item = T>>(iter: It) -> Self {
        Self::from_vec(iter.into_iter().collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halfedges_of_a_triangle_form_a_cycle() {
        for h in [HalfedgeId(0), HalfedgeId(4), HalfedgeId(8)] {
            assert_eq!(h.next().next().next(), h);
            assert_eq!(h.next().prev(), h);
            assert_eq!(h.next().face(), h.face());
        }
    }

    #[test]
    fn a_map_is_indexed_by_its_ids() {
        let mut map: VertexMap<f64> = VertexMap::filled(2, 0.5);
        let id = map.push(2.5);
        map[VertexId(0)] = 1.5;
        assert_eq!(id, VertexId(2));
        assert_eq!(map.as_slice(), [1.5, 0.5, 2.5]);
        assert_eq!(map.ids().map(Id::index).sum::<usize>(), 3);
    }
}
