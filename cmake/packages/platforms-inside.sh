#!/bin/sh
# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause
#
# What platforms.sh does in its chroot: the repository is /tree.

set -eu
target=x86_64-pc-windows-gnu
cc=x86_64-w64-mingw32-gcc
export WINEDEBUG=-all WINEPREFIX=/wine XDG_RUNTIME_DIR=/tmp

# make_std TARGET: Rust's standard library. Nothing else here needs RUSTC_BOOTSTRAP.
make_std() {
    std=$(rustc --print sysroot)/lib/rustlib/$1/lib
    [ ! -e "$std/made" ] || return 0
    mkdir -p "$std" /std/src
    printf '[package]\nname = "std-alone"\nversion = "0.0.0"\nedition = "2021"\n' >/std/Cargo.toml
    : >/std/src/lib.rs
    (cd /std && RUSTC_BOOTSTRAP=1 cargo build --release -Zbuild-std=std,panic_unwind --target "$1")
    cp "/std/target/$1/release/deps/"*.rlib "$std"
    rm "$std/libstd_alone"*
    case $1 in
    *-windows-gnu)
        for object in rsbegin rsend; do
            RUSTC_BOOTSTRAP=1 rustc --target "$1" --emit=obj -o "$std/$object.o" \
                "/usr/lib/rustlib/src/rust/library/rtstartup/$object.rs"
        done
        ;;
    esac
    touch "$std/made"
}

# install TARGET SYSTEM COMPILER STRIP: the library, by CMake, in /prefix/TARGET, and a project that finds it there,
# in /consumer/TARGET
install() {
    echo "== $1: the library, by CMake"
    cat >"/$1.cmake" <<END
set(CMAKE_SYSTEM_NAME $2)
set(CMAKE_SYSTEM_PROCESSOR ${1%%-*})
set(CMAKE_C_COMPILER $3)
set(CMAKE_STRIP $4)
END
    rm -rf "/build/$1" "/prefix/$1" "/consumer/$1"
    cmake -S /tree/cmake -B "/build/$1" -DCMAKE_INSTALL_PREFIX="/prefix/$1" -DCMAKE_TOOLCHAIN_FILE="/$1.cmake" \
        -DCCD_RUST_TARGET="$1" -DCCD_CARGO_TARGET_DIR=/cargo
    cmake --build "/build/$1"
    cmake --install "/build/$1"
    echo "== $1: a project that finds the package"
    cmake -S /tree/c-tests/tests/packaging/consumer -B "/consumer/$1" -DWAY=find_package -DCMAKE_PREFIX_PATH="/prefix/$1" \
        -DCMAKE_TOOLCHAIN_FILE="/$1.cmake"
    cmake --build "/consumer/$1"
}
failed=0

make_std $target
install $target Windows $cc x86_64-w64-mingw32-strip
prefix=/prefix/$target
cp $prefix/bin/ccd.dll /consumer/$target
for program in plain namespaced static; do
    wine /consumer/$target/$program.exe
done

# What the tests take from POSIX to go on after a crash or an endless loop: here these end the program.
cat >/posix.h <<'END'
#include <setjmp.h>
#include <signal.h>
#define sigjmp_buf jmp_buf
#define sigsetjmp(buffer, mask) setjmp(buffer)
#define siglongjmp longjmp
#define SIGALRM 14
#define SIGBUS 10
struct sigaction { void (*sa_handler)(int); int sa_flags, sa_mask; };
static inline int sigaction(int n, const struct sigaction *a, void *old) { return (void)n, (void)a, (void)old, 0; }
#define sigemptyset(mask) (*(mask) = 0)
#define SA_NODEFER 0
#define alarm(seconds) ((void)(seconds))
END

