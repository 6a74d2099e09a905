// The witness: right hulls pass, and each kind of wrong hull is caught by the claim that is wrong.
#include "approx/verify/verify.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/verify/hand_made_hull.h"

namespace ndhull {
namespace {

constexpr VerifyMode kModes[] = {VerifyMode::kFloating, VerifyMode::kExact};

void expect_pass(const HandMadeHull& hull) {
  for (const VerifyMode mode : kModes) {
    const Verification found = verify_claims(hull.view(), hull, mode);
    EXPECT_TRUE(found.passed()) << found.first_failure();
    EXPECT_TRUE(found.complete());
    EXPECT_EQ(found.first_failure(), "");
    for (const Claim claim :
         {Claim::kComplex, Claim::kFacets, Claim::kVertices, Claim::kNormals, Claim::kOuter, Claim::kInner,
          Claim::kRidges, Claim::kInterior, Claim::kNumbers}) {
      EXPECT_GT(found.of(claim).checks, 0u) << to_string(claim);
    }
    EXPECT_LE(found.largest_outer_excess, 0.0);
  }
}

/// Both modes find the claim wrong, and say so in one line that mentions `mention`.
void expect_failure(const HandMadeHull& hull, Claim claim, const std::string& mention) {
  for (const VerifyMode mode : kModes) {
    const Verification found = verify_claims(hull.view(), hull, mode);
    EXPECT_FALSE(found.passed());
    EXPECT_GT(found.of(claim).failures, 0u) << to_string(claim) << "; first: " << found.first_failure();
    EXPECT_NE(found.of(claim).first_failure.find(mention), std::string::npos)
        << found.of(claim).first_failure;
    EXPECT_EQ(found.first_failure().find('\n'), std::string::npos);
    EXPECT_FALSE(found.first_failure().empty());
  }
}

void expect_only_failure(const HandMadeHull& hull, Claim claim, const std::string& mention) {
  expect_failure(hull, claim, mention);
  for (const VerifyMode mode : kModes) {
    const Verification found = verify_claims(hull.view(), hull, mode);
    for (std::size_t row = 0; row < found.claims.size(); ++row) {
      if (static_cast<Claim>(row) == claim) continue;
      EXPECT_EQ(found.claims[row].failures, 0u) << found.claims[row].first_failure;
    }
  }
}

TEST(VerifyExample, RightHullsPass) {
  for (std::size_t d = 2; d <= 6; ++d) {
    SCOPED_TRACE(d);
    expect_pass(hand_made_cross_polytope(d));
    if (d > 2) expect_pass(hand_made_cube(d, true));
    expect_pass(hand_made_cube(d, false));
  }
}

TEST(VerifyExample, PointsInsideAndOnFacetsPass) {
  expect_pass(hand_made_cube(4, true, {0, 0, 0, 0, 1, 0.25, -0.5, 0, 1, 1, 1, 0.5, 1, 1, 1, 1}));
}

TEST(VerifyExample, OrientationIsCheckedInExactModeOnly) {
  const HandMadeHull hull = hand_made_cross_polytope(4);
  EXPECT_EQ(verify_claims(hull.view(), hull, VerifyMode::kFloating).of(Claim::kOrientation).checks, 0u);
  EXPECT_EQ(verify_claims(hull.view(), hull, VerifyMode::kExact).of(Claim::kOrientation).checks,
            16u * 4u / 2u);
}

TEST(VerifyExample, PlanesAboutAFarReferencePass) {
  HandMadeHull hull = hand_made_cube(4, true);
  constexpr double kFar = 0x1p40;  // corners stay exact
  for (double& x : hull.points) x += kFar;
  for (double& x : hull.interior) x += kFar;
  for (double& x : hull.origin) x += kFar;
  for (HandMadeFacet& facet : hull.facets) {
    facet.offset = -1.0;
    for (const double n : facet.normal) facet.offset -= n * kFar;
  }
  expect_pass(hull);
  hull.facets[2].offset += 1.0;
  expect_only_failure(hull, Claim::kNormals, "the offset of facet 2");
}

TEST(VerifyExample, WidthsAreMeasuredInTheFacetsUnit) {
  HandMadeHull hull = hand_made_cube(4, true);
  hull.facets[5].centred_offset = hull.facets[5].offset = -0.75;  // corners are 0.25 above
  hull.facets[5].unit = 0.125;
  hull.facets[5].outer_offset = 2.0;
  hull.settle_numbers();
  expect_pass(hull);
  hull.facets[5].unit = std::nextafter(0.125, 0.0);
  expect_failure(hull, Claim::kOuter, "facet 5");
}

TEST(VerifyExample, FlatHullsAreCheckedInTheirSubspace) {
  HandMadeHull hull = hand_made_cube(3, true);
  std::vector<double> embedded;
  for (std::size_t row = 0; row < 8; ++row) {
    for (std::size_t k = 0; k < 3; ++k) embedded.push_back(hull.points[row * 3 + k]);
    embedded.push_back(7.0);
  }
  hull.points = embedded;
  hull.claimed.dimension = 4;
  hull.interior.push_back(7.0);
  hull.origin.push_back(0.0);
  for (HandMadeFacet& facet : hull.facets) facet.normal.push_back(0.0);
  expect_pass(hull);
}

TEST(VerifyWitness, PlaneMovedInIsCaught) {
  HandMadeHull hull = hand_made_cube(4, true);
  hull.facets[3].centred_offset = hull.facets[3].offset = -0.5;
  expect_failure(hull, Claim::kOuter, "is above the outer plane of facet 3: found 0.5, claimed 0");
  expect_failure(hull, Claim::kRidges, "facet 3");
  const Verification found = verify_claims(hull.view(), hull, VerifyMode::kFloating);
  EXPECT_EQ(found.of(Claim::kOuter).failures, 8u);
  EXPECT_EQ(found.of(Claim::kOuter).worst_excess, 0.5);
}

TEST(VerifyWitness, OuterOffsetShortByOneUlpIsCaught) {
  HandMadeHull hull = hand_made_cube(5, true);
  hull.facets[7].centred_offset = hull.facets[7].offset = -0.9;
  hull.facets[7].outer_offset = 1.0 - 0.9;  // exact
  hull.settle_numbers();
  expect_pass(hull);
  hull.facets[7].outer_offset = std::nextafter(1.0 - 0.9, 0.0);
  hull.settle_numbers();
  expect_failure(hull, Claim::kOuter, "facet 7");
  expect_failure(hull, Claim::kRidges, "facet 7");
}

TEST(VerifyWitness, PointOneUlpOutsideIsCaught) {
  std::vector<double> more(4 * 50, 0.125);
  more[4 * 40 + 2] = std::nextafter(1.0, 2.0);
  expect_only_failure(hand_made_cube(4, true, more), Claim::kOuter,
                      "point 56 is above the outer plane of facet 5");
}

TEST(VerifyWitness, InnerOffsetShortByOneUlpIsCaught) {
  HandMadeHull hull = hand_made_cube(4, true);
  hull.facets[1].centred_offset = hull.facets[1].offset = -1.1;
  hull.facets[1].inner_offset = 1.0 - 1.1;
  hull.settle_numbers();
  expect_pass(hull);
  hull.facets[1].inner_offset = std::nextafter(1.0 - 1.1, 0.0);
  hull.settle_numbers();
  expect_only_failure(hull, Claim::kInner, "is below the inner plane of facet 1");
}

TEST(VerifyWitness, RotatedCornersWithRoundedPlanesNeedTheirWidths) {
  // The cross polytope's vertices scaled by 1 / 3 are no longer on the rounded planes.
  HandMadeHull hull = hand_made_cross_polytope(5);
  for (double& x : hull.points) x /= 3.0;
  hull.claimed.area /= 81.0;
  hull.claimed.volume /= 243.0;
  hull.share_area();
  for (HandMadeFacet& facet : hull.facets) facet.centred_offset = facet.offset = facet.offset / 3.0;
  const double slack = 0x1p-54;
  for (HandMadeFacet& facet : hull.facets) {
    facet.outer_offset = slack;
    facet.inner_offset = -slack;
  }
  hull.settle_numbers();
  expect_pass(hull);
}

TEST(VerifyWitness, SwappedFacetNeighboursAreCaught) {
  HandMadeHull hull = hand_made_cube(4, true);
  hull.facets[0].neighbours[0] = FacetId{1};  // the opposite side
  expect_only_failure(hull, Claim::kFacets, "facet");
}

TEST(VerifyWitness, OneSidedNeighbourIsCaught) {
  HandMadeHull hull = hand_made_cross_polytope(3);
  hull.facets[0].neighbours.push_back(FacetId{7});
  expect_failure(hull, Claim::kFacets, "facet 0");
}

TEST(VerifyWitness, SwappedSimplexNeighboursAreCaught) {
  HandMadeHull hull = hand_made_cross_polytope(4);
  std::swap(hull.simplex_neighbours(5)[0], hull.simplex_neighbours(5)[2]);
  expect_failure(hull, Claim::kComplex, "simplex");
}

TEST(VerifyWitness, RidgeSharedByThreeIsCaught) {
  HandMadeHull hull = hand_made_cross_polytope(4);
  const std::size_t copy = hull.complex.row_count++;
  hull.complex.state[copy] = SimplexState::kLive;
  std::copy_n(hull.simplex_vertices(6), 8, hull.simplex_vertices(copy));
  hull.facets.push_back(hull.facets[6]);
  hull.facets.back().simplices = {SimplexId{static_cast<std::uint32_t>(copy)}};
  hull.facet_of_simplex.push_back(FacetId{static_cast<std::uint32_t>(copy)});
  expect_failure(hull, Claim::kComplex, "");
}

TEST(VerifyWitness, SimplexTurnedInsideOutIsCaught) {
  HandMadeHull hull = hand_made_cross_polytope(4);
  std::swap(hull.simplex_vertices(9)[0], hull.simplex_vertices(9)[1]);
  std::swap(hull.simplex_neighbours(9)[0], hull.simplex_neighbours(9)[1]);
  expect_failure(hull, Claim::kComplex, "oriented");
}

TEST(VerifyWitness, SimplexOfNoFacetIsCaught) {
  HandMadeHull hull = hand_made_cube(4, true);
  hull.facets[2].simplices.pop_back();
  expect_failure(hull, Claim::kFacets, "");
}

TEST(VerifyWitness, IdsOutOfRangeAreCaught) {
  HandMadeHull hull = hand_made_cube(4, true);
  hull.facets[2].vertices[1] = PointId{1000};
  expect_failure(hull, Claim::kVertices, "facet 2");
  hull = hand_made_cube(4, true);
  hull.facets[2].neighbours[1] = FacetId{1000};
  expect_failure(hull, Claim::kFacets, "facet 2");
  hull = hand_made_cube(4, true);
  hull.facets[2].simplices[1] = SimplexId{1000000};
  expect_failure(hull, Claim::kFacets, "facet 2");
  hull = hand_made_cube(4, true);
  hull.vertex_ids.push_back(PointId{1000});
  expect_failure(hull, Claim::kVertices, "point 1000");
}

TEST(VerifyWitness, ForeignAndMissingVerticesAreCaught) {
  HandMadeHull hull = hand_made_cube(4, true, {1, 0.5, 0.5, 0.5});
  hull.facets[1].vertices.push_back(PointId{16});  // on the facet, a corner of none of its simplices
  expect_only_failure(hull, Claim::kVertices, "point 16 is a vertex of facet 1 but of none of its simplices");
  hull = hand_made_cube(4, true);
  hull.facets[1].vertices.resize(3);
  expect_failure(hull, Claim::kVertices, "facet 1");
  for (const bool merged : {true, false}) {
    hull = hand_made_cube(4, merged);
    hull.vertex_ids.erase(hull.vertex_ids.begin() + 11);
    expect_only_failure(hull, Claim::kVertices, "point 11 is a corner of the hull");
  }
  hull = hand_made_cube(4, true, {0, 0, 0, 0});
  hull.vertex_ids.push_back(PointId{16});
  expect_only_failure(hull, Claim::kVertices, "point 16");
}

TEST(VerifyWitness, NormalOfOtherLengthIsCaught) {
  HandMadeHull hull = hand_made_cube(4, true);
  for (double& n : hull.facets[6].normal) n *= 1.0 + 1e-9;
  hull.facets[6].centred_offset = hull.facets[6].offset = -(1.0 + 1e-9);
  expect_only_failure(hull, Claim::kNormals, "the normal of facet 6");
}

TEST(VerifyWitness, InteriorPointOnAFacetIsCaught) {
  HandMadeHull hull = hand_made_cube(4, true);
  hull.interior[2] = 1.0;
  expect_failure(hull, Claim::kInterior, "facet 5");
}

TEST(VerifyWitness, NumbersOfTheHullAreThoseOfItsFacets) {
  const auto expect_wrong = [](auto change) {
    HandMadeHull hull = hand_made_cube(4, true);
    hull.facets[0].outer_offset = 0.25;
    hull.facets[3].inner_offset = -0.5;
    hull.settle_numbers();
    expect_pass(hull);
    change(hull);
    expect_only_failure(hull, Claim::kNumbers, "");
  };
  expect_wrong([](HandMadeHull& hull) { hull.claimed.max_outer_offset = 0.0; });
  expect_wrong([](HandMadeHull& hull) { hull.claimed.min_inner_offset = -0.25; });
  expect_wrong([](HandMadeHull& hull) { hull.claimed.max_facet_width = std::nextafter(0.5, 0.0); });
  expect_wrong([](HandMadeHull& hull) { hull.claimed.max_facet_width = 0.75; });
  expect_wrong([](HandMadeHull& hull) { hull.claimed.volume = 0.0; });
  expect_wrong([](HandMadeHull& hull) { hull.claimed.area = std::nan(""); });
  expect_wrong([](HandMadeHull& hull) { hull.claimed.area *= 1.0 + 1e-5; });
  expect_wrong([](HandMadeHull& hull) { hull.facets[1].area *= 1.0 + 1e-5; });
  expect_wrong([](HandMadeHull& hull) {  // still closed
    for (HandMadeFacet& facet : hull.facets) facet.area *= 1.5;
    hull.claimed.area *= 1.5;
  });
}

TEST(VerifyWitness, OtherPointsAreCaught) {
  const HandMadeHull hull = hand_made_cube(4, true);
  const PointView fewer = PointView::row_major(hull.points.data(), 15, 4);
  EXPECT_GT(verify_claims(fewer, hull, VerifyMode::kFloating).of(Claim::kNumbers).failures, 0u);
}

/// Vertex 0 moved inwards below the plane of its neighbours: a dent.
HandMadeHull dented(double outer_offset, double inner_offset) {
  HandMadeHull hull = hand_made_cross_polytope(4);
  hull.points[0] = -0.5;
  hull.interior[0] = -0.75;
  for (HandMadeFacet& facet : hull.facets) {
    facet.outer_offset = outer_offset;
    facet.inner_offset = inner_offset;
  }
  hull.settle_numbers();
  return hull;
}

TEST(VerifyWitness, DentIsCaughtByExactOrientation) {
  const HandMadeHull hull = dented(0.0, 0.0);
  const Verification found = verify_claims(hull.view(), hull, VerifyMode::kExact);
  EXPECT_GT(found.concave_ridges, 0u);
  EXPECT_GT(found.of(Claim::kOrientation).failures, 0u);
  EXPECT_GT(found.of(Claim::kInner).failures, 0u);
}

TEST(VerifyWitness, DentThatTheWidthExplainsIsCountedOnly) {
  const HandMadeHull hull = dented(0.0, -0.75);
  const Verification found = verify_claims(hull.view(), hull, VerifyMode::kExact);
  EXPECT_GT(found.concave_ridges, 0u);
  EXPECT_EQ(found.of(Claim::kOrientation).failures, 0u) << found.first_failure();
  EXPECT_EQ(found.of(Claim::kInner).failures, 0u);
}

TEST(VerifyWitness, SampleSaysThatItIsOneAndStillFindsAPlaneMovedIn) {
  HandMadeHull hull = hand_made_cube(4, false);
  const double work = static_cast<double>(hull.facets.size() * hull.points.size()) / 4;
  Verification found = verify_claims(hull.view(), hull, VerifyMode::kFloating, work);
  EXPECT_TRUE(found.passed());
  EXPECT_FALSE(found.complete());
  EXPECT_FALSE(found.of(Claim::kOuter).complete);
  EXPECT_LT(found.of(Claim::kOuter).checks, hull.facets.size() * 16);
  EXPECT_TRUE(verify_claims(hull.view(), hull, VerifyMode::kExact, work).complete());
  hull.facets[17].centred_offset = hull.facets[17].offset = -0.5;
  found = verify_claims(hull.view(), hull, VerifyMode::kFloating, work);
  EXPECT_GT(found.of(Claim::kOuter).failures, 0u);
  EXPECT_NE(found.of(Claim::kOuter).first_failure.find("facet 17"), std::string::npos);
}

TEST(VerifyExample, OnePointHasNothingToCheck) {
  HandMadeHull hull;
  hull.claimed.dimension = 3;
  hull.claimed.point_count = 1;
  hull.points = {1, 2, 3};
  EXPECT_TRUE(verify_claims(hull.view(), hull, VerifyMode::kExact).passed());
}

}  // namespace
}  // namespace ndhull
