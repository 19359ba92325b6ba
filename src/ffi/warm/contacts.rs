// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Contacts: where two objects touch.

use core::ffi::{c_int, c_uint, c_void};

use super::super::callbacks::QueryArgs;
use super::super::types::{ccd_t, ccd_vec3_t};
use super::codes::CCD_BAD_INPUT;
use super::direction;
use crate::contact::face::MAX_CONTACTS;
use crate::contact::manifold;
use crate::contact::manifold_cache::ManifoldCache;
use crate::math::{Real, unit};

/// One point of a contact manifold.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct ccd_contact_t {
    /// Within the slop of the surface of obj1.
    pub point1: ccd_vec3_t,
    /// point1 - depth * normal; within the slop of the surface of obj2. If the faces do not overlap in
    /// projection, the closest point of obj2's face instead.
    pub point2: ccd_vec3_t,
    /// Metres, at least the support value of normal minus twice the slop; negative if the objects are
    /// apart there.
    pub depth: Real,
    /// Contact id: the same while the contact moves with obj1 or obj2, never 0; 0 without a cache. When a
    /// contact vanishes, a new one within a quarter of the overlap's extent takes its id.
    pub id: c_uint,
}

/// Number of reals in a ccd_manifold_cache_t.
pub const CCD_MANIFOLD_CACHE_REALS: usize = 139;

/// Warm-start data of ccdContacts for one pair, in either order. All bytes zero: empty. Plain
/// data: it may be copied and stored. Stale or random contents only cost time.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct ccd_manifold_cache_t {
    /// Private.
    pub reals: [f32; CCD_MANIFOLD_CACHE_REALS],
    /// Private.
    pub words: [c_uint; 9],
    /// Private.
    pub checksum: c_uint,
}

const _: () = {
    assert!(size_of::<ccd_manifold_cache_t>() == size_of::<ManifoldCache>() + size_of::<c_uint>());
    assert!(align_of::<ccd_manifold_cache_t>() == align_of::<ManifoldCache>());
};

impl ccd_manifold_cache_t {
    /// Returns the checksum of all numbers; 0 where all are zero.
    fn sum(&self) -> c_uint {
        let bits = self.reals.iter().map(|x| x.to_bits());
        let bits = bits.chain(self.words.iter().copied());
        bits.fold(0, |sum: c_uint, x| {
            (sum.rotate_left(5) ^ x).wrapping_mul(0x9e37_79b1)
        })
    }
}

/// Computes the contact manifold: the overlap of the two faces along `normal`, projected along it
/// and reduced to at most `max` contacts, the deepest first, the others in order around the normal,
/// chosen for the largest area.
///
/// `normal`: of a result for this pose (`dir` of calls that have no normal), of any length.
/// `slop`, metres, >= 0: largest distance of a corner below its support plane at which it still
/// belongs to the face; a thousandth of the objects' size is good for resting contacts. Corners
/// between half the slop and the slop may be found or not. If `normal` is off by an angle, the
/// slop must be at least that angle times the extent of the face, or only an edge or a corner is
/// found. For normals of this library 1 % of the depth is enough. The slop is therefore raised to
/// 1 % of the depth along `normal` and to 32 ulps of the largest coordinate; it is at most the
/// size of the face.
///
/// Rounded edges and corners are reduced to their core: a sphere gives one contact, a lying capsule
/// or cylinder two. A face of more than 9 corners is replaced by an inscribed polygon. If the faces
/// do not overlap in projection, there is one contact, with the closest point of each face. The
/// overlap moves continuously with the objects. For objects with margins, the caller moves the
/// points by the margins along the normal.
///
/// `cache`: NULL, or the pair's. An object whose face is that of the last call then takes half the
/// support calls, and contacts keep their ids, with which a solver can reuse the last impulses. If
/// there are more than `max` contacts, the cache also makes the choice of those kept steadier.
///
/// Reads no tolerance, center or max_iterations. At most 24 support calls for each object, 12 for a
/// box, and 10 more if the cache is out of date. Allocates nothing.
///
/// Returns the number of contacts written, at least 1. Returns CCD_BAD_INPUT, and writes nothing, if
/// `normal` is zero, not finite or NULL, `slop` negative or NaN, `max` < 1, `contacts`, `ccd` or a
/// support callback NULL, or a point of a callback not finite.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn ccdContacts(
    obj1: *const c_void,
    obj2: *const c_void,
    ccd: *const ccd_t,
    normal: *const ccd_vec3_t,
    slop: Real,
    cache: *mut ccd_manifold_cache_t,
    contacts: *mut ccd_contact_t,
    max: c_int,
) -> c_int {
    if contacts.is_null() || max < 1 || !(slop >= 0.0) {
        return CCD_BAD_INPUT;
    }
    // SAFETY: [inputs].
    let (normal, objects) = unsafe { (direction(normal), QueryArgs { obj1, obj2, ccd }.objects()) };
    let (Some(normal), Some((one, two))) = (unit(&normal), objects) else {
        return CCD_BAD_INPUT;
    };
    let max = (max as usize).min(MAX_CONTACTS);
    // SAFETY: [inputs]; every bit pattern is a ManifoldCache, which is all but the checksum.
    let mut updated = unsafe { cache.as_ref() }.map(|cache| {
        if cache.checksum == cache.sum() {
            // SAFETY: [inputs]; the cache is the first part of what was read.
            unsafe { *(&raw const *cache).cast::<ManifoldCache>() }
        } else {
            ManifoldCache::default()
        }
    });
    let Ok(manifold) = manifold::contacts(&one, &two, &normal, slop.into(), updated.as_mut(), max)
    else {
        return CCD_BAD_INPUT;
    };
    if let Some(updated) = updated {
        // SAFETY: [outputs].
        unsafe {
            *cache.cast::<ManifoldCache>() = updated;
            (*cache).checksum = (*cache).sum();
        }
    }
    for (i, contact) in manifold.iter().enumerate() {
        // SAFETY: [outputs]; `contacts` has room for `max`. Padding is left unchanged.
        unsafe {
            let out = contacts.add(i);
            (&raw mut (*out).point1).write(contact.point1.into());
            (&raw mut (*out).point2).write(contact.point2.into());
            (&raw mut (*out).depth).write(contact.depth);
            (&raw mut (*out).id).write(contact.id);
        }
    }
    manifold.len() as c_int
}
