// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The memory of an expanding polytope: on the caller's stack, and in a block of C's
//! malloc once that is full.
//!
//! A callback may throw or longjmp over this frame, so nothing here has a destructor:
//! [`with`] frees the block when the query returns, and a callback that unwinds leaks it.

use core::mem::MaybeUninit;

use super::{free, malloc};
use crate::epa::{Arena, Edge, Entry, FACES_PER_POINT, Face, LEAST_POINTS, MAX_POINTS, Storage};
use crate::support::{Fault, SupportPoint};

/// Points on the stack: enough for all but pairs whose minima (nearly) form a curve.
const STACK_POINTS: usize = 4 * LEAST_POINTS;

/// What a polytope of so many points needs, in one piece.
const fn size(points: usize) -> usize {
    points
        * (size_of::<SupportPoint>()
            + FACES_PER_POINT * (size_of::<Face>() + size_of::<Entry>())
            + size_of::<Edge>())
}

// The arrays follow each other without a gap.
const _: () = assert!(
    align_of::<SupportPoint>() >= align_of::<Face>()
        && align_of::<SupportPoint>() >= align_of::<Entry>()
        && size_of::<SupportPoint>() % align_of::<Face>() == 0
        && size_of::<Face>() % align_of::<Entry>() == 0
        && size_of::<Entry>() % align_of::<Edge>() == 0
);

/// Bytes with the alignment of the arrays.
#[repr(C)]
union Stack {
    bytes: [u8; size(STACK_POINTS)],
    align: SupportPoint,
}

struct Memory {
    /// Points, then faces, then heap entries, then edges, for `capacity` points.
    block: *mut u8,
    capacity: usize,
    /// So many of each are initialised; the polytope is shown no more.
    points: usize,
    /// The block is one of malloc.
    owned: bool,
}

impl Memory {
    fn arrays(&self) -> (*mut SupportPoint, *mut Face, *mut Entry, *mut Edge) {
        let points = self.block.cast::<SupportPoint>();
        let faces = points.wrapping_add(self.capacity).cast::<Face>();
        let heap = faces
            .wrapping_add(self.capacity * FACES_PER_POINT)
            .cast::<Entry>();
        let rim = heap
            .wrapping_add(self.capacity * FACES_PER_POINT)
            .cast::<Edge>();
        (points, faces, heap, rim)
    }

    /// Initialises what `points` more points need, within the capacity.
    fn show(&mut self, points: usize) {
        let (p, f, h, r) = self.arrays();
        let (from, to) = (self.points, points);
        // SAFETY: the block has room for `capacity` points and what belongs to them.
        unsafe {
            for i in from..to {
                p.add(i).write(SupportPoint::default());
                r.add(i).write(Edge::default());
            }
            for i in from * FACES_PER_POINT..to * FACES_PER_POINT {
                f.add(i).write(Face::default());
                h.add(i).write(Entry::default());
            }
        }
        self.points = points;
    }
}

impl Arena for Memory {
    fn storage(&mut self) -> Storage<'_> {
        let (p, f, h, r) = self.arrays();
        let faces = self.points * FACES_PER_POINT;
        // SAFETY: so many of each are initialised, and nobody else knows the block.
        unsafe {
            Storage {
                points: core::slice::from_raw_parts_mut(p, self.points),
                faces: core::slice::from_raw_parts_mut(f, faces),
                open: core::slice::from_raw_parts_mut(h, faces),
                rim: core::slice::from_raw_parts_mut(r, self.points),
            }
        }
    }

    fn grow(&mut self) -> Result<(), Fault> {
        let wanted = (2 * self.points).min(MAX_POINTS);
        if wanted > self.capacity {
            // SAFETY: malloc may be called with any size; its blocks are aligned for reals.
            let block: *mut u8 = unsafe { malloc(size(wanted)) }.cast();
            if block.is_null() {
                return Err(Fault::NoMemory);
            }
            let (from, points) = (self.arrays(), self.points);
            let old = core::mem::replace(
                self,
                Memory {
                    block,
                    capacity: wanted,
                    points,
                    owned: true,
                },
            );
            let to = self.arrays();
            // SAFETY: both blocks have room for `points` points, and do not overlap.
            unsafe {
                to.0.copy_from_nonoverlapping(from.0, points);
                to.1.copy_from_nonoverlapping(from.1, points * FACES_PER_POINT);
                to.2.copy_from_nonoverlapping(from.2, points * FACES_PER_POINT);
                to.3.copy_from_nonoverlapping(from.3, points);
            }
            old.release();
        }
        self.show(wanted);
        Ok(())
    }
}

impl Memory {
    fn release(&self) {
        if self.owned {
            // SAFETY: a block of malloc that nobody uses any more.
            unsafe { free(self.block.cast()) };
        }
    }
}

/// Runs `query` with an arena.
pub fn with<R>(query: impl FnOnce(&mut dyn Arena) -> R) -> R {
    let mut stack = MaybeUninit::<Stack>::uninit();
    let mut memory = Memory {
        block: stack.as_mut_ptr().cast(),
        capacity: STACK_POINTS,
        points: 0,
        owned: false,
    };
    memory.show(LEAST_POINTS);
    let result = query(&mut memory);
    memory.release();
    result
}
