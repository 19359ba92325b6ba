// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! The known vertices of both objects, and the support function of their k² differences.
//!
//! Entry i holds the vertex of obj1 and the vertex of obj2 that one support call of D returned, and the
//! unit direction of that call. The coordinates of the two objects are interleaved, obj2's negated: a
//! difference is then a sum, and one loop of two-lane operations finds the farthest vertex of both.
//!
//! A full set does not grow: [`VertexSet::push`] replaces the last entry. A caller that needs all of its
//! entries tests [`VertexSet::is_full`] first.

use crate::math::{Vec3, ZERO, index_below, larger};
use crate::minkowski::support::SupportPoint;

/// A known difference: the index of obj1's vertex and of obj2's.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct VertexPair {
    /// Index of obj1's vertex.
    pub a: u16,
    /// Index of obj2's vertex.
    pub b: u16,
}

/// A known difference with its coordinates: a corner of a portal or of the polytope.
#[derive(Clone, Copy, Debug, Default)]
pub struct Vertex {
    /// The point of D.
    pub w: Vec3,
    /// Its two vertices.
    pub pair: VertexPair,
}

/// The known vertices of a pair, from at most `N` support calls.
pub struct VertexSet<const N: usize> {
    /// x, y and z of each entry: obj1's vertex, and minus obj2's.
    coords: [[[f64; 2]; N]; 3],
    /// The unit direction of the support call of each entry; zero for a point that no call returned.
    dirs: [Vec3; N],
    len: usize,
}

/// The bits of an index.
const INDEX_BITS: u32 = 10;
/// The bits of a packed pair.
pub const PAIR_BITS: u32 = 2 * INDEX_BITS;
/// The largest index, which no set has.
const NO_INDEX: u16 = (1 << INDEX_BITS) - 1;

impl VertexPair {
    /// The mark of the interior point, which is not a difference of known vertices.
    pub const INTERIOR: Self = Self {
        a: NO_INDEX,
        b: NO_INDEX,
    };

    /// Returns whether this is the interior point.
    #[inline(always)]
    pub fn is_interior(self) -> bool {
        self.a == NO_INDEX
    }

    /// Packs the pair into the low [`PAIR_BITS`] bits.
    #[inline(always)]
    pub fn to_bits(self) -> u64 {
        u64::from(self.b) << INDEX_BITS | u64::from(self.a)
    }

    /// Unpacks a pair; the other bits are ignored.
    #[inline(always)]
    pub fn from_bits(bits: u64) -> Self {
        let (a, b) = (
            bits as u16 & NO_INDEX,
            (bits >> INDEX_BITS) as u16 & NO_INDEX,
        );
        Self { a, b }
    }
}

impl<const N: usize> VertexSet<N> {
    /// The set without vertices.
    pub const EMPTY: Self = Self {
        coords: [[[0.0; 2]; N]; 3],
        dirs: [ZERO; N],
        len: 0,
    };
    /// The low bits of a dot product that are replaced by the index of its vertex.
    const INDEX_MASK: u64 = (N.next_power_of_two() - 1) as u64;
    /// The bits of a dot product that a tag replaces.
    const TAG_MASK: u64 = Self::INDEX_MASK | Self::INDEX_MARK;
    /// The bit above the index, which is always set, so that no tagged product is ±0: codegen, see README.
    const INDEX_MARK: u64 = N.next_power_of_two() as u64;

    /// Returns an index that is in range for any `i`.
    #[inline(always)]
    fn in_range(i: usize) -> usize {
        const { assert!(N > 0 && N <= NO_INDEX as usize) };
        index_below(N, i)
    }

