// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! A local minimum of the penetration depth in few support points: cutting planes
//! that carry the curvature which the support points themselves reveal.
//!
//! The question is the paper's (Sec. III): the unit n with the least support value
//! h(n) = max over D of n·p, near a start. The paper walks there by rays and
//! portals, whose update is the dual simplex step of a cutting-plane method and
//! knows nothing of curvature; a sphere costs it fifty support points. Here every
//! support point seen near the best direction stays in use.
//!
//! # Derivation
//!
//! *Model.* Near the best direction b, take D = P ⊕ Q: P a polytope, Q smooth. Most
//! pairs are of this form: a box has P alone, an ellipsoid Q alone, a capsule a
//! segment and a ball, a cylinder a segment and a disc. A support point is then
//! s(n) = p(n) + R n with a vertex p of P and the symmetric R, the second derivative
//! of Q's support function: R n changes slowly while p jumps.
//!
//! *Chart.* Directions are b + E x, E = (e1 e2) tangent, not normalised. There
//! H(x) = h·|b + E x| is convex, a support point s is its subgradient E's, and
//!
//!   H(x) ≥ s·b + (E's)·x                                          (exact cut)
//!
//! holds everywhere. With R in the chart split as ρ I + A, tr A = 0, the vertex
//! p = s − R n of the sample (n, s) gives in place of it
//!
//!   H(x) = α + β·x + ½ x'Ax + ρ|b + E x|,   α = s·b − ρ n·b + ½ y'Ay,
//!   β = E's − ρ E'n − A y,   y = E'n / n·b                       (curved cut)
//!
//! exact for P and for balls, to second order for the rest of Q. The depth is
//! h(x) = max over cuts of (α + β·x + ½ x'Ax) / sqrt(1 + x²) + ρ; to second order
//! that is max (α + β·x) + ½ x'Kx + ρ with K = A − (h(b) − ρ) I, the same K for all
//! cuts. Its minimum within a reach |x| ≤ Δ is where to look next.
//!
//! *Subproblem.* One cut: x = −K⁻¹β. Two cuts meet in a line, along which the
//! quadratic has its minimum; three meet in a point. Where K is not positive along
//! what is free, the minimum is on the border of the reach. [`Model::minimise`] takes
//! the lowest of these points that no other cut lies above: K is not positive for
//! polytopes, and of their several minima the lowest is wanted. With four cuts, of
//! which the best or the newest must be active, that is eleven points at most; where
//! R = 0 and the search goes on from a portal it is the portal update of the paper,
//! the dual simplex step.
//!
//! *Curvature.* Two samples of the same vertex p satisfy s' − s = R (n' − n). For
//! two samples let e = (s' − s)·n' and e' = (s − s')·n: what each one exceeds the
//! other's exact cut by. On a smooth piece the trapezoidal rule makes them equal; a
//! kink between the two directions makes e : e' whatever it likes. So a pair with
//! e = e' within [`ALIKE`], whose slope |s' − s| / |n' − n| is no larger than the
//! object, is taken as smooth and R updated from it: by the symmetric rank-one formula,
//! and where that has no say, because what is missing lies across n' − n, by Powell's
//! (both in Nocedal and Wright, Numerical Optimization, ch. 6). The first such pair
//! sets R: its slope times I; a cylinder (R of rank one) corrects that with the next. Samples that have the same vertex within R
//! are one cut: the one nearest to b is kept. A pair with a kink refutes an R
//! that makes the one cut exceed the other's value, and R is reduced along n' − n.
//!
//! The residual of a pair before its update, |s' − s − R (n' − n)| / |s' − s|, is the
//! relative error of R. Until a second pair has told it, R serves for K alone, and a
//! kink or a vertex seen twice that refutes it ends it: polytopes show a pair that
//! looks smooth now and then. Δs exactly parallel to Δn is a ball's, while every smooth
//! pair is so.
//!
//! *Finish.* When the minimum of the model lies inside the reach and no more than
//! the tolerance below h(b), b is the answer if the model can be believed: with
//! R = 0 always, because exact cuts are a proof that h has a local minimum within
//! the tolerance. Otherwise (a) the error of R times the height that R has lifted any
//! active cut by must be within the tolerance; else the next support point is taken
//! on that cut's side of the minimum, near enough to settle it, and replaces it. What
//! is known of R is known of one piece of D: a cylinder's rim bends and its edge line
//! does not. So each sample keeps the error that a pair of its own has told, the whole
//! height where none has, and by as much as a later pair corrects R it is in error
//! again. A ball alone is part of every piece.
//! (b) R must have been measured in two directions if the minimum rests on it (fewer
//! than three active cuts); else the next support point is taken across the one
//! direction known. And (c) along what one or two active cuts leave free, where a valley may
//! go on, R may bend by its error less than is believed: what that would leave of the
//! descent must be within the tolerance, too; else the minimum itself is asked.
//! A start where the gradient vanishes is treated like any other:
//! the second sample, a step aside, tells minimum from maximum. Where minima form a
//! curve or a surface, a model that is level over the whole first reach ends the
//! search.
//!
//! *Bounds.* The reach grows when a descent foretold on its border came true to
//! seven tenths, and shrinks when there was none or when an active cut had to be
//! forgotten. After [`TRUST_CURVATURE`] support points R is given up (exact cuts
//! only); after the caller's cap, or when the reach has shrunk to nothing, the best
//! direction seen is returned as [`Answer::Limit`], for the portal method to go on
//! from. The answer is always the best support plane seen: sound. A support plane with
//! the origin outside ends the query with [`Answer::Miss`] at once; the overlap itself
//! is not proven here.
//!
//! An answer whose witness points do not meet is none: stationary is where the support
//! plane touches D below the origin, and points of the plane around that spot show it. R
//! has led astray there, is forgotten, and the search goes on by exact cuts; where these
//! do not meet either, it is a limit too.
//!
//! *Witness points* are means of the objects' own points, hence inside them, where the
//! points seen have a mean that lies low enough and below the origin. Otherwise they are
//! where R takes the points of the active cuts, which is believed of balls, and of one
//! active cut whose curvature the objects share evenly; of anything else (a cylinder's rim
//! moves along the rim alone) up to [`SIGHTS`] more support points are asked, at the
//! minimum, beside it or, of a face that ties, aside towards the point below the origin,
//! until own points serve: a third of a support point on cylinders and cones, an eighth on
//! ellipsoids.
//!
//! *Memory.* A face that is still there is found again by three directions aside of
//! the last answer, each towards one active cut and farther than the pair moved, and
//! proven by a fourth; a smooth contact by the last direction and one step with R.

use core::ops::{Add, Div, Index, IndexMut, Mul, Sub};

use crate::contact::{Answer, Penetration, Settings};
use crate::contact_patch;
use crate::descent::flat::{Flat, Minimum, Outcome, Samples};
use crate::gjk;
use crate::math::{EPSILON, Real, Vec3, larger, perpendicular, unit};
use crate::support::{Fault, Known, MinkowskiDifference, SupportMap, SupportPoint};

/// Samples kept: three active cuts and the newest.
pub const CUTS: usize = 4;

/// First reach, radians: the error of a good guess.
const REACH: Real = 0.1;
/// The reach grows by this when the model foretold a descent on its border …
const GROW: Real = 2.5;
/// … and shrinks by this when there was none.
const SHRINK: Real = 0.6;
/// Relative difference of the two excesses of a smooth pair.
const ALIKE: Real = 0.03;
/// A pair whose slope is larger than this share of the object must be more alike.
const STEEP: Real = 0.7;
/// A slope larger than so many times the object is a kink's.
const BLUNT: Real = 50.0;
/// Cosine of the angle beyond which R says nothing.
const NEAR: Real = 0.9;
/// How much more alike once a vertex was seen twice (a polytope, it seems).
const FLAT: Real = 0.05;
/// Residual below which two samples are one vertex of P.
const SAME_PIECE: Real = 0.15;
/// Smallest first step, radians: enough to see curvature.
const ASIDE: Real = 0.01;
/// Step across the one direction known, radians.
const ACROSS: Real = 0.03;
/// Relative error of a remembered R, until a pair tells.
const REMEMBERED: Real = 0.4;
/// Relative error above which R moves no cut, and is given up once refuted.
const CONFIRMED: Real = 0.5;
/// Tangent of the angle between a bold first step and the gradient.
const OBLIQUE: Real = 0.1;
/// Reach below which the search has lost its way, radians.
const STUCK: Real = if SINGLE { 1e-4 } else { 1e-6 };
/// Is it the single-precision build?
const SINGLE: bool = EPSILON > 1e-10;
/// Squared angle below which a pair tells nothing above the rounding errors.
const CLOSE: Real = if SINGLE { 1e-4 } else { 1e-10 };
/// Relative residual of a pair that is parallel: a ball's.
const BALL: Real = if SINGLE { 3e-5 } else { 1e-6 };
/// Relative error of R, and of the objects' shares in it, up to which it foretells the
/// witness points of one active cut.
const FORETOLD: Real = 0.1;
const SHARED: Real = 0.4;
/// Support points asked to see witness points that are only foretold.
const SIGHTS: u32 = 4;
/// Support points after which curvature is given up.
const TRUST_CURVATURE: u64 = 40;

