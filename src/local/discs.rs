// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! Discs that are part of the objects, found from their own points and taken off.
//!
//! What a disc is, and how two of its points tell it, stands in `known/round.rs` ([`Disc::of`]). Its
//! support function is r |n⊥|, n⊥ = n − (n·a) a, whose second derivative is (r / |n⊥|) t t' with
//! t = a × n⊥ / |n⊥|.
//!
//! *What is believed*: any two points of a smooth object could be a disc's. A third one confirms
//! it. Before that a pair of the one object that moved is enough to look by; where both moved,
//! the next sample tells.
//!
//! *Remembered*: the radius stays, the axis turns with its object, and one pair finds it again.
//! [`Disc::of`] confirms itself where it has the radius remembered. Where the pair is too narrow for
//! that, the radius helps ([`Disc::turned`]); that is believed as above.
//!
//! *Where it is*: a vertex carries the disc if it is above or below the one that did where the
//! disc was found. Any other, a cone's tip, has a cut of its own without it, and bends nothing.

use super::curvature::BALL;
use super::lanes::{Lanes, Vectors};
use super::samples::Sample;
use crate::known::round::{ALIKE, Disc, Seen, TOLD, fits};
use crate::math::{Real, Vec3, larger, perpendicular, unit};

/// Relative difference of the two excesses of one object's points up to which they are taken for
/// those of another smooth surface, before a disc is confirmed; a kink's are what they like.
/// Measured: ×2 nothing, ÷3 ellipsoids beside a ball two support points more.
const OWN: Real = 0.1;

/// How far the objects' points moved between two samples, as points of D.
#[inline(always)]
pub fn moves(old: &Sample, new: &Sample) -> [Vec3; 2] {
    [new.p.v1 - old.p.v1, old.p.v2 - new.p.v2]
}

/// Did a vertex move by `d` because its ball or disc of this radius moved so? That must be more
/// than a vertex without it would need to pass for one with it: the difference of two points,
/// each off by as much twice, where it was taken and where it is compared.
#[inline(always)]
pub fn shows(radius: Real, moved: &Vec3, d: &Vec3, same: Real) -> bool {
    let least = larger(TOLD * TOLD * radius * radius, 16.0 * same * same);
    moved.norm_squared() > least && (d - moved).norm_squared() <= same * same
}

/// What a smooth pair shows.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Shown {
    /// A disc of each object that moved.
    Discs,
    /// Discs of both objects, maybe.
    Maybe,
    Nothing,
}

/// The same, and the direction it was asked along.
#[inline(always)]
fn seen(sample: &Sample, o: usize) -> Seen {
    Seen {
        n: sample.n,
        p: vertex(sample, o),
    }
}

/// One object's disc in a sample.
#[derive(Clone, Copy, Debug, Default)]
struct Rim {
    /// r m(n), metres; zero where the vertex carries none.
    point: Vec3,
    /// r |n⊥|, metres.
    height: Real,
    /// 1 where the vertex carries it, else 0.
    carries: Real,
}

/// A disc and the pair of samples that it was found by.
#[derive(Clone, Copy, Debug, Default)]
struct Found {
    disc: Disc,
    /// The directions of the pair.
    pair: [Vec3; 2],
    /// The vertex that carries it there.
    carrier: Vec3,
}

impl Found {
    /// Does this vertex of a sample along `n` carry it, too? Of another smooth surface it would be
    /// off by a third order of the angles between the three samples.
    fn is_shown_by(&self, n: &Vec3, vertex: &Vec3) -> bool {
        let [a, b] = self.pair;
        let order = (n - a).norm() * (n - b).norm() * (a - b).norm();
        // Above or below is as good: a cylinder's other end.
        let apart = vertex - self.disc.point(n) - self.carrier;
        let apart = self.disc.across(&apart).norm();
        order > 0.0 && apart <= ALIKE * self.disc.radius * order
    }
}

