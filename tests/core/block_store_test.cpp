// Blocks of the store: apart from each other, their contents kept, their memory used again.
#include "core/machine/block_store.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <random>
#include <thread>
#include <vector>

#include "core/machine/huge_array.h"

namespace ndhull {
namespace {

struct Block {
  std::uint32_t* words;
  std::size_t count;
  std::uint32_t first;  // they rise from here
};

Block make_block(std::mt19937& random) {
  const std::size_t bytes = std::uniform_int_distribution<std::size_t>(kSmallestBlock, 1 << 20)(random);
  Block block{static_cast<std::uint32_t*>(take_block(bytes)), bytes / 4,
              static_cast<std::uint32_t>(random())};
  if (block.words != nullptr) std::iota(block.words, block.words + block.count, block.first);
  return block;
}

bool is_kept(const Block& block) {
  for (std::size_t i = 0; i < block.count; ++i)
    if (block.words[i] != block.first + static_cast<std::uint32_t>(i)) return false;
  return true;
}

// Takes and gives at random, then gives all.
bool exercise(unsigned seed) {
  std::mt19937 random(seed);
  std::vector<Block> blocks;
  bool is_right = true;
  for (int step = 0; step < 400; ++step) {
    if (blocks.size() < 4 || (blocks.size() < 40 && random() % 2 == 0)) {
      blocks.push_back(make_block(random));
      is_right &=
          blocks.back().words != nullptr && reinterpret_cast<std::uintptr_t>(blocks.back().words) % 64 == 0;
      if (!is_right) return false;
    } else {
      std::swap(blocks[random() % blocks.size()], blocks.back());
      is_right &= is_kept(blocks.back()) && give_block(blocks.back().words);
      blocks.pop_back();
    }
  }
  for (const Block& block : blocks) is_right &= is_kept(block) && give_block(block.words);
  return is_right;
}

TEST(BlockStore, BlocksKeepWhatIsWrittenIntoThem) {
  for (unsigned seed = 0; seed < 4; ++seed) EXPECT_TRUE(exercise(seed));
}

// Blocks of 16 MB, every second one free: its pages go, the others' contents stay.
TEST(BlockStore, GivesBackThePagesOfFreePlacesAlone) {
  constexpr std::size_t kBytes = std::size_t{1} << 24, kHugePage = std::size_t{1} << 21;
  std::vector<Block> blocks;
  for (std::uint32_t i = 0; i < 5; ++i) {
    blocks.push_back({static_cast<std::uint32_t*>(take_block(kBytes)), kBytes / 4, 1000 * i + 1});
    ASSERT_NE(blocks.back().words, nullptr);
    std::iota(blocks.back().words, blocks.back().words + blocks.back().count, blocks.back().first);
  }
  for (const std::size_t i : {1U, 3U, 4U}) EXPECT_TRUE(give_block(blocks[i].words));
  give_back_free_pages();
  EXPECT_TRUE(is_kept(blocks[0]));
  EXPECT_TRUE(is_kept(blocks[2]));
  // A page that was given back reads as zero: the place is taken again, and at least six of its eight went.
  auto* const again = static_cast<std::uint32_t*>(take_block(kBytes));
  ASSERT_EQ(again, blocks[1].words);
  EXPECT_GE(std::count(again, again + kBytes / 4, 0U) * 4, static_cast<std::ptrdiff_t>(6 * kHugePage));
  for (const std::size_t i : {0U, 1U, 2U}) EXPECT_TRUE(give_block(blocks[i].words));
}

TEST(BlockStore, ThreadsTakeAndGiveAtTheSameTime) {
  std::vector<std::uint8_t> is_right(4);
  std::vector<std::thread> threads;
  for (unsigned seed = 0; seed < 4; ++seed)
    threads.emplace_back([&, seed] { is_right[seed] = exercise(100 + seed) ? 1 : 0; });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(std::count(is_right.begin(), is_right.end(), 1), 4);
}

TEST(BlockStore, FreePlacesAreJoinedAndTakenAgain) {
  constexpr std::size_t kBytes = std::size_t{1} << 20;
  void* const first = take_block(kBytes);
  void* const second = take_block(kBytes);
  void* const third = take_block(kBytes);
  void* const last = take_block(kBytes);  // so that none of them is at the end
  ASSERT_NE(last, nullptr);
  give_block(second);
  EXPECT_EQ(take_block(kBytes), second);
  give_block(first);
  give_block(third);
  give_block(second);  // joins both
  EXPECT_EQ(take_block(3 * kBytes), first);
  give_block(first);
  give_block(last);
  EXPECT_EQ(take_block(4 * kBytes), first);  // all that was
  give_block(first);
}

TEST(BlockStore, ACopiedProcessBeginsInOtherPages) {
  constexpr std::size_t kBytes = std::size_t{1} << 20;
  auto* const kept = static_cast<char*>(take_block(kBytes));
  auto* const freed = static_cast<char*>(take_block(kBytes));
  ASSERT_NE(freed, nullptr);
  give_block(freed);
  leave_shared_blocks();
  auto* const fresh = static_cast<char*>(take_block(kBytes));
  EXPECT_GE(fresh, std::max(kept, freed) + kBytes);
  std::fill_n(kept, kBytes, 'k');
  std::fill_n(fresh, kBytes, 'f');
  EXPECT_EQ(std::count(kept, kept + kBytes, 'k'), static_cast<std::ptrdiff_t>(kBytes));
  EXPECT_TRUE(give_block(kept));
  EXPECT_TRUE(give_block(fresh));
}

TEST(BlockStore, LeavesOtherSizesAndAddressesAlone) {
  EXPECT_EQ(take_block(kSmallestBlock - 1), nullptr);
  EXPECT_EQ(take_block(kLargestBlock + 1), nullptr);
  std::vector<int> other(10);
  EXPECT_FALSE(give_block(other.data()));
  EXPECT_FALSE(give_block(nullptr));
}

TEST(HugeArray, GrowingOnesAreZeroAndWrittenOnesUseMemoryAgain) {
  constexpr std::size_t kCount = 100'000;
  const double* place = nullptr;
  {
    auto array = HugeArray<double>::to_write(kCount);
    ASSERT_EQ(array.capacity(), kCount);
    place = array.data();
    std::fill_n(array.data(), kCount, 1.0);
  }
  auto again = HugeArray<double>::to_write(kCount);
  EXPECT_EQ(again.data(), place);
  const HugeArray<double> growing(kCount);
  EXPECT_TRUE(std::all_of(growing.data(), growing.data() + kCount, [](double x) { return x == 0.0; }));
}

}  // namespace
}  // namespace ndhull
