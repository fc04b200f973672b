// What a sweep varies: the [[axis]] tables of a sweep file.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace myowave::apps {

// Where something stands in a file, both from 1.
struct Place {
  std::uint32_t line = 0, column = 0;
};

// A value on an axis.
struct AxisValue {
  nlohmann::ordered_json shown;  // what tables and plots show: the value, or its name
  Place place;                   // in the sweep file
};

struct SweepAxis {
  std::string key;  // "section.key", or "section" where the values are whole tables
  std::vector<AxisValue> values;
  bool sampled = false;  // one of the axes of the latin hypercube
};

}  // namespace myowave::apps