    /// Returns the number of entries.
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.len
    }

    /// Returns whether there is no room for another entry.
    #[inline(always)]
    pub fn is_full(&self) -> bool {
        self.len >= N
    }

    /// Makes room for another entry: compacts a full set.
    #[inline(always)]
    pub fn make_room(&mut self, corners: &mut [Vertex]) {
        if self.is_full() {
            self.compact(corners);
        }
    }

    /// Removes all entries except those of the corners, at most four. Indices change.
    #[cold]
    #[inline(never)]
    pub fn compact(&mut self, corners: &mut [Vertex]) {
        let mut kept = Self::EMPTY;
        let mut olds = [usize::MAX; 8];
        let mut keep = |old: usize| {
            if let Some(new) = olds.iter().position(|o| *o == old) {
                return new;
            }
            let new = kept.push(&self.dir(old), &self.point(Self::pair_of_entry(old)));
            if let Some(slot) = olds.get_mut(new) {
                *slot = old;
            }
            new
        };
        for corner in corners {
            if !corner.pair.is_interior() {
                let [a, b] = [corner.pair.a, corner.pair.b].map(|i| keep(i.into()) as u16);
                corner.pair = VertexPair { a, b };
            }
        }
        self.copy_from(&kept);
    }

    /// Adds an entry and returns its index. A full set replaces its last entry.
    #[inline(always)]
    pub fn push(&mut self, dir: &Vec3, point: &SupportPoint) -> usize {
        let i = Self::in_range(self.len.min(N - 1));
        self.set(i, dir, point);
        self.len = i + 1;
        i
    }

    /// Replaces the entry with index `i`.
    #[inline(always)]
    fn set(&mut self, i: usize, dir: &Vec3, point: &SupportPoint) {
        let i = Self::in_range(i);
        for (k, coords) in self.coords.iter_mut().enumerate() {
            coords[i] = [point.v1[k], -point.v2[k]];
        }
        self.dirs[i] = *dir;
    }

    /// Removes the entries from index `len` on.
    #[inline(always)]
    pub fn truncate(&mut self, len: usize) {
        self.len = self.len.min(len);
    }

    /// Copies the entries of another set, with their indices, as far as there is room.
    pub fn copy_from<const M: usize>(&mut self, other: &VertexSet<M>) {
        let len = other.len.min(M).min(N);
        for (coords, others) in self.coords.iter_mut().zip(&other.coords) {
            coords[..len].copy_from_slice(&others[..len]);
        }
        self.dirs[..len].copy_from_slice(&other.dirs[..len]);
        self.len = len;
    }

    /// Returns the direction of the support call of an entry, unit; zero for a point that no call returned.
    #[inline(always)]
    pub fn dir(&self, i: usize) -> Vec3 {
        self.dirs[Self::in_range(i)]
    }

    /// Returns x, y and z of an entry: obj1's vertex, and minus obj2's.
    #[inline(always)]
    pub fn coords(&self, i: usize) -> [[f64; 2]; 3] {
        let i = Self::in_range(i);
        self.coords.each_ref().map(|coords| coords[i])
    }

    /// Returns the coordinates of all entries, like [`VertexSet::coords`].
    #[inline(always)]
    pub fn all_coords(&self) -> impl Iterator<Item = [[f64; 2]; 3]> + '_ {
        let [x, y, z] = self
            .coords
            .each_ref()
            .map(|coords| coords.get(..self.len).unwrap_or(&[]));
        x.iter().zip(y).zip(z).map(|((x, y), z)| [*x, *y, *z])
    }

    /// Returns the vertex of obj1 of an entry.
    #[inline(always)]
    pub fn vertex1(&self, i: usize) -> Vec3 {
        let [x, y, z] = &self.coords;
        let i = Self::in_range(i);
        Vec3::new(x[i][0], y[i][0], z[i][0])
    }

    /// Returns the vertex of obj2 of an entry.
    #[inline(always)]
    pub fn vertex2(&self, i: usize) -> Vec3 {
        let [x, y, z] = &self.coords;
        let i = Self::in_range(i);
        Vec3::new(-x[i][1], -y[i][1], -z[i][1])
    }

    /// Returns a known difference, a point of D.
    #[inline(always)]
    pub fn difference(&self, pair: VertexPair) -> Vec3 {
        let [x, y, z] = &self.coords;
        let (a, b) = (Self::in_range(pair.a.into()), Self::in_range(pair.b.into()));
        Vec3::new(x[a][0] + x[b][1], y[a][0] + y[b][1], z[a][0] + z[b][1])
    }

    /// Returns the known difference farthest along `n` with its coordinates.
    #[inline(always)]
    pub fn farthest_vertex(&self, n: &Vec3) -> Vertex {
        let pair = self.farthest(n);
        Vertex {
            w: self.difference(pair),
            pair,
        }
    }

    /// Returns the known difference farthest along `n`, which need not be unit, of the vertices of three corners alone. At
    /// least one corner is not the interior point.
    #[inline(always)]
    pub fn farthest_of_corners(&self, n: &Vec3, corners: &[VertexPair; 3]) -> Vertex {
        let [x, y, z] = &self.coords;
        let mut best = [f64::NEG_INFINITY; 2];
        for corner in corners {
            if corner.is_interior() {
                continue;
            }
            for (lane, i) in [corner.a, corner.b].into_iter().enumerate() {
                let i = Self::in_range(i.into());
                let h = n.x * x[i][lane] + n.y * y[i][lane] + n.z * z[i][lane];
                let tag = Self::INDEX_MARK | i as u64;
                best[lane] = larger(best[lane], Self::tagged(h, tag));
            }
        }
        let pair = Self::tagged_pair(best);
        let w = self.difference(pair);
        Vertex { w, pair }
    }

    /// Returns a corner. `interior`: the coordinates of the interior point.
    #[inline(always)]
    pub fn vertex(&self, pair: VertexPair, interior: &Vec3) -> Vertex {
        let w = if pair.is_interior() {
            *interior
        } else {
            self.difference(pair)
        };
        Vertex { w, pair }
    }

    /// Returns a known difference with its two vertices.
    #[inline(always)]
    pub fn point(&self, pair: VertexPair) -> SupportPoint {
        SupportPoint {
            v: self.difference(pair),
            v1: self.vertex1(pair.a.into()),
            v2: self.vertex2(pair.b.into()),
        }
    }

    /// Returns the indices of the support point of entry `i`: its own two vertices.
    #[inline(always)]
    pub fn pair_of_entry(i: usize) -> VertexPair {
        VertexPair {
            a: i as u16,
            b: i as u16,
        }
    }

    /// Returns the known difference farthest along `n`, which need not be unit; the first entry if the set is
    /// empty.
    ///
    /// The index of a vertex is in the low bits of its dot product, so that the maximum carries its index. Products
    /// that differ by less than 2⁻⁴², relatively, count as equal; callers compute heights from the coordinates.
    #[inline(always)]
    pub fn farthest(&self, n: &Vec3) -> VertexPair {
        if self.len < 2 {
            return VertexPair::default();
        }
        let [x, y, z] = &self.coords;
        let mut best = [f64::NEG_INFINITY; 2];
        let mut tag = [Self::INDEX_MARK; 2];
        // codegen: see README.
        let step = core::hint::black_box(&[1, 1]);
        for i in 0..self.len.min(N) {
            for lane in 0..2 {
                let h = n.x * x[i][lane] + n.y * y[i][lane] + n.z * z[i][lane];
                best[lane] = larger(best[lane], Self::tagged(h, tag[lane]));
                tag[lane] += step[lane];
            }
        }
        Self::tagged_pair(best)
    }

    /// Replaces the low bits of a dot product by a tag.
    #[inline(always)]
    fn tagged(h: f64, tag: u64) -> f64 {
        f64::from_bits(h.to_bits() & !Self::TAG_MASK | tag)
    }

    /// Returns the indices in the tags of two products.
    #[inline(always)]
    fn tagged_pair(products: [f64; 2]) -> VertexPair {
        let [a, b] = products.map(|h| (h.to_bits() & Self::INDEX_MASK) as u16);
        VertexPair { a, b }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_shapes::Random;

    fn random_set<const N: usize>(r: &mut Random, count: usize) -> VertexSet<N> {
        let mut set = VertexSet::EMPTY;
        for _ in 0..count {
            let (v1, v2) = (r.vector(1.0), r.vector(1.0));
            set.push(&r.direction(), &SupportPoint { v: v1 - v2, v1, v2 });
        }
        set
    }

    #[test]
    fn the_farthest_difference_is_that_of_all_pairs() {
        let mut r = Random::new(1);
        for count in 1..=21 {
            let set = random_set::<21>(&mut r, count);
            for _ in 0..50 {
                let n = r.vector(3.0);
                let pairs = (0..count as u16).flat_map(|a| (0..count as u16).map(move |b| (a, b)));
                let most = pairs
                    .map(|(a, b)| n.dot(&set.difference(VertexPair { a, b })))
                    .fold(f64::NEG_INFINITY, f64::max);
                let found = n.dot(&set.difference(set.farthest(&n)));
                assert!((found - most).abs() <= 1e-12, "{count} {found} {most}");
            }
        }
    }

    #[test]
    fn the_farthest_difference_of_corners_is_that_of_their_vertices() {
        let mut r = Random::new(3);
        let set = random_set::<20>(&mut r, 20);
        for _ in 0..200 {
            let n = r.vector(3.0);
            let mut index = || r.within(0.0, 19.9) as u16;
            let (a, b) = ([index(), index()], [index(), index()]);
            let corners = [
                VertexPair { a: a[0], b: b[0] },
                VertexPair::INTERIOR,
                VertexPair { a: a[1], b: b[1] },
            ];
            let pairs = a.into_iter().flat_map(|a| b.map(|b| VertexPair { a, b }));
            let most = pairs
                .map(|pair| n.dot(&set.difference(pair)))
                .fold(f64::NEG_INFINITY, f64::max);
            let found = set.farthest_of_corners(&n, &corners);
            assert_eq!(found.w, set.difference(found.pair));
            assert!((n.dot(&found.w) - most).abs() <= 1e-12);
        }
    }

    #[test]
    fn a_negative_product_keeps_its_index() {
        let mut set = VertexSet::<8>::EMPTY;
        for x in [-3.0, -1.0, -2.0] {
            let v1 = Vec3::x() * x;
            set.push(
                &Vec3::x(),
                &SupportPoint {
                    v: v1 * 2.0,
                    v1,
                    v2: -v1,
                },
            );
        }
        assert_eq!(set.farthest(&Vec3::x()), VertexPair { a: 1, b: 1 });
        assert_eq!(set.farthest(&-Vec3::x()), VertexPair { a: 0, b: 0 });
    }

    #[test]
    fn entries_are_stored_and_copied() {
        let mut r = Random::new(2);
        let mut set = random_set::<4>(&mut r, 4);
        assert!(set.is_full());
        let last = (set.point(VertexSet::<4>::pair_of_entry(3)), set.dir(3));
        assert_eq!(last.0.v, last.0.v1 - last.0.v2);
        let mut large = VertexSet::<9>::EMPTY;
        large.copy_from(&set);
        assert_eq!(large.point(VertexSet::<9>::pair_of_entry(3)), last.0);
        set.truncate(2);
        set.push(&last.1, &last.0);
        assert_eq!((set.len(), set.dir(2)), (3, last.1));
    }
}
