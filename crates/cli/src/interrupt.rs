//! Signals to stop: Ctrl-C, and those of queues and closed terminals.
//!
//! The first signal sets a flag, which long-running work checks; a second one, of any kind, ends the
//! process at once.

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, LazyLock};

/// Exit code of work that was stopped (128 + SIGINT, as shells have it), whichever signal it was.
pub const STOPPED: u8 = 130;

static ASKED: LazyLock<Arc<AtomicBool>> = LazyLock::new(Arc::default);

/// Set by the first signal after [`listen`].
pub fn flag() -> &'static AtomicBool {
    &ASKED
}

/// Whether somebody asked to stop.
pub fn asked() -> bool {
    ASKED.load(Ordering::Relaxed)
}

/// From now on the first signal sets the flag instead of ending the process.
///
/// # Errors
/// If the system refuses; signals end the process then.
pub fn listen() -> std::io::Result<()> {
    #[cfg(unix)]
    let hangup = (!hangups_are_ignored()).then_some(signal_hook::consts::SIGHUP);
    #[cfg(not(unix))]
    let hangup = None;
    for signal in [SIGINT, SIGTERM].into_iter().chain(hangup) {
        // Done in this order: only a flag that is set already ends the process.
        flag::register_conditional_shutdown(signal, STOPPED.into(), Arc::clone(&ASKED))?;
        flag::register(signal, Arc::clone(&ASKED))?;
    }
    Ok(())
}

/// From now on a file that grows beyond what the system allows (`ulimit -f`) is an error of the one who writes it, who
/// cleans up, rather than the end of the process.
///
/// # Errors
/// If the system refuses; the signal ends the process then.
pub fn outlive_too_large_files() -> std::io::Result<()> {
    #[cfg(unix)]
    flag::register(signal_hook::consts::SIGXFSZ, Arc::default())?;
    Ok(())
}

/// Whether the process was started to outlive its terminal, as by `nohup`.
#[cfg(unix)]
fn hangups_are_ignored() -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    mask.is_some_and(|mask| mask & (1 << (signal_hook::consts::SIGHUP - 1)) != 0)
}
