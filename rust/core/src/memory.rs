// SPDX-License-Identifier: MIT OR Apache-2.0
//! The memory that is left for this process, as Linux tells it; for solvers and the bindings, and hidden.
//!
//! A program that lacks memory midway is ended, so whoever is about to take much asks before.

use std::fs::read_to_string;

use crate::error::NumericsError;

/// Less is not asked for: reading the system's tables takes longer than most small runs.
const LITTLE: u64 = 16_000_000;

/// What threads and the allocator keep for themselves, mostly of a limited address space.
const KEPT: u64 = 150_000_000;

/// Refuses work on surfaces of `n_vertices` in all that takes so many bytes for each.
///
/// # Errors
/// [`NumericsError::OutOfMemory`] where less is free.
pub fn require_for_vertices(bytes: u64, n_vertices: usize) -> Result<(), NumericsError> {
    lacking(bytes.saturating_mul(n_vertices as u64)).map_or(Ok(()), |Lack { needed, available }| {
        Err(NumericsError::OutOfMemory { n_vertices, needed, available })
    })
}

/// Refuses arrays of `n_numbers` in all that take so many bytes for each, with what they are computed from.
///
/// # Errors
/// [`NumericsError::ArraysOutOfMemory`] where less is free.
pub fn require_for_numbers(bytes: u64, n_numbers: usize) -> Result<(), NumericsError> {
    lacking(bytes.saturating_mul(n_numbers as u64)).map_or(Ok(()), |Lack { needed, available }| {
        Err(NumericsError::ArraysOutOfMemory { n_numbers, needed, available })
    })
}

/// Bytes that are needed, and the fewer that are free.
struct Lack {
    needed: u64,
    available: u64,
}

/// The lack of so many bytes and those that are kept, where there is one.
fn lacking(bytes: u64) -> Option<Lack> {
    if bytes < LITTLE {
        return None;
    }
    let (needed, available) = (bytes.saturating_add(KEPT), available()?);
    (available < needed).then_some(Lack { needed, available })
}

/// The bytes that this process can still have, where the system says so.
pub fn available() -> Option<u64> {
    let read = |path: &str| read_to_string(path).ok();
    let status = read("/proc/self/status");
    let of_system = read("/proc/meminfo").and_then(|text| of_system(&text));
    let of_address_space = read("/proc/self/limits")
        .zip(status.as_deref())
        .and_then(|(limits, status)| of_address_space(&limits, status));
    let of_group = read("/sys/fs/cgroup/memory.max")
        .zip(read("/sys/fs/cgroup/memory.stat"))
        .and_then(|(limit, usage)| of_group(&limit, &usage));
    [of_system, of_address_space, of_group].into_iter().flatten().min()
}

/// What the system could give without ending other programs.
fn of_system(meminfo: &str) -> Option<u64> {
    let memory = number_after(meminfo, "MemAvailable:")?;
    let swap = number_after(meminfo, "SwapFree:").unwrap_or(0);
    Some(1024 * (memory + swap))
}

/// What a limit on the address space (`ulimit -v`) leaves.
fn of_address_space(limits: &str, status: &str) -> Option<u64> {
    let limit = number_after(limits, "Max address space")?;
    let used = 1024 * number_after(status, "VmSize:")?;
    Some(limit.saturating_sub(used))
}

/// What the limit of a container leaves; its caches give way.
fn of_group(limit: &str, usage: &str) -> Option<u64> {
    let limit: u64 = limit.trim().parse().ok()?;
    Some(limit.saturating_sub(number_after(usage, "anon ")?))
}

/// The number behind a word at the start of a line; none where another word stands there, as `unlimited`.
fn number_after(text: &str, word: &str) -> Option<u64> {
    let line = text.lines().find_map(|line| line.strip_prefix(word))?;
    line.split_whitespace().next()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_is_read_from_the_systems_tables() {
        let meminfo = "MemTotal:       24000000 kB\nMemAvailable:   16000000 kB\nSwapFree:  1000000 kB\n";
        assert_eq!(of_system(meminfo), Some(17_000_000 * 1024));
        let limits = "Limit  Soft Limit  Hard Limit  Units\nMax address space  2048000  unlimited  bytes\n";
        assert_eq!(of_address_space(limits, "Name: x\nVmSize:\t 1000 kB\n"), Some(1_024_000));
        assert_eq!(of_address_space(limits, "VmSize: 9000 kB\n"), Some(0));
        let unlimited = "Max address space  unlimited  unlimited  bytes\n";
        assert_eq!(of_address_space(unlimited, "VmSize: 1000 kB\n"), None);
        assert_eq!(of_group("4096\n", "anon 1096\nfile 3000\n"), Some(3000));
        assert_eq!(of_group("max\n", "anon 1096\n"), None);
        assert_eq!(of_system(""), None);
    }
}
