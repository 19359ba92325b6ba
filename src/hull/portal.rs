// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! A portal of the polytope P that known points make ([`Points`]), and the closed surface that it is
//! part of.
//!
//! The portal, a triangle of P that the ray from the apex c through the origin passes, is found in P
//! ([`View`]), and moved outwards until it lies in P's surface, which is MPR's refinement
//! ([`Portal::advance`]). Of a flat face its normal comes from the face's own corners, to
//! rounding, whatever the other object is.
//!
//! Where its plane, and the three planes through c and two of its corners, are at least r from the
//! origin, each with the origin on its inner side, the ball of radius r is in the tetrahedron of c and
//! the portal. Where a side is not, the surface goes on beyond that edge with faces of P, each as far
//! away: the solid angles of a closed surface's faces, all positive, add up to a whole number of
//! spheres, at least one ([`Portal::open_side`]).

use crate::gjk::barycentric;
use crate::hull::start;
use crate::known::points::Points;
use crate::known::support_set::Lowest;
use crate::math::{EPSILON, Vec3, larger, perpendicular, replace_if};

/// Steps of a portal that is looked for. Insensitive: 5 to 16 tried on the recorded contacts.
const FOUND: usize = 8;
/// The share of a distance that a point must leave, or it is no nearer: a guard against rounding.
/// Insensitive: 0.999 and 0.9999 tried.
const NEARER: f64 = 0.999;
/// Faces beyond each other on one side of the portal, at most. Insensitive: 2 to 8 tried, within 0.5 % of
/// the instructions.
const DEEP: usize = 4;
/// The share of the size up to which a depth is shallow. Measured on a first version: deep pairs took
/// a quarter more time where these were tried too.
const SHALLOW: f64 = 0.05;

/// A triangle of points of P, counter-clockwise as seen from outside.
#[derive(Clone, Copy)]
pub struct Portal {
    /// Of each corner, the places of obj1's and of obj2's point.
    pub names: [[usize; 2]; 3],
    /// The corners.
    pub points: [Vec3; 3],
}

/// A corner of a portal that is looked for: a point of P.
#[derive(Clone, Copy)]
struct Seen {
    names: [usize; 2],
    p: Vec3,
    /// c × p: times another point, what both span as seen along the ray, times |c|.
    across: Vec3,
}

impl Seen {
    #[inline(always)]
    fn of(names: [usize; 2], p: Vec3, c: &Vec3) -> Self {
        let across = c.cross(&p);
        Self { names, p, across }
    }
}

/// What a step came to.
pub enum Step {
    /// Nearer to the ray.
    On,
    /// The portal.
    Portal(Portal),
    /// No nearer.
    End,
}

/// As seen along the ray, what has been found of a portal.
pub struct View {
    a: Seen,
    /// Another corner, and what the two span; the ray passes beyond the edge between them, or
    /// through it.
    b: Option<(Seen, f64)>,
    /// Across the ray, from the corner or the edge towards it; of any length.
    pub way: Vec3,
    /// How far along it corner or edge are: not positive.
    from: f64,
}

impl View {
    /// From the point of P that direction number `from` found.
    #[inline(always)]
    pub fn of(points: &Points, from: usize, c: &Vec3) -> Self {
        let names = points.names(from);
        let p = points.point(names);
        let c2 = c.norm_squared();
        let mut way = c * c.dot(&p) - p * c2;
        // On the ray any way is as good.
        if !(way.norm_squared() > EPSILON * EPSILON * c2 * c2 * p.norm_squared()) {
            way = perpendicular(c) * c2;
        }
        Self {
            a: Seen::of(names, p, c),
            b: None,
            way,
            from: way.dot(&p),
        }
    }

    /// From an edge of a portal that the ray passes beyond; `None` where it passes the portal.
    fn beyond(portal: &Portal, c: &Vec3) -> Option<Self> {
        let seen = |i: usize| Seen::of(portal.names[i], portal.points[i], c);
        let corners = [seen(0), seen(1), seen(2)];
        for (a, b) in [(0, 1), (1, 2), (2, 0)] {
            let (a, b) = (corners[a], corners[b]);
            let ab = a.across.dot(&b.p);
            if ab > 0.0 {
                let mut view = Self {
                    a,
                    b: None,
                    way: Vec3::zeros(),
                    from: 0.0,
                };
                view.turn(b, ab);
                return Some(view);
            }
        }
        None
    }

