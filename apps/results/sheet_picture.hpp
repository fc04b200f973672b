// A stored frame as a panel of a figure.
#pragma once

#include <string>

#include "apps/draw/plot.hpp"
#include "apps/results/run_results.hpp"

namespace myowave::apps {

SheetPicture sheet_picture(const StoredFrame&, std::string title, SheetPicture::Shading);

}  // namespace myowave::apps
