#include "apps/base/page.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "apps/base/embedded_files.hpp"

namespace myowave::apps {
namespace {

constexpr std::string_view replacement = "\xEF\xBF\xBD";  // U+FFFD

// Bytes of the character that `text` begins with; 0 where there is none (RFC 3629).
std::size_t character_length(std::string_view text) {
  const auto byte = [&](std::size_t n) { return n < text.size() ? static_cast<unsigned char>(text[n]) : 0U; };
  const auto follows = [&](std::size_t n) { return (byte(n) & 0xC0U) == 0x80U; };
  const unsigned first = byte(0), second = byte(1);
  if (first < 0x80) return first >= 0x20 ? first != 0x7F : first == '\t' || first == '\n';
  if (first >= 0xC2 && first <= 0xDF && follows(1)) return 2;
  if (first >= 0xE0 && first <= 0xEF && follows(1) && follows(2)) {
    const bool overlong = first == 0xE0 && second < 0xA0, surrogate = first == 0xED && second >= 0xA0;
    const bool no_character = first == 0xEF && second == 0xBF && byte(2) >= 0xBE;  // U+FFFE, U+FFFF
    return overlong || surrogate || no_character ? 0 : 3;
  }
  if (first >= 0xF0 && first <= 0xF4 && follows(1) && follows(2) && follows(3)) {
    return (first == 0xF0 && second < 0x90) || (first == 0xF4 && second >= 0x90) ? 0 : 4;
  }
  return 0;
}

}  // namespace

std::string valid_text(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const std::size_t length = character_length(text);
    result += length > 0 ? text.substr(0, length) : replacement;
    text.remove_prefix(length > 0 ? length : 1);
  }
  return result;
}

std::string html_escape(std::string_view text) {
  std::string result;
  for (const char letter : valid_text(text)) {
    switch (letter) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      case '\'':
        result += "&#39;";
        break;
      default:
        result += letter;
    }
  }
  return result;
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string result;
  result.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t n = 0; n < bytes.size(); n += 3) {
    const auto byte = [&](std::size_t k) -> std::uint32_t {
      return n + k < bytes.size() ? static_cast<unsigned char>(bytes[n + k]) : 0U;
    };
    const std::uint32_t group = byte(0) << 16U | byte(1) << 8U | byte(2);
    for (const unsigned shift : {18U, 12U, 6U, 0U}) result += letters[group >> shift & 63U];
  }
  for (std::size_t n = 0; n < (3 - bytes.size() % 3) % 3; ++n) result[result.size() - 1 - n] = '=';
  return result;
}

std::string data_uri(const std::filesystem::path& image) {
  std::ifstream file(image, std::ios::binary);
  if (!file) throw std::runtime_error("cannot read " + image.string());
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  const char* type = image.extension() == ".svg" ? "image/svg+xml" : "image/png";
  return fmt::format("data:{};base64,{}", type, base64(bytes));
}

std::string html_page(std::string_view title, std::string_view body, std::string_view scripts) {
  return fmt::format(R"(<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src data:">
<link rel="icon" href="data:,">
<title>{}</title>
<style>
{}</style>
</head>
<body>
<main>
{}
</main>
{}
</body>
</html>
)",
                     html_escape(title), embedded_file("page.css"), body, scripts);
}

}  // namespace myowave::apps
