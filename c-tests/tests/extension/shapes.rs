// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

//! `<ccd/shapes.h>` from C and C++, on this library and on libccd, and `ccd::shapes`.

use crate::harness::{self, Link, Precision, Program};
use ccd::Shape;
use ccd::shapes::{Kind, Posed};

const NO_ARGS: [&str; 0] = [];

fn program() -> Program {
    Program::new("tests/extension/shapes.c").strict()
}

run_programs! {
    shapes_are_exact: program().flag("-DOURS_ALONE"), NO_ARGS;
    shapes_are_exact_in_cpp: program().flag("-DOURS_ALONE").in_cpp(), NO_ARGS;
}

/// Compiles `shapes.h` with Debian's headers of libccd and runs it on Debian's libccd.
#[test]
fn shapes_work_with_libccd() {
    if Precision::CURRENT == Precision::Double {
        let include = harness::root().join("include");
        let program = program().system_headers().flag("-idirafter").flag(include).link(Link::System);
        program.build().run(NO_ARGS);
    }
}

/// Words of a line of the C program.
struct Words<'a>(std::str::SplitWhitespace<'a>);

impl Words<'_> {
    fn decimal(&mut self) -> usize {
        self.0.next().and_then(|word| word.parse().ok()).expect("a number")
    }

    fn bits(&mut self) -> u64 {
        u64::from_str_radix(self.0.next().expect("a word"), 16).expect("bits")
    }

    fn reals<const N: usize>(&mut self) -> [ccd::Real; N] {
        std::array::from_fn(|_| ccd::Real::from_bits(self.bits() as _))
    }
}

/// Compares support points and centers of every shape with those of C, bit for bit.
#[test]
fn shapes_have_the_bits_of_c() {
    let text = program().flag("-DOURS_ALONE").build().run(["print", "60"]).stdout;
    let mut lines = text.lines().peekable();
    let (mut shapes, mut queries) = (0, 0);
    while let Some(head) = lines.next() {
        let mut words = Words(head.split_whitespace());
        assert_eq!(words.0.next(), Some("shape"));
        let [kind, points, edges] = std::array::from_fn(|_| words.decimal());
        let size: [ccd::Real; 3] = words.reals();
        let points: Vec<[ccd::Real; 3]> = (0..points).map(|_| words.reals()).collect();
        let first: Vec<usize> =
            (0..if edges > 0 { points.len() + 1 } else { 0 }).map(|_| words.bits() as usize).collect();
        let neighbors: Vec<usize> = (0..edges).map(|_| words.bits() as usize).collect();
        let shape = match kind {
            0 => Posed::sphere(size[0]),
            1 => Posed::capsule(size[0], size[1]),
            2 => Posed::cuboid(size),
            3 => Posed::cylinder(size[0], size[1]),
            4 => Posed::cone(size[0], size[1]),
            5 => Posed::ellipsoid(size),
            _ if edges > 0 => Posed::hull_with_neighbors(&points, &first, &neighbors),
            _ => Posed::hull(&points),
        };
        assert_eq!(matches!(shape.kind, Kind::Hull(_)), kind == 6);
        while let Some(line) = lines.next_if(|line| !line.starts_with("shape")) {
            let mut words = Words(line.split_whitespace());
            let placed = shape.at(words.reals()).turned(words.reals());
            let (dir, point, center) = (words.reals(), words.reals(), words.reals());
            let bits = |v: [ccd::Real; 3]| v.map(ccd::Real::to_bits);
            assert_eq!(bits(placed.support(dir)), bits(point), "{placed:?} along {dir:?}");
            assert_eq!(placed.center().map(bits), Some(bits(center)), "{placed:?}");
            queries += 1;
        }
        shapes += 1;
    }
    assert_eq!((shapes, queries), (28, 28 * 60));
}
