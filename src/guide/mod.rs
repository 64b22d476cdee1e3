//! The user's guide, which README leads to.
//!
//! | page | what it answers |
//! |---|---|
//! | [`tasks`] | How does a genome become a body, and what does the body have to do? |
//! | [`problems`] | What else can islands evolve, and how do I add a problem of my own? |
//! | [`networks`] | How do networks grow, and which tests do they pass? |
//! | [`search`] | Which operators, topologies and policies are there? |
//! | [`experiments`] | How do I compare settings, and what wins? |
//! | [`reproducibility`] | Why does the same seed give the same bits, and where does the promise end? |
//! | [`recovery`] | What happens when something dies, and how was that tested? |
//! | [`score`] | Why is a score neither luck nor a fault of the engine? |
//! | [`interchange`] | How do genomes and bodies come in and go out? |
//! | [`files`] | What does a run leave on disk? |
//! | [`watching`] | What does the viewer show, and what does it cost? |
//! | [`adding`] | Where do I add a task, a setting, a scheme, a brain? |

// A page is read in two places. Its links end in definitions that lead to files, for those who read the file itself.
// Here `links.md` comes before each page and leads the same names to modules: the first definition of a name counts.

#[doc = include_str!("links.md")]
#[doc = include_str!("tasks.md")]
pub mod tasks {}

#[doc = include_str!("links.md")]
#[doc = include_str!("problems.md")]
pub mod problems {}

#[doc = include_str!("links.md")]
#[doc = include_str!("networks.md")]
pub mod networks {}

#[doc = include_str!("links.md")]
#[doc = include_str!("search.md")]
pub mod search {}

#[doc = include_str!("links.md")]
#[doc = include_str!("experiments.md")]
pub mod experiments {}

#[doc = include_str!("links.md")]
#[doc = include_str!("reproducibility.md")]
pub mod reproducibility {}

#[doc = include_str!("links.md")]
#[doc = include_str!("recovery.md")]
pub mod recovery {}

#[doc = include_str!("links.md")]
#[doc = include_str!("score.md")]
pub mod score {}

#[doc = include_str!("links.md")]
#[doc = include_str!("interchange.md")]
pub mod interchange {}

#[doc = include_str!("links.md")]
#[doc = include_str!("files.md")]
pub mod files {}

#[doc = include_str!("links.md")]
#[doc = include_str!("watching.md")]
pub mod watching {}

#[doc = include_str!("links.md")]
#[doc = include_str!("adding.md")]
pub mod adding {}
