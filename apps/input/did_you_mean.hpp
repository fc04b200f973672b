// The known name that a misspelt word may stand for.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace myowave::apps {

// The name nearest to `word` by edit distance, or "" if no name is near enough.
std::string did_you_mean(std::string_view word, const std::vector<std::string_view>& names);
// "; did you mean "..."?", empty where nothing is meant.
std::string hint(std::string_view meant);

}  // namespace myowave::apps
