/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Catches exceptions, and jumps: this object defines longjmp. The buffer of a jump that stays within the work (Lua's, in a
 * callback) lies on the stack below the guard. */

#include "tools/compare/guard.h"

#include <cxxabi.h>
#include <dlfcn.h>
#include <setjmp.h>
#include <stdlib.h>

namespace {

struct frame {
    jmp_buf back;
    volatile guard_t how;
};

thread_local frame *innermost;

[[noreturn]] void jump(const char *name, void *buffer, int value)
{
    const auto next = reinterpret_cast<void (*)(void *, int)>(dlsym(RTLD_NEXT, name));
    if (next)
        next(buffer, value);
    abort(); /* it does not return */
}

[[noreturn]] void leave(guard_t how)
{
    innermost->how = how;
    jump("longjmp", innermost->back, 1);
}

/* Returns whether a frame within the guard filled the buffer. */
bool stays_within(const void *buffer) { return buffer > __builtin_frame_address(0) && buffer < innermost; }

} // namespace

guard_t guard_run(void (*work)(void *), void *argument)
{
    frame *const outer = innermost;
    frame guard;
    guard.how = GUARD_RETURNED;
    if (_setjmp(guard.back) == 0) {
        innermost = &guard;
        try {
            work(argument);
        } catch (abi::__forced_unwind &) { /* pthread_exit and cancellation end the thread */
            innermost = nullptr;
            throw;
        } catch (...) {
            guard.how = GUARD_THREW;
        }
    }
    innermost = outer;
    return guard.how;
}

int guard_active(void) { return innermost != nullptr; }

void guard_end(void) { leave(GUARD_ENDED); }

#define JUMP(name) \
    extern "C" __attribute__((visibility("default"), noreturn)) void compare_##name(void *, int) __asm__(#name); \
    void compare_##name(void *buffer, int value) \
    { \
        if (innermost && !stays_within(buffer)) \
            leave(GUARD_JUMPED); \
        jump(#name, buffer, value); \
    }

JUMP(longjmp)
JUMP(_longjmp)
JUMP(siglongjmp)
JUMP(__longjmp_chk)