    /// Is the point on the ray, or so near to it that the minimum of a ball around the apex is no lower?
    /// `far`: |c|.
    #[inline(always)]
    pub fn is_at(&self, tolerance: f64, far: f64) -> bool {
        -self.from <= 0.5 * tolerance * far * far * far
    }

    /// The way that the lowest direction is to be tilted by, as [`start::tilt`] has it, and
    /// whether there is any. `far`: |c|; `length`: from there to where the ray leaves D, about.
    #[inline(always)]
    pub fn tilt(&self, depth: f64, far: f64, length: f64, vain: usize) -> Option<Vec3> {
        let way2 = self.way.norm_squared();
        let span = if self.b.is_some() { 1.0 / far } else { 0.0 };
        let tilt = start::tilt(depth, -self.from, -self.from / way2, span, length);
        start::growth(vain)
            .filter(|_| tilt > 0.0)
            .map(|by| self.way * (tilt * by))
    }

    /// Goes on in P. The portal, if there is one; `None` where P ends this side of the ray.
    #[inline(never)]
    pub fn portal(&mut self, points: &Points, c: &Vec3) -> Option<Portal> {
        for _ in 0..FOUND {
            let names = points.extreme(&self.way);
            let p = points.point(names);
            match self.step(names, &p, c) {
                Step::On => {}
                Step::Portal(portal) => return Some(portal),
                Step::End => return None,
            }
        }
        None
    }

    /// Goes on to the point of P of these places.
    #[inline(always)]
    pub fn step(&mut self, names: [usize; 2], p: &Vec3, c: &Vec3) -> Step {
        let beyond = self.way.dot(p);
        if !(beyond > NEARER * self.from) {
            return Step::End;
        }
        let Some((b, ab)) = self.b else {
            self.turn(Seen::of(names, *p, c), self.a.across.dot(p));
            return Step::On;
        };
        // Of the same sign as the edge's, if the ray is this side of the new edges.
        let sign = (1.0 as f64).copysign(ab);
        let (bp, pa) = (b.across.dot(p), -self.a.across.dot(p));
        if sign * bp < 0.0 {
            self.a = Seen::of(names, *p, c);
            self.turn(b, -bp);
        } else if sign * pa < 0.0 {
            self.turn(Seen::of(names, *p, c), -pa);
        } else if !(beyond > 0.0) {
            return Step::End;
        } else {
            let (x, y) = if sign < 0.0 {
                (&self.a, &b)
            } else {
                (&b, &self.a)
            };
            return Step::Portal(Portal {
                names: [x.names, y.names, names],
                points: [x.p, y.p, *p],
            });
        }
        Step::On
    }

    /// The edge leads from `a` to this corner now, and the two span so much.
    #[inline(always)]
    fn turn(&mut self, b: Seen, ab: f64) {
        let sign = (1.0 as f64).copysign(ab);
        self.way = (b.across - self.a.across) * sign;
        self.from = -ab.abs();
        self.b = Some((b, ab));
    }
}

impl Portal {
    /// The portal that a [`Basis::hint`](crate::hull::global::Basis::hint) tells of.
    #[inline(always)]
    pub fn hinted(points: &Points, hint: u32) -> Self {
        let corner = |i: u32| {
            let [a, b] = [2 * i, 2 * i + 1].map(|i| points.names((hint >> (2 * i)) as usize % 4));
            [a[0], b[1]]
        };
        let names = [corner(0), corner(1), corner(2)];
        Self {
            names,
            points: names.map(|names| points.point(names)),
        }
    }

    /// Does the ray from c through the origin pass it, and has the tetrahedron with c a volume? `tiny`: what
    /// three products of lengths round by.
    #[inline(always)]
    pub fn is_pierced(&self, c: &Vec3, tiny: f64) -> bool {
        let [u, v, w] = &self.points;
        let m = w.cross(c);
        let (x, y, z) = (c.dot(&u.cross(v)), m.dot(v), -m.dot(u));
        x <= 0.0 && y <= 0.0 && z <= 0.0 && x + y + z < -tiny
    }

    /// The portal of another ray.
    pub fn moved(&self, points: &Points, c: &Vec3) -> Option<Self> {
        match View::beyond(self, c) {
            Some(mut view) => view.portal(points, c),
            None => Some(*self),
        }
    }

