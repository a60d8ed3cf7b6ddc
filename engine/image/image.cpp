// Images on the CPU and their files: EXR and PNG.
#include "engine/image/image.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStdIO.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <system_error>
#include <utility>

#include "engine/base/error.h"
#include "engine/base/input_file.h"
#include "engine/image/exr.h"
#include "engine/image/png.h"

namespace gnomon {
namespace {

std::string system_message(int code) { return std::generic_category().message(code); }

std::string hint_for(int code) {
  switch (code) {
    case ENOENT:
      return "the folder does not exist";
    case ENOSPC:
      return "the disk is full";
    case EACCES:
    case EROFS:
      return "the folder is not writable";
    default:
      return {};
  }
}

[[noreturn]] void fail_write(const std::filesystem::path& file, int code) {
  fail(fmt::format("cannot write: {}", system_message(code)), file.string(), {}, hint_for(code));
}

// Owns a file descriptor.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  bool valid() const { return fd_ >= 0; }
  // Writes everything; 0 or an errno value.
  int write(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t written = ::write(fd_, bytes.data(), bytes.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) return errno;
      bytes.remove_prefix(static_cast<size_t>(written));
    }
    return 0;
  }
  // Some file systems report a full disk or quota only here.
  int close() { return ::close(std::exchange(fd_, -1)) == 0 ? 0 : errno; }

 private:
  int fd_;
};

// Devices and pipes cannot be replaced by a rename: they are written directly.
void write_in_place(const std::filesystem::path& file, std::string_view bytes) {
  Descriptor out(::open(file.c_str(), O_WRONLY | O_CLOEXEC));
  if (!out.valid()) fail_write(file, errno);
  if (const int code = out.write(bytes)) fail_write(file, code);
  if (const int code = out.close()) fail_write(file, code);
}

void write_beside_and_rename(const std::filesystem::path& file, std::string_view bytes) {
  std::filesystem::path temporary;
  int fd = -1;
  for (int attempt = 0; fd < 0; ++attempt) {
    temporary =
        file.parent_path() / fmt::format(".{}.{}-{}.tmp", file.filename().string(), ::getpid(), attempt);
    fd = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (fd < 0 && (errno != EEXIST || attempt == 1000)) fail_write(file, errno);
  }
  Descriptor out(fd);
  int code = out.write(bytes);
  if (const int close_code = out.close(); code == 0) code = close_code;
  if (code == 0 && std::rename(temporary.c_str(), file.c_str()) != 0) code = errno;
  if (code != 0) {
    ::unlink(temporary.c_str());
    fail_write(file, code);
  }
}

void write_bytes(const std::filesystem::path& file, std::string_view bytes) {
  if (file.filename().empty()) fail("cannot write: not a file name", file.string());
  std::error_code ignored;
  // A link keeps pointing at its target, which is what gets replaced.
  const auto resolved =
      std::filesystem::is_symlink(file, ignored) ? std::filesystem::canonical(file, ignored) : file;
  const auto target = resolved.empty() ? file : resolved;
  const auto status = std::filesystem::status(target, ignored);
  if (std::filesystem::is_directory(status)) fail("cannot write: it is a folder", file.string());
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
    write_in_place(target, bytes);
  else
    write_beside_and_rename(target, bytes);
}

void require_readable(const std::filesystem::path& file) {
  constexpr uint64_t most_bytes = uint64_t{8} << 30;  // 16384 x 16384 pixels of 8 channels take that
  check_input_file(file, most_bytes);
  if (::access(file.c_str(), R_OK) != 0)
    fail(fmt::format("cannot read: {}", system_message(errno)), file.string());
}

Imf::Slice float_slice(float* plane, uint32_t width, const Imath::Box2i& window) {
  return Imf::Slice::Make(Imf::FLOAT, plane, window, sizeof(float), sizeof(float) * width);
}

void check_channels(const std::filesystem::path& file, const Image& image, size_t channels) {
  if (image.channels.size() != channels)
    fail(fmt::format("cannot write PNG: {} channels expected, {} given", channels, image.channels.size()),
         file.string());
  if (image.width == 0 || image.height == 0) fail("cannot write an empty image", file.string());
}

uint8_t to_byte(float value) {  // NaN becomes 0
  return static_cast<uint8_t>(std::lround(255.0f * (value > 0 ? std::min(value, 1.0f) : 0.0f)));
}