/// What a query leaves behind for the next one of the pair: all zero is cold, and
/// any other bits are harmless, since they only choose where to look first.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
pub struct Memory {
    /// The direction of the answer, or a guess of it.
    pub dir: Vec3,
    /// The gradients of the active cuts there, metres.
    pub slopes: [Vec3; 3],
    /// R, metres: xx, xy, xz, yy, yz, zz.
    pub curvature: [Real; 6],
    /// How far `dir` moved since the query before, radians.
    pub drift: Real,
    /// How many of `slopes` are in use.
    pub count: u32,
    /// 1 if `curvature` was measured.
    pub curved: u32,
}

/// One number for each sample. Samples are kept coordinate by coordinate, so that what is
/// computed for all of them needs no loop and compiles to vector instructions.
#[derive(Clone, Copy, Default)]
struct Lanes([Real; CUTS]);

/// The sample that is meant: in range whatever `i` is, and the compiler sees it.
#[inline(always)]
fn lane(i: usize) -> usize {
    i % CUTS
}

impl Index<usize> for Lanes {
    type Output = Real;
    #[inline(always)]
    fn index(&self, i: usize) -> &Real {
        &self.0[lane(i)]
    }
}

impl IndexMut<usize> for Lanes {
    #[inline(always)]
    fn index_mut(&mut self, i: usize) -> &mut Real {
        &mut self.0[lane(i)]
    }
}

impl Lanes {
    #[inline(always)]
    fn all(a: Real) -> Self {
        Self([a; CUTS])
    }

    #[inline(always)]
    fn map(self, f: impl Fn(Real) -> Real) -> Self {
        Self(self.0.map(f))
    }

    #[inline(always)]
    fn zip(self, o: Self, f: impl Fn(Real, Real) -> Real) -> Self {
        Self(core::array::from_fn(|i| f(self[i], o[i])))
    }
}

impl Add for Lanes {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        self.zip(o, |a, b| a + b)
    }
}

impl Sub for Lanes {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        self.zip(o, |a, b| a - b)
    }
}

impl Mul for Lanes {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        self.zip(o, |a, b| a * b)
    }
}

impl Div for Lanes {
    type Output = Self;
    #[inline(always)]
    fn div(self, o: Self) -> Self {
        self.zip(o, |a, b| a / b)
    }
}

impl Mul<Real> for Lanes {
    type Output = Self;
    #[inline(always)]
    fn mul(self, f: Real) -> Self {
        self.map(|a| a * f)
    }
}

/// One vector for each sample.
#[derive(Clone, Copy, Default)]
struct Vectors {
    x: Lanes,
    y: Lanes,
    z: Lanes,
}

impl Vectors {
    #[inline(always)]
    fn get(&self, i: usize) -> Vec3 {
        Vec3::new(self.x[i], self.y[i], self.z[i])
    }

    #[inline(always)]
    fn set(&mut self, i: usize, v: &Vec3) {
        self.x[i] = v.x;
        self.y[i] = v.y;
        self.z[i] = v.z;
    }

    #[inline(always)]
    fn dot(&self, v: &Vec3) -> Lanes {
        self.x * v.x + self.y * v.y + self.z * v.z
    }

    /// Squared distance of each from `v`.
    #[inline(always)]
    fn distance2(&self, v: &Vec3) -> Lanes {
        let (x, y, z) = (
            self.x - Lanes::all(v.x),
            self.y - Lanes::all(v.y),
            self.z - Lanes::all(v.z),
        );
        x * x + y * y + z * z
    }
}

/// A symmetric matrix.
#[derive(Clone, Copy, Default)]
struct Symmetric {
    xx: Real,
    xy: Real,
    xz: Real,
    yy: Real,
    yz: Real,
    zz: Real,
}

impl Symmetric {
    fn scaled_identity(a: Real) -> Self {
        Self {
            xx: a,
            yy: a,
            zz: a,
            ..Self::default()
        }
    }

    #[inline]
    fn times(&self, v: &Vec3) -> Vec3 {
        Vec3::new(
            self.xx * v.x + self.xy * v.y + self.xz * v.z,
            self.xy * v.x + self.yy * v.y + self.yz * v.z,
            self.xz * v.x + self.yz * v.y + self.zz * v.z,
        )
    }

    /// Adds a · w w'.
    #[inline]
    fn add(&mut self, a: Real, w: &Vec3) {
        let aw = w * a;
        self.xx += aw.x * w.x;
        self.xy += aw.x * w.y;
        self.xz += aw.x * w.z;
        self.yy += aw.y * w.y;
        self.yz += aw.y * w.z;
        self.zz += aw.z * w.z;
    }
}

/// R and what is known of it.
struct Curvature {
    r: Symmetric,
    /// Some pair measured it, or the memory remembers it.
    known: bool,
    /// Relative error, by the last smooth pair.
    error: Real,
    /// How much of it is obj1's, …
    share: Real,
    /// … and how far off that was for a pair's own points, in parts of the lesser share.
    uneven: Real,
    /// The direction of the first smooth pair; zero before it.
    line: Vec3,
    /// Measured along a second direction too.
    spread: bool,
    /// Every smooth pair so far was exactly parallel: a ball, which is part of every
    /// piece of D.
    round: bool,
    /// A vertex was seen from two directions.
    flat: bool,
    /// No longer looked for.
    give_up: bool,
    /// The extent of the object, metres.
    size: Real,
}

impl Curvature {
    /// Relative error of R along `d`: nothing is known across the one direction that it
    /// was measured in.
    #[inline]
    fn error_along(&self, d: &Vec3) -> Real {
        let across = self.line.cross(d).norm_squared();
        if self.spread || across <= 0.04 * self.line.norm_squared() * d.norm_squared() {
            self.error
        } else {
            1.0
        }
    }

    /// Sets the extent of the object; a remembered R beyond any object of that extent
    /// was another's.
    fn forget_unless_fits(&mut self, size: Real) {
        self.size = size;
        let r = &self.r;
        let largest = r.xx.abs() + r.yy.abs() + r.zz.abs() + r.xy.abs() + r.xz.abs() + r.yz.abs();
        self.known &= largest <= 1e3 * size;
    }
}

/// The samples, the best of them, and what they tell.
struct Search<'a> {
    /// Unit directions, …
    n: Vectors,
    /// … their support points of D, …
    v: Vectors,
    /// … and support values.
    h: Lanes,
    /// Where in `met` the support points are.
    at: [usize; CUTS],
    /// Relative error of R as a pair of this sample told it; 1 where none did.
    told: Lanes,
    met: &'a mut Known,
    /// Samples in use; lanes beyond repeat the last one set.
    len: usize,
    best: usize,
    curvature: Curvature,
    /// Rounding error of a support value, metres.
    noise: Real,
}

