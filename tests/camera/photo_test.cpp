// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/photo.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "picture_files.h"

namespace tranos::camera {
namespace {

using geom::ErrorCode;

std::span<const std::byte> BytesOf(const std::string& file) {
  return std::as_bytes(std::span<const char>(file.data(), file.size()));
}

geom::Result<Photo> Decode(const std::string& file) { return DecodePhoto(BytesOf(file)); }

// A picture that no turning or mirroring maps to itself.
Samples Ramp(int width = 21, int height = 13, int channels = 3) {
  return Paint(width, height, channels, [](int x, int y, int c) {
    return static_cast<std::uint16_t>((x * 11 + y * 3 + c * 5) % 256 << 8);
  });
}

int Upper(const Samples& s, int x, int y, int c) { return s.at(x, y, c) >> 8; }

// The largest difference of any sample from what f(x, y, channel) says.
template <class F>
int Deviation(const Photo& photo, F f) {
  int worst = 0;
  for (int y = 0; y < photo.height_px; ++y) {
    for (int x = 0; x < photo.width_px; ++x) {
      for (int c = 0; c < 3; ++c) {
        const int value = photo.rgb[std::size_t{3} * (y * photo.width_px + x) + c];
        worst = std::max(worst, std::abs(value - static_cast<int>(f(x, y, c))));
      }
    }
  }
  return worst;
}

int Deviation(const geom::Result<Photo>& photo, const Samples& s) {
  if (!photo || photo->width_px != s.width || photo->height_px != s.height) return 1000;
  return Deviation(*photo,
                   [&](int x, int y, int c) { return Upper(s, x, y, s.channels < 3 ? 0 : c); });
}

TEST(Png, GreyAndColourComeBackExactly) {
  for (const bool interlaced : {false, true}) {
    for (const int channels : {1, 3}) {
      PngOptions options;
      options.interlaced = interlaced;
      const Samples s = Ramp(21, 13, channels);
      EXPECT_EQ(Deviation(Decode(PngFileOf(s, options)), s), 0);
    }
  }
}

TEST(Png, OfSixteenBitsTheNearestOf256LevelsIsKept) {
  const Samples s = Paint(256, 17, 3, [](int x, int y, int c) {
    return static_cast<std::uint16_t>(x * 257 + y * 15 - 120 + c);
  });
  PngOptions options;
  options.bit_depth = 16;
  const auto photo = Decode(PngFileOf(s, options));
  ASSERT_TRUE(photo.has_value());
  EXPECT_EQ(Deviation(*photo, [&](int x, int y, int c) { return (s.at(x, y, c) + 128) / 257; }), 0);
}

TEST(Png, WhatIsTransparentShowsWhite) {
  for (const bool interlaced : {false, true}) {
    Samples s = Ramp(21, 13, 4);
    PngOptions options;
    options.interlaced = interlaced;
    const auto photo = Decode(PngFileOf(s, options));
    ASSERT_TRUE(photo.has_value());
    const int worst = Deviation(*photo, [&](int x, int y, int c) {
      const double a = Upper(s, x, y, 3) / 255.0;
      return std::lround(Upper(s, x, y, c) * a + 255 * (1 - a));
    });
    EXPECT_LE(worst, 1);
  }
}

TEST(Png, PaletteIsLookedUp) {
  std::vector<std::uint8_t> indices(256);
  for (int i = 0; i < 256; ++i) indices[i] = static_cast<std::uint8_t>(i);
  const auto photo = Decode(PalettePngFileOf(16, 16, indices));
  ASSERT_TRUE(photo.has_value());
  const int worst = Deviation(*photo, [&](int x, int y, int c) {
    const int i = 16 * y + x;
    const int colour[] = {i, 255 - i, i / 2};
    return i == 0 ? 255 : colour[c];
  });
  EXPECT_EQ(worst, 0);
}

TEST(Jpeg, GreyAndColourComeBackWithinItsLoss) {
  for (const bool progressive : {false, true}) {
    for (const int channels : {1, 3}) {
      JpegOptions options;
      options.progressive = progressive;
      const Samples s = Paint(40, 24, channels, [](int x, int y, int c) {
        return static_cast<std::uint16_t>((x * 4 + y * 3 + c * 9) << 8);
      });
      EXPECT_LE(Deviation(Decode(JpegFileOf(s, options)), s), 3);
    }
  }
}

TEST(Jpeg, InkDarkensWhitePaperWhicheverWayItIsStored) {
  const Samples s = Paint(32, 32, 4, [](int x, int y, int c) {
    const int ink[] = {x * 4, y * 4, 60, 40};
    return static_cast<std::uint16_t>(ink[c] << 8);
  });
  for (const bool adobe : {false, true}) {
    JpegOptions options;
    options.adobe = adobe;
    const auto photo = Decode(JpegFileOf(s, options));
    ASSERT_TRUE(photo.has_value());
    const int worst = Deviation(*photo, [&](int x, int y, int c) {
      return std::lround((255 - Upper(s, x, y, c)) * (255 - Upper(s, x, y, 3)) / 255.0);
    });
    EXPECT_LE(worst, 3) << adobe;
  }
}

TEST(Tiff, StripsTilesPlanesAndCompressionsGiveOnePicture) {
  const int kLzw = 5, kDeflate = 8, kPackBits = 32773;
  for (const int compression : {1, kLzw, kDeflate, kPackBits}) {
    for (const int channels : {1, 3}) {
      for (const int layout : {0, 1, 2}) {
        TiffOptions options;
        options.compression = compression;
        options.tiled = layout == 1;
        options.planes = layout == 2;
        const Samples s = Ramp(37, 21, channels);
        EXPECT_EQ(Deviation(Decode(TiffFileOf(s, options)), s), 0)
            << compression << ' ' << channels << ' ' << layout;
      }
    }
  }
}

TEST(Tiff, OfSixteenBitsALevelIsKeptToWithinOne) {
  TiffOptions options;
  options.bit_depth = 16;
  for (const int channels : {1, 3}) {
    const Samples s = Paint(64, 8, channels, [](int x, int y, int c) {
      return static_cast<std::uint16_t>(x * 1000 + y * 77 + c);
    });
    const auto photo = Decode(TiffFileOf(s, options));
    ASSERT_TRUE(photo.has_value());
    EXPECT_LE(
        Deviation(*photo, [&](int x, int y,
                              int c) { return (s.at(x, y, channels == 1 ? 0 : c) + 128) / 257; }),
        1);
  }
}

TEST(Tiff, AlphaOfBothKindsIsShownOverWhite) {
  for (const bool associated : {false, true}) {
    TiffOptions options;
    options.associated = associated;
    const auto photo =
        Decode(TiffFileOf(Paint(16, 16, 4,
                                [](int x, int, int c) {
                                  return static_cast<std::uint16_t>((c < 3 ? x * 2 : 100) << 8);
                                }),
                          options));
    ASSERT_TRUE(photo.has_value());
    const int worst = Deviation(*photo, [&](int x, int, int) {
      return std::lround(x * 2 * (associated ? 1 : 100 / 255.0) + 155);
    });
    EXPECT_LE(worst, 1) << associated;
  }
}

TEST(Tiff, PaletteIsLookedUp) {
  TiffOptions options;
  options.palette = true;
  const Samples s = Paint(
      16, 16, 1, [](int x, int y, int) { return static_cast<std::uint16_t>((16 * y + x) << 8); });
  const auto photo = Decode(TiffFileOf(s, options));
  ASSERT_TRUE(photo.has_value());
  EXPECT_EQ(Deviation(*photo,
                      [](int x, int y, int c) {
                        const int i = 16 * y + x;
                        return c == 0 ? i : c == 1 ? 255 - i : i / 2;
                      }),
            0);
}

// Exif 2.3, tag Orientation: where the stored row 0 and column 0 are in the upright picture.
int ExpectedUpright(const Samples& s, int orientation, int x, int y, int c) {
  const int w = s.width - 1, h = s.height - 1;
  switch (orientation) {
    case 2:
      return Upper(s, w - x, y, c);  // row 0 at the top, column 0 on the right
    case 3:
      return Upper(s, w - x, h - y, c);  // bottom, right
    case 4:
      return Upper(s, x, h - y, c);  // bottom, left
    case 5:
      return Upper(s, y, x, c);  // left, top
    case 6:
      return Upper(s, y, h - x, c);  // right, top
    case 7:
      return Upper(s, w - y, h - x, c);  // right, bottom
    case 8:
      return Upper(s, w - y, x, c);  // left, bottom
    default:
      return Upper(s, x, y, c);
  }
}

TEST(Orientation, EachOfTheEightIsTurnedUprightInEachFormat) {
  const Samples s = Paint(130, 70, 3, [](int x, int y, int c) {
    return static_cast<std::uint16_t>((x + y / 2 + c * 20) << 8);
  });
  for (int orientation = 1; orientation <= 8; ++orientation) {
    PngOptions png;
    JpegOptions jpeg;
    TiffOptions tiff;
    png.orientation = jpeg.orientation = tiff.orientation = orientation;
    for (const std::string& file : {PngFileOf(s, png), JpegFileOf(s, jpeg), TiffFileOf(s, tiff)}) {
      const auto photo = Decode(file);
      const auto size = PhotoSizeOf(BytesOf(file));
      ASSERT_TRUE(photo && size) << orientation;
      EXPECT_EQ(size->width_px, orientation < 5 ? 130 : 70);
      EXPECT_EQ(size->width_px, photo->width_px);
      EXPECT_EQ(size->height_px, photo->height_px);
      EXPECT_LE(Deviation(*photo, [&](int x, int y,
                                      int c) { return ExpectedUpright(s, orientation, x, y, c); }),
                3)
          << orientation;
    }
  }
}

std::vector<std::string> OneOfEachKind() {
  const Samples s = Ramp(61, 43);
  PngOptions interlaced;
  interlaced.interlaced = true;
  JpegOptions progressive, turned;
  progressive.progressive = true;
  turned.orientation = 6;
  TiffOptions lzw, tiled;
  lzw.compression = 5;
  tiled.tiled = true;
  return {PngFileOf(s),          PngFileOf(s, interlaced),
          JpegFileOf(s, turned), JpegFileOf(s, progressive),
          TiffFileOf(s, lzw),    TiffFileOf(s, tiled)};
}

TEST(CutOff, APictureIsWholeOrAnError) {
  for (const std::string& file : OneOfEachKind()) {
    const auto whole = Decode(file);
    ASSERT_TRUE(whole.has_value());
    for (int part = 0; part < 50; ++part) {
      const auto cut = Decode(file.substr(0, file.size() * part / 50));
      if (cut) {
        EXPECT_TRUE(cut->rgb == whole->rgb) << part;
      } else {
        EXPECT_EQ(cut.error().code, ErrorCode::kUnreadable) << part;
        EXPECT_FALSE(cut.error().detail.empty());
      }
    }
    EXPECT_FALSE(Decode(file.substr(0, file.size() / 2)).has_value());
  }
}

TEST(CutOff, IsSeenFromTheSegmentsAlone) {
  const Samples s = Ramp(61, 43);
  PngOptions interlaced;
  interlaced.interlaced = true;
  JpegOptions plain, progressive, restarted, turned;
  progressive.progressive = true;
  restarted.restart_rows = 1;
  turned.orientation = 6;
  for (const std::string& file :
       {JpegFileOf(s, plain), JpegFileOf(s, progressive), JpegFileOf(s, restarted),
        JpegFileOf(s, turned), PngFileOf(s), PngFileOf(s, interlaced)}) {
    EXPECT_TRUE(PhotoSizeOf(BytesOf(file)).has_value());
    for (const std::size_t size : {file.size() - 1, file.size() - 2, file.size() * 2 / 3}) {
      const auto cut = PhotoSizeOf(BytesOf(file.substr(0, size)));
      ASSERT_FALSE(cut.has_value()) << size << " of " << file.size();
      EXPECT_EQ(cut.error().code, ErrorCode::kUnreadable);
      EXPECT_NE(cut.error().detail.find("cut off"), std::string::npos) << cut.error().detail;
    }
  }
}

TEST(CutOff, WhatFollowsAWholeJpegIsLetBe) {
  const std::string file = JpegFileOf(Ramp());
  const std::string half = file.substr(0, file.size() / 2);
  // Zeros of a card's last block; a second picture, as phones append one, and the half of one.
  for (const std::string& after : {std::string(4096, '\0'), std::string("\xff"), file, half})
    EXPECT_TRUE(PhotoSizeOf(BytesOf(file + after)).has_value());
  // Fill bytes before the end's marker.
  const std::string filled = file.substr(0, file.size() - 2) + "\xff\xff\xff\xd9";
  EXPECT_TRUE(PhotoSizeOf(BytesOf(filled)).has_value());
  EXPECT_TRUE(Decode(filled).has_value());
}

TEST(CutOff, AThumbnailsEndIsNotThePictures) {
  const std::string thumbnail = JpegFileOf(Ramp(8, 8)), file = JpegFileOf(Ramp());
  const std::size_t length = thumbnail.size() + 2;
  const std::string segment = std::string("\xff\xe2") + static_cast<char>(length >> 8) +
                              static_cast<char>(length & 0xff) + thumbnail;
  const std::string with = file.substr(0, 2) + segment + file.substr(2);
  EXPECT_TRUE(PhotoSizeOf(BytesOf(with)).has_value());
  EXPECT_FALSE(PhotoSizeOf(BytesOf(with.substr(0, with.size() - 2))).has_value());
}

TEST(Damage, NeverGivesAPictureOfAnotherLayout) {
  for (const std::string& file : OneOfEachKind()) {
    for (std::size_t at = 0; at < file.size(); at += 1 + file.size() / 400) {
      std::string damaged = file;
      damaged[at] = static_cast<char>(damaged[at] ^ 0x55);
      const auto photo = DecodePhoto(BytesOf(damaged), 1'000'000);
      if (photo) {
        EXPECT_EQ(photo->rgb.size(), std::size_t{3} * photo->width_px * photo->height_px);
      }
    }
  }
}

std::uint32_t Crc(const std::string& bytes) {
  std::uint32_t crc = 0xffffffff;
  for (const char byte : bytes) {
    crc ^= static_cast<unsigned char>(byte);
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0u);
  }
  return ~crc;
}

std::string BigEndian(std::uint32_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift);
  return bytes;
}

