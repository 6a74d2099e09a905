// Growth to an outside width (W), and merging under a centrum radius (C) or a cosine (A).
#pragma once

#include "approx/trade/approximation.h"

namespace ndhull {

/// One approximate hull by Qhull's rules: its facets are simplices, or neighbours that a rule lets merge.
class RuleApproximation : private Approximation {
 public:
  explicit RuleApproximation(const ApproximationTask& task) : Approximation(task) {}

  ApproximateFacets run();

 private:
  void grow_outside_width();
  bool search_outside(double width);
  FacetClusters merge();
};

}  // namespace ndhull
