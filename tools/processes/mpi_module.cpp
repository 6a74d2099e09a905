// The module ndhull_mpi.so: ProcessGroup on MPI. The program loads it when mpirun started it.
#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <thread>
#include <vector>

#include "tools/processes/process_group.h"

namespace ndhull {
namespace {

/// Numbers of one message: MPI counts in int.
constexpr std::size_t kMessage = std::size_t{1} << 26;

class MpiProcesses : public ProcessGroup {
 public:
  MpiProcesses() {
    MPI_Init(nullptr, nullptr);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
    MPI_Comm machine = MPI_COMM_NULL;
    MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
    MPI_Comm_size(machine, &on_machine_);
    MPI_Comm_free(&machine);
  }
  ~MpiProcesses() override {
    wait_for_all();
    MPI_Finalize();
  }

  std::size_t rank() const override { return static_cast<std::size_t>(rank_); }
  std::size_t size() const override { return static_cast<std::size_t>(size_); }
  std::size_t processes_on_machine() const override { return static_cast<std::size_t>(on_machine_); }

  void end_all(int exit_code) const override { MPI_Abort(MPI_COMM_WORLD, exit_code); }

  std::vector<double> all_gather(std::span<const double> mine) const override {
    const std::vector<std::uint64_t> counts = counts_of(mine.size());
    std::vector<double> all(total(counts));
    double* at = all.data();
    for (int process = 0; process < size_; ++process) {
      const std::uint64_t count = counts[static_cast<std::size_t>(process)];
      if (process == rank_) std::copy(mine.begin(), mine.end(), at);
      for_each_message(at, count, [&](double* data, int size) {
        MPI_Bcast(data, size, MPI_DOUBLE, process, MPI_COMM_WORLD);
      });
      at += count;
    }
    return all;
  }

  std::vector<double> gather_to_first(std::span<const double> mine) const override {
    const std::vector<std::uint64_t> counts = counts_of(mine.size());
    if (rank_ != 0) {
      for_each_message(const_cast<double*>(mine.data()), mine.size(), [&](const double* data, int size) {
        MPI_Send(data, size, MPI_DOUBLE, 0, 0, MPI_COMM_WORLD);
      });
      return {};
    }
    std::vector<double> all(total(counts));
    std::copy(mine.begin(), mine.end(), all.begin());
    double* at = all.data() + mine.size();
    for (int process = 1; process < size_; ++process) {
      const std::uint64_t count = counts[static_cast<std::size_t>(process)];
      for_each_message(at, count, [&](double* data, int size) {
        MPI_Recv(data, size, MPI_DOUBLE, process, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
      });
      at += count;
    }
    return all;
  }

 private:
  static std::uint64_t total(const std::vector<std::uint64_t>& counts) {
    std::uint64_t sum = 0;
    for (const std::uint64_t count : counts) sum += count;
    return sum;
  }

  template <class Call>
  static void for_each_message(double* data, std::size_t count, const Call& call) {
    for (std::size_t begin = 0; begin < count; begin += kMessage)
      call(data + begin, static_cast<int>(std::min(kMessage, count - begin)));
  }

  std::vector<std::uint64_t> counts_of(std::uint64_t mine) const {
    wait_for_all();
    std::vector<std::uint64_t> counts(size());
    MPI_Allgather(&mine, 1, MPI_UINT64_T, counts.data(), 1, MPI_UINT64_T, MPI_COMM_WORLD);
    return counts;
  }

  /// Without keeping a core busy, as MPI does while it waits: the first process computes for long, and may
  /// want that core.
  void wait_for_all() const {
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Ibarrier(MPI_COMM_WORLD, &request);
    std::chrono::microseconds pause(10);
    for (int is_done = 0;;) {
      MPI_Test(&request, &is_done, MPI_STATUS_IGNORE);
      if (is_done != 0) return;
      std::this_thread::sleep_for(pause);
      pause = std::min(pause * 2, std::chrono::microseconds(5000));
    }
  }

  int rank_ = 0, size_ = 1, on_machine_ = 1;
};

}  // namespace
}  // namespace ndhull

extern "C" ndhull::ProcessGroup* ndhull_join_mpi();  // what join_processes looks for
ndhull::ProcessGroup* ndhull_join_mpi() { return new ndhull::MpiProcesses; }