impl Search<'_> {
    /// The support point of sample `i`.
    fn point(&self, i: usize) -> &SupportPoint {
        self.met.get(self.at[lane(i)])
    }

    /// Drops sample `i`; the last one takes its place. Returns where sample `j` is now.
    #[inline]
    fn drop(&mut self, i: usize, j: usize) -> usize {
        let last = self.len - 1;
        let (n, v) = (self.n.get(last), self.v.get(last));
        self.n.set(i, &n);
        self.v.set(i, &v);
        self.h[i] = self.h[last];
        self.at[lane(i)] = self.at[lane(last)];
        self.told[i] = self.told[last];
        let moved = |k: usize| if k == last { i } else { k };
        self.best = moved(self.best);
        self.len = last;
        moved(j)
    }

    /// Makes (n, p, h) sample `i`.
    #[inline(always)]
    fn set(&mut self, i: usize, n: &Vec3, p: &SupportPoint, h: Real, told: Real) {
        self.at[lane(i)] = self.met.put(p, &self.at);
        self.n.set(i, n);
        self.v.set(i, &p.v);
        self.h[i] = h;
        self.told[i] = told;
        for j in self.len..CUTS {
            self.n.set(j, n);
            self.v.set(j, &p.v);
            self.h[j] = h;
            self.told[j] = told;
            self.at[j] = self.at[lane(i)];
        }
    }

    /// Relative error of R between sample `i` and the direction b: of R as a whole and,
    /// but for a ball, on that piece of D.
    #[inline]
    fn error(&self, i: usize, b: &Vec3) -> Real {
        let curvature = &self.curvature;
        let error = curvature.error_along(&(self.n.get(i) - b));
        if curvature.round {
            error
        } else {
            error.max(self.told[i])
        }
    }

    /// Learns the curvature from a new sample, not yet kept. Returns the nearest sample
    /// that makes a smooth pair with it, [`CUTS`] for none.
    ///
    /// `None`, and nothing learnt: the sample contradicts another. One of the two points
    /// lies beyond the support plane of the other, so one is no support point. Not asked
    /// where the sample is to be `kept` even so.
    #[inline]
    fn learn(&mut self, n: &Vec3, p: &SupportPoint, h: Real, kept: bool) -> Option<usize> {
        let noise = self.noise;
        let curvature = &mut self.curvature;
        let size2 = curvature.size * curvature.size;
        let steep = STEEP * STEEP * size2;
        let mut twin = CUTS;
        let mut twin_dn2 = Real::INFINITY;
        // What a kink between the new sample and the best leaves for R.
        let mut room = Real::INFINITY;
        let mut contradicted = false;
        let dn2s = Lanes::all(2.0) - self.n.dot(n) * 2.0;
        let ds2s = self.v.distance2(&p.v);
        let aheads = Lanes::all(h) - self.v.dot(n);
        let behinds = self.h - self.n.dot(&p.v);
        for i in 0..self.len.min(CUTS) {
            let (dn2, ds2, ahead, behind) = (dn2s[i], ds2s[i], aheads[i], behinds[i]);
            // Also NaN.
            if !(dn2 > CLOSE) {
                continue;
            }
            let repeated = ds2 <= noise * noise;
            curvature.flat |= repeated;
            contradicted |= ahead < -noise || behind < -noise;
            let sum = ahead + behind;
            let limit = if curvature.flat { ALIKE * FLAT } else { ALIKE };
            let gap = (ahead - behind) * (ahead - behind);
            let steep = steep * dn2;
            let alike = sum > noise
                && !curvature.give_up
                && ds2 <= BLUNT * BLUNT * size2 * dn2
                && gap <= limit * limit * sum * sum
                && gap * ds2 <= limit * limit * sum * sum * steep;
            if repeated || alike {
                if dn2 < twin_dn2 {
                    twin = i;
                    twin_dn2 = dn2;
                }
            } else if i == self.best {
                room = 2.0 * ahead.min(behind);
            }
        }
        if contradicted && !kept {
            return None;
        }
        if curvature.known && room < Real::INFINITY {
            let dn = n - self.n.get(self.best);
            let rd = curvature.r.times(&dn);
            let bend = rd.dot(&dn);
            let room = room.max(0.0);
            if bend > room && curvature.error > CONFIRMED {
                // Refuted before it was confirmed.
                curvature.known = false;
            } else if bend > room {
                curvature.r.add((room - bend) / (bend * bend), &rd);
                curvature.round &= bend - room <= BALL * bend;
                self.told = self.told.map(|told| told.max((bend - room) / bend));
            }
        }
        if twin == CUTS {
            return Some(twin);
        }
        let (dn, dn2) = (n - self.n.get(twin), twin_dn2);
        let other = self.met.get(self.at[lane(twin)]);
        let ds = p.v - other.v;
        let ds2 = ds.norm_squared();
        // The first pair that confirms a remembered R confirms all of it.
        let remembered = curvature.known && curvature.line == Vec3::zeros();
        if curvature.line == Vec3::zeros() {
            curvature.line = dn;
        } else if curvature.line.cross(&dn).norm_squared()
            > 0.04 * dn2 * curvature.line.norm_squared()
        {
            curvature.spread = true;
        }
        if ds2 <= noise * noise {
            if curvature.error > CONFIRMED {
                curvature.known = false;
            }
            if curvature.known {
                let rd = curvature.r.times(&dn);
                let bend = rd.dot(&dn);
                if bend > 1e-6 * curvature.size * dn2 {
                    curvature.r.add(-1.0 / bend, &rd);
                    self.told = Lanes::all(1.0);
                }
            }
            return Some(twin);
        }
        let bend = ds.dot(&dn);
        let slope = bend / dn2;
        let ds1 = p.v1 - other.v1;
        curvature.share = (ds1.dot(&dn) / bend).clamp(0.0, 1.0);
        let lesser = curvature.share.min(1.0 - curvature.share) + BALL;
        let uneven = (ds1 - ds * curvature.share).norm_squared() / ds2;
        curvature.uneven = curvature.uneven.max(uneven.sqrt() / lesser);
        let measured = curvature.known;
        if !measured {
            curvature.known = true;
            let square = slope * bend > 0.9 * ds2;
            curvature.r = Symmetric::scaled_identity(if square { slope } else { ds2 / bend });
        }
        let w = ds - curvature.r.times(&dn);
        let w2 = w.norm_squared();
        if measured {
            curvature.error = (w2 / ds2).sqrt();
            // By as much as this pair corrects it R is another for the other samples.
            self.told = self.told.map(|told| told.max(curvature.error));
        }
        curvature.spread |= remembered && curvature.error < 0.1;
        // Exactly parallel: a ball, if the object has room for it.
        if (ds - dn * slope).norm_squared() <= BALL * BALL * ds2 && slope * slope <= 1.02 * size2 {
            curvature.spread = true;
            if curvature.error > BALL {
                curvature.r = Symmetric::scaled_identity(slope);
                curvature.error = BALL;
            }
            return Some(twin);
        }
        curvature.round = false;
        let along = w.dot(&dn);
        if along * along > 0.0025 * w2 * dn2 {
            curvature.r.add(1.0 / along, &w);
        } else {
            // Across: the least symmetric change that makes R dn what was seen (Powell's).
            let sum = w + dn;
            let across = 1.0 / dn2;
            curvature.r.add(across, &sum);
            curvature.r.add(-across, &w);
            curvature.r.add(-across - along * across * across, &dn);
        }
        Some(twin)
    }

    /// Is sample `i` the same vertex of P as (n, v), within R, and farther from the best
    /// direction b? Then it tells nothing more.
    #[inline]
    fn outdated(&self, i: usize, n: &Vec3, v: &Vec3, b: &Vec3) -> bool {
        let old = self.n.get(i);
        let mut residual = v - self.v.get(i);
        let mut small = self.noise * self.noise;
        if self.curvature.known {
            let rd = self.curvature.r.times(&(n - old));
            small += SAME_PIECE * SAME_PIECE * rd.norm_squared().min(residual.norm_squared());
            residual -= rd;
        }
        residual.norm_squared() <= small && old.dot(b) <= n.dot(b)
    }
}

impl Search<'_> {
    /// Can witness points that R foretells be believed? All of a ball's; of other smooth
    /// pairs those that are near to the one active cut's own. `across`: how far from meeting
    /// they are, which three cuts must do by themselves.
    fn foretells(&self, b: &Vec3, step: &Step, across: Real, tolerance: Real) -> bool {
        let curvature = &self.curvature;
        let exact = |i: &usize| self.error(*i, b) <= BALL;
        let ball = step.set.iter().all(exact);
        let meet = step.count < 3 || across <= self.reach_across(tolerance);
        let smooth = step.count == 1
            && curvature.spread
            && curvature.error <= FORETOLD
            && curvature.uneven <= SHARED;
        curvature.known && (ball || smooth) && meet
    }

    /// How much deeper the minimum can be along what one or two active cuts leave free,
    /// if R bends as much less there as it may be in error.
    fn unsure(&self, model: &Model, step: &Step, reach: Real) -> Real {
        let [i, j, _] = step.set;
        let (x, y) = if step.count == 2 {
            (model.y[j] - model.y[i], model.x[i] - model.x[j])
        } else {
            (step.x, step.y)
        };
        let length2 = x * x + y * y;
        let way = step.x * x + step.y * y;
        let r = model.rho * length2 + model.axx * (x * x - y * y) + 2.0 * model.axy * x * y;
        let bend = r - self.h[self.best] * length2;
        let weights = Model::weights(step, &model.x, &model.y);
        let error: Real = step
            .set
            .iter()
            .zip(weights)
            .map(|(&i, w)| w * self.error(i, &model.b))
            .sum();
        let less = error.min(1.0) * r;
        // How far along, in parts of (x, y).
        let way = way / length2;
        let open = 0.5 * bend * way * way * less / (bend - less);
        // Where no bend is left the slope goes on to the border.
        let slope = bend * way.abs() * reach / length2.sqrt();
        // Neither NaN, of no way.
        if bend > less {
            open.min(slope)
        } else {
            slope.max(0.0)
        }
    }

    /// Where to ask so that the objects' own points take the place of foretold ones.
    fn sight(&self, model: &Model, step: &Step, tolerance: Real) -> Next {
        if step.x * step.x + step.y * step.y <= EPSILON {
            // The minimum itself was asked, and showed one point of a face: another one is
            // found with the direction turned towards it, by so little that it is still of
            // that face.
            let towards = self.towards_foot(model, tolerance);
            if let Some(t) = unit(&towards) {
                return Next::Aside(t * (0.5 * tolerance / self.curvature.size));
            }
        }
        // At the minimum, unless its own point is near enough to where R takes it: then near
        // there, on the side of the active cut that is farthest off, and so near that it is
        // off by less than a witness may be. A point moves as the direction, what it lacks
        // in height as its square.
        let across = self.reach_across(tolerance);
        let weights = Model::weights(step, &model.x, &model.y);
        let mut next = Next::Minimum;
        let mut least = 1.0;
        for (&i, w) in step.set.iter().take(step.count).zip(weights) {
            let (x, y) = model.moved(i, &self.v.get(i), step.x, step.y);
            let share = (0.5 * across / (larger(w, 0.0) * (x * x + y * y).sqrt()))
                .min((0.5 * tolerance / model.lift[i]).sqrt());
            if i == self.best && share < 1.0 {
                return Next::Minimum;
            }
            if share < least {
                least = share;
                next = Next::Beside(i, share);
            }
        }
        next
    }

    /// How far across the normal the witness points may be apart: as far as keeps their
    /// distance within the tolerance of the depth.
    fn reach_across(&self, tolerance: Real) -> Real {
        (2.0 * self.h[self.best] * tolerance).sqrt().max(self.noise)
    }

    /// The way across the normal from what is known of the touched face of D to the point
    /// below the origin.
    fn towards_foot(&self, model: &Model, tolerance: Real) -> Vec3 {
        let least = self.h[self.best] - tolerance;
        let across = |i: usize| {
            let v = self.v.get(i);
            let height = v.dot(&model.b);
            (height >= least).then(|| model.b * height - v)
        };
        let mut nearest = model.b * self.h[self.best] - self.v.get(self.best);
        for p in (0..self.len).filter_map(across) {
            for q in (0..self.len).filter_map(across) {
                let side = q - p;
                let t = -p.dot(&side) / side.norm_squared();
                // NaN, of a side without length, is its end.
                let on = p + side * t.clamp(0.0, 1.0).max(0.0);
                if on.norm_squared() < nearest.norm_squared() {
                    nearest = on;
                }
            }
        }
        nearest
    }
}

