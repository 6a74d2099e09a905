// Which instruction sets the loops are compiled for. Three are enough on x86-64: what every machine has,
// AVX2 and AVX-512; elsewhere Highway's own list. Included before <hwy/foreach_target.h>; no include guard
// is wanted around the macro since each source includes this once.
#pragma once

#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)
