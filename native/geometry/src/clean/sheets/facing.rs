//! Which faces hang together, and which of them face the same way.

use crate::mesh::{FaceId, Id};

/// Groups of faces; in each every face knows whether it is turned against the first.
pub(super) struct Facing {
    parents: Vec<u32>,
    /// Whether each face is turned against its parent.
    is_turned: Vec<bool>,
    /// Of each first face, whether its group has one side only.
    is_one_sided: Vec<bool>,
}

/// A face in its group.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) struct Place {
    /// The group, named by its first face.
    pub(super) group: usize,
    is_turned: bool,
}

impl Facing {
    /// Every face in a group of its own.
    pub(super) fn new(n: usize) -> Self {
        Self {
            parents: (0..n as u32).collect(),
            is_turned: vec![false; n],
            is_one_sided: vec![false; n],
        }
    }

    pub(super) fn place(&mut self, face: FaceId) -> Place {
        let mut i = face.index();
        let mut is_turned = false;
        while self.parents[i] as usize != i {
            let parent = self.parents[i] as usize;
            self.is_turned[i] ^= self.is_turned[parent];
            self.parents[i] = self.parents[parent];
            is_turned ^= self.is_turned[i];
            i = self.parents[i] as usize;
        }
        Place {
            group: i,
            is_turned,
        }
    }

    /// Whether the groups of two faces would have two sides as one; `is_against` says whether the
    /// faces are turned against each other.
    pub(super) fn may_link(&mut self, faces: [FaceId; 2], is_against: bool) -> bool {
        let [a, b] = faces.map(|face| self.place(face));
        let agrees = a.group != b.group || (a.is_turned ^ b.is_turned) == is_against;
        agrees && !self.is_one_sided[a.group] && !self.is_one_sided[b.group]
    }

    /// Makes one group of those of two faces.
    pub(super) fn link(&mut self, faces: [FaceId; 2], is_against: bool) {
        let [a, b] = faces.map(|face| self.place(face));
        let turn = a.is_turned ^ b.is_turned ^ is_against;
        let [from, to] = [a.group.max(b.group), a.group.min(b.group)];
        if from == to {
            self.is_one_sided[to] |= turn;
            return;
        }
        self.parents[from] = to as u32;
        self.is_turned[from] = turn;
        self.is_one_sided[to] |= self.is_one_sided[from];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ring_of_faces_has_two_sides_if_it_turns_an_even_number_of_times() {
        for n_against in 0..4 {
            let mut facing = Facing::new(7);
            for i in 0..6_u32 {
                facing.link([FaceId(i), FaceId(i + 1)], i < n_against);
            }
            let ends = [FaceId(6), FaceId(0)];
            assert_eq!(facing.may_link(ends, false), n_against % 2 == 0);
            assert_eq!(facing.may_link(ends, true), n_against % 2 == 1);
            facing.link(ends, n_against % 2 == 0);
            assert!(!facing.may_link([FaceId(2), FaceId(3)], false));
        }
    }
}
