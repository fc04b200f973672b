#include "apps/input/did_you_mean.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <limits>
#include <numeric>

namespace myowave::apps {

std::string hint(std::string_view meant) {
  return meant.empty() ? "" : fmt::format("; did you mean \"{}\"?", meant);
}

std::string did_you_mean(std::string_view word, const std::vector<std::string_view>& names) {
  const auto same = [](char left, char right) {
    return std::tolower(static_cast<unsigned char>(left)) == std::tolower(static_cast<unsigned char>(right));
  };
  // Damerau-Levenshtein (a swap of neighbours is one edit), letter case ignored.
  const auto distance = [&](std::string_view left, std::string_view right) {
    std::vector<std::size_t> before, last(right.size() + 1), now(right.size() + 1);
    std::iota(last.begin(), last.end(), std::size_t{0});
    for (std::size_t i = 1; i <= left.size(); ++i) {
      now[0] = i;
      for (std::size_t j = 1; j <= right.size(); ++j) {
        now[j] =
            std::min({last[j] + 1, now[j - 1] + 1, last[j - 1] + (same(left[i - 1], right[j - 1]) ? 0 : 1)});
        if (i > 1 && j > 1 && same(left[i - 1], right[j - 2]) && same(left[i - 2], right[j - 1])) {
          now[j] = std::min(now[j], before[j - 2] + 1);
        }
      }
      before = last;
      std::swap(last, now);
      now.resize(right.size() + 1);
    }
    return last[right.size()];
  };
  std::string best;
  std::size_t best_distance = std::numeric_limits<std::size_t>::max();
  constexpr std::size_t longest = 64;  // a longer word is no slip of a key
  if (word.size() > longest) return best;
  for (std::string_view name : names) {
    const std::size_t edits = distance(word, name);
    const std::size_t allowed = std::max<std::size_t>(1, std::min(word.size(), name.size()) / 3 + 1);
    // Every letter changed is another word, not a slip.
    if (edits <= allowed && edits < std::max(word.size(), name.size()) && edits < best_distance) {
      best = name;
      best_distance = edits;
    }
  }
  return best;
}

}  // namespace myowave::apps