/// Object `o`'s point of a sample, as one of D.
#[inline(always)]
fn vertex(sample: &Sample, o: usize) -> Vec3 {
    if o == 0 { sample.p.v1 } else { -sample.p.v2 }
}

/// One object's disc, and what is known of it.
#[derive(Clone, Copy, Debug, Default)]
struct Own {
    at: Found,
    /// Was it shown by more than the pair that it was found by?
    confirmed: bool,
    /// How many had been asked when it was found; 0 for a remembered one.
    found: usize,
    /// In the samples kept.
    point: Vectors,
    height: Lanes,
    carries: Lanes,
    /// In the sample looked at last.
    latest: Rim,
}

impl Own {
    /// Is it no more than a pair's?
    #[inline(always)]
    fn is_doubted(&self) -> bool {
        self.at.disc.is_there() && self.found > 0 && !self.confirmed
    }
}

/// The discs of both objects, and their points in the samples kept.
#[derive(Clone, Copy, Debug, Default)]
pub struct Discs {
    of: [Own; 2],
    /// What may be discs.
    suspects: [Found; 2],
    /// How much less each bends, for the weight of the active cuts that do not.
    less: [Real; 2],
}

impl Discs {
    /// These are remembered. `None` where there is none.
    pub fn recall(discs: &[Disc; 2]) -> Option<Self> {
        let mut this = Self::default();
        for (own, disc) in this.of.iter_mut().zip(discs) {
            own.at.disc = *disc;
        }
        this.is_there().then_some(this)
    }

    /// Is there one?
    pub fn is_there(&self) -> bool {
        self.of.iter().any(|own| own.at.disc.is_there())
    }

    /// Is there one of object `o`?
    #[inline]
    pub fn has(&self, o: usize) -> bool {
        self.of.get(o).is_some_and(|own| own.at.disc.is_there())
    }

    /// The discs.
    #[inline]
    pub fn discs(&self) -> [Disc; 2] {
        self.of.map(|own| own.at.disc)
    }

    /// One larger than an object of this squared extent was another's.
    pub fn forget_unless_fits(&mut self, extent2: Real) {
        for own in &mut self.of {
            if !fits(own.at.disc.radius, extent2) {
                own.at.disc = Disc::default();
            }
        }
    }

    /// Is unit `n` along the axis of a disc, within rounding? There m is none.
    #[inline]
    pub fn along_axis(&self, n: &Vec3) -> bool {
        self.of.iter().any(|own| own.at.disc.is_along(n))
    }

    /// Of which object is unit `n` along the axis of the disc?
    #[inline]
    pub fn along(&self, n: &Vec3) -> [bool; 2] {
        self.of
            .map(|own| own.at.disc.is_there() && own.at.disc.is_along(n))
    }

    /// The farthest points along unit `n`; along an axis, where all of a disc is, the one that is
    /// nearest to a `vertex`'s opposite.
    #[inline(never)]
    pub fn points(&self, n: &Vec3, vertex: &Vec3) -> [Vec3; 2] {
        let mut points = [Vec3::zeros(); 2];
        for (point, own) in points.iter_mut().zip(&self.of) {
            if own.at.disc.is_along(n) {
                let aside = own.at.disc.across(vertex);
                if aside.norm_squared() <= own.at.disc.radius * own.at.disc.radius {
                    *point = -aside;
                }
            } else if own.at.disc.is_there() {
                *point = own.at.disc.point(n);
            }
        }
        points
    }

    /// Three points of the disc whose axis is along unit `n`, around a vertex that is aside of
    /// the origin by less than its radius: their triangle has the origin inside. Across `n`.
    #[inline(never)]
    pub fn rim_below(&self, vertex: &Vec3, n: &Vec3) -> [Vec3; 3] {
        let along = self.of.iter().find(|own| own.at.disc.is_along(n));
        let radius = along.map_or(0.0, |own| own.at.disc.radius);
        let middle = vertex - n * n.dot(vertex);
        // One opposite to the vertex, the others a third of a turn away.
        let to = unit(&-middle).unwrap_or_else(|| perpendicular(n)) * radius;
        let (half, side) = (to * -0.5, n.cross(&to) * (3.0 as Real).sqrt() * 0.5);
        [middle + to, middle + half + side, middle + half - side]
    }