/// The chart around the best direction and the cuts α + β·x in it.
struct Model {
    b: Vec3,
    e1: Vec3,
    e2: Vec3,
    rho: Real,
    /// A is [[axx, axy], [axy, −axx]].
    axx: Real,
    axy: Real,
    /// h(b) − ρ: K = A − core · I.
    core: Real,
    /// α − ρ.
    a: Lanes,
    /// β.
    x: Lanes,
    y: Lanes,
    /// How far R lifts each cut at x = 0, metres.
    lift: Lanes,
    len: usize,
    best: usize,
}

/// α + β·x.
#[derive(Clone, Copy, Default)]
struct Cut {
    a: Real,
    x: Real,
    y: Real,
}

impl Cut {
    #[inline]
    fn at(&self, x: Real, y: Real) -> Real {
        self.a + self.x * x + self.y * y
    }

    #[inline]
    fn minus(&self, o: &Self) -> Self {
        Self {
            a: self.a - o.a,
            x: self.x - o.x,
            y: self.y - o.y,
        }
    }
}

/// A point of the chart that minimises the model, and the cuts active there.
#[derive(Clone, Copy)]
struct Step {
    x: Real,
    y: Real,
    value: Real,
    set: [usize; 3],
    count: usize,
    inside: bool,
}

/// Where to ask next.
enum Next {
    /// Where the model has its minimum.
    Minimum,
    /// On the way from there to that sample's direction, a share of it.
    Beside(usize, Real),
    /// Across the one direction in which R was measured.
    Across,
    /// So far aside of there.
    Aside(Vec3),
}

/// The lanes beside one, the last of them twice.
const OTHERS: [[usize; CUTS]; CUTS] = [[1, 2, 3, 3], [0, 2, 3, 3], [0, 1, 3, 3], [0, 1, 2, 2]];
impl Model {
    #[inline]
    fn new(search: &Search) -> Self {
        let best = search.best;
        let b = search.n.get(best);
        let h = search.h[best];
        // Orthonormal basis without a branch (Duff et al., JCGT 6(1), 2017).
        let sign = (1.0 as Real).copysign(b.z);
        let c = -1.0 / (sign + b.z);
        let d = b.x * b.y * c;
        let e1 = Vec3::new(1.0 + sign * b.x * b.x * c, sign * d, -sign * b.x);
        let e2 = Vec3::new(d, sign + b.y * b.y * c, -b.y);
        let (mut rho, mut axx, mut axy) = (0.0, 0.0, 0.0);
        if search.curvature.known {
            let r1 = search.curvature.r.times(&e1);
            let r2 = search.curvature.r.times(&e2);
            let (rxx, rxy, ryy) = (r1.dot(&e1), r1.dot(&e2), r2.dot(&e2));
            rho = 0.5 * (rxx + ryy);
            axx = 0.5 * (rxx - ryy);
            axy = rxy;
            // R is positive semidefinite: a negative eigenvalue becomes zero.
            let m = (axx * axx + axy * axy).sqrt();
            if m > rho {
                let top = (rho + m).max(0.0);
                rho = 0.5 * top;
                axx *= rho / m;
                axy *= rho / m;
            }
        }
        let level = search.v.dot(&b);
        let mut model = Self {
            b,
            e1,
            e2,
            rho,
            axx,
            axy,
            core: h - rho,
            a: level - Lanes::all(rho),
            x: search.v.dot(&e1),
            y: search.v.dot(&e2),
            lift: Lanes::default(),
            len: search.len,
            best,
        };
        if rho > 0.0 && search.curvature.error <= CONFIRMED {
            let z = search.n.dot(&b);
            let (tx, ty) = (search.n.dot(&e1), search.n.dot(&e2));
            let (x, y) = (tx / z, ty / z);
            let (ax, ay) = (x * axx + y * axy, x * axy - y * axx);
            let lift = (Lanes::all(1.0) - z) * rho + (ax * x + ay * y) * 0.5;
            let behind = Lanes::all(h) - level;
            let ahead = search.h - search.n.dot(&search.v.get(best));
            let unlike = (ahead - behind).map(Real::abs) - (ahead + behind) * ALIKE;
            for i in 0..CUTS {
                // A smooth pair is one piece, which b itself represents; a lift above
                // h(b) is refuted; far away R means nothing. All stay exact cuts.
                if i != best
                    && z[i] > NEAR
                    && lift[i] >= 0.0
                    && lift[i] <= behind[i]
                    && unlike[i] > 0.0
                {
                    model.a[i] += lift[i];
                    model.x[i] -= rho * tx[i] + ax[i];
                    model.y[i] -= rho * ty[i] + ay[i];
                    model.lift[i] = lift[i];
                }
            }
        }
        model
    }

    /// Least model value within the reach: the lowest of the points where one cut has
    /// its minimum, two meet and have theirs, or three meet, among those that the
    /// best or the newest cut is part of (the others were there before).
    #[inline]
    fn minimise(&self, newest: usize, reach: Real, noise: Real) -> Step {
        let mut step = Step {
            x: 0.0,
            y: 0.0,
            value: Real::INFINITY,
            set: [self.best; 3],
            count: 1,
            inside: false,
        };
        self.pivot(self.best, reach, noise, &mut step);
        if newest != self.best {
            self.pivot(newest, reach, noise, &mut step);
        }
        // The model's own value of the depth there, exact for P and for balls.
        let (x, y) = (step.x, step.y);
        let i = step.set[0];
        let v = self.a[i] + self.x[i] * x + self.y[i] * y;
        let bent = 0.5 * self.axx * (x * x - y * y) + self.axy * x * y;
        step.value = (v + bent) / (1.0 + x * x + y * y).sqrt() + self.rho;
        step
    }

    #[inline(always)]
    fn cut(&self, i: usize) -> Cut {
        Cut {
            a: self.a[i],
            x: self.x[i],
            y: self.y[i],
        }
    }

    /// The candidates of [`Self::minimise`] with cut `p`.
    #[inline]
    fn pivot(&self, p: usize, reach: Real, noise: Real, step: &mut Step) {
        let c = self.cut(p);
        let (kxx, kxy, kyy) = (self.axx - self.core, self.axy, -self.axx - self.core);
        let reach2 = reach * reach;
        // How far c lies above each other cut.
        let others = &OTHERS[lane(p)];
        let len = self.len - 1;
        let above = [
            c.minus(&self.cut(others[0])),
            c.minus(&self.cut(others[1])),
            c.minus(&self.cut(others[2])),
        ];
        let mut offer = |x: Real, y: Real, i: usize, j: usize, count: usize, inside: bool| {
            let value = c.at(x, y) + 0.5 * (kxx * x * x + kyy * y * y) + kxy * x * y;
            if value < step.value
                && above[0].at(x, y) >= -noise
                && above[1].at(x, y) >= -noise
                && above[2].at(x, y) >= -noise
            {
                *step = Step {
                    x,
                    y,
                    value,
                    set: [p, i, j],
                    count,
                    inside,
                };
            }
        };
        let (mut x, mut y) = (-c.x, -c.y);
        let mut inside = false;
        let det = kxx * kyy - kxy * kxy;
        if det > 0.0 && kxx > 0.0 {
            let di = 1.0 / det;
            (x, y) = ((kyy * x - kxy * y) * di, (kxx * y - kxy * x) * di);
            inside = x * x + y * y <= reach2;
        }
        if !inside {
            let g = x * x + y * y;
            // No gradient: one way is as good as another.
            (x, y) = if g > 0.0 {
                let f = reach / g.sqrt();
                (x * f, y * f)
            } else {
                (reach, 0.0)
            };
        }
        offer(x, y, p, p, 1, inside);
        for k in 0..len.min(3) {
            let (d, i) = (&above[k], others[k]);
            // On the line d = 0, from its point nearest to x = 0.
            let q = d.x * d.x + d.y * d.y;
            let f = -d.a / q;
            // Squared half chord of the line in the reach; NaN for equal cuts.
            let room = reach2 + f * d.a;
            if room > 0.0 {
                let (x0, y0) = (f * d.x, f * d.y);
                let (tx, ty) = (-d.y, d.x);
                let (kx, ky) = (kxx * tx + kxy * ty, kxy * tx + kyy * ty);
                let slope = c.x * tx + c.y * ty + x0 * kx + y0 * ky;
                let bend = kx * tx + ky * ty;
                let mut t = -slope / bend;
                let inside = bend > 0.0 && t * t * q <= room;
                if !inside {
                    t = (room / q).sqrt().copysign(-slope);
                }
                offer(x0 + t * tx, y0 + t * ty, i, i, 2, inside);
            }
            for l in 0..k {
                let (e, j) = (&above[l], others[l]);
                let w = 1.0 / (d.x * e.y - d.y * e.x);
                let (x, y) = ((e.a * d.y - d.a * e.y) * w, (e.x * d.a - d.x * e.a) * w);
                // Refuses NaN and infinity too.
                if x * x + y * y <= reach2 {
                    offer(x, y, i, j, 3, true);
                }
            }
        }
    }

    /// How far R raises cut `i`, of the support point v, at (x, y).
    #[inline]
    fn raise(&self, i: usize, v: &Vec3, x: Real, y: Real) -> Real {
        let turned = (self.x[i] - v.dot(&self.e1)) * x + (self.y[i] - v.dot(&self.e2)) * y;
        let bent = 0.5 * (self.rho + self.axx) * x * x + 0.5 * (self.rho - self.axx) * y * y;
        self.lift[i] + turned + bent + self.axy * x * y
    }

