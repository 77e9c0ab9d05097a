// SPDX-License-Identifier: MIT
#pragma once
/// @file The intrinsics of x86's vector units, where the compiler may use them; every use has a portable form beside it.

#if defined(__AVX2__)
#include <immintrin.h>
#endif
