// Images and their files: layout, round trips, atomic writing, broken input.
#include "engine/image/image.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <half.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <random>

#include "engine/base/error.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;

class ImageFiles : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) / ("gnomon_image_" + std::to_string(::getpid()) + "_" +
                                              testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  size_t files() const {
    return static_cast<size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }
  fs::path folder_;
};

template <typename F>
std::string message_of(F&& f) {
  try {
    f();
  } catch (const Error& e) {
    return e.what();
  }
  return {};
}

std::string read_all(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

Image small_image() {
  Image image(3, 2, {"Y", "light1.Y", "N.x"});
  for (size_t i = 0; i < image.data.size(); ++i) image.data[i] = 0.1f * static_cast<float>(i) - 0.3f;
  return image;
}

TEST(Image, IsPlanarWithRowZeroFirst) {
  Image image(3, 2, {"Y", "Z"});
  image.at(2, 1, 1) = 7;
  EXPECT_EQ(image.data[(1 * 2 + 1) * 3 + 2], 7);
  EXPECT_EQ(image.plane("Z")[1 * 3 + 2], 7);
  EXPECT_TRUE(image.has("Y"));
  EXPECT_FALSE(image.has("R"));
  EXPECT_THROW(static_cast<const Image&>(image).plane("R"), Error);
}

TEST_F(ImageFiles, ExrKeepsEveryBitAndName) {
  Image image = small_image();
  image.data[0] = std::numeric_limits<float>::infinity();
  image.data[1] = 1e-42f;  // denormal
  image.data[2] = std::nextafter(1.0f, 2.0f);
  write_exr(folder_ / "a.exr", image);
  const Image read = read_exr(folder_ / "a.exr");
  ASSERT_EQ(read.width, 3u);
  ASSERT_EQ(read.height, 2u);
  ASSERT_EQ(read.channels.size(), 3u);
  for (const std::string& name : image.channels)
    for (size_t i = 0; i < 6; ++i)
      EXPECT_EQ(static_cast<const Image&>(image).plane(name)[i], read.plane(name)[i]) << name << i;
  EXPECT_EQ(files(), 1u);
}

TEST_F(ImageFiles, ExrReadsHalfAndUint) {
  const half halves[2] = {half(0.5f), half(-2.0f)};
  const unsigned int uints[2] = {3, 70000};
  Imf::Header header(2, 1);
  header.channels().insert("H", Imf::Channel(Imf::HALF));
  header.channels().insert("U", Imf::Channel(Imf::UINT));
  Imf::FrameBuffer frame;
  frame.insert("H",
               Imf::Slice(Imf::HALF, reinterpret_cast<char*>(const_cast<half*>(halves)), sizeof(half), 0));
  frame.insert(
      "U", Imf::Slice(Imf::UINT, reinterpret_cast<char*>(const_cast<unsigned int*>(uints)), sizeof(int), 0));
  {
    Imf::OutputFile out((folder_ / "mixed.exr").c_str(), header);
    out.setFrameBuffer(frame);
    out.writePixels(1);
  }
  const Image image = read_exr(folder_ / "mixed.exr");
  EXPECT_EQ(image.plane("H")[0], 0.5f);
  EXPECT_EQ(image.plane("H")[1], -2.0f);
  EXPECT_EQ(image.plane("U")[0], 3.0f);
  EXPECT_EQ(image.plane("U")[1], 70000.0f);
}

TEST_F(ImageFiles, PngIsSrgbEncodedOnce) {
  Image image(4, 1, {"R", "G", "B"});
  // Linear 0.214041 is sRGB 0.5: ((0.5 + 0.055) / 1.055)^2.4; 0.002 lies on the linear part: 12.92 * 0.002 *
  // 255 = 6.59.
  const float values[4] = {0, 0.21404114f, 0.002f, 5.0f};
  const int expected[4] = {0, 128, 7, 255};
  for (int c = 0; c < 3; ++c)
    for (uint32_t x = 0; x < 4; ++x) image.at(x, 0, c) = values[x];
  write_png_srgb(folder_ / "c.png", image);
  const Image read = read_image(folder_ / "c.png");
  ASSERT_EQ(read.channels, (std::vector<std::string>{"R", "G", "B"}));
  for (uint32_t x = 0; x < 4; ++x) EXPECT_EQ(std::lround(read.at(x, 0, 1) * 255), expected[x]) << x;
}

TEST_F(ImageFiles, GrayPngHasNoTransferCurveAndClampsNan) {
  Image image(4, 1, {"Y"});
  image.data = {0.5f, -1.0f, 2.0f, std::nanf("")};
  write_png_gray(folder_ / "g.png", image);
  const Image read = read_image(folder_ / "g.png");
  ASSERT_EQ(read.channels.size(), 1u);
  EXPECT_FLOAT_EQ(read.data[0], 128 / 255.0f);
  EXPECT_EQ(read.data[1], 0);
  EXPECT_EQ(read.data[2], 1);
  EXPECT_EQ(read.data[3], 0);
}

TEST_F(ImageFiles, WritingReplacesAndLeavesNothingBeside) {
  write_text(folder_ / "t.txt", "first");
  write_text(folder_ / "t.txt", "second");
  EXPECT_EQ(read_all(folder_ / "t.txt"), "second");
  EXPECT_EQ(files(), 1u);
}

TEST_F(ImageFiles, WritingFollowsLinks) {
  write_text(folder_ / "target.txt", "old");
  fs::create_symlink(folder_ / "target.txt", folder_ / "link.txt");
  write_text(folder_ / "link.txt", "new");
  EXPECT_TRUE(fs::is_symlink(folder_ / "link.txt"));
  EXPECT_EQ(read_all(folder_ / "target.txt"), "new");
}

TEST_F(ImageFiles, FullDiskIsAnErrorThatNamesTheFile) {
  ASSERT_TRUE(fs::is_character_file("/dev/full"));
  const std::string message = message_of([] { write_text("/dev/full", "some text"); });
  EXPECT_NE(message.find("/dev/full"), std::string::npos);
  EXPECT_NE(message.find("full"), std::string::npos);
  EXPECT_THROW(write_exr("/dev/full", small_image()), Error);
  EXPECT_TRUE(fs::is_character_file("/dev/full"));  // not replaced by a file
}

TEST_F(ImageFiles, WriteFailuresLeaveTheOldFileAndNoTemporary) {
  EXPECT_NE(message_of([&] { write_text(folder_ / "no" / "such.txt", "x"); }).find("folder does not exist"),
            std::string::npos);
  fs::create_directory(folder_ / "sub");
  EXPECT_THROW(write_text(folder_ / "sub", "x"), Error);       // a folder
  EXPECT_THROW(write_text(folder_ / "sub" / "", "x"), Error);  // no file name
  EXPECT_TRUE(fs::is_empty(folder_ / "sub"));
  EXPECT_THROW(write_text(folder_ / std::string(300, 'n'), "x"), Error);  // name too long
  EXPECT_EQ(files(), 1u);
  if (::geteuid() != 0) {  // root may write anywhere
    fs::permissions(folder_ / "sub", fs::perms::owner_read | fs::perms::owner_exec);
    EXPECT_THROW(write_text(folder_ / "sub" / "x.txt", "x"), Error);
    fs::permissions(folder_ / "sub", fs::perms::owner_all);
  }
}

TEST_F(ImageFiles, EmptyAndUnfitImagesAreErrors) {
  EXPECT_THROW(write_exr(folder_ / "e.exr", Image()), Error);
  EXPECT_THROW(write_png_gray(folder_ / "e.png", Image(0, 0, {"Y"})), Error);
  EXPECT_THROW(write_png_srgb(folder_ / "e.png", Image(1, 1, {"Y"})), Error);
  EXPECT_EQ(files(), 0u);
}

TEST_F(ImageFiles, MissingAndUnknownFilesAreErrors) {
  EXPECT_NE(message_of([&] { read_exr(folder_ / "none.exr"); }).find("none.exr"), std::string::npos);
  EXPECT_THROW(read_image(folder_ / "none.png"), Error);
  EXPECT_THROW(read_image(folder_), Error);
  EXPECT_THROW(read_exr(folder_), Error);
  write_text(folder_ / "a.bmp", "BM");
  EXPECT_NE(message_of([&] { read_image(folder_ / "a.bmp"); }).find(".png"), std::string::npos);
}

// Cut off at any length, or with any byte changed, a file is read or refused: nothing else.
TEST_F(ImageFiles, CorruptFilesNeverCrash) {
  Image gray(16, 16, {"Y"});
  for (size_t i = 0; i < gray.data.size(); ++i) gray.data[i] = static_cast<float>(i % 7) / 7;
  write_exr(folder_ / "ok.exr", gray);
  write_png_gray(folder_ / "ok.png", gray);
  std::mt19937 random(7);
  for (const char* extension : {".exr", ".png"}) {
    const std::string good = read_all(folder_ / (std::string("ok") + extension));
    const fs::path bad = folder_ / (std::string("bad") + extension);
    for (size_t length = 0; length < good.size(); length += 13) {
      write_text(bad, good.substr(0, length));
      EXPECT_NE(message_of([&] { read_image(bad); }).find("bad"), std::string::npos) << length;
    }
    for (int round = 0; round < 400; ++round) {
      std::string broken = good;
      for (int k = 0; k < 3; ++k) broken[random() % broken.size()] = static_cast<char>(random());
      write_text(bad, broken);
      try {
        const Image image = read_image(bad);
        EXPECT_EQ(image.data.size(), size_t{image.width} * image.height * image.channels.size());
      } catch (const Error&) {
      }
    }
  }
}

}  // namespace
}  // namespace gnomon
