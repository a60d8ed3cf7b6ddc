// EXR files of other programs: parts, layers, colours and windows.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>

#include <array>
#include <filesystem>

#include "engine/base/error.h"
#include "engine/image/image.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;

class ExrFiles : public testing::Test {
 protected:
  ExrFiles() { fs::create_directories(folder_); }
  ~ExrFiles() override { fs::remove_all(folder_); }

  template <typename Function>
  static std::string message_of(Function function) {
    try {
      function();
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  }

  // 3 x 2 pixels with one channel, whose data window is `data` in a display window of `display`.
  fs::path windowed(const Imath::Box2i& display, const Imath::Box2i& data) const {
    Imf::Header header(display, data);
    header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
    const fs::path file = folder_ / "window.exr";
    Imf::OutputFile output(file.c_str(), header);
    Imf::FrameBuffer frame;
    frame.insert("Y", Imf::Slice::Make(Imf::FLOAT, values_.data(), data, sizeof(float), 3 * sizeof(float)));
    output.setFrameBuffer(frame);
    output.writePixels(2);
    return file;
  }

  // Two parts: "rgb" with R, G and B, and "shadow" with Y.
  fs::path parts() const {
    std::vector<Imf::Header> headers;
    for (const auto& [name, channels] : {std::pair{"rgb", "RGB"}, {"shadow", "Y"}}) {
      Imf::Header header(3, 2);
      header.setName(name);
      header.setType(Imf::SCANLINEIMAGE);
      for (const char* c = channels; *c != 0; ++c)
        header.channels().insert(std::string(1, *c), Imf::Channel(Imf::FLOAT));
      headers.push_back(header);
    }
    const fs::path file = folder_ / "parts.exr";
    Imf::MultiPartOutputFile output(file.c_str(), headers.data(), 2);
    for (int p = 0; p < 2; ++p) {
      Imf::OutputPart part(output, p);
      Imf::FrameBuffer frame;
      for (auto it = part.header().channels().begin(); it != part.header().channels().end(); ++it)
        frame.insert(it.name(), Imf::Slice::Make(Imf::FLOAT, values_.data(), part.header().dataWindow(),
                                                 sizeof(float), 3 * sizeof(float)));
      part.setFrameBuffer(frame);
      part.writePixels(2);
    }
    return file;
  }

  const fs::path folder_ = fs::temp_directory_path() / ("gnomon_exr_test_" + std::to_string(getpid()));
  const std::array<float, 6> values_ = {0, 1, 0.25f, 0.5f, 0.75f, 2};
};

TEST_F(ExrFiles, ChannelsOfPartsHaveTheirNames) {
  const Image image = read_exr(parts());
  EXPECT_EQ(image.width, 3u);
  ASSERT_EQ(image.channels, (std::vector<std::string>{"rgb.B", "rgb.G", "rgb.R", "shadow.Y"}));
  for (size_t c = 0; c < 4; ++c)
    for (size_t i = 0; i < 6; ++i) EXPECT_EQ(image.plane(c)[i], values_[i]);
}

TEST_F(ExrFiles, OneValueAPixelOfChannelLayerOrColours) {
  Image image(1, 1, {"R", "G", "B", "shadow.Y", "sun.R", "sun.G", "sun.B"});
  image.data = {1, 0, 0, 0.5f, 0, 1, 0};
  EXPECT_EQ(scalar_values(image, "G", "a.exr")[0], 0);
  EXPECT_EQ(scalar_values(image, "shadow", "a.exr")[0], 0.5f);
  EXPECT_EQ(scalar_values(image, "shadow.Y", "a.exr")[0], 0.5f);
  EXPECT_FLOAT_EQ(scalar_values(image, "luminance", "a.exr")[0], 0.2126f);
  EXPECT_FLOAT_EQ(scalar_values(image, "sun", "a.exr")[0], 0.7152f);
  const std::string error = message_of([&] { scalar_values(image, "Y", "a.exr"); });
  EXPECT_NE(error.find("a.exr: no channel 'Y'; it has: R, G, B, shadow.Y"), std::string::npos) << error;
}

TEST_F(ExrFiles, DataWindowsMustBeTheDisplayWindow) {
  const auto box = [](int x, int y) { return Imath::Box2i({x, y}, {x + 2, y + 1}); };
  const Image shifted = read_exr(windowed(box(10, 20), box(10, 20)));  // wherever that begins
  for (size_t i = 0; i < 6; ++i) EXPECT_EQ(shifted.data[i], values_[i]);
  const std::string error = message_of([&] { read_exr(windowed(Imath::Box2i({0, 0}, {9, 9}), box(4, 5))); });
  EXPECT_NE(error.find("data window (4, 5) to (6, 6) is not its display window (0, 0) to (9, 9)"),
            std::string::npos)
      << error;
}

TEST_F(ExrFiles, OnlyRegularFilesAreRead) {
  ASSERT_EQ(mkfifo((folder_ / "pipe.exr").c_str(), 0600), 0);
  EXPECT_NE(message_of([&] { read_exr(folder_ / "pipe.exr"); }).find("not a file"), std::string::npos);
  fs::create_symlink("/dev/zero", folder_ / "zero.png");
  EXPECT_NE(message_of([&] { read_image(folder_ / "zero.png"); }).find("not a file"), std::string::npos);
}

}  // namespace
}  // namespace gnomon