    /// Its plane.
    #[inline(always)]
    pub fn plane(&self) -> Plane {
        // From the last corner: in the swapped pair the first two change places, and this is minus
        // the same to the bit.
        let [u, v, w] = &self.points;
        let n = (u - w).cross(&(v - w));
        Plane {
            n,
            n2: n.norm_squared(),
            d: n.dot(w),
        }
    }

    /// Moves it outwards in P: to the point farthest along its normal, if that is above it by more than
    /// `level`, metres.
    #[inline(always)]
    pub fn advance(&mut self, points: &Points, plane: &Plane, c: &Vec3, level: f64) -> bool {
        let names = points.extreme(&plane.n);
        let p = points.point(names);
        let gain = plane.n.dot(&(p - self.points[2]));
        let above = gain > 0.0 && gain * gain > level * level * plane.n2;
        if above {
            self.replace(names, &p, c);
        }
        above
    }

    /// A point above takes the place of a corner: the ray passes the triangle with the other two.
    #[inline(always)]
    pub fn replace(&mut self, names: [usize; 2], p: &Vec3, c: &Vec3) {
        // The side of the plane through c, the origin and p that a corner is on.
        let m = p.cross(c);
        // By masks: which corner it is nothing foretells.
        let above = |corner: &Vec3| m.dot(corner) > 0.0;
        let [a, b, c] = self.points.each_ref().map(above);
        let takes = [a & b | !a & !c, !a & c, a & !b];
        for ((corner, name), takes) in self.points.iter_mut().zip(&mut self.names).zip(takes) {
            for (x, p) in corner.iter_mut().zip(p.iter()) {
                replace_if(takes, x, *p);
            }
            let mask = 0_usize.wrapping_sub(takes.into());
            for (x, p) in name.iter_mut().zip(names) {
                *x = p & mask | *x & !mask;
            }
        }
    }

    /// Is the ball of this radius, metres, inside, if the portal's plane reaches so far? Else the normal of
    /// the plane that leans out as far as may be on a side where it is not.
    #[inline(always)]
    pub fn open_side(&self, points: &Points, c: &Vec3, least: f64, tiny: f64) -> Option<Vec3> {
        let [u, v, w] = &self.points;
        let inner = Inner {
            c,
            least2: least * least,
            tiny,
        };
        // Spelt out: a loop would go by way of memory.
        let open = |a, b| match inner.is_beside(a, b) {
            true => None,
            false => inner.open_side(points, [a, b], DEEP),
        };
        open(u, v).or_else(|| open(v, w)).or_else(|| open(w, u))
    }

    /// The weights of the corners in the point where the ray along the lowest direction leaves,
    /// about: `least` or more along it. `None`: that is elsewhere, another minimum is as low within
    /// the tolerance.
    #[inline(always)]
    pub fn touches(
        &self,
        plane: &Plane,
        lowest: &Lowest,
        least: f64,
        tolerance: f64,
    ) -> Option<[f64; 3]> {
        let [u, v, w] = &self.points;
        let Lowest { depth, dir } = lowest;
        let Plane { n, n2, d } = *plane;
        let along = n.dot(dir);
        // How far the foot of the origin is from the lowest plane's, squared, at most: what a ball falls
        // back by half the tolerance in.
        let most = depth * tolerance;
        if d * along >= least * n2 && (n2 - along * along) * depth * depth <= most * n2 {
            let n = n / n2;
            let (x, y) = (n.dot(&v.cross(w)), n.dot(&w.cross(u)));
            let z = 1.0 - (x + y);
            if x >= 0.0 && y >= 0.0 && z >= 0.0 {
                return Some([x, y, z]);
            }
        }
        let barycentric::Nearest {
            weights, distance2, ..
        } = barycentric::triangle(&(dir * *depth), u, v, w);
        let height = dir.dot(&barycentric::mix(&weights, [u, v, w]));
        (distance2 <= most && height >= least).then_some(weights)
    }
}

/// The plane of a portal.
#[derive(Clone, Copy)]
pub struct Plane {
    /// Its normal, outwards, twice as long as the portal's area.
    pub n: Vec3,
    /// The square of that length.
    n2: f64,
    /// The plane's distance from the origin, times that length.
    d: f64,
}

