/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Prints the library that each kind of link gives.
 * -DLINK_BOTH: the system's libccd, by a function it has, and this library under its renamed
 * symbols. */

#include "identity.h"
#include <stdio.h>

#ifdef LINK_BOTH
const char *rs_ccdImplementation(void);
void ccdFirstDirDefault(const void *, const void *, void *);
#else
const char *ccdImplementation(void);
#endif

int main(void)
{
    const char *name = running_ccd();
#ifdef LINK_BOTH
    double dir[3];
    ccdFirstDirDefault(NULL, NULL, dir);
    printf("libccd: %s\n", name == NULL ? "another" : name);
    printf("renamed: %s\n", rs_ccdImplementation());
#else
    printf("libccd: %s\n", ccdImplementation());
#endif
    (void)name;
    return 0;
}
