// The facets of a complex whose growth has gone to its end.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/complex/simplicial_complex.h"
#include "core/growth/growth.h"
#include "core/machine/blocks.h"

namespace ndhull {

/// Gauges up to so many shifts are no distance: coplanar merging takes them for rounding.
inline constexpr double kShiftsInPlane = 4.0;

/// Do so many points share planes that rounding has drawn many simplices' planes? A quarter of the vertices
/// was moved inwards when they were added, and an eighth of the ridges are flat. (Of values on a grid nearly
/// all points lie on some plane of others, and hardly any ridge is flat.)
///
/// Shapes  points: point_count x rank, the frame's; so below.
/// Cost    looks at the ridges of some hundred simplices.
bool shares_planes(const GrowthWork& work, const double* points);

/// May coplanar merging leave no more than `most` facets? A sample tells: the number of facets is the sum of
/// one over the size of its facet over all simplices.
///
/// Returns   false  where less than a quarter of the vertices were moved inwards, or the mean of the sample is
///                  far above that, by three standard errors.
/// Cost      looks at 16,384 simplices at most: facets of 64 and more count for nothing.
bool may_be_few_facets(const GrowthWork& work, const double* points, std::uint64_t most);

/// One flag a point: was it moved inwards when it was added? Empty: none was.
std::vector<std::uint8_t> find_shifted(const GrowthWork& work);

/// solve_simplices, with the sign turned so that volumes are positive: the rows' common orientation may be
/// either. The same shapes and cost; in one dimension from the planes.
void solve_outwards(SimplicialComplex& complex, const double* points,
                    std::span<const std::uint8_t> is_shifted, std::span<double> determinants);

/// The same of a hull without shifted points: find_determinants, or solved where that loses digits. `also`:
/// as there.
void find_outwards(
    SimplicialComplex& complex, const double* points, std::span<double> determinants,
    const BlockWork& also = [](std::size_t, std::size_t) {});

/// How many facets coplanar merging leaves of the simplices; `work` stays as it is.
///
/// Shapes  points: point_count x rank, the frame's.
/// Cost    a copy of the complex, solve_simplices and merge_coplanar; nothing where no point was shifted.
std::uint64_t count_exact_facets(const GrowthWork& work, const double* points);

}  // namespace ndhull
