// What the reports in JSON have in common.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <variant>

namespace ndhull {

using Json = nlohmann::ordered_json;

/// null for 0, which the library's limits use for none.
template <class Number>
Json limit(Number value) {
  return value == Number{} ? Json(nullptr) : Json(value);
}

/// A path may hold any bytes: those that are no UTF-8 are replaced.
inline std::string report_text(const Json& report) {
  return report.dump(2, ' ', false, Json::error_handler_t::replace);
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
