// Text files that are compiled in: those of apps/report/ and apps/scenes/, the documentation that help shows
// and, where the build found it, uPlot.
#pragma once

#include <string_view>

namespace myowave::apps {

// The content of a file by its name without folder, or of a README.md by its folder's: "solver.md", at the
// root "myowave.md". Empty where it is not compiled in.
std::string_view embedded_file(std::string_view name);

}  // namespace myowave::apps
