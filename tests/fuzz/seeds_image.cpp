// Images with every compression, layout and depth of their formats.
#include <unistd.h>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfTiledOutputFile.h>

#include <array>
#include <bit>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

#include "engine/base/input_file.h"
#include "engine/image/image.h"
#include "engine/image/png.h"
#include "engine/truth/reference.h"
#include "tests/fuzz/seeds.h"
#include "tools/scene_generate.h"

namespace gnomon::fuzz {
namespace {

namespace fs = std::filesystem;

constexpr int kWidth = 37, kHeight = 19;  // pixels: no multiple of any block or tile

class Folder {
 public:
  Folder() : path_(fs::temp_directory_path() / ("gnomon-seeds-" + std::to_string(getpid()))) {
    fs::create_directories(path_);
  }
  ~Folder() { fs::remove_all(path_); }
  fs::path operator/(const char* name) const { return path_ / name; }

 private:
  fs::path path_;
};

// Finite as floats, and their first two bytes as half floats.
std::vector<float> ramp() {
  std::vector<float> values(size_t{kWidth} * kHeight);
  for (uint32_t i = 0; i < values.size(); ++i)
    values[i] = std::bit_cast<float>((0x3F00 + i % uint32_t(kWidth)) << 16 | (0x3000 + 37 * i % 0x800));
  return values;
}

Imf::FrameBuffer frame_of(const Imf::Header& header, std::vector<float>& values) {
  Imf::FrameBuffer frame;
  for (auto it = header.channels().begin(); it != header.channels().end(); ++it)
    frame.insert(it.name(), Imf::Slice::Make(it.channel().type, values.data(), header.dataWindow(),
                                             sizeof(float), sizeof(float) * kWidth));
  return frame;
}

Imf::Header header_of(Imf::Compression compression, Imf::PixelType type) {
  Imf::Header header(kWidth, kHeight);
  header.compression() = compression;
  for (const char* name : {"R", "G", "B"}) header.channels().insert(name, Imf::Channel(type));
  return header;
}

std::string scan_lines(const fs::path& file, Imf::Compression compression, Imf::PixelType type) {
  std::vector<float> values = ramp();
  {
    const Imf::Header header = header_of(compression, type);
    Imf::OutputFile output(file.c_str(), header);
    output.setFrameBuffer(frame_of(header, values));
    output.writePixels(kHeight);
  }
  return read_input_file(file);
}

std::string tiles(const fs::path& file, Imf::LevelMode levels) {
  std::vector<float> values = ramp();
  {
    Imf::Header header = header_of(Imf::ZIP_COMPRESSION, Imf::HALF);
    header.setTileDescription({16, 16, levels, Imf::ROUND_DOWN});
    Imf::TiledOutputFile output(file.c_str(), header);
    output.setFrameBuffer(frame_of(header, values));
    for (int y = 0; y < output.numYLevels(); ++y)
      for (int x = 0; x < output.numXLevels(); ++x)
        if (output.isValidLevel(x, y))
          output.writeTiles(0, output.numXTiles(x) - 1, 0, output.numYTiles(y) - 1, x, y);
  }
  return read_input_file(file);
}

std::string parts(const fs::path& file) {
  std::vector<float> values = ramp();
  {
    std::array<Imf::Header, 2> headers = {header_of(Imf::ZIPS_COMPRESSION, Imf::FLOAT),
                                          header_of(Imf::RLE_COMPRESSION, Imf::UINT)};
    headers[0].setName("rgb"), headers[1].setName("shadow");
    for (Imf::Header& header : headers) header.setType(Imf::SCANLINEIMAGE);
    Imf::MultiPartOutputFile output(file.c_str(), headers.data(), int(headers.size()));
    for (int p = 0; p < int(headers.size()); ++p) {
      Imf::OutputPart part(output, p);
      part.setFrameBuffer(frame_of(headers[size_t(p)], values));
      part.writePixels(kHeight);
    }
  }
  return read_input_file(file);
}

std::string reference(const Folder& folder) {
  std::ofstream(folder / "scene.glb", std::ios::binary) << scene_bytes("square_plane");
  const ReferenceTracer tracer(load_scene(folder / "scene.glb"));
  write_exr(folder / "reference.exr", to_image(tracer.trace({.width = 8, .height = 5})));
  return read_input_file(folder / "reference.exr");
}

void append_big_endian(std::string& out, uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) out += char(value >> shift & 0xFF);
}

// Checksums are left out, which the decoder does not look at.
void append_chunk(std::string& out, const std::string& kind, const std::string& data) {
  append_big_endian(out, uint32_t(data.size()));
  out += kind + data + std::string(4, '\0');
}

// 4 x 2 pixels with what the encoder does not write; the rows stored without compression.
std::string png_of(int depth, int color, const std::string& rows, bool interlaced,
                   const std::string& palette) {
  std::string out = "\x89PNG\r\n\x1a\n", header;
  append_big_endian(header, 4);
  append_big_endian(header, 2);
  header += {char(depth), char(color), 0, 0, char(interlaced)};
  append_chunk(out, "IHDR", header);
  if (!palette.empty()) append_chunk(out, "PLTE", palette);
  if (!palette.empty()) append_chunk(out, "tRNS", std::string(2, '\x80'));
  const auto size = uint16_t(rows.size());
  std::string stored = "\x78\x01\x01";
  for (const uint16_t word : {size, uint16_t(~size)}) stored += {char(word & 0xFF), char(word >> 8)};
  append_chunk(out, "IDAT", stored + rows + std::string(4, '\0'));
  append_chunk(out, "IEND", "");
  return out;
}

}  // namespace

