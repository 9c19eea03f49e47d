//! How long each step takes, and how much memory the process took.

use std::time::{Duration, Instant};

use serde::Serialize;

/// The time of one step, summed over the parts of the mesh.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct Step {
    /// The step's name, that of its module.
    pub name: &'static str,
    /// Time that passed, in milliseconds.
    pub time_ms: f64,
    /// Processor time of the whole process in milliseconds; none where the system does not tell.
    pub cpu_ms: Option<f64>,
}

/// Measures steps one after the other.
#[derive(Debug, Default)]
pub struct Clock {
    steps: Vec<Step>,
}

impl Clock {
    /// Runs a step and adds its time to the step of that name.
    pub fn step<T>(&mut self, name: &'static str, run: impl FnOnce() -> T) -> T {
        let (start, cpu) = (Instant::now(), cpu_time());
        let value = run();
        let time_ms = start.elapsed().as_secs_f64() * 1e3;
        let cpu_ms = cpu_time()
            .zip(cpu)
            .map(|(end, start)| end.saturating_sub(start).as_secs_f64() * 1e3);
        match self.steps.iter_mut().find(|step| step.name == name) {
            Some(step) => {
                step.time_ms += time_ms;
                step.cpu_ms = step.cpu_ms.zip(cpu_ms).map(|(a, b)| a + b);
            }
            None => self.steps.push(Step {
                name,
                time_ms,
                cpu_ms,
            }),
        }
        value
    }

    /// The steps in the order of their first run.
    pub fn into_steps(self) -> Vec<Step> {
        self.steps
    }
}

#[cfg(unix)]
fn usage() -> Option<nix::sys::resource::Usage> {
    use nix::sys::resource::{UsageWho, getrusage};
    getrusage(UsageWho::RUSAGE_SELF).ok()
}

/// Processor time of this process so far, its threads together.
#[cfg(unix)]
fn cpu_time() -> Option<Duration> {
    use nix::sys::time::TimeValLike;
    let usage = usage()?;
    let micros = usage.user_time().num_microseconds() + usage.system_time().num_microseconds();
    u64::try_from(micros).ok().map(Duration::from_micros)
}

#[cfg(not(unix))]
fn cpu_time() -> Option<Duration> {
    None
}

/// The most memory that the process has held so far, in MiB; none where the system does not tell.
#[cfg(unix)]
pub fn peak_memory_mb() -> Option<f64> {
    // macOS counts in bytes, the other systems in KiB.
    let unit = if cfg!(target_vendor = "apple") {
        1.0
    } else {
        1024.0
    };
    usage().map(|usage| usage.max_rss() as f64 * unit / f64::from(1 << 20))
}

/// The most memory that the process has held so far, in MiB; none where the system does not tell.
#[cfg(not(unix))]
pub fn peak_memory_mb() -> Option<f64> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_of_one_name_are_summed_in_the_order_of_their_first_run() {
        let mut clock = Clock::default();
        assert_eq!(clock.step("embed", || 3), 3);
        clock.step("deform", || ());
        clock.step("embed", || std::thread::sleep(Duration::from_millis(3)));
        let steps = clock.into_steps();
        assert_eq!(
            steps.iter().map(|s| s.name).collect::<Vec<_>>(),
            ["embed", "deform"]
        );
        assert!(steps[0].time_ms >= 3.0, "{steps:?}");
    }

    #[cfg(unix)]
    #[test]
    fn the_peak_memory_is_that_of_a_running_program() {
        let peak = peak_memory_mb().unwrap();
        assert!((0.5..100_000.0).contains(&peak), "{peak}");
    }
}