    /// How far across b R moves the support point v of cut `i` on the way to (x, y).
    fn moved(&self, i: usize, v: &Vec3, x: Real, y: Real) -> (Real, Real) {
        (
            self.x[i] - v.dot(&self.e1) + (self.rho + self.axx) * x + self.axy * y,
            self.y[i] - v.dot(&self.e2) + self.axy * x + (self.rho - self.axx) * y,
        )
    }

    #[inline]
    fn direction(&self, x: Real, y: Real) -> Vec3 {
        self.b + self.e1 * x + self.e2 * y
    }

    /// Weights of the active cuts whose gradients (x, y) balance, or come nearest to it.
    fn weights(step: &Step, x: &Lanes, y: &Lanes) -> [Real; 3] {
        let [g, h, k] = step.set.map(|i| (x[i], y[i]));
        let cross = |a: (Real, Real), b: (Real, Real)| a.0 * b.1 - a.1 * b.0;
        match step.count {
            3 => {
                let w = [cross(h, k), cross(k, g), cross(g, h)];
                let sum = w[0] + w[1] + w[2];
                // max drops NaN
                let w = w.map(|w| (w / sum).max(0.0));
                let sum = w[0] + w[1] + w[2];
                // Infinite where gradients on one line add up to no area.
                if sum > 0.0 && sum < Real::INFINITY {
                    w.map(|w| w / sum)
                } else {
                    [1.0, 0.0, 0.0]
                }
            }
            2 => {
                let d = (h.0 - g.0, h.1 - g.1);
                let t = -(g.0 * d.0 + g.1 * d.1) / (d.0 * d.0 + d.1 * d.1);
                // NaN becomes 0
                let t = if t > 0.0 { t.min(1.0) } else { 0.0 };
                [1.0 - t, t, 0.0]
            }
            _ => [1.0, 0.0, 0.0],
        }
    }
}

/// A local minimum of the depth near the remembered direction, else near the unit
/// vector `start`.
///
/// `centre`: any inner point of D, its distance is what curvature is first guessed
/// from. `met`: gains the support points, the best one first, the samples kept last
/// among them, for the caller's proof of the overlap, which a local minimum alone is not.
///
/// # Errors
/// [`Fault::NonFinite`] from a support mapping.
pub fn penetration<A: SupportMap, B: SupportMap>(
    md: &MinkowskiDifference<A, B>,
    centre: Option<&Vec3>,
    start: &Vec3,
    memory: &mut Memory,
    settings: &Settings,
    met: &mut Known,
) -> Result<Answer, Fault> {
    let mut samples = Samples::default();
    if memory.curved != 1 {
        let inner = centre.copied().unwrap_or_default();
        let mut n = *start;
        let mut queue = [n; 3];
        let mut queued = 0;
        let mut trust = REACH;
        if let Some(dir) = unit(&memory.dir) {
            n = dir;
            queued = recall(memory, &dir, &mut queue, None, &mut trust);
            if queued > 0 {
                queued -= 1;
                n = queue[queued.min(2)];
            }
        }
        let rest = queue.get(..queued).unwrap_or(&[]);
        match Flat::new(trust).run(md, &inner, n, rest, settings, met)? {
            Outcome::Found(minimum) => {
                leave(memory, &minimum);
                return Ok(Answer::Hit(minimum.hit));
            }
            Outcome::Apart(n) => return Ok(Answer::Miss(n)),
            Outcome::Open(open) => samples = open,
        }
    }
    bent(md, centre, start, memory, settings, met, &samples)
}

/// Leaves behind what finds the same exact cuts again.
fn leave(memory: &mut Memory, minimum: &Minimum) {
    let dir = minimum.hit.dir;
    let drift = if memory.count > 0 || memory.curved == 1 {
        (dir - memory.dir).norm()
    } else {
        0.0
    };
    let rho = minimum.rho;
    *memory = Memory {
        dir,
        slopes: if minimum.count > 1 {
            minimum.slopes
        } else {
            [Vec3::zeros(); 3]
        },
        curvature: [rho, 0.0, 0.0, rho, 0.0, rho],
        drift,
        count: if minimum.count > 1 {
            minimum.count as u32
        } else {
            0
        },
        curved: u32::from(rho > 0.0),
    };
}

