// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Allocates the memory of the largest polytopes: one block of C's heap, when a query needs it.
//!
//! A C callback may throw or longjmp over this frame, so nothing in [`with`] has a destructor: it
//! frees the block when the query returns, and a callback that unwinds leaks it. [`Heap`] is for
//! shapes in Rust, which only unwind.

use core::ptr::NonNull;

use super::{calloc, free};
use crate::epa::penetration::{Arena, EpaBuffers};
use crate::minkowski::support::Fault;

#[derive(Default)]
struct Block(Option<NonNull<EpaBuffers>>);

impl Block {
    fn free(&mut self) {
        if let Some(block) = self.0.take() {
            // SAFETY: [heap]; the block is no longer used.
            unsafe { free(block.as_ptr().cast()) };
        }
    }
}

impl Arena for Block {
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
        // SAFETY: [heap]; zero bytes are a valid EpaBuffers, which holds numbers alone.
        Ok(unsafe { &mut *block.as_ptr() })
    }
}

/// Runs `query` with an arena and frees the arena's block.
pub fn with<R>(query: impl FnOnce(&mut dyn Arena) -> R) -> R {
    let mut block = Block::default();
    let result = query(&mut block);
    block.free();
    result
}

/// An arena that frees its block when it is dropped.
#[derive(Default)]
pub struct Heap(Block);

impl Arena for Heap {
    fn buffers(&mut self) -> Result<&mut EpaBuffers, Fault> {
        self.0.buffers()
    }
}

impl Drop for Heap {
    fn drop(&mut self) {
        self.0.free();
    }
}