    /// The points of the discs in a sample, now the latest: their sum. `same`: how far apart
    /// points may be that are one.
    #[inline(never)]
    pub fn look_at(&mut self, sample: &Sample, same: Real) -> Vec3 {
        let mut sum = Vec3::zeros();
        for (o, own) in self.of.iter_mut().enumerate() {
            let vertex = vertex(sample, o);
            let disc = &own.at.disc;
            own.latest = Rim::default();
            if !disc.is_there() {
                continue;
            }
            let across = disc.across(&sample.n);
            let length = across.norm();
            let point = across * (disc.radius / length);
            own.latest.height = disc.radius * length;
            let aside = disc.across(&(vertex - point - own.at.carrier));
            if own.found == 0 || aside.norm_squared() <= same * same {
                own.latest.point = point;
                own.latest.carries = 1.0;
                sum += point;
            }
        }
        sum
    }

    /// Is a sample beside the axis along `n` where its disc says? `same`: as in [`Self::look_at`].
    #[cold]
    pub fn is_on_rim(&self, n: &Vec3, sample: &Sample, same: Real) -> bool {
        self.of.iter().enumerate().all(|(o, own)| {
            let disc = &own.at.disc;
            let carrier = vertex(sample, o) - disc.point(&sample.n) - own.at.carrier;
            !disc.is_along(n) || disc.across(&carrier).norm() <= same
        })
    }

    /// Keeps the latest sample's in lane `i`.
    #[inline]
    pub fn put(&mut self, i: usize) {
        for own in &mut self.of {
            own.point.set(i, &own.latest.point);
            own.height[i] = own.latest.height;
            own.carries[i] = own.latest.carries;
        }
    }

    /// Lane `i` is that of sample `from`.
    #[inline]
    pub fn repeat(&mut self, i: usize, from: usize) {
        for own in &mut self.of {
            let point = own.point.get(from);
            own.point.set(i, &point);
            own.height[i] = own.height[from];
            own.carries[i] = own.carries[from];
        }
    }

    /// Does the latest sample show another smooth surface where a disc is not confirmed yet?
    #[inline(never)]
    pub fn refuted_by(&self, new: &Sample, kept: &[Sample]) -> bool {
        let smooth = |o: usize, old: &Sample| {
            let d = moves(old, new)[o % 2];
            let (ahead, behind) = (d.dot(&new.n), -d.dot(&old.n));
            (ahead - behind).abs() <= OWN * (ahead + behind)
        };
        (0..2).any(|o| {
            self.of[o].is_doubted()
                && self.of[o].latest.carries == 0.0
                && kept.iter().any(|old| smooth(o, old))
        })
    }

    /// Turns remembered discs to where two samples show them. Returns whether one was.
    #[inline(never)]
    pub fn turn(&mut self, old: &Sample, new: &Sample, same: Real, asked: usize) -> bool {
        let mut turned = false;
        for (o, (own, d)) in self.of.iter_mut().zip(moves(old, new)).enumerate() {
            let disc = own.at.disc;
            if !disc.is_there() || own.found > 0 || own.confirmed {
                continue;
            }
            let (from, to) = (seen(old, o), seen(new, o));
            let moved = disc.point(&new.n) - disc.point(&old.n);
            if (d - moved).norm_squared() <= same * same {
                continue;
            }
            let anew = Disc::of(&from, &to)
                .filter(|anew| (anew.radius - disc.radius).abs() <= BALL * disc.radius);
            if let Some(disc) = anew.or_else(|| disc.turned(&from, &to, same)) {
                own.confirmed = anew.is_some();
                let carrier = vertex(new, o) - disc.point(&new.n);
                let pair = [old.n, new.n];
                own.at = Found {
                    disc,
                    pair,
                    carrier,
                };
                own.found = asked;
                turned = true;
            }
        }
        turned
    }