Seeds exr_seeds() {
  const Folder folder;
  Seeds all = {{"tiles", tiles(folder / "a.exr", Imf::ONE_LEVEL)},
               {"mipmap", tiles(folder / "b.exr", Imf::MIPMAP_LEVELS)},
               {"ripmap", tiles(folder / "c.exr", Imf::RIPMAP_LEVELS)},
               {"parts", parts(folder / "d.exr")},
               {"reference", reference(folder)}};
  for (int c = Imf::NO_COMPRESSION; c < Imf::NUM_COMPRESSION_METHODS; ++c)
    for (const Imf::PixelType type : {Imf::HALF, Imf::FLOAT, Imf::UINT})
      all["lines_" + std::to_string(c) + "_" + std::to_string(int(type))] =
          scan_lines(folder / "e.exr", Imf::Compression(c), type);
  Image mask(8, 4, {"Y"});
  mask.data[9] = 1;
  write_exr(folder / "f.exr", mask);
  all["mask"] = read_input_file(folder / "f.exr");
  return all;
}

Seeds png_seeds() {
  Seeds all;
  std::vector<uint8_t> pixels(5 * 3 * 4);
  for (size_t i = 0; i < pixels.size(); ++i) pixels[i] = uint8_t(7 * i);
  for (uint32_t channels = 1; channels <= 4; ++channels)
    all["channels_" + std::to_string(channels)] =
        png::encode(std::span(pixels).first(size_t{15} * channels), 5, 3, channels, "seed.png");
  const auto rows = [](size_t bytes) {  // two, each with its filter before it
    return "\1" + std::string(bytes, '\x11') + "\2" + std::string(bytes, '\x22');
  };
  all["bits_1"] = png_of(1, 0, rows(1), false, {});
  all["bits_16"] = png_of(16, 2, rows(24), false, {});
  all["palette"] = png_of(4, 3, rows(2), false, "abcdefghi" + std::string(39, 'x'));
  // Of Adam7's passes 4 x 2 pixels have the first, fourth, sixth and seventh.
  all["interlaced"] = png_of(8, 0, std::string(1 + 1 + 2 + 1 + 1 + 3 + 4 + 4, '\0'), true, {});
  return all;
}

}  // namespace gnomon::fuzz