/// [`penetration`] with curvature, from samples of the search without.
#[inline(never)]
pub fn bent<A: SupportMap, B: SupportMap>(
    md: &MinkowskiDifference<A, B>,
    centre: Option<&Vec3>,
    start: &Vec3,
    memory: &mut Memory,
    settings: &Settings,
    met: &mut Known,
    samples: &Samples,
) -> Result<Answer, Fault> {
    let inner = centre.copied().unwrap_or_default();
    let mut n = *start;
    let mut search = Search {
        n: Vectors::default(),
        v: Vectors::default(),
        h: Lanes::default(),
        at: [Known::NONE; CUTS],
        told: Lanes::default(),
        met,
        len: 0,
        best: 0,
        curvature: Curvature {
            r: Symmetric::default(),
            known: false,
            error: 1.0,
            share: 0.5,
            uneven: 0.0,
            line: Vec3::zeros(),
            spread: false,
            round: true,
            flat: false,
            give_up: false,
            size: 0.0,
        },
        noise: 0.0,
    };
    // Directions to ask before the first model, last one first.
    let mut queue = [n; 3];
    let mut queued = 0;
    let mut reach = REACH;
    let mut given = samples.list();
    if !given.is_empty() {
        reach = samples.trust;
    }
    if let (Some(dir), []) = (unit(&memory.dir), given) {
        n = dir;
        queued = recall(
            memory,
            &dir,
            &mut queue,
            Some(&mut search.curvature),
            &mut reach,
        );
        if queued > 0 {
            queued -= 1;
            n = queue[queued.min(2)];
        }
    }
    let mut predicted = Real::NAN;
    let mut on_border = false;
    let mut from = n;
    let mut probing = CUTS;
    let mut tolerance = settings.tolerance;
    let mut iterations = 0;
    let mut beside = false;
    let mut sights = SIGHTS;
    loop {
        let mut p = match given.split_first() {
            Some((first, rest)) => {
                given = rest;
                n = first.n;
                first.point
            }
            None => md.support(&n)?,
        };
        let mut h = n.dot(&p.v);
        if h < 0.0 {
            match gjk::farthest(search.met.points(), &n, 0.0) {
                None => return Ok(Answer::Miss(n)),
                // D holds what was seen: no miss.
                Some(q) if beside || search.len == 0 => {
                    p = q;
                    h = n.dot(&p.v);
                }
                Some(_) => (),
            }
        }
        iterations += 1;
        let size = (p.v1.x.abs() + p.v1.y.abs() + p.v1.z.abs())
            + (p.v2.x.abs() + p.v2.y.abs() + p.v2.z.abs());
        let rounding = 8.0 * EPSILON * size;
        if rounding > search.noise {
            search.noise = rounding;
            tolerance = tolerance.max(rounding);
        }
        let extent = (p.v - inner).norm();
        let mut newest = search.len;
        let mut told = 1.0;
        if search.len == 0 {
            search.curvature.forget_unless_fits(extent);
            tolerance = crate::math::tolerance(settings.tolerance, extent, 0.0).max(rounding);
        } else {
            search.curvature.size = search.curvature.size.max(extent);
            let twin = match search.learn(&n, &p, h, beside) {
                Some(twin) if beside || !(h < 0.0) => twin,
                // A callback that errs here is asked again a little beside.
                _ => {
                    beside = true;
                    n = unit(&(n + perpendicular(&n) * EPSILON.sqrt())).unwrap_or(n);
                    continue;
                }
            };
            beside = false;
            if twin < CUTS {
                told = search.curvature.error;
                search.told[twin] = told;
            }
            if iterations >= TRUST_CURVATURE {
                search.curvature.give_up = true;
                search.curvature.known = false;
            }
            let before = search.h[search.best];
            let came = before - h;
            // False for NaN: no forecast.
            if came > 0.25 * (before - predicted) {
                if on_border && came > 0.7 * (before - predicted) {
                    reach = (reach * GROW).min(1.0);
                }
            } else if predicted.is_finite()
                // Level ground within rounding is no failure.
                && !(came > -8.0 * EPSILON * h)
                && (n - from).norm_squared() > 0.25 * reach * reach
            {
                reach *= SHRINK;
            }
            let better = h < before;
            let best = if better { n } else { search.n.get(search.best) };
            let free = |i: usize| i < CUTS && (better || i != search.best);
            // The answer to a doubt replaces what was doubted.
            if free(probing) {
                newest = probing;
            } else if free(twin) && search.outdated(twin, &n, &p.v, &best) {
                newest = twin;
            }
            if better {
                search.best = newest;
            }
        }
        search.len = search.len.max(newest + 1);
        search.set(newest, &n, &p, h, told);
        probing = CUTS;
        if !given.is_empty() {
            if search.len == CUTS {
                let victim = usize::from(search.best == 0);
                search.drop(victim, CUTS);
            }
            continue;
        }
        if queued > 0 && iterations < settings.max_iterations {
            queued -= 1;
            n = queue[queued.min(2)];
            continue;
        }
        if search.len == 1
            && !search.curvature.known
            && h > search.noise
            && iterations < settings.max_iterations
        {
            // Nothing but the size to go by: down the gradient as on a ball, at least
            // far enough to see curvature.
            let gradient = p.v - n * h;
            let slope = gradient.norm();
            let core = h - search.curvature.size;
            let ball = -slope / core;
            let length = if ball > 0.0 { ball.min(reach) } else { reach }.max(ASIDE);
            on_border = length == reach;
            predicted = (core - slope * length) / (1.0 + length * length).sqrt() + h - core;
            from = n;
            // No gradient: one way is as good as another.
            let down = unit(&-gradient).unwrap_or_else(|| perpendicular(&n));
            // A bold step goes a little aside, so that no symmetry of the start hides what
            // is across.
            let down = if on_border {
                down + n.cross(&down) * OBLIQUE
            } else {
                down
            };
            let d = n + down * length;
            n = d * (1.0 / d.norm());
            continue;
        }
        let (model, step, next) = loop {
            let model = Model::new(&search);
            let step = model.minimise(newest, reach, search.noise);
            let gain = search.h[search.best] - step.value;
            let curved = model.rho != 0.0;
            let mut far = search.best;
            let mut doubt = 0.0;
            // What the same error of R leaves open where the model has its minimum.
            let mut open: Real = 0.0;
            if curved && step.count > 1 {
                for &i in step.set.iter().take(step.count) {
                    let error = search.error(i, &model.b);
                    if i != search.best {
                        let raise = model.raise(i, &search.v.get(i), step.x, step.y);
                        open = open.max(raise * error);
                    }
                    if model.lift[i] * error > doubt {
                        doubt = model.lift[i] * error;
                        far = i;
                    }
                }
            }
            // So near to b another point would tell nothing.
            let far2 = step.x * step.x + step.y * step.y;
            if curved && step.count < 3 && step.inside && far2 > CLOSE {
                open = open.max(search.unsure(&model, &step, reach));
            }
            // Flat as far as the eye reaches: minima that form a curve or a surface.
            let level = reach >= REACH && search.curvature.spread;
            let close = gain.abs() <= tolerance && (step.inside || level);
            let blind = close && curved && step.count < 3 && !search.curvature.spread;
            // Depth zero within rounding cannot be lower.
            let touch = search.h[search.best] <= search.noise;
            let done =
                touch || close && !blind && doubt <= tolerance && gain.abs() + open <= tolerance;
            // A reach that small means that the search is stuck.
            let broken = !step.value.is_finite() || reach < STUCK;
            let last = iterations >= settings.max_iterations;
            if !(done || broken || last) {
                // The probe goes near enough to the minimum to settle the doubt.
                let next = if step.inside && doubt > tolerance && 2.0 * doubt >= gain {
                    let share = (0.5 * tolerance.max(0.1 * gain) / doubt).sqrt();
                    Next::Beside(far, share.min(0.5))
                } else if blind {
                    Next::Across
                } else {
                    Next::Minimum
                };
                break (model, step, next);
            }
            // As asked for, also where rounding allows the depth less.
            let fine = tolerance.min(settings.tolerance + search.noise * 0.25);
            let (answer, across, own) = conclude(&search, &model, &step, fine, iterations);
            // A minimum is where the support plane touches D below the origin: witness
            // points farther apart across the normal than a curve of the object's size
            // may be within the tolerance are not witnesses of one.
            let size = search.curvature.size.max(answer.depth);
            let met = touch || done && across * across <= 4.0 * tolerance * size;
            let foretold = own
                || touch
                || last
                || sights == 0
                || search.foretells(&model.b, &step, across, fine);
            if met && !foretold {
                sights -= 1;
                let next = search.sight(&model, &step, fine);
                break (model, step, next);
            }
            if met || last || !search.curvature.known {
                remember(memory, &search.curvature, &model, &step);
                search.met.lead(search.at[lane(search.best)]);
                return Ok(if met {
                    Answer::Hit(answer)
                } else {
                    Answer::Limit(answer)
                });
            }
            // R has led astray: on from here by exact cuts, and what the next pairs tell.
            search.curvature.known = false;
        };
        predicted = step.value;
        on_border = !step.inside;
        from = model.b;
        let mut d = model.direction(step.x, step.y);
        match next {
            Next::Minimum => (),
            Next::Beside(far, share) => {
                predicted = Real::NAN;
                d += (search.n.get(far) - d) * share;
                probing = far;
            }
            Next::Across => {
                predicted = Real::NAN;
                let line = &search.curvature.line;
                let across = unit(&line.cross(&model.b)).unwrap_or(model.e1);
                search.curvature.spread = *line != Vec3::zeros();
                let g = search.v.get(search.best).dot(&across);
                d += across * ACROSS.copysign(-g);
            }
            Next::Aside(by) => {
                predicted = Real::NAN;
                d += by;
            }
        }
        n = d * (1.0 / d.norm());
        if search.len == CUTS {
            // Room for the next: the cut that is lowest where the model has its
            // minimum. The newest may be the answer to a doubt.
            let mut least = Real::INFINITY;
            let mut victim = CUTS;
            let levels = model.a + model.x * step.x + model.y * step.y;
            for i in 0..CUTS {
                let kept = i == search.best || i == newest || step.set.contains(&i);
                if !kept && levels[i] < least {
                    least = levels[i];
                    victim = i;
                }
            }
            if victim == CUTS {
                // The best and three others: the lowest at the best goes, and for what
                // the model forgets the reach must pay.
                for i in (0..CUTS).filter(|&i| i != search.best) {
                    if model.a[i] < least {
                        least = model.a[i];
                        victim = i;
                    }
                }
                reach *= 0.5;
            }
            if victim == CUTS {
                victim = (search.best + 1) % CUTS;
            }
            probing = search.drop(victim, probing);
        }
    }
}

/// The answer: the best support plane, with its witness points; how far across the
/// normal these were from meeting; and whether they are means of the objects' own points.
fn conclude(
    search: &Search,
    model: &Model,
    step: &Step,
    tolerance: Real,
    iterations: u64,
) -> (Penetration, Real, bool) {
    let b = &model.b;
    let depth = search.h[search.best];
    // Points of the objects themselves: a mean of support points that lie below the
    // origin, or as near to that as a depth within the tolerance allows, and no deeper
    // than the tolerance. First of the active cuts; but a direction that ties several
    // vertices shows one of them, which may leave the model fewer cuts than the search
    // has seen.
    let (x, y) = (search.v.dot(&model.e1), search.v.dot(&model.e2));
    let height = search.v.dot(b);
    let near = search.reach_across(tolerance).powi(2);
    let inside = |set: [usize; 3], w: [Real; 3]| {
        let mean = |l: &Lanes| l[set[0]] * w[0] + l[set[1]] * w[1] + l[set[2]] * w[2];
        let (x, y) = (mean(&x), mean(&y));
        let across2 = x * x + y * y;
        (across2 <= near && mean(&height) >= depth - tolerance).then_some((set, w, across2.sqrt()))
    };
    let active = inside(step.set, Model::weights(step, &x, &y));
    let found = active.or_else(|| enclosing(&x, &y).find_map(|(set, w)| inside(set, w)));
    let own = found.is_some();
    let (point1, point2, across) = match found {
        Some((set, w, across)) => {
            let first = search.point(set[0]);
            let (mut point1, mut point2) = (first.v1, first.v2);
            for (i, w) in set.into_iter().zip(w).skip(1) {
                point1 += (search.point(i).v1 - first.v1) * w;
                point2 += (search.point(i).v2 - first.v2) * w;
            }
            (point1, point2, across)
        }
        None => guessed(search, model, step),
    };
    let seen: [SupportPoint; CUTS] = core::array::from_fn(|i| *search.point(i));
    let answer = Penetration {
        depth,
        depth_lower: 0.0,
        dir: *b,
        normal: *b,
        point1,
        point2,
        width: contact_patch::width(&seen, b, tolerance, search.curvature.size),
        iterations,
    };
    (answer, across, own)
}

/// The witness points that the model foretells: the support points of the active cuts,
/// moved to where R takes them when their directions become b; and how far across the
/// normal these are from meeting.
fn guessed(search: &Search, model: &Model, step: &Step) -> (Vec3, Vec3, Real) {
    let best = search.point(search.best);
    let b = &model.b;
    let share = search.curvature.share;
    let (mut point1, mut point2) = (Vec3::zeros(), Vec3::zeros());
    let weights = Model::weights(step, &model.x, &model.y);
    for (&i, w) in step.set.iter().take(step.count).zip(weights) {
        let p = search.point(i);
        point1 += p.v1 * w;
        point2 += p.v2 * w;
        if model.lift[i] > 0.0 {
            let (x, y) = (
                model.x[i] - p.v.dot(&model.e1),
                model.y[i] - p.v.dot(&model.e2),
            );
            let moved = (model.e1 * x + model.e2 * y) * w;
            point1 += moved * share;
            point2 -= moved * (1.0 - share);
        }
    }
    // What is left across the normal is the distance to the model's minimum.
    let across = point1 - point2;
    let across = across - b * across.dot(b);
    let apart = across.norm();
    if search.h[search.best] <= search.noise {
        // A touch: where these do not meet, the proof of the overlap knows points that do.
        return (best.v1, best.v2, apart);
    }
    point1 -= across * share;
    point2 += across * (1.0 - share);
    // Onto the support planes of both objects.
    point1 += b * (best.v1 - point1).dot(b);
    point2 += b * (best.v2 - point2).dot(b);
    (point1, point2, apart)
}

/// Each three samples whose triangle the ray along b meets, and the weights of where it
/// does; x, y: the samples across b.
fn enclosing(x: &Lanes, y: &Lanes) -> impl Iterator<Item = ([usize; 3], [Real; 3])> {
    let area = |i: usize, j: usize| x[i] * y[j] - y[i] * x[j];
    OTHERS.into_iter().filter_map(move |[i, j, k, _]| {
        let w = [area(j, k), area(k, i), area(i, j)];
        let sum = w[0] + w[1] + w[2];
        let w = w.map(|w| w / sum);
        // False for NaN: three points on a line.
        w.iter().all(|&w| w >= 0.0).then_some(([i, j, k], w))
    })
}

