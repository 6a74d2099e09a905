// Qhull as its own program calls it (qhull's unix_r.c), without reading and printing. qh_new_qhull would put
// the checks of its output into the time.
extern "C" {
#include <libqhull_r/qhull_ra.h>
}

#include <fmt/format.h>

#include <algorithm>
#include <csetjmp>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include "bench/hull_run.h"

namespace ndhull {
namespace {

// Qhull's error messages, in memory.
class Messages {
 public:
  Messages() : file_(open_memstream(&text_, &size_)) {
    if (file_ == nullptr) throw std::runtime_error("no memory for Qhull's messages");
  }
  Messages(const Messages&) = delete;
  Messages& operator=(const Messages&) = delete;
  ~Messages() {
    std::fclose(file_);
    std::free(text_);
  }

  std::FILE* file() { return file_; }
  std::string first_line() {
    std::fflush(file_);
    const std::string all(text_, size_);
    const std::size_t begin = std::min(all.find_first_not_of('\n'), all.size());
    return all.substr(begin, all.find('\n', begin) - begin);
  }

 private:
  char* text_ = nullptr;
  std::size_t size_ = 0;
  std::FILE* file_;
};

// Qhull leaves an error by longjmp to here: nothing that owns memory lives in this frame. Returns its exit
// code.
int compute(qhT* qh, char* command, coordT* points, int count, int dimension, HullRun& run,
            std::vector<double>* outer_planes) {
  const int exit_code = setjmp(qh->errexit);
  if (exit_code != 0) return exit_code;
  qh->NOerrexit = False;
  qh_initflags(qh, command);
  qh_init_B(qh, points, count, dimension, False);
  run.resident_bytes = resident_bytes();
  const Stopwatch watch;
  qh_qhull(qh);
  run.wall_seconds = watch.wall_seconds();
  run.cpu_seconds = watch.cpu_seconds();
  run.peak_bytes = peak_resident_bytes();

  run.facets = static_cast<std::uint64_t>(qh->num_facets - qh->num_visible);
  run.vertices = static_cast<std::uint64_t>(qh->num_vertices - qh_setsize(qh, qh->del_vertices));
  facetT* facet;
  FORALLfacets {
    realT outer = 0.0, inner = 0.0;
    qh_outerinner(qh, facet, &outer, &inner);
    run.max_facet_width = std::max(run.max_facet_width, outer - inner);
    run.max_outer_offset = std::max(run.max_outer_offset, outer);
    run.min_inner_offset = std::min(run.min_inner_offset, inner);
    if (outer_planes == nullptr) continue;
    outer_planes->insert(outer_planes->end(), facet->normal, facet->normal + dimension);
    outer_planes->push_back(facet->offset - outer);
  }
  qh->NOerrexit = True;
  return 0;
}

}  // namespace

HullRun run_qhull(const BenchInput& input, const std::string& options, std::vector<double>* outer_planes) {
  const PointSet& points = input.qhull_points();
  coordT* data = const_cast<coordT*>(points.coordinates.data());  // not changed: QbB scales a copy
  std::string command = "qhull " + options;
  Messages messages;
  HullRun run;

  QHULL_LIB_CHECK
  static qhT qh_memory;
  qhT* qh = &qh_memory;
  char* arguments[] = {command.data(), nullptr};
  qh_init_A(qh, nullptr, messages.file(), messages.file(), 1, arguments);
  const int exit_code = compute(qh, command.data(), data, static_cast<int>(points.rows()),
                                static_cast<int>(points.dimension), run, outer_planes);
  if (exit_code != 0) {
    throw std::runtime_error(fmt::format("exit code {}: {}", exit_code, messages.first_line()));
  }
  run.detail = {{"options", command}};
  return run;
}

const char* qhull_version() { return qh_version; }

}  // namespace ndhull
