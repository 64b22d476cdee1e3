//! A genome as a flat list of links: which gene hangs on which.

use super::gene::Gene;
use super::traits::Traits;

/// Which of a gene's numbers says who the parent is, as a share of the way through the earlier genes.
const PARENT: usize = 6;

/// The parent of each gene's link among the links of earlier genes; none for the first, the root.
pub fn parents(traits: &[Traits]) -> Vec<Option<usize>> {
    traits.iter().enumerate().map(|(i, traits)| parent(traits.parent_share, i)).collect()
}

/// The parent of gene `i`.
fn parent(share: f64, i: usize) -> Option<usize> {
    // Rounding may reach the excluded end of the share: it means the last candidate.
    i.checked_sub(1).map(|last| ((share * i as f64) as usize).min(last))
}

/// Appends copies of gene `limb`, from 1, and of all that hang on it: the new limb hangs on the parent of the old one,
/// and is like it. Nothing happens if there were more than `genes_max` genes then.
pub fn duplicate(genome: &mut Vec<Gene>, limb: usize, genes_max: usize) {
    let parents: Vec<Option<usize>> =
        genome.iter().enumerate().map(|(i, gene)| parent(gene.0[PARENT], i)).collect();
    // The genes of the limb, each with the place of its copy.
    let mut copies: Vec<(usize, usize)> = Vec::new();
    let copy_of = |copies: &[(usize, usize)], gene| {
        copies.iter().find(|(old, _)| *old == gene).map(|(_, new)| *new)
    };
    for (gene, parent) in parents.iter().enumerate().skip(limb) {
        let is_carried = parent.is_some_and(|parent| copy_of(&copies, parent).is_some());
        if gene == limb || is_carried {
            copies.push((gene, genome.len() + copies.len()));
        }
    }
    if genome.len() + copies.len() > genes_max {
        return;
    }
    for &(old, new) in &copies {
        let mut gene = genome[old];
        if let Some(parent) = parents[old] {
            let parent = copy_of(&copies, parent).unwrap_or(parent);
            gene.0[PARENT] = (parent as f64 + 0.5) / new as f64;
        }
        genome.push(gene);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Genes with these parents, told apart by their first number.
    fn genome(parents: &[usize]) -> Vec<Gene> {
        let gene = |(i, &parent): (usize, &usize)| {
            let mut gene = Gene([i as f64 / 16.0; 17]);
            gene.0[PARENT] = if i == 0 { 0.0 } else { (parent as f64 + 0.5) / i as f64 };
            gene
        };
        parents.iter().enumerate().map(gene).collect()
    }

    fn read(genome: &[Gene]) -> Vec<(f64, Option<usize>)> {
        let genes = genome.iter().enumerate();
        genes.map(|(i, gene)| (gene.0[0] * 16.0, parent(gene.0[PARENT], i))).collect()
    }

    #[test]
    fn a_limb_is_repeated_with_all_that_it_carries_and_nothing_else_changes() {
        // 0 carries 1 and 4; 1 carries 2, which carries 3.
        let mut genome = genome(&[0, 0, 1, 2, 0]);
        let before = genome.clone();
        duplicate(&mut genome, 1, 8);
        assert_eq!(genome[..5], before);
        assert_eq!(read(&genome)[5..], [(1.0, Some(0)), (2.0, Some(5)), (3.0, Some(6))]);
    }

    #[test]
    fn a_limb_that_does_not_fit_is_not_repeated() {
        let mut genome = genome(&[0, 0, 1]);
        duplicate(&mut genome, 1, 4);
        assert_eq!(genome.len(), 3);
        duplicate(&mut genome, 2, 4);
        assert_eq!(read(&genome)[3], (2.0, Some(1)));
    }
}
