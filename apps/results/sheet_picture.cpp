#include "apps/results/sheet_picture.hpp"

#include <utility>

namespace myowave::apps {

SheetPicture sheet_picture(const StoredFrame& frame, std::string title, SheetPicture::Shading shading) {
  return {.title = std::move(title),
          .shape = frame.shape,
          .V = frame.V,
          .nodes = frame.nodes,
          .shading = shading};
}

}  // namespace myowave::apps