run=/run-windows
rm -rf $run
mkdir $run
cp $prefix/bin/ccd.dll $run
cargo build --release --lib --locked --manifest-path /tree/Cargo.toml --target-dir /cargo
cp /cargo/release/libccd.so $run/libccd.so.2
cp /tree/c-tests/tools/record/contacts.bin $run
cd $run
system=$(sed -n 's/^Libs.private: //p' $prefix/lib/pkgconfig/ccd.pc)
threads="-Wl,-Bstatic -lwinpthread -Wl,-Bdynamic"
flags="-std=gnu99 -O2 -ffp-contract=off -DOURS_ALONE -I/tree/c-tests"
ways="shared static"
# What a program wrote, without times, which end a line, one or two, and without how many checks there were: some go
# by addresses.
lines() {
    tr -d '\r' | sed -E 's/( +[0-9]+){1,2}( ns)?$//; s/ [0-9.]+ ns$//; s/^[0-9]+ checks/checks/'
}
# try SOURCE ARGUMENT...: a program of c-tests/ on this machine, on the DLL and on the archive. All are
# run, so that one failure does not hide another.
try() {
    name=$(basename "$1" .c)
    source=/tree/c-tests/$1
    shift
    # shellcheck disable=SC2086  # one word each
    {
        gcc $flags -I/tree/include "$source" ./libccd.so.2 -lm -o "$name"
        $cc $flags -D__USE_MINGW_ANSI_STDIO=1 -include /posix.h -I$prefix/include "$source" \
            -L$prefix/lib -lccd $threads -o "$name-shared.exe"
        $cc $flags -D__USE_MINGW_ANSI_STDIO=1 -include /posix.h -I$prefix/include -DCCD_STATIC_DEFINE "$source" \
            $prefix/lib/libccd.a $system $threads -o "$name-static.exe"
    }
    LD_LIBRARY_PATH=. "./$name" "$@" >here.txt
    for way in $ways; do
        said="exit code 0"
        wine "./$name-$way.exe" "$@" >there.txt 2>&1 || {
            said="exit code $?"
            failed=1
        }
        lines <here.txt >here-lines.txt
        lines <there.txt >there-lines.txt
        differ=$(diff here-lines.txt there-lines.txt | grep -c '^>' || true)
        [ "$differ" -eq 0 ] && [ "$(wc -l <here.txt)" -eq "$(wc -l <there.txt)" ] || failed=1
        echo "$name${*:+ $*}, $way: $said; $differ of $(wc -l <here.txt) lines other than on Linux"
    done
}

echo "== programs under $(wine --version)"
try tests/contract/objects.c
# Its _Float128 is GCC's on the DLL; the archive has Rust's functions of these names, whose calls differ.
ways=shared
try tests/contract/point_distance.c 2000
ways="shared static"
try tests/contract/arguments.c 20
try tests/contract/callbacks.c
try tests/contract/threads.c
try tests/contract/exceptions.c
try examples/pair_table.c
try examples/world.c
try tests/extension/warm_states.c
try tests/extension/pos.c pressure
try tests/stability/judged.c configurations
try tools/record/replay.c contacts.bin

echo "== other targets"
for target in x86_64-pc-windows-msvc aarch64-apple-darwin x86_64-apple-darwin; do
    make_std $target
    for features in "" single; do
        cargo check -q --lib --locked --manifest-path /tree/Cargo.toml --target-dir /cargo --target $target \
            --features "$features" && echo "$target${features:+, $features}: cargo check passes" || failed=1
    done
done

# zig's package brings macOS's headers, and the names of libSystem's symbols, in the place of Apple's SDK.
[ -x /zig/bin/python ] && /zig/bin/python -c "import ziglang" || {
    python3 -m venv /zig && /zig/bin/pip install -q ziglang
} || {
    echo "ziglang cannot be installed here: nothing is linked for macOS" >&2
    exit 1
}
zig=$(dirname "$(find /zig/lib -path '*/ziglang/__init__.py')")/lib/libc
rm -rf /sdk
mkdir -p /sdk/usr/lib /sdk/bin
ln -s "$zig/include/any-darwin-any" /sdk/usr/include
# arm64e's symbols are arm64's; LLVM's linker knows no newer name than these.
sed -E 's/arm64e(\.x1)?-/arm64-/g' "$zig/darwin/libSystem.tbd" >/sdk/usr/lib/libSystem.tbd
for library in c m; do
    ln -s libSystem.tbd /sdk/usr/lib/lib$library.tbd
done
# CMake asks it for macOS's version.
printf '#!/bin/sh\necho 11.0\n' >/sdk/bin/sw_vers
chmod +x /sdk/bin/sw_vers
export SDKROOT=/sdk PATH=/sdk/bin:$PATH
for target in aarch64-apple-darwin x86_64-apple-darwin; do
    cat >/sdk/bin/$target <<END
#!/bin/sh
exec clang --target=$target -mmacosx-version-min=11.0 -fuse-ld=lld -Wno-unused-command-line-argument "\$@"
END
    chmod +x /sdk/bin/$target
    install $target Darwin /sdk/bin/$target /usr/bin/llvm-strip
    library=/prefix/$target/lib/libccd.2.dylib
    # What a program on it asks for at run time.
    llvm-objdump --macho --dylibs-used /consumer/$target/plain | tee /mac.txt
    grep -q '@rpath/libccd.2.dylib (compatibility version 2.0.0, current version 2.0.0)' /mac.txt || failed=1
    # The names that it defines are those that it defines on Linux.
    llvm-nm -gU --format=just-symbols $library | sed 's/^_//' | sort >/mac.txt
    nm -D --defined-only --format=just-symbols /cargo/release/libccd.so | sed 's/@.*//' | sort | diff - /mac.txt || failed=1
done
exit $failed
