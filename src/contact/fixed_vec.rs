// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! A short list without heap, for polygons and fans.

use core::mem::swap;
use core::ops::{Deref, DerefMut};

/// At most `CAPACITY` elements, in order; a full one takes no more.
#[derive(Clone, Copy, Debug)]
pub struct FixedVec<T, const CAPACITY: usize> {
    all: [T; CAPACITY],
    len: usize,
}

impl<T: Copy + Default, const CAPACITY: usize> Default for FixedVec<T, CAPACITY> {
    fn default() -> Self {
        Self {
            all: [T::default(); CAPACITY],
            len: 0,
        }
    }
}

impl<T, const CAPACITY: usize> Deref for FixedVec<T, CAPACITY> {
    type Target = [T];

    fn deref(&self) -> &[T] {
        self.all.get(..self.len).unwrap_or(&[])
    }
}

impl<T, const CAPACITY: usize> DerefMut for FixedVec<T, CAPACITY> {
    fn deref_mut(&mut self) -> &mut [T] {
        self.all.get_mut(..self.len).unwrap_or(&mut [])
    }
}

impl<T: Copy + Default, const CAPACITY: usize> FixedVec<T, CAPACITY> {
    fn index(&self, i: usize) -> usize {
        let i = if i < self.len { i } else { i - self.len };
        i.min(CAPACITY - 1)
    }

    /// Returns the `i`th, counted on from the first after the last.
    pub fn at(&self, i: usize) -> &T {
        &self.all[self.index(i)]
    }

    /// Returns the same, mutable.
    pub fn at_mut(&mut self, i: usize) -> &mut T {
        &mut self.all[self.index(i)]
    }

    /// Adds one after the last.
    pub fn push(&mut self, new: T) {
        if let Some(end) = self.all.get_mut(self.len) {
            *end = new;
            self.len += 1;
        }
    }

    /// Inserts one; those from there on move up, the last out of a full one.
    pub fn insert(&mut self, i: usize, mut new: T) {
        self.len = (self.len + 1).min(CAPACITY);
        let places = self.iter_mut().skip(i);
        places.for_each(|place| swap(place, &mut new));
    }
}

impl<T: Copy + Default, const CAPACITY: usize> FromIterator<T> for FixedVec<T, CAPACITY> {
    fn from_iter<I: IntoIterator<Item = T>>(all: I) -> Self {
        let mut vec = Self::default();
        all.into_iter().for_each(|new| vec.push(new));
        vec
    }
}
