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
//! what is free, the minimum is on the border of the reach. [`Model::minimise`]
//! starts with the cut of b and adds the cut that is most violated, trying the new
//! cut with each subset of the active ones (1 + 3 + 3), until none is violated: the
//! dual simplex step again, with curvature.
//!
//! *Curvature.* Two samples of the same vertex p satisfy s' − s = R (n' − n). For
//! two samples let e = (s' − s)·n' and e' = (s − s')·n: what each one exceeds the
//! other's exact cut by. On a smooth piece the trapezoidal rule makes them equal; a
//! kink between the two directions makes e : e' whatever it likes. So a pair with
//! e = e' within [`ALIKE`], whose slope |s' − s| / |n' − n| is no larger than the
//! object, is taken as smooth and R updated by the symmetric rank-one formula from
//! it. The first such pair sets R: its slope times I; a cylinder (R of rank one)
//! corrects that with the next pair. Samples that have the same vertex within R
//! are one cut: the one nearest to b is kept. A pair with a kink refutes an R
//! that makes the one cut exceed the other's value, and R is reduced along n' − n.
//!
//! *Finish.* When the minimum of the model lies inside the reach and no more than
//! the tolerance below h(b), b is the answer if the model can be believed:
//! with R = 0 always, because exact cuts are a proof that h has a local minimum
//! within the tolerance. Otherwise (a) the relative error of R, measured as the
//! residual of the last smooth pair before its update, times the height that R has
//! lifted the farthest active cut by must be within the tolerance; else the next
//! support point is taken on that cut's side of the minimum, close enough to
//! settle it. And (b) R must have been measured in two directions if the minimum
//! rests on it (fewer than three active cuts); else the next support point is taken
//! across the one direction known. A start where the gradient vanishes is treated like any
//! other: the second sample a step aside tells minimum from maximum.
//!
//! *Bounds.* The reach grows when the model's descent came true on its border and
//! shrinks when it did not. After [`TRUST_CURVATURE`] support points R is given up
//! (exact cuts only: the portal method's guarantee); after the caller's cap the best
//! direction seen is returned as [`Answer::Limit`]. The answer is always the best
//! support plane seen: sound. A support plane with the origin outside ends the
//! query with [`Answer::Miss`] at once; the overlap itself is not proven here.
//!
//! *Tried and left out* (they did not save a tenth of the supports or of the time):
//! one isotropic radius for all cuts, the prototype's erosion (no help on cylinders
//! and ellipsoids); choosing between a bundle and a Newton model by the better
//! forecast (one model does both); more than [`CUTS`] samples.

use crate::contact::{Answer, Penetration, Settings};
use crate::math::{EPSILON, Real, Vec3, unit};
use crate::support::{Fault, MinkowskiDifference, SupportMap, SupportPoint};

/// Samples kept: three active cuts, the best, the newest, and one to spare.
pub const CUTS: usize = 6;

/// First reach, radians: the error of a good guess.
const REACH: Real = 0.09;
/// The reach grows by this when the model foretold a descent on its border …
const GROW: Real = 2.0;
/// … and shrinks by this when there was none.
const SHRINK: Real = 0.6;
/// Relative difference of the two excesses of a smooth pair.
const ALIKE: Real = 0.03;
/// A pair whose slope is larger than this share of the object must be more alike.
const STEEP: Real = 0.7;
/// How much more alike once a vertex was seen twice (a polytope, it seems).
const FLAT: Real = 0.25;
/// Residual below which two samples are one vertex of P.
const SAME_PIECE: Real = 0.15;
/// Smallest first step, radians: enough to see curvature.
const ASIDE: Real = 0.01;
/// Support points after which curvature is given up.
const TRUST_CURVATURE: u64 = 40;

/// What a query leaves behind for the next one of the pair: all zero is cold, and
/// any other bits are harmless, since they only choose where to look first.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
pub struct Memory {
    /// The direction of the answer, or a guess of it.
    pub dir: Vec3,
    /// Tangents at `dir` towards the sides of the active cuts.
    pub sides: [Vec3; 3],
    /// R, metres: xx, xy, xz, yy, yz, zz.
    pub curvature: [Real; 6],
    /// How far `dir` moved since the query before, radians.
    pub drift: Real,
    /// How many of `sides` are in use.
    pub count: u32,
    /// 1 if `curvature` was measured.
    pub curved: u32,
}

