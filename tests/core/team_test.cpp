// Teams: every block of every loop is done once, whoever comes late.
#include "core/machine/team.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <new>
#include <thread>
#include <vector>

namespace ndhull {
namespace {

/// Runs `loops` loops of `count` elements; returns how often each element was visited.
std::vector<int> visits(Team& team, std::size_t loops, std::size_t count, std::size_t size) {
  std::vector<int> seen(count, 0);
  for (std::size_t loop = 0; loop < loops; ++loop) {
    team.for_each_block(count, size, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) ++seen[i];
    });
  }
  return seen;
}

TEST(Team, DoesEveryBlockOfEveryLoopOnce) {
  for (const unsigned threads : {1u, 2u, 5u}) {
    Team team(threads);
    EXPECT_EQ(team.threads(), threads);
    for (const unsigned size : {1u, 7u, 64u, 1000u}) {
      EXPECT_EQ(visits(team, 300, 500, size), std::vector<int>(500, 300)) << threads << " threads, " << size;
    }
  }
}

TEST(Team, EmptyLoopsCallNothing) {
  Team team(2);
  EXPECT_EQ(visits(team, 3, 0, 8), std::vector<int>());
}

TEST(Team, ThreadsThatFellAsleepDoNotLoseALoop) {
  Team team(3);
  for (int round = 0; round < 5; ++round) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));  // longer than they spin
    EXPECT_EQ(visits(team, 20, 100, 3), std::vector<int>(100, 20));
  }
}

// The first block waits for the second one: only another thread can do that.
TEST(Team, SleepersAreCalled) {
  Team team(2);
  std::this_thread::sleep_for(std::chrono::milliseconds(5));
  std::atomic<bool> second_was_done = false;
  team.for_each_block(2, 1, [&](std::size_t begin, std::size_t) {
    if (begin == 1) {
      second_was_done = true;
    } else {
      while (!second_was_done) std::this_thread::yield();
    }
  });
  EXPECT_TRUE(second_was_done);
}

// Whichever thread does the block, and the loops after it are done as if nothing had been.
TEST(Team, WhatABlockThrowsIsThrownWhenAllAreDone) {
  for (const unsigned threads : {1u, 2u, 4u}) {
    Team team(threads);
    for (const std::size_t bad : {0u, 3u, 63u}) {
      std::atomic<int> done = 0;
      const auto work = [&](std::size_t begin, std::size_t) {
        if (begin == bad) throw std::bad_alloc();
        ++done;
      };
      EXPECT_THROW(team.for_each_block(64, 1, work), std::bad_alloc);
      EXPECT_EQ(done, 63);
    }
    EXPECT_EQ(visits(team, 20, 100, 3), std::vector<int>(100, 20));
  }
}

}  // namespace
}  // namespace ndhull
