// Self-contained HTML pages: one file holds everything that they show.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace myowave::apps {

// Valid UTF-8 and XML text: invalid bytes, and control characters other than tab and newline, become U+FFFD.
std::string valid_text(std::string_view);

// For the content and the quoted attributes of HTML and XML.
std::string html_escape(std::string_view);

std::string base64(std::string_view bytes);

// "data:image/png;base64,..." or, of .svg, "data:image/svg+xml;base64,...".
// Errors: std::runtime_error "cannot read FILE".
std::string data_uri(const std::filesystem::path& image);

// A whole page: head with the shared style (dark mode, print, small screens), title, body. `scripts`:
// elements that go before </body>. Its content policy keeps a browser from loading anything outside of the
// file: images are data URIs.
std::string html_page(std::string_view title, std::string_view body, std::string_view scripts = {});

}  // namespace myowave::apps