/// A direction, its support point, its support value.
#[derive(Clone, Copy, Default)]
struct Sample {
    n: Vec3,
    p: SupportPoint,
    h: Real,
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
#[derive(Clone, Copy)]
struct Curvature {
    r: Symmetric,
    /// Some pair measured it, or the memory remembers it.
    known: bool,
    /// Relative error, by the last smooth pair.
    error: Real,
    /// The direction of the first smooth pair; zero before it.
    line: Vec3,
    /// Measured along a second direction too.
    spread: bool,
    /// A vertex was seen from two directions.
    flat: bool,
    /// The extent of the object, metres.
    size: Real,
}

impl Curvature {
    /// Learns from the new sample `s`, compared with the `others`.
    #[inline]
    fn learn(&mut self, s: &Sample, others: &[Sample], noise: Real) {
        let mut nearest: Option<(&Sample, Vec3, Vec3, Real)> = None;
        for o in others {
            let dn = s.n - o.n;
            let ds = s.p.v - o.p.v;
            let dn2 = dn.norm_squared();
            // Closer directions tell nothing above the rounding errors.
            if !(dn2 > 1e-10) {
                continue;
            }
            let ds2 = ds.norm_squared();
            let ahead = s.h - o.p.v.dot(&s.n);
            let behind = o.h - s.p.v.dot(&o.n);
            let repeated = ds2 <= noise * noise;
            self.flat |= repeated;
            let limit = if self.flat { ALIKE * FLAT } else { ALIKE };
            let sum = limit * (ahead + behind);
            let gap = ((ahead - behind).abs() - noise).max(0.0);
            let steep = STEEP * self.size;
            let alike =
                gap * gap * ds2.max(steep * steep * dn2) <= sum * sum * (steep * steep * dn2);
            if repeated || alike && sum > noise {
                if nearest.is_none_or(|(_, _, _, d)| dn2 < d) {
                    nearest = Some((o, dn, ds, dn2));
                }
            } else if self.known {
                let rd = self.r.times(&dn);
                let bend = rd.dot(&dn);
                let room = 2.0 * ahead.min(behind).max(0.0);
                if bend > room {
                    self.r.add((room - bend) / (bend * bend), &rd);
                }
            }
        }
        let Some((_, dn, ds, dn2)) = nearest else {
            return;
        };
        if self.line == Vec3::zeros() {
            self.line = dn / dn2.sqrt();
        } else if self.line.cross(&dn).norm_squared() > 0.04 * dn2 {
            self.spread = true;
        }
        let ds2 = ds.norm_squared();
        if ds2 <= noise * noise {
            if self.known {
                let rd = self.r.times(&dn);
                let bend = rd.dot(&dn);
                if bend > 1e-6 * self.size * dn2 {
                    self.r.add(-1.0 / bend, &rd);
                }
            }
            return;
        }
        let slope = ds.dot(&dn) / dn2;
        if !self.known {
            self.known = true;
            let square = slope * slope * dn2 > 0.9 * ds2;
            self.r = Symmetric::scaled_identity(if square { slope } else { ds2 / (slope * dn2) });
        }
        let w = ds - self.r.times(&dn);
        self.error = (w.norm_squared() / ds2).sqrt();
        // Exactly parallel: a ball.
        if (ds - dn * slope).norm_squared() <= 1e-12 * ds2 {
            self.spread = true;
            if self.error > 1e-6 {
                self.r = Symmetric::scaled_identity(slope);
                self.error = 1e-6;
            }
            return;
        }
        let w2 = w.norm_squared();
        let along = w.dot(&dn);
        if along * along > 0.0025 * w2 * dn2 && w2 > 1e-18 * self.size * self.size * dn2 {
            self.r.add(1.0 / along, &w);
        }
    }
}

/// α + β·x.
#[derive(Clone, Copy, Default)]
struct Cut {
    a: Real,
    bx: Real,
    by: Real,
}

impl Cut {
    #[inline]
    fn at(&self, x: Real, y: Real) -> Real {
        self.a + self.bx * x + self.by * y
    }
}

/// The chart around the best direction and the cuts in it.
struct Model {
    b: Vec3,
    e1: Vec3,
    e2: Vec3,
    rho: Real,
    axx: Real,
    axy: Real,
    ayy: Real,
    kxx: Real,
    kxy: Real,
    kyy: Real,
    cuts: [Cut; CUTS],
    /// How far R lifts each cut at x = 0, metres.
    lift: [Real; CUTS],
    len: usize,
    best: usize,
}

/// A point of the chart that minimises the model.
#[derive(Clone, Copy)]
struct Step {
    x: Real,
    y: Real,
    value: Real,
    set: [usize; 3],
    count: usize,
    inside: bool,
}

impl Model {
    #[inline]
    fn new(samples: &[Sample], best: usize, curvature: &Curvature) -> Self {
        let s = &samples[best];
        let b = s.n;
        // Orthonormal basis without a branch (Duff et al., JCGT 6(1), 2017).
        let sign = (1.0 as Real).copysign(b.z);
        let c = -1.0 / (sign + b.z);
        let d = b.x * b.y * c;
        let e1 = Vec3::new(1.0 + sign * b.x * b.x * c, sign * d, -sign * b.x);
        let e2 = Vec3::new(d, sign + b.y * b.y * c, -b.y);
        let (mut rho, mut axx, mut axy, mut ayy) = (0.0, 0.0, 0.0, 0.0);
        if curvature.known {
            let r1 = curvature.r.times(&e1);
            let r2 = curvature.r.times(&e2);
            let (rxx, rxy, ryy) = (r1.dot(&e1), r1.dot(&e2), r2.dot(&e2));
            rho = 0.5 * (rxx + ryy);
            axx = rxx - rho;
            axy = rxy;
            ayy = -axx;
            // R is positive semidefinite: a negative eigenvalue becomes zero.
            let m = (axx * axx + axy * axy).sqrt();
            if m > rho {
                let top = (rho + m).max(0.0);
                let f = if m > 0.0 { 0.5 * top / m } else { 0.0 };
                rho = 0.5 * top;
                axx *= f;
                axy *= f;
                ayy *= f;
            }
        } else if samples.len() == 1 {
            // Nothing but the size to go by.
            rho = curvature.size;
        }
        let mut model = Self {
            b,
            e1,
            e2,
            rho,
            axx,
            axy,
            ayy,
            kxx: axx - (s.h - rho),
            kxy: axy,
            kyy: ayy - (s.h - rho),
            cuts: [Cut::default(); CUTS],
            lift: [0.0; CUTS],
            len: samples.len(),
            best,
        };
        for (i, o) in samples.iter().enumerate() {
            let v = &o.p.v;
            let a = v.dot(&b);
            let mut cut = Cut {
                a: a - rho,
                bx: v.dot(&e1),
                by: v.dot(&e2),
            };
            if i != best && rho > 0.0 {
                let z = o.n.dot(&b);
                let (tx, ty) = (o.n.dot(&e1), o.n.dot(&e2));
                let zi = 1.0 / z.max(0.3);
                let (x, y) = (tx * zi, ty * zi);
                let (ax, ay) = (axx * x + axy * y, axy * x + ayy * y);
                let lift = rho * (1.0 - z) + 0.5 * (ax * x + ay * y);
                let behind = s.h - a;
                let ahead = o.h - s.p.v.dot(&o.n);
                // A smooth pair is one piece, which b itself represents; a lift above
                // h(b) is refuted. Both stay as exact cuts.
                let smooth = (ahead - behind).abs() <= ALIKE * (ahead + behind);
                if !smooth && lift <= behind {
                    cut.a += lift;
                    cut.bx -= rho * tx + ax;
                    cut.by -= rho * ty + ay;
                    model.lift[i] = lift;
                }
            }
            model.cuts[i] = cut;
        }
        model
    }

