// Which insertions threads share, on machines whose times are made up.
#include "core/growth/sharing_choice.h"

#include <gtest/gtest.h>

#include <cstddef>

namespace ndhull {
namespace {

/// What insertions of `ridges` ridges take alone, and shared: so much for each loop's threads to meet, and a
/// part of the rest.
struct Machine {
  double meeting, part;

  double seconds(bool is_shared, std::size_t ridges) const {
    const double alone = 1e-7 * static_cast<double>(ridges);
    return is_shared ? meeting + part * alone : alone;
  }
};

/// How many of `count` insertions of this size are shared.
std::size_t shared_of(SharingChoice& choice, const Machine& machine, std::size_t ridges, std::size_t count) {
  std::size_t shared = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const bool is_shared = choice.shares(ridges);
    shared += is_shared ? 1 : 0;
    choice.took(is_shared, ridges, machine.seconds(is_shared, ridges));
  }
  return shared;
}

TEST(SharingChoice, SharesWhatTakesLessTimeShared) {
  SharingChoice choice;
  const Machine machine{100e-6, 0.6};  // pays from 2,500 ridges on
  EXPECT_LE(shared_of(choice, machine, 600, 100), 4u);
  EXPECT_GE(shared_of(choice, machine, 5000, 100), 96u);
  EXPECT_LE(shared_of(choice, machine, 600, 20), 3u);  // as before, a look again apart
}

TEST(SharingChoice, TriesSeldomWhatTakesFarLonger) {
  SharingChoice choice;
  const Machine far_cores{100e-6, 1.5};
  std::size_t shared = 0;
  for (const std::size_t ridges : {600u, 1200u, 2400u, 4800u})
    shared += shared_of(choice, far_cores, ridges, 500);
  EXPECT_GE(shared, 4u);
  EXPECT_LE(shared, 13u);
}

TEST(SharingChoice, TriesNothingAloneWhereSmallerInsertionsClearlyPay) {
  SharingChoice choice;
  const Machine machine{1e-6, 0.6};
  EXPECT_GE(shared_of(choice, machine, 600, 100), 96u);
  EXPECT_EQ(shared_of(choice, machine, 9000, 100), 100u);
}

TEST(SharingChoice, NoticesThatTheMachineHasChanged) {
  SharingChoice choice;
  EXPECT_GE(shared_of(choice, {1e-6, 0.6}, 600, 200), 190u);
  const Machine busy{1e-3, 0.6};
  shared_of(choice, busy, 600, 130);
  EXPECT_LE(shared_of(choice, busy, 600, 100), 4u);
}

TEST(SharingChoice, OneThatWasHeldUpDecidesNothing) {
  SharingChoice choice;
  const Machine machine{1e-6, 0.6};
  while (!choice.shares(600)) choice.took(false, 600, machine.seconds(false, 600));
  choice.took(true, 600, 1.0);
  EXPECT_GE(shared_of(choice, machine, 600, 100), 96u);
}

}  // namespace
}  // namespace ndhull
