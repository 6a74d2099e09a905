// The invariants of the growth complex, tested by code that shares nothing with growth.
#pragma once

#include <cstdint>
#include <string>

#include "core/complex/simplicial_complex.h"

namespace ndhull {

/// What a check of a complex found. `first_problem` is empty exactly when the complex is sound.
struct ComplexCheck {
  std::uint64_t simplices = 0;
  std::uint64_t problems = 0;
  std::string first_problem;  ///< one line with the ids
  bool sound() const { return problems == 0; }
};

/// Tests, for every live simplex: its vertices differ; each neighbour is live and names it back across the
/// same ridge (the same rank-1 vertices); no ridge (as a vertex set) belongs to more or fewer than two
/// simplices; all are connected; neighbouring vertex rows have opposite induced orientation.
/// Cost  O(s rank^2 + s rank log(s rank)), by all threads: 1 us a simplex in 8-d. Memory: 4 rank + 5 bytes a
///       simplex; for each thread 16 bytes a ridge of a thirty-second of all, or of some hundred thousand.
///       The first problem is the same for any number of threads.
ComplexCheck check_complex(const SimplicialComplex& complex);

}  // namespace ndhull
