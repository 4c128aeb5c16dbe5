// What the test programs share.
#ifndef TAUT_TESTS_REQUIRE_H
#define TAUT_TESTS_REQUIRE_H

#include <stdio.h>

// Ends the function with 1, and a line that says what was required.
#define REQUIRE(condition)                                 \
    do {                                                   \
        if (!(condition)) {                                \
            printf("line %d: %s\n", __LINE__, #condition); \
            return 1;                                      \
        }                                                  \
    } while (0)

#endif
