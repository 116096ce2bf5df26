//! Processor time of a process: that of all its threads together, which other programs on the machine change little.

use std::fs;

/// Clock ticks per second in Linux's `/proc` (`USER_HZ`).
const TICKS: f64 = 100.0;

/// The processor time that a process has taken so far (s), from Linux's `/proc`.
pub(super) fn cpu_seconds(process: u32) -> Result<f64, String> {
    let file = format!("/proc/{process}/stat");
    let text = fs::read_to_string(&file).map_err(|e| format!("{file}: {e}"))?;
    seconds_in(&text).ok_or_else(|| format!("{file} holds no times"))
}

/// User and system time: fields 14 and 15, of which the second, a name in brackets, may hold anything.
fn seconds_in(stat: &str) -> Option<f64> {
    let (_, fields) = stat.rsplit_once(')')?;
    let mut times = fields.split_whitespace().skip(11).map(str::parse::<u64>);
    let (user, system) = (times.next()?.ok()?, times.next()?.ok()?);
    Some((user + system) as f64 / TICKS)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_found_behind_any_name() {
        let stat = "42 (a) b (c) S 1 2 3 4 5 6 7 8 9 10 150 25 0 0 20 0 1 0";
        assert_eq!(seconds_in(stat), Some(1.75));
        assert_eq!(seconds_in("42 (a) S 1 2"), None);
    }
}
