#include "tools/hull_input.h"

#include <fmt/format.h>

#include <cstdlib>
#include <exception>
#include <new>
#include <utility>

#include "approx/planes/plane_check.h"
#include "approx/planes/written_planes.h"
#include "core/error.h"
#include "tools/command_line/exit_code.h"

namespace ndhull {
namespace {

/// What this process alone cannot go on after: the others wait for it.
[[noreturn]] void end_all(const ProcessGroup& group, const char* what) {
  fmt::print(stderr, "ndhull: internal: {}, in process {} of {}\n", what, group.rank(), group.size());
  group.end_all(kInternalErrorExitCode);
  std::_Exit(kInternalErrorExitCode);
}

template <class Call>
auto call_in_group(const ProcessGroup* group, const Call& call) -> decltype(call()) {
  if (group == nullptr) return call();
  std::optional<Error> error;
  decltype(call()) result{};
  try {
    result = call();
  } catch (const Error& found) {
    error = found;
  } catch (const std::bad_alloc&) {
    end_all(*group, "out of memory; set --max-memory, or take more machines");
  } catch (const std::exception& found) {
    end_all(*group, found.what());
  }
  agree_on_error(group, error);
  return result;
}

}  // namespace

HullInput::HullInput(const std::string& points_path, const ColumnChoice& columns, std::size_t kept_bytes,
                     const std::string& shards_pattern, const ProcessGroup* group,
                     const std::function<void()>& check)
    : group_(group) {
  if (shards_pattern.empty()) {
    file_ = read_points(points_path, columns, kept_bytes);
    check();
    return;
  }
  shards_ = std::make_unique<ShardFiles>(shards_pattern, group, check);
  if (group != nullptr) return;
  file_ = joined(shards_pattern, shards_->shards());
  shards_.reset();
}

std::optional<Hull> HullInput::compute(const HullOptions& options) {
  if (!shards_) return convex_hull(file_.view(), options);
  std::optional<ShardedHull> sharded =
      call_in_group(group_, [&] { return convex_hull_of_shards(shards_->shards(), options); });
  if (!sharded) return std::nullopt;
  kept_ = std::move(sharded->points);
  return std::move(sharded->hull);
}

std::string HullInput::verify(const Hull* hull, VerifyMode mode, unsigned threads,
                              Verification& verification) const {
  std::string failure;
  const auto verify_first = [&] {
    std::vector<double> planes;
    if (hull == nullptr) return planes;
    verification = verify_hull(view(), *hull, mode);
    if (!verification.passed()) failure = verification.first_failure();
    if (!shards_ || !failure.empty()) return planes;
    const WrittenPlanes written(*hull, view(), PlaneKind::kOuter);
    const std::size_t columns = hull->dimension + 1;
    planes.resize(hull->facet_count() * columns);
    for (std::uint32_t facet = 0; facet < hull->facet_count(); ++facet)
      written.fill(FacetId{facet}, {planes.data() + facet * columns, columns});
    return planes;
  };
  std::vector<double> planes = call_in_group(group_, verify_first);
  if (!shards_) return failure;
  planes = group_->all_gather(planes);
  double above = 0.0;
  if (!planes.empty()) {
    for (const PointShard& part : shards_->shards().parts)
      above += static_cast<double>(check_planes(part.points, planes, threads).above);
  }
  double all_above = 0.0;
  for (const double number : group_->all_gather({&above, 1})) all_above += number;
  if (failure.empty() && all_above > 0.0)
    failure = fmt::format("found {} pairs of a point above an outer plane, expected none", all_above);
  return failure;
}

void HullInput::number_as_whole(Hull& hull) const {
  if (kept_) rename_points(hull, kept_->ids(), shards_->shards().rows);
}

}  // namespace ndhull