impl Plane {
    /// Is it this far from the origin, metres, by more than what rounds? `tiny`: what three
    /// products of lengths round by. The normal of a small triangle is off by as much as its corners
    /// are, and that tells far from it.
    #[inline(always)]
    pub fn reaches(&self, least: f64, tiny: f64) -> bool {
        let d = self.d - tiny;
        d > 0.0 && d * d >= least * least * self.n2
    }

    /// How far a point is above it, metres.
    #[inline(always)]
    pub fn above(&self, p: &Vec3) -> f64 {
        (self.n.dot(p) - self.d) / self.n2.sqrt()
    }

    /// Is it too far from the origin for a shallow contact?
    #[inline(always)]
    pub fn is_deep(&self, size2: f64) -> bool {
        self.d > 0.0 && self.d * self.d > SHALLOW * SHALLOW * size2 * self.n2
    }
}

/// The ball that is to be in the surface.
struct Inner<'c> {
    c: &'c Vec3,
    least2: f64,
    /// What three products of lengths round by.
    tiny: f64,
}

impl Inner<'_> {
    /// Is the triangle of c and an edge from `a` to `b`, with the surface on its left, as far?
    #[inline(always)]
    fn is_beside(&self, a: &Vec3, b: &Vec3) -> bool {
        self.is_behind(&(a - self.c).cross(&(b - self.c)), self.c)
    }

    /// Is the plane of this normal through this point as far, with the origin on its inner side?
    /// The normal of the sides points inwards.
    #[inline(always)]
    fn is_behind(&self, n: &Vec3, p: &Vec3) -> bool {
        let d = -n.dot(p) - self.tiny;
        d > 0.0 && d * d >= self.least2 * n.norm_squared()
    }

    /// The surface goes on beyond the edge from `a` to `b` with a face to a point of P out there. Where
    /// it does not, the normal of the plane through the edge that leans out as far as may be.
    #[cold]
    #[inline(never)]
    fn open_side(&self, points: &Points, [a, b]: [&Vec3; 2], deep: usize) -> Option<Vec3> {
        // What is above that plane makes a face that leans out less.
        let e = b - a;
        let across = e * (e.dot(a) / e.norm_squared()) - a;
        let far2 = across.norm_squared();
        let out = across.cross(&e);
        let slope = (larger(far2 / self.least2 - 1.0, 0.0) / out.norm_squared()).sqrt();
        let f = out * (far2.sqrt() * slope) - across;
        let p = points.point(points.extreme(&f));
        if !self.is_behind(&(p - b).cross(&(a - b)), a) {
            return Some(f);
        }
        let open = |a: &Vec3, b: &Vec3| {
            if self.is_beside(a, b) {
                None
            } else if deep > 0 {
                self.open_side(points, [a, b], deep - 1)
            } else {
                Some(f)
            }
        };
        open(a, &p).or_else(|| open(&p, b))
    }
}
#[cfg(test)]
mod tests {
    use super::*;
    use crate::known::points::tests::random_points;
    use crate::math::EPSILON;
    use crate::shapes::Random;

    const TOLERANCE: f64 = if EPSILON < 1e-10 { 1e-7 } else { 1e-4 };

    /// The ray passes the portal, and nothing of P is above it.
    #[test]
    fn a_portal_is_refined_to_the_surface() {
        let mut r = Random::new(5);
        let mut found = 0;
        for _ in 0..500 {
            let points = random_points(&mut r, 8);
            let c = r.vector(0.2);
            let Some(mut portal) = View::of(&points, 0, &c).portal(&points, &c) else {
                continue;
            };
            found += 1;
            for _ in 0..24 {
                if !portal.advance(&points, &portal.plane(), &c, 1e-3 * TOLERANCE) {
                    break;
                }
            }
            let n = portal.plane().n;
            assert!(n.dot(&c) < 0.0);
            let top = n.dot(&points.point(points.extreme(&n))) - n.dot(&portal.points[2]);
            assert!(top <= 1e-2 * TOLERANCE * n.norm() + 64.0 * EPSILON);
            let [u, v, w] = &portal.points;
            for (a, b) in [(u, v), (v, w), (w, u)] {
                assert!(c.dot(&a.cross(b)) <= 64.0 * EPSILON);
            }
        }
        assert!(found > 300);
    }
}
