// PNG bytes back to pixels.
#pragma once

#include <png.h>

#include <stdexcept>
#include <string>

#include "apps/draw/picture.hpp"

namespace myowave::test {

inline apps::Picture decode_png(const std::string& bytes) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()) == 0)
    throw std::runtime_error(image.message);
  image.format = PNG_FORMAT_RGB;
  apps::Picture picture(int(image.width), int(image.height), {});
  png_image_finish_read(&image, nullptr, &picture.at(0, 0), 0, nullptr);
  return picture;
}

}  // namespace myowave::test
