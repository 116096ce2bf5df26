//! What the process has used, and what it may use.

use std::fs::read_to_string;

/// The most threads that one may ask for.
pub const MOST_THREADS: u32 = 1024;

/// The most replicates that one may ask for.
pub const MOST_REPLICATES: u32 = 4096;

/// The largest resident size of this process so far (bytes), where the system tells.
pub fn peak_memory_bytes() -> Option<u64> {
    field(&read_to_string("/proc/self/status").ok()?, "VmHWM:")
}

/// The memory that may still be taken without driving others out (bytes), where the system
/// tells: what it calls available, or less where a control group limits the process.
pub fn available_memory_bytes() -> Option<u64> {
    let system = field(&read_to_string("/proc/meminfo").ok()?, "MemAvailable:")?;
    Some(group_allowance().map_or(system, |allowance| system.min(allowance)))
}

/// What the process's control group (version 2) leaves of its limit.
fn group_allowance() -> Option<u64> {
    let number = |name: &str| -> Option<u64> {
        let text = read_to_string(format!("/sys/fs/cgroup/{name}")).ok()?;
        text.trim().parse().ok()
    };
    Some(number("memory.max")?.saturating_sub(number("memory.current")?))
}

/// The value of a line such as `VmHWM:   1234 kB` (bytes).
fn field(text: &str, name: &str) -> Option<u64> {
    let line = text.lines().find(|line| line.starts_with(name))?;
    let kib: u64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kib * 1024)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_are_found() {
        let text = "VmPeak:\t  9 kB\nVmHWM:\t  12 kB\n";
        assert_eq!(field(text, "VmHWM:"), Some(12 << 10));
        assert_eq!(field(text, "VmSwap:"), None);
    }
}
