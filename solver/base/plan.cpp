#include "solver/base/plan.hpp"

#include <fmt/format.h>

namespace myowave::solver {

std::uint64_t Plan::bytes() const {
  std::uint64_t sum = 0;
  for (const auto& part : parts) sum += part.bytes();
  return sum;
}

std::uint64_t Plan::device_bytes() const {
  std::uint64_t sum = 0;
  for (const auto& part : parts) sum += part.device_bytes;
  return sum;
}

std::vector<std::string> Plan::in_words() const {
  std::vector<std::string> words;
  for (const auto& part : parts)
    if (part.active) words.push_back(fmt::format("{}: {}", part.part, part.what));
  return words;
}

}  // namespace myowave::solver
