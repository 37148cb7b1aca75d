// SPDX-License-Identifier: GPL-3.0-or-later
// The library's elements shown: a page, and two pictures of each.
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <utility>
#include <vector>

namespace tranos::app {

struct GalleryElement {
  std::string words;
  std::string picture_file, plan_file;  // below the page's folder
  std::string plan;                     // SVG
};
struct Gallery {
  std::string page;
  std::vector<GalleryElement> elements;
  std::vector<std::string> problems;  // what could not be shown, and why
};
// Everything but the rendered pictures, which takes a moment: the page records what each shows.
Gallery MakeGallery();
// The PNG of an element at its defaults, or why there is none.
tl::expected<std::string, std::string> PictureOf(const std::string& words, int threads);

}  // namespace tranos::app
