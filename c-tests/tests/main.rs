// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! All tests of the library as C, C++ and Rust programs see it, in one program:
//! `cargo test --test integration contract::` runs one module's.

#[path = "../harness/mod.rs"]
mod harness;
#[path = "../bench/measuring/mod.rs"]
#[cfg(not(feature = "single"))]
mod measuring;

/// Defines tests that each run a program with some arguments.
macro_rules! run_programs {
    ($($(#[$attribute:meta])* $test:ident: $program:expr, $arguments:expr;)+) => {$(
        $(#[$attribute])*
        #[test]
        fn $test() {
            $program.build().run($arguments);
        }
    )+};
}

// What programs see.
#[path = "extension/api.rs"]
mod api;
#[path = "contract/contract.rs"]
mod contract;
#[path = "extension/extension.rs"]
mod extension;
#[path = "header/header.rs"]
mod header;
#[path = "packaging/packaging.rs"]
mod packaging;
#[path = "extension/shapes.rs"]
mod shapes;

// What the answers are worth. Recordings, Debian's programs and Debian's libccd are double.
#[cfg(not(feature = "single"))]
#[path = "../tools/record/record.rs"]
mod record;
#[path = "stability/stability.rs"]
mod stability;
#[cfg(not(feature = "single"))]
#[path = "../engines/swap.rs"]
mod swap;

#[cfg(not(feature = "single"))]
#[path = "../tools/compare/compare.rs"]
mod compare;

// What they cost.
#[cfg(not(feature = "single"))]
#[path = "../bench/measuring/support_counts.rs"]
mod support_counts;

// The tests' own tools.
#[path = "../harness/harness.rs"]
mod harness_itself;
// Natively in the lab.
#[cfg(miri)]
#[path = "../lab/miri.rs"]
mod miri;
