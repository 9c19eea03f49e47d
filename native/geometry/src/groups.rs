//! Groups of things that are linked, directly or through others.

/// Numbers 0..n sorted into groups by links between them (union by index, path halving).
#[derive(Clone, Debug)]
pub struct Groups {
    parents: Vec<u32>,
}

impl Groups {
    /// Every number in a group of its own.
    pub fn new(n: usize) -> Self {
        Self {
            parents: (0..n as u32).collect(),
        }
    }

    /// Joins the groups of two numbers; whether they were apart.
    pub fn link(&mut self, a: usize, b: usize) -> bool {
        let [a, b] = [self.root(a), self.root(b)];
        self.parents[a.max(b)] = a.min(b) as u32;
        a != b
    }

    /// The smallest number of the group.
    pub fn root(&mut self, mut i: usize) -> usize {
        while self.parents[i] as usize != i {
            let grandparent = self.parents[self.parents[i] as usize];
            self.parents[i] = grandparent;
            i = grandparent as usize;
        }
        i
    }

    /// The group of each number, 0, 1, … by smallest member, and how many groups there are.
    pub fn numbered(mut self) -> (Vec<u32>, usize) {
        let mut group = vec![0; self.parents.len()];
        let mut n = 0;
        for i in 0..group.len() {
            let root = self.root(i);
            if root == i {
                group[i] = n;
                n += 1;
            } else {
                group[i] = group[root];
            }
        }
        (group, n as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn linked_numbers_share_a_group() {
        let mut groups = Groups::new(6);
        for (a, b) in [(4, 5), (1, 4), (5, 5), (0, 2)] {
            assert_eq!(groups.link(a, b), a != b);
        }
        assert!(!groups.link(1, 5));
        assert_eq!(groups.numbered(), (vec![0, 1, 0, 2, 1, 1], 3));
    }
}
