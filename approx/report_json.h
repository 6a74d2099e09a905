// What the reports in JSON have in common.
#pragma once

#include <nlohmann/json.hpp>
#include <variant>

namespace ndhull {

using Json = nlohmann::ordered_json;

/// null for 0, which the library's limits use for none.
template <class Number>
Json limit(Number value) {
  return value == Number{} ? Json(nullptr) : Json(value);
}

/// Visits an OptionValue.
struct OptionToJson {
  Json operator()(std::monostate) const { return nullptr; }
  template <class T>
  Json operator()(const T& value) const {
    return value;
  }
};

}  // namespace ndhull
