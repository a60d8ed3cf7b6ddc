// Scan lines and tiles of EXR files, one part or several.
#include "engine/image/exr.h"

#include <fmt/format.h>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>

#include "engine/base/error.h"

namespace gnomon::exr {
namespace {

constexpr uint64_t kMaxSide = 1u << 16;      // pixels; larger claims come from corrupt headers
constexpr uint64_t kMaxValues = 1ull << 31;  // floats in one image (8 GiB)

std::string text(const Imath::Box2i& box) {
  return fmt::format("({}, {}) to ({}, {})", box.min.x, box.min.y, box.max.x, box.max.y);
}

// Pixels are counted from the display window's corner: a part of it would be compared with the wrong ones.
void check_window(const Imf::Header& header, const std::string& file) {
  const Imath::Box2i &data = header.dataWindow(), &display = header.displayWindow();
  if (data != display)
    fail(fmt::format("its data window {} is not its display window {}", text(data), text(display)), file, {},
         "save it without cropping or overscan");
}

class Reader {
 public:
  explicit Reader(const std::filesystem::path& file) : name_(file.string()), input_(file.c_str()) {}

  Image read() {
    for (int p = 0; p < input_.parts(); ++p) add_part(p);
    Image image(static_cast<uint32_t>(width_), static_cast<uint32_t>(height_), names_);
    if (Imf::hasComments(input_.header(0))) image.comment = Imf::comments(input_.header(0));
    size_t first = 0;
    for (int p = 0; p < input_.parts(); ++p) first = read_part(p, first, image);
    return image;
  }

 private:
  // Its channels' names and its size.
  void add_part(int p) {
    const Imf::Header& header = input_.header(p);
    const std::string part = header.hasName() ? header.name() : fmt::format("part{}", p);
    if (header.hasType() && Imf::isDeepData(header.type()))
      fail("deep images are not supported", name_, input_.parts() > 1 ? part : "");
    if (!input_.partComplete(p)) fail("the EXR file is incomplete (cut off)", name_);
    check_window(header, name_);
    const Imath::Box2i window = header.dataWindow();
    const auto width = static_cast<uint64_t>(int64_t{window.max.x} - window.min.x + 1);
    const auto height = static_cast<uint64_t>(int64_t{window.max.y} - window.min.y + 1);
    if (p > 0 && (width != width_ || height != height_))
      fail(fmt::format("the part has {} x {} pixels, the first {} x {}", width, height, width_, height_),
           name_, part);
    width_ = width, height_ = height;
    const auto& channels = header.channels();
    for (auto it = channels.begin(); it != channels.end(); ++it) {
      if (it.channel().xSampling != 1 || it.channel().ySampling != 1)
        fail("subsampled channels are not supported", name_, it.name());
      names_.push_back(input_.parts() > 1 ? part + "." + it.name() : it.name());
    }
    if (width > kMaxSide || height > kMaxSide || width * height * names_.size() > kMaxValues)
      fail(fmt::format("the EXR file is too large ({} x {}, {} channels)", width, height, names_.size()),
           name_);
  }

  // Into the planes from `first` on; the next part's first.
  size_t read_part(int p, size_t first, Image& image) {
    Imf::InputPart part(input_, p);
    const Imath::Box2i window = part.header().dataWindow();
    Imf::FrameBuffer frame;
    const auto& channels = part.header().channels();
    for (auto it = channels.begin(); it != channels.end(); ++it)
      frame.insert(it.name(), Imf::Slice::Make(Imf::FLOAT, image.plane(first++).data(), window, sizeof(float),
                                               sizeof(float) * image.width));
    part.setFrameBuffer(frame);
    part.readPixels(window.min.y, window.max.y);
    return first;
  }

  const std::string name_;
  Imf::MultiPartInputFile input_;
  uint64_t width_ = 0, height_ = 0;
  std::vector<std::string> names_;
};

}  // namespace

Image read(const std::filesystem::path& file) { return Reader(file).read(); }

}  // namespace gnomon::exr
