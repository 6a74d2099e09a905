// From three dimensions to the page: a camera that looks at the middle of what is drawn.
#pragma once

#include <array>

namespace ndhull {

using Point3 = std::array<double, 3>;

/// Where the camera stands, in the drawing's own units: it looks at the origin, the third axis points up.
struct Camera {
  double azimuth = 0.0;        ///< [radians] about the third axis, from the first towards the second
  double elevation = 0.0;      ///< [radians] above the plane of the first two
  double distance = 6.0;       ///< from the origin
  double field_of_view = 0.5;  ///< [radians] vertical, above 0 and below pi
};

/// Perspective onto a page of width x height whose second coordinate grows downwards.
class Projection {
 public:
  Projection(const Camera& camera, double width, double height);

  struct OnPage {
    double x = 0.0, y = 0.0;
    double depth = 0.0;  ///< grows away from the camera
  };
  /// Precondition  the point is in front of the camera.
  OnPage project(const Point3& point) const;
  /// Is the face through `point` with this outward normal seen from outside?
  bool is_facing(const Point3& point, const Point3& normal) const;

 private:
  std::array<double, 16> page_from_drawing_;  // column-major, homogeneous
  Point3 eye_;
  double width_, height_;
};

}  // namespace ndhull
