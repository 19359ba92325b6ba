# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause
#
# Builds this library and the tests' C and C++ programs, for mod.rs, which passes the variables in capitals and holds a lock.
# Targets are relative to the folder of all output, in which it runs: their names have no blanks, while those of sources
# and of the repository may. A file is made under another name and moved, so that processes that use the old one go on.
#
#   library       FROM: where CARGO_BUILD leaves libccd.so and libccd.a; INTO: double or single
#   $(PROGRAM)    COMPILE: the whole command but for -o; ARCHIVE: the one that it links, if any

.DELETE_ON_ERROR:
.PHONY: library cargo

library: $(INTO)/libccd.so $(INTO)/librs_ccd.a
	@[ -e $(INTO)/libccd.so.2 ] || ln -s libccd.so $(INTO)/libccd.so.2

# Touched only when they change: a newer file would recompile all programs.
cargo:
	@$(CARGO_BUILD)
	@mkdir -p $(INTO)
$(INTO)/libccd.so $(INTO)/libccd.a: cargo
	@cmp -s $(FROM)/$(@F) $@ || { cp $(FROM)/$(@F) $@.new && mv $@.new $@; }

# With rs_ before each of libccd's names, so that one process can link this library and the system's.
$(INTO)/librs_ccd.a: $(INTO)/libccd.a
	@$(NM) -g --defined-only $< | sed -n 's/.* [A-Z] \(\(__\)\{0,1\}ccd.*\)/\1 rs_\1/p' | sort -u >$(INTO)/renamed.txt
	@test -s $(INTO)/renamed.txt
	@$(OBJCOPY) --redefine-syms=$(INTO)/renamed.txt $< $@.new && mv $@.new $@

# The compiler writes which files a program depends on.
ifdef PROGRAM
-include $(PROGRAM).d
$(PROGRAM): $(ARCHIVE)
	@$(COMPILE) -MD -MP -MF $@.d -MT $@ -o $@.new && mv $@.new $@
endif
