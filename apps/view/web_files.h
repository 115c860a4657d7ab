// web_files.h — the page's files, which are part of the program (web/)
#pragma once

#include <span>
#include <string_view>

namespace arris::view {

struct WebFile {
  std::string_view name;  // "index.html"
  std::string_view content;
};

std::span<const WebFile> web_files();

}  // namespace arris::view
