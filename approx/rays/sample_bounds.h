// What a sample of independent rays proves about shares of directions, and what it suggests about facets that
// it did not meet.
#pragma once

#include <cstdint>

namespace ndhull {

/// A closed interval of shares. [ratio]
struct ShareInterval {
  double low = 0.0;
  double high = 1.0;
};

/// The exact interval for a share of which `hits` of `rays` were counted: it covers the true share with at
/// least this confidence.
/// Precondition  hits <= rays, 0 < confidence < 1.
/// Source        Clopper, Pearson. The use of confidence or fiducial limits illustrated in the case of the
///               binomial. Biometrika 26, 1934.
ShareInterval share_interval(std::uint64_t hits, std::uint64_t rays, double confidence);

/// x such that, with this confidence, no facet that no ray hit has a share of directions above x.
/// Proof  at most 1 / x facets have a share of x or more, and each is missed with probability (1 - x)^rays or
///        less; x makes the product 1 - confidence. 1 when there are no rays.
double unseen_share_bound(std::uint64_t rays, double confidence);

/// Part of all kinds that was met, when `once` were met once, `twice` twice and `more` more often:
/// 1 - once / (once + 2 twice + 3 more), Good's and Turing's estimate with counts that end at three. 0
/// without any.
///
/// Bias   Where all kinds are met equally often on average (Poisson) it is right to 0.02, whatever that
///        average is. Where rates differ it is too high, and where kinds are met in groups it varies more
///        than they do alone.
/// Source Good. The population frequencies of species. Biometrika 40, 1953.
double coverage_estimate(std::uint64_t once, std::uint64_t twice, std::uint64_t more);

/// How many kinds were not met, when `once` were met once and `twice` twice: a lower estimate, unbiased when
/// all are equally likely. Source  Chao. Nonparametric estimation of the number of classes in a population.
/// Scand. J. Statistics 11, 1984 (with the usual correction for small counts).
double unseen_estimate(std::uint64_t once, std::uint64_t twice);

}  // namespace ndhull
