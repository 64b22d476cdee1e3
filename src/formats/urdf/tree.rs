//! Which link of a URDF hangs on which.

use super::error::{UrdfError, shortened};
use super::read::Robot;
use std::collections::BTreeMap;

/// Which joints hang on which link, by index.
pub struct Tree {
    /// The link without a parent.
    pub root: usize,
    /// The joints below each link and the links that they lead to, in the order of the file.
    pub children: Vec<Vec<(usize, usize)>>,
}

impl Tree {
    /// Puts links and joints in order.
    ///
    /// # Errors
    /// If names are not unique or lead nowhere, or it is no tree.
    pub fn of(robot: &Robot) -> Result<Self, UrdfError> {
        let links =
            indexed(robot.links.iter().map(|link| (link.name.as_str(), link.line)), "link")?;
        indexed(robot.joints.iter().map(|joint| (joint.name.as_str(), joint.line)), "joint")?;
        let mut children = vec![Vec::new(); robot.links.len()];
        let mut has_parent = vec![false; robot.links.len()];
        for (index, joint) in robot.joints.iter().enumerate() {
            let end = |name: &str| {
                let (what, line) = ("link", joint.line);
                let unknown = || UrdfError::Unknown { line, what, name: shortened(name) };
                links.get(name).copied().ok_or_else(unknown)
            };
            let (parent, child) = (end(&joint.parent)?, end(&joint.child)?);
            if std::mem::replace(&mut has_parent[child], true) {
                let name = shortened(&joint.child);
                return Err(UrdfError::NoTree(format!("{name:?} has two parents")));
            }
            children[parent].push((index, child));
        }
        let mut roots = (0..robot.links.len()).filter(|&link| !has_parent[link]);
        let name = |link: usize| shortened(&robot.links[link].name);
        match (roots.next(), roots.next()) {
            (Some(root), None) => Self { root, children }.whole(robot),
            (Some(a), Some(b)) => Err(UrdfError::NoTree(format!(
                "neither {:?} nor {:?} has a parent",
                name(a),
                name(b)
            ))),
            (None, _) if robot.links.is_empty() => {
                Err(UrdfError::NoTree("there is no link".to_owned()))
            }
            (None, _) => Err(UrdfError::NoTree("every link has a parent".to_owned())),
        }
    }

    /// A tree with one root may still leave out a ring of links.
    fn whole(self, robot: &Robot) -> Result<Self, UrdfError> {
        let mut reached = vec![self.root];
        let mut at = 0;
        while at < reached.len() {
            reached.extend(self.children[reached[at]].iter().map(|&(_, child)| child));
            at += 1;
        }
        match robot.links.len() - reached.len() {
            0 => Ok(self),
            ring => Err(UrdfError::NoTree(format!("{ring} links hang on one another in a ring"))),
        }
    }
}

fn indexed<'a>(
    names: impl Iterator<Item = (&'a str, u32)>,
    what: &'static str,
) -> Result<BTreeMap<&'a str, usize>, UrdfError> {
    let mut all = BTreeMap::new();
    for (index, (name, line)) in names.enumerate() {
        if all.insert(name, index).is_some() {
            return Err(UrdfError::Duplicate { line, what, name: shortened(name) });
        }
    }
    Ok(all)
}
