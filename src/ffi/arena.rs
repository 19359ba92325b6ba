// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Allocates the memory of the largest polytopes: one block of C's heap, if a query needs it.
//!
//! A C callback may throw or longjmp over the frame of the block's owner, where nothing with a destructor may be alive:
//! queries of C callers keep [`LargeBuffers`] in a `ManuallyDrop`, and a callback that unwinds leaks the block. Panics of
//! shapes in Rust run the destructor.

use core::ptr::NonNull;

use super::{calloc, free};
use crate::epa::buffers::{Arena, EpaBuffers};
use crate::minkowski::support::Fault;

/// The block of one query; empty until the query asks for it.
#[derive(Default)]
pub struct LargeBuffers(Option<NonNull<EpaBuffers>>);

impl Arena for LargeBuffers {
    fn buffers(&mut self) -> Result<&mut EpaBuffers, Fault> {
        let block = match self.0 {
            Some(block) => block,
            None => {
                // SAFETY: [heap]; calloc takes any size.
                let block = unsafe { calloc(1, size_of::<EpaBuffers>()) };
                NonNull::new(block.cast()).ok_or(Fault::NoMemory)?
            }
        };
        self.0 = Some(block);
        // SAFETY: [heap]; zero bytes are a valid EpaBuffers, which holds only numbers.
        Ok(unsafe { &mut *block.as_ptr() })
    }
}

impl Drop for LargeBuffers {
    fn drop(&mut self) {
        if let Some(block) = self.0 {
            // SAFETY: [heap]; the block is no longer used.
            unsafe { free(block.as_ptr().cast()) };
        }
    }
}
