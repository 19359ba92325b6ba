/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Catches an exception as C++ does, with C alone: for a frame with a cleanup the compiler names the
 * personality routine __gcc_personality_v0, and this object has its own. It
 * reports to the unwinder's first pass that the frame handles the exception, and jumps out of the
 * second once the frames within have been left, their destructors run.
 *
 * A jump is caught at longjmp, which this object defines. The buffer of a jump that stays within the work
 * (Lua's, in a callback) lies on the stack below the guard. */

#define _GNU_SOURCE
#include "tools/compare/compare.h"

#include <dlfcn.h>
#include <setjmp.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <unwind.h>

#define EXPORT __attribute__((visibility("default")))

struct frame {
    jmp_buf back;
    volatile guard_t how;
};

static __thread struct frame *innermost;

typedef void (*jump_fn)(void *, int);
static jump_fn next_jump(const char *name)
{
    void *symbol = dlsym(RTLD_NEXT, name);
    jump_fn jump;
    if (!symbol)
        abort();
    memcpy(&jump, &symbol, sizeof jump);
    return jump;
}

static void leave(guard_t how) __attribute__((noreturn));
static void leave(guard_t how)
{
    innermost->how = how;
    next_jump("longjmp")(innermost->back, 1);
    abort(); /* it does not return */
}

void guard_end(void) { leave(GUARD_ENDED); }

int guard_active(void) { return innermost != NULL; }

/* --- exceptions ------------------------------------------------------------------- */

/* Ends a C++ exception as a catch clause does, so that std::uncaught_exceptions is right. */
static void swallow(_Unwind_Exception_Class class, struct _Unwind_Exception *exception)
{
    static const char vendor[] = "GNUCC++";
    /* not in the global scope if only a plugin has loaded it */
    void *library = dlopen("libstdc++.so.6", RTLD_NOW | RTLD_NOLOAD), *scope = library ? library : RTLD_DEFAULT;
    void *begin_symbol = dlsym(scope, "__cxa_begin_catch"), *end_symbol = dlsym(scope, "__cxa_end_catch");
    void *(*begin)(void *);
    void (*end)(void);
    uint64_t name = 0;
    for (size_t i = 0; i + 1 < sizeof vendor; i++)
        name = name << 8 | (unsigned char)vendor[i];
    if ((uint64_t)class >> 8 != name || !begin_symbol || !end_symbol) {
        _Unwind_DeleteException(exception);
        return;
    }
    memcpy(&begin, &begin_symbol, sizeof begin);
    memcpy(&end, &end_symbol, sizeof end);
    begin(exception);
    end();
}

/* `shielded` alone has a cleanup here. */
_Unwind_Reason_Code __gcc_personality_v0(int version, _Unwind_Action actions, _Unwind_Exception_Class class,
                                         struct _Unwind_Exception *exception, struct _Unwind_Context *context);
_Unwind_Reason_Code __gcc_personality_v0(int version, _Unwind_Action actions, _Unwind_Exception_Class class,
                                         struct _Unwind_Exception *exception, struct _Unwind_Context *context)
{
    (void)version;
    (void)context;
    /* pthread_exit and cancellation end the thread */
    if (actions & _UA_FORCE_UNWIND) {
        innermost = NULL;
        return _URC_CONTINUE_UNWIND;
    }
    if (actions & _UA_SEARCH_PHASE)
        return _URC_HANDLER_FOUND;
    if (!(actions & _UA_HANDLER_FRAME))
        return _URC_CONTINUE_UNWIND;
    swallow(class, exception);
    leave(GUARD_THREW);
}

__attribute__((noinline)) static void cleanup(struct frame **frame) { __asm__ volatile("" : : "r"(frame) : "memory"); }

__attribute__((noinline)) static void shielded(void (*work)(void *), void *argument)
{
    __attribute__((cleanup(cleanup))) struct frame *frame = innermost;
    work(argument);
}

guard_t guard_run(void (*work)(void *), void *argument)
{
    struct frame *const outer = innermost;
    struct frame frame;
    frame.how = GUARD_RETURNED;
    if (_setjmp(frame.back) == 0) {
        innermost = &frame;
        shielded(work, argument);
    }
    innermost = outer;
    return frame.how;
}

/* --- jumps ------------------------------------------------------------------------ */

/* Returns whether a frame within the guard filled the buffer. */
static int stays_within(const void *buffer)
{
    const char *const here = (const char *)__builtin_frame_address(0);
    return (const char *)buffer > here && (const char *)buffer < (const char *)innermost;
}

#define JUMP(name) \
    EXPORT __attribute__((noreturn)) void compare_##name(void *buffer, int value) __asm__(#name); \
    void compare_##name(void *buffer, int value) \
    { \
        if (innermost && !stays_within(buffer)) \
            leave(GUARD_JUMPED); \
        next_jump(#name)(buffer, value); \
        abort(); /* it does not return */ \
    }

JUMP(longjmp)
JUMP(_longjmp)
JUMP(siglongjmp)
JUMP(__longjmp_chk)