float srgb_encode(float linear) {  // IEC 61966-2-1
  if (!(linear > 0)) return 0;
  return linear <= 0.0031308f ? 12.92f * linear
                              : 1.055f * std::pow(std::min(linear, 1.0f), 1 / 2.4f) - 0.055f;
}

}  // namespace

Image::Image(uint32_t w, uint32_t h, std::vector<std::string> names)
    : width(w), height(h), channels(std::move(names)), data(size_t{w} * h * channels.size(), 0.0f) {}

std::span<float> Image::plane(size_t channel) {
  const size_t size = size_t{width} * height;
  return std::span(data).subspan(channel * size, size);
}

std::span<const float> Image::plane(size_t channel) const {
  const size_t size = size_t{width} * height;
  return std::span(data).subspan(channel * size, size);
}

std::span<const float> Image::plane(const std::string& name) const {
  const auto it = std::find(channels.begin(), channels.end(), name);
  if (it == channels.end())
    fail(fmt::format("the image has no channel '{}'", name), {}, {}, did_you_mean(name, channels));
  return plane(static_cast<size_t>(it - channels.begin()));
}

bool Image::has(const std::string& name) const {
  return std::find(channels.begin(), channels.end(), name) != channels.end();
}

Image read_exr(const std::filesystem::path& file) {
  require_readable(file);
  try {
    return exr::read(file);
  } catch (const Error&) {
    throw;
  } catch (const std::exception& e) {  // OpenEXR's exceptions name the file; ours do it by themselves
    fail(fmt::format("cannot read as EXR: {}", e.what()), file.string());
  }
}

void write_exr(const std::filesystem::path& file, const Image& image) {
  if (image.width == 0 || image.height == 0 || image.channels.empty())
    fail("cannot write an empty image", file.string());
  std::string bytes;
  try {
    Imf::Header header(static_cast<int>(image.width), static_cast<int>(image.height));
    header.compression() = Imf::ZIP_COMPRESSION;
    if (!image.comment.empty()) Imf::addComments(header, image.comment);
    Imf::FrameBuffer frame;
    for (size_t c = 0; c < image.channels.size(); ++c) {
      header.channels().insert(image.channels[c], Imf::Channel(Imf::FLOAT));
      // The slice's pointer is not const; writing only reads through it.
      auto* plane = const_cast<float*>(image.plane(c).data());
      frame.insert(image.channels[c], float_slice(plane, image.width, header.dataWindow()));
    }
    Imf::StdOSStream stream;
    {
      Imf::OutputFile output(stream, header);
      output.setFrameBuffer(frame);
      output.writePixels(static_cast<int>(image.height));
    }  // the destructor completes the line table
    bytes = stream.str();
  } catch (const std::exception& e) {
    fail(fmt::format("cannot write as EXR: {}", e.what()), file.string());
  }
  write_bytes(file, bytes);
}

Image read_image(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  if (extension == ".exr") return read_exr(file);
  if (extension != ".png")
    fail(fmt::format("unknown image type '{}'", extension), file.string(), {}, "use .exr or .png");
  require_readable(file);
  return png::read(file);
}

void write_png_srgb(const std::filesystem::path& file, const Image& linear_rgb) {
  check_channels(file, linear_rgb, 3);
  const size_t size = size_t{linear_rgb.width} * linear_rgb.height;
  std::vector<uint8_t> bytes(3 * size);
  for (size_t c = 0; c < 3; ++c) {
    const auto plane = linear_rgb.plane(c);
    for (size_t i = 0; i < size; ++i) bytes[3 * i + c] = to_byte(srgb_encode(plane[i]));
  }
  write_bytes(file, png::encode(bytes, linear_rgb.width, linear_rgb.height, 3, file));
}

void write_png_gray(const std::filesystem::path& file, const Image& values) {
  check_channels(file, values, 1);
  std::vector<uint8_t> bytes(values.data.size());
  std::transform(values.data.begin(), values.data.end(), bytes.begin(), to_byte);
  write_bytes(file, png::encode(bytes, values.width, values.height, 1, file));
}

void write_text(const std::filesystem::path& file, const std::string& text) { write_bytes(file, text); }

}  // namespace gnomon
