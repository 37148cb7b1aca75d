// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <filesystem>
#include <thread>

#include "app/console.h"
#include "app/files.h"
#include "app/gallery.h"
#include "app/status.h"
#include "app/verbs.h"

namespace tranos::app {

namespace {

int Stale(const std::string& file) {
  PrintFailure("`" + interp::Printable(file) + "` is stale: run `./dev gallery`");
  return kScriptIsWrong;
}

// Pages and plans by their content. Of a picture it is enough that it is there: the page has the
// hash of what it shows.
int Check(const Gallery& gallery, const GalleryOptions& options) {
  const std::string page = options.folder + "/gallery.md";
  if (ReadNamedFile(page).value_or("") != gallery.page) return Stale(page);
  for (const GalleryElement& element : gallery.elements) {
    const std::string plan = options.folder + "/" + element.plan_file;
    if (ReadNamedFile(plan).value_or("") != element.plan) return Stale(plan);
    const std::string picture = options.folder + "/" + element.picture_file;
    if (!std::filesystem::is_regular_file(picture)) return Stale(picture);
  }
  return kFine;
}

bool Put(const std::string& file, std::string_view bytes) {
  const auto written = ReplaceNamedFile(file, bytes);
  if (!written)
    PrintFailure("`" + interp::Printable(file) + "` cannot be written: " + written.error().detail);
  return written.has_value();
}

bool IsAsked(const GalleryOptions& options, const GalleryElement& element) {
  return options.names.empty() ||
         std::any_of(options.names.begin(), options.names.end(), [&](const std::string& name) {
           return element.picture_file.ends_with("/" + name + ".png");
         });
}

}  // namespace

int GalleryVerb(const GalleryOptions& options) {
  const Gallery gallery = MakeGallery();
  for (const std::string& problem : gallery.problems) PrintFailure(problem);
  if (!gallery.problems.empty()) return kScriptIsWrong;
  if (options.check) return Check(gallery, options);
  std::error_code failed;
  std::filesystem::create_directories(options.folder + "/gallery", failed);
  const int threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  for (const GalleryElement& element : gallery.elements) {
    if (!Put(options.folder + "/" + element.plan_file, element.plan)) return kFileFailed;
    if (!IsAsked(options, element)) continue;
    const auto picture = PictureOf(element.words, threads);
    if (!picture) {
      PrintFailure("`" + element.words + "` cannot be drawn: " + picture.error());
      return kScriptIsWrong;
    }
    if (!Put(options.folder + "/" + element.picture_file, *picture)) return kFileFailed;
    PrintOut(interp::Printable(options.folder + "/" + element.picture_file) + "\n");
  }
  return Put(options.folder + "/gallery.md", gallery.page) ? kFine : kFileFailed;
}

}  // namespace tranos::app
