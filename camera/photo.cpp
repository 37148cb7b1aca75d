// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/photo.h"

#include <cstdio>  // before jpeglib.h, which uses its names

#include <jpeglib.h>
#include <libexif/exif-data.h>
#include <png.h>
#include <tiffio.h>

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstdarg>
#include <cstring>
#include <memory>
#include <string>
#include <string_view>

namespace tranos::camera {
namespace {

using geom::Error;
using geom::ErrorCode;
using geom::Result;
using Bytes = std::span<const std::byte>;
using Pixels = std::vector<std::uint8_t>;

tl::unexpected<Error> Unreadable(std::string detail) {
  return tl::unexpected(Error{ErrorCode::kUnreadable, std::move(detail)});
}

tl::unexpected<Error> Damaged(const std::string& format, const std::string& library_says) {
  return Unreadable("the " + format + " file is damaged or cut off" +
                    (library_says.empty() ? "" : " (" + library_says + ")"));
}

// A picture as it lies in the file: orientation 1 to 8 says which way up it is.
struct Stored {
  int width_px;
  int height_px;
  int orientation;
};

Result<Stored> Checked(std::uint64_t width, std::uint64_t height, int orientation,
                       std::int64_t max_pixels) {
  constexpr std::uint64_t kMaxSide = 1u << 30;  // so that no product of two sides overflows
  if (width == 0 || height == 0) return Unreadable("the picture has no pixels");
  if (width > kMaxSide || height > kMaxSide ||
      width * height > static_cast<std::uint64_t>(std::max<std::int64_t>(max_pixels, 0))) {
    return tl::unexpected(Error{ErrorCode::kTooLarge, "the picture has " + std::to_string(width) +
                                                          " × " + std::to_string(height) +
                                                          " pixels; the most is " +
                                                          std::to_string(max_pixels)});
  }
  return Stored{static_cast<int>(width), static_cast<int>(height),
                orientation >= 1 && orientation <= 8 ? orientation : 1};
}

std::size_t PixelCount(const Stored& s) { return std::size_t{1} * s.width_px * s.height_px; }

std::uint8_t Product(int a, int b) { return static_cast<std::uint8_t>((a * b + 127) / 255); }

// Four bytes a pixel become three, over white, in place; `premultiplied`: by alpha already.
void Flatten(Pixels& pixels, bool premultiplied) {
  const std::size_t count = pixels.size() / 4;
  for (std::size_t i = 0; i < count; ++i) {
    const int alpha = pixels[4 * i + 3];
    for (std::size_t c = 0; c < 3; ++c) {
      const int value = pixels[4 * i + c];
      const int shown = premultiplied ? value : Product(value, alpha);
      pixels[3 * i + c] = static_cast<std::uint8_t>(std::min(255, shown + 255 - alpha));
    }
  }
  pixels.resize(3 * count);
}

bool IsTurned(const Stored& s) { return s.orientation >= 5; }

PhotoSize UprightSize(const Stored& s) {
  return IsTurned(s) ? PhotoSize{s.height_px, s.width_px} : PhotoSize{s.width_px, s.height_px};
}

// A pixel (x, y) of the upright picture is the stored one at start + x·right + y·down.
Photo Upright(const Stored& s, Pixels pixels) {
  const PhotoSize size = UprightSize(s);
  if (s.orientation == 1) return {size.width_px, size.height_px, std::move(pixels)};
  const std::ptrdiff_t w = s.width_px, h = s.height_px, last_row = w * (h - 1), last = w - 1;
  struct Walk {
    std::ptrdiff_t start, right, down;
  };
  const std::array<Walk, 9> walks{{{0, 1, w},
                                   {0, 1, w},
                                   {last, -1, w},
                                   {last_row + last, -1, -w},
                                   {last_row, 1, -w},
                                   {0, w, 1},
                                   {last_row, -w, 1},
                                   {last_row + last, -w, -1},
                                   {last, w, -1}}};
  const Walk walk = walks[s.orientation];
  Photo photo{size.width_px, size.height_px, Pixels(pixels.size())};
  // In squares, so that a column of the stored picture is met again while its lines are cached.
  constexpr int kSquare = 64;
  for (int top = 0; top < size.height_px; top += kSquare) {
    const int bottom = std::min(top + kSquare, size.height_px);
    for (int left = 0; left < size.width_px; left += kSquare) {
      const int right = std::min(left + kSquare, size.width_px);
      for (int y = top; y < bottom; ++y) {
        for (int x = left; x < right; ++x) {
          const std::ptrdiff_t from = walk.start + x * walk.right + y * walk.down;
          const std::ptrdiff_t to = std::ptrdiff_t{y} * size.width_px + x;
          std::memcpy(&photo.rgb[3 * to], &pixels[3 * from], 3);
        }
      }
    }
  }
  return photo;
}

// `exif` begins with "Exif\0\0"; 1 where nothing valid is said.
int OrientationOf(const unsigned char* exif, std::size_t size) {
  const std::unique_ptr<ExifData, decltype(&exif_data_unref)> data(exif_data_new(),
                                                                   &exif_data_unref);
  if (!data) return 1;
  exif_data_unset_option(data.get(), EXIF_DATA_OPTION_FOLLOW_SPECIFICATION);
  exif_data_load_data(data.get(), exif, static_cast<unsigned>(std::min<std::size_t>(size, 0xffff)));
  const ExifEntry* entry = exif_content_get_entry(data->ifd[EXIF_IFD_0], EXIF_TAG_ORIENTATION);
  if (!entry || entry->format != EXIF_FORMAT_SHORT || entry->size < 2) return 1;
  return exif_get_short(entry->data, exif_data_get_byte_order(data.get()));
}

constexpr char kExifMark[] = {'E', 'x', 'i', 'f', 0, 0};

// PNG. libpng reports errors by a jump, over no object that has a destructor: what it jumps back
// to is a function of plain locals.
struct PngFile {
  Bytes rest;
  std::array<char, 128> message{};
  png_structp png = nullptr;
  png_infop info = nullptr;

