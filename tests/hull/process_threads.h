// Processes that share a point set, played by threads.
#pragma once

#include <barrier>
#include <functional>
#include <thread>
#include <vector>

#include "approx/reduction/point_shards.h"

namespace ndhull {

/// What the processes of one group say at the moment.
struct SaidByProcesses {
  explicit SaidByProcesses(std::size_t count) : said(count), meeting(static_cast<std::ptrdiff_t>(count)) {}
  std::vector<std::vector<double>> said;
  std::barrier<> meeting;
};

class ThreadExchange : public ShardExchange {
 public:
  ThreadExchange(SaidByProcesses& shared, std::size_t process) : shared_(shared), process_(process) {}

  std::vector<double> all_gather(std::span<const double> mine) const override {
    shared_.said[process_].assign(mine.begin(), mine.end());
    shared_.meeting.arrive_and_wait();
    std::vector<double> all;
    for (const std::vector<double>& said : shared_.said) all.insert(all.end(), said.begin(), said.end());
    shared_.meeting.arrive_and_wait();
    return all;
  }
  std::vector<double> gather_to_first(std::span<const double> mine) const override {
    std::vector<double> all = all_gather(mine);
    if (!is_first()) all.clear();
    return all;
  }
  bool is_first() const override { return process_ == 0; }

 private:
  SaidByProcesses& shared_;
  std::size_t process_;
};

/// Cuts `points`, row-major, at these rows and calls work(process, its shards) for all processes at once:
/// process p holds the part between cuts p and p + 1, or none when they are equal.
inline void run_processes(const PointView& points, const std::vector<std::size_t>& cuts,
                          const std::function<void(std::size_t, const PointShards&)>& work) {
  const std::size_t count = cuts.size() - 1;
  SaidByProcesses shared(count);
  std::vector<std::thread> threads;
  for (std::size_t process = 0; process < count; ++process) {
    threads.emplace_back([&, process] {
      const ThreadExchange exchange(shared, process);
      PointShards shards = PointShards::whole(points);
      shards.parts.clear();
      shards.exchange = &exchange;
      // Two parts each, as if of two files.
      const std::size_t begin = cuts[process], end = cuts[process + 1], middle = begin + (end - begin) / 3;
      for (const auto& [from, to] : {std::pair(begin, middle), std::pair(middle, end)}) {
        if (from == to) continue;
        PointView part = points;
        part.data = static_cast<const double*>(points.data) + from * points.dimension;
        part.rows = to - from;
        shards.parts.push_back({part, from});
      }
      work(process, shards);
    });
  }
  for (std::thread& thread : threads) thread.join();
}

}  // namespace ndhull