    /// Is one of them no more than a pair's?
    pub fn is_doubted(&self) -> bool {
        self.of.iter().any(Own::is_doubted)
    }

    /// Does the latest sample carry the same discs as sample `i`?
    #[inline]
    pub fn alike(&self, i: usize) -> bool {
        self.of
            .iter()
            .all(|own| own.carries[i] == own.latest.carries)
    }

    /// What the discs add to the support values of the kept vertices along unit `n`, metres.
    #[inline(never)]
    pub fn heights(&self, n: &Vec3) -> Lanes {
        let mut heights = Lanes::default();
        for own in &self.of {
            if own.at.disc.is_there() {
                heights =
                    heights + own.carries * (own.at.disc.radius * own.at.disc.across(n).norm());
            }
        }
        heights
    }

    /// What they add to the support values in the kept samples, less what they would add there
    /// to the latest one's vertex, metres.
    #[inline]
    pub fn heights_less_latest(&self) -> Lanes {
        let less = |own: &Own| own.height * (own.carries - Lanes::all(own.latest.carries));
        less(&self.of[0]) + less(&self.of[1])
    }

    /// How much higher the cuts of the kept samples are along unit `n` for what they bend, metres.
    #[inline]
    pub fn lifts(&self, n: &Vec3) -> Lanes {
        self.heights(n) - self.of[0].point.dot(n) - self.of[1].point.dot(n)
    }

    /// Adds these points of the discs, along a vector, where the vertices carry them.
    #[inline]
    pub fn add_along(&self, lanes: &mut Lanes, points: &[Vec3; 2], along: &Vec3) {
        for (own, point) in self.of.iter().zip(points) {
            *lanes = *lanes + own.carries * point.dot(along);
        }
    }

    /// That of these two points of the discs that sample `i` carries of object `o`; the one that
    /// it was taken at where it was not `seen` to carry it.
    #[inline]
    pub fn carried(&self, i: usize, o: usize, points: &[Vec3; 2], seen: &[u32; 2]) -> Vec3 {
        if seen[o] & 1 << i != 0 {
            points[o] * self.of[o].carries[i]
        } else {
            self.kept(i, o)
        }
    }

    /// The unit direction along the axis of a disc, where its support value is least, if that is
    /// within this angle of unit `b`.
    pub fn axis_near(&self, b: &Vec3, angle: Real) -> Option<Vec3> {
        self.of.iter().find_map(|own| {
            let axis = &own.at.disc.axis;
            let cos = axis.dot(b);
            let near = own.at.disc.across(b).norm_squared() <= cos * cos * angle * angle;
            (own.at.disc.is_there() && near).then(|| axis * (1.0 as Real).copysign(cos))
        })
    }

    /// Is the disc with the axis `n` so large that it alone balances this vertex, of sample `i`?
    /// `None`: that carries it not.
    pub fn balances(&self, n: &Vec3, i: usize, vertex: &Vec3) -> Option<bool> {
        let own = self.of.iter().find(|own| own.at.disc.is_along(n))?;
        let alone = self.of.iter().filter(|own| own.at.disc.is_there()).count() == 1;
        let carries = own.carries[i] > 0.0;
        carries.then(|| alone && own.at.disc.across(vertex).norm() <= own.at.disc.radius)
    }

    /// The point of object `o`'s disc in sample `i`.
    #[inline]
    pub fn kept(&self, i: usize, o: usize) -> Vec3 {
        self.of[o].point.get(i)
    }