std::string Chunk(const std::string& name, const std::string& data) {
  return BigEndian(static_cast<std::uint32_t>(data.size())) + name + data +
         BigEndian(Crc(name + data));
}

std::string PngHeader(std::uint32_t width, std::uint32_t height) {
  return "\x89PNG\r\n\x1a\n" +
         Chunk("IHDR", BigEndian(width) + BigEndian(height) + std::string("\x08\x02\0\0\0", 5)) +
         Chunk("IDAT", "");
}

TEST(Bomb, ASizeBeyondTheCapIsRefusedFromTheHeader) {
  const std::string file = PngHeader(100'000, 100'000);
  EXPECT_EQ(Decode(file).error().code, ErrorCode::kTooLarge);
  EXPECT_EQ(PhotoSizeOf(BytesOf(file)).error().code, ErrorCode::kTooLarge);
  EXPECT_EQ(Decode(PngHeader(0x7fffffff, 0x7fffffff)).error().code, ErrorCode::kTooLarge);
  EXPECT_EQ(Decode(PngHeader(0x80000000u, 1)).error().code, ErrorCode::kUnreadable);
}

TEST(Bomb, APngTooShortForItsSizeIsRefusedFromTheHeader) {
  EXPECT_EQ(PhotoSizeOf(BytesOf(PngHeader(14'000, 14'000))).error().code, ErrorCode::kUnreadable);
}