/// Leaves behind what finds the same active cuts again.
fn remember(memory: &mut Memory, curvature: &Curvature, model: &Model, step: &Step) {
    let drift = if memory.count > 0 || memory.curved == 1 {
        (model.b - memory.dir).norm()
    } else {
        0.0
    };
    let gradient = |i: usize| model.e1 * model.x[i] + model.e2 * model.y[i];
    let (slopes, count) = match step.count {
        1 => ([Vec3::zeros(); 3], 0),
        count => (step.set.map(gradient), count as u32),
    };
    let r = &curvature.r;
    *memory = Memory {
        dir: model.b,
        slopes,
        curvature: [r.xx, r.xy, r.xz, r.yy, r.yz, r.zz],
        drift,
        count,
        curved: u32::from(curvature.known),
    };
}

/// Takes from the memory what still makes sense: the directions to ask first, into
/// `queue`, and the curvature. Returns the number of directions.
fn recall(
    memory: &Memory,
    dir: &Vec3,
    queue: &mut [Vec3; 3],
    curvature: Option<&mut Curvature>,
    reach: &mut Real,
) -> usize {
    // Farther aside than the pair moved, and not as far where R is known, which serves
    // the better the nearer the samples are (in double precision); NaN becomes the least
    // angle.
    let (times, least) = if memory.curved == 1 && !SINGLE {
        (2.0, 0.0005)
    } else {
        (5.0, 0.004)
    };
    let drift = times * memory.drift;
    let angle = if drift > least {
        drift.min(0.03)
    } else {
        least
    };
    let slopes = &memory.slopes;
    let count = (memory.count as usize).min(slopes.len());
    let mut queued = 0;
    let at = |i: usize| slopes[(i % count).min(2)];
    for i in 0..count {
        let (g, h, k) = (at(i), at(i + 1), at(i + 2));
        // Where one cut is above the other two by as much as it can: across the line on
        // which they are equal, and, since a face may have a fourth vertex there, towards
        // the vertex itself.
        let side = if count == 3 {
            let across = dir.cross(&(k - h));
            let up = across.dot(&(g - h));
            unit(&across)
                .zip(unit(&g))
                .map(|(a, g)| a * (1.0 as Real).copysign(up) + g)
        } else {
            Some(g - h)
        };
        let across = side.map(|s| s - dir * dir.dot(&s));
        if let Some(n) = across
            .and_then(|a| unit(&a))
            .and_then(|s| unit(&(dir + s * angle)))
        {
            if let Some(place) = queue.get_mut(queued) {
                *place = n;
                queued += 1;
            }
        }
    }
    if queued > 0 {
        *reach = reach.min(2.5 * angle);
    }
    let [xx, xy, xz, yy, yz, zz] = memory.curvature;
    if let (Some(curvature), true) = (
        curvature,
        memory.curved == 1 && (xx + xy + xz + yy + yz + zz).is_finite(),
    ) {
        curvature.r = Symmetric {
            xx,
            xy,
            xz,
            yy,
            yz,
            zz,
        };
        curvature.known = true;
        // Enough to look by, not to believe.
        curvature.error = REMEMBERED;
    }
    queued
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::local::{self, Shortcut};

    /// A support function, placed.
    type Shape = Box<dyn Fn(&Vec3) -> Vec3>;

    fn at(c: Vec3, f: impl Fn(&Vec3) -> Vec3 + 'static) -> Shape {
        Box::new(move |d| c + f(d))
    }

    fn ball(c: Vec3, r: Real) -> Shape {
        at(c, move |d| d * r)
    }

    fn block(c: Vec3, half: Vec3) -> Shape {
        at(c, move |d| {
            Vec3::new(
                half.x.copysign(d.x),
                half.y.copysign(d.y),
                half.z.copysign(d.z),
            )
        })
    }

    fn capsule(c: Vec3, r: Real, half: Real) -> Shape {
        at(c, move |d| d * r + Vec3::z() * half.copysign(d.z))
    }

    fn cylinder(c: Vec3, r: Real, half: Real) -> Shape {
        at(c, move |d| {
            let t = (d.x * d.x + d.y * d.y).sqrt();
            let f = if t > 0.0 { r / t } else { 0.0 };
            Vec3::new(d.x * f, d.y * f, half.copysign(d.z))
        })
    }

    fn ellipsoid(c: Vec3, r: Vec3) -> Shape {
        at(c, move |d| {
            let w = r.component_mul(&r.component_mul(d));
            w / w.dot(d).sqrt()
        })
    }

    fn hull(points: Vec<Vec3>) -> Shape {
        Box::new(move |d| {
            points
                .iter()
                .copied()
                .max_by(|a, b| a.dot(d).total_cmp(&b.dot(d)))
                .unwrap_or_default()
        })
    }

    fn icosahedron() -> Vec<Vec3> {
        let g = 0.5 * (1.0 + (5.0 as Real).sqrt());
        let mut points = Vec::new();
        for (a, b) in [(1.0, g), (1.0, -g), (-1.0, g), (-1.0, -g)] {
            points.push(Vec3::new(0.0, a, b).normalize());
            points.push(Vec3::new(a, b, 0.0).normalize());
            points.push(Vec3::new(b, 0.0, a).normalize());
        }
        points
    }

    const TOLERANCE: Real = if EPSILON > 1e-10 { 1e-5 } else { 1e-8 };

    fn settings(tolerance: Real) -> Settings {
        Settings {
            tolerance,
            max_iterations: 500,
        }
    }

    fn solve(
        a: &Shape,
        b: &Shape,
        start: Vec3,
        memory: &mut Memory,
        tolerance: Real,
    ) -> (Answer, u64) {
        let md = MinkowskiDifference::new(a, b);
        let mut met = Known::default();
        let answer = penetration(
            &md,
            None,
            &start.normalize(),
            memory,
            &settings(tolerance),
            &mut met,
        );
        match answer {
            // What every caller does with a search that did not end in a minimum.
            Ok(Answer::Limit(p)) => {
                let shortcut = Shortcut::Always;
                let rest = settings(tolerance);
                match local::penetration(&md, p.normal, shortcut, &rest, |_| ()) {
                    Ok(answer) => (answer, md.supports()),
                    Err(fault) => panic!("{fault:?}"),
                }
            }
            Ok(answer) => (answer, md.supports()),
            Err(fault) => panic!("{fault:?}"),
        }
    }

    fn hit(a: &Shape, b: &Shape, start: Vec3, tolerance: Real) -> Penetration {
        match solve(a, b, start, &mut Memory::default(), tolerance) {
            (Answer::Hit(p), supports) => {
                assert!(supports < 100, "{supports} support points");
                p
            }
            (other, supports) => panic!("{other:?} after {supports}"),
        }
    }

    fn h(a: &Shape, b: &Shape, n: &Vec3) -> Real {
        n.dot(&(a(n) - b(&-n)))
    }

    /// Sound, witnessed, and nothing lower nearby: an answer must hold all of this.
    fn check(a: &Shape, b: &Shape, p: &Penetration, tolerance: Real, size: Real) {
        let slack = 64.0 * EPSILON * size;
        assert!((p.dir.norm() - 1.0).abs() < 8.0 * EPSILON);
        assert!((h(a, b, &p.dir) - p.depth).abs() <= slack);
        let difference = p.point1 - p.point2;
        // Where a touch meets is for the proof of the overlap to say.
        assert!(
            p.depth <= slack
                || (difference - p.dir * p.depth).norm()
                    <= (2.0 * p.depth * tolerance).sqrt() + tolerance + slack
        );
        for (point, reach) in [
            (p.point1, a(&p.dir).dot(&p.dir)),
            (p.point2, b(&-p.dir).dot(&p.dir)),
        ] {
            assert!((point.dot(&p.dir) - reach).abs() <= tolerance + slack);
        }
        let e1 = perpendicular(&p.dir);
        let e2 = p.dir.cross(&e1);
        for k in 0..16 {
            let (s, c) = (k as Real * 0.39).sin_cos();
            for step in [1e-3, 1e-2] {
                let n = (p.dir + (e1 * c + e2 * s) * step).normalize();
                let there = h(a, b, &n);
                assert!(
                    there >= p.depth - 4.0 * tolerance - slack,
                    "{} lower at {step} rad",
                    p.depth - there
                );
            }
        }
    }

    #[test]
    fn a_stationary_start_is_not_an_answer() {
        // A ball on a capsule's axis: 1.3 along it is a maximum.
        let a = capsule(Vec3::zeros(), 0.5, 0.5);
        let b = ball(Vec3::z() * 0.2, 0.5);
        let p = hit(&a, &b, Vec3::z(), TOLERANCE);
        assert!((p.depth - 1.0).abs() < 2.0 * TOLERANCE, "{}", p.depth);
        check(&a, &b, &p, TOLERANCE, 3.0);
        // Icosahedra along a vertex: a maximum of the distance.
        let points = icosahedron();
        let start = points[0];
        let a = hull(points.clone());
        let b = hull(points);
        let p = hit(&a, &b, start, TOLERANCE);
        check(&a, &b, &p, TOLERANCE, 3.0);
        assert!(p.depth < 1.9);
    }

    #[test]
    fn balls_and_boxes_are_exact() {
        let c = Vec3::new(0.3, 0.2, 0.1);
        let (a, b) = (ball(Vec3::zeros(), 1.0), ball(c, 1.0));
        let p = hit(&a, &b, Vec3::new(1.0, 0.4, -0.3), TOLERANCE);
        assert!((p.depth - (2.0 - c.norm())).abs() < TOLERANCE);
        check(&a, &b, &p, TOLERANCE, 3.0);
        let (a, b) = (
            block(Vec3::zeros(), Vec3::repeat(1.0)),
            block(Vec3::new(0.1, 0.2, 1.9), Vec3::repeat(1.0)),
        );
        let p = hit(&a, &b, Vec3::new(0.1, -0.2, 1.0), TOLERANCE);
        assert!((p.depth - 0.1).abs() < 16.0 * EPSILON, "{}", p.depth);
        assert!((p.dir - Vec3::z()).norm() < 16.0 * EPSILON);
        check(&a, &b, &p, TOLERANCE, 3.0);
    }

    #[test]
    fn coincident_centres_end() {
        let unit_box = || block(Vec3::zeros(), Vec3::new(0.5, 0.4, 0.3));
        let pairs: [(Shape, Shape); 5] = [
            (ball(Vec3::zeros(), 1.0), ball(Vec3::zeros(), 0.1)),
            (unit_box(), unit_box()),
            (
                capsule(Vec3::zeros(), 0.5, 0.5),
                capsule(Vec3::zeros(), 0.2, 0.7),
            ),
            (
                cylinder(Vec3::zeros(), 0.5, 0.5),
                cylinder(Vec3::zeros(), 0.5, 0.5),
            ),
            (
                ellipsoid(Vec3::zeros(), Vec3::new(0.5, 0.35, 0.25)),
                ellipsoid(Vec3::zeros(), Vec3::new(0.5, 0.35, 0.25)),
            ),
        ];
        for (i, (a, b)) in pairs.iter().enumerate() {
            for start in [
                Vec3::x(),
                Vec3::z(),
                Vec3::new(0.3, -0.8, 0.5),
                Vec3::new(1.0, 1.0, 1.0),
            ] {
                let p = hit(a, b, start, TOLERANCE);
                assert!(p.depth > 0.0, "{i}");
                check(a, b, &p, TOLERANCE, 2.0);
            }
        }
    }

    #[test]
    fn flat_and_thin_shapes_end() {
        // Beyond that the rounding errors of single precision are as large as the rest.
        let long = if SINGLE { 1e3 } else { 1e6 };
        let flat: Vec<Shape> = vec![
            block(Vec3::zeros(), Vec3::new(0.5, 0.5, 0.0)),
            block(Vec3::zeros(), Vec3::new(0.5, 0.0, 0.0)),
            block(Vec3::zeros(), Vec3::zeros()),
            cylinder(Vec3::zeros(), 0.5, 0.0),
            block(Vec3::zeros(), Vec3::new(1.0, 1e-6, 1.0)),
            block(Vec3::zeros(), Vec3::new(long, 1.0, 1.0)),
            ellipsoid(Vec3::zeros(), Vec3::new(1.0, 0.05, 0.05)),
        ];
        for (i, a) in flat.iter().enumerate() {
            for (j, b) in flat.iter().enumerate() {
                for start in [
                    Vec3::z(),
                    Vec3::new(0.1, 0.2, 0.9),
                    Vec3::new(-0.7, 0.3, 0.5),
                ] {
                    let size = if i == 5 || j == 5 { 2.0 * long } else { 2.0 };
                    match solve(a, b, start, &mut Memory::default(), TOLERANCE) {
                        (Answer::Hit(p), _) => check(a, b, &p, TOLERANCE, size),
                        // In single precision the curvature of a needle is rounding:
                        // the search may stop at the minimum without knowing it.
                        (Answer::Limit(p), _) if SINGLE => check(a, b, &p, TOLERANCE, size),
                        (Answer::Miss(n), _) => assert!(h(a, b, &n) < 0.0),
                        (other, supports) => panic!("{i} {j} {start:?} {other:?} after {supports}"),
                    }
                }
            }
        }
    }

    #[test]
    fn any_scale_place_and_tolerance() {
        for scale in [1e-6, 1e-3, 1.0, 1e3, 1e6] {
            for far in [0.0, 1e3] {
                for fine in [0.0, 1e-12, 1e-6] {
                    let o = Vec3::new(1.0, -0.7, 0.4) * (far * scale);
                    let c = |x, y, z| o + Vec3::new(x, y, z) * scale;
                    let pairs: [(Shape, Shape); 5] = [
                        (ball(o, scale), ball(c(0.9, 0.4, 0.2), 0.5 * scale)),
                        (
                            block(o, Vec3::new(0.5, 0.4, 0.3) * scale),
                            block(c(0.4, 0.2, 0.3), Vec3::repeat(0.3 * scale)),
                        ),
                        (
                            capsule(o, 0.5 * scale, 0.5 * scale),
                            ellipsoid(c(0.5, 0.3, 0.4), Vec3::new(0.5, 0.35, 0.25) * scale),
                        ),
                        (
                            cylinder(o, 0.5 * scale, 0.5 * scale),
                            block(c(0.7, 0.3, 0.4), Vec3::new(0.5, 0.4, 0.3) * scale),
                        ),
                        (
                            cylinder(o, 0.5 * scale, 0.5 * scale),
                            capsule(c(0.6, 0.2, 0.4), 0.2 * scale, 0.3 * scale),
                        ),
                    ];
                    for (i, (a, b)) in pairs.iter().enumerate() {
                        let tolerance = fine * scale;
                        let size = scale * (1.0 + far);
                        match solve(
                            a,
                            b,
                            Vec3::new(0.8, 0.4, 0.3),
                            &mut Memory::default(),
                            tolerance,
                        ) {
                            (Answer::Hit(p), supports) => {
                                assert!(supports < 100, "{i} {scale} {far} {fine}: {supports}");
                                check(a, b, &p, tolerance.max(64.0 * EPSILON * size), size);
                            }
                            other => panic!("{i} {scale} {far} {fine}: {other:?}"),
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn apart_is_seen_and_touching_is_free() {
        let a = ball(Vec3::zeros(), 1.0);
        let b = block(Vec3::new(1.7, 0.1, 0.2), Vec3::repeat(0.5));
        match solve(
            &a,
            &b,
            Vec3::new(0.2, 1.0, 0.1),
            &mut Memory::default(),
            TOLERANCE,
        ) {
            (Answer::Miss(n), supports) => {
                assert!(h(&a, &b, &n) < 0.0);
                assert!(supports < 20);
            }
            other => panic!("{other:?}"),
        }
        for (a, b) in [
            (ball(Vec3::zeros(), 1.0), ball(Vec3::x() * 2.0, 1.0)),
            (
                block(Vec3::zeros(), Vec3::repeat(1.0)),
                block(Vec3::x() * 2.0, Vec3::repeat(1.0)),
            ),
        ] {
            match solve(
                &a,
                &b,
                Vec3::new(1.0, 0.1, 0.1),
                &mut Memory::default(),
                TOLERANCE,
            ) {
                (Answer::Hit(p), _) => assert!(p.depth <= TOLERANCE, "{}", p.depth),
                (Answer::Miss(n), _) => assert!(h(&a, &b, &n) < 0.0),
                other => panic!("{other:?}"),
            }
        }
    }

    #[test]
    fn any_memory_is_harmless() {
        // Bits of a linear congruential generator, and of another pair.
        let mut bits: u64 = 1;
        let mut next = || {
            bits = bits
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            bits
        };
        let a = cylinder(Vec3::zeros(), 0.5, 0.5);
        let b = block(Vec3::new(0.6, 0.3, 0.4), Vec3::new(0.5, 0.4, 0.3));
        for round in 0..2000 {
            let mut real = || {
                if round % 2 == 0 {
                    Real::from_bits(next() as _)
                } else {
                    (next() >> 40) as Real / (1 << 23) as Real - 1.0
                }
            };
            let mut v = || Vec3::new(real(), real(), real());
            let mut memory = Memory {
                dir: v(),
                slopes: [v(), v(), v()],
                ..Memory::default()
            };
            memory.curvature = [(); 6].map(|_| real());
            memory.drift = real();
            memory.count = (round % 5) as u32;
            memory.curved = (round % 3) as u32;
            match solve(&a, &b, Vec3::x(), &mut memory, TOLERANCE) {
                (Answer::Hit(p), _) => check(&a, &b, &p, TOLERANCE, 2.0),
                (other, supports) => panic!("{round}: {other:?} after {supports}"),
            }
        }
    }

    #[test]
    fn a_contact_that_stays_is_found_again_cheaply() {
        let still = |a: &Shape, b: &Shape, most: u64| {
            let mut memory = Memory::default();
            let mut last = 0;
            for _ in 0..4 {
                last = solve(a, b, Vec3::new(0.2, 0.1, 1.0), &mut memory, 1e-6).1;
            }
            assert!(last <= most, "{last} support points");
        };
        still(
            &block(Vec3::zeros(), Vec3::new(0.5, 0.4, 0.3)),
            &hull(
                icosahedron()
                    .iter()
                    .map(|p| p * 0.5 + Vec3::new(0.03, 0.02, 0.7))
                    .collect(),
            ),
            if SINGLE { 6 } else { 4 },
        );
        still(
            &ball(Vec3::zeros(), 0.5),
            &ball(Vec3::new(0.1, 0.2, 0.8), 0.5),
            2,
        );
    }
}