    /// Notes the samples that show a vertex again from another direction than the latest, `new`,
    /// as bits, and the `span` of the directions, squared. Returns whose vertex does, a bit for each
    /// object, and how wide apart at most. Nothing was seen before a disc is confirmed: by a sample
    /// that is not of the pair that it was found by.
    #[inline(never)]
    pub fn see(
        &mut self,
        new: &Sample,
        kept: &[Sample],
        seen: &mut [u32; 2],
        span: &mut Lanes,
        same: Real,
        asked: usize,
    ) -> (u32, Real) {
        let (mut whose, mut widest) = (0, 0.0);
        for (o, own) in self.of.iter_mut().enumerate() {
            if !(own.latest.carries > 0.0) {
                continue;
            }
            let mut shown: u32 = 0;
            for (i, old) in kept.iter().enumerate() {
                let moved = own.latest.point - own.point.get(i);
                let d = &moves(old, new)[o % 2];
                if own.carries[i] > 0.0 && shows(own.at.disc.radius, &moved, d, same) {
                    shown |= 1 << i;
                    // A remembered one, whose axis has not turned.
                    let least = ALIKE * (new.n - old.n).norm() * moved.norm();
                    own.confirmed |= own.found == 0 && (d - moved).norm() <= least;
                }
            }
            let mut seen_by_pair = 0;
            if own.is_doubted() && own.found != asked && own.at.is_shown_by(&new.n, &vertex(new, o))
            {
                own.confirmed = true;
                // The pair's vertex was seen twice.
                for (i, old) in kept.iter().enumerate() {
                    let apart = vertex(old, o) - own.point.get(i) - own.at.carrier;
                    if own.carries[i] > 0.0 && apart.norm_squared() <= same * same {
                        seen_by_pair |= 1 << i;
                    }
                }
            }
            if own.confirmed {
                seen[o % 2] |= shown | seen_by_pair;
                whose |= u32::from(shown != 0) << o;
                let [a, b] = own.at.pair;
                let pair = (a - b).norm_squared();
                for (i, old) in kept.iter().enumerate() {
                    let turned = (new.n - old.n).norm_squared();
                    if shown >> i & 1 != 0 {
                        span[i] = larger(turned, span[i]);
                        widest = larger(turned, widest);
                    }
                    if seen_by_pair >> i & 1 != 0 {
                        span[i] = larger(pair, span[i]);
                    }
                }
            }
        }
        (whose, widest)
    }

    /// The samples whose vertices carry a disc and were not seen, of those not `seen`, as bits.
    #[inline]
    pub fn unseen(&self, seen: &[u32; 2]) -> u32 {
        let of = |own: &Own, seen: u32| own.carries.mask(|c| c > 0.0) & !seen;
        of(&self.of[0], seen[0]) | of(&self.of[1], seen[1])
    }

    /// Weighs active cuts, for what they bend. Returns whether that is another than thought.
    pub fn weigh(&mut self, set: &[usize; 3], weights: &[Real; 3]) -> bool {
        let mut differs = false;
        for (own, less) in self.of.iter().zip(&mut self.less) {
            let plain = set
                .iter()
                .zip(weights)
                .map(|(&i, w)| (1.0 - own.carries[i]) * w);
            let now: Real = plain.sum();
            differs |= own.at.disc.is_there() && (now - *less).abs() > ALIKE;
            *less = now;
        }
        differs
    }

    /// Of each disc the direction t in which it bends at unit `b`, across it, and how much,
    /// metres.
    #[inline]
    pub fn bends(&self, b: &Vec3) -> [(Vec3, Real); 2] {
        [0, 1].map(|o| {
            let disc = &self.of[o].at.disc;
            if !disc.is_there() {
                return (Vec3::zeros(), 0.0);
            }
            let across = disc.across(b);
            let length = across.norm();
            let t = disc.axis.cross(&across) * (1.0 / length);
            (t, disc.radius / length * (1.0 - self.less[o]))
        })
    }