TEST(Bomb, AJpegsSizeIsCappedToo) {
  std::string file = JpegFileOf(Ramp());
  const std::size_t frame = file.find("\xff\xc0");
  for (int i = 5; i < 9; ++i) file[frame + i] = '\xfe';
  EXPECT_EQ(Decode(file).error().code, ErrorCode::kTooLarge);
}

// Little-endian: width, height, one strip.
TEST(Bomb, ATiffsSizeIsCappedToo) {
  const std::string file(
      "II\x2a\0\x08\0\0\0\x04\0"
      "\0\x01\x04\0\x01\0\0\0\xff\xff\xff\x7f"
      "\x01\x01\x04\0\x01\0\0\0\xff\xff\xff\x7f"
      "\x11\x01\x04\0\x01\0\0\0\x08\0\0\0"
      "\x17\x01\x04\0\x01\0\0\0\x10\0\0\0\0\0\0\0",
      62);
  EXPECT_EQ(Decode(file).error().code, ErrorCode::kTooLarge);
}

TEST(Bomb, TextOfAnySizeIsPassedOver) {
  PngOptions options;
  options.text = std::string(50'000'000, 'a');
  const Samples s = Ramp();
  EXPECT_EQ(Deviation(Decode(PngFileOf(s, options)), s), 0);
}

TEST(Cap, IsWhatTheCallerSays) {
  const std::string file = PngFileOf(Ramp(20, 10));
  EXPECT_TRUE(DecodePhoto(BytesOf(file), 200).has_value());
  EXPECT_EQ(DecodePhoto(BytesOf(file), 199).error().code, ErrorCode::kTooLarge);
}

TEST(NoPicture, IsSaidInWords) {
  EXPECT_EQ(Decode("").error().detail, "the file is empty");
  EXPECT_EQ(Decode("GIF89a").error().detail, "the file is no PNG, JPEG or TIFF picture");
  EXPECT_EQ(PhotoSizeOf({}).error().code, ErrorCode::kUnreadable);
}

}  // namespace
}  // namespace tranos::camera
