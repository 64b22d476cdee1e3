//! When a process that has died is started again, and when it is not.

use std::os::unix::process::ExitStatusExt;
use std::process::ExitStatus;
use std::time::Duration;

/// So often a process may end by itself without having got any further in between.
pub const FAILURES_MAX: u32 = 5;

/// So many early deaths, one after the other, delay no successor.
const AT_ONCE: u32 = 8;
/// Who has lived for so long has not died early, as who has got further has not.
const EARLY: Duration = Duration::from_secs(10);
/// The first delay is so long, and each next one twice as long…
pub const PAUSE_MIN: Duration = Duration::from_millis(50);
/// … up to this.
pub const PAUSE_MAX: Duration = Duration::from_secs(5);

/// The deaths of one process, and of those that came after it in its role.
#[derive(Debug, Clone, Copy, Default)]
pub struct RestartPolicy {
    /// Early deaths, one after the other, whoever is to blame.
    early: u32,
    /// The generation that the last one had evolved.
    reached: Option<u32>,
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

    /// How long its successor has to wait, given how long it lived and the generation that it got to. Whatever kills
    /// processes as soon as they are there, such as a lack of memory, shall not be answered by hundreds more.
    pub fn pause(&mut self, lived: Duration, after: Option<u32>) -> Duration {
        let is_early = lived < EARLY && after <= self.reached;
        self.early = if is_early { self.early + 1 } else { 0 };
        self.reached = self.reached.max(after);
        match self.early.checked_sub(AT_ONCE + 1) {
            Some(more) => PAUSE_MIN.saturating_mul(1 << more.min(16)).min(PAUSE_MAX),
            None => Duration::ZERO,
        }
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
    fn who_dies_early_again_and_again_waits_for_longer_and_longer() {
        let mut policy = RestartPolicy::default();
        let soon = Duration::from_millis(30);
        let mut pauses: Vec<u128> = (0..20).map(|_| policy.pause(soon, None).as_millis()).collect();
        assert_eq!(pauses[..12], [0, 0, 0, 0, 0, 0, 0, 0, 50, 100, 200, 400]);
        assert_eq!(pauses.split_off(15), [5_000; 5]);
        assert_eq!(policy.pause(EARLY, None), Duration::ZERO, "it has lived for long");
        for _ in 0..AT_ONCE {
            assert_eq!(policy.pause(soon, None), Duration::ZERO);
        }
        assert_eq!(policy.pause(soon, None), PAUSE_MIN);
        assert_eq!(policy.pause(soon, Some(0)), Duration::ZERO, "it has got further");
        assert_eq!(policy.pause(soon, Some(0)), Duration::ZERO);
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
