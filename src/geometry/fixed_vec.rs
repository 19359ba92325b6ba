// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! A list of limited length without heap memory, for polygons and manifolds.

use core::mem::swap;
use core::ops::{Deref, DerefMut};

/// A list of at most `CAPACITY` elements. A full list ignores further elements.
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
    /// Returns `i` modulo the length, for `i` below twice the length.
    fn index(&self, i: usize) -> usize {
        let i = if i < self.len { i } else { i - self.len };
        i.min(CAPACITY - 1)
    }

    /// Returns element `i` modulo the length. `i` must be below twice the length.
    pub fn cyclic(&self, i: usize) -> &T {
        &self.all[self.index(i)]
    }

    /// Returns element `i` modulo the length, mutable. `i` must be below twice the length.
    pub fn cyclic_mut(&mut self, i: usize) -> &mut T {
        &mut self.all[self.index(i)]
    }

    /// Appends an element.
    pub fn push(&mut self, new: T) {
        if let Some(end) = self.all.get_mut(self.len) {
            *end = new;
            self.len += 1;
        }
    }

    /// Inserts an element at index `i`. In a full list the last element is lost.
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
