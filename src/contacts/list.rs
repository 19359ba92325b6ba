// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! A list that has its room in itself.

use core::mem::swap;
use core::ops::{Deref, DerefMut};

/// At most `ROOM` things, in order; without room nothing is added.
#[derive(Clone, Copy, Debug)]
pub struct List<T, const ROOM: usize> {
    all: [T; ROOM],
    len: usize,
}

impl<T: Copy + Default, const ROOM: usize> Default for List<T, ROOM> {
    fn default() -> Self {
        Self {
            all: [T::default(); ROOM],
            len: 0,
        }
    }
}

impl<T, const ROOM: usize> Deref for List<T, ROOM> {
    type Target = [T];

    #[inline(always)]
    fn deref(&self) -> &[T] {
        self.all.get(..self.len).unwrap_or(&[])
    }
}

impl<T, const ROOM: usize> DerefMut for List<T, ROOM> {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [T] {
        self.all.get_mut(..self.len).unwrap_or(&mut [])
    }
}

impl<T, const ROOM: usize> List<T, ROOM> {
    #[inline(always)]
    fn place(&self, i: usize) -> usize {
        let i = if i < self.len { i } else { i - self.len };
        i.min(ROOM - 1)
    }

    /// The `i`th, counted around once.
    #[inline(always)]
    pub fn at(&self, i: usize) -> &T {
        &self.all[self.place(i)]
    }

    /// The same, to be changed.
    #[inline(always)]
    pub fn at_mut(&mut self, i: usize) -> &mut T {
        &mut self.all[self.place(i)]
    }

    /// Adds one after the last.
    #[inline(always)]
    pub fn push(&mut self, new: T) {
        if let Some(place) = self.all.get_mut(self.len) {
            *place = new;
            self.len += 1;
        }
    }

    /// Puts one in its place; those from there on move up, the last out of a full list.
    #[inline(always)]
    pub fn insert(&mut self, i: usize, mut new: T) {
        self.len = (self.len + 1).min(ROOM);
        let places = self.iter_mut().skip(i);
        places.for_each(|place| swap(place, &mut new));
    }

    /// Takes the last away.
    pub fn pop(&mut self) {
        self.len = self.len.saturating_sub(1);
    }
}