    /// Looks for discs: of each object whose points of a smooth pair moved by more than its ball,
    /// of these radii, or its disc did. `kept`: the samples, of which `old` is one.
    #[inline(never)]
    pub fn look(
        &mut self,
        [old, new]: [&Sample; 2],
        kept: &[Sample],
        balls: &[Real; 2],
        same: Real,
        extent2: Real,
        asked: usize,
    ) -> Shown {
        let d = moves(old, new);
        let dn = new.n - old.n;
        let moved = [0, 1].map(|o| {
            let mut own = dn * balls[o];
            if self.of[o].at.disc.is_there() {
                let disc = &self.of[o].at.disc;
                own += disc.point(&new.n) - disc.point(&old.n);
            }
            (d[o] - own).norm_squared() > same * same
        });
        // More aside than along: curvature of rank one?
        let aside = |d: &Vec3| {
            let along = d.dot(&dn);
            2.0 * along * along < d.norm_squared() * dn.norm_squared()
        };
        let both = moved == [true; 2];
        if moved == [false; 2] || both && kept.len() < 2 && !d.iter().any(aside) {
            return Shown::Nothing;
        }
        let mut found = [Found::default(); 2];
        let mut confirmed = [false; 2];
        for o in (0..2).filter(|&o| moved[o]) {
            let before = &self.of[o];
            // One that is known, or was taken for one, does not fit.
            if balls[o] > 0.0 || before.found > 0 {
                return Shown::Nothing;
            }
            let disc = Disc::of(&seen(old, o), &seen(new, o));
            let Some(disc) = disc.filter(|d| fits(d.radius, extent2)) else {
                return Shown::Nothing;
            };
            found[o] = Found {
                disc,
                pair: [old.n, new.n],
                carrier: vertex(new, o) - disc.point(&new.n),
            };
            let third = |third: &Sample| found[o].is_shown_by(&third.n, &vertex(third, o));
            confirmed[o] = kept.iter().any(third);
        }
        if both && confirmed == [false; 2] {
            self.suspects = found;
            return Shown::Maybe;
        }
        for o in (0..2).filter(|&o| moved[o]) {
            self.take_off(o, found[o], confirmed[o], asked);
        }
        Shown::Discs
    }

    /// Does a new sample show both suspected discs, too? Then they are discs.
    #[inline(never)]
    pub fn settle(&mut self, new: &Sample, asked: usize) -> bool {
        let suspects = self.suspects;
        let shown = |o: usize| suspects[o].is_shown_by(&new.n, &vertex(new, o));
        let both = shown(0) && shown(1);
        for o in (0..2).filter(|_| both) {
            self.take_off(o, suspects[o], true, asked);
        }
        both
    }

    fn take_off(&mut self, o: usize, at: Found, confirmed: bool, asked: usize) {
        let own = &mut self.of[o];
        (own.at, own.confirmed, own.found) = (at, confirmed, asked);
    }
}

// In single precision the search begins with curvature, and no disc is looked for.
#[cfg(all(test, not(feature = "single")))]
mod tests {
    use super::*;
    use crate::known::support::SupportPoint;
    use crate::math::EPSILON;
    use crate::shapes::Random;

    const SAME: Real = if EPSILON > 1e-10 { 1e-4 } else { 1e-9 };

    /// A sample of a shape and of a point at the origin.
    fn ask(shape: impl Fn(&Vec3) -> Vec3, d: Vec3) -> Sample {
        let n = d.normalize();
        let v1 = shape(&n);
        let p = SupportPoint {
            v: v1,
            v1,
            v2: Vec3::zeros(),
        };
        Sample::new(&n, p)
    }

    /// Of radius 0.5, about the z axis, from −0.4 to 0.4.
    fn cylinder(d: &Vec3) -> Vec3 {
        let f = 0.5 / d.x.hypot(d.y);
        Vec3::new(d.x * f, d.y * f, (0.4 as Real).copysign(d.z))
    }

    /// The same rim, and a tip at z = 0.9.
    fn cone(d: &Vec3) -> Vec3 {
        let tip = Vec3::z() * 0.9;
        let base = cylinder(&Vec3::new(d.x, d.y, -1.0));
        if tip.dot(d) > base.dot(d) { tip } else { base }
    }

    fn look(discs: &mut Discs, kept: &[Sample], new: &Sample, asked: usize) -> Shown {
        discs.look([&kept[0], new], kept, &[0.0; 2], SAME, 4.0, asked)
    }

