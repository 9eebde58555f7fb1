// SPDX-License-Identifier: MIT OR Apache-2.0
//! Disjoint sets of numbers (R. E. Tarjan, Efficiency of a good but not linear set union algorithm, JACM 1975).

/// The numbers `0..n`, divided into sets. The root of a set is its smallest member.
pub(crate) struct Sets {
    parent: Vec<u32>,
}

impl Sets {
    /// `n` sets of one number each.
    pub(crate) fn new(n: usize) -> Self {
        Self { parent: (0..n as u32).collect() }
    }

    /// How many numbers there are.
    pub(crate) fn len(&self) -> usize {
        self.parent.len()
    }

    /// The root of the set of a number.
    pub(crate) fn root(&mut self, member: usize) -> usize {
        let mut member = member as u32;
        while self.parent[member as usize] != member {
            let grandparent = self.parent[self.parent[member as usize] as usize];
            self.parent[member as usize] = grandparent;
            member = grandparent;
        }
        member as usize
    }

    /// Joins two sets; false where they are one already.
    pub(crate) fn join(&mut self, a: usize, b: usize) -> bool {
        let [a, b] = [self.root(a), self.root(b)];
        self.parent[a.max(b)] = a.min(b) as u32;
        a != b
    }
}

#[cfg(test)]
mod tests {
    use super::Sets;

    #[test]
    fn numbers_that_were_joined_have_the_smallest_of_them_as_their_root() {
        let mut sets = Sets::new(6);
        assert!(sets.join(5, 3) && sets.join(1, 5) && !sets.join(3, 1));
        assert_eq!([0, 1, 2, 3, 4, 5].map(|member| sets.root(member)), [0, 1, 2, 1, 4, 1]);
    }
}
