// SPDX-License-Identifier: GPL-3.0-or-later
// The pixels of an attached photograph, as commands ask for them.
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "interp/commands/photographs.h"
#include "interp/run.h"
#include "picture_files.h"

namespace tranos::interp {
namespace {

using camera::Samples;

class PixelsTest : public ::testing::Test {
 protected:
  // After a script that is to run without error.
  model::State StateAfter(const std::string& script, const RunOptions& options = {}) {
    Host host;
    host.read = [this](std::string_view path) -> tl::expected<std::string, HostError> {
      ++reads_;
      const auto file = files_.find(std::string(path));
      if (file != files_.end()) return file->second;
      return tl::make_unexpected(HostError{HostError::kMissing, "no such file"});
    };
    const ScriptResult result = RunScript("pixels.trn", script, {}, options, host);
    EXPECT_FALSE(result.diagnostics.has_errors());
    return result.outcome.state;
  }
  model::ElementPtr Named(const model::State& state, const std::string& name) {
    model::ElementPtr found;
    state.model.ForEach([&](const model::ElementPtr& element) {
      if (element->name_or_empty() == name) found = element;
    });
    return found;
  }
  model::ElementPtr After(const std::string& script, const std::string& name,
                          const RunOptions& options = {}) {
    return Named(StateAfter(script, options), name);
  }

  std::map<std::string, std::string> files_;
  int reads_ = 0;
};

Samples Ramp() {
  return camera::Paint(5, 3, 3, [](int x, int y, int c) {
    return static_cast<std::uint16_t>((x * 40 + y * 7 + c) << 8);
  });
}

TEST_F(PixelsTest, AreThoseOfTheFileAndTheSameObjectEachTime) {
  files_["a.png"] = camera::PngFileOf(Ramp());
  const auto photograph = After("attach photo \"a.png\" as a", "a");
  const auto pixels = PixelsOf(*photograph);
  ASSERT_TRUE(pixels.has_value());
  EXPECT_EQ((*pixels)->width_px, 5);
  EXPECT_EQ((*pixels)->rgb[3 * (2 * 5 + 4) + 1], 4 * 40 + 2 * 7 + 1);
  EXPECT_EQ(*PixelsOf(*photograph), *pixels);
}

TEST_F(PixelsTest, OfAFileAttachedTwiceAreReadOnceAndShared) {
  files_["a.png"] = camera::PngFileOf(Ramp());
  const model::State state = StateAfter("attach photo \"a.png\" as a\nattach photo \"a.png\" as b");
  EXPECT_EQ(reads_, 1);
  const auto a = PixelsOf(*Named(state, "a"));
  ASSERT_TRUE(a.has_value());
  EXPECT_EQ(*PixelsOf(*Named(state, "b")), *a);
}

TEST_F(PixelsTest, AreUpright) {
  camera::JpegOptions options;
  options.orientation = 6;  // the file's left column is the picture's top row, turned clockwise
  files_["portrait.jpg"] = camera::JpegFileOf(Ramp(), options);
  const auto photograph = After("attach photo \"portrait.jpg\" as p", "p");
  const auto pixels = PixelsOf(*photograph);
  ASSERT_TRUE(pixels.has_value());
  EXPECT_EQ((*pixels)->width_px, 3);
  EXPECT_EQ((*pixels)->height_px, 5);
  EXPECT_EQ(PhotographOf(*photograph).frame.size_px, Eigen::Vector2i(3, 5));
  // Top left is the file's bottom left.
  EXPECT_NEAR((*pixels)->rgb[0], 2 * 7, 6);
}

TEST_F(PixelsTest, OfAFileDamagedInsideAreRefused) {
  std::string file = camera::PngFileOf(Ramp());
  file[file.size() - 30] ^= '\x55';
  files_["torn.png"] = file;
  const auto pixels = PixelsOf(*After("attach photo \"torn.png\" as a", "a"));
  ASSERT_FALSE(pixels.has_value());
  EXPECT_EQ(pixels.error().code, Code::kNoPhotograph);
}

TEST_F(PixelsTest, OfAStatedCameraThereAreNone) {
  const auto pixels =
      PixelsOf(*After("place camera f=35mm format=36mm,24mm size=36,24 xy=0,-9,2 as c", "c"));
  ASSERT_FALSE(pixels.has_value());
  EXPECT_EQ(pixels.error().code, Code::kNoPhotograph);
}

TEST_F(PixelsTest, AreNotKeptByAJournal) {
  RunOptions replay;
  replay.photographs.by_path["a.png"] = {{}, {5, 3}};
  const auto pixels = PixelsOf(*After("attach photo \"a.png\" as a", "a", replay));
  ASSERT_FALSE(pixels.has_value());
  EXPECT_EQ(pixels.error().code, Code::kCannotRead);
}

}  // namespace
}  // namespace tranos::interp
