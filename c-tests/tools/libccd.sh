# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause
#
# Functions of the scripts that compare this library with the system's libccd.

# loaded_libccd: reads what ldd prints, and prints the libccd.so.2 in it
loaded_libccd() {
    sed -n 's|.*libccd\.so\.2 => \(/.*\) (0x.*|\1|p' | head -n 1
}

# system_libccd: prints the libccd.so.2 that the dynamic linker finds for a program that loads it later
system_libccd() {
    LD_PRELOAD=libccd.so.2 LD_TRACE_LOADED_OBJECTS=1 "$(command -v cat)" 2>/dev/null | loaded_libccd
}

# other_libccd FILE: prints FILE, or if that is this library, as after an installation to /usr/local, or empty, the first
# libccd.so.2 in the dynamic linker's cache that is not; nothing if there is none
other_libccd() {
    {
        echo "$1"
        PATH=$PATH:/usr/sbin:/sbin ldconfig -p 2>/dev/null | sed -n 's|.*libccd\.so\.2 .*=> \(/.*\)|\1|p'
    } | {
        found=
        # To the end: sed would report a closed pipe.
        while read -r file; do
            if [ -z "$found" ] && [ -r "$file" ] && ! grep -q ccdImplementation "$file"; then
                echo "$file"
                found=1
            fi
        done
    }
}
