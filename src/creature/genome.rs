//! A genome as a flat list of links: which gene hangs on which.

use super::traits::Traits;

/// The parent of each gene's link among the links of earlier genes; none for the first, the root.
pub fn parents(traits: &[Traits]) -> Vec<Option<usize>> {
    traits
        .iter()
        .enumerate()
        .map(|(i, traits)| match i {
            0 => None,
            // Rounding may reach the excluded end of the share: it means the last candidate.
            _ => Some(((traits.parent_share * i as f64) as usize).min(i - 1)),
        })
        .collect()
}