    #[test]
    fn a_third_point_confirms_what_two_could_be_by_chance() {
        let dirs = [(1.0, 0.0, 0.6), (1.0, 0.2, 0.5), (1.0, 0.1, 0.7)];
        let [a, b, c] = dirs.map(|(x, y, z)| ask(cylinder, Vec3::new(x, y, z)));
        let mut discs = Discs::default();
        assert!(look(&mut discs, &[a], &b, 2) == Shown::Discs);
        let [found, none] = discs.discs();
        assert!((found.radius - 0.5).abs() < SAME && !none.is_there());
        assert!(found.axis.cross(&Vec3::z()).norm() < SAME);
        let mut span = Lanes::default();
        let mut seen = [0; 2];
        // The pair itself.
        discs.look_at(&a, SAME);
        discs.put(0);
        discs.look_at(&b, SAME);
        assert_eq!(discs.see(&b, &[a], &mut seen, &mut span, SAME, 2).0, 0);
        assert_eq!((seen, discs.is_doubted()), ([0; 2], true));
        discs.put(1);
        let left = c.p.v - discs.look_at(&c, SAME);
        assert!((left - Vec3::z() * 0.4).norm() < SAME);
        assert_eq!(discs.see(&c, &[a, b], &mut seen, &mut span, SAME, 3).0, 1);
        assert_eq!((seen, discs.is_doubted()), ([3, 0], false));
    }

    /// Of an ellipsoid any two points could be a disc's; a third one shows that they are not.
    #[test]
    fn an_ellipsoid_refutes_what_two_of_its_points_show() {
        let r = Vec3::new(0.5, 0.35, 0.25);
        let ellipsoid = |d: &Vec3| {
            let w = r.component_mul(&r.component_mul(d));
            w / w.dot(d).sqrt()
        };
        let mut random = Random::new(2);
        for _ in 0..200 {
            let n = random.direction();
            let near = |random: &mut Random| n + random.vector(0.05);
            let (a, b) = (ask(ellipsoid, n), ask(ellipsoid, near(&mut random)));
            let mut discs = Discs::default();
            if look(&mut discs, &[a], &b, 2) != Shown::Discs {
                continue;
            }
            let c = ask(ellipsoid, near(&mut random));
            discs.look_at(&c, SAME);
            assert!(discs.refuted_by(&c, &[a, b]));
        }
    }

    #[test]
    fn a_tip_carries_no_disc() {
        let dirs = [(1.0, 0.0, -0.6), (1.0, 0.2, -0.5), (1.0, 0.1, 0.45)];
        let [a, b, tip] = dirs.map(|(x, y, z)| ask(cone, Vec3::new(x, y, z)));
        let mut discs = Discs::default();
        assert!(look(&mut discs, &[a], &b, 2) == Shown::Discs);
        assert_eq!(discs.look_at(&tip, SAME), Vec3::zeros());
        assert!(!discs.refuted_by(&tip, &[a, b]));
        discs.put(1);
        assert!(discs.look_at(&a, SAME).norm() > 0.4 && !discs.alike(1));
        discs.put(0);
        // The support value of the disc, where there is one.
        let heights = discs.heights(&Vec3::x());
        assert!((heights[0] - 0.5).abs() < SAME && heights[1] == 0.0);
        assert_eq!(discs.unseen(&[0; 2]) & 3, 1);
        // A tip that is active bends nothing.
        let bend = |discs: &Discs| discs.bends(&Vec3::x())[0].1;
        assert!((bend(&discs) - 0.5).abs() < SAME);
        assert!(discs.weigh(&[0, 1, 0], &[0.25, 0.75, 0.0]));
        assert!((bend(&discs) - 0.125).abs() < SAME);
    }

