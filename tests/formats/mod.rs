//! Files that the program reads and writes.

pub mod course;
mod format;
mod imports;
mod readers;