    #[inline]
    fn quadratic(&self, x: Real, y: Real) -> Real {
        0.5 * (self.kxx * x * x + self.kyy * y * y) + self.kxy * x * y
    }

    /// Minimum of one cut within the reach.
    #[inline]
    fn single(&self, i: usize, reach: Real) -> Step {
        let c = &self.cuts[i];
        let det = self.kxx * self.kyy - self.kxy * self.kxy;
        let (mut x, mut y) = (-c.bx, -c.by);
        let mut inside = false;
        if self.kxx + self.kyy > 0.0 && det > 0.0 {
            let d = 1.0 / det;
            (x, y) = (
                (self.kyy * x - self.kxy * y) * d,
                (self.kxx * y - self.kxy * x) * d,
            );
            inside = x * x + y * y <= reach * reach;
        }
        if !inside {
            let g = (x * x + y * y).sqrt();
            // No gradient: one way is as good as another.
            (x, y) = if g > 0.0 {
                (x * (reach / g), y * (reach / g))
            } else {
                (reach, 0.0)
            };
        }
        Step {
            x,
            y,
            value: 0.0,
            set: [i, i, i],
            count: 1,
            inside,
        }
    }

    /// Minimum on the line where two cuts meet, if that crosses the reach.
    #[inline]
    fn pair(&self, i: usize, j: usize, reach: Real) -> Option<Step> {
        let (c, o) = (&self.cuts[i], &self.cuts[j]);
        let (dx, dy, da) = (c.bx - o.bx, c.by - o.by, c.a - o.a);
        let q = dx * dx + dy * dy;
        let f = -da / q;
        let (x0, y0) = (f * dx, f * dy);
        let room = reach * reach + f * da;
        // Also refuses q = 0.
        if !(room > 0.0) {
            return None;
        }
        let (tx, ty) = (-dy, dx);
        let (kx, ky) = (self.kxx * tx + self.kxy * ty, self.kxy * tx + self.kyy * ty);
        let slope = c.bx * tx + c.by * ty + x0 * kx + y0 * ky;
        let bend = kx * tx + ky * ty;
        let mut t = -slope / bend;
        let inside = bend > 0.0 && t * t * q <= room;
        if !inside {
            t = (room / q).sqrt().copysign(-slope);
        }
        Some(Step {
            x: x0 + t * tx,
            y: y0 + t * ty,
            value: 0.0,
            set: [i, j, j],
            count: 2,
            inside,
        })
    }

