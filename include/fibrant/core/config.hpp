// SPDX-License-Identifier: MIT
#pragma once
/// @file What every header relies on: the version, and the arithmetic that the results depend on.

#if defined(__FAST_MATH__)
#error \
    "fibrant needs IEEE arithmetic: NaN marks unset parameters, and the same bits are promised for any number of threads. Compile without -ffast-math (and without -Ofast)."
#endif

#define FIBRANT_VERSION_MAJOR 0
#define FIBRANT_VERSION_MINOR 2
#define FIBRANT_VERSION_PATCH 0
#define FIBRANT_VERSION "0.2.0"
