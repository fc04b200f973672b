// Numbers in JSON files: null stands where there is none; nan and inf never appear.
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

namespace myowave::apps {

inline nlohmann::ordered_json json_number(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json();
}

inline nlohmann::ordered_json json_number(const std::optional<double>& value) {
  return value ? json_number(*value) : nlohmann::ordered_json();
}

}  // namespace myowave::apps
