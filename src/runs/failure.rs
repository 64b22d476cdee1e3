//! Why a command ends without having done what it was asked for.

use crate::store::{RunDir, StoreError};

/// The exit code of a run that the user stopped.
pub const INTERRUPTED: u8 = 130;

/// Why the program ends without having done what it was asked for.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct Failure {
    /// One sentence that says what to do.
    pub message: String,
    /// The exit code.
    pub code: u8,
}

impl Failure {
    /// The user has to say something else.
    pub fn usage(message: impl Into<String>) -> Self {
        Self { message: message.into(), code: 2 }
    }

    /// In this folder is no run.
    pub fn no_run(dir: &RunDir) -> Self {
        let path = dir.path().display();
        Self::usage(format!(
            "there is no run in {path}: name the folder of one, such as runs/walk-seed7"
        ))
    }

    /// Something did not work.
    pub fn failed(message: impl Into<String>) -> Self {
        Self { message: message.into(), code: 1 }
    }

    /// The user stopped it.
    pub fn interrupted(message: impl Into<String>) -> Self {
        Self { message: message.into(), code: INTERRUPTED }
    }

    /// Whether the user stopped it.
    pub fn is_interruption(&self) -> bool {
        self.code == INTERRUPTED
    }
}

impl From<StoreError> for Failure {
    fn from(error: StoreError) -> Self {
        Self::failed(error.to_string())
    }
}

impl From<crate::transport::TransportError> for Failure {
    fn from(error: crate::transport::TransportError) -> Self {
        use crate::transport::TransportError::{
            NoSpace, TooManyEdges, TooManyFiles, TooManyMigrants,
        };
        match error {
            NoSpace { .. } | TooManyEdges { .. } | TooManyFiles { .. } | TooManyMigrants { .. } => {
                Self::usage(error.to_string())
            }
            _ => Self::failed(error.to_string()),
        }
    }
}

#[cfg(feature = "view")]
impl From<crate::view::ViewError> for Failure {
    fn from(error: crate::view::ViewError) -> Self {
        Self::failed(error.to_string())
    }
}