  PngFile() = default;
  PngFile(const PngFile&) = delete;
  PngFile& operator=(const PngFile&) = delete;
  ~PngFile() { png_destroy_read_struct(&png, &info, nullptr); }
};

[[noreturn]] void KeepMessage(png_structp png, png_const_charp message) {
  auto& kept = static_cast<PngFile*>(png_get_error_ptr(png))->message;
  std::snprintf(kept.data(), kept.size(), "%s", message);
  png_longjmp(png, 1);
}

void NoWarning(png_structp, png_const_charp) {}

void Take(png_structp png, png_bytep to, png_size_t size) {
  Bytes& rest = static_cast<PngFile*>(png_get_io_ptr(png))->rest;
  if (size > rest.size()) png_error(png, "the end comes too early");
  std::memcpy(to, rest.data(), size);
  rest = rest.subspan(size);
}

bool ReadHeader(PngFile* file) {
  if (setjmp(png_jmpbuf(file->png))) return false;
  png_set_read_fn(file->png, file, Take);
  png_set_user_limits(file->png, 0x7fffffff, 0x7fffffff);
  png_set_chunk_cache_max(file->png, 16);
  png_set_chunk_malloc_max(file->png, 1u << 20);
  // Text, profiles and the rest are passed over; nothing is allocated for what they say they hold.
  png_set_keep_unknown_chunks(file->png, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
  png_set_keep_unknown_chunks(file->png, PNG_HANDLE_CHUNK_NEVER,
                              reinterpret_cast<png_const_bytep>("eXIf"), 1);
  png_read_info(file->png, file->info);
  return true;
}

std::uint32_t BigEndian(Bytes four) {
  std::uint32_t value = 0;
  for (int i = 0; i < 4; ++i) value = value << 8 | std::to_integer<std::uint32_t>(four[i]);
  return value;
}

// Of the chunk eXIf, if it is whole and comes before the pixels. libpng would allocate whatever
// length it states.
int OrientationOfPng(Bytes file) {
  constexpr std::size_t kSignature = 8, kHead = 8, kCrc = 4;
  Bytes rest = file.subspan(std::min(kSignature, file.size()));
  while (rest.size() >= kHead) {
    const std::size_t size = BigEndian(rest);
    const std::string_view name(reinterpret_cast<const char*>(rest.data()) + 4, 4);
    if (name == "IDAT" || size + kCrc > rest.size() - kHead) return 1;
    if (name == "eXIf") {
      std::vector<unsigned char> exif(std::begin(kExifMark), std::end(kExifMark));
      for (const std::byte b : rest.subspan(kHead, std::min<std::size_t>(size, 0xffff))) {
        exif.push_back(std::to_integer<unsigned char>(b));
      }
      return OrientationOf(exif.data(), exif.size());
    }
    rest = rest.subspan(kHead + size + kCrc);
  }
  return 1;
}

// Whether the last chunk is there, so that a file that is cut off is told without decoding it.
bool PngComesToItsEnd(Bytes file) {
  constexpr std::size_t kSignature = 8, kHead = 8, kCrc = 4;
  Bytes rest = file.subspan(std::min(kSignature, file.size()));
  while (rest.size() >= kHead + kCrc) {
    const std::size_t size = BigEndian(rest);
    if (std::string_view(reinterpret_cast<const char*>(rest.data()) + 4, 4) == "IEND") return true;
    if (size > rest.size() - kHead - kCrc) return false;
    rest = rest.subspan(kHead + size + kCrc);
  }
  return false;
}

Result<Stored> Open(PngFile& file, Bytes bytes, std::int64_t max_pixels) {
  file.rest = bytes;
  file.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &file, KeepMessage, NoWarning);
  file.info = file.png ? png_create_info_struct(file.png) : nullptr;
  if (!file.info || !ReadHeader(&file)) return Damaged("PNG", file.message.data());
  const auto stored =
      Checked(png_get_image_width(file.png, file.info), png_get_image_height(file.png, file.info),
              OrientationOfPng(bytes), max_pixels);
  // Deflate makes at most 1032 bytes of one.
  const std::size_t row_bytes = png_get_rowbytes(file.png, file.info);
  if (stored && row_bytes * stored->height_px / 1032 > bytes.size()) {
    return Damaged("PNG", "too short for its size");
  }
  if (stored && !PngComesToItsEnd(bytes)) return Damaged("PNG", "its end is missing");
  return stored;
}

bool HasAlpha(const PngFile& file) {
  return (png_get_color_type(file.png, file.info) & PNG_COLOR_MASK_ALPHA) ||
         png_get_valid(file.png, file.info, PNG_INFO_tRNS);
}

bool ReadRows(PngFile* file, std::uint8_t* pixels, std::size_t row_bytes, int rows) {
  if (setjmp(png_jmpbuf(file->png))) return false;
  png_set_expand(file->png);
  png_set_scale_16(file->png);
  png_set_gray_to_rgb(file->png);
  const int passes = png_set_interlace_handling(file->png);
  png_read_update_info(file->png, file->info);
  if (png_get_rowbytes(file->png, file->info) != row_bytes) {
    png_error(file->png, "rows of another length");
  }
  for (int pass = 0; pass < passes; ++pass) {
    for (int y = 0; y < rows; ++y) png_read_row(file->png, pixels + row_bytes * y, nullptr);
  }
  png_read_end(file->png, nullptr);
  return true;
}

Result<Pixels> PixelsOf(PngFile& file, const Stored& stored) {
  const std::size_t channels = HasAlpha(file) ? 4 : 3;
  Pixels pixels(channels * PixelCount(stored));
  if (!ReadRows(&file, pixels.data(), channels * stored.width_px, stored.height_px)) {
    return Damaged("PNG", file.message.data());
  }
  if (channels == 4) Flatten(pixels, false);
  return pixels;
}

// JPEG. Its library jumps, too.
struct JpegFile {
  jpeg_decompress_struct reader{};
  jpeg_error_mgr errors{};
  jpeg_progress_mgr progress{};
  std::jmp_buf jump;
  std::array<char, JMSG_LENGTH_MAX> message{};
  bool open = false;

