// The only place that knows GLM, which stops at four components: here everything has three.
#include "approx/drawing/projection.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace ndhull {
namespace {

glm::dvec3 vector_of(const Point3& point) { return {point[0], point[1], point[2]}; }

}  // namespace

Projection::Projection(const Camera& camera, double width, double height) : width_(width), height_(height) {
  const glm::dvec3 eye = camera.distance * glm::dvec3(std::cos(camera.elevation) * std::cos(camera.azimuth),
                                                      std::cos(camera.elevation) * std::sin(camera.azimuth),
                                                      std::sin(camera.elevation));
  eye_ = {eye.x, eye.y, eye.z};
  // Depth only orders what is drawn, so the planes that bound it may lie far on both sides.
  const double near_plane = 0.01 * camera.distance;
  const double far_plane = 100.0 * camera.distance;
  const glm::dmat4 view = glm::lookAt(eye, glm::dvec3(0.0), glm::dvec3(0.0, 0.0, 1.0));
  const glm::dmat4 lens = glm::perspective(camera.field_of_view, width / height, near_plane, far_plane);
  const glm::dmat4 both = lens * view;
  std::copy_n(glm::value_ptr(both), page_from_drawing_.size(), page_from_drawing_.begin());
}

Projection::OnPage Projection::project(const Point3& point) const {
  const glm::dvec4 clip = glm::make_mat4(page_from_drawing_.data()) * glm::dvec4(vector_of(point), 1.0);
  // w is the distance along the view.
  return {0.5 * width_ * (1.0 + clip.x / clip.w), 0.5 * height_ * (1.0 - clip.y / clip.w), clip.w};
}

bool Projection::is_facing(const Point3& point, const Point3& normal) const {
  return glm::dot(vector_of(eye_) - vector_of(point), vector_of(normal)) > 0.0;
}

}  // namespace ndhull