    /// The point where three cuts meet, if within the reach.
    #[inline]
    fn triple(&self, i: usize, j: usize, l: usize, reach: Real) -> Option<Step> {
        let (c, o, p) = (&self.cuts[i], &self.cuts[j], &self.cuts[l]);
        let (dx, dy, da) = (c.bx - o.bx, c.by - o.by, c.a - o.a);
        let (ex, ey, ea) = (c.bx - p.bx, c.by - p.by, c.a - p.a);
        let w = 1.0 / (dx * ey - dy * ex);
        let (x, y) = ((ea * dy - da * ey) * w, (ex * da - dx * ea) * w);
        // Also refuses NaN and infinity.
        if !(x * x + y * y <= reach * reach) {
            return None;
        }
        Some(Step {
            x,
            y,
            value: 0.0,
            set: [i, j, l],
            count: 3,
            inside: true,
        })
    }

    /// Least model value within the reach.
    fn minimise(&self, reach: Real, noise: Real) -> Step {
        let mut step = self.single(self.best, reach);
        for _ in 0..2 * CUTS {
            let base = self.cuts[step.set[0]].at(step.x, step.y);
            let mut worst = self.len;
            let mut top = base + noise;
            for (i, c) in self.cuts.iter().enumerate().take(self.len) {
                let v = c.at(step.x, step.y);
                if v > top {
                    top = v;
                    worst = i;
                }
            }
            if worst == self.len {
                break;
            }
            let old = step;
            let mut set = [worst; 4];
            set[1..=old.count].copy_from_slice(&old.set[..old.count]);
            let set = &set[..old.count + 1];
            let value = |s: &Step| {
                let mut m = Real::NEG_INFINITY;
                for &k in set {
                    m = m.max(self.cuts[k].at(s.x, s.y));
                }
                m + self.quadratic(s.x, s.y)
            };
            let mut best = self.single(worst, reach);
            let mut least = value(&best);
            let mut consider = |s: Option<Step>| {
                if let Some(s) = s {
                    let v = value(&s);
                    if v < least {
                        least = v;
                        best = s;
                    }
                }
            };
            for k in 1..set.len() {
                consider(self.pair(worst, set[k], reach));
                for l in 1..k {
                    consider(self.triple(worst, set[k], set[l], reach));
                }
            }
            step = best;
        }
        // The model's own value of the depth there, exact for P and for balls.
        let (x, y) = (step.x, step.y);
        let mut m = Real::NEG_INFINITY;
        for c in &self.cuts[..self.len] {
            m = m.max(c.at(x, y));
        }
        let bent = 0.5 * (self.axx * x * x + self.ayy * y * y) + self.axy * x * y;
        step.value = (m + bent) / (1.0 + x * x + y * y).sqrt() + self.rho;
        step
    }

