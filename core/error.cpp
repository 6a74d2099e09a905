#include "core/error.h"

#include <cstdio>
#include <cstdlib>

namespace ndhull {

std::string_view to_string(ErrorCode code) {
  switch (code) {
    case ErrorCode::kUsage: return "usage";
    case ErrorCode::kFileMissing: return "file-missing";
    case ErrorCode::kFileWrite: return "file-write";
    case ErrorCode::kEmptyInput: return "empty-input";
    case ErrorCode::kBadHeader: return "bad-header";
    case ErrorCode::kBadNumber: return "bad-number";
    case ErrorCode::kNotFinite: return "not-finite";
    case ErrorCode::kOutOfRange: return "out-of-range";
    case ErrorCode::kRaggedRow: return "ragged-row";
    case ErrorCode::kWrongCount: return "wrong-count";
    case ErrorCode::kTruncated: return "truncated";
    case ErrorCode::kUnknownType: return "unknown-type";
    case ErrorCode::kDimensionTooLow: return "dimension-too-low";
    case ErrorCode::kDimensionTooHigh: return "dimension-too-high";
    case ErrorCode::kTooManyPoints: return "too-many-points";
    case ErrorCode::kTooManySimplices: return "too-many-simplices";
    case ErrorCode::kBadHalfspace: return "bad-halfspace";
  }
  return "unknown";
}

void check_failed(const char* file, int line, const char* condition) {
  std::fprintf(stderr, "ndhull: internal error: %s:%d: %s\n", file, line, condition);
  std::abort();
}

}  // namespace ndhull
