//! As many open files as the run needs.

use super::TransportError;
use rustix::process::{Resource, Rlimit, getrlimit, setrlimit};

/// Makes sure that this process and those that it starts may have `needed` files open. Many systems let a process have
/// a thousand, and more if it asks.
///
/// # Errors
/// If the system does not let it.
pub fn provide(needed: u64) -> Result<(), TransportError> {
    let Rlimit { current, maximum } = getrlimit(Resource::Nofile);
    // No limit is none that could be too low.
    if current.is_none_or(|current| needed <= current) {
        return Ok(());
    }
    let raised = match maximum {
        Some(maximum) if maximum < needed => None,
        maximum => setrlimit(Resource::Nofile, Rlimit { current: Some(needed), maximum }).ok(),
    };
    let limit = maximum.or(current).unwrap_or(needed);
    raised.ok_or(TransportError::TooManyFiles { needed, limit })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_the_system_does_not_let_a_process_have_is_said_in_numbers() {
        provide(1).unwrap();
        // As many as this can no process have.
        let error = provide(1 << 40).unwrap_err();
        assert!(error.to_string().contains("may have up to 1099511627776 files open"), "{error}");
    }
}