    #[inline]
    fn direction(&self, x: Real, y: Real) -> Vec3 {
        self.b + self.e1 * x + self.e2 * y
    }

    /// Weights of the active cuts whose gradients balance at `step`.
    fn weights(&self, step: &Step) -> [Real; 3] {
        let target = |c: &Cut| {
            (
                c.bx + self.kxx * step.x + self.kxy * step.y,
                c.by + self.kxy * step.x + self.kyy * step.y,
            )
        };
        let [g, h, k] = step.set.map(|i| target(&self.cuts[i]));
        let cross = |a: (Real, Real), b: (Real, Real)| a.0 * b.1 - a.1 * b.0;
        match step.count {
            3 => {
                let w = [cross(h, k), cross(k, g), cross(g, h)];
                let sum = w[0] + w[1] + w[2];
                let w = w.map(|w| (w / sum).clamp(0.0, 1.0));
                let sum = w[0] + w[1] + w[2];
                if sum > 0.0 {
                    w.map(|w| w / sum)
                } else {
                    [1.0, 0.0, 0.0]
                }
            }
            2 => {
                let d = (h.0 - g.0, h.1 - g.1);
                let q = d.0 * d.0 + d.1 * d.1;
                let t = -(g.0 * d.0 + g.1 * d.1) / q;
                // NaN too
                let t = if t > 0.0 { t.min(1.0) } else { 0.0 };
                [1.0 - t, t, 0.0]
            }
            _ => [1.0, 0.0, 0.0],
        }
    }
}

/// The support points that the search kept, for a proof of the overlap.
#[derive(Clone, Copy, Default)]
pub struct Seen {
    points: [SupportPoint; CUTS],
    len: usize,
}

impl Seen {
    /// The points, all of D.
    pub fn points(&self) -> &[SupportPoint] {
        self.points.get(..self.len).unwrap_or(&[])
    }
}

/// What the search works on.
struct Search {
    samples: [Sample; CUTS],
    len: usize,
    best: usize,
    curvature: Curvature,
}

impl Search {
    fn slice(&self) -> &[Sample] {
        &self.samples[..self.len]
    }

