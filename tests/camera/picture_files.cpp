// SPDX-License-Identifier: GPL-3.0-or-later
#include "picture_files.h"

#include <cstdio>  // before jpeglib.h, which uses its names

#include <jpeglib.h>
#include <png.h>
#include <tiffio.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>

namespace tranos::camera {

Samples Paint(int width, int height, int channels,
              const std::function<std::uint16_t(int, int, int)>& f) {
  Samples s{width, height, channels, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < channels; ++c) s.values.push_back(f(x, y, c));
    }
  }
  return s;
}

namespace {

// EXIF in big-endian TIFF with the orientation and nothing else.
std::string Exif(int orientation) {
  std::string exif("MM\0\x2a\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0\x01\0\0\0\0\0\0", 26);
  exif[19] = static_cast<char>(orientation);
  return exif;
}

void Append(png_structp png, png_bytep data, png_size_t size) {
  static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<char*>(data), size);
}

// The rows of a file: samples of 16 bits with the high byte first, of 8 their upper halves.
std::vector<std::uint8_t> Rows(const Samples& s, int bit_depth) {
  std::vector<std::uint8_t> bytes;
  for (const std::uint16_t v : s.values) {
    bytes.push_back(static_cast<std::uint8_t>(v >> 8));
    if (bit_depth == 16) bytes.push_back(static_cast<std::uint8_t>(v));
  }
  return bytes;
}

struct PngWriter {
  std::string file;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);

  PngWriter() { png_set_write_fn(png, &file, Append, nullptr); }
  ~PngWriter() { png_destroy_write_struct(&png, &info); }

  void Write(std::vector<std::uint8_t>& bytes, int height) {
    std::vector<png_bytep> rows;
    for (int y = 0; y < height; ++y) rows.push_back(&bytes[bytes.size() / height * y]);
    png_write_info(png, info);
    png_write_image(png, rows.data());
    png_write_end(png, nullptr);
  }
};

}  // namespace

std::string PngFileOf(const Samples& s, const PngOptions& options) {
  PngWriter w;
  const int types[] = {0, PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB,
                       PNG_COLOR_TYPE_RGB_ALPHA};
  png_set_IHDR(w.png, w.info, static_cast<png_uint_32>(s.width), static_cast<png_uint_32>(s.height),
               options.bit_depth, types[s.channels],
               options.interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  std::string exif = Exif(options.orientation), key = "Comment", text = options.text;
  if (options.orientation) {
    png_set_eXIf_1(w.png, w.info, static_cast<png_uint_32>(exif.size()),
                   reinterpret_cast<png_bytep>(exif.data()));
  }
  png_text chunk{};
  chunk.compression = PNG_TEXT_COMPRESSION_zTXt;
  chunk.key = key.data();
  chunk.text = text.data();
  chunk.text_length = text.size();
  if (!text.empty()) png_set_text(w.png, w.info, &chunk, 1);
  std::vector<std::uint8_t> rows = Rows(s, options.bit_depth);
  w.Write(rows, s.height);
  return w.file;
}

std::string PalettePngFileOf(int width, int height, const std::vector<std::uint8_t>& indices) {
  PngWriter w;
  png_set_IHDR(w.png, w.info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), 8,
               PNG_COLOR_TYPE_PALETTE, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  png_color colours[256];
  for (int i = 0; i < 256; ++i) {
    colours[i] = {static_cast<png_byte>(i), static_cast<png_byte>(255 - i),
                  static_cast<png_byte>(i / 2)};
  }
  png_set_PLTE(w.png, w.info, colours, 256);
  png_byte transparent = 0;
  png_set_tRNS(w.png, w.info, &transparent, 1, nullptr);
  std::vector<std::uint8_t> rows = indices;
  w.Write(rows, height);
  return w.file;
}

std::string JpegFileOf(const Samples& s, const JpegOptions& options) {
  jpeg_compress_struct writer{};
  jpeg_error_mgr errors{};
  writer.err = jpeg_std_error(&errors);
  jpeg_create_compress(&writer);
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&writer, &bytes, &size);
  writer.image_width = static_cast<JDIMENSION>(s.width);
  writer.image_height = static_cast<JDIMENSION>(s.height);
  writer.input_components = s.channels;
  writer.in_color_space = s.channels == 1 ? JCS_GRAYSCALE : s.channels == 3 ? JCS_RGB : JCS_CMYK;
  jpeg_set_defaults(&writer);
  jpeg_set_quality(&writer, 100, TRUE);
  for (int c = 0; c < writer.num_components; ++c) {
    writer.comp_info[c].h_samp_factor = writer.comp_info[c].v_samp_factor = 1;
  }
  const bool inverted = s.channels == 4 && options.adobe;
  if (s.channels == 4) writer.write_Adobe_marker = inverted ? TRUE : FALSE;
  if (options.progressive) jpeg_simple_progression(&writer);
  writer.restart_in_rows = options.restart_rows;
  jpeg_start_compress(&writer, TRUE);
  std::string exif("Exif\0\0", 6);
  exif += Exif(options.orientation);
  if (options.orientation) {
    jpeg_write_marker(&writer, JPEG_APP0 + 1, reinterpret_cast<const JOCTET*>(exif.data()),
                      static_cast<unsigned>(exif.size()));
  }
  std::vector<std::uint8_t> rows = Rows(s, 8);
  if (inverted) {
    for (std::uint8_t& v : rows) v = static_cast<std::uint8_t>(255 - v);
  }
  while (writer.next_scanline < writer.image_height) {
    JSAMPROW row = &rows[rows.size() / s.height * writer.next_scanline];
    jpeg_write_scanlines(&writer, &row, 1);
  }
  jpeg_finish_compress(&writer);
  jpeg_destroy_compress(&writer);
  const std::string file(reinterpret_cast<char*>(bytes), size);
  std::free(bytes);
  return file;
}

