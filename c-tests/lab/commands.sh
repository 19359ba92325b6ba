#!/bin/sh
# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause
#
# Runs the commands of the pages, which stand here word for word, in a clone of the commit at a path with a blank, on a
# machine with libfcl-dev, and so with libccd-dev.
#   commands.sh           what a reader builds, links and runs (10 minutes)
#   commands.sh figures   what measures the pages' figures (an hour)
#   commands.sh check     runs nothing; fails where a page has a command that is not here, or the other way round

set -eu
cd "$(dirname "$0")/../.."
wanted=${1:-build}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
group=build # of the steps that follow

# elsewhere WHERE: the commands on stdin are run there
elsewhere() {
    cat >>"$work/here"
}

# run TITLE EXPECTED EDIT [TOOL...]: runs the commands on stdin after an edit by sed, for what their placeholders stand for.
# The output must contain the text. A tool, program or directory, that is missing skips the step.
run() {
    title=$1 expected=$2 edit=$3
    shift 3
    commands=$(cat)
    printf '%s\n' "$commands" >>"$work/here"
    [ "$wanted" = "$group" ] || return 0
    for tool; do
        command -v "$tool" >/dev/null || [ -d "$tool" ] || { echo "== $title: skipped: $tool"; return 0; }
    done
    commands=$(printf '%s\n' "$commands" | sed "$edit")
    printf '== %s\n%s\n' "$title" "$commands"
    printf 'set -e\n%s\n' "$commands" | sh >"$work/output" 2>&1 && grep -q -e "$expected" "$work/output" && return
    cat "$work/output" >&2
    echo "commands.sh: failed, or no '$expected': $title" >&2
    exit 1
}

