//! Development: copies links by their recurrence, with all that they carry, into a tree.
//!
//! Recursive, segment-copying growth after Sims (1994); the order and the sibling index are the course's.

/// One link of the tree.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Copy {
    /// The gene that it is a copy of.
    pub gene: usize,
    /// Its parent in the tree, an earlier link; none for the root.
    pub parent: Option<usize>,
    /// 1 for the root; for others 2 and up, counted over all copies on the same parent.
    pub sibling: u32,
}

impl Copy {
    /// The name that the course gives to the link at `index`: its gene, then its place in the tree. Names can
    /// collide from 12 genes on, so links are told apart by their index.
    pub fn name(&self, index: usize) -> String {
        match self.parent {
            None => self.gene.to_string(),
            Some(_) => format!("{}{index}", self.gene),
        }
    }
}

/// Expands a flat list of links, depth first and parents first. `parents` names each gene's parent,
/// `copies` how often it is built (ignored for the root). Growth is a product of copies, so it stops at
/// `links_max` links: the first ones in this order are built, with no link whose parent was cut.
pub fn expand(parents: &[Option<usize>], copies: &[u32], links_max: usize) -> Vec<Copy> {
    let mut children = vec![Vec::new(); parents.len()];
    for (gene, parent) in parents.iter().enumerate() {
        if let Some(parent) = parent {
            children[*parent].push(gene);
        }
    }
    let mut tree = vec![Copy { gene: 0, parent: None, sibling: 1 }];
    grow(&mut tree, 0, &children, copies, links_max);
    tree
}

fn grow(
    tree: &mut Vec<Copy>,
    at: usize,
    children: &[Vec<usize>],
    copies: &[u32],
    links_max: usize,
) {
    let mut sibling = 1;
    for &gene in &children[tree[at].gene] {
        for _ in 0..copies[gene] {
            if tree.len() >= links_max {
                return;
            }
            sibling += 1;
            tree.push(Copy { gene, parent: Some(at), sibling });
            grow(tree, tree.len() - 1, children, copies, links_max);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_copy_carries_its_whole_subtree_and_siblings_are_numbered_through() {
        // 0 carries 1 (twice) and 3; 1 carries 2.
        let tree = expand(&[None, Some(0), Some(1), Some(0)], &[3, 2, 1, 1], 99);
        let shape: Vec<_> = tree.iter().map(|c| (c.gene, c.parent, c.sibling)).collect();
        assert_eq!(
            shape,
            [
                (0, None, 1),
                (1, Some(0), 2),
                (2, Some(1), 2),
                (1, Some(0), 3),
                (2, Some(3), 2),
                (3, Some(0), 4)
            ]
        );
        assert_eq!(tree[4].name(4), "24");
    }

    #[test]
    fn growth_stops_at_the_bound_whatever_the_product_would_be() {
        let chain: Vec<Option<usize>> = (0..64_usize).map(|i| i.checked_sub(1)).collect();
        let tree = expand(&chain, &[4; 64], 32);
        assert_eq!(tree.len(), 32);
        assert!(tree.iter().enumerate().all(|(i, copy)| copy.parent.is_none_or(|p| p < i)));
    }
}
