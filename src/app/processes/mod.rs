//! The processes of a run.
//!
//! `run` is the launcher: it starts a process for each island (`island`) and one that watches (`monitor`), tied to it by
//! `parent_link`: they die with it, and stop when it closes their standard input.

pub mod island;
pub mod monitor;
pub mod parent_link;
pub mod run;
