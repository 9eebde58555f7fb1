// SPDX-License-Identifier: MIT OR Apache-2.0
//! The clock of all runs. WebAssembly in a browser has none that the standard library knows: there no time passes, and
//! all seconds are 0. No result depends on time.

#[cfg(not(all(target_family = "wasm", target_os = "unknown")))]
pub(crate) use std::time::Instant;

#[cfg(all(target_family = "wasm", target_os = "unknown"))]
pub(crate) use standing::Instant;

#[cfg(all(target_family = "wasm", target_os = "unknown"))]
mod standing {
    use std::time::Duration;

    /// A moment of a clock that stands still.
    #[derive(Debug, Clone, Copy)]
    pub(crate) struct Instant;

    impl Instant {
        pub(crate) fn now() -> Self {
            Self
        }

        pub(crate) fn elapsed(self) -> Duration {
            Duration::ZERO
        }
    }
}
