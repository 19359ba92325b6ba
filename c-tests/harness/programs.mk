# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause
#
# Builds this library and the tests' C and C++ programs, for mod.rs, which passes the variables in capitals and holds a lock.
# Targets are relative to the folder of all output, in which it runs: their names have no blanks, while those of sources
# and of the repository may. A file is made under another name and moved, so that processes that use the old one go on.
#
#   library       REPOSITORY; BUILT: cargo's folder, and FROM: where it leaves libccd.so and libccd.a; INTO: double or single;
#                 FLAGS, FEATURES, PLATFORM: of cargo
#   $(PROGRAM)    COMPILE: the command but for libccd and -o; LINK: one of those below; INTO

.DELETE_ON_ERROR:
.PHONY: library cargo

ifndef PROGRAM

library: $(INTO)/libccd.so $(INTO)/librs_ccd.a $(INTO)/native.txt
	@[ -e $(INTO)/libccd.so.2 ] || ln -s libccd.so $(INTO)/libccd.so.2

# Touched only when they change: a newer file would recompile all programs.
cargo:
	@cd $(REPOSITORY) && CARGO_ENCODED_RUSTFLAGS=$(FLAGS) $${CARGO:-cargo} rustc --release --lib --locked \
	    --crate-type staticlib,cdylib $(FEATURES) $(PLATFORM) --target-dir $(BUILT)
	@mkdir -p $(INTO)
$(INTO)/libccd.so $(INTO)/libccd.a: cargo
	@cmp -s $(FROM)/$(@F) $@ || { cp $(FROM)/$(@F) $@.new && mv $@.new $@; }

# With rs_ before each of libccd's names, so that one process can link this library and the system's.
$(INTO)/librs_ccd.a: $(INTO)/libccd.a
	@$${NM:-nm} -g --defined-only $< | sed -n 's/.* [A-Z] \(\(__\)\{0,1\}ccd.*\)/\1 rs_\1/p' | sort -u >$(INTO)/renamed.txt
	@test -s $(INTO)/renamed.txt
	@$${OBJCOPY:-objcopy} --redefine-syms=$(INTO)/renamed.txt $< $@.new && mv $@.new $@

# The linker's flags for a static library of Rust's.
$(INTO)/native.txt: $(INTO)/libccd.a
	@$${RUSTC:-rustc} $(PLATFORM) --crate-type staticlib --print native-static-libs -o $(INTO)/empty.a - </dev/null 2>&1 | \
	    sed -n 's/.*native-static-libs: //p' >$@
	@test -s $@

else

ARCHIVE_Static = $(INTO)/libccd.a
ARCHIVE_Renamed = $(INTO)/librs_ccd.a
LIBCCD_Shared = -L$(INTO) -lccd
LIBCCD_Static = $(ARCHIVE_Static) $$(cat $(INTO)/native.txt)
LIBCCD_Renamed = $(ARCHIVE_Renamed) -lccd $$(cat $(INTO)/native.txt)
LIBCCD_System = -lccd

# The compiler writes which files a program depends on.
-include $(PROGRAM).d
$(PROGRAM): $(ARCHIVE_$(LINK))
	@$(COMPILE) $(LIBCCD_$(LINK)) -lm -MD -MP -MF $@.d -MT $@ -o $@.new && mv $@.new $@

endif
