//! Genomes that islands begin with.

/// Genomes to begin with, in their order: each island begins with as many of them as its population has room for, the
/// next island with those that follow, and from the first one again after the last. All others are random.
#[derive(Debug, Clone, PartialEq)]
pub struct Founders<G>(pub Vec<Vec<G>>);

impl<G> Founders<G> {
    /// None: all begin at random.
    pub const NONE: Self = Self(Vec::new());

    /// The genome that individual `index` of generation 0 of an island with so many individuals has to have; none if a
    /// random one.
    pub fn of(&self, island: u32, index: usize, population: usize) -> Option<&[G]> {
        let share = population.min(self.0.len());
        let place = || (island as usize).wrapping_mul(share).wrapping_add(index) % self.0.len();
        (index < share).then(|| &self.0[place()][..])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn founders_are_dealt_out_in_their_order_and_none_twice_on_an_island() {
        let founders = Founders((0..5).map(|gene| vec![gene]).collect());
        let dealt =
            |island| [0, 1, 2, 3].map(|index| founders.of(island, index, 4).map(|it| it[0]));
        assert_eq!(dealt(0), [0, 1, 2, 3].map(Some));
        assert_eq!(dealt(1), [4, 0, 1, 2].map(Some));
        assert_eq!(founders.of(0, 5, 9), None);
        assert_eq!(Founders::<u8>::NONE.of(0, 0, 4), None);
    }
}
