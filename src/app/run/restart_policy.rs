//! When a process that has died is started again, and when that has no hope.

use std::os::unix::process::ExitStatusExt;
use std::process::ExitStatus;

/// So often a process may end by itself without having got any further in between.
pub const FAILURES_MAX: u32 = 5;

/// The deaths of one process, and of those that came after it in its role.
#[derive(Debug, Clone, Copy, Default)]
pub struct RestartPolicy {
    /// Deaths by its own fault, one after the other, after the same generation.
    fruitless: u32,
    /// That generation.
    after: Option<u32>,
}

impl RestartPolicy {
    /// Takes note of a death after a generation, none if it had not evolved any. Returns whether there is hope
    /// for a successor.
    ///
    /// Who is killed from outside is not to blame, as often as it happens. An error, a panic or a crash comes
    /// again if the same is evolved again, as it must be.
    pub fn allows_restart(&mut self, status: ExitStatus, after: Option<u32>) -> bool {
        if is_from_outside(status) {
            return true;
        }
        self.fruitless = if after == self.after { self.fruitless + 1 } else { 1 };
        self.after = after;
        self.fruitless < FAILURES_MAX
    }
}

fn is_from_outside(status: ExitStatus) -> bool {
    use signal_hook::consts::{SIGKILL, SIGTERM};
    matches!(status.signal(), Some(SIGKILL | SIGTERM))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As wait(2) says it: an exit code in the second byte, a signal in the first.
    fn exit(code: i32) -> ExitStatus {
        ExitStatus::from_raw(code << 8)
    }

    fn signal(number: i32) -> ExitStatus {
        ExitStatus::from_raw(number)
    }

    #[test]
    fn the_fifth_death_by_its_own_fault_at_the_same_generation_is_the_last() {
        use signal_hook::consts::{SIGABRT, SIGBUS, SIGSEGV};
        let mut policy = RestartPolicy::default();
        for status in [exit(1), exit(101), signal(SIGSEGV), signal(SIGBUS)] {
            assert!(policy.allows_restart(status, Some(7)), "{status}");
        }
        assert!(!policy.allows_restart(signal(SIGABRT), Some(7)));
    }

    #[test]
    fn progress_and_deaths_from_outside_leave_hope() {
        use signal_hook::consts::{SIGKILL, SIGTERM};
        let mut policy = RestartPolicy::default();
        for generation in 0..100 {
            assert!(policy.allows_restart(exit(1), Some(generation)));
        }
        for _ in 0..100 {
            assert!(policy.allows_restart(signal(SIGKILL), None));
            assert!(policy.allows_restart(signal(SIGTERM), Some(99)));
        }
        for _ in 1..FAILURES_MAX - 1 {
            assert!(policy.allows_restart(exit(0), Some(99)), "a success that nobody asked for");
        }
        assert!(
            !policy.allows_restart(exit(1), Some(99)),
            "those from outside make nothing forgotten"
        );
    }
}
