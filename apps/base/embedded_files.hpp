// Text files that are compiled in: those of apps/report/ and apps/scenes/, the documentation that help shows
// and, where the build found it, uPlot.
#pragma once

#include <string_view>

namespace myowave::apps {

// The content of a file: Markdown by its path from the root of the project, "apps/sweep/README.md"; any other
// file by its name without folder, "quickstart.toml". Empty if it is not compiled in.
std::string_view embedded_file(std::string_view name);

}  // namespace myowave::apps