  JpegFile() = default;
  JpegFile(const JpegFile&) = delete;
  JpegFile& operator=(const JpegFile&) = delete;
  ~JpegFile() {
    if (open) jpeg_destroy_decompress(&reader);
  }
};

[[noreturn]] void KeepMessage(j_common_ptr reader) {
  auto* file = static_cast<JpegFile*>(reader->client_data);
  reader->err->format_message(reader, file->message.data());
  std::longjmp(file->jump, 1);
}

// The library goes on with grey where data are missing; a photograph here is evidence, so what is
// made up is refused. Traces (level ≥ 0) and oddities between the pixels' data are let be.
void RefuseMissingData(j_common_ptr reader, int level) {
  if (level >= 0) return;
  auto* file = static_cast<JpegFile*>(reader->client_data);
  reader->err->format_message(reader, file->message.data());
  const std::string_view text = file->message.data();
  for (const char* harmless : {"extraneous", "JFIF", "Adobe"}) {
    if (text.find(harmless) != std::string_view::npos) return;
  }
  std::longjmp(file->jump, 1);
}

// A progressive file can ask for the whole picture to be gone over again by a few bytes.
void LimitScans(j_common_ptr reader) {
  constexpr int kMaxScans = 200;
  auto* file = static_cast<JpegFile*>(reader->client_data);
  if (file->reader.input_scan_number <= kMaxScans) return;
  std::snprintf(file->message.data(), file->message.size(), "more than %d scans", kMaxScans);
  std::longjmp(file->jump, 1);
}

bool ReadHeader(JpegFile* file, const unsigned char* bytes, unsigned long size) {
  if (setjmp(file->jump)) return false;
  file->reader.err = jpeg_std_error(&file->errors);
  file->errors.error_exit = KeepMessage;
  file->errors.emit_message = RefuseMissingData;
  file->reader.client_data = file;
  file->open = true;
  jpeg_create_decompress(&file->reader);
  file->progress.progress_monitor = LimitScans;
  file->reader.progress = &file->progress;
  jpeg_mem_src(&file->reader, bytes, size);
  jpeg_save_markers(&file->reader, JPEG_APP0 + 1, 0xffff);
  jpeg_read_header(&file->reader, TRUE);
  return true;
}

int OrientationOf(const JpegFile& file) {
  for (jpeg_saved_marker_ptr m = file.reader.marker_list; m; m = m->next) {
    if (m->data_length > sizeof kExifMark && !std::memcmp(m->data, kExifMark, sizeof kExifMark)) {
      return OrientationOf(m->data, m->data_length);
    }
  }
  return 1;
}

// Whether the mark of the picture's end (EOI) comes, so that a file that is cut off is told without
// decoding it. Segments are stepped over by their lengths, for a thumbnail in one of them has an
// end of its own; so are a scan's data by their bytes, in which only FF 00 and restarts begin with
// FF. The library looks for markers in the same way, and what follows the end is nobody's concern.
bool JpegComesToItsEnd(Bytes jpeg) {
  constexpr unsigned kStuffed = 0x00, kTemporary = 0x01, kFirstRestart = 0xd0, kStart = 0xd8,
                     kEnd = 0xd9, kFill = 0xff;
  for (std::size_t at = 0; at + 1 < jpeg.size();) {
    const auto marker = std::to_integer<unsigned>(jpeg[at + 1]);
    if (jpeg[at] != std::byte{0xff}) {
      const auto next =
          std::find(jpeg.begin() + static_cast<std::ptrdiff_t>(at), jpeg.end(), std::byte{0xff});
      at = static_cast<std::size_t>(next - jpeg.begin());
    } else if (marker == kEnd) {
      return true;
    } else if (marker == kFill) {
      ++at;  // it may be the first byte of the marker that follows
    } else if (marker == kStuffed || marker == kTemporary ||
               (marker >= kFirstRestart && marker <= kStart)) {
      at += 2;
    } else {
      if (jpeg.size() - at < 4) return false;
      at += 2 + (std::to_integer<std::size_t>(jpeg[at + 2]) << 8 |
                 std::to_integer<std::size_t>(jpeg[at + 3]));
    }
  }
  return false;
}

Result<Stored> Open(JpegFile& file, Bytes bytes, std::int64_t max_pixels) {
  if (!ReadHeader(&file, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size())) {
    return Damaged("JPEG", file.message.data());
  }
  const auto stored =
      Checked(file.reader.image_width, file.reader.image_height, OrientationOf(file), max_pixels);
  if (stored && !JpegComesToItsEnd(bytes)) return Damaged("JPEG", "its end is missing");
  return stored;
}

// One row of CMYK to RGB. Adobe's files hold what is left of white, others the ink.
void ShowInk(const std::uint8_t* cmyk, std::uint8_t* rgb, int width, bool is_ink) {
  const int flip = is_ink ? 0xff : 0;
  for (int x = 0; x < width; ++x, cmyk += 4, rgb += 3) {
    for (int c = 0; c < 3; ++c) rgb[c] = Product(cmyk[c] ^ flip, cmyk[3] ^ flip);
  }
}

bool ReadRows(JpegFile* file, std::uint8_t* pixels, std::uint8_t* cmyk_row) {
  if (setjmp(file->jump)) return false;
  jpeg_decompress_struct& reader = file->reader;
  reader.out_color_space = cmyk_row ? JCS_CMYK : JCS_RGB;
  jpeg_start_decompress(&reader);
  while (reader.output_scanline < reader.output_height) {
    std::uint8_t* to = pixels + std::size_t{3} * reader.output_width * reader.output_scanline;
    JSAMPROW row = cmyk_row ? cmyk_row : to;
    jpeg_read_scanlines(&reader, &row, 1);
    if (cmyk_row) {
      ShowInk(cmyk_row, to, static_cast<int>(reader.output_width), !reader.saw_Adobe_marker);
    }
  }
  jpeg_finish_decompress(&reader);
  return true;
}

Result<Pixels> PixelsOf(JpegFile& file, const Stored& stored) {
  Pixels pixels(3 * PixelCount(stored));
  Pixels cmyk_row(file.reader.num_components == 4 ? std::size_t{4} * stored.width_px : 0);
  if (!ReadRows(&file, pixels.data(), cmyk_row.empty() ? nullptr : cmyk_row.data())) {
    return Damaged("JPEG", file.message.data());
  }
  return pixels;
}

// TIFF. Its library returns errors and tells them to a handler of each file's own.
struct TiffFile {
  Bytes bytes;
  std::uint64_t at = 0;
  std::string message;
  TIFF* tiff = nullptr;