# page_commands: prints each command of the pages: lines of blocks for sh, code within lines that begins with a program,
# the commands in the comments of the examples
page_commands() {
    git ls-files -z '*.md' c-tests/examples include | xargs -0 awk -F '`' '
        FNR == 1 { inside = 0 }
        /^```/ { inside = $0 == "```sh"; next }
        inside { sub(/(^| +)#.*/, ""); print; next }
        /^ \*     (g\+\+|cc) / { sub(/^ \* +/, ""); print; next }
        { for (i = 2; i <= NF; i += 2)
              if ($i ~ /^([a-z-]+\.sh|sh|cargo|cc|cmake|sudo|apt-get|ldd|pkg-config|python|rustup|\$\(pkg-config|(CC|LD_[A-Z_]*|C_TESTS_[A-Z]*)=[^ ]*) /) print $i }' |
        sed 's/\\|/|/g; /^$/d' | sort -u
}

# program LANGUAGE PAGE: prints the first program of a page in a language
program() {
    awk -v start="\`\`\`$1" '$0 == start { inside = 1; next } /^```/ && inside { exit } inside' "$2"
}

if [ "$wanted" != check ]; then
    git clone -q . "$work/a clone"
    cd "$work/a clone"
    program c README.md >program.c
    mkdir target
    cp program.c target
    # This script's own files.
    printf '%s\n' /program.c /program /program.so /app.py /arm64.cmake /arm64/ /kept/ /a.out >>.git/info/exclude
    cc -g program.c -Iinclude -lccd -lm -o program
    cc -shared -fPIC -Dmain=query program.c -Iinclude -lccd -lm -o program.so
    echo 'import ctypes; ctypes.CDLL("./program.so").query()' >app.py
    printf 'set(%s)\n' "CMAKE_SYSTEM_NAME Linux" "CMAKE_SYSTEM_PROCESSOR aarch64" "CMAKE_C_COMPILER aarch64-linux-gnu-gcc" >arm64.cmake
fi
prefix=$work/installed
export PKG_CONFIG_PATH="$prefix/lib/pkgconfig" TURNS=1
installed="s/sudo //g; s/ && ldconfig//; s|/usr/local|$prefix|"

run "a program with this library" "^depth 0.100" "" <<'END'
cargo build --release
cc target/program.c -Iinclude target/release/libccd.a -Wl,--gc-sections -s -lm -o target/program && target/program
END
run "one C program of the tests" " 0 broken guarantees" "" <<'END'
cc -O2 -DOURS_ALONE -Ic-tests -Iinclude -Ic-tests/tests/stability c-tests/tests/stability/judged.c target/release/libccd.a -lm -o target/judged
target/judged hard 3
END
run "the swap" "^depth 0.100" "" <<'END'
mkdir -p target/swap && ln -sf "$PWD/target/release/libccd.so" target/swap/libccd.so.2
LD_LIBRARY_PATH=$PWD/target/swap ./program
END
run "which library a program loads" "libccd.so.2 => /lib" "" <<'END'
ldd ./program | grep libccd
END
run "linked to the shared library" "^depth 0.100" 's/$/ \&\& target\/program/' <<'END'
cc target/program.c -Iinclude target/swap/libccd.so.2 -lm -Wl,-rpath,"$PWD/target/swap" -o target/program
END
run "the example for FCL" "3.0 mm deep" "" <<'END'
g++ -O2 -Iinclude -I/usr/include/eigen3 c-tests/examples/fcl.cpp target/swap/libccd.so.2 -Wl,-rpath,"$PWD/target/swap" -lfcl && ./a.out
END
run "the main job" "^Wrong results of ccdMPRPenetration: 12.. with libccd, 0 with" "" <<'END'
sh c-tests/main.sh
END
run "a program on both libraries" "^this library " 's/PROGRAM/.\/program/; s/DIR/kept/' <<'END'
sh c-tests/compare.sh --runs 5 ./program
sh c-tests/compare.sh ./program
sh c-tests/compare.sh PROGRAM
sh c-tests/compare.sh --keep DIR ./program
sh c-tests/compare.sh --keep DIR PROGRAM
END
run "a program that loads libccd later" "^this library " 's/^/sh c-tests\//; s/python/python3/' <<'END'
compare.sh python app.py
END
run "a wrong answer, repeated" "right$" 's/FILE/--trace kept\/libccd-deep.txt/' <<'END'
sh c-tests/replay.sh FILE
END
run "what is preloaded for FCL" "^depth 0.100" "" <<'END'
cmake -S cmake -B build -DCCD_FCL=ON
cmake --build build
LD_LIBRARY_PATH=$PWD/build/lib LD_PRELOAD=libwarmccd-fcl.so ./program
LD_LIBRARY_PATH=$PWD/build/lib LD_PRELOAD=libwarmccd-middle.so ./program
END
run "preloading in Python" "^depth 0.100" 's/ python / python3 /' <<'END'
LD_LIBRARY_PATH=$PWD/target/release LD_PRELOAD=libccd.so python app.py
LD_LIBRARY_PATH=$PWD/build/lib LD_PRELOAD=libwarmccd-fcl.so:libccd.so.2 python app.py
END
run "the precision of a library" "^double" 's|libccd.so.2|target/swap/&|' <<'END'
objdump -d --disassemble=ccdVec3PointSegmentDist2 libccd.so.2 | grep -qE 'mulss|cvtss2sd|cvtps2pd' && echo single || echo double
END
run "the precision of a program" "= 8" "" gdb <<'END'
gdb -batch -ex 'whatis (ccd_real_t)0' -ex 'print sizeof(ccd_real_t)' program
END
run "an installation with a prefix" "Installing" "$installed" <<'END'
cmake -S cmake -B build -DCMAKE_INSTALL_PREFIX=/usr/local
cmake --build build
sudo cmake --install build && sudo ldconfig
END
run "a program on the installation" "libccd.so.2 => $prefix" 's/.*/cc program.c & \&\& .\/a.out \&\& ldd a.out/' <<'END'
$(pkg-config --cflags --libs ccd) -Wl,-rpath,"$(pkg-config --variable=libdir ccd)"
END
run "flags of a static link" "include" "" <<'END'
pkg-config --static --cflags ccd
END
run "the installation undone" "^0$" "s/sudo //; s|; sudo ldconfig|; find '$prefix' ! -type d \| wc -l|" <<'END'
sudo xargs rm < build/install_manifest.txt; sudo ldconfig
END
run "a cross build" "^depth 0.100" "s|\\.\\.\\.|../arm64.cmake|; s|-B build|-B arm64|; s|\$| \&\& cmake --build arm64 \&\& \
        aarch64-linux-gnu-gcc program.c -Iinclude arm64/lib/libccd.so.2 -Wl,-rpath,\"\$PWD/arm64/lib\" -lm \&\& \
        qemu-aarch64 -L /usr/aarch64-linux-gnu ./a.out|" aarch64-linux-gnu-gcc qemu-aarch64 \
    "$(rustc --print target-libdir --target aarch64-unknown-linux-gnu)" <<'END'
cmake -S cmake -B build -DCMAKE_TOOLCHAIN_FILE=... -DCCD_RUST_TARGET=aarch64-unknown-linux-gnu
END
run "documentation" "Generated" 's/ --open/ --no-deps/' <<'END'
cargo doc --open
END
run "some tests" "ok. [1-9]" 's/NAME/header/; s/MODULE/math/' <<'END'
cargo test --test integration NAME::
cargo test --lib MODULE::
END
run "the tests that pages name" ": test$" 's/ --nocapture//; s/ --$//; / -- /!s/$/ --/; s/$/ --list | grep ": test$"/' <<'END'
cargo test --test integration stability::configurations
cargo test --test integration support_counts::
cargo test --test integration support_counts -- --nocapture
cargo test --test integration swap::
cargo test --test integration record::
cargo test --test integration pos_
cargo test --test integration pos_in_the_middle -- --nocapture
cargo test --test integration known_costs
cargo test --test integration no_panic
cargo test -p lab -- --nocapture libraries_are static_link
cargo test -p lab charts_test::
cargo test -p lab paper_test::
cargo test -p lab compare::
cargo test -p lab fcl::
cargo test -p lab mujoco_cylinders
END
run "tests with another compiler" "ok. [1-9]" 's/$/ cargo test --test integration contract::distances/' clang clang++ <<'END'
CC=clang CXX=clang++
END
run "lints in single precision" "Finished" "" <<'END'
cargo clippy --all-targets --features single -- -D warnings
END

if [ "$wanted" = build ] && [ -n "$(git status --porcelain)" ]; then
    git status --porcelain >&2
    echo "commands.sh: a command leaves files that git does not track" >&2
    exit 1
fi

group=figures
run "simulations and FCL" "ms a step" "" <<'END'
cargo run --release -p lab --bin engines
cargo run --release -p lab --bin engines -- steps
cargo run --release -p lab --bin engines -- screens
cargo run --release -p lab --bin engines -- fcl
cargo run --release -p lab --bin engines -- distance
END
run "charts and recorded costs" "" "" <<'END'
cargo bench -p lab -- charts
cargo bench -p lab -- local
cargo bench -p lab -- ratios
cargo bench -p lab -- paper
cargo bench -p lab -- redraw
cargo bench -p lab -- engines
cargo bench -p lab -- record
END
run "configurations where libccd is wrong" "libccd" 's/NAME/determinism/' <<'END'
cargo run --release -p lab --bin campaigns -- ledger
cargo run --release -p lab --bin campaigns -- NAME
END

elsewhere "steps of release.sh by these names; packaging; itself" <<'END'
cargo run --release -p lab --bin engines -- long
cargo run --release -p lab --bin campaigns -- rates
cargo run --release -p lab --bin campaigns -- wide
cargo run --release -p lab --bin campaigns -- positions
cargo vendor
source.sh OUT
sh cmake/packages/source.sh OUT
sh c-tests/lab/release.sh LOGS
sh c-tests/lab/release.sh LOGS packaging packaging-single
sh c-tests/lab/fcl_tests.sh
sh c-tests/lab/libccd_tests.sh
sh c-tests/lab/ode_demos.sh
sh c-tests/lab/reasons.sh
sh c-tests/setup.sh lab
release.sh LOGS STEP...
tests.sh SUITE
tests.sh bookworm
tests.sh trixie
newcomer.sh SUITE [tests]
cross.sh arm64|i386
cross.sh arm64
cross.sh i386
cargo cinstall
sudo cargo cinstall --release --locked --prefix=/usr/local && sudo ldconfig
cargo check
END
elsewhere "simulations: the wheel" <<'END'
python c-tests/lab/engines/wheel.py
END
elsewhere "by hand: needs a nightly Rust, which nothing else does" <<'END'
sh c-tests/tools/check.sh miri
END
elsewhere "a release" <<'END'
sh cmake/packages/release.sh OUT
release.sh OUT
deb.sh ARCHIVE OUT
try.sh SUITE ARCHIVE OUT
try.sh bookworm
try.sh trixie
apt-get install ./libwarmccd2_*.deb
apt-get install libccd2
END
elsewhere "linux-inside.sh, in the archive" <<'END'
linux.sh OUT
sh cmake/packages/linux.sh OUT
prebuilt.sh SUITE OUT
prebuilt.sh bookworm
prebuilt.sh trixie
try-linux.sh SUITE ARCHIVE
try-linux.sh bookworm
try-linux.sh trixie
./run-on-warmccd.sh PROGRAM
LD_LIBRARY_PATH=$PWD/lib PROGRAM
LD_LIBRARY_PATH=$PWD/lib LD_PRELOAD=libwarmccd-fcl.so PROGRAM
LD_LIBRARY_PATH=$PWD/lib LD_PRELOAD=libwarmccd-middle.so PROGRAM
cc example.c -Iinclude lib/libccd.a -Wl,--gc-sections -lm -o example && ./example
cc example.c -Iinclude lib/libccd.so.2 -lm -Wl,-rpath,"$PWD/lib" -o example && ./example
cc example.c $(PKG_CONFIG_PATH=$PWD/lib/pkgconfig pkg-config --cflags --libs ccd) -Wl,-rpath,"$PWD/lib" -o example && ./example
cmake -S . -B build -DCMAKE_PREFIX_PATH=/path/to/this/folder
END
elsewhere "try-wheel.sh, without a compiler and in a build" <<'END'
sh cmake/packages/wheel.sh OUT
wheel.sh OUT [ARCHIVE]
try-wheel.sh SUITE WHEEL
try-wheel.sh bookworm
try-wheel.sh trixie
warmccd compare python app.py
warmccd run python app.py
warmccd run --signed-distance python app.py
warmccd run --middle python app.py
include=$(python -c 'import warmccd; print(warmccd.get_include())')
library=$(python -c 'import warmccd; print(warmccd.get_library())')
cc app.c -I"$include" "$library" -lm -Wl,-rpath,"${library%/*}"
END
elsewhere ".ci/run" <<'END'
cargo test
sh c-tests/test.sh
cargo fmt --all --check
cargo clippy --workspace --all-targets -- -D warnings
sh c-tests/tools/check.sh memcheck contract::
sh c-tests/compare.sh [--every N] [--runs N] [--limit S] [--swap] [--keep DIR] PROGRAM [ARGUMENT...]
END

if [ "$wanted" = check ]; then
    page_commands >"$work/pages"
    sort -u "$work/here" | diff -U0 "$work/pages" - | grep '^[-+][^-+]' >&2 || exit 0
    echo "commands.sh: - a command of a page that no step runs; + a command that no page has" >&2
    exit 1
fi
