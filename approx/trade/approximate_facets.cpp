#include "approx/trade/approximate_facets.h"

#include "approx/trade/count_approximation.h"
#include "approx/trade/rule_approximation.h"
#include "approx/trade/width_approximation.h"

namespace ndhull {

ApproximateFacets approximate_facets(const ApproximationTask& task) {
  if (task.accuracy.facets > 0) return CountApproximation(task).run();
  if (task.lengths.width > 0.0) return WidthApproximation(task).run();
  return RuleApproximation(task).run();
}

}  // namespace ndhull