    /// Drops sample `i`; the last one takes its place.
    fn drop(&mut self, i: usize) {
        let last = self.len - 1;
        self.samples[i] = self.samples[last];
        if self.best == last {
            self.best = i;
        }
        self.len = last;
    }
}

/// A local minimum of the depth near the remembered direction, else near the unit
/// vector `start`.
///
/// `centre`: any inner point of D, its scale is what curvature is first guessed from.
/// `seen`: filled with points of D for the caller's proof of the overlap, which a
/// local minimum alone is not.
///
/// # Errors
/// [`Fault::NonFinite`] from a support mapping.
pub fn penetration<A: SupportMap, B: SupportMap>(
    md: &MinkowskiDifference<A, B>,
    centre: Option<&Vec3>,
    start: &Vec3,
    memory: &mut Memory,
    settings: &Settings,
    seen: &mut Seen,
) -> Result<Answer, Fault> {
    let remembered = unit(&memory.dir);
    let mut n = remembered.unwrap_or(*start);
    // Directions to ask before the first model, last one first.
    let mut queue = [n; 3];
    let mut queued = 0;
    let mut search = Search {
        samples: [Sample::default(); CUTS],
        len: 0,
        best: 0,
        curvature: Curvature {
            r: Symmetric::default(),
            known: false,
            error: 1.0,
            line: Vec3::zeros(),
            spread: false,
            flat: false,
            size: 0.0,
        },
    };
    if remembered.is_some() {
        // Farther aside than the pair moved; NaN becomes the least angle.
        let drift = 3.0 * memory.drift;
        let angle = if drift > 0.003 {
            drift.min(0.03)
        } else {
            0.003
        };
        for side in memory.sides.iter().take(memory.count as usize) {
            if let Some(side) = unit(&(side - n * n.dot(side))).and_then(|s| unit(&(n + s * angle)))
            {
                queue[queued] = side;
                queued += 1;
            }
        }
        if queued > 0 {
            queued -= 1;
            n = queue[queued];
        }
        let [xx, xy, xz, yy, yz, zz] = memory.curvature;
        if memory.curved == 1 && (xx + xy + xz + yy + yz + zz).is_finite() {
            search.curvature.r = Symmetric {
                xx,
                xy,
                xz,
                yy,
                yz,
                zz,
            };
            search.curvature.known = true;
        }
    }
    let cap = settings.max_iterations;
    let mut reach = REACH;
    let mut predicted = Real::NAN;
    let mut on_border = false;
    let mut from = n;
    let mut probing = CUTS;
    let mut tolerance = settings.tolerance;
    let mut iterations = 0;
    let mut noise: Real = 0.0;
    loop {
        let p = md.support(&n)?;
        let h = n.dot(&p.v);
        if h < 0.0 {
            return Ok(Answer::Miss(n));
        }
        iterations += 1;
        let sample = Sample { n, p, h };
        let magnitude = p.magnitude();
        noise = noise.max(32.0 * EPSILON * magnitude);
        tolerance = tolerance.max(16.0 * EPSILON * magnitude);
        if search.len == 0 {
            let inner = centre.copied().unwrap_or_default();
            search.curvature.size = (p.v - inner).norm();
        }
        search
            .curvature
            .learn(&sample, &search.samples[..search.len], noise);
        if iterations == TRUST_CURVATURE {
            search.curvature.known = false;
            search.curvature.size = 0.0;
        }
        let new = search.len;
        search.samples[new] = sample;
        search.len = new + 1;
        let before = search.samples[search.best].h;
        if new == 0 || h < before {
            search.best = new;
        }
        // The reach.
        if predicted.is_finite() {
            let foretold = before - predicted;
            let came = before - h;
            if came > 0.25 * foretold {
                if on_border {
                    reach = (reach * GROW).min(1.0);
                }
            } else if !(came > 0.0) && (n - from).norm_squared() > 0.25 * reach * reach {
                reach *= SHRINK;
            }
        }
        // One sample per piece.
        if probing < new && probing != search.best {
            search.drop(probing);
        } else {
            let b = search.samples[search.best].n;
            let away = (n - b).norm_squared();
            for i in (0..new).rev() {
                let o = &search.samples[i];
                let dn = n - o.n;
                let ds = p.v - o.p.v;
                let rd = if search.curvature.known {
                    search.curvature.r.times(&dn)
                } else {
                    Vec3::zeros()
                };
                let small = SAME_PIECE * SAME_PIECE * rd.norm_squared().min(ds.norm_squared());
                if i != search.best
                    && (ds - rd).norm_squared() <= small + noise * noise
                    && (o.n - b).norm_squared() >= away
                {
                    search.drop(i);
                }
            }
        }
        probing = CUTS;
        if queued > 0 && iterations < cap {
            queued -= 1;
            n = queue[queued];
            continue;
        }
        let alone = search.len == 1 && !search.curvature.known;
        let model = Model::new(search.slice(), search.best, &search.curvature);
        let mut step = model.minimise(reach, noise);
        if alone {
            // Far enough to see curvature.
            let length = (step.x * step.x + step.y * step.y).sqrt();
            if !(length >= ASIDE) {
                let g = ASIDE / length;
                (step.x, step.y) = if g.is_finite() {
                    (step.x * g, step.y * g)
                } else {
                    (ASIDE, 0.0)
                };
            }
        }
        let gain = model_gain(&search, &step);
        let exact = model.rho == 0.0;
        let mut far = search.best;
        for &i in &step.set[..step.count] {
            if model.lift[i] > model.lift[far] {
                far = i;
            }
        }
        let doubt = if exact || step.count == 1 {
            0.0
        } else {
            model.lift[far] * search.curvature.error
        };
        // Flat as far as the eye reaches: minima that form a curve or a surface.
        let level = reach >= REACH && search.curvature.spread;
        let close = !alone && gain <= tolerance && (step.inside || level);
        let blind = close && !exact && step.count < 3 && !search.curvature.spread;
        let done = close && !blind && doubt <= tolerance;
        let broken = !(step.x + step.y + gain).is_finite();
        if done || broken || iterations >= cap {
            let answer = finish(&search, &model, &step, iterations);
            remember(memory, &search, &model, &step);
            seen.len = search.len;
            for (to, from) in seen.points.iter_mut().zip(search.slice()) {
                *to = from.p;
            }
            return Ok(if done {
                Answer::Hit(answer)
            } else {
                Answer::Limit(answer)
            });
        }
        predicted = step.value;
        on_border = !step.inside;
        from = model.b;
        let mut d = model.direction(step.x, step.y);
        let mut far_kept = CUTS;
        if step.inside && !alone && doubt > tolerance && 2.0 * doubt >= gain {
            // Ask nearer to the minimum on the side of the cut in doubt.
            predicted = Real::NAN;
            let share = (0.5 * tolerance.max(0.1 * gain) / doubt).sqrt().min(0.5);
            d += (search.samples[far].n - d) * share;
            far_kept = far;
        } else if blind {
            predicted = Real::NAN;
            search.curvature.spread = true;
            if let Some(a) = unit(&search.curvature.line.cross(&model.b)) {
                let g = search.samples[search.best].p.v.dot(&a);
                d += a * (0.03 as Real).copysign(-g);
            }
        }
        n = d / d.norm();
        if search.len == CUTS {
            let mut least = Real::INFINITY;
            let mut victim = (search.best + 1) % CUTS;
            for i in 0..CUTS {
                // The newest sample may be the answer to a doubt.
                if i == search.best
                    || i == new.min(search.len - 1)
                    || step.set[..step.count].contains(&i)
                {
                    continue;
                }
                let v = model.cuts[i].at(step.x, step.y);
                if v < least {
                    least = v;
                    victim = i;
                }
            }
            if far_kept == CUTS - 1 {
                far_kept = victim;
            }
            search.drop(victim);
        }
        probing = far_kept;
    }
}

#[inline]
fn model_gain(search: &Search, step: &Step) -> Real {
    search.samples[search.best].h - step.value
}

/// The answer: the best support plane, with witness points in the middle of the
/// active cuts.
fn finish(search: &Search, model: &Model, step: &Step, iterations: u64) -> Penetration {
    let best = &search.samples[search.best];
    let weights = model.weights(step);
    let mut point1 = Vec3::zeros();
    let mut point2 = Vec3::zeros();
    for (&i, w) in step.set[..step.count].iter().zip(weights) {
        let s = &search.samples[i];
        point1 += s.p.v1 * w;
        point2 += s.p.v2 * w;
    }
    let b = &model.b;
    point1 += b * (best.p.v1.dot(b) - point1.dot(b));
    point2 += b * (best.p.v2.dot(b) - point2.dot(b));
    Penetration {
        depth: best.h,
        depth_lower: 0.0,
        dir: best.n,
        normal: best.n,
        point1,
        point2,
        iterations,
    }
}

/// Leaves behind what finds the same active cuts again.
fn remember(memory: &mut Memory, search: &Search, model: &Model, step: &Step) {
    let drift = match unit(&memory.dir) {
        Some(old) if memory.count > 0 || memory.curved == 1 => (model.b - old).norm(),
        _ => 0.0,
    };
    let [g, h, k] = step.set.map(|i| (model.cuts[i].bx, model.cuts[i].by));
    let side = |x: Real, y: Real| model.e1 * x + model.e2 * y;
    // Away from the line on which the other two cuts are equal.
    let apart = |a: (Real, Real), b: (Real, Real), c: (Real, Real)| {
        let (x, y) = (c.1 - b.1, b.0 - c.0);
        let s = ((a.0 - b.0) * x + (a.1 - b.1) * y).signum();
        side(x * s, y * s)
    };
    let (sides, count) = match step.count {
        3 => ([apart(g, h, k), apart(h, k, g), apart(k, g, h)], 3),
        2 => {
            let d = side(g.0 - h.0, g.1 - h.1);
            ([d, -d, Vec3::zeros()], 2)
        }
        _ => ([Vec3::zeros(); 3], 0),
    };
    let r = &search.curvature.r;
    *memory = Memory {
        dir: model.b,
        sides,
        curvature: [r.xx, r.xy, r.xz, r.yy, r.yz, r.zz],
        drift,
        count,
        curved: u32::from(search.curvature.known),
    };
}