  TiffFile() = default;
  TiffFile(const TiffFile&) = delete;
  TiffFile& operator=(const TiffFile&) = delete;
  ~TiffFile() {
    if (tiff) TIFFClose(tiff);
  }
};

// The first message is the cause; later ones follow from it.
int KeepMessage(TIFF*, void* file, const char*, const char* format, va_list values) {
  std::string& message = static_cast<TiffFile*>(file)->message;
  std::array<char, 200> text{};
  std::vsnprintf(text.data(), text.size(), format, values);
  if (message.empty()) message = text.data();
  return 1;
}

int NoWarning(TIFF*, void*, const char*, const char*, va_list) { return 1; }

tmsize_t Take(thandle_t handle, void* to, tmsize_t size) {
  auto* file = static_cast<TiffFile*>(handle);
  if (size <= 0 || file->at >= file->bytes.size()) return 0;
  const std::size_t taken =
      std::min<std::size_t>(static_cast<std::size_t>(size), file->bytes.size() - file->at);
  std::memcpy(to, file->bytes.data() + file->at, taken);
  file->at += taken;
  return static_cast<tmsize_t>(taken);
}

tmsize_t Refuse(thandle_t, void*, tmsize_t) { return 0; }

// The library reads mapped bytes and writes none of them.
int Map(thandle_t handle, void** base, toff_t* size) {
  const Bytes bytes = static_cast<TiffFile*>(handle)->bytes;
  *base = const_cast<std::byte*>(bytes.data());
  *size = bytes.size();
  return 1;
}

void Unmap(thandle_t, void*, toff_t) {}

toff_t Seek(thandle_t handle, toff_t offset, int whence) {
  auto* file = static_cast<TiffFile*>(handle);
  if (whence == SEEK_SET) file->at = offset;
  if (whence == SEEK_CUR) file->at += offset;
  if (whence == SEEK_END) file->at = file->bytes.size() + offset;
  return file->at;
}

int KeepOpen(thandle_t) { return 0; }

toff_t Size(thandle_t handle) { return static_cast<TiffFile*>(handle)->bytes.size(); }

// The compressions of photographs and scans; the others' decoders are seldom met and less tried.
bool IsRead(std::uint16_t compression) {
  constexpr std::array kRead{
      COMPRESSION_NONE,      COMPRESSION_CCITTRLE, COMPRESSION_CCITTRLEW, COMPRESSION_CCITTFAX3,
      COMPRESSION_CCITTFAX4, COMPRESSION_LZW,      COMPRESSION_JPEG,      COMPRESSION_ADOBE_DEFLATE,
      COMPRESSION_DEFLATE,   COMPRESSION_PACKBITS};
  return std::find(kRead.begin(), kRead.end(), compression) != kRead.end();
}

TIFF* OpenInMemory(TiffFile& file, std::int64_t max_pixels) {
  const std::unique_ptr<TIFFOpenOptions, decltype(&TIFFOpenOptionsFree)> options(
      TIFFOpenOptionsAlloc(), &TIFFOpenOptionsFree);
  if (!options) return nullptr;
  TIFFOpenOptionsSetErrorHandlerExtR(options.get(), KeepMessage, &file);
  TIFFOpenOptionsSetWarningHandlerExtR(options.get(), NoWarning, nullptr);
  // A strip or tile holds at most four samples of 16 bits for each pixel, and some rows' padding.
  TIFFOpenOptionsSetMaxSingleMemAlloc(options.get(),
                                      static_cast<tmsize_t>(8 * max_pixels + (1 << 24)));
  return TIFFClientOpenExt("photo", "r", &file, Take, Refuse, Seek, KeepOpen, Size, Map, Unmap,
                           options.get());
}

Result<Stored> Open(TiffFile& file, Bytes bytes, std::int64_t max_pixels) {
  file.bytes = bytes;
  file.tiff = OpenInMemory(file, max_pixels);
  if (!file.tiff) return Damaged("TIFF", file.message);
  std::uint32_t width = 0, height = 0;
  std::uint16_t orientation = 1, compression = COMPRESSION_NONE;
  if (!TIFFGetField(file.tiff, TIFFTAG_IMAGEWIDTH, &width) ||
      !TIFFGetField(file.tiff, TIFFTAG_IMAGELENGTH, &height)) {
    return Damaged("TIFF", file.message);
  }
  TIFFGetFieldDefaulted(file.tiff, TIFFTAG_ORIENTATION, &orientation);
  TIFFGetFieldDefaulted(file.tiff, TIFFTAG_COMPRESSION, &compression);
  if (!IsRead(compression)) {
    return Unreadable("TIFF's compression " + std::to_string(compression) +
                      " is not read; save it without compression, or as PNG");
  }
  return Checked(width, height, orientation, max_pixels);
}

// A tile larger than the picture would be decoded whole, though little of it is in the picture.
bool PiecesFit(TIFF* tiff, const Stored& stored) {
  if (!TIFFIsTiled(tiff)) return true;
  std::uint32_t width = 0, height = 0;
  constexpr std::uint64_t kPadding = 4096;
  return TIFFGetField(tiff, TIFFTAG_TILEWIDTH, &width) &&
         TIFFGetField(tiff, TIFFTAG_TILELENGTH, &height) && width <= stored.width_px + kPadding &&
         height <= stored.height_px + kPadding;
}

Result<Pixels> PixelsOf(TiffFile& file, const Stored& stored) {
  TIFFRGBAImage image{};
  std::array<char, 1024> message{};
  if (!TIFFRGBAImageOK(file.tiff, message.data())) {
    return Unreadable(std::string("this variety of TIFF is not read (") + message.data() + ")");
  }
  if (!PiecesFit(file.tiff, stored)) return Damaged("TIFF", "tiles far larger than the picture");
  if (!TIFFRGBAImageBegin(&image, file.tiff, 1, message.data())) {
    return Damaged("TIFF", file.message.empty() ? message.data() : file.message);
  }
  // The rows as they are stored; Upright turns them.
  image.orientation = image.req_orientation = ORIENTATION_TOPLEFT;
  Pixels pixels(4 * PixelCount(stored));
  const bool read = TIFFRGBAImageGet(&image, reinterpret_cast<std::uint32_t*>(pixels.data()),
                                     static_cast<std::uint32_t>(stored.width_px),
                                     static_cast<std::uint32_t>(stored.height_px));
  TIFFRGBAImageEnd(&image);
  if (!read || !file.message.empty()) return Damaged("TIFF", file.message);
  Flatten(pixels, true);
  return pixels;
}

enum class Format { kPng, kJpeg, kTiff };

bool StartsWith(Bytes bytes, std::initializer_list<unsigned char> start) {
  return bytes.size() >= start.size() &&
         std::equal(start.begin(), start.end(), bytes.begin(),
                    [](unsigned char a, std::byte b) { return std::byte{a} == b; });
}

Result<Format> FormatOf(Bytes bytes) {
  if (bytes.empty()) return Unreadable("the file is empty");
  if (StartsWith(bytes, {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'})) return Format::kPng;
  if (StartsWith(bytes, {0xff, 0xd8, 0xff})) return Format::kJpeg;
  if (StartsWith(bytes, {'I', 'I', 42, 0}) || StartsWith(bytes, {'M', 'M', 0, 42}) ||
      StartsWith(bytes, {'I', 'I', 43, 0}) || StartsWith(bytes, {'M', 'M', 0, 43})) {
    return Format::kTiff;
  }
  return Unreadable("the file is no PNG, JPEG or TIFF picture");
}

template <class File>
Result<Photo> Decode(Bytes bytes, std::int64_t max_pixels) {
  File file;
  const auto stored = Open(file, bytes, max_pixels);
  if (!stored) return tl::unexpected(stored.error());
  auto pixels = PixelsOf(file, *stored);
  if (!pixels) return tl::unexpected(pixels.error());
  return Upright(*stored, std::move(*pixels));
}

template <class File>
Result<PhotoSize> SizeOf(Bytes bytes, std::int64_t max_pixels) {
  File file;
  return Open(file, bytes, max_pixels).map(UprightSize);
}

}  // namespace

Result<Photo> DecodePhoto(Bytes file, std::int64_t max_pixels) {
  const auto format = FormatOf(file);
  if (!format) return tl::unexpected(format.error());
  switch (*format) {
    case Format::kPng:
      return Decode<PngFile>(file, max_pixels);
    case Format::kJpeg:
      return Decode<JpegFile>(file, max_pixels);
    default:
      return Decode<TiffFile>(file, max_pixels);
  }
}

Result<PhotoSize> PhotoSizeOf(Bytes file, std::int64_t max_pixels) {
  const auto format = FormatOf(file);
  if (!format) return tl::unexpected(format.error());
  switch (*format) {
    case Format::kPng:
      return SizeOf<PngFile>(file, max_pixels);
    case Format::kJpeg:
      return SizeOf<JpegFile>(file, max_pixels);
    default:
      return SizeOf<TiffFile>(file, max_pixels);
  }
}

}  // namespace tranos::camera
