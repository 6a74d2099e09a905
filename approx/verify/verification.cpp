#include "approx/verify/verification.h"

#include <algorithm>
#include <cstdio>

namespace ndhull {

std::string_view to_string(Claim claim) {
  switch (claim) {
    case Claim::kComplex: return "complex";
    case Claim::kFacets: return "facets";
    case Claim::kVertices: return "vertices";
    case Claim::kNormals: return "normals";
    case Claim::kOuter: return "outer";
    case Claim::kInner: return "inner";
    case Claim::kRidges: return "ridges";
    case Claim::kInterior: return "interior";
    case Claim::kNumbers: return "numbers";
    case Claim::kOrientation: return "orientation";
    case Claim::kCount: break;
  }
  return "";
}

bool Verification::passed() const {
  return std::all_of(claims.begin(), claims.end(),
                     [](const ClaimRecord& record) { return record.failures == 0; });
}

bool Verification::complete() const {
  return std::all_of(claims.begin(), claims.end(), [](const ClaimRecord& record) { return record.complete; });
}

std::string Verification::first_failure() const {
  for (std::size_t row = 0; row < claims.size(); ++row) {
    if (claims[row].failures == 0) continue;
    return std::string(to_string(static_cast<Claim>(row))) + ": " + claims[row].first_failure;
  }
  return "";
}

void join_records(ClaimRecord& a, const ClaimRecord& b) {
  if (a.failures == 0 && b.failures > 0) a.first_failure = b.first_failure;
  a.checks += b.checks;
  a.failures += b.failures;
  a.complete = a.complete && b.complete;
  a.worst_excess = std::max(a.worst_excess, b.worst_excess);
}

std::string found_and_claimed(double found, double claimed) {
  char text[96];
  std::snprintf(text, sizeof text, "found %.17g, claimed %.17g", found, claimed);
  return text;
}

}  // namespace ndhull