namespace {

struct TiffMemory {
  std::string bytes;
  std::uint64_t at = 0;
};

tmsize_t ReadBack(thandle_t handle, void* to, tmsize_t size) {
  auto* m = static_cast<TiffMemory*>(handle);
  const std::size_t n = std::min<std::size_t>(size, m->bytes.size() - m->at);
  std::memcpy(to, m->bytes.data() + m->at, n);
  m->at += n;
  return static_cast<tmsize_t>(n);
}

tmsize_t Write(thandle_t handle, void* from, tmsize_t size) {
  auto* m = static_cast<TiffMemory*>(handle);
  if (m->bytes.size() < m->at + size) m->bytes.resize(m->at + size);
  std::memcpy(m->bytes.data() + m->at, from, size);
  m->at += size;
  return size;
}

toff_t Seek(thandle_t handle, toff_t offset, int whence) {
  auto* m = static_cast<TiffMemory*>(handle);
  m->at = whence == SEEK_SET ? offset : whence == SEEK_CUR ? m->at + offset : m->bytes.size();
  return m->at;
}

int Close(thandle_t) { return 0; }

toff_t Size(thandle_t handle) { return static_cast<TiffMemory*>(handle)->bytes.size(); }

std::vector<std::uint8_t> NativeRows(const Samples& s, int bit_depth) {
  if (bit_depth == 8) return Rows(s, 8);
  std::vector<std::uint8_t> bytes(2 * s.values.size());
  std::memcpy(bytes.data(), s.values.data(), bytes.size());
  return bytes;
}

// A tile's or a plane's part of the samples; outside the picture 0.
Samples Part(const Samples& s, int left, int top, int size) {
  return Paint(size, size, s.channels, [&](int x, int y, int c) -> std::uint16_t {
    const bool inside = left + x < s.width && top + y < s.height;
    return inside ? s.at(left + x, top + y, c) : std::uint16_t{0};
  });
}

Samples Plane(const Samples& s, int channel) {
  return Paint(s.width, s.height, 1, [&](int x, int y, int) { return s.at(x, y, channel); });
}

void SetTags(TIFF* tiff, const Samples& s, const TiffOptions& o) {
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, s.width);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, s.height);
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, s.channels);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, o.bit_depth);
  TIFFSetField(tiff, TIFFTAG_COMPRESSION, o.compression);
  TIFFSetField(tiff, TIFFTAG_ORIENTATION, o.orientation);
  TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, o.planes ? PLANARCONFIG_SEPARATE : PLANARCONFIG_CONTIG);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC,
               o.palette         ? PHOTOMETRIC_PALETTE
               : s.channels == 1 ? PHOTOMETRIC_MINISBLACK
                                 : PHOTOMETRIC_RGB);
  std::uint16_t extra = o.associated ? EXTRASAMPLE_ASSOCALPHA : EXTRASAMPLE_UNASSALPHA;
  if (s.channels == 4) TIFFSetField(tiff, TIFFTAG_EXTRASAMPLES, 1, &extra);
  if (o.palette) {
    std::vector<std::uint16_t> r(256), g(256), b(256);
    for (int i = 0; i < 256; ++i) {
      r[i] = static_cast<std::uint16_t>(257 * i);
      g[i] = static_cast<std::uint16_t>(257 * (255 - i));
      b[i] = static_cast<std::uint16_t>(257 * (i / 2));
    }
    TIFFSetField(tiff, TIFFTAG_COLORMAP, r.data(), g.data(), b.data());
  }
  if (o.tiled) {
    TIFFSetField(tiff, TIFFTAG_TILEWIDTH, 16);
    TIFFSetField(tiff, TIFFTAG_TILELENGTH, 16);
  } else {
    TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, 4);
  }
}

void WriteTiles(TIFF* tiff, const Samples& s, int bit_depth) {
  for (int y = 0; y < s.height; y += 16) {
    for (int x = 0; x < s.width; x += 16) {
      std::vector<std::uint8_t> bytes = NativeRows(Part(s, x, y, 16), bit_depth);
      TIFFWriteTile(tiff, bytes.data(), static_cast<std::uint32_t>(x),
                    static_cast<std::uint32_t>(y), 0, 0);
    }
  }
}

void WriteScanlines(TIFF* tiff, const Samples& s, int bit_depth, int plane) {
  std::vector<std::uint8_t> rows = NativeRows(s, bit_depth);
  for (int y = 0; y < s.height; ++y) {
    TIFFWriteScanline(tiff, &rows[rows.size() / s.height * y], static_cast<std::uint32_t>(y),
                      static_cast<std::uint16_t>(plane));
  }
}

}  // namespace

std::string TiffFileOf(const Samples& s, const TiffOptions& o) {
  TiffMemory memory;
  TIFF* tiff =
      TIFFClientOpen("test", "w", &memory, ReadBack, Write, Seek, Close, Size, nullptr, nullptr);
  SetTags(tiff, s, o);
  if (o.tiled) {
    WriteTiles(tiff, s, o.bit_depth);
  } else if (o.planes) {
    for (int c = 0; c < s.channels; ++c) WriteScanlines(tiff, Plane(s, c), o.bit_depth, c);
  } else {
    WriteScanlines(tiff, s, o.bit_depth, 0);
  }
  TIFFClose(tiff);
  return memory.bytes;
}

}  // namespace tranos::camera
