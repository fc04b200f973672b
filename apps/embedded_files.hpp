// Text files that are compiled in: those of apps/report/ and apps/scenes/ and, where the build found it,
// uPlot.
#pragma once

#include <string_view>

namespace myowave::apps {

// The content of a file by its name without folder; empty where it is not compiled in.
std::string_view embedded_file(std::string_view name);

}  // namespace myowave::apps