    #[test]
    fn a_remembered_disc_turns_with_its_object() {
        let mut random = Random::new(4);
        let (mut turned, mut at_once, mut confirmed) = (0, 0, 0);
        for round in 0..400 {
            let (aside, same) = [(0.01, SAME), (0.0005, 1e-3 * SAME)][round % 2];
            let n = Vec3::new(1.0, 0.0, random.within(0.1, 2.0)).normalize();
            let near = |random: &mut Random| ask(cylinder, n + random.vector(aside));
            let (a, b, c) = (ask(cylinder, n), near(&mut random), near(&mut random));
            let axis = (Vec3::z() + random.vector(0.02)).normalize();
            let disc = |radius| [Disc { radius, axis }, Disc::default()];
            let mut other = Discs::recall(&disc(0.45)).unwrap();
            assert!(!other.turn(&a, &b, same, 2));
            let mut discs = Discs::recall(&disc(0.5)).unwrap();
            // A pair nearly along the rim tells little of the axis.
            if !discs.turn(&a, &b, same, 2) {
                continue;
            }
            turned += 1;
            let [found, none] = discs.discs();
            assert!((found.radius - 0.5).abs() < 1e-6 && !none.is_there());
            assert!(found.axis.cross(&Vec3::z()).norm() < 1e-4, "{found:?}");
            at_once += usize::from(!discs.is_doubted());
            let mut span = Lanes::default();
            let mut seen = [0; 2];
            for (i, sample) in [a, b].iter().enumerate() {
                discs.look_at(sample, same);
                discs.put(i);
            }
            discs.look_at(&c, same);
            discs.see(&c, &[a, b], &mut seen, &mut span, same, 3);
            assert!(discs.is_doubted() == (seen[0] == 0));
            confirmed += usize::from(!discs.is_doubted());
        }
        // The narrow pairs tell it less well: some thirds do not confirm.
        let all = [turned, at_once, confirmed];
        assert!(turned > 350 && confirmed > 320 && at_once < 320, "{all:?}");
        assert!(Discs::recall(&[Disc::default(); 2]).is_none());
    }

    /// Where both objects move, a pair shows no more than a suspicion.
    #[test]
    fn two_discs_are_suspected_until_another_sample_shows_both() {
        let both = |x, y, z| {
            let mut sample = ask(cylinder, Vec3::new(x, y, z));
            let n = sample.n;
            sample.p.v2 = cylinder(&Vec3::new(-n.y, -n.z, -n.x));
            sample.p.v2 = Vec3::new(sample.p.v2.z, sample.p.v2.x, sample.p.v2.y);
            sample
        };
        let [a, b, c] = [
            both(1.0, 0.3, 0.6),
            both(1.0, 0.35, 0.75),
            both(1.0, 0.45, 0.7),
        ];
        let mut discs = Discs::default();
        assert!(look(&mut discs, &[a], &b, 2) == Shown::Maybe && !discs.is_there());
        assert!(discs.settle(&c, 3));
        let axes = discs.discs().map(|disc| disc.axis);
        assert!(axes[0].cross(&Vec3::z()).norm() < SAME);
        assert!(axes[1].cross(&Vec3::x()).norm() < SAME);
        // Of three samples at once.
        assert!(look(&mut Discs::default(), &[a, c], &b, 3) == Shown::Discs);
    }

    #[test]
    fn the_rim_around_the_origin() {
        let mut discs = Discs::recall(&[
            Disc {
                radius: 0.5,
                axis: Vec3::z(),
            },
            Disc::default(),
        ])
        .unwrap();
        let vertex = Vec3::new(0.3, -0.2, 0.7);
        assert!(discs.along_axis(&Vec3::z()));
        let [p, _] = discs.points(&Vec3::z(), &vertex);
        assert!((p - Vec3::new(-0.3, 0.2, 0.0)).norm() < 8.0 * EPSILON);
        let rim = discs.rim_below(&vertex, &Vec3::z());
        for (i, p) in rim.iter().enumerate() {
            let next = rim[(i + 1) % 3];
            assert!(p.cross(&next).z > 0.0 && p.z == 0.0);
            let aside = p - Vec3::new(0.3, -0.2, 0.0);
            assert!((aside.norm() - 0.5).abs() < 8.0 * EPSILON);
        }
        discs.forget_unless_fits(0.2);
        assert!(!discs.is_there());
    }
}
